"""What a real house needs in a description: reading, writing, refusals with file and line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mascarin import cli
from mascarin.building import Building, Gain, load
from mascarin.building.checks.overview import check
from mascarin.building.engine_input import measured_columns
from mascarin.building.parameters.sources import sources
from mascarin.building.parts.site_air import heat_capacity
from mascarin.errors import InputError

HOUSE = """\
name: house
site: {latitude: 47.9, longitude: 11.7, altitude: 680, timezone: UTC+1}
materials: {brick: {conductivity: 0.22, density: 800, specific_heat: 1000}}
constructions: {wall: {layers: [{material: brick, thickness: 0.3}]}}
zones:
  living:
    volume: 80
    infiltration: {blower_door: 2.2}
    gains: {heater: {column: P_living, radiative: 0.3}, duct: {power: -70}}
    thermal_bridges:
      edges: {psi: 0.05, length: 20}
      attic: {chi: 2.6, measured: [T_east, T_west]}
      soil: {psi: 0.1, length: 10, ground: {mean: 10, amplitude: 3}}
  bath:
    volume: 17
    infiltration: {blower_door: {kind: stack_wind, n50: 1.6, shelter: 2}}
    held: {column: T_bath}
air_paths:
  overflow: {between: [living, bath], flow: 0.03, one_way: true}
  door: {between: [living, bath], door: {width: 0.9, height: 2}}
ventilation_units:
  unit:
    supply: {living: 0.03}
    exhaust: {bath: 0.03}
    recovery: 0.8
surfaces:
  south: {construction: wall, area: 16, tilt: 90, azimuth: 180,
          outside: {outdoors: true, convection: 15, emissivity: 0.9, absorptance: 0.6},
          inside: {zone: living, convection: 3, emissivity: 0.9}}
  ceiling: {construction: wall, area: 40, tilt: 0, outside: {measured: [T_east, T_west], convection: 5},
            inside: {zone: living, convection: 3, emissivity: 0.9}}
  between: {construction: wall, area: 10, tilt: 90, azimuth: 0,
            outside: {zone: living, convection: 3, emissivity: 0.9},
            inside: {zone: bath, convection: 3, emissivity: 0.9}}
"""


def read(folder: Path, text: str = HOUSE) -> Building:
    (folder / "house.yaml").write_text(text, encoding="utf-8")
    return load(folder / "house.yaml")


def test_a_house_is_written_as_it_was_read(tmp_path: Path) -> None:
    house = read(tmp_path)
    house.to_yaml(tmp_path / "again.yaml")
    assert load(tmp_path / "again.yaml") == house
    assert measured_columns(house) == ["P_living", "T_east", "T_west", "T_bath"]


def test_numbers_have_paths_units_and_ranges(tmp_path: Path) -> None:
    house = read(tmp_path)
    psi = house.parameter("zones.living.thermal_bridges.edges.psi")
    assert (psi.unit, psi.value, psi.varies) == ("W/(m K)", 0.05, True)
    assert house.parameter("ventilation_units.unit.recovery").high == pytest.approx(0.9)
    assert house.parameter("zones.bath.infiltration.blower_door.wind").value == 0.000246
    # What is measured varies only if a range is given.
    assert not house.parameter("zones.living.gains.heater.factor").varies
    ranged = HOUSE.replace("column: P_living,", "column: P_living, factor: {value: 1, range: [0.9, 1.1]},")
    assert read(tmp_path, ranged).parameter("zones.living.gains.heater.factor").varies


def test_the_check_and_the_sources_name_them(tmp_path: Path) -> None:
    house = read(tmp_path)
    lines = "\n".join(check(house))
    for words in (
        "gain heater of column P_living, 30 % radiated",
        "thermal bridge edges of 1.000 W/K to outdoors",
        "thermal bridge attic of 2.600 W/K to T_east and T_west",
        "door of 0.9 m x 2 m, 100 % open, between living and bath",
        f"extracts from bath: {0.03 * heat_capacity(house.site):.2f} W/K",
        "outdoor air, heat recovery 0.8",
        "zone living: infiltration of a pressure test, n50 2.2 1/h (factor)",
    ):
        assert words in lines, words
    found = "\n".join(sources(house))
    for source in ("Brown & Solvason 1962", "EN ISO 13789", "Sherman & Grimsrud 1980", "ch. 26, eq. 2"):
        assert source in found


WRONG = {
    "psi without length": (
        "edges: {psi: 0.05, length: 20}", "edges: {psi: 0.05}",
        ("house.yaml:11", "psi without length", "Add 'length:'"),
    ),
    "flows that do not balance": (
        "exhaust: {bath: 0.03}", "exhaust: {bath: 0.04}",
        ("house.yaml:14", "0.03 m3/s of air enters and 0.04 m3/s leaves", "makeup_air: outdoors"),
    ),
    "two sources for one power": (
        "{column: P_living, radiative: 0.3}", "{column: P_living, power: 100}",
        ("house.yaml:9", "power and column", "Keep one source"),
    ),
    "two sources for the supplied air": (
        "    recovery: 0.8", "    recovery: 0.8\n    temperature: 18",
        ("house.yaml:22", "temperature and recovery"),
    ),
    "held and heated": (
        "    held: {column: T_bath}", "    held: {column: T_bath}\n    heating: {setpoint: 20}",
        ("house.yaml:14", "held and heating"),
    ),
    "a latent share": ("radiative: 0.3", "latent: 0.3", ("house.yaml:9", "power is sensible heat")),
    "a schedule beside a column": (
        "{column: P_living, radiative: 0.3}",
        "{column: P_living, schedule: work}",
        ("house.yaml:9", "'work'"),
    ),
    "a door with a flow": (
        "door: {width: 0.9, height: 2}}", "door: {width: 0.9, height: 2}, flow: 0.1}",
        ("house.yaml:20", "door and flow"),
    ),
    "a bridge to its own zone": (
        "edges: {psi: 0.05, length: 20}", "edges: {psi: 0.05, length: 20, zone: living}",
        ("house.yaml:11", "the zone itself"),
    ),
    "sun to the air without windows": (
        "    volume: 17", "    volume: 17\n    solar_to_air: 0.1", ("house.yaml:16", "without windows"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_refusals_name_place_finding_and_remedy(tmp_path: Path, case: str) -> None:
    before, after, words = WRONG[case]
    assert HOUSE.count(before) == 1
    text = HOUSE.replace(before, after)
    with pytest.raises(InputError) as error:
        read(tmp_path, text)
    for word in words:
        assert word in str(error.value), f"{word!r} not in: {error.value}"


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "exactly one of power and column"),
        ({"power": 100, "unit": "kW"}, "'unit' without a column"),
        ({"power": 100, "factor": 2}, "'factor' without a column"),
        ({"column": "P", "unit": "hp"}, "one of W, kW"),
    ],
)
def test_a_gain_has_one_source(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as error:
        Gain(**fields)
    assert words in str(error.value), json.dumps(fields)


def test_make_up_air_needs_fans(tmp_path: Path) -> None:
    """It lets flows differ, and is refused where there are none."""
    text = HOUSE.replace("    volume: 17", "    volume: 17\n    makeup_air: outdoors")
    assert read(tmp_path, text.replace("bath: 0.03", "bath: 0.04")).zones["bath"].makeup_air == "outdoors"
    still = text[: text.index("ventilation_units:")] + text[text.index("surfaces:") :]
    still = still.replace("  overflow: {between: [living, bath], flow: 0.03, one_way: true}\n", "")
    with pytest.raises(InputError, match="a zone that no fan moves air through"):
        read(tmp_path, still)


def test_errors_of_a_run_name_file_and_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Flows that do not balance over time, and a column that the table does not have."""
    text = HOUSE.replace("supply: {living: 0.03}", "supply: {living: {column: V}}")
    text = text.replace("    recovery: 0.8\n", "")
    text = text.replace("{column: T_bath}", "20").replace("[T_east, T_west]", "V")
    text = text.replace("{column: P_living, radiative: 0.3}", "{power: 100}")
    read(tmp_path, text)
    hours = [f"2024-01-01 {hour:02d}:00,5,0.03,{0.02 + 0.001 * hour}" for hour in range(24)]
    (tmp_path / "table.csv").write_text("time,T,other,V\n" + "\n".join(hours) + "\n", encoding="utf-8")
    absent = ("dew_point", "wind_speed", "wind_direction", "radiation", "cloud_cover")
    command = ["run", str(tmp_path / "house.yaml"), "--weather", str(tmp_path / "table.csv")]
    command += ["--column", "air_temperature=T", *(f"--column={name}=none" for name in absent)]
    assert cli.main([*command, "--timezone", "UTC+1"]) == 2
    error = capsys.readouterr().err
    assert "house.yaml:6" in error
    assert "zones.living: found that 0.043 m3/s of air enters and 0.03 m3/s leaves" in error
    read(tmp_path, text.replace("column: V}", "column: W}"))
    assert cli.main([*command, "--timezone", "UTC+1"]) == 2
    assert "house.yaml:23: " in capsys.readouterr().err
