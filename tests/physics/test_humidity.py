"""Vapour balances against closed forms: decay, source, saturation, penetration depth, plants."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.errors import InputError
from mascarin.examples import box

WARM = 23.0
PRESSURE = 101_325.0
#: Air changes [1/h] of the box, its volume [m3], area of its surface [m2].
CHANGES, VOLUME, AREA = 0.5, 27.0, 54.0
#: Latent heat of the engine [J/kg].
LATENT = 2.5e6


def saturation(celsius: float) -> float:
    """Saturation pressure over water by Hyland & Wexler (ASHRAE Fundamentals 2017, ch. 1, eq. 6) [Pa]."""
    kelvin = celsius + 273.15
    terms = (-5.8002206e3 / kelvin, 1.3914993, -4.8640239e-2 * kelvin, 4.1764768e-5 * kelvin**2)
    return math.exp(sum(terms) - 1.4452093e-8 * kelvin**3 + 6.5459673 * math.log(kelvin))


def ratio(vapour: float) -> float:
    """Humidity ratio at a vapour pressure [kg/kg]."""
    return 0.621945 * vapour / (PRESSURE - vapour)


def climate(
    dew_point: Any = 10.0,
    *,
    air: float = WARM,
    hours: int = 48,
    minutes: int = 60,
    points: Any = None,
) -> mc.Climate:
    """Weather without sun, sky and wind, as warm as the room; ``points`` is one more column of means."""
    rows = hours * 60 // minutes + 1
    table = pd.DataFrame(
        {
            "air_temperature": air,
            "dew_point": dew_point,
            "wind_speed": 0.0,
            "wind_direction": 0.0,
            "pressure": PRESSURE,
            "direct_normal": 0.0,
            "diffuse_horizontal": 0.0,
        },
        index=pd.date_range("2001-01-01", periods=rows, freq=f"{minutes}min", tz="UTC"),
    )
    names = [name for name in table.columns if table[name].notna().all()]
    extra = [] if points is None else ["points"]
    return mc.Climate.from_table(
        table[names] if points is None else table[names].assign(points=points),
        timezone="UTC", columns={name: name for name in names}, extra=extra, instant=names, mean=extra,
        check_sun=False,
    )  # fmt: skip


def room(humidity: dict[str, Any] | None = None, **changes: Any) -> mc.Building:
    """The box at sea level, airtight but for constant air changes, under a sky as warm as the air."""
    plain = box().to_dict()
    plain["site"] |= {
        "altitude": 0.0,
        "air_density": 1.2,
        "air_specific_heat": 1006.0,
        "sky": {"kind": "offset", "depression": 0.0},
        "timezone": "UTC",
    }
    plain["zones"]["room"] = {"volume": VOLUME, "infiltration": CHANGES, "longwave": "none"} | changes
    plain["humidity"] = {} if humidity is None else humidity
    return mc.Building.from_dict(plain)


def run(building: mc.Building, weather: mc.Climate, *names: str, step: Any = "15min", **options: Any) -> Any:
    """Series by name, from 23 degC everywhere."""
    options = {"initial": WARM} | options
    return mc.simulate(building, weather, step=step, outputs=list(names), **options)


def test_humidity_decays_after_a_source_has_stopped() -> None:
    """``w - w_o`` falls as ``exp(-n t)``: an error of second order in the step."""
    outside = ratio(saturation(10.0))
    inside = ratio(0.9 * saturation(WARM))
    errors = []
    for step in (3600, 1800):
        found = run(room({"initial": 0.9}), climate(), "room.humidity_ratio", step=step)
        series = found["room.humidity_ratio"].to_numpy()
        hours = np.arange(len(series)) * step / 3600.0
        exact = outside + (inside - outside) * np.exp(-CHANGES * hours)
        assert series[0] == pytest.approx(inside, rel=1e-12)
        errors.append(np.abs(series - exact).max() / (inside - outside))
        assert found.vapour.relative_residual < 1e-12
    assert errors[0] < 4e-3
    # The first step is made in parts, so that the ratio is not exactly 4.
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_a_steady_source_raises_the_humidity_by_its_share_of_the_air() -> None:
    """``w = w_o + G / m``, as power [W] and as mass [kg/s]."""
    flow = 1.2 * VOLUME * CHANGES / 3600.0
    for source in ({"power": 25.0}, {"rate": 25.0 / LATENT}):
        damp = {"zones": {"room": {"gains": {"people": source}}}}
        found = run(room(damp), climate(hours=96), "room.humidity_ratio", "room.relative_humidity")
        expected = ratio(saturation(10.0)) + 25.0 / LATENT / flow
        assert found["room.humidity_ratio"].to_numpy()[-1] == pytest.approx(expected, rel=1e-9)
        vapour = PRESSURE * expected / (0.621945 + expected)
        assert found["room.relative_humidity"].to_numpy()[-1] == pytest.approx(
            vapour / saturation(WARM), rel=1e-9
        )


def test_saturated_air_keeps_no_more_and_the_rest_is_counted() -> None:
    """At 5 degC with a strong source: 100 %; what condenses is the source less what air and room take."""
    damp = {"zones": {"room": {"gains": {"laundry": {"power": 1000.0}}}}}
    found = run(
        room(damp), climate(0.0, air=5.0, hours=24), "room.relative_humidity", "room.dew_point", initial=5.0
    )
    assert found["room.relative_humidity"].to_numpy()[-1] == pytest.approx(1.0, abs=1e-12)
    assert found["room.dew_point"].to_numpy()[-1] == pytest.approx(5.0, abs=1e-9)
    flow = 1.2 * VOLUME * CHANGES / 3600.0
    lost = (1000.0 / LATENT - flow * (ratio(saturation(5.0)) - ratio(611.2127))) * 86400.0 * 25.0 / 24.0
    assert -found.vapour.into["condensation"] == pytest.approx(lost, rel=0.003)
    assert any("saturated" in warning for warning in found.warnings)


def test_a_daily_swing_is_damped_as_by_the_lumped_layer() -> None:
    """Amplitude and lag of the room under a daily swing against the closed form of air and one layer.

    ``i w M = m (w_o - w) - A F``, ``F = b p' w i w c / (i w c + b P)`` with ``c = d xi`` and
    ``b = 1 / (1/h + d / (2 delta))``.
    """
    days, minutes = 6, 15
    hours = np.arange(days * 24 * 60 // minutes + 1) * minutes / 60.0
    omega = 2.0 * math.pi / 86400.0
    dew = 12.0 + 0.2 * np.cos(omega * 3600.0 * hours)
    capacity, resistance, depth = 12.0, 8.0, 0.01
    sorption = {"capacity": capacity, "vapour_resistance": resistance, "depth": depth}
    start = saturation(12.0) / saturation(WARM)
    damp = room({"initial": start, "materials": {"concrete": sorption}})
    weather = climate(dew, hours=24 * days, minutes=minutes)
    found = run(damp, weather, "room.humidity_ratio", "facade.inside_convection")
    series = found["room.humidity_ratio"].to_numpy()[: len(hours)][-96:]
    film = float(found["facade.inside_convection"].to_numpy()[-1])

    dry = 1.2 * VOLUME
    flow = dry * CHANGES / 3600.0
    permeability = 2e-7 * (WARM + 273.15) ** 0.81 / PRESSURE / resistance
    vapour = film / (1.2 * 1006.0) / (461.524 * (WARM + 273.15))
    exchange = 1.0 / (1.0 / vapour + 0.5 * depth / permeability)
    mean = ratio(saturation(12.0))
    slope = PRESSURE * 0.621945 / (0.621945 + mean) ** 2
    store = 1j * omega * depth * capacity
    uptake = AREA * exchange * slope * store / (store + exchange * saturation(WARM))
    response = flow / (1j * omega * dry + flow + uptake)
    swing = 0.5 * (ratio(saturation(12.2)) - ratio(saturation(11.8)))
    phase = np.exp(-1j * omega * 3600.0 * hours[-96:])
    amplitude = 2.0 * np.mean(series * phase) / swing
    assert abs(response) < 0.2
    assert abs(amplitude) == pytest.approx(abs(response), rel=0.01)
    assert np.angle(amplitude) == pytest.approx(np.angle(response), abs=0.02)
    assert found.vapour.relative_residual < 1e-10


def test_drying_to_a_set_point_takes_away_what_is_too_much() -> None:
    """Latent load ``2.5e6 (G + m (w_o - w))``; with a smaller capacity the room stays more humid."""
    flow = 1.2 * VOLUME * CHANGES / 3600.0
    damp: dict[str, Any] = {"gains": {"people": {"power": 100.0}}, "drying": {"relative_humidity": 0.5}}
    names = ("room.relative_humidity", "room.latent_cooling_load", "room.humidity_ratio")
    weather = climate(18.0, hours=24)
    found = run(room({"zones": {"room": damp}}), weather, *names)
    assert found["room.relative_humidity"].to_numpy()[1:] == pytest.approx(0.5, abs=1e-12)
    held = ratio(0.5 * saturation(WARM))
    load = 100.0 + LATENT * flow * (ratio(saturation(18.0)) - held)
    assert found["room.latent_cooling_load"].to_numpy()[-1] == pytest.approx(load, rel=1e-9)
    weak = damp | {"drying": {"relative_humidity": 0.5, "capacity": 40.0}}
    found = run(room({"zones": {"room": weak}}), climate(10.0, hours=72), *names)
    assert found["room.latent_cooling_load"].to_numpy()[-1] == pytest.approx(40.0, rel=1e-9)
    rest = ratio(saturation(10.0)) + 60.0 / LATENT / flow
    assert found["room.humidity_ratio"].to_numpy()[-1] == pytest.approx(rest, rel=1e-6)


#: A set point of 0.6, and 0.5 from 8 to 16 h.
BY_DAY = [("00:00", 0.6), ("08:00", 0.5), ("16:00", 0.6)]
STEPS = {"kind": "fraction", "days": {"all": [{"at": at, "value": value} for at, value in BY_DAY]}}


@pytest.mark.parametrize("point", [{"schedule": "points"}, {"column": "points", "unit": "%"}])
def test_drying_to_a_set_point_that_steps(point: dict[str, Any]) -> None:
    """Latent load with a steady source: that of the set point, and vapour of the air where it steps down.

    Down, the room follows within the step on a straight line: ``M (w_1 - w_2)`` more is taken away. Up,
    nothing is dried until the source has brought the room to the new set point, after
    ``ln((w_e - w_2)/(w_e - w_1))/n``.
    """
    damp = {"gains": {"people": {"power": 100.0}}, "drying": {"relative_humidity": point}}
    plain = room().to_dict() | {"schedules": {"points": STEPS} if "schedule" in point else {}}
    plain["humidity"] = {"initial": 0.6, "zones": {"room": damp}}
    hours = np.arange(25)
    weather = climate(hours=24, points=np.where((hours >= 8) & (hours < 16), 50.0, 60.0))
    names = ("room.latent_cooling_load", "room.relative_humidity")
    found = run(mc.Building.from_dict(plain), weather, *names)
    load, humidity = (found[name].to_numpy() for name in names)

    dry = 1.2 * VOLUME
    flow = dry * CHANGES / 3600.0
    outside = ratio(saturation(10.0))
    high, low = (ratio(share * saturation(WARM)) for share in (0.6, 0.5))
    steady = {w: 100.0 - LATENT * flow * (w - outside) for w in (high, low)}
    # Rows are the ends of steps of 15 min.
    assert load[2:33] == pytest.approx(np.full(31, steady[high]), rel=1e-9)
    mean = 0.5 * (steady[high] + steady[low])
    assert load[33] == pytest.approx(mean + LATENT * dry * (high - low) / 900.0, rel=1e-9)
    assert load[34:65] == pytest.approx(np.full(31, steady[low]), rel=1e-9)
    assert humidity[[32, 33, 64]] == pytest.approx([0.6, 0.5, 0.5], abs=1e-12)
    end = outside + 100.0 / LATENT / flow
    rising = math.log((end - low) / (end - high)) / CHANGES * 4.0
    reached = 64 + math.ceil(rising)
    assert not load[65:reached].any()
    assert 0.0 < load[reached] <= steady[high]
    assert load[reached + 1 : 97] == pytest.approx(np.full(96 - reached, steady[high]), rel=1e-9)
    assert found.vapour.relative_residual < 1e-12


def test_humidifying_by_a_schedule_of_humidity_ratios() -> None:
    """To 10 g/kg by day and 5 g/kg, below that of the outdoor air, by night: nothing is added then."""
    profile = [{"at": "00:00", "value": 0.005}, {"at": "08:00", "value": 0.010}]
    plain = room().to_dict() | {"schedules": {"points": {"kind": "humidity_ratio", "days": {"all": profile}}}}
    plain["humidity"] = {"zones": {"room": {"humidifying": {"humidity_ratio": {"schedule": "points"}}}}}
    names = ("room.latent_heating_load", "room.humidity_ratio")
    found = run(mc.Building.from_dict(plain), climate(hours=24), *names)
    load = found["room.latent_heating_load"].to_numpy()
    assert not load[1:33].any()
    flow = 1.2 * VOLUME * CHANGES / 3600.0
    expected = LATENT * flow * (0.010 - ratio(saturation(10.0)))
    assert load[34:97] == pytest.approx(np.full(63, expected), rel=1e-9)
    assert found["room.humidity_ratio"].to_numpy()[33:97] == pytest.approx(0.010, rel=1e-12)


@pytest.mark.parametrize(
    ("drying", "humidifying", "words"),
    [
        ({"relative_humidity": {"schedule": "point"}}, None, "Did you mean 'points'"),
        ({"relative_humidity": {"schedule": "warm"}}, None, "a schedule of kind fraction"),
        ({"relative_humidity": {"schedule": "nought"}}, None, "'nought' with 0\n  expected: values above 0"),
        ({"humidity_ratio": {"schedule": "points"}}, None, "a schedule of kind humidity_ratio"),
        ({"humidity_ratio": {"schedule": "none"}}, None,
         "'none' with 0\n  expected: values above 0, up to 0.2 [kg/kg]"),
        ({"relative_humidity": {"schedule": "none"}}, None, "a schedule of kind fraction"),
        ({"relative_humidity": {"schedule": "points", "column": "points"}}, None, "schedule and column"),
        ({"relative_humidity": {"constant": 0.6, "unit": "%"}}, None, "'unit' without a column"),
        ({"relative_humidity": {"schedule": "points"}}, {"relative_humidity": 0.55},
         "0.55, above 0.5 of drying, on monday at 08:00"),
        ({"relative_humidity": 0.55}, {"relative_humidity": {"schedule": "points"}},
         "0.6, above 0.55 of drying, on monday at 00:00"),
        ({"relative_humidity": 0.5}, {"relative_humidity": 0.6}, "0.6, above 0.5 of drying\n"),
    ],
)  # fmt: skip
def test_set_points_that_cannot_be_are_refused(drying: Any, humidifying: Any, words: str) -> None:
    plain = room().to_dict()
    plain["schedules"] = {
        "points": STEPS,
        "warm": {"kind": "temperature", "value": 20},
        "nought": {"kind": "fraction", "value": 0},
        "none": {"kind": "humidity_ratio", "value": 0},
    }
    plain["humidity"] = {"zones": {"room": {"drying": drying, "humidifying": humidifying}}}
    with pytest.raises(InputError) as caught:
        mc.Building.from_dict(plain)
    assert words in str(caught.value)


def test_measured_set_points_that_cannot_be_are_refused() -> None:
    """Columns are read over the period of the run: above 100 %, and humidifying above drying."""
    drying = {"relative_humidity": {"column": "points"}}
    damp = room({"zones": {"room": {"drying": drying, "humidifying": {"relative_humidity": 0.55}}}})
    names = ["room.relative_humidity"]
    with pytest.raises(InputError, match=r"(?s)points.*60.*1"):
        run(damp, climate(hours=24, points=60.0), *names)
    hours = np.arange(25)
    crossing = climate(hours=24, points=np.where(hours == 5, 0.5, 0.6))
    with pytest.raises(InputError, match=r"humidifying to 0.55 above drying to 0.5 .* 2001-01-01 05:00"):
        run(damp, crossing, *names)


def test_a_coil_dries_in_proportion_to_its_sensible_load() -> None:
    """Latent over sensible load ``(1 - s)/s``, until the room is as dry as air saturated at the coil."""
    for changes, dew, limited in ((2.0, 20.0, False), (0.05, 5.0, True)):
        coil = {"drying": {"sensible_heat_ratio": 0.8, "coil_temperature": 10.0}}
        building = room(
            {"initial": 0.6, "zones": {"room": coil}},
            infiltration=changes,
            gains={"machines": {"power": 600.0}},
            cooling={"setpoint": WARM},
        )
        names = ("room.latent_cooling_load", "room.cooling_load", "room.humidity_ratio")
        found = run(building, climate(dew, hours=48), *names)
        latent, sensible, humidity = (found[name].to_numpy()[-1] for name in names)
        if limited:
            # Outdoor air is drier than the coil makes it: nothing is left to take away.
            assert humidity <= ratio(saturation(10.0)) + 1e-12
            assert latent < 0.05 * sensible
        else:
            assert latent == pytest.approx(0.25 * sensible, rel=1e-9)
            assert sensible > 300.0


def test_vapour_is_kept_between_zones_units_and_plants() -> None:
    """Two rooms, a door, a unit that recovers vapour, sorption and plants: closes to 1e-10, in lanes too."""
    plain = room({"materials": {"concrete": "gypsum"}}).to_dict()
    plain["zones"]["room"]["makeup_air"] = "outdoors"
    plain["zones"]["attic"] = {
        "volume": 20.0, "infiltration": 0.2, "heating": {"setpoint": 20}, "makeup_air": "outdoors"
    }  # fmt: skip
    plain["surfaces"]["partition"] = {
        "construction": "wall", "area": 12.0, "tilt": 90, "azimuth": 0,
        "outside": {"zone": "attic", "convection": 3, "emissivity": 0.9},
        "inside": {"zone": "room", "convection": 3, "emissivity": 0.9},
    }  # fmt: skip
    plain["air_paths"] = {"door": {"between": ["room", "attic"], "door": {"width": 0.8, "height": 2.0}}}
    flows = {"supply": {"room": 0.01}, "exhaust": {"attic": 0.01}}
    plain["ventilation_units"] = {"unit": flows | {"recovery": 0.7}}
    plain["humidity"] |= {
        "deep_period": 504.0,
        "recovery": {"unit": 0.5},
        "zones": {
            "room": {"gains": {"people": {"power": 120.0}}, "drying": {"relative_humidity": 0.55}},
            "attic": {"humidifying": {"humidity_ratio": 0.0095}},
        },
    }
    building = mc.Building.from_dict(plain)
    weather = climate(8.0 + 5.0 * np.sin(np.arange(49) / 4.0), air=15.0)
    names = ["room.relative_humidity", "attic.humidity_ratio", "room.latent_cooling_load"]
    simulation = mc.Simulation(building, weather, step="30min", outputs=names, initial=20.0)
    found = simulation.run()
    assert found.vapour is not None
    assert found.vapour.relative_residual < 1e-10
    assert all("cannot enclose" in line for line in found.warnings)
    assert found.vapour.stored == pytest.approx(sum(found.vapour.into.values()), abs=1e-9)
    assert min(found.vapour.into["gains"], found.vapour.into["humidifying"]) > 0.0
    assert found.vapour.into["drying"] < 0.0
    vectors = np.tile(simulation.values, (9, 1))
    place = simulation.paths.index("humidity.zones.room.gains.people.power")
    vectors[:, place] = np.linspace(0.0, 400.0, 9)
    records, residuals, failures = simulation.compiled.ensemble(vectors)
    alone = np.array([simulation.compiled.run(vector)[0] for vector in vectors])
    assert not failures
    assert residuals.max() < 1e-10
    assert records.tobytes() == alone.tobytes()


def test_derivatives_of_the_humidity() -> None:
    """Forward and reverse mode against central differences."""
    sorption = {"capacity": 12.0, "vapour_resistance": 8.0, "depth": 0.01}
    damp = {"materials": {"concrete": sorption}, "zones": {"room": {"gains": {"people": {"power": 60.0}}}}}
    names = ["room.relative_humidity", "room.wet_bulb"]
    simulation = mc.Simulation(room(damp), climate(hours=12), step="1h", outputs=names, initial=WARM)
    paths = [
        "humidity.zones.room.gains.people.power",
        "humidity.materials.concrete.capacity",
        "humidity.materials.concrete.depth",
        "zones.room.infiltration.constant",
    ]
    _, slopes = simulation.jacobian_vector(paths, simulation.values)
    start = simulation.vector({})
    trajectory = simulation.trajectory(start)
    weights = np.ones_like(trajectory.records)
    pulled = trajectory.pull(weights)
    for path, slope in zip(paths, slopes, strict=True):
        place = simulation.paths.index(path)
        nudge = 1e-4 * start[place]
        ends = []
        for sign in (1.0, -1.0):
            vector = start.copy()
            vector[place] += sign * nudge
            ends.append(simulation.compiled.run(vector)[0])
        difference = (ends[0] - ends[1]) / (2.0 * nudge)
        np.testing.assert_allclose(slope, difference, atol=1e-6 * np.abs(difference).max())
        assert pulled[place] == pytest.approx(slope.sum(), rel=1e-9)


def test_condensation_on_a_cold_surface() -> None:
    """A surface below the dew point is flagged, a warm one is not."""
    names = ("facade.inside_condensation", "facade.inside_temperature", "room.dew_point")
    building = room({"zones": {"room": {"gains": {"people": {"power": 60.0}}}}}, heating={"setpoint": 20})
    found = run(building, climate(-6.0, air=-5.0, hours=24), *names, initial=20.0)
    flag, surface, dew = (found[name].to_numpy() for name in names)
    assert set(flag) == {0.0, 1.0}
    assert np.array_equal(flag == 1.0, surface < dew)


@pytest.mark.parametrize(
    ("humidity", "words"),
    [
        ({"materials": {"concret": "gypsum"}}, "the name of a material"),
        ({"materials": {"concrete": "paper"}}, "gypsum"),
        ({"zones": {"room": {"gains": {"people": {}}}}}, "no rate"),
        ({"zones": {"room": {"gains": {"people": {"power": -5}}}}}, "power"),
        ({"zones": {"room": {"gains": {"people": {"power": 5, "rate": 1e-5}}}}}, "power and rate"),
        ({"zones": {"room": {"drying": {"sensible_heat_ratio": 0.7}}}}, "without cooling"),
        ({"zones": {"room": {"drying": {}}}}, "no set point"),
        ({"recovery": {"unit": 0.5}}, "ventilation_units"),
        ({"initial": 1.5}, "initial"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(humidity: dict[str, Any], words: str) -> None:
    """The text says where and what was expected."""
    with pytest.raises(InputError, match="humidity") as caught:
        room(humidity)
    assert words in str(caught.value)


def test_humidity_of_the_weather_and_of_the_building_are_needed() -> None:
    """A climate without dew point, and an output of a building without humidity."""
    with pytest.raises(InputError, match="no column for dew_point"):
        run(room(), climate(None, hours=4), "room.relative_humidity")
    with pytest.raises(InputError, match="Add 'humidity: "):
        box().output("room.relative_humidity")
    lines = room({"materials": {}}).check()
    assert any("no sorption data of concrete" in line for line in lines)


def test_humidity_changes_no_temperature() -> None:
    """With a given start the heat has the same bits with and without vapour balances."""
    plain = room().to_dict()
    del plain["humidity"]
    weather = climate(hours=12)
    dry = run(mc.Building.from_dict(plain), weather, "room.air_temperature", initial=18.0)
    damp = run(room({"materials": {"concrete": "gypsum"}}), weather, "room.air_temperature", initial=18.0)
    assert dry.records.tobytes() == damp.records.tobytes()
    assert dry.vapour is None
    assert damp.vapour is not None
