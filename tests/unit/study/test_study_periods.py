"""Several periods, excluded days and hours, and periods of single sensors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import cli
from mascarin.errors import InputError
from mascarin.study import Study
from mascarin.study.file.description import Periods
from study_support import BUILDING, STUDY, Bench, logger_table

WARM_UP = '  warm_up: ["2023-03-01 00:00", "2023-03-02 00:00"]\n'
KNOWN = '  identification: ["2023-03-02 00:00", "2023-03-06 00:00"]\n'
HELD = '  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]\n'
CORE = "core: {column: core, output: core.temperature, offset: 0, uncertainty: 0.3}"


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    path = tmp_path_factory.mktemp("table") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return logger_table(path)


@pytest.fixture
def bench(tmp_path: Path, table: pd.DataFrame) -> Bench:
    (tmp_path / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    table.to_csv(tmp_path / "logger.csv")
    return Bench(tmp_path)


def days_of(study: Study, period: str, sensor: int) -> list[int]:
    """Days of March of which a sensor has values in a period."""
    measured = np.isfinite(study.context.observation.measured[:, sensor])
    use = study.context.used[period][:, sensor] & measured
    return sorted({stamp.day for stamp in study.context.observation.times[use]})


def test_several_periods(bench: Bench) -> None:
    bench.edit(KNOWN, '  identification: [["2023-03-02", "2023-03-04"], ["2023-03-06", "2023-03-07"]]\n')
    bench.edit(HELD, '  corroboration: [["2023-03-04", "2023-03-05"], ["2023-03-07", "2023-03-08"]]\n')
    study = Study.from_yaml(bench.study)
    assert days_of(study, "identification", 0) == [2, 3, 6]
    assert days_of(study, "corroboration", 0) == [4, 7]
    assert days_of(study, "blind", 0) == [5, 8, 9]
    problem = study.context.problem()
    # One series of regular instants: the days between count as not compared.
    assert problem.measured.shape == (5 * 48, 2)
    assert int(problem.mask.sum()) == 2 * 3 * 48
    assert study.context.identity()["study"]


def test_excluded_days_and_hours(bench: Bench) -> None:
    bench.edit(
        HELD,
        HELD + '  exclude: ["2023-03-04", ["2023-03-07 06:00", "2023-03-07 12:00"]]\n'
        '  exclude_hours: [["22:00", "02:00"]]\n',
    )
    study = Study.from_yaml(bench.study)
    times, measured = study.context.observation.times, study.context.observation.measured
    gone = np.isnan(measured[:, 0])
    local: Any = times.tz_localize(None)
    expected = (
        (local.day == 4)
        | ((local.day == 7) & (local.hour >= 6) & (local.hour < 12))
        | (local.hour >= 22)
        | (local.hour < 2)
    )
    np.testing.assert_array_equal(gone, expected)
    count = study.run().fitted.scores["joint"]["identification"].n
    assert count == int((~expected & (local.day >= 2) & (local.day < 6)).sum())


def test_a_disturbed_day_that_is_excluded_does_not_act(bench: Bench, table: pd.DataFrame) -> None:
    day: Any = table.index
    disturbed = table.assign(joint=table["joint"] + 4.0 * (day.day == 4))
    disturbed.to_csv(bench.table)
    wrong = Study.from_yaml(bench.study).run().calibration
    bench.edit(HELD, HELD + '  exclude: ["2023-03-04"]\n')
    right = Study.from_yaml(bench.study).run().calibration
    table.to_csv(bench.table)
    clean = Study.from_yaml(bench.study).run().calibration
    np.testing.assert_array_equal(right.x, clean.x)
    assert np.abs(wrong.x / clean.x - 1.0).max() > 0.2


def test_periods_of_a_sensor(bench: Bench) -> None:
    bench.edit(
        CORE,
        CORE.removesuffix("}")
        + ', periods: {identification: ["2023-03-05", "2023-03-07"], corroboration: ["2023-03-03", '
        '"2023-03-04"], exclude: ["2023-03-08"]}}',
    )
    study = Study.from_yaml(bench.study)
    assert days_of(study, "identification", 0) == [2, 3, 4, 5]
    assert days_of(study, "identification", 1) == [5, 6]
    assert days_of(study, "corroboration", 1) == [3]
    assert days_of(study, "blind", 1) == [2, 4, 7, 9]
    assert study.context.periods.identification[1].day == 7
    mask = study.context.problem().mask
    assert mask.sum(axis=0).tolist() == [4 * 48, 2 * 48]
    results = study.run()
    scores = results.fitted.scores["core"]
    assert (scores["identification"].n, scores["corroboration"].n) == (2 * 48, 48)
    assert scores["blind"].rmse < 0.05
    assert results.calibration.values["surfaces.wall.outside.absorptance"] == pytest.approx(0.62, rel=0.01)  # noqa: PD011


@pytest.mark.parametrize(
    ("before", "after", "line", "says"),
    [
        (
            KNOWN,
            '  identification: [["2023-03-02", "2023-03-04"], ["2023-03-03", "2023-03-05"]]\n',
            "identification: [[",
            "expected identification periods that have no instant in common",
        ),
        (
            HELD,
            '  corroboration: [["2023-03-06", "2023-03-07"], ["2023-03-05", "2023-03-06"]]\n',
            "corroboration: [[",
            "which overlaps the identification",
        ),
        (HELD, HELD + "  exclude: [2023-13-45]\n", "exclude:", "2023-13-45"),
        (HELD, HELD + '  exclude_hours: [["25:00", "02:00"]]\n', "exclude_hours:", "an hour of the day"),
        (HELD, '  corroboration: [["2023-03-09", "2023-04-06"]]\n', "corroboration: [[", "move it"),
        (
            CORE,
            CORE.removesuffix("}") + ', periods: {corroboration: ["2023-03-05", "2023-03-07"]}}',
            "periods: {corroboration",
            "sensors.core.periods.corroboration",
        ),
        ("  starts: 2\n", "  starts: 2\n  discrepancy: {persistence: 9d}\n", "persistence: 9d", "lasts 96 h"),
        (
            "  starts: 2\n",
            "  starts: 2\n  profiles: true\n  discrepancy: {}\n",
            "profiles: true",
            "leave profiles out",
        ),
        ("  starts: 2\n", "  method: emcee\n  discrepancy: {}\n", "method: emcee", "write least-squares"),
    ],
)
def test_periods_that_are_refused(
    bench: Bench, capsys: pytest.CaptureFixture[str], before: str, after: str, line: str, says: str
) -> None:
    bench.edit(before, after)
    number = next(
        k for k, text in enumerate(bench.study.read_text(encoding="utf-8").splitlines(), 1) if line in text
    )
    assert cli.main(["validate", str(bench.study)]) == 2
    text = capsys.readouterr().err
    assert f"study.yaml:{number}" in text
    assert says in text


def test_errors_are_estimated_from_several_periods(bench: Bench) -> None:
    bench.edit(KNOWN, '  identification: [["2023-03-02", "2023-03-04"], ["2023-03-06", "2023-03-07"]]\n')
    bench.edit(HELD, '  corroboration: [["2023-03-04", "2023-03-06"], ["2023-03-07", "2023-03-09"]]\n')
    bench.edit(CORE, CORE.replace("offset: 0, uncertainty: 0.3", "standard_uncertainty: 0.1, offset: 0.05"))
    results = Study.from_yaml(bench.study).run()
    assert results.combination is not None
    assert results.combination.forms[0].joint.by_day.shape == (5,)
    assert results.calibration.values["surfaces.wall.outside.absorptance"] == pytest.approx(0.62, rel=0.01)  # noqa: PD011
    assert results.prediction_intervals.coverage["corroboration"].min() > 0.85


def test_a_study_of_several_periods_is_written_and_read(bench: Bench, tmp_path: Path) -> None:
    bench.edit(KNOWN, '  identification: [["2023-03-02", "2023-03-04"], ["2023-03-06", "2023-03-07"]]\n')
    bench.edit(HELD, '  exclude: ["2023-03-05"]\n')
    study = Study.from_yaml(bench.study)
    study.to_yaml(tmp_path / "again.yaml")
    again = Study.from_yaml(tmp_path / "again.yaml")
    assert again.plan.periods == study.plan.periods
    assert days_of(again, "corroboration", 0) == [7, 8, 9]


def test_no_period_is_refused() -> None:
    with pytest.raises(InputError, match="no period"):
        Periods(identification=[])
