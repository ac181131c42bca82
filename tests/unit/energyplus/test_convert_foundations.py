"""Foundations of Kiva: blocks of soil, and both programs."""

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
    assert loads["heating"].sum() == pytest.approx(1691.0, rel=0.09)
    assert loads["cooling"].sum() == pytest.approx(1854.0, rel=0.03)


def test_soil_has_the_defaults_of_energyplus(bench: Any, tmp_path: Path) -> None:
    block = block_of(converted(tmp_path, weather=bench.WEATHER))
    assert (block["length"], block["width"], block["wall_thickness"]) == (5.0, 5.0, 0.3)
    assert (block["conductivity"], block["heat_capacity"]) == (1.73, 1842 * 419)
    assert (block["absorptance"], block["emissivity"]) == (0.9, 0.9)
    # 0.1022 m of depth of the ground water for each of 201 m of altitude, at the mean of the weather file.
    assert block["depth"] == pytest.approx(20.542, abs=0.001)
    assert block["deep_temperature"] == pytest.approx(9.99, abs=0.01)
    assert "edge" not in block


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
    assert block_of(conversion)["wall_thickness"] == pytest.approx(0.2625), "the construction 'wall'"


def test_basements_are_listed(tmp_path: Path) -> None:
    wall = "BuildingSurface:Detailed,room N,Wall,wall,room,,Outdoors,,SunExposed,WindExposed"
    conversion = converted(
        tmp_path, (wall, "BuildingSurface:Detailed,room N,Wall,wall,room,,Foundation,foot,NoSun,NoWind")
    )
    assert "soil_blocks" not in conversion.description
    assert [one.what for one in conversion.findings if one.level == "left out"].count(
        "ground by foundation"
    ) >= 1


@pytest.mark.parametrize("row", ["1999,1,1,1,60,?,cold,2", "cut", "1999,1,1,1,60,?,nan,2", ""])
def test_a_weather_file_without_temperatures_gives_no_ground_water(tmp_path: Path, row: str) -> None:
    head = ["LOCATION,Chicago,IL,USA,TMY3,725300,41.98,-87.92,-6.0,201.0", *["X"] * 7]
    weather = tmp_path / "weather.epw"
    weather.write_text("\n".join([*head, row, row]), encoding="utf-8")
    assert "deep_temperature" not in block_of(converted(tmp_path, weather=weather))
