"""Vents, which pressure drives air through, and controls of openings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import examples
from mascarin.building import Building
from mascarin.building.parts.site_air import density
from mascarin.ensemble import sweep
from mascarin.errors import InputError
from mascarin.simulation.simulation import Simulation
from test_simulation_derivatives import both_ways, misses

OUTSIDE = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.5}
#: Pressure coefficients of Swami & Chandra with the wind along the normal and from behind.
WINDWARD, LEEWARD = 0.6 * np.log(1.248 + 0.769 + 0.717), 0.6 * np.log(1.248 - 0.703)


def rooms(**changes: Any) -> Building:
    """Two rooms of light walls, the first in the north with a lamp, and a door between them."""

    def wall(zone: str, azimuth: float) -> dict[str, Any]:
        inside = {"zone": zone, "convection": 3}
        return {
            "construction": "wall",
            "area": 20,
            "tilt": 90,
            "azimuth": azimuth,
            "outside": OUTSIDE,
            "inside": inside,
        }

    def window(zone: str, surface: str, elevation: float, **more: Any) -> dict[str, Any]:
        wind = {"kind": "low_rise", "shelter": 0.8, "height": 6}
        return {
            "zone": zone,
            "surface": surface,
            "area": 0.5,
            "elevation": elevation,
            "pressure": wind,
            **more,
        }

    plain: dict[str, Any] = {
        "name": "two rooms",
        "site": {"latitude": 48, "longitude": 2, "altitude": 100, "timezone": "UTC"},
        "materials": {"board": {"conductivity": 0.16, "density": 800, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "board", "thickness": 0.05}]}},
        "zones": {
            "a": {"volume": 50, "longwave": "none", "gains": {"lamp": {"power": 300}}},
            "b": {"volume": 50, "longwave": "none"},
        },
        "surfaces": {"north": wall("a", 0), "south": wall("b", 180)},
        "vents": {
            "windward": window("a", "north", 1.5),
            "leeward": window("b", "south", 1.5),
            "door": {"between": ["a", "b"], "area": 1.5, "elevation": 1.5},
        },
    }
    return Building.from_dict(plain | changes)


def weather(hours: int = 49, absent: dict[str, float] | None = None, **columns: Any) -> mc.Climate:
    """A day between 14 and 24 degC with wind from the north of 4 m/s."""
    hour = np.arange(hours)
    air = 19.0 - 5.0 * np.cos(2 * np.pi * (hour - 3) / 24)
    index = pd.date_range("2023-06-01", periods=hours, freq="1h", tz="UTC")
    frame = pd.DataFrame({"air_temperature": air, "wind_speed": 4.0}, index=index).assign(**columns)
    missing = {"radiation": 0.0, "dew_point": 12.0, "wind_direction": 360.0} | (absent or {})
    kept = [name for name in ("air_temperature", "wind_speed") if name not in missing]
    extra = [str(name) for name in frame if name not in ("air_temperature", "wind_speed")]
    columns = {name: name for name in kept}
    return mc.Climate.from_table(frame, columns=columns, absent=missing, extra=extra, timezone="UTC")


def run(building: Building, climate: mc.Climate, outputs: list[str] | None = None, **more: Any) -> mc.Results:
    names = [output.name for output in building.outputs()] if outputs is None else outputs
    settings: dict[str, Any] = {"step": "30min", "initial": 20.0} | more
    return mc.simulate(building, climate, outputs=names, **settings)


def last(results: mc.Results, name: str) -> float:
    return float(results[name][-1])


def test_cross_flow_by_hand() -> None:
    """`sqrt(2 dp/rho)` over the root of the sum of `1/(C_d A)^2`, with the wind at 6 m, as air of 15 degC."""
    building = rooms()
    wind = {key: float(number) for key, number in building.site.wind if isinstance(number, float)}
    at_mast = (wind["mast_layer"] / wind["mast_height"]) ** wind["mast_exponent"]
    factor = at_mast * (6 / wind["layer"]) ** wind["exponent"]
    # Flows at the start belong to the first stage; the speed is the same all day.
    results = run(building, weather(air_temperature=20.0), step="1h")
    squares = 2 / (0.65 * 0.5) ** 2 + 1 / (0.65 * 1.5) ** 2
    speed = 0.8 * factor * 4.0
    expected = np.sqrt((WINDWARD - LEEWARD) * speed**2 / squares) * 288.15 / 293.15
    assert results["windward.inflow"][0] == pytest.approx(expected, rel=1e-6)
    assert results["leeward.outflow"][0] == pytest.approx(expected, rel=1e-6)
    assert results["door.outflow"][0] == pytest.approx(expected, rel=1e-6)
    assert results["a.air_changes"][0] == pytest.approx(3600 * expected / 50, rel=1e-6)
    # Air that came through the first room counts as that of the second no more.
    assert results["b.air_changes"][0] == pytest.approx(0.0, abs=1e-4)
    assert results["windward.outflow"][0] == 0.0


def test_flows_balance_and_so_does_the_heat() -> None:
    """In a steady state the air carries the heat of the lamp that the walls do not: through both rooms."""
    climate = weather(air_temperature=15.0, hours=97)
    building = rooms().replace({"vents.door.height": 2.0})
    results = run(building, climate)
    heat = density(building.site) * 1006.0
    into = last(results, "windward.inflow")
    assert into == pytest.approx(last(results, "leeward.outflow"), abs=1e-6)
    passing = last(results, "door.outflow") - last(results, "door.inflow")
    assert passing == pytest.approx(into, abs=1e-6)
    a, b = (last(results, f"{zone}.air_temperature") for zone in "ab")
    through_wall = sum(-20 * last(results, f"{wall}.inside_flux") for wall in ("north", "south"))
    assert heat * into * (b - 15.0) + through_wall == pytest.approx(300.0, rel=1e-4)
    assert a > b > 15.0
    assert results.energy.closes
    assert results.energy.into["interzone"] == pytest.approx(0.0, abs=1e-3)


CONTROLS = {
    "controls": {"night": {"zone": "a", "indoor": {"open": 24, "close": 21}, "wind": {"open": 5, "close": 7}}}
}


def controlled(**control: Any) -> Building:
    vents = rooms().to_dict()["vents"]
    for name in ("windward", "leeward"):
        vents[name]["control"] = "night"
    return rooms(vents=vents, controls={"night": {**CONTROLS["controls"]["night"], **control}})


def test_a_control_decides_as_it_says() -> None:
    """The decisions replayed from the recorded temperatures; closed vents let nothing through."""
    results = run(
        controlled(), weather(), ["a.air_temperature", "night.open", "windward.inflow", "windward.open"]
    )
    state, expected = 0.0, []
    for air in results["a.air_temperature"][:-1]:
        state = float(air > (21.0 if state else 24.0))
        expected.append(state)
    found = results["night.open"][1:]
    np.testing.assert_array_equal(found, expected)
    assert np.abs(np.diff(found)).sum() >= 4
    np.testing.assert_array_equal(results["windward.open"][1:], found)
    assert (results["windward.inflow"][1:][found == 0.0] == 0.0).all()
    assert results.energy.closes


def test_rain_and_wind_close() -> None:
    """Rain between 10:00 and 12:00; a wind of 8 m/s in the second night, closed until it is below 5 m/s."""
    hour = np.arange(49)
    wet = np.where((hour >= 10) & (hour < 12), 2.0, 0.0)
    wind = np.select([hour < 24, hour < 27], [4.0, 8.0], 6.0)
    building = controlled(indoor={"open": -20, "close": -30}, rain={"column": "rain", "close": 0.2})
    results = run(building, weather(rain=wet, wind_speed=wind), ["night.open"], step="1h")
    found = results["night.open"][1:]
    assert found[:9].all()
    assert not found[10:12].any()
    assert found[13:23].all()
    # Open at 4 m/s only: 6 m/s is between the limits, and it was closed before.
    assert not found[25:].any()


def test_minimum_times() -> None:
    """Outdoor air above and below both limits in turn: open for 3 h and closed for 2 h at least.

    It opens in a warm hour, may close in the third hour after it, which is cold, and may open two hours
    later, in a cold one: it opens in the next. Members of an ensemble have the bits of single runs.
    """
    hour = np.arange(25)
    climate = weather(25, air_temperature=np.where(hour % 2 == 1, 21.0, 19.0))
    band = {"open": 20, "close": 20}
    times = {"minimum_open_time": {"value": 180, "range": [0, 400]}, "minimum_closed_time": 120}
    building = controlled(indoor=None, outdoor=band, **times)
    outputs = ["night.open", "a.air_temperature"]
    settings: dict[str, Any] = {"step": "1h", "scheme": "backward-euler"}
    found = run(building, climate, outputs, **settings)
    # The values of a step are those at its end; the record has none for the end of the last hour.
    states = found["night.open"][1:25]
    np.testing.assert_array_equal(states, [float(k % 6 < 3) for k in range(24)])
    path = "controls.night.minimum_open_time"
    in_turn = building.replace({path: None, "controls.night.minimum_closed_time": 0})
    states = run(in_turn, climate, outputs, **settings)["night.open"][1:25]
    np.testing.assert_array_equal(states, [1.0, 0.0] * 12)
    minutes = [0.0, 59.9, 60.1, 180.0, 240.0, 400.0]
    every = sweep(building, climate, {path: minutes}, outputs=outputs, initial=20.0, **settings)
    for member, time in enumerate(minutes):
        alone = run(building.replace({path: time}), climate, outputs, **settings)
        for name in outputs:
            assert every[name].to_numpy()[member].tobytes() == alone[name].to_numpy().tobytes(), (time, name)
    said = "outdoor 20 and 20, wind 5 and 7, open for at least 180 min, closed for at least 120 min"
    assert said in "\n".join(building.check())
    with pytest.raises(InputError, match=f"{path}: found 1600 min, longer than the run of 1500 min"):
        run(building.replace({path: 1600}), climate, outputs, **settings)


def test_controls_of_single_openings_and_schedules() -> None:
    """An opening without a network obeys as well; a schedule multiplies."""
    plain = controlled().to_dict()
    plain["openings"] = {"slot": {"zone": "a", "area": 0.2, "height": 0.4, "control": "night"}}
    plain["vents"]["windward"]["schedule"] = "half"
    plain["schedules"] = {"half": {"kind": "fraction", "value": 0.5}}
    plain["vents"].pop("door")
    results = run(Building.from_dict(plain), weather(), ["a.air_changes", "night.open", "windward.open"])
    is_open = results["night.open"] > 0
    assert (results["a.air_changes"][~is_open] < 1e-3).all()
    assert (results["a.air_changes"][is_open] > 1.0).all()
    np.testing.assert_array_equal(results["windward.open"], 0.5 * is_open)


def test_vapour_travels_with_the_air() -> None:
    """A source in the first room dampens the second one behind it; the vapour balance closes."""
    humidity = {"zones": {"a": {"gains": {"people": {"rate": 1e-5}}}}}
    climate = weather(air_temperature=20.0, hours=25)
    results = run(rooms(humidity=humidity), climate)
    flow = density(rooms().site) * last(results, "windward.inflow")
    ratios = [last(results, f"{zone}.humidity_ratio") for zone in "ab"]
    assert ratios[0] == pytest.approx(ratios[1], rel=1e-6)
    dry = last(run(rooms(humidity={}), climate), "b.humidity_ratio")
    assert ratios[1] - dry == pytest.approx(1e-5 / flow, rel=1e-3)
    assert results.vapour is not None
    assert results.vapour.closes


def test_derivatives_of_a_controlled_network() -> None:
    """Of a temperature and a flow, by every number: in reverse as forward, and as central differences."""
    times = {"minimum_open_time": 80, "minimum_closed_time": 50}  # no whole steps
    building = controlled(indoor={"open": 22, "close": 19}, **times).replace({"vents.door.height": 2.0})
    simulation = Simulation(
        building,
        weather(25),
        step="30min",
        outputs=["b.air_temperature", "windward.inflow", "door.inflow"],
        initial=20.0,
    )
    reverse, forward = both_ways(simulation)
    np.testing.assert_allclose(reverse, forward, rtol=0.0, atol=1e-9 * np.abs(forward).max())
    # The wind blows along the normal of one wall and from behind the other: the angle has a corner there.
    assert set(misses(simulation)) <= {"surfaces.north.azimuth", "surfaces.south.azimuth"}


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (
            {"absent": {"wind_speed": 0.0}},
            r"no wind in the whole record.*windward and 1 more.*absent: \{wind_speed: 2\}.*pressure: none",
        ),
        ({"absent": {"wind_direction": 0.0}}, r"no direction of the wind.*wind_direction: 225"),
    ],
)
def test_a_climate_without_wind_is_refused(columns: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=f"(?s){said}"):
        run(rooms(), weather(**columns))
    sheltered = rooms().to_dict()
    for name in ("windward", "leeward"):
        sheltered["vents"][name]["pressure"] = "none"
    assert run(Building.from_dict(sheltered), weather(**columns), ["a.air_temperature"]).energy.closes


def test_a_measured_calm_is_that_of_openings_without_wind() -> None:
    high = rooms().replace({"vents.leeward.elevation": 3.5}).to_dict()
    calm = run(Building.from_dict(high), weather(25, wind_speed=0.0))
    sheltered = dict(high)
    for name in ("windward", "leeward"):
        sheltered["vents"][name]["pressure"] = "none"
    stack = run(Building.from_dict(sheltered), weather(25, wind_speed=0.0))
    assert np.array_equal(calm.records, stack.records)
    assert abs(last(calm, "windward.inflow") - last(calm, "windward.outflow")) > 0.01


def test_a_wall_with_corners_is_as_steep_as_they_say() -> None:
    house = mc.load(examples.FOLDER / "reunion_house" / "building.yaml")
    said = "zone 'living' and outdoors"
    with pytest.raises(InputError, match=said):
        house.replace({"vents.living_north_jalousie.surface": "bedroom_north"})
    with pytest.raises(InputError, match=r"low_rise in 'roof_north' of tilt 27\.4"):
        house.replace({"vents.living_north_jalousie.surface": "roof_north",
                       "vents.living_north_jalousie.zone": "attic"})  # fmt: skip


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"vents.windward.pressure": None}, "no 'pressure' of an opening to outdoors"),
        ({"vents.windward.surface": None}, "no direction of an opening that the wind reaches"),
        ({"vents.windward.surface": "south"}, "a surface between zone 'a' and outdoors"),
        ({"vents.windward.surface": "nort"}, "Did you mean 'north'"),
        ({"vents.door.azimuth": 90}, "no wind reaches it"),
        ({"vents.door.between": ["a", "a"]}, "two different zones"),
        ({"vents.door.zone": "a"}, "both 'zone' and 'between'"),
        ({"vents.windward.control": "day"}, "the name of a control under 'controls:'"),
        ({"controls.night.indoor": {"open": 20, "close": 22}}, "'open' at least as large as 'close'"),
        ({"controls.night.wind": {"open": 8, "close": 6}}, "'open' at most as large as 'close'"),
        ({"controls.night": {"zone": "a"}}, "a control without conditions"),
        ({"controls.night.minimum_open_time": -5}, "minimum_open_time"),
        ({"controls.night.minimum_closed_time": 2e4}, "10080"),
        ({"surfaces.north.tilt": 20}, "the correlation holds for vertical surfaces"),
    ],
)
def test_refusals(change: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as error:
        controlled().replace(change)
    assert said in str(error.value)


def test_a_missing_rain_column_is_refused() -> None:
    building = controlled(rain={"column": "rain"})
    with pytest.raises(InputError, match="rain"):
        run(building, weather())


def test_words_and_sources() -> None:
    building = controlled()
    lines = "\n".join(building.check())
    assert (
        "vent windward: 0.5 m2 from a to outdoors at 1.5 m, wind pressure low_rise, by control night" in lines
    )
    assert "control night in a opens and closes at indoor 24 and 21, wind 5 and 7" in lines
    assert any("Swami & Chandra" in source for source in building.sources())
