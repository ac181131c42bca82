"""Foundations of Kiva: blocks of soil below slabs and around basements, and both programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mascarin.energyplus import Conversion, convert
from small_models import energyplus_small

HERE = Path(__file__).resolve().parents[2]
SMALL = HERE / "idf_small"
FLOOR = "BuildingSurface:Detailed,room F,Floor,slab,room,,Ground,,NoSun"
EXPOSED = "SurfaceProperty:ExposedFoundationPerimeter,room F,TotalExposedPerimeter,20;"
PLAIN = "Foundation:Kiva,foot;"


@pytest.fixture(scope="module")
def bench(data_dir: Path) -> Any:
    """The module that simulates a conversion by hours."""
    return energyplus_small()


def converted(
    tmp_path: Path,
    *changes: tuple[str, str],
    foundation: str = PLAIN,
    exposed: str = EXPOSED,
    weather: Path | None = None,
    name: str = "base_ideal",
) -> Conversion:
    """The plain box with a slab of concrete on a foundation."""
    text = (SMALL / f"{name}.idf").read_text(encoding="utf-8")
    for old, new in (
        ("Construction,slab,insulation,concrete;", "Construction,slab,concrete;"),
        (FLOOR, FLOOR.replace("Ground,,", "Foundation,foot,")),
        *changes,
    ):
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "model.idf"
    file.write_text("\n".join((text, foundation, exposed)), encoding="utf-8")
    return convert(file, weather=weather)


def block_of(conversion: Conversion) -> dict[str, Any]:
    (block,) = conversion.description["soil_blocks"].values()
    return dict(block)


def test_loads_above_a_foundation_are_those_of_energyplus(bench: Any, tmp_path: Path) -> None:
    # EnergyPlus 25.2, Chicago, a year: 1691 and 1854 kWh; 1068 and 322 on ground of 18 degC.
    loads = bench.simulated(converted(tmp_path, weather=bench.WEATHER))["room"].loads
    assert loads["heating"].sum() == pytest.approx(1691.0, rel=0.04)
    assert loads["cooling"].sum() == pytest.approx(1854.0, rel=0.01)


def test_loads_with_an_insulated_edge_are_those_of_energyplus(bench: Any, tmp_path: Path) -> None:
    # EnergyPlus 25.2, Chicago, a year: 1221 and 1778 kWh.
    edge = "Foundation:Kiva,foot,,,,,,,,,,insulation,0.8;"
    loads = bench.simulated(converted(tmp_path, foundation=edge, weather=bench.WEATHER))["room"].loads
    assert loads["heating"].sum() == pytest.approx(1221.0, rel=0.05)
    assert loads["cooling"].sum() == pytest.approx(1778.0, rel=0.055)


def test_soil_has_the_defaults_of_energyplus(bench: Any, tmp_path: Path) -> None:
    block = block_of(converted(tmp_path, weather=bench.WEATHER))
    assert (block["length"], block["width"], block["wall_thickness"]) == (5.0, 5.0, 0.05)
    # Without Foundation:Kiva:Settings. EnergyPlus 25.2 has the same results with settings of these numbers.
    assert (block["conductivity"], block["heat_capacity"]) == (0.864, 1510 * 1260)
    assert (block["absorptance"], block["emissivity"]) == (0.9, 0.9)
    # 0.1022 m of depth of the ground water for each of 201 m of altitude, at the mean of the weather file.
    assert block["depth"] == pytest.approx(20.542, abs=0.001)
    assert block["deep_temperature"] == pytest.approx(9.99, abs=0.01)
    assert "edge" not in block


def test_blank_fields_of_settings_have_the_defaults_of_the_schema(tmp_path: Path) -> None:
    block = block_of(converted(tmp_path, foundation=PLAIN + "Foundation:Kiva:Settings,,,,0.8;"))
    assert (block["conductivity"], block["heat_capacity"], block["absorptance"]) == (1.73, 1842 * 419, 0.8)


def test_ground_water_is_a_metre_below_the_slab_at_least(tmp_path: Path) -> None:
    # The slab of 0.15 m ends 0.05 m above the ground; 0.5 m of wall below it.
    site = ("Chicago,41.98,-87.92,-6,201", "Coast,41.98,-87.92,-6,1")
    deep = "Foundation:Kiva,foot,,,,,,,,,,,,0.2,0.5;"
    assert block_of(converted(tmp_path, site))["depth"] == 1.0
    assert block_of(converted(tmp_path, site, foundation=deep))["depth"] == pytest.approx(1.45)


@pytest.mark.parametrize(
    ("foundation", "psi"),
    [
        (PLAIN, 0.2 / (1.18 + 0.154)),
        ("Foundation:Kiva,foot,,,,,,,,,,,,0.4;", 0.4 / (1.18 + 0.154)),
        ("Foundation:Kiva,foot,,,,,,,,,,insulation,0.8;", 0.2 / (1.18 + 0.154 + 2.5)),
        # Concrete, insulation, board.
        ("Foundation:Kiva,foot,,,,,,,,,,,,0.2,,wall;", 0.2 / (1.18 + 0.15 / 1.4 + 2.5 + 0.0125 / 0.25)),
    ],
)
def test_the_wall_above_the_ground_is_a_bridge(tmp_path: Path, foundation: str, psi: float) -> None:
    (bridge,) = (
        converted(tmp_path, foundation=foundation).description["zones"]["room"]["thermal_bridges"].values()
    )
    assert bridge["psi"] == pytest.approx(psi, abs=1e-4)
    assert bridge["length"] == 20.0


def test_a_slab_level_with_the_ground_has_no_bridge(tmp_path: Path) -> None:
    conversion = converted(tmp_path, foundation="Foundation:Kiva,foot,,,,,,,,,,,,0.0;")
    assert "thermal_bridges" not in conversion.description["zones"]["room"]


def test_concrete_outside_of_insulation_stores_nothing(bench: Any, tmp_path: Path) -> None:
    # The soil instead does. EnergyPlus 25.2 has 1268 and 2174 kWh. With both, the start did not converge.
    on_foundation = FLOOR.replace("Ground,,", "Foundation,foot,")
    floor = (on_foundation, on_foundation.replace("slab,", "wall,"))
    conversion = converted(tmp_path, floor, weather=bench.WEATHER)
    layers = conversion.description["constructions"]["wall_on_soil"]["layers"]
    material = conversion.description["materials"][layers[0]["material"]]
    assert material == {"kind": "resistance", "resistance": pytest.approx(0.15 / 1.4, abs=1e-6)}
    assert [layer["material"] for layer in layers[1:]] == ["insulation", "board"]
    plain = conversion.description["constructions"]["wall"]["layers"]
    assert [layer["material"] for layer in plain] == ["concrete", "insulation", "board"]
    loads = bench.simulated(conversion)["room"].loads
    assert loads["heating"].sum() == pytest.approx(1268.0, rel=0.10)
    assert loads["cooling"].sum() == pytest.approx(2174.0, rel=0.03)


def test_without_weather_no_heat_passes_the_bottom(tmp_path: Path) -> None:
    conversion = converted(tmp_path)
    assert "deep_temperature" not in block_of(conversion)
    assert any("--weather" in finding.effect for finding in conversion.findings)


def test_settings_of_the_soil(tmp_path: Path) -> None:
    settings = "Foundation:Kiva:Settings,1.2,1600,1000,0.7,0.8,0.03,30,ZeroFlux,25;"
    block = block_of(converted(tmp_path, foundation=PLAIN + settings))
    assert (block["conductivity"], block["heat_capacity"]) == (1.2, 1.6e6)
    assert (block["absorptance"], block["emissivity"], block["far"], block["depth"]) == (0.7, 0.8, 30.0, 25.0)
    assert "deep_temperature" not in block


@pytest.mark.parametrize(
    ("exposed", "plan"),
    [
        ("TotalExposedPerimeter,10", {"width": 5.0}),
        ("ExposedPerimeterFraction,,0.25", {"width": 10.0}),
        ("TotalExposedPerimeter,0", {"width": 500.0}),
        ("BySegment,,,Yes,Yes,No,No", {"width": 5.0}),
        ("BySegment,,,Yes,Yes,Yes,Yes", {"length": 5.0, "width": 5.0}),
    ],
)
def test_a_floor_with_few_edges_outdoors_is_a_strip(
    tmp_path: Path, exposed: str, plan: dict[str, float]
) -> None:
    text = f"SurfaceProperty:ExposedFoundationPerimeter,room F,{exposed};"
    block = block_of(converted(tmp_path, exposed=text))
    assert {key: block[key] for key in ("length", "width") if key in block} == plan


def test_insulation_of_the_edge(tmp_path: Path) -> None:
    vertical = block_of(converted(tmp_path, foundation="Foundation:Kiva,foot,,,,,,,,,,insulation,0.8,0.2;"))
    assert vertical["edge"] == {"position": "vertical", "extent": 0.8, "thickness": 0.1, "conductivity": 0.04}
    horizontal = block_of(converted(tmp_path, foundation="Foundation:Kiva,foot,,insulation,0,1.2;"))
    assert (horizontal["edge"]["position"], horizontal["edge"]["extent"]) == ("horizontal", 1.2)


def test_what_a_block_has_no_place_for_is_listed(tmp_path: Path) -> None:
    more = "Foundation:Kiva,foot,,insulation,0,1,insulation,0.5,,,,insulation,0.8,0.2,0.3,wall;"
    conversion = converted(tmp_path, foundation=more)
    left_out = {finding.what for finding in conversion.findings if finding.level == "left out"}
    assert {"a second insulation, horizontal", "interior vertical insulation"} <= left_out


def basement(
    tmp_path: Path, wall: str = "wall", weather: Path | None = None, foundation: str = PLAIN
) -> Conversion:
    """The plain box above a basement of 2.4 m, of which 2.2 m are below the ground, in one zone."""
    sides = {"N": (5, 5, 0, 5), "E": (5, 0, 5, 5), "S": (0, 0, 5, 0), "W": (0, 5, 0, 0)}
    walls, changes = [], []
    for name, (x, y, u, v) in sides.items():
        walls.append(
            f"BuildingSurface:Detailed,cellar {name},Wall,{wall},room,,Foundation,foot,NoSun,NoWind,,4,"
            f"{x},{y},0.2,{x},{y},-2.2,{u},{v},-2.2,{u},{v},0.2;"
        )
        changes.append(
            (f"{x},{y},3,{x},{y},0,{u},{v},0,{u},{v},3;", f"{x},{y},3,{x},{y},0.2,{u},{v},0.2,{u},{v},3;")
        )
    floor = ("0,0,0,0,5,0,5,5,0,5,0,0;", "0,0,-2.2,0,5,-2.2,5,5,-2.2,5,0,-2.2;")
    return converted(tmp_path, *changes, floor, foundation="\n".join((foundation, *walls)), weather=weather)


@pytest.mark.parametrize(
    ("wall", "heating", "cooling", "tolerance"),
    # EnergyPlus 25.2, Chicago, a year [kWh]. On ground of 18 degC: -15 and -87 % of the first.
    [("wall", 2333.0, 1298.0, 0.06), ("sym", 4022.0, 1422.0, 0.13)],
)
def test_loads_above_a_basement_are_those_of_energyplus(
    bench: Any, tmp_path: Path, wall: str, heating: float, cooling: float, tolerance: float
) -> None:
    loads = bench.simulated(basement(tmp_path, wall, bench.WEATHER))["room"].loads
    assert loads["heating"].sum() == pytest.approx(heating, rel=tolerance)
    assert loads["cooling"].sum() == pytest.approx(cooling, rel=tolerance)


def test_a_basement_has_a_block_for_each_surface(tmp_path: Path) -> None:
    described = basement(tmp_path).description
    floor, wall = described["soil_blocks"]["room_F"], described["soil_blocks"]["cellar_N"]
    assert (floor["contact"], wall["contact"]) == ("floor", "walls")
    for block in (floor, wall):
        # Twice the area over the edges outdoors.
        assert (block["width"], block["basement_depth"]) == (2.5, 2.2)
        assert "length" not in block
    assert "thermal_bridges" not in described["zones"]["room"]
    heights = {name: sorted({z for *_, z in described["surfaces"][name]["vertices"]}) for name in (
        "cellar_N", "cellar_N_above_the_ground")}  # fmt: skip
    assert heights["cellar_N"] == [-2.2, pytest.approx(0.0)]
    assert heights["cellar_N_above_the_ground"] == [pytest.approx(0.0), 0.2]
    above = described["surfaces"]["cellar_N_above_the_ground"]
    assert above["outside"]["outdoors"]
    assert "exposure" not in above["outside"], "sun and wind"


def test_insulation_of_a_basement_begins_above_the_ground(tmp_path: Path) -> None:
    foundation = "Foundation:Kiva,foot,,,,,,,,,,insulation,1.2,0.2;"
    blocks = basement(tmp_path, foundation=foundation).description["soil_blocks"]
    assert {block["edge"]["extent"] for block in blocks.values()} == {1.0}


def below_the_ground(*walls: str) -> list[tuple[str, str]]:
    """Changes of the plain box by which some of its walls of 3 m are on the foundation."""
    row = "BuildingSurface:Detailed,room {0},Wall,wall,room,,{1}"
    return [
        (
            row.format(wall, "Outdoors,,SunExposed,WindExposed"),
            row.format(wall, "Foundation,foot,NoSun,NoWind"),
        )
        for wall in walls
    ]


def test_a_floor_has_the_mean_depth_of_its_walls(tmp_path: Path) -> None:
    conversion = converted(tmp_path, *below_the_ground("N", "E", "W"))
    blocks = conversion.description["soil_blocks"]
    # 2.8 m along 15 of 20 m.
    assert (blocks["room_F"]["basement_depth"], blocks["room_N"]["basement_depth"]) == (2.1, 2.8)
    assert any("several depths" in finding.what for finding in conversion.findings)


def test_a_floor_with_one_wall_below_the_ground_is_a_slab(tmp_path: Path) -> None:
    described = converted(tmp_path, *below_the_ground("N")).description
    assert "basement_depth" not in described["soil_blocks"]["room_F"]
    assert described["soil_blocks"]["room_N"]["basement_depth"] == 2.8
    (bridge,) = described["zones"]["room"]["thermal_bridges"].values()
    assert bridge["length"] == 15.0


@pytest.mark.parametrize(("roughness", "film"), [(None, 18.0), (0.03, 13.0), (0.164317, 15.5)])
def test_smooth_ground_has_less_convection(tmp_path: Path, roughness: float | None, film: float) -> None:
    settings = "" if roughness is None else f"Foundation:Kiva:Settings,,,,,,{roughness};"
    block = block_of(converted(tmp_path, foundation=PLAIN + settings))
    # The third is the geometric mean of the others.
    assert block["outdoor_film"] == pytest.approx(film, abs=1e-3)


def test_insulation_outside_covers_the_wall_above_the_ground(tmp_path: Path) -> None:
    foundation = "Foundation:Kiva,foot,,,,,,,,,,insulation,1.2,0.2;"
    described = basement(tmp_path, "sym", foundation=foundation).description
    name = described["surfaces"]["cellar_N_above_the_ground"]["construction"]
    outer = described["constructions"][name]["layers"][0]["material"]
    assert described["materials"][outer] == {"kind": "resistance", "resistance": 2.5}


def test_a_wall_without_a_floor_in_its_zone_is_listed(tmp_path: Path) -> None:
    wall = "BuildingSurface:Detailed,room N,Wall,wall,room,,Outdoors,,SunExposed,WindExposed"
    conversion = converted(
        tmp_path,
        (wall, "BuildingSurface:Detailed,room N,Wall,wall,room,,Foundation,foot,NoSun,NoWind"),
        (FLOOR.replace("Ground,,", "Foundation,foot,"), FLOOR),
    )
    assert "soil_blocks" not in conversion.description
    assert "ground by foundation" in {one.what for one in conversion.findings if one.level == "left out"}


@pytest.mark.parametrize("row", ["1999,1,1,1,60,?,cold,2", "cut", "1999,1,1,1,60,?,nan,2", ""])
def test_a_weather_file_without_temperatures_gives_no_ground_water(tmp_path: Path, row: str) -> None:
    head = ["LOCATION,Chicago,IL,USA,TMY3,725300,41.98,-87.92,-6.0,201.0", *["X"] * 7]
    weather = tmp_path / "weather.epw"
    weather.write_text("\n".join([*head, row, row]), encoding="utf-8")
    assert "deep_temperature" not in block_of(converted(tmp_path, weather=weather))
