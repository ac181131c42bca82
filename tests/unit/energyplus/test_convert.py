"""Models of EnergyPlus as buildings: parts with closed answers, input that is refused, the command."""

from __future__ import annotations

import contextlib
import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building.parts.air.flow_density import ConstantDensity
from mascarin.cli import main
from mascarin.energyplus import Conversion, convert
from mascarin.energyplus.envelope.constructions import inner_part
from mascarin.energyplus.envelope.convection import combined as combined_film
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.year import combined, constant, plain, year_of
from mascarin.errors import InputError

BOX = """\
Version,25.2;
Building,Box,{north},Suburbs,,,FullExterior;
GlobalGeometryRules,UpperLeftCorner,{entry},{system};
Site:Location,Somewhere,40,-75,-5,100;
Timestep,4;
RunPeriod,Year,1,1,,12,31,,Tuesday;
Material,Brick,Rough,0.2,0.8,1800,900,0.9,0.7,0.7;
Construction,Wall,Brick;
Zone,Room,{turn},{x},{y},{z};
"""
WALLS = {
    "South": ((0, 0, 3), (0, 0, 0), (4, 0, 0), (4, 0, 3)),
    "East": ((4, 0, 3), (4, 0, 0), (4, 5, 0), (4, 5, 3)),
    "North": ((4, 5, 3), (4, 5, 0), (0, 5, 0), (0, 5, 3)),
    "West": ((0, 5, 3), (0, 5, 0), (0, 0, 0), (0, 0, 3)),
    "Roof": ((0, 5, 3), (0, 0, 3), (4, 0, 3), (4, 5, 3)),
    "Floor": ((0, 0, 0), (0, 5, 0), (4, 5, 0), (4, 0, 0)),
}


def box(*extra: str, entry: str = "Counterclockwise", system: str = "Relative", **values: Any) -> str:
    """A brick box of 4 x 5 x 3 m as IDF; its floor lies on the ground."""
    given = {"north": 0, "turn": 0, "x": 0, "y": 0, "z": 0, **values}
    text = BOX.format(entry=entry, system=system, **given)
    for name, corners in WALLS.items():
        kind = name if name in ("Roof", "Floor") else "Wall"
        facing = "Ground" if name == "Floor" else "Outdoors"
        shown = corners if entry == "Counterclockwise" else corners[::-1]
        points = ",".join(",".join(map(str, corner)) for corner in shown)
        text += (
            f"BuildingSurface:Detailed,{name},{kind},Wall,ROOM,,{facing},,SunExposed,WindExposed,"
            f"autocalculate,4,{points};\n"
        )
    return text + "\n".join(extra)


def converted(tmp_path: Path, text: str, name: str = "box.idf") -> Conversion:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return convert(file)


def left_out(conversion: Conversion) -> list[str]:
    return [one.text() for one in conversion.findings if one.level == "left out"]


# --- parts with closed answers ------------------------------------------------------------------------------


def test_half_of_a_symmetric_wall_is_kept() -> None:
    materials = {
        "brick": {"conductivity": 0.8, "density": 1800, "specific_heat": 900},
        "wool": {"kind": "resistance", "resistance": 2.0},
    }
    one = inner_part([{"material": "brick", "thickness": 0.2}], materials)
    assert one == [{"material": "brick", "thickness": pytest.approx(0.1)}]
    sandwich: list[dict[str, Any]] = [
        {"material": "brick", "thickness": 0.1},
        {"material": "wool"},
        {"material": "brick", "thickness": 0.1},
    ]
    assert inner_part(sandwich, materials) == [{"material": "wool"}, {"material": "brick", "thickness": 0.1}]


def test_the_plane_without_heat_flow_by_its_integral() -> None:
    """Ramp on both surfaces: the flux at the plane is zero, by the temperatures of a fine mesh."""
    materials = {
        "a": {"conductivity": 1.5, "density": 2000, "specific_heat": 800},
        "b": {"conductivity": 0.1, "density": 400, "specific_heat": 1500},
    }
    layers = [{"material": "a", "thickness": 0.12}, {"material": "b", "thickness": 0.05}]
    kept = sum(layer["thickness"] for layer in inner_part(layers, materials))
    x = np.linspace(0.0, 0.17, 170001)
    middle = 0.5 * (x[1:] + x[:-1])
    k, c = np.where(middle < 0.12, 1.5, 0.1), np.where(middle < 0.12, 1.6e6, 6.0e5)
    held = np.concatenate([[0.0], np.cumsum(c * np.diff(x))])
    resistance = np.diff(x) / k
    start = float(np.sum(0.5 * (held[1:] + held[:-1]) * resistance) / np.sum(resistance))
    plane = float(np.interp(start, held, x))
    assert kept == pytest.approx(0.17 - plane, abs=1e-6)


def test_a_layer_on_an_adiabatic_surface_stores_as_much_as_in_energyplus(tmp_path: Path) -> None:
    text = box().replace("Floor,Wall,ROOM,,Ground", "Floor,Wall,ROOM,,Adiabatic")
    floor = converted(tmp_path, text).building.surfaces["Floor"]
    assert floor.outside.adiabatic
    layers = converted(tmp_path, text).building.constructions[floor.construction].layers
    assert [float(layer.thickness or 0.0) for layer in layers] == [pytest.approx(0.1)]


def test_directions_of_rectangles() -> None:
    for azimuth, tilt in (
        (180.0, 90.0),
        (90.0, 90.0),
        (0.0, 90.0),
        (225.0, 60.0),
        (180.0, 0.0),
        (90.0, 180.0),
    ):
        corners = g.rectangle(np.zeros(3), g.plane_of(azimuth, tilt), 3.0, 2.0)
        assert g.area_of(corners) == pytest.approx(6.0)
        assert g.tilt_of(corners) == pytest.approx(tilt, abs=1e-9)
        if 0.0 < tilt < 180.0:
            assert g.azimuth_of(corners) == pytest.approx(azimuth)
            assert corners[:2, 2] == pytest.approx(0.0)  # starts at the lower left corner


def test_zones_are_placed_and_turned(tmp_path: Path) -> None:
    """A building turned by 30 degrees with a zone turned by 60: the south wall faces 270."""
    found = converted(tmp_path, box(north=30, turn=60, x=10, y=0, z=1)).building
    south = found.surfaces["South"]
    assert south.vertices is not None
    assert float(south.azimuth or 0.0) == pytest.approx(270.0)
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert [float(v) for v in south.vertices[1]] == pytest.approx([10 * c, -10 * s, 1.0], abs=1e-6)
    world = converted(tmp_path, box(north=30, turn=60, x=10, system="World")).building.surfaces["South"]
    assert float(world.azimuth or 0.0) == pytest.approx(180.0)


def test_clockwise_corners_give_the_same_building(tmp_path: Path) -> None:
    clockwise = converted(tmp_path, box(entry="Clockwise")).building
    assert float(clockwise.surfaces["South"].azimuth or 0.0) == pytest.approx(180.0)
    assert float(clockwise.surfaces["Roof"].tilt or 0.0) == pytest.approx(0.0, abs=1e-6)
    assert float(clockwise.zones["Room"].volume or 0.0) == pytest.approx(60.0)


def test_a_year_of_two_schedules() -> None:
    night = ((0, 0.0), (480, 1.0), (1080, 0.0))
    off = ((0, 0.0),)
    week = (off, night, night, night, night, night, off, off)
    work = year_of([("12-31", week)])
    summer = year_of(
        [("04-30", (((0, 1.0),),) * 8), ("09-30", (((0, 2.0),),) * 8), ("12-31", (((0, 1.0),),) * 8)]
    )
    product = combined(lambda a, b: a * b, work, summer)
    made = plain(product, "fraction", [])
    assert [season["until"] for season in made["seasons"]] == ["04-30", "09-30", "12-31"]
    assert made["seasons"][1]["days"]["weekdays"][1] == {"at": "08:00", "value": 2}
    assert made["seasons"][1]["days"]["weekends"] == [{"at": "00:00", "value": 0}]
    assert work.mean() == pytest.approx(5 * 10 / (7 * 24))
    assert combined(lambda a, b: a + b, constant(1.0), constant(2.0)).constant == 3.0


def test_the_combined_coefficient_follows_its_quadratic() -> None:
    law = combined_film("smooth")["upward"]
    for wind in (1.0, 3.0, 6.0, 10.0):
        assert law["a"] + law["c"] * wind ** law["m"] == pytest.approx(10.22 + 3.1 * wind, rel=1e-3)
    bent = combined_film("medium_smooth")["upward"]
    assert bent["a"] + bent["c"] * 5.0 ** bent["m"] == pytest.approx(8.23 + 20.0 - 0.057 * 25.0, rel=0.01)


def test_schedules_and_gains(tmp_path: Path) -> None:
    """Lights of 2 W/m2 on 20 m2, half on weekday mornings until 30 April, and holidays by rule."""
    text = box(
        "RunPeriodControl:SpecialDays,Thanks,4th Thursday in November,1,Holiday;",
        "Schedule:Compact,On,,Through: 4/30,For: Weekdays,Until: 6:00,0,Until: 12:00,0.5,Until: 24:00,0,",
        "For: AllOtherDays,Until: 24:00,0,Through: 12/31,For AllDays,Until: 24:00,1;",
        "Lights,Lamps,Room,On,Watts/Area,,2,,0,0.4,0.2;",
    )
    found = converted(tmp_path, text)
    gain = found.building.zones["Room"].gains["Lamps"]
    assert float(gain.power or 0.0) == pytest.approx(40.0)
    assert float(gain.radiative) == pytest.approx(0.6)
    schedule = found.building.schedules[str(gain.schedule)]
    assert schedule.pieces(0)[1][:3] == (360.0, 720.0, 0.5)
    assert schedule.pieces(5) == [(0.0, 1440.0, 0.0, 0.0)]
    assert found.start == "2019-01-01"  # a Tuesday
    assert schedule.holidays == ("11-28",)


def test_infiltration_by_the_density_of_outdoor_air(tmp_path: Path) -> None:
    """0.5 air changes, as volumes of outdoor air, of the air of the zone, and of air of 20 degC at 100 m."""
    text = box("ZoneInfiltration:DesignFlowRate,Leaks,Room,,AirChanges/Hour,,,,0.5,1,0,0,0;")
    leaks = converted(tmp_path, text).building.zones["Room"].infiltration
    assert float(leaks.constant) == 0.5
    assert leaks.density is not None
    assert leaks.density.kind == "outdoors"
    for basis, kind in (("Indoor", "zone"), ("Standard", "constant")):
        found = converted(tmp_path, text.replace("0.5,1,0,0,0;", f"0.5,1,0,0,0,{basis};"))
        density = found.building.zones["Room"].infiltration.density
        assert density is not None
        assert density.kind == kind
    assert isinstance(density, ConstantDensity)
    altitude = float(found.building.site.altitude)
    # 101325 Pa exp(-z/8434 m)/(287 J/(kg K) 293.15 K)
    expected = 1.2043 * math.exp(-altitude / 8434.0)
    assert float(density.constant) == pytest.approx(expected, rel=2e-3)


def test_a_thermostat_by_its_control_type(tmp_path: Path) -> None:
    text = box(
        "Schedule:Constant,Twenty,,20;Schedule:Constant,Twentysix,,26;",
        "Schedule:Compact,Kind,,Through: 4/30,For: AllDays,Until: 24:00,1,",
        "Through: 12/31,For: AllDays,Until: 24:00,2;",
        "ThermostatSetpoint:SingleHeating,Heat,Twenty;ThermostatSetpoint:SingleCooling,Cool,Twentysix;",
        "ZoneControl:Thermostat,Control,Room,Kind,ThermostatSetpoint:SingleHeating,Heat,"
        "ThermostatSetpoint:SingleCooling,Cool;",
        "ZoneHVAC:EquipmentConnections,Room,Equipment,In,,Node,Out;",
        "ZoneHVAC:EquipmentList,Equipment,SequentialLoad,ZoneHVAC:IdealLoadsAirSystem,Ideal,1,1;",
        "ZoneHVAC:IdealLoadsAirSystem,Ideal,,In,,,50,13,0.01,0.01,LimitCapacity,,2000,NoLimit;",
    )
    building = converted(tmp_path, text).building
    zone = building.zones["Room"]
    assert zone.heating is not None
    assert zone.cooling is not None
    heating = building.schedules[str(zone.heating.setpoint.schedule)]
    cooling = building.schedules[str(zone.cooling.setpoint.schedule)]
    assert [heating.pieces(0, season=k)[0][2] for k in (0, 1)] == [20.0, -50.0]
    assert [cooling.pieces(0, season=k)[0][2] for k in (0, 1)] == [80.0, 26.0]
    assert float(zone.heating.capacity or 0.0) == 2000.0
    assert zone.cooling.capacity is None


def test_an_overhang_over_a_window(tmp_path: Path) -> None:
    text = box(
        "WindowMaterial:SimpleGlazingSystem,Glass,2.0,0.5;Construction,Glazing,Glass;",
        "Window,Pane,Glazing,South,,1,1,0.8,2,1.5;",
        "Shading:Overhang,Roofing,Pane,0.2,90,0.1,0.3,0.6;",
    )
    building = converted(tmp_path, text).building
    assert float(building.windows["Pane"].area or 0.0) == pytest.approx(3.0)
    corners = building.shades["Roofing"].vertices
    assert [[float(c) for c in p] for p in corners] == [
        pytest.approx([0.9, 0.0, 2.5]),
        pytest.approx([3.3, 0.0, 2.5]),
        pytest.approx([3.3, -0.6, 2.5]),
        pytest.approx([0.9, -0.6, 2.5]),
    ]
    assert building.zones["Room"].sun is not None


def test_a_window_behind_its_wall_keeps_what_stands_in_front_of_its_glass(tmp_path: Path) -> None:
    """0.2 m behind the south wall, below a shade of the wall that reaches 0.5 m out of it."""
    found = converted(
        tmp_path,
        box(
            "WindowMaterial:SimpleGlazingSystem,Glass,2.0,0.5;Construction,Glazing,Glass;",
            "FenestrationSurface:Detailed,Pane,Window,Glazing,South,,,,1,4,"
            "1,0.2,2.5,1,0.2,0.5,3,0.2,0.5,3,0.2,2.5;",
            "Shading:Zone:Detailed,Slab,South,,4,0.5,-0.5,2.7,0.5,0,2.7,3.5,0,2.7,3.5,-0.5,2.7;",
        ),
    )
    window = found.building.windows["Pane"]
    assert window.vertices is not None
    assert {float(corner[1]) for corner in window.vertices} == {0.0}
    assert float(window.area or 0.0) == pytest.approx(4.0)
    shades = {name: np.array(one.vertices, dtype=float) for name, one in found.building.shades.items()}
    reveal = [corners for name, corners in shades.items() if name != "Slab"]
    assert sum(map(g.area_of, reveal)) == pytest.approx(0.2 * 8.0)
    assert all(corners[:, 1].min() == -0.2 and corners[:, 1].max() == 0.0 for corners in reveal)
    # From the glass the slab reaches from 0.2 to 0.7 m, as in the file.
    assert (shades["Slab"][:, 1].min(), shades["Slab"][:, 1].max()) == pytest.approx((-0.7, -0.2))
    assert any("0.200 m behind the plane of its wall" in one.what for one in found.findings)


def test_a_frame_lies_around_the_glass(tmp_path: Path) -> None:
    text = box(
        "WindowMaterial:SimpleGlazingSystem,Glass,2.0,0.5;Construction,Glazing,Glass;",
        "WindowProperty:FrameAndDivider,Wood,0.1,,,4,1.2,0.7,0.7,0.9;",
        "Window,Pane,Glazing,South,Wood,1,1,0.8,2,1;",
    )
    window = converted(tmp_path, text).building.windows["Pane"]
    assert window.frame is not None
    assert float(window.area or 0.0) == pytest.approx(2.2 * 1.2)
    assert float(window.frame.fraction) == pytest.approx(1.0 - 2.0 / 2.64)
    assert float(window.frame.u_value) == pytest.approx(1.0 / (0.25 + 0.17))


def test_nothing_is_dropped_in_silence(tmp_path: Path) -> None:
    text = box(
        "WaterHeater:Mixed,Tank,0.2;",
        "Daylighting:Controls,Dimming,Room,SplitFlux;",
        "RunPeriodControl:DaylightSavingTime,4/1,10/1;",
        "Output:Variable,*,Zone Mean Air Temperature,Hourly;",
    )
    found = converted(tmp_path, text)
    words = " ".join(left_out(found))
    assert "Daylighting:Controls 'Dimming'" in words
    assert "RunPeriodControl:DaylightSavingTime" in words
    assert not found.complete
    kinds = {one.kind for one in found.findings}
    assert {"WaterHeater:Mixed", "Output:Variable"} <= kinds


# --- input that is refused ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            box("Schedule:Compact,A,,Through: 12/31,For: AllDays,Until: 24:00,nan;"),
            "A': data 4: field: found nan; expected a finite number",
        ),
        (
            box("Schedule:Constant,A,,1e308;"),
            "box.idf:16: Schedule:Constant 'A': hourly_value: found 1e\\+308",
        ),
        (
            box("MaterialProperty:PhaseChange,Brick,0,-20,0,20,Wall;"),
            "values 2: enthalpy: found 'Wall'; expected a",
        ),
        (
            box().replace("Year,1,1,,12,31", "Year,4,31,,12,31"),
            r"box\.idf:6: RunPeriod 'Year': found the day 4/31",
        ),
        (
            box().replace("Year,1,1,,12", "Year,1,1,3000,12"),
            "'Year': begin_year: found 3000; expected a year",
        ),
        (box("RunPeriod,B,13,1,,12,31,,Tuesday;"), "'B': begin_month: found 13; expected at most 12"),
    ],
)
def test_numbers_that_energyplus_refuses(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        converted(tmp_path, text)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("Zone,Room", "Zoone,Room"), r"box\.idf:9: Zoone 'Room': Unknown object type"),
        (("Version,25.2;", "Version,7.2;"), r"version 7\.2; expected 8\.9 to 26\.2"),
        (("Version,25.2;", "Version,99.1;"), r"version 99\.1; expected 8\.9 to 26\.2"),
        (("Version,25.2;", ""), r"found no Version object"),
        (("4,5,0,4,0,0;", "4,5,0"), r"box\.idf:15: found 'BuildingSurface:Detailed' without a semicolon"),
        (("Wall,Wall,ROOM", "Wall,Wall,"), r"box\.idf:10: BuildingSurface:Detailed 'South': found no zone"),
        (
            ("Wall,Wall,ROOM", "Wall,Wall,Rom"),
            r"found 'Rom'; expected the name of a Zone.*Did you mean 'Room'",
        ),
        (("Wall,Wall,ROOM", "Wall,Wal,ROOM"), r"found 'Wal'; expected the name of a Construction"),
        (("0.2,0.8,1800", "0.2,zero,1800"), r"box\.idf:7: Material 'Brick': conductivity: found 'zero'"),
        (("Construction,Wall,Brick", "Construction,Wall,Brik"), r"box\.idf:8: Construction 'Wall'.*'Brik'"),
        (("Construction,Wall,Brick", "Construction,Wall,"), r"box\.idf:8: Construction 'Wall': no layer"),
        (
            ("4,0,0,3,0,0,0,4,0,0,4,0,3", "2,0,0,3,0,0,0"),
            r"South.*vertices: found 2; expected at least 3",
        ),
        (("ROOM,,Outdoors,,Sun", "ROOM,,Space,,Sun"), r"outside_boundary_condition: found 'space'"),
        (("Site:Location", "!Site:Location"), r"found no Site:Location"),
    ],
)
def test_what_cannot_be_used_is_named_with_its_line(
    tmp_path: Path, change: tuple[str, str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        converted(tmp_path, box().replace(change[0], change[1], 1))


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "utf-8-sig"])
def test_names_that_are_not_ascii(tmp_path: Path, encoding: str) -> None:
    file = tmp_path / "box.idf"
    file.write_text(box().replace("Zone,Room", "Zone,Küche").replace("ROOM", "KÜCHE"), encoding=encoding)
    assert list(convert(file).building.zones) == ["Küche"]


def test_a_shipped_climate_gives_the_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A model without a place gets that of a climate of Mascarin; no file is refused with a remedy."""
    monkeypatch.chdir(tmp_path)
    text = "".join(line + "\n" for line in box().splitlines() if not line.startswith("Site:Location"))
    Path("box.idf").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="found no Site:Location"):
        convert("box.idf")
    site = convert("box.idf", weather="shipped:tampa").building.site
    assert (site.latitude, site.longitude) == pytest.approx((27.97, -82.53))
    assert main(["convert", "box.idf", "--weather", "shipped:tampa", "-o", "box.yaml"]) in (0, 1)
    assert mc.load("box.yaml").site.latitude == pytest.approx(27.97)
    capsys.readouterr()
    assert main(["convert", "box.idf", "--weather", "shipped:tamba", "-o", "no.yaml"]) == 2
    assert "Did you mean 'tampa'" in capsys.readouterr().err
    assert main(["convert", "box.idf", "--weather", "tampa.epw", "-o", "no.yaml"]) == 2
    assert "tampa.epw: no such file; expected a weather file (.epw)" in capsys.readouterr().err
    assert not Path("no.yaml").exists()


def test_missing_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nothing\.idf: found no such file; expected a model of EnergyPlus"):
        convert(tmp_path / "nothing.idf")
    with pytest.raises(InputError, match=r"expected \.idf or \.epJSON"):
        convert(tmp_path / "model.osm")
    (tmp_path / "broken.epJSON").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="expected epJSON"):
        convert(tmp_path / "broken.epJSON")
    text = box("Schedule:File,Hours,,hours.csv,1,0;", "Lights,Lamps,Room,Hours,LightingLevel,5;")
    with pytest.raises(InputError, match=r"Schedule:File 'Hours': file_name: found no file 'hours\.csv'"):
        converted(tmp_path, text)


def test_a_zone_that_is_not_convex(tmp_path: Path) -> None:
    """An L of two squares: view factors by areas, with rows that sum to one, and a finding."""
    outline = [(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)]
    text = box().split("BuildingSurface", maxsplit=1)[0]
    for k, (x, y) in enumerate(outline):
        u, v = outline[(k + 1) % 6]
        text += (
            f"BuildingSurface:Detailed,W{k},Wall,Wall,Room,,Outdoors,,SunExposed,WindExposed,0.5,4,"
            f"{x},{y},3,{x},{y},0,{u},{v},0,{u},{v},3;\n"
        )
    top = ",".join(f"{x},{y},3" for x, y in outline)
    low = ",".join(f"{x},{y},0" for x, y in outline[::-1])
    text += f"BuildingSurface:Detailed,Top,Roof,Wall,Room,,Outdoors,,SunExposed,WindExposed,0,6,{top};\n"
    text += f"BuildingSurface:Detailed,Low,Floor,Wall,Room,,Ground,,NoSun,NoWind,0,6,{low};\n"
    found = converted(tmp_path, text)
    factors = found.building.zones["Room"].view_factors
    assert factors is not None
    assert [sum(map(float, row.values())) for row in factors.values()] == pytest.approx([1.0] * 8, abs=1e-6)
    assert any(one.name == "Room" and "not convex" in one.what for one in found.findings)
    areas = {name: float(surface.area or 0.0) for name, surface in found.building.surfaces.items()}
    assert areas["W0"] * factors["W0"]["Top"] == pytest.approx(areas["Top"] * factors["Top"]["W0"], rel=1e-6)


# --- the command --------------------------------------------------------------------------------------------


def run(folder: Path, *words: str) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a command in this process."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main([*words])
    return code, out.getvalue(), err.getvalue()


def test_the_command_writes_a_file_that_is_read_again(tmp_path: Path) -> None:
    (tmp_path / "box.idf").write_text(box(), encoding="utf-8")
    code, _, said = run(tmp_path, "convert", "box.idf", "-o", "out.yaml")
    assert code == 0, said
    assert mc.load(tmp_path / "out.yaml") == convert(tmp_path / "box.idf").building
    assert run(tmp_path, "check", "out.yaml")[0] == 0


def test_the_exit_code_says_that_something_was_left_out(tmp_path: Path) -> None:
    text = box("ZoneEarthtube,Room,,0.1,10,20,1,Natural,0,1,0.15,0.002,20,1,3;")
    (tmp_path / "box.idf").write_text(text, encoding="utf-8")
    code, printed, _ = run(tmp_path, "convert", "box.idf", "--json")
    told = json.loads(printed)
    assert code == 1
    assert told["complete"] is False
    assert any(one["level"] == "left out" and one["class"] == "ZoneEarthtube" for one in told["findings"])
    assert told["names"]["zones"] == {"Room": "Room"}
    assert "ZoneEarthtube" in (tmp_path / "box.yaml").read_text(encoding="utf-8")
    (tmp_path / "bad.idf").write_text("Zone,Room;", encoding="utf-8")
    assert run(tmp_path, "convert", "bad.idf")[0] == 2


def test_minimal_shadowing_has_no_shadows_between_surfaces(tmp_path: Path) -> None:
    assert converted(tmp_path, box()).building.site.self_shading
    minimal = box().replace("FullExterior", "MinimalShadowing")
    assert not converted(tmp_path, minimal).building.site.self_shading
