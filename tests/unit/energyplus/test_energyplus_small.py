"""Small models of EnergyPlus, one feature each, in both programs.

The models in ``idf_small`` are our own; what EnergyPlus 25.2 makes of them lies beside them, made by
``bench/energyplus_small.py``. No feature is silent: what is carried over agrees, what is not is listed,
with an effect that was measured, and what EnergyPlus refuses is refused.
"""

from __future__ import annotations

from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import idfkit
import numpy as np
import pytest

from mascarin.energyplus import Conversion, convert, terminal_lines, was_edited, yaml_text
from mascarin.energyplus.ledger import IDLE_FIELDS
from mascarin.energyplus.model.year import Day, ahead, year_of
from mascarin.errors import InputError
from small_models import energyplus_small

HERE = Path(__file__).resolve().parents[2]
SMALL = HERE / "idf_small"
#: Rms of the hourly air temperature of January and July that a carried feature may differ [K]: what is asked
#: of models with steady gains.
USUAL = 0.2
#: The same where more is known, with the reason.
LARGER = {
    "until_between_steps": (0.7, "a load of 4 kW that is switched between time steps"),
    "until_average": (0.6, "the same"),
    "daylight_saving": (0.55, "a load of 2 kW that is switched"),
    "day_list_average": (0.5, "the same"),
    "compact_syntax": (0.42, "the same"),
    "interpolate_compact": (0.3, "a load of 2 kW"),
    "interpolate_day_interval": (0.3, "the same"),
    "daylight_saving_south": (0.23, "the same"),
    "capacity_limit": (0.24, "loads at their limit"),
    "tank_stratified": (0.37, "a tank of one temperature"),
    "interzone_one_sided": (0.28, "EnergyPlus takes a surface that names itself as adiabatic in its balance"),
    "skylight": (0.26, "circumsolar radiation through horizontal glass"),
    "skylight_panes": (0.24, "the same"),
    "vapour": (0.4, "heat of sorption: EnergyPlus with and without it differs by 0.30 K"),
    "plenum_of_walls": (0.45, "not known: the zone above, whose heat leaves by windows alone"),
}
#: Refused by EnergyPlus, or with macros: a word of the error.
REFUSED = {"extra_field": "extra field", "macro_include": "##include walls.imf"}
#: Not carried over, or only in part: class of the object that the list names.
LISTED = {
    "ceiling_interzone": "Ceiling:Interzone",
    "hvac_template_vav": "HVACTemplate:Zone:PTAC",
    "incident_inside": "SurfaceProperty:SolarIncidentInside",
    "incident_multiplier": "SurfaceProperty:IncidentSolarMultiplier",
    "inside_adaptive": "SurfaceConvectionAlgorithm:Inside",
    "inside_astm": "SurfaceConvectionAlgorithm:Inside",
    "movable_insulation": "SurfaceControl:MovableInsulation",
    "oa_mixing": "ZoneMixing",
    "surrounding_surfaces": "SurfaceProperty:SurroundingSurfaces",
}
#: Models with a measured effect: the class, and the model without the object.
MEASURED = {
    "incident_inside": "SurfaceProperty:SolarIncidentInside",
    "incident_multiplier": "SurfaceProperty:IncidentSolarMultiplier",
    "inside_adaptive": "SurfaceConvectionAlgorithm:Inside",
    "inside_astm": "SurfaceConvectionAlgorithm:Inside",
    "movable_insulation": "SurfaceControl:MovableInsulation",
    "surrounding_surfaces": "SurfaceProperty:SurroundingSurfaces",
}
NAMES = sorted(path.stem for path in SMALL.glob("*.idf"))
VERSIONS = ((8, 9, 0), (9, 4, 0), (25, 2, 0), max(idfkit.get_schema_manager().get_supported_versions()))
EPJSON = '{"Version":{"v":{"version_identifier":"%s"}}%s}'
CARRIED = [name for name in NAMES if name not in REFUSED and name not in LISTED]


@pytest.fixture(scope="module")
def bench(data_dir: Path) -> Any:
    """The module that makes the table and the references."""
    return energyplus_small()


def months(bench: Any, conversion: Conversion) -> tuple[dict[str, Any], Any]:
    """Hourly air by zone in January and July, and which hours of the year these are."""
    year = int(conversion.start[:4])
    january = bench.simulated(conversion, start=f"{year}-01-01", end=f"{year}-02-01")
    # Two weeks before July, of which the storage of heat knows nothing more afterwards.
    july = bench.simulated(conversion, start=f"{year}-06-17", end=f"{year}-08-01")
    air = {zone: np.concatenate([january[zone].air, july[zone].air[-744:]]) for zone in january}
    return air, np.r_[0:744, 4344:5088]


@pytest.mark.parametrize("name", CARRIED)
def test_what_is_carried_over_agrees(bench: Any, name: str) -> None:
    conversion = convert(SMALL / f"{name}.idf")
    theirs = bench.reference(name)
    assert theirs, f"no results of EnergyPlus for {name}: make them by bench/energyplus_small.py"
    ours, hours = months(bench, conversion)
    limit = LARGER.get(name, (USUAL, ""))[0]
    for zone, results in theirs.items():
        rms = float(np.sqrt(np.mean((ours[zone] - results.air[hours]) ** 2)))
        assert rms < limit, f"{name}, zone {zone}: {rms:.2f} K"
    assert conversion.complete, "what agrees leaves nothing out"


@pytest.mark.parametrize(
    "name", ["base_ideal", "lights_return_ideal", "water_use_schedule", "capacity_limit"]
)
def test_loads_of_carried_models_agree(bench: Any, name: str) -> None:
    conversion = convert(SMALL / f"{name}.idf")
    year = int(conversion.start[:4])
    theirs = bench.reference(name)["room"].loads
    for which, month, start, end in (("heating", 0, "01-01", "02-01"), ("cooling", 6, "07-01", "08-01")):
        ours = bench.simulated(conversion, start=f"{year}-{start}", end=f"{year}-{end}")["room"].loads[which]
        assert ours.sum() == pytest.approx(theirs[which][month], rel=0.06, abs=3.0)


@pytest.mark.parametrize("name", sorted(LISTED))
def test_what_is_not_carried_over_is_listed(bench: Any, name: str) -> None:
    conversion = convert(SMALL / f"{name}.idf")
    levels = {finding.level for finding in conversion.findings if finding.kind == LISTED[name]}
    if levels & {"left out", "approximated"}:
        return
    ours, hours = months(bench, conversion)
    for zone, results in bench.reference(name).items():
        rms = float(np.sqrt(np.mean((ours[zone] - results.air[hours]) ** 2)))
        assert rms < USUAL, f"{name}, zone {zone}: {rms:.2f} K, and nothing says so"


def test_other_run_periods_are_named() -> None:
    findings = convert(SMALL / "two_run_periods.idf").findings
    (finding,) = [entry for entry in findings if entry.kind == "RunPeriod"]
    assert "--start 2017-07-01 --end 2017-08-01" in finding.effect


@pytest.mark.parametrize("name", sorted(MEASURED))
def test_a_stated_effect_is_right_within_a_factor_of_two(bench: Any, name: str) -> None:
    with_it, without = (bench.reference(model)["room"].air for model in (name, "base"))
    measured = float(np.sqrt(np.mean((with_it - without) ** 2)))
    findings = [entry for entry in convert(SMALL / f"{name}.idf").findings if entry.kind == MEASURED[name]]
    (stated,) = {entry.kelvin for entry in findings if entry.kelvin is not None}
    assert 0.5 * measured <= stated <= 2.0 * measured


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_what_energyplus_refuses_is_refused_by_name(name: str) -> None:
    with pytest.raises(InputError, match=REFUSED[name]):
        convert(SMALL / f"{name}.idf")


def written(tmp_path: Path, *changes: tuple[str, str], more: str = "") -> Path:
    """The plain box with changes."""
    text = (SMALL / "base.idf").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "model.idf"
    file.write_text(text + more, encoding="utf-8")
    return file


def left_out(conversion: Conversion) -> list[str]:
    return [finding.text() for finding in conversion.findings if finding.level == "left out"]


def test_a_field_that_nothing_reads_is_listed(tmp_path: Path) -> None:
    # An exhaust node of lamps: the heat that leaves there is not carried over.
    lamps = "  Lights,lamps,room,on,LightingLevel,10,,,0,0,0,1,General,No,,,,node;\n"
    assert convert(written(tmp_path, more=lamps)).complete, "nodes are idle"
    solar = ("FullExterior,25,6;", "FullExterior,25,6;\n  WindowProperty:FrameAndDivider,edge,0.1,,,5,1.3;")
    frame = ("room S,,autocalculate,,1,4", "room S,,autocalculate,edge,1,4")
    (finding,) = left_out(convert(written(tmp_path, solar, frame)))
    assert "WindowProperty:FrameAndDivider 'edge'" in finding
    assert "ratio of frame edge glass conductance to center of glass conductance = 1.3" in finding


def test_every_class_of_idle_fields_exists() -> None:
    schemas = [idfkit.get_schema_manager().get_schema(version) for version in VERSIONS]
    for beginning, patterns in IDLE_FIELDS.items():
        kinds = [
            (schema, kind)
            for schema in schemas
            for kind in schema.object_types
            if kind.casefold().startswith(beginning)
        ]
        assert kinds, f"no class begins with {beginning}"
        for pattern in patterns:
            names = {name for schema, kind in kinds for name in schema.get_all_field_names(kind)}
            names |= {
                name
                for schema, kind in kinds
                for name in (schema.get_inner_schema(kind) or {}).get("properties", {})
            }
            assert any(fnmatchcase(name, pattern) for name in names), f"{beginning}: no field {pattern}"


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.idf", "  Version,25.2;\n  Zone,room,0,", "2: found 'Zone' without a semicolon"),
        ("a.idf", "Version,25.2;\0\0", "1: found bytes that are no text"),
        ("a.idf", "Version,31.1;\n", "found EnergyPlus version 31.1"),
        ("a.idf", "Version,25.2;\nTimestep,4;\n", "found no Zone and no surfaces"),
        ("a.idf", "Version,25.2;\nZone,a,#eval[1+1];\n", "2: found the macro '#eval"),
        ("a.idf", "Version,25.2;\nZone,a,=$x;\n", "2: Zone 'a'.*ParametricPreprocessor"),
        (
            "a.epJSON",
            '{"Version":{"v":{"version_identifier":"25.2"}},"Zone":{"a":{"zz":3}}}',
            "the field 'zz'",
        ),
        ("a.epJSON", '{"Version":{"v":{"version_identifier":"99.1"}}}', "found EnergyPlus version 99.1"),
        ("a.epJSON", '{"Version":{', "found no JSON"),
        ("a.epJSON", "[" * 100000, "nested too deeply"),
    ],
)
def test_bad_files_are_refused_by_line_and_remedy(
    tmp_path: Path, name: str, content: str, words: str
) -> None:
    (tmp_path / name).write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=words):
        convert(tmp_path / name)


@pytest.mark.parametrize(
    "more",
    [
        "ZoneList,za,zb;\nZoneList,zb,za;\nLights,x,za,on,LightingLevel,10;",
        "Schedule:Year,sy,any,sw,1,1,12,31;\nSchedule:Week:Compact,sw,For: AllDays,sy;\n"
        "Lights,x,room,sy,LightingLevel,10;",
    ],
)
def test_lists_that_name_themselves_are_refused(tmp_path: Path, more: str) -> None:
    with pytest.raises(InputError, match=r"model\.idf:\d+: .*expected the name of a"):
        convert(written(tmp_path, more=more))


def test_what_energyplus_reads_over_is_read_over(tmp_path: Path) -> None:
    blank = ("EquipmentLevel,500,,,0,0,0;", "EquipmentLevel,500,,,0,0,0,,,,;")
    step = ("Timestep,4", "Timestep,7")
    conversion = convert(written(tmp_path, blank, step))
    assert conversion.steps_per_hour == 6
    assert any(finding.kind == "Timestep" for finding in conversion.findings)


def test_dividers_are_a_part_of_the_frame() -> None:
    # Two and two bars of 0.04 m on 3 x 1.4 m of glass; a U value with both films.
    frame = convert(SMALL / "dividers.idf").description["windows"]["room_win"]["frame"]
    assert frame["fraction"] == pytest.approx(0.04 * (2 * 3.0 + 2 * 1.4 - 4 * 0.04) / 4.2, rel=1e-6)
    assert frame["u_value"] == pytest.approx(1.0 / (1.0 / 3.0 + 0.17), rel=1e-6)
    assert frame["absorptance"] == 0.5


def test_recovered_air_passes_by_where_no_heat_is_needed(tmp_path: Path) -> None:
    description = convert(SMALL / "recovery.idf").description
    flows = description["zones"]["room"]["ventilation"].values()
    base, bypass = sorted(flows, key=lambda flow: "control" in flow)
    assert base["flow"] == pytest.approx(0.3 * 2.0 * 75.0 / 3600.0)
    assert bypass["flow"] == pytest.approx(0.7 * 2.0 * 75.0 / 3600.0)
    control = description["controls"][bypass["control"]]
    assert control["difference"] == {"open": 0, "close": 0}
    assert control["indoor"] == {"open": 21, "close": 21}, "1 K above the heating set point"


def test_expressions_have_the_values_of_the_first_run(tmp_path: Path) -> None:
    thick = ("Material,concrete,MediumRough,0.15", "Material,concrete,MediumRough,=sqrt($t)/2")
    runs = "\n  Parametric:SetValueForRun,$T,0.09,0.2;\n"
    conversion = convert(written(tmp_path, thick, more=runs))
    assert conversion.description["constructions"]["wall"]["layers"][0]["thickness"] == pytest.approx(0.15)
    assert any("first run" in text for text in left_out(conversion))
    with pytest.raises(InputError, match=r"13: Material 'concrete'.*ParametricPreprocessor"):
        convert(written(tmp_path, thick))


def test_unlike_layers_of_a_pair_are_noted(tmp_path: Path) -> None:
    text = (SMALL / "interior_window.idf").read_text(encoding="utf-8")
    assert not any("layers" in entry.what for entry in convert(SMALL / "interior_window.idf").findings)
    pair = "BuildingSurface:Detailed,b W,Wall,sym"
    assert pair in text
    (tmp_path / "pair.idf").write_text(text.replace(pair, pair[:-3] + "slab"), encoding="utf-8")
    findings = convert(tmp_path / "pair.idf").findings
    assert [entry.name for entry in findings if "layers of 'slab'" in entry.what] == ["b W"]


def test_a_changed_building_is_not_written_over(tmp_path: Path) -> None:
    file = tmp_path / "box.yaml"
    assert not was_edited(file)
    file.write_text(yaml_text(convert(SMALL / "base.idf")), encoding="utf-8")
    assert not was_edited(file)
    file.write_text(file.read_text(encoding="utf-8").replace("room_win", "large"), encoding="utf-8")
    assert was_edited(file)


def test_objects_with_one_effect_are_one_line() -> None:
    lines = list(terminal_lines(convert(SMALL / "incident_inside.idf")))
    assert lines[0] == "Left out; the results change:"
    assert "about 0.98 K in a small room" in lines[1], "the largest effect comes first"
    unused = [line for line in lines if "Schedule:Constant" in line]
    assert len(unused) == 1


def test_the_clock_of_summer_moves_a_schedule() -> None:
    day: Day = ((0, 0.0), (480, 1.0), (1380, 2.0))
    other: Day = ((0, 5.0),)
    week = (day, other, *[day] * 6)
    moved = ahead(year_of([("12-31", week)]), "03-10", "11-02")
    assert [until for until, _ in moved.seasons] == ["03-09", "11-02", "12-31"]
    summer = moved.seasons[1][1]
    assert summer[0] == ((0, 0.0), (420, 1.0), (1320, 2.0), (1380, 5.0)), "Sunday, then Monday's first hour"
    assert summer[1] == ((0, 5.0), (1380, 0.0))
    assert moved.seasons[0][1][0] == day
