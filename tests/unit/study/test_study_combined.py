"""Sensors that are sums and means of outputs, names of columns, stars for words, and grouped suspicions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from mascarin.cli import main
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.study import Study
from study_support import BUILDING, STUDY, logger_table

FIRST, SECOND = "wall.interface_1_temperature", "core.temperature"


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    building = tmp_path_factory.mktemp("wall") / "building.yaml"
    building.write_text(BUILDING, encoding="utf-8")
    return logger_table(building)


def written(folder: Path, table: pd.DataFrame, sensors: dict[str, Any], **changes: Any) -> Path:
    """A study of the wall with other sensors."""
    plain = yaml.safe_load(STUDY)
    plain |= {"sensors": sensors, **changes}
    table.to_csv(folder / "logger.csv", index="time" not in table)
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(yaml.safe_dump(plain, sort_keys=False), encoding="utf-8")
    return folder / "study.yaml"


def rms(study: Study, sensor: str) -> float:
    return float(study.validate().content.metrics(sensor, "identification", "nominal").rmse or 0.0)


def test_a_sum_and_a_mean_are_those_of_the_outputs_and_columns(tmp_path: Path, table: pd.DataFrame) -> None:
    both = {"column": ["joint", "core"], "offset": 0, "uncertainty": 0.4}
    sensors = {"sum": {**both, "sum": [FIRST, SECOND]}, "mean": {**both, "mean": [FIRST, SECOND]}}
    study = Study.from_yaml(written(tmp_path, table, sensors))
    simulated = study.context.models.nominal.run().to_dataframe()
    total = simulated["sensor_sum"].to_numpy()
    assert total == pytest.approx(2.0 * simulated["sensor_mean"].to_numpy(), rel=1e-12)
    measured = study.context.observation.measured
    assert measured[:, 0] == pytest.approx(2.0 * measured[:, 1], rel=1e-12)
    assert rms(study, "sum") == pytest.approx(2.0 * rms(study, "mean"), rel=1e-6)


def test_a_sum_lacks_where_one_of_its_columns_lacks(tmp_path: Path, table: pd.DataFrame) -> None:
    gap = table.copy()
    gap.loc[gap.index[400:460], "core"] = np.nan
    both = {"column": ["joint", "core"], "offset": 0, "uncertainty": 0.4}
    sensors = {"sum": {**both, "sum": [FIRST, SECOND]}, "mean": {**both, "mean": [FIRST, SECOND]}}
    measured = Study.from_yaml(written(tmp_path, gap, sensors)).context.observation.measured
    assert np.isnan(measured[:, 0]).sum() > 0
    assert np.isfinite(measured[:, 1]).all()


def test_a_study_with_a_sum_is_written_and_read_again(tmp_path: Path, table: pd.DataFrame) -> None:
    sensors = {"total": {"column": ["joint", "core"], "sum": [FIRST, SECOND], "uncertainty": 0.4}}
    study = Study.from_yaml(written(tmp_path, table, sensors))
    (tmp_path / "again.yaml").write_text(study.to_yaml(), encoding="utf-8")
    assert "sensor_total" not in study.to_yaml()
    assert rms(Study.from_yaml(tmp_path / "again.yaml"), "total") == pytest.approx(rms(study, "total"))


@pytest.mark.parametrize(
    ("sensor", "message"),
    [
        ({"sum": ["total", SECOND]}, "found 'total', the sensor itself"),
        ({"sum": ["sensor_total", SECOND]}, "found 'sensor_total', the sensor itself"),
        ({"sum": [SECOND, SECOND]}, f"'{SECOND}' twice"),
        ({"sum": [FIRST, "wall.inside_flux"]}, "found outputs in degC and W/m2"),
        ({"sum": [FIRST, "core.temprature"]}, "core.temperature"),
        ({"sum": [FIRST, SECOND], "output": FIRST}, "one of output, sum and mean"),
        ({}, "no output"),
        ({"sum": [FIRST]}, "sum"),
    ],
)
def test_sums_that_cannot_be_made(
    sensor: dict[str, Any], message: str, tmp_path: Path, table: pd.DataFrame
) -> None:
    total = {"column": ["joint", "core"], "uncertainty": 0.4, **sensor}
    with pytest.raises(InputError) as error:
        Study.from_yaml(written(tmp_path, table, {"total": total}))
    assert message in str(error.value)


def test_columns_have_other_names_in_the_table(tmp_path: Path, table: pd.DataFrame) -> None:
    """A star stands for the same text in both; the longest pattern counts, a name of its own before it."""
    sensors = yaml.safe_load(STUDY)["sensors"]
    plain = Study.from_yaml(written(tmp_path, table, sensors))
    expected = rms(plain, "joint")
    other = table.rename(columns={name: f"N2_{name}" for name in ("joint", "core", "room")})
    other = other.rename(columns={"N2_room": "room_of_N2"})
    columns = {"*": "N2_*", "sun": "sun", "room": "room_of_N2"}
    measurements = {"table": "logger.csv", "timezone": "UTC+1", "columns": columns}
    folder = tmp_path / "renamed"
    folder.mkdir()
    study = Study.from_yaml(written(folder, other, sensors, measurements=measurements))
    assert rms(study, "joint") == pytest.approx(expected, rel=1e-12)
    columns["*"] = "N3_*"
    with pytest.raises(InputError, match=r"sensors\.core\.column.*N3_core"):
        Study.from_yaml(written(folder, other, sensors, measurements=measurements))
    columns["*"] = "N2_joint"
    with pytest.raises(InputError, match=r"at most one \*"):
        Study.from_yaml(written(folder, other, sensors, measurements=measurements))


def test_a_star_stands_for_words_too() -> None:
    room = box()
    changed = room.replace({"surfaces.*.outside.longwave": "none", "zones.*.longwave": "none"})
    sides = [surface.outside.longwave for surface in changed.surfaces.values()]
    assert all(side is not None and side.kind == "none" for side in sides)
    assert all(zone.longwave.kind == "none" for zone in changed.zones.values())
    stated = room.replace({"surfaces.*.dimensions": "external"})
    assert {surface.dimensions for surface in stated.surfaces.values()} == {"external"}
    with pytest.raises(InputError, match="found nothing in the building that matches"):
        room.replace({"surfaces.*.outside.lngwave": "none"})


def test_words_by_star_in_a_study(tmp_path: Path, table: pd.DataFrame) -> None:
    sensors = yaml.safe_load(STUDY)["sensors"]
    study = Study.from_yaml(written(tmp_path, table, sensors, set={"surfaces.*.dimensions": "external"}))
    assert study.building.surfaces["wall"].dimensions == "external"


def test_suspicions_of_one_column_and_kind_are_one_line(
    tmp_path: Path, table: pd.DataFrame, capsys: pytest.CaptureFixture[str]
) -> None:
    values = table["joint"].to_numpy().copy()
    for first in range(20, 320, 60):
        values[first : first + 24] = values[first]
    wobbling = table.assign(joint=values)
    path = written(tmp_path, wobbling, yaml.safe_load(STUDY)["sensors"])
    suspicious = [stretch for stretch in Study.from_yaml(path).quality if stretch.channel == "joint"]
    assert len(suspicious) > 3
    main(["validate", str(path)])
    lines = [line for line in capsys.readouterr().err.splitlines() if line.startswith("  joint: stuck")]
    assert len(lines) == 1
    assert f"stuck {sum(s.kind == 'stuck' for s in suspicious)} times from" in lines[0]
