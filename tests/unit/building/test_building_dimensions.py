"""Dimensions of areas and thermal bridges, and conductances by destination, by hand."""

from __future__ import annotations

import json
from typing import Any

import pytest
import yaml

import mascarin as mc
from mascarin.building.checks.conductances import by_destination, conductances, totals
from mascarin.building.checks.u_values import described_u_value
from mascarin.building.heat_loss import heat_loss
from mascarin.cli import main
from mascarin.pages.view.page import render
from mascarin.physics import leakage_air_changes

TEXT = """\
name: two rooms
site: {latitude: 48, longitude: 11, altitude: 0, timezone: UTC+1, air_density: 1.2, air_specific_heat: 1000}
materials:
  wool: {conductivity: 0.04, density: 50, specific_heat: 1000}
constructions:
  wall: {layers: [{material: wool, thickness: 0.1}]}
zones:
  a: {volume: 30, longwave: none, infiltration: {blower_door: {kind: factor, n50: 2, factor: 0.1}}}
  b: {volume: 30, longwave: none, infiltration: 0.5}
surfaces:
  a_south:
    {construction: wall, area: 10, tilt: 90, azimuth: 180, outside: &out {outdoors: true, convection: 20,
     longwave: none, absorptance: 0.5}, inside: &a {zone: a, convection: 5}}
  a_north: {construction: wall, area: 10, tilt: 90, azimuth: 0, outside: *out, inside: *a}
  a_west: {construction: wall, area: 9, tilt: 90, azimuth: 270, outside: *out, inside: *a}
  a_floor: {construction: wall, area: 12, tilt: 180, outside: {measured: cellar, convection: 5}, inside: *a}
  a_roof: {construction: wall, area: 12, tilt: 0, outside: *out, inside: *a}
  partition:
    {construction: wall, area: 9, tilt: 90, azimuth: 90, outside: {zone: b, convection: 5}, inside: *a}
  b_south:
    {construction: wall, area: 10, tilt: 90, azimuth: 180, outside: *out, inside: &b {zone: b, convection: 5}}
  b_north: {construction: wall, area: 10, tilt: 90, azimuth: 0, outside: *out, inside: *b}
  b_east: {construction: wall, area: 9, tilt: 90, azimuth: 90, outside: *out, inside: *b}
  b_floor: {construction: wall, area: 12, tilt: 180, outside: {measured: cellar, convection: 5}, inside: *b}
  b_roof: {construction: wall, area: 12, tilt: 0, outside: *out, inside: *b}
"""
#: U value to outdoors, with 20 and 5 W/(m2 K); to the cellar and between zones, with 5 on both sides.
U_OUT, U_IN = 1.0 / (0.05 + 2.5 + 0.2), 1.0 / (0.2 + 2.5 + 0.2)


def described(**changes: Any) -> dict[str, Any]:
    tree: dict[str, Any] = yaml.safe_load(TEXT)
    for path, value in changes.items():
        *above, key = path.split("__")
        part = tree
        for step in above:
            part = part.setdefault(step, {})
        part[key] = value
    return tree


def building(**changes: Any) -> mc.Building:
    return mc.Building.from_dict(described(**changes))


def test_conductances_by_destination_are_those_by_hand() -> None:
    found = totals(conductances(building(zones__a__thermal_bridges={"edge": {"psi": 0.1, "length": 12}})))
    air = 1.2 * 1000.0 * 30.0 / 3600.0
    assert found["outdoors"] == pytest.approx(
        {
            "surface": 82.0 * U_OUT,
            "thermal bridge": 1.2,
            # A tenth of 2 1/h by the pressure test, and 0.5 1/h.
            "infiltration": air * (0.2 + 0.5),
        }
    )
    assert found["measured cellar"] == pytest.approx({"surface": 24.0 * U_IN})
    assert set(found) == {"outdoors", "measured cellar"}


def test_the_heat_loss_coefficient_has_the_pressure_test() -> None:
    room = building()
    assert heat_loss(room).destinations["infiltration"] == pytest.approx(10.0 * 0.7)
    rows = [
        conductance for conductance in conductances(room) if not conductance.destination.startswith("zone ")
    ]
    assert heat_loss(room).total == pytest.approx(sum(conductance.value for conductance in rows))


def test_a_pressure_test_by_stack_and_wind_is_the_law_of_the_engine() -> None:
    """The same numbers as in the engine's test: 0.12438 1/h at 20 K and 4 m/s."""
    numbers = {"n50": 2.2, "exponent": 0.65, "stack": 0.000145, "wind": 0.000174}
    expected = 2.2 * 0.08**0.65 * 10.0 * 0.15**0.5 * 0.005684**0.5
    assert leakage_air_changes("stack_wind", numbers, 4.0, 20.0) == pytest.approx(expected, rel=1e-5)
    assert leakage_air_changes("stack_wind", numbers, 4.0, -20.0) == pytest.approx(expected, rel=1e-5)
    with pytest.raises(mc.InputError, match="pressure test"):
        leakage_air_changes("unknown", numbers, 4.0, 20.0)


def test_partitions_and_air_between_zones_stand_once() -> None:
    paths = {"door": {"between": ["a", "b"], "flow": 0.01}}
    between = [
        conductance
        for conductance in conductances(building(air_paths=paths))
        if conductance.destination.startswith("zone ")
    ]
    assert {conductance.element: conductance.value for conductance in between} == pytest.approx(
        {"partition": 9.0 * U_IN, "door": 12.0}
    )


def test_check_and_view_show_the_same_conductances(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    room = building()
    lines = room.check()
    total = sum(
        conductance.value for conductance in conductances(room) if conductance.destination == "outdoors"
    )
    assert any(line.startswith(f"heat loss to outdoors: {total:.2f} W/K (surfaces ") for line in lines)
    assert any("infiltration 2.00 W/K" in line for line in lines if line.startswith("zone a:"))
    page = render(room)
    assert "Conductances by destination" in page
    assert f"{total:.2f}" in page
    (tmp_path / "room.yaml").write_text(TEXT, encoding="utf-8")
    assert main(["check", str(tmp_path / "room.yaml"), "--json"]) == 0
    table = json.loads(capsys.readouterr().out)["conductances"]
    assert sum(row["value"] for row in table if row["destination"] == "outdoors") == pytest.approx(total)
    assert by_destination(conductances(room))[0].element == "all"


@pytest.mark.parametrize(
    ("areas", "bridges", "refused"),
    [
        ("internal", "internal", False),
        ("external", "external", False),
        ("internal", "external", True),
        ("external", "internal", True),
        ("external", "any", False),
    ],
)
def test_a_mix_of_dimensions_is_refused(areas: str, bridges: str, refused: bool) -> None:
    edge = {"psi": 0.1, "length": 12, "dimensions": bridges}
    changes = {"dimensions": areas, "zones__a__thermal_bridges": {"edge": edge}}
    if refused:
        with pytest.raises(mc.InputError, match=f"{bridges} dimensions beside areas of {areas} dimensions"):
            building(**changes)
    else:
        assert any(f"dimensions: areas {areas}" in line for line in building(**changes).check())


def test_the_dimensions_of_one_surface_decide_for_its_zone() -> None:
    edge = {"edge": {"psi": 0.1, "length": 12}}
    stated = {"areas": "internal", "bridges": "internal"}
    changes: dict[str, Any] = {"dimensions": stated, "surfaces__a_roof__dimensions": "external"}
    with pytest.raises(mc.InputError, match=r"external dimensions \(a_roof\)"):
        building(**changes, zones__a__thermal_bridges=edge)
    building(**changes, zones__b__thermal_bridges=edge)  # the roof of the other zone is internal
    building(dimensions=stated, surfaces__partition__dimensions="external", zones__a__thermal_bridges=edge)


def test_a_bridge_of_other_dimensions_is_converted() -> None:
    """psi_e = psi_i - sum(U dA) / l: 12 m of 0.1 W/(m K) less 0.6 m2 of wall and 0.5 m2 of roof."""
    edge = {"psi": 0.1, "length": 12, "dimensions": "internal", "excess": {"a_south": 0.6, "a_roof": 0.5}}
    house = building(dimensions="external", zones__a__thermal_bridges={"edge": edge})
    bridge = house.zones["a"].thermal_bridges["edge"]
    assert described_u_value(house, house.surfaces["a_south"]) == pytest.approx(U_OUT)
    assert bridge.conductance == pytest.approx(1.2 - 1.1 * U_OUT)
    assert any("1.200 W/K in internal dimensions, converted to 0.800 W/K" in line for line in house.check())
    again = mc.Building.from_dict(house.to_dict())
    assert again == house


def test_a_converted_bridge_is_what_the_engine_has() -> None:
    """A run with the converted bridge is that with the external coefficient."""
    edge = {"psi": 0.1, "length": 12, "dimensions": "internal", "excess": {"a_south": 0.6, "a_roof": 0.5}}
    external = {"chi": 1.2 - 1.1 * U_OUT, "dimensions": "external"}
    from mascarin.examples import box_climate

    def temperatures(bridge: dict[str, Any]) -> Any:
        tree = described(dimensions="external", zones__a__thermal_bridges={"edge": bridge})
        for floor in ("a_floor", "b_floor"):
            tree["surfaces"][floor]["outside"] = {"ground": {"temperature": 12}, "convection": 5}
        return mc.simulate(mc.Building.from_dict(tree), box_climate(), step="1h").to_dataframe()[
            "a.air_temperature"
        ]

    assert temperatures(edge).to_numpy() == pytest.approx(temperatures(external).to_numpy(), abs=1e-9)
    unconverted = temperatures({"psi": 0.1, "length": 12, "dimensions": "external"})
    assert abs(unconverted - temperatures(edge)).max() > 0.01


@pytest.mark.parametrize(
    ("bridge", "message"),
    [
        ({"dimensions": "internal", "excess": {"a_suth": 0.6}}, "a_south"),
        ({"dimensions": "internal", "excess": {"b_south": 0.6}}, "through which this zone loses heat"),
        ({"dimensions": "internal", "excess": {"a_south": 60}}, "less than the 10.00 m2"),
        ({"dimensions": "external", "excess": {"a_south": 0.6}}, "two different dimensions"),
        ({"dimensions": "any", "excess": {"a_south": 0.6}}, "not stated or the same in all"),
        ({"dimensions": "external", "converted": 0.6}, "Remove 'converted:'"),
    ],
)
def test_conversions_that_cannot_be_made(bridge: dict[str, Any], message: str) -> None:
    with pytest.raises(mc.InputError, match=message):
        building(
            dimensions="external", zones__a__thermal_bridges={"edge": {"psi": 0.1, "length": 12, **bridge}}
        )


def test_facades_and_floors_that_do_not_close_are_named() -> None:
    def warned(**changes: Any) -> list[str]:
        return [line for line in building(**changes).check() if line.startswith("warning")]

    assert warned(dimensions="internal") == []
    south = warned(dimensions="internal", surfaces__a_south__area=13)
    assert len(south) == 1
    assert "20.00 m2 face north and 23.00 m2 face south, a difference of -3.00" in south[0]
    assert warned(surfaces__a_south__area=13) == []  # no dimensions are claimed
    floor = warned(dimensions="internal", surfaces__b_floor__area=11)
    assert len(floor) == 1
    assert "zones.b: a floor of 11.00 m2 below a ceiling of 12.00 m2" in floor[0]


def test_dimensions_that_are_not_stated_are_said() -> None:
    edge = {"edge": {"psi": 0.1, "length": 12}}
    lines = building(zones__a__thermal_bridges=edge).check()
    assert any(line.startswith("dimensions: not stated") for line in lines)
    lines = building(dimensions="internal", zones__a__thermal_bridges=edge).check()
    assert any("the dimensions of its coefficient are not stated" in line for line in lines)
    assert not any(line.startswith("dimensions") for line in building().check())


def test_windows_larger_than_their_facade_are_refused() -> None:
    sides = {"outside": {"convection": 20}, "inside": {"convection": 5}}
    window = {"surface": "a_south", "glazing": "glass", "area": 10.5, **sides}
    glass = {"kind": "simple", "u_value": 1.1, "solar_heat_gain": 0.5}
    with pytest.raises(
        mc.InputError, match=r"(?s)10.50 m2 of windows .*less than the 10.00 m2 of their wall"
    ):
        building(glazings={"glass": glass}, windows={"pane": window})
