"""A calibration that is carried to another building, of which nothing is identified."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
import yaml

from mascarin.building import load
from mascarin.errors import InputError
from mascarin.study import Study
from mascarin.study.carried.bands import usable
from study_support import BUILDING, STUDY, logger_table

#: A tied factor, and other parameters whose true values are known.
TIED = {
    "materials.insul*.conductivity": {"tie": True, "low": 0.5, "high": 1.5},
    "materials.brick.conductivity": None,
    # Twice the described absorptance is possible, twice the estimated one is not.
    "surfaces.*.outside.absorptance": {"tie": True, "low": 0.4, "high": 2.0},
    "surfaces.wall.inside.convection.coefficient": None,
}
FACTOR = "materials.insul*.conductivity"
#: The insulation of the other wall is thinner.
OTHER = {
    "extends": "building.yaml",
    "name": "Other wall",
    "set": {"constructions.wall.layers.insulation.thickness": 0.04},
}


def written(folder: Path, **changes: object) -> Path:
    """A study of a wall, whose calibration is carried to another one."""
    plain = yaml.safe_load(STUDY)
    plain["identification"]["parameters"] = TIED
    plain |= {"transfer": {"east": {"study": "east.yaml"}}, "sensitivity": None, **changes}
    plain = {key: value for key, value in plain.items() if value is not None}
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "east_building.yaml").write_text(yaml.safe_dump(OTHER), encoding="utf-8")
    (folder / "study.yaml").write_text(yaml.safe_dump(plain, sort_keys=False), encoding="utf-8")
    return folder / "study.yaml"


def tables(folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    south = logger_table(folder / "building.yaml")
    east = logger_table(folder / "east_building.yaml")
    south.to_csv(folder / "logger.csv")
    east.to_csv(folder / "east.csv")
    return south, east


EAST = {
    "extends": "study.yaml",
    "building": "east_building.yaml",
    "climate": {"measured": {"table": "east.csv"}},
    "measurements": {"table": "east.csv"},
}


def test_a_calibration_is_carried_to_another_building(tmp_path: Path) -> None:
    path = written(tmp_path)
    tables(tmp_path)
    (tmp_path / "east.yaml").write_text(yaml.safe_dump(EAST), encoding="utf-8")
    results = Study.from_yaml(path).run(tmp_path / "out", figures=False)
    entry = results.transfer["east"]
    assert entry.building == "Other wall"
    for sensor in ("joint", "core"):
        for scores in entry.sensors[sensor].values():
            before, after = scores.described.rmse, scores.calibrated.rmse
            assert before is not None
            assert after is not None
            assert after < 0.5 * before
            assert (scores.held or 0.0) > 0.85
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Transfer of the calibration" in report
    assert "Other wall" in report
    # The tied factor is one of the calibrated building: 1, with its spread.
    building = load(tmp_path / "out" / "calibrated.yaml")
    assert building.posterior is not None
    estimate, low, high = building.posterior.intervals[FACTOR]
    assert estimate == pytest.approx(1.0)
    assert low < 1.0 < high
    columns, words = usable(building, building.posterior)
    assert building.posterior.paths.index(FACTOR) in columns
    assert words == []
    position = building.posterior.paths.index(FACTOR)
    assert building.posterior.draws[:, position].std() > 0.0
    assert building.posterior.draws[:, position].mean() == pytest.approx(1.0, abs=high - low)


def test_two_records_of_one_time_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path)
    tables(tmp_path)
    (tmp_path / "east.yaml").write_text(yaml.safe_dump({"extends": "study.yaml"}), encoding="utf-8")
    with pytest.raises(InputError, match=r"transfer\.east\.study.*this study compares from"):
        Study.from_yaml(path)
    twice = {"transfer": {"east": {"study": "east.yaml"}, "again": {"study": "east.yaml"}}}
    (tmp_path / "east.yaml").write_text(yaml.safe_dump(EAST), encoding="utf-8")
    with pytest.raises(InputError, match=r"transfer\.again\.study.*'east' compares from"):
        Study.from_yaml(written(tmp_path, **twice))


def test_other_days_of_one_table_are_another_record(tmp_path: Path) -> None:
    days = {"identification": ["2023-03-06 00:00", "2023-03-08 00:00"], "corroboration": None}
    own = {"warm_up": None, "identification": ["2023-03-02 00:00", "2023-03-06 00:00"]}
    path = written(tmp_path, periods={key: value for key, value in own.items() if value})
    tables(tmp_path)
    later = {"extends": "study.yaml", "periods": {key: value for key, value in days.items() if value}}
    (tmp_path / "east.yaml").write_text(yaml.safe_dump(later), encoding="utf-8")
    assert list(Study.from_yaml(path).context.inputs.transfer) == ["east"]


def test_a_study_that_is_missing_is_named(tmp_path: Path) -> None:
    path = written(tmp_path)
    tables(tmp_path)
    with pytest.raises(InputError, match=r"transfer\.east\.study.*found no file"):
        Study.from_yaml(path)
