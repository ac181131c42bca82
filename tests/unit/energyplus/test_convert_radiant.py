"""Electric mats in layers: heat sources, or ideal heating with the reason; water in layers: radiant loads."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.energyplus import Conversion, convert

SMALL = Path(__file__).resolve().parents[2] / "idf_small"
MAT = "ZoneHVAC:LowTemperatureRadiant:Electric"
#: A thermostat of the room, for which ideal heating takes the place of a mat.
THERMOSTAT = """
ZoneControl:Thermostat,room thermostat,room,dual,ThermostatSetpoint:DualSetpoint,points;
ThermostatSetpoint:DualSetpoint,points,heat20,cool26;
"""


def edited(tmp_path: Path, name: str, *edits: tuple[str, str], more: str = "") -> Conversion:
    """A small model with other words."""
    text = (SMALL / f"{name}.idf").read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "model.idf").write_text(text + more, encoding="utf-8")
    return convert(tmp_path / "model.idf")


def findings_of(conversion: Conversion) -> list[str]:
    """What is said of mats."""
    return [finding.what for finding in conversion.findings if finding.kind == MAT]


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("HeatingDesignCapacity,2000,", "HeatingDesignCapacity,autosize,", "sizes from design days"),
        ("MeanAirTemperature", "SurfaceInteriorTemperature", "turned by surfaceinteriortemperature"),
        ("room,room F,Heating", "room,room R,Heating", "without a plane"),
        ("Floor,radiant,room,,Ground,,", "Floor,radiant,room,,Adiabatic,,", "adiabatic"),
        ("src,radiant,2,2,1", "src,radiant,3,3,1", "after layer 3"),
    ],
)
def test_what_is_no_heat_source_is_ideal_heating(tmp_path: Path, old: str, new: str, reason: str) -> None:
    conversion = edited(tmp_path, "radiant_mat", (old, new), more=THERMOSTAT)
    assert not conversion.building.heat_sources
    assert any(reason in what for what in findings_of(conversion))
    assert "heating" in conversion.building.zones["room"].loads


def test_a_mat_beside_ideal_loads(tmp_path: Path) -> None:
    """The mat has its own set point; ideal loads bring what is left."""
    row = ("mat,1,1,,;", "mat,1,1,,,ZoneHVAC:IdealLoadsAirSystem,ideal,2,2;")
    ideal = "ZoneHVAC:IdealLoadsAirSystem,ideal,,room in;"
    conversion = edited(tmp_path, "radiant_mat", row, more=THERMOSTAT + ideal)
    assert list(conversion.building.heat_sources) == ["mat"]
    assert set(conversion.building.zones["room"].loads) == {"heating", "cooling"}
    assert findings_of(conversion) == []


def test_a_control_by_operative_temperature_is_noted(tmp_path: Path) -> None:
    conversion = edited(tmp_path, "radiant_mat", ("MeanAirTemperature", "OperativeTemperature"))
    assert conversion.building.heat_sources
    assert findings_of(conversion) == ["a control by operativetemperature"]


def test_a_narrow_range_is_that_of_energyplus(tmp_path: Path) -> None:
    conversion = edited(tmp_path, "radiant_group", ("ZeroFlowPower,1,", "ZeroFlowPower,0,"))
    thermostat = conversion.building.heat_sources["mats_b_W"].thermostat
    assert thermostat is not None
    assert float(thermostat.range) == 0.5
    assert float(thermostat.setpoint.temperature or 0.0) == 19.75


def test_a_plane_without_a_mat_has_no_effect(tmp_path: Path) -> None:
    conversion = edited(tmp_path, "internal_source")
    assert conversion.complete
    levels = {f.level for f in conversion.findings if f.kind == "ConstructionProperty:InternalHeatSource"}
    assert levels == {"no effect"}


def test_older_versions_state_the_plane_with_the_construction(tmp_path: Path) -> None:
    older = (
        ("Version,25.2", "Version,9.0"),
        ("Construction,radiant,insulation,concrete,board;", ""),
        ("ConstructionProperty:InternalHeatSource,src,radiant,2,2,1,0.15,0;",
         "Construction:InternalSource,radiant,2,2,1,0.15,insulation,concrete,board;"),
        (",MeanAirTemperature,HalfFlowPower,2,", ",MeanAirTemperature,2,"),
        ("PolygonClipping,Periodic,1", "AverageOverDaysInFrequency,1"),
    )  # fmt: skip
    text = (
        (SMALL / "radiant_mat.idf")
        .read_text(encoding="utf-8")
        .replace("Floor,radiant,room,,", "Floor,radiant,room,")
    )
    for old, new in older:
        assert old in text, old
        text = text.replace(old, new)
    for shape in ("Wall,wall", "Roof,wall"):
        text = text.replace(f"{shape},room,,", f"{shape},room,")
    (tmp_path / "model.idf").write_text(text, encoding="utf-8")
    conversion = convert(tmp_path / "model.idf")
    assert conversion.building.heat_sources["mat"].after == "concrete"


_MAT_IN_LIST = f"SequentialLoad,{MAT},mat,1,1,,;"
_VARIABLE = """
ZoneHVAC:LowTemperatureRadiant:VariableFlow,panel,design,,room,room {surface},,autosize,0.0001,a,b,autosize,
  0.0001,c,d;
ZoneHVAC:LowTemperatureRadiant:VariableFlow:Design,design,ConvectionOnly,0.013,0.016,0.35,{control},HalfFlowPower,
  HeatingDesignCapacity,,,2,heat20,CoolingDesignCapacity,,,2,cool26;
"""
_CONSTANT = """
Schedule:Constant,low,any,18;
Schedule:Constant,high,any,23;
Schedule:Constant,water,any,40;
ZoneHVAC:LowTemperatureRadiant:ConstantFlow,panel,design,,room,room F,,0.0004,,75000,50,a,b,water,
  water,high,low;
ZoneHVAC:LowTemperatureRadiant:ConstantFlow:Design,design;
"""


def _with_water(tmp_path: Path, kind: str, objects: str) -> Conversion:
    """The model of the mat, with water in its place."""
    text = (SMALL / "radiant_mat.idf").read_text(encoding="utf-8")
    own_line = next(line for line in text.splitlines() if line.strip().startswith(f"{MAT},mat"))
    listed = f"SequentialLoad,ZoneHVAC:LowTemperatureRadiant:{kind},panel,1,1,,;"
    return edited(tmp_path, "radiant_mat", (own_line, ""), (_MAT_IN_LIST, listed), more=objects)


@pytest.mark.parametrize(
    ("surface", "heating", "cooling"), [("F", 5.5 / 11.0, 5.5 / 7.0), ("R", 5.5 / 6.0, 5.5 / 11.0)]
)
def test_water_in_a_surface_is_a_radiant_load(
    tmp_path: Path, surface: str, heating: float, cooling: float
) -> None:
    """Without a thermostat, at its own set points; a floor radiates half of its heat (EN ISO 11855-2)."""
    objects = _VARIABLE.format(surface=surface, control="MeanAirTemperature")
    conversion = _with_water(tmp_path, "VariableFlow", objects)
    room = conversion.building.to_dict()["zones"]["room"]
    assert room["heating"]["radiative"] == pytest.approx(heating, abs=1e-6)
    assert room["cooling"]["radiative"] == pytest.approx(cooling, abs=1e-6)
    assert conversion.building.parameter("zones.room.cooling.setpoint.temperature").value == 26.0
    assert [f.what for f in conversion.findings if f.kind.endswith("VariableFlow")] == ["water in a surface"]


def test_water_of_constant_flow_is_turned_in_the_middle_of_its_range(tmp_path: Path) -> None:
    """From 18 degC, the warmest water, to 23 degC, none: 20.5 degC; and no cooling."""
    building = _with_water(tmp_path, "ConstantFlow", _CONSTANT).building
    assert set(building.zones["room"].loads) == {"heating"}
    assert building.parameter("zones.room.heating.setpoint.temperature").value == 20.5


def test_water_turned_by_something_else_is_left_out(tmp_path: Path) -> None:
    objects = _VARIABLE.format(surface="F", control="SurfaceFaceTemperature")
    conversion = _with_water(tmp_path, "VariableFlow", objects)
    assert not conversion.building.zones["room"].loads
    assert any("turned by surfacefacetemperature" in f.what for f in conversion.findings)
