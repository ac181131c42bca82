"""Blinds and measured irradiance of windows: by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Blind, Building
from mascarin.building.checks.overview import check
from mascarin.building.parameters.sources import sources
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from simulation_samples import hours
from test_simulation_zones import box, dark, last

AREA = 2.0
#: Both surface coefficients and the pane [m2 K/W].
BARE = 1 / 13 + 0.004 / 1.0 + 1 / 2.4
#: Diffuse optics of the glass from both sides.
GLASS = {"transmittance": 0.6, "absorptance": [0.15]}
SCREEN = {
    "transmittance": 0.2,
    "reflectance": 0.5,
    "resistance": 0.25,
    "emissivity": 0.84,
    "schedule": "down",
}


def room(blind: dict[str, Any] | None, held: Any = 20, outside: dict[str, Any] | None = None) -> Building:
    """A room of light walls and one pane, without long-wave radiation."""
    none = {"kind": "none"}
    facade = {
        "construction": "wall", "area": 5, "tilt": 90, "azimuth": 0,
        "outside": {
            "outdoors": True, "convection": 20, "emissivity": 0.9, "absorptance": 0.6, "longwave": none
        },
        "inside": {"zone": "room", "convection": 4, "absorptance": 0.5},
    }  # fmt: skip
    wall = {
        "construction": "wall", "area": 30, "tilt": 90, "azimuth": 0,
        "outside": {"measured": "yard", "convection": 20},
        "inside": {"zone": "room", "convection": 4, "absorptance": 0.5},
    }  # fmt: skip
    angles = [0, 60, 90]
    table = {
        "angles": angles,
        "transmittance": [0.7, 0.5, 0],
        "absorptance": [[0.1, 0.1, 0]],
        "diffuse": GLASS,
    }
    pane = {"thickness": 0.004, "conductivity": 1, "emissivity": 0.84}
    window = {
        "surface": "facade", "glazing": "pane", "area": AREA, "inside": {"convection": 2.4},
        "outside": {"convection": 13, "longwave": none} | (outside or {}),
    }  # fmt: skip
    zone = {"infiltration": 0} | ({"held": held} if held is not None else {})
    more: dict[str, Any] = {
        "glazings": {"pane": {"kind": "panes", "panes": [pane], "gaps": [], "angular": table}},
        "windows": {"pane": window | ({"blind": blind} if blind else {})},
        "schedules": {"down": {"kind": "fraction", "column": "closed"}} if blind else {},
        "surfaces": {"facade": facade, "wall_room": wall},
    }
    return box({"room": zone}, **more)


def night(building: Building, closed: float = 1.0, **columns: float) -> Results:
    level = np.ones(len(hours(3)))
    extra: dict[str, Any] = {name: value * level for name, value in columns.items()}
    climate = dark(0 * level, closed=closed * level, **extra)
    return simulate(building, climate, step="1h", outputs=[one.name for one in building.outputs()])


def overcast(diffuse: float, **columns: Any) -> Climate:
    """Two days with diffuse radiation from 10 to 14 o'clock [W/m2], and other columns."""
    index = pd.date_range("2001-01-01", periods=49, freq="1h", tz="UTC")
    level = np.ones(len(index))
    sun = diffuse * ((index.hour > 9) & (index.hour < 15))
    channels = {"air_temperature": 0 * level, "dew_point": -5 * level, "cloud_cover": 10 * level}
    channels |= {"wind_speed": level, "wind_direction": 0 * level}
    channels |= {"direct_normal": 0 * level, "diffuse_horizontal": np.asarray(sun)}
    extra = {"yard": 0 * level} | {name: value * level for name, value in columns.items()}
    return Climate.from_table(
        pd.DataFrame(channels | extra, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        extra=list(extra),
        instant=[*channels, *extra],
    )


def day(building: Building, step: str = "1h", **columns: Any) -> Results:
    names = [one.name for one in building.outputs()]
    return simulate(building, overcast(200.0, **columns), step=step, outputs=names)


def noon(results: Results, name: str) -> float:
    return float(results[name].sel(time="2001-01-02 12:00Z"))


@pytest.mark.parametrize("position", ["outside", "inside"])
@pytest.mark.parametrize("closed", [0.0, 0.5, 1.0])
def test_the_resistance_of_a_blind(position: str, closed: float) -> None:
    """In proportion to the closed part; an open blind adds 1e-3 m2 K/W."""
    load = [
        last(night(room(blind), closed), "room.net_load") for blind in (None, SCREEN | {"position": position})
    ]
    expected = 20 * AREA * (1 / BARE - 1 / (BARE + 1e-3 + closed * 0.25))
    assert load[0] - load[1] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("position", "part"),
    [
        # t T/(1 - r R) in both cases for diffuse radiation; R = 1 - 0.6 - 0.15.
        ("outside", 0.2 * 0.6 / (1 - 0.5 * 0.25)),
        ("inside", 0.6 * 0.2 / (1 - 0.5 * 0.25)),
    ],
)
def test_the_sun_behind_a_blind(position: str, part: float) -> None:
    """Nothing is lost: the ledger closes with what the blind absorbs."""
    building = room(SCREEN | {"position": position})
    results = day(building, closed=1.0)
    incident = noon(results, "pane.incident_solar")
    assert incident > 50
    # A table has its own mean for the bright horizon; isotropic light has none.
    flat = building.replace({"site.diffuse": "isotropic"})
    results = day(flat, closed=1.0)
    assert noon(results, "pane.transmitted_solar") == pytest.approx(
        AREA * noon(results, "pane.incident_solar") * part, rel=1e-9
    )
    assert results.energy.closure < 1e-12
    bare, open_blind = day(room(None).replace({"site.diffuse": "isotropic"})), day(flat, closed=0.0)
    for name in ("pane.transmitted_solar", "pane.absorbed_solar"):
        assert noon(open_blind, name) == pytest.approx(noon(bare, name), rel=1e-12)


def test_the_air_behind_an_inner_blind_carries_heat_into_the_room() -> None:
    """Of what the blind absorbs, the part (1 - to_air) divides between the room and outdoors, the rest stays.

    The blind is 2.4 W/(m2 K) from the room, and through its resistance, the pane and 13 W/(m2 K) from
    outdoors.
    """
    outwards = 1 / (0.25 + 1e-3 + 0.004 + 1 / 13)
    lost = outwards / (outwards + 2.4)
    absorbed = 0.6 * 0.3 / (1 - 0.5 * 0.25)
    loads, incident = {}, 0.0
    for part in (0.0, 0.4, 1.0):
        building = room(SCREEN | {"position": "inside", "to_air": part})
        # In steps of 15 min the panes are in their steady state at noon.
        results = day(building.replace({"site.diffuse": "isotropic"}), step="15min", closed=1.0)
        loads[part], incident = noon(results, "room.net_load"), noon(results, "pane.incident_solar")
        assert results.energy.closure < 1e-12
    for part in (0.4, 1.0):
        expected = AREA * incident * absorbed * lost * part
        assert loads[0.0] - loads[part] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("u_value", [1.1, 2.8, 5.8])
def test_the_share_of_the_air_behind_a_blind_by_the_standard(u_value: float) -> None:
    """The upper end of the range loses what EN 13363-1 loses with 0.08 m2 K/W: U/(U + 30)."""
    blind = Blind(position="inside", transmittance=0.1, reflectance=0.6, resistance=0.08)
    assert blind.to_air is not None
    outwards = 1 / (0.08 + 1 / u_value - 1 / 7.7)
    lost = (1 - blind.to_air.plausible[1]) * outwards / (outwards + 7.7)
    assert lost == pytest.approx(u_value / (u_value + 30), abs=0.012)


@pytest.mark.parametrize(("outdoors", "speed"), [(20.0, 0.2), (20.0, 0.3), (4.5, 0.2), (4.5, 0.3)])
def test_the_share_of_the_air_behind_a_blind_by_its_flow(outdoors: float, speed: float) -> None:
    """ISO 15099 for a gap of 50 mm, 1.5 m high, behind a single pane or two: the default is about it.

    Films of the gap 2 h + 4 v with h = 1.2 W/(m2 K); radiation 4 W/(m2 K) to the glass and 4.5 to the room,
    3.1 W/(m2 K) from blind to room.
    """
    film = 2 * 1.2 + 4 * speed
    flow = 1200 * speed * 0.05 / 1.5  # [W/(m2 K)], of the window
    carried = flow * (1 - np.exp(-2 * film / flow))  # from the mean of both faces to the room
    gap = 1 / (1 / carried - 1 / (2 * film))
    between, to_room = film**2 / (2 * film + gap) + 4, film * gap / (2 * film + gap)
    balance = np.array([[between + to_room + 7.6, -between], [-between, between + to_room + outdoors]])
    lost = outdoors * np.linalg.solve(balance, [1.0, 0.0])[1]
    closed = 1 / (0.08 + 1 / outdoors)
    share = 1 - lost / (closed / (closed + 7.6))
    assert 0.35 < share < 0.6


def test_a_blind_that_radiation_closes() -> None:
    control = SCREEN | {"position": "outside", "radiation": 30.0}
    results = day(room(control), closed=1.0)
    assert noon(results, "pane.solar_transmittance") < 0.2
    bright = day(room(control | {"radiation": 1000}), closed=1.0)
    assert noon(bright, "pane.solar_transmittance") > 0.5


def test_a_measured_irradiance_of_a_window() -> None:
    """It scales all parts of the radiation: what is transmitted follows in proportion."""
    modelled = day(room(None))
    measured = day(room(None, outside={"irradiance": "G"}), G=150.0)
    assert noon(measured, "pane.incident_solar") == pytest.approx(150.0)
    factor = 150.0 / noon(modelled, "pane.incident_solar")
    transmitted = noon(modelled, "pane.transmitted_solar")
    assert noon(measured, "pane.transmitted_solar") == pytest.approx(factor * transmitted, rel=1e-6)


@pytest.mark.parametrize("position", ["outside", "inside"])
def test_slopes_agree_with_differences(position: str) -> None:
    building = room(
        SCREEN | {"position": position, "cover": 0.9}, held={"column": "T_room", "radiative": 0.3}
    )
    climate = overcast(300.0, closed=0.6, T_room=20 + np.sin(np.arange(49) / 5))
    simulation = Simulation(building, climate, step="1h", outputs=["room.net_load"])
    paths = [f"windows.pane.blind.{key}" for key in ("transmittance", "reflectance", "resistance", "cover")]
    paths += ["windows.pane.blind.to_air"] if position == "inside" else []
    paths += ["zones.room.heating.radiative", "surfaces.wall_room.inside.convection.coefficient"]
    slopes = simulation.gradient(Mean("room.net_load")).slopes
    for path in paths:
        value = building.parameter(path).value
        step = 1e-4 * value
        high, low = (
            float(simulation.run({path: value + sign * step})["room.net_load"].mean()) for sign in (1, -1)
        )
        assert slopes[path] == pytest.approx((high - low) / (2 * step), rel=5e-4, abs=1e-6), path


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "without properties": ({"position": "outside"}, "transmittance"),
    "between the panes": (SCREEN | {"position": "between"}, "one of outside, inside"),
    "more than all": (SCREEN | {"position": "outside", "transmittance": 0.6}, "a sum of at most 1"),
    "an unknown schedule": (SCREEN | {"position": "outside", "schedule": "dawn"}, "'dawn'"),
    "no resistance": (
        {"position": "outside", "transmittance": 0, "reflectance": 0.5},
        "'shutter_resistance' and 'air_permeability'",
    ),
    "air of outdoors": (SCREEN | {"position": "outside", "to_air": 0.5}, "a blind in the room only"),
    "slats": (SCREEN | {"position": "outside", "slats": 0.1}, "at the angle in use"),
}


@pytest.mark.parametrize("case", WRONG)
def test_refusals(case: str) -> None:
    blind, words = WRONG[case]
    with pytest.raises(InputError) as error:
        room(blind)
    assert words in str(error.value), error.value
    assert "windows.pane.blind" in str(error.value)


def test_a_blind_is_one_of_the_parts() -> None:
    blind = Blind(position="inside", transmittance=0.1, reflectance=0.6, resistance=0.08)
    assert (
        room(blind.model_dump(exclude_none=True) | {"schedule": "down"})
        .parameter("windows.pane.blind.resistance")
        .unit
        == "m2 K/W"
    )


@pytest.mark.parametrize(
    ("permeability", "expected"),
    [("very_high", 0.08), ("high", 0.115), ("average", 0.165), ("low", 0.22), ("tight", 0.265)],
)
def test_the_resistance_of_a_shutter_by_its_permeability(permeability: Any, expected: float) -> None:
    """EN ISO 10077-1 for a shutter of 0.1 m2 K/W; it is a parameter like one that is given."""
    blind = {
        "position": "outside", "transmittance": 0, "reflectance": 0.6, "schedule": "down",
        "shutter_resistance": 0.1, "air_permeability": permeability,
    }  # fmt: skip
    building = room(blind)
    path = "windows.pane.blind.resistance"
    assert building.parameter(path).value == pytest.approx(expected)
    assert Building.from_dict(building.to_dict()) == building
    assert building.with_values({path: 0.5}).parameter(path).value == 0.5


def test_an_opaque_roller_lets_no_sun_in() -> None:
    """A transmittance of 0 outside: nothing passes and the panes absorb nothing, whatever the sun."""
    results = day(room(SCREEN | {"position": "outside", "transmittance": 0}), closed=1.0)
    assert noon(results, "pane.incident_solar") > 50
    assert noon(results, "pane.transmitted_solar") == 0.0
    absorbed = noon(results, "pane.absorbed_solar")
    assert absorbed == pytest.approx(0.5 * noon(results, "pane.incident_solar"), rel=1e-12)
    assert results.energy.closure < 1e-12


def test_the_check_names_blinds() -> None:
    lines = "\n".join(check(room(SCREEN | {"position": "outside", "radiation": 150})))
    assert "blind outside, closed as schedule down above 150 W/m2 on the window, transmits 20 %" in lines
    assert any("EN 13363-2" in source for source in sources(room(SCREEN | {"position": "inside"})))


def test_nothing_between_two_zones() -> None:
    """Neither a blind nor an irradiance: no sun of the climate reaches such a window."""
    building = room(SCREEN | {"position": "outside"}, outside={"irradiance": "G"})
    plain = building.to_dict()
    plain["zones"]["other"] = {"volume": 10}
    plain["surfaces"]["facade"]["outside"] = {"zone": "other", "convection": 4, "absorptance": 0.5}
    plain["surfaces"]["facade"]["outside"]["emissivity"] = 0.9
    del plain["windows"]["pane"]["outside"]["longwave"]
    with pytest.raises(InputError) as error:
        Building.from_dict(plain)
    for words in ("windows.pane.blind", "a blind of a window to outdoors", "windows.pane.outside.irradiance"):
        assert words in str(error.value)


@pytest.mark.parametrize("position", ["outside", "inside"])
def test_a_given_start_has_the_cells_of_the_engine(position: str) -> None:
    """The glass behind a blind is one more node; an open window starts along its resistance."""
    building = room(SCREEN | {"position": position}, held=None)
    results = simulate(
        building, overcast(0.0, closed=0.0), step="1h", end="2001-01-01 02:00",
        initial={"zones": {"room": 20}}, outputs=["pane.inside_temperature"],
    )  # fmt: skip
    assert 0.0 < float(results["pane.inside_temperature"][0]) < 20.0


def test_an_irradiance_in_kilowatts_is_refused_or_named() -> None:
    """A column of a window has the limits of an irradiance."""
    with pytest.raises(InputError, match="G"):
        day(room(None, outside={"irradiance": "G"}), G=5000.0)


def test_a_column_with_a_gap_or_missing_is_named() -> None:
    hollow = np.where(np.arange(49) == 30, np.nan, 1.0)
    with pytest.raises(InputError, match="closed"):
        day(room(SCREEN | {"position": "outside"}), closed=hollow)
    with pytest.raises(InputError, match="closed"):
        day(room(SCREEN | {"position": "outside"}))
