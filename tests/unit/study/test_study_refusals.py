"""What a study refuses before anything is run: where, what was found, what was expected, what to do."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from study_support import BUILDING, STUDY, Bench, logger_table

MEASURED = "measurements:\n  table: logger.csv\n"
IDENTIFIED = '["2023-03-02 00:00", "2023-03-06 00:00"]'
HELD = '["2023-03-06 00:00", "2023-03-08 00:00"]'
FREE = STUDY[STUDY.index("    materials.insulation.conductivity:") :]


class Refused(NamedTuple):
    """A changed text of the study, and the expected message."""

    before: str
    after: str
    #: Text on the line that the message must name, in the changed file; the place follows.
    line: str
    says: tuple[str, ...]
    file: str = "study.yaml"


CASES = {
    "start outside the bounds": Refused(
        "    materials.brick.conductivity:",
        "    materials.brick.conductivity: {low: 0.4, high: 1.0, start: 1.4}",
        "start: 1.4",
        (
            "identification.parameters.materials.brick.conductivity",
            "range [0.4, 1] W/(m K) does not contain the start 1.4: move the start",
        ),
    ),
    "a prior wider than its range": Refused(
        "    materials.brick.conductivity:",
        "    materials.brick.conductivity: {low: 0.4, high: 1.0, prior: 0.7}",
        "prior: 0.7",
        (
            "identification.parameters.materials.brick.conductivity",
            "range [0.4, 1] W/(m K) is narrower than the standard deviation of its prior, 0.7",
        ),
    ),
    "alternatives that are the same": Refused(
        "identification:\n  starts",
        "alternatives:\n  outside:\n    first: {changes: {surfaces.wall.outside.convection: 20}}\n"
        "    second: {changes: {surfaces.wall.outside.convection.coefficient: 20}}\n"
        "identification:\n  starts",
        "  outside:",
        ("alternatives.outside", "found 'second', which is the same as 'first'", "remove one"),
    ),
    "an alternative that is the building": Refused(
        "identification:\n  starts",
        "alternatives: {outside: {first: {changes: {surfaces.wall.outside.absorptance: 0.5}}}}\n"
        "identification:\n  starts",
        "alternatives:",
        ("alternatives.outside", "found 'first', which is the same as the building as described"),
    ),
    "one value of an alternative twice": Refused(
        "identification:\n  starts",
        "alternatives: {surfaces.wall.outside.convection: [20, 30, 20]}\nidentification:\n  starts",
        "alternatives:",
        ("alternatives.surfaces.wall.outside.convection", "found one value twice"),
    ),
    "an alternative of nothing": Refused(
        "identification:\n  starts",
        "alternatives: {outside: {first: {changes: {surfaces.roof*.outside.convection: 20}}}}\n"
        "identification:\n  starts",
        "alternatives:",
        ("alternatives.outside", "surfaces.roof*.outside.convection", "nothing in the building that matches"),
    ),
    "a parameter of an alternative that does not exist": Refused(
        "identification:\n  starts",
        "alternatives: {outside: {first: {changes: {surfaces.wall.outside.convection: 20}, "
        "parameters: {surfaces.wall.outside.convection.wind: {}}}}}\n"
        "identification:\n  starts",
        "alternatives:",
        ("alternatives.outside", "surfaces.wall.outside.convection.wind"),
    ),
    "a tie of one number in an alternative": Refused(
        "identification:\n  starts",
        "alternatives: {outside: {first: {changes: {surfaces.wall.outside.convection: 20}, "
        "parameters: {surfaces.wall.outside.convection.coefficient: {tie: true}}}}}\n"
        "identification:\n  starts",
        "alternatives:",
        ("alternatives.outside", "found a tie of one number", "leave tie out"),
    ),
    "errors that last longer than the identification": Refused(
        "  starts: 2",
        "  independent: 5d",
        "independent: 5d",
        ("identification.independent", "the identification lasts 96 h", "make the identification longer"),
    ),
    "errors of days from one day": Refused(
        f"identification: {IDENTIFIED}",
        'identification: ["2023-03-02 00:00", "2023-03-03 00:00"]',
        'identification: ["2023-03-02 00:00", "2023-03-03 00:00"]',
        ("periods.identification", "found 24 h, expected at least 48 h", "make it longer"),
    ),
    "a candidate beside alternatives": Refused(
        "identification:\n  starts",
        "alternatives: {surfaces.wall.outside.convection: [20]}\n"
        "variants: {other: {candidate: true, changes: {surfaces.wall.outside.convection: 30}}}\n"
        "identification:\n  starts",
        "variants:",
        ("variants.other.candidate", "expected alternatives", "leave candidate out"),
    ),
    "an offset without an uncertainty in another unit": Refused(
        "{column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}",
        "{column: joint, output: wall.inside_flux, clock: 5min}",
        "clock: 5min",
        ("sensors.joint", "found no uncertainty, expected one, because the unit is W/m2"),
    ),
    "unknown method of fitting": Refused(
        "  starts: 2",
        "  method: particle-swarn",
        "particle-swarn",
        ("identification.method", "hybrid, cma-es, emcee", "mean 'particle-swarm'"),
    ),
    "a sample of what is no likelihood": Refused(
        "  starts: 2",
        "  method: emcee\n  cost: sd",
        "cost: sd",
        ("identification.cost", "nll, the only cost that emcee supports"),
    ),
    "profiles of what is no likelihood": Refused(
        "  starts: 2",
        "  method: hooke-jeeves\n  cost: sd\n  profiles: true",
        "profiles: true",
        ("identification.profiles", "nll, the likelihood of which profiles are made"),
    ),
    "unknown key": Refused(
        "step: 30min", "stepp: 30min", "stepp", (": stepp", "found: the key", "mean 'step'")
    ),
    "no time zone of the table": Refused(
        MEASURED + "  timezone: UTC+1\n",
        MEASURED.replace("logger", "other"),  # what the weather says of its own table does not hold for it
        "measurements:",
        ("measurements.timezone", "found: nothing", "Europe/Paris", "Add 'timezone:'"),
    ),
    "no time zone of the weather": Refused(
        "    table: logger.csv\n    timezone: UTC+1\n",
        "    table: other.csv\n",
        "measured:",
        ("climate.measured.timezone", "found: nothing", "Add"),
    ),
    "wrong time zone": Refused(
        MEASURED + "  timezone: UTC+1",
        MEASURED + "  timezone: Europe/Pariss",
        "Europe/Pariss",
        ("measurements.timezone", "found: 'Europe/Pariss'", "UTC+4", "mean 'Europe/Paris'"),
    ),
    "time zone beyond the globe": Refused(
        MEASURED + "  timezone: UTC+1",
        MEASURED + "  timezone: UTC+25",
        "UTC+25",
        ("found: 'UTC+25'",),
    ),
    "measured column missing": Refused(
        "column: joint",
        "column: jiont",
        "jiont",
        ("sensors.joint.column", "no column 'jiont'", "'joint'"),
    ),
    "no column of a sensor": Refused(
        "column: joint",
        "column: []",
        "column: []",
        ("sensors.joint.column", "found: []"),
    ),
    "weather column missing": Refused(
        "air_temperature: air}",
        "air_temperature: airr}",
        "measured:",
        ("climate.measured", "no column 'airr'", "mean 'air'"),
    ),
    "no such channel": Refused(
        "air_temperature: air}",
        "air_temprature: air}",
        "measured:",
        ("'air_temprature' is no climate channel", "mean 'air_temperature'"),
    ),
    "column of a boundary missing": Refused(
        "measured: room",
        "measured: rooom",
        "measured: rooom",
        ("no column 'rooom'", "mean 'room'"),
        "building.yaml",
    ),
    "column of the irradiance missing": Refused(
        "irradiance: sun",
        "irradiance: son",
        "irradiance: son",
        ("no column 'son'", "mean 'sun'"),
        "building.yaml",
    ),
    "column to inspect missing": Refused(
        MEASURED,
        MEASURED + "  inspect: [probe]\n",
        "inspect",
        ("measurements.inspect", "no column 'probe'"),
    ),
    "column of means missing": Refused(
        MEASURED,
        MEASURED + "  mean: [probe]\n",
        "mean:",
        ("measurements.mean", "'probe' is not read"),
    ),
    "time column missing": Refused(
        MEASURED,
        MEASURED + "  time: stamp\n",
        "measurements:",
        ("no time column 'stamp'", "time"),
    ),
    "period after the data": Refused(
        HELD,
        '["2023-03-06 00:00", "2023-04-08 00:00"]',
        "corroboration:",
        (
            "periods.corroboration",
            "found 2023-03-06 00:00 .. 2023-04-08",
            "cover, 2023-03-01 00:00 .. 2023-03-10",
            "move it",
        ),
    ),
    "period before the data": Refused(
        IDENTIFIED,
        '["2022-03-02 00:00", "2022-03-06 00:00"]',
        "identification: [",
        ("periods.identification", "found 2022-03-02 00:00", "expected a period inside"),
    ),
    "warm-up before the data": Refused(
        '["2023-03-01 00:00", ',
        '["2023-02-20 00:00", ',
        "warm_up:",
        ("periods.warm_up", "move it"),
    ),
    "end after the data": Refused(
        "  warm_up:",
        '  end: "2023-05-01"\n  warm_up:',
        "end:",
        ("periods.end", "found 2023-05-01", "leave it out"),
    ),
    "period after the end": Refused(
        "  warm_up:",
        '  end: "2023-03-07"\n  warm_up:',
        "corroboration:",
        ("periods.corroboration", "periods.end leave"),
    ),
    "warm-up reaches into the identification": Refused(
        '["2023-03-01 00:00", "2023-03-02 00:00"]',
        '["2023-03-01 00:00", "2023-03-03 00:00"]',
        "identification: [",
        ("periods.identification", "2023-03-03 00:00", "move one of the two"),
    ),
    "period backwards": Refused(
        IDENTIFIED,
        '["2023-03-06 00:00", "2023-03-02 00:00"]',
        "identification: [",
        ("found 2023-03-06 00:00 .. 2023-03-02 00:00", "exchange"),
    ),
    "no date": Refused(
        IDENTIFIED,
        '["2023-03-32 00:00", "2023-03-06 00:00"]',
        "identification: [",
        ("'2023-03-32 00:00' is not a date", "write it as"),
    ),
    "half a period": Refused(IDENTIFIED, '["2023-03-02 00:00"]', "identification: [", ("Start and end",)),
    "overlap": Refused(
        HELD,
        '["2023-03-05 00:00", "2023-03-08 00:00"]',
        "corroboration:",
        ("periods.corroboration", "overlaps the identification", "move one of the two"),
    ),
    "identification to the end": Refused(
        """identification: ["2023-03-02 00:00", "2023-03-06 00:00"]
  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]
""",
        'identification: ["2023-03-02 00:00", "2023-03-10 00:00"]\n',
        "identification: [",
        ("periods.identification", "leaves nothing of the record, up to 2023-03-09 23:30", "end it earlier"),
    ),
    "corroboration between two instants": Refused(
        HELD,
        '["2023-03-06 00:10", "2023-03-06 00:20"]',
        "corroboration:",
        ("periods.corroboration", "contains no measured instant", "make it longer"),
    ),
    "unknown output": Refused(
        "output: core.temperature",
        "output: core.temprature",
        "core.temprature",
        ("sensors.core.output", "no such output", "mean 'core.temperature'"),
    ),
    "unknown parameter": Refused(
        "materials.brick.conductivity:",
        "materials.brick.condctivity:",
        "condctivity",
        ("identification.parameters", "found no such parameter", "mean 'materials.brick.conductivity'"),
    ),
    "structural parameter": Refused(
        "materials.brick.conductivity:",
        "site.latitude:",
        "site.latitude",
        ("identification.parameters.site.latitude", "structural", "choose another"),
    ),
    "parameter twice": Refused(
        "materials.brick.conductivity:",
        "materials.brick.conductivity:\n    constructions.wall.layers.brick.conductivity:",
        "constructions.wall.layers.brick",
        ("the same as materials.brick.conductivity", "remove one"),
    ),
    "bounds beyond the limits": Refused(
        "materials.brick.conductivity:",
        "materials.brick.conductivity: {low: -1}",
        "{low: -1}",
        ("range [-1, 1.2] W/(m K)", "possible values, [0,", "narrow it"),
    ),
    "bounds backwards": Refused(
        "materials.brick.conductivity:",
        "materials.brick.conductivity: {low: 2, high: 1}",
        "{low: 2",
        ("range [2, 1]", "lower bound below"),
    ),
    "no parameter": Refused(FREE, "    {}\n", "  parameters:", ("identification.parameters", "Path ->")),
    "list of parameters": Refused(
        FREE,
        "    - materials.brick.conductivity\n",
        "  parameters:",
        ("a mapping (key: value)",),
    ),
    "building missing": Refused(
        "building: building.yaml",
        "building: bulding.yaml",
        "bulding",
        ("building: found no file", "folder of the study", "'building.yaml'"),
    ),
    "table missing": Refused(
        MEASURED,
        "measurements:\n  table: loger.csv\n",
        "loger.csv",
        ("measurements.table: found no file", "'logger.csv'"),
    ),
    "folder missing": Refused(
        MEASURED,
        "measurements:\n  table: data/logger.csv\n",
        "data/logger.csv",
        ("no folder", "correct the path"),
    ),
    "unknown metric": Refused(
        "metric: rmse",
        "metric: rmsee",
        "rmsee",
        ("criteria.0.metric", "found: 'rmsee'", "mean 'rmse'"),
    ),
    "limit below zero": Refused("limit: 0.25", "limit: -1", "limit: -1", ("criteria.0.limit", "found: -1")),
    "unknown key of a criterion": Refused(
        "limit: 0.25",
        "limit: 0.25, sensor: joint",
        "sensor: joint",
        ("the key 'sensor'", "mean 'sensors'"),
    ),
    "criterion on no sensor": Refused(
        "limit: 0.25",
        "limit: 0.25, sensors: jont",
        "jont",
        ("criteria.0.sensors", "found 'jont', expected one of joint, core", "mean 'joint'"),
    ),
    "criterion on no period": Refused(
        "limit: 0.25",
        "limit: 0.25, periods: blnd",
        "blnd",
        ("criteria.0.periods", "mean 'blind'"),
    ),
    "step is no time": Refused(
        "step: 30min", "step: 30 parsecs", "parsecs", ("found: '30 parsecs'", "15min")
    ),
    "step below zero": Refused("step: 30min", "step: -30min", "step: -30min", ("a length of time",)),
    "interval is no time": Refused("interval: 1h", "interval: fast", "fast", ("sensitivity.interval", "1h")),
    "step of the sensitivity analysis that does not divide its interval": Refused(
        "interval: 1h",
        "interval: 1h, step: 25min",
        "25min",
        ("sensitivity.step", "whole part", "30min for 1h"),
    ),
    "range of an unknown parameter": Refused(
        "interval: 1h",
        "interval: 1h, ranges: {materials.bric.density: [1, 2]}",
        "bric.density",
        ("sensitivity.ranges.materials.bric.density", "mean 'materials.brick.density'"),
    ),
    "range beyond the limits": Refused(
        "interval: 1h",
        "interval: 1h, ranges: {materials.brick.density: [-5, 2000]}",
        "[-5, 2000]",
        ("found [-5, 2000] kg/m3", "expected", "above 0 and at most 25000 kg/m3", "correct the range"),
    ),
    "range of a structural parameter": Refused(
        "interval: 1h",
        "interval: 1h, ranges: {site.latitude: [40, 50]}",
        "[40, 50]",
        ("structural", "leave it out"),
    ),
    "unknown parameter left out": Refused(
        "interval: 1h",
        "interval: 1h, leave_out: [site.altitud]",
        "leave_out",
        ("mean 'site.altitude'",),
    ),
    "cost that least squares does not know": Refused(
        "starts: 2",
        "starts: 2\n  cost: rmse",
        "cost: rmse",
        ("identification.cost", "hooke-jeeves"),
    ),
    "prior that a cost does not weigh": Refused(
        "starts: 2\n  lead: 1d\n  parameters:\n    materials.insulation.conductivity:",
        "method: hooke-jeeves\n  cost: rmse\n  parameters:\n"
        "    materials.insulation.conductivity: {prior: 1}",
        "cost: rmse",
        ("identification.cost", "nll"),
    ),
    "unknown method": Refused(
        "starts: 2",
        "starts: 2\n  method: newton",
        "newton",
        ("expected: one of least-squares, hooke-jeeves",),
    ),
    "setting of an unknown parameter": Refused(
        "building: building.yaml",
        "building: building.yaml\nset: {materials.brick.densty: 1}",
        "densty",
        ("set: ", "mean 'materials.brick.density'"),
    ),
    "setting that cannot be": Refused(
        "building: building.yaml",
        "building: building.yaml\nset: {materials.brick.density: -1}",
        "density: -1",
        ("materials.brick.density", "found: -1", "above 0"),
    ),
    "variant of nothing": Refused(
        "building: building.yaml",
        "building: building.yaml\nvariants: {a: {changes: {surfaces.wall.inside.convectn: 3}}}",
        "convectn",
        ("variants.a.changes", "mean 'surfaces.wall.inside.convection"),
    ),
    "variant that cannot be": Refused(
        "building: building.yaml",
        "building: building.yaml\nvariants: {a: {changes: {surfaces.wall.outside.absorptance: 3}}}",
        "variants:",
        ("variants.a.changes", "found: 3", "at most 1"),
    ),
    "variant with a name of ours": Refused(
        "building: building.yaml",
        "building: building.yaml\nvariants: {fitted: {changes: {surfaces.wall.outside.absorptance: 0.3}}}",
        "variants:",
        ("variants.fitted", "another name"),
    ),
    "sensor with the name of a path": Refused(
        "  core: {column",
        "  ../core: {column",
        "../core",
        ("found: '../core'", "letters"),
    ),
    "no sensor takes part": Refused(
        "  joint: {column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}\n"
        "  core: {column: core, output: core.temperature, offset: 0, uncertainty: 0.3}",
        "  joint: {column: joint, output: wall.interface_1_temperature, use: false}",
        "sensors:",
        ("use: false on every sensor",),
    ),
    "uncertainty of nothing": Refused(
        "uncertainty: 0.2", "uncertainty: 0", "uncertainty: 0}", ("greater than 0",)
    ),
    "mask of nothing": Refused("mask: [stuck]", "mask: [stick]", "stick", ("quality.mask.0", "mean 'stuck'")),
    "two climates": Refused(
        "  measured:\n",
        "  epw: a.epw\n  measured:\n",
        "climate:",
        ("found: epw, measured", "Keep exactly one"),
    ),
    "a key twice": Refused(
        "  core: {column",
        "  joint: {column",
        "joint: {column: core",
        ("sensors.joint", "first on line 13"),
    ),
    "a tab": Refused("step: 30min", "\tstep: 30min", "\tstep", ("no YAML", "Indent with spaces")),
    "a number in the place of bounds": Refused(
        "materials.brick.conductivity:",
        "materials.brick.conductivity: 0.6",
        "conductivity: 0.6",
        ("found: 0.6", "a mapping", "write {low: , high: }"),
    ),
    "a list in the place of bounds": Refused(
        "materials.brick.conductivity:",
        "materials.brick.conductivity: [0.3, 1.2]",
        "[0.3, 1.2]",
        ("found: [0.3, 1.2]", "Write {low: 0.3, high: 1.2}"),
    ),
    "a number in the place of a time zone": Refused(
        MEASURED + "  timezone: UTC+1",
        MEASURED + "  timezone: 1",
        "timezone: 1\n",
        ("measurements.timezone", "found: '1'", "UTC+4"),
    ),
    "a building in the place of a study": Refused(
        STUDY,
        BUILDING,
        "name: Test wall",
        ("found: a building", "expected: a study", "mascarin run FILE"),
    ),
    "too short to identify on": Refused(
        IDENTIFIED,
        '["2023-03-02 00:00", "2023-03-02 00:20"]',
        "identification:\n",
        ("4 parameters cannot be estimated from 2 measured values", "a longer period"),
    ),
    # --- the building, through the study
    "negative thickness": Refused(
        "thickness: 0.06",
        "thickness: -0.06",
        "-0.06",
        ("thickness", "found: -0.06", "above 0"),
        "building.yaml",
    ),
    "construction without layers": Refused(
        BUILDING[BUILDING.index("    layers:") : BUILDING.index("surfaces:")],
        "    layers: []\n",
        "layers: []",
        ("constructions.wall.layers",),
        "building.yaml",
    ),
    "unknown zone": Refused(
        "      measured: room\n",
        "      zone: attic\n      emissivity: 0.9\n",
        "zone: attic",
        ("surfaces.wall.inside.zone", "attic"),
        "building.yaml",
    ),
    "enthalpy that falls": Refused(
        "  brick: {conductivity: {value: 0.60, range: [0.3, 1.2]}, density: 1700, specific_heat: 850}",
        "  brick: {kind: pcm, conductivity: 0.6, density: 1700, specific_heat: 850, latent_heat: 50000, "
        "melting_temperature: 20, "
        "law: {kind: table, temperatures: [10, 20, 30], enthalpies: [0, 50000, 40000]}}",
        "enthalpies",
        ("enthalpies",),
        "building.yaml",
    ),
    "two sides on one zone": Refused(
        "      outdoors: true\n      irradiance: sun\n      absorptance: {value: 0.5, range: [0.2, 0.8]}\n"
        "      emissivity: 0.9\n      convection: {value: 15, range: [5, 40]}\n    inside:\n"
        "      measured: room\n",
        "      zone: hall\n      emissivity: 0.9\n      convection: 3\n    inside:\n      zone: hall\n"
        "      emissivity: 0.9\n",
        "zone: hall\n      emissivity: 0.9\n      convection: {value: 8",
        ("surfaces.wall.inside.zone", "internal_mass: true"),
        "building.yaml",
    ),
    "unknown key of the building": Refused(
        "altitude: 200",
        "altitud: 200",
        "altitud",
        ("the key 'altitud'", "mean 'altitude'"),
        "building.yaml",
    ),
}


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("table")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return folder / "logger.csv"


@pytest.fixture
def bench(tmp_path: Path, table: Path) -> Bench:
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    shutil.copy(table, tmp_path / "logger.csv")
    return Bench(tmp_path)


def refusal(bench: Bench, capsys: pytest.CaptureFixture[str]) -> str:
    """Message of a study that must be refused; no file may remain."""
    before = sorted(bench.folder.rglob("*"))
    code = cli.main(["study", str(bench.study), "-o", str(bench.folder / "out"), "--no-figures"])
    printed = capsys.readouterr()
    assert code == 2, printed.err
    assert printed.out == ""
    assert sorted(bench.folder.rglob("*")) == before
    return printed.err


@pytest.mark.parametrize("name", CASES)
def test_a_study_is_refused_before_it_runs(
    name: str, bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    bench.edit(case.before, case.after, case.file)
    if name == "errors of days from one day":
        bench.edit("  starts: 2", "  starts: 2\n  discrepancy: {}")
    if "zone: hall" in case.after:
        bench.edit("surfaces:\n", "zones: {hall: {volume: 10}}\nsurfaces:\n", case.file)
    text = (bench.folder / case.file).read_text(encoding="utf-8")
    assert case.line in text
    line = text[: text.index(case.line)].count("\n") + 1
    said = refusal(bench, capsys)
    assert f"{case.file}:{line}: " in said
    for part in case.says:
        assert part in said


def gap(table: pd.DataFrame, column: str) -> None:
    table.loc[300:302, column] = np.nan


def dead(table: pd.DataFrame, column: str) -> None:
    table.loc[100:800, column] = float(table[column].iloc[100])


def words(table: pd.DataFrame, column: str) -> None:
    table[column] = table[column].astype(object)
    table.loc[300, column] = "error"


def twice(table: pd.DataFrame, column: str) -> None:
    table.loc[300, column] = str(table[column].iloc[299])


def code(table: pd.DataFrame, column: str) -> None:
    table.loc[300:302, column] = -9999.0


TABLES: dict[str, tuple[Callable[[pd.DataFrame, str], None], str, tuple[str, ...]]] = {
    "NaN in the weather": (gap, "air", ("logger.csv:302", "air_temperature has no value", "fill_gaps: 2h")),
    "NaN in a boundary": (gap, "room", ("logger.csv:302", "room has no value", "fill_gaps: 2h")),
    "words in the weather": (
        words,
        "air",
        ("study.yaml:4: climate.measured", "line 302", "'error'", "missing: ['error']"),
    ),
    "words in a sensor": (words, "core", ("study.yaml:14: sensors.core.column", "line 302", "'error'")),
    "a stamp twice": (twice, "time", ("2023-03-03 01:50",)),
    "a dead sensor that is masked": (
        dead,
        "core",
        ("study.yaml:14: sensors.core", "no values", "choose another"),
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_refused_before_a_study_runs(
    name: str, bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil, column, says = TABLES[name]
    table = pd.read_csv(bench.table)
    spoil(table, column)
    table.to_csv(bench.table, index=False)
    said = refusal(bench, capsys)
    for part in says:
        assert part in said


def test_a_stuck_sensor_that_is_not_masked_is_refused(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    bench.edit("mask: [stuck]", "mask: []")
    table = pd.read_csv(bench.table)
    dead(table, "core")
    table.to_csv(bench.table, index=False)
    said = refusal(bench, capsys)
    for part in (
        "study.yaml:14: sensors.core.column",
        "column core stuck from 2023-03-01 16:50",
        "mask: [stuck]",
    ):
        assert part in said


def test_all_errors_are_in_one_message(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    """What is wrong with a table hides neither what else is, nor another column."""
    bench.edit("column: joint", "column: jiont")
    bench.edit("column: core", "column: cor")
    bench.edit("output: core.temperature", "output: core.temprature")
    bench.edit("air_temperature: air}", "air_temperature: airr}")
    bench.edit("materials.brick.conductivity:", "materials.brick.conductvity:")
    said = refusal(bench, capsys)
    assert "study.yaml: 5 faults" in said
    for part in ("'jiont'", "'cor'", "core.temprature", "'airr'", "materials.brick.conductvity"):
        assert part in said


@pytest.mark.parametrize("label", ["as described", "measured", "weather", "fitted"])
def test_a_variant_cannot_bear_a_name_that_results_use(
    label: str, bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    bench.edit(
        "identification:\n  starts",
        f"variants: {{{label}: {{changes: {{site.sky: brunt}}}}}}\nidentification:\n  starts",
    )
    said = refusal(bench, capsys)
    assert f"found: '{label}'" in said
    assert "another name" in said


def test_without_an_identification_a_building_is_only_compared(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    bench.edit(STUDY[STUDY.index("identification:\n  starts") :], "")
    assert cli.main(["validate", str(bench.study), "--json"]) in (0, 1)
    assert json.loads(capsys.readouterr().out)["sensors"]["joint"]["blind"]["nominal"]["n"] > 0
    for command in ("study", "calibrate"):
        assert cli.main([command, str(bench.study), "-o", str(bench.folder / "out")]) == 2
        said = capsys.readouterr().err
        assert "identification: found nothing" in said
        assert "mascarin validate" in said
        assert not (bench.folder / "out").exists()


def test_a_folder_that_is_a_file_is_refused(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    (bench.folder / "out").write_text("mine", encoding="utf-8")
    assert "found a file, expected a folder" in refusal(bench, capsys)
    assert (bench.folder / "out").read_text(encoding="utf-8") == "mine"


def test_a_study_that_is_not_there_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["study", "wall-bensh", "-o", "out"]) == 2
    assert "Did you mean 'wall-bench'?" in capsys.readouterr().err
    assert not Path("out").exists()


def test_gaps_in_what_drives_the_model_are_filled_on_request(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    table = pd.read_csv(bench.table)
    for column in ("air", "room", "core"):
        gap(table, column)
    table.to_csv(bench.table, index=False)
    bench.edit("    timezone: UTC+1\n    columns", "    timezone: UTC+1\n    fill_gaps: 1h\n    columns")
    bench.edit(MEASURED, MEASURED + "  fill_gaps: 20min\n")
    assert "room has no value" in refusal(bench, capsys)
    bench.edit("fill_gaps: 20min", "fill_gaps: 30min")
    from mascarin.study import Study

    study = Study(bench.study)
    assert any("3 missing values of room filled" in text for text in study.measurements.provenance)
    # What is compared is never filled, and what was missing is named.
    assert study.measurements.data["core"].isna().sum() == 3
    assert {s.channel for s in study.quality if s.kind == "missing"} >= {"room", "core"}


def test_a_code_that_is_named_is_no_value(bench: Bench) -> None:
    from mascarin.study import Study

    table = pd.read_csv(bench.table)
    code(table, "core")
    table.to_csv(bench.table, index=False)
    bench.edit(MEASURED, MEASURED + "  missing: [-9999]\n")
    assert Study(bench.study).measurements.data["core"].isna().sum() == 3


def test_an_irradiance_in_kilowatts_is_asked_about(bench: Bench) -> None:
    from mascarin.study import Study

    table = pd.read_csv(bench.table)
    table["sun"] /= 1000.0
    table.to_csv(bench.table, index=False)
    with pytest.warns(UserWarning, match=r"irradiance sun is 0\.\d+ W/m2 at most; is it kW/m2"):
        Study(bench.study)


def test_a_bare_number_is_seconds(bench: Bench) -> None:
    from mascarin.study import Study

    bench.edit("step: 30min", "step: 1800")
    assert Study(bench.study).context.models.nominal.step_seconds == 1800.0


def test_a_code_in_a_sensor_is_counted_as_missing(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    table = pd.read_csv(bench.table)
    code(table, "core")
    table.to_csv(bench.table, index=False)
    assert cli.main(["study", str(bench.study), "-o", str(bench.folder / "out"), "--no-figures"]) == 0
    assert "3 missing (3 '-9999')" in capsys.readouterr().err
