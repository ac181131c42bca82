"""A calibrated building with its posterior: written, extended, and used in another season and building."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.calibration.errors.posterior_checks import Contradiction, of_fit
from mascarin.errors import InputError
from mascarin.study import Study
from mascarin.study.carried.bands import day_numbers
from mascarin.study.steps import predictive_checks
from study_support import BUILDING, STUDY, TRUTH, Bench, drivers, logger_table, open_climate

INSULATION = "materials.insulation.conductivity"
EXTENDING = """\
extends: out/calibrated.yaml
name: Second wall
"""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """A study that has been carried out, and a second study beside it that extends its building."""
    folder = tmp_path_factory.mktemp("carried")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    text = STUDY.replace("offset: 0, uncertainty: 0.2}", "offset: 0.1, repeatability: 0.03}")
    text = text.replace("offset: 0, uncertainty: 0.3}", "offset: 0.1, repeatability: 0.03}")
    text = text.replace("sensitivity: {replicates: 3, interval: 1h}\n", "")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    Study.from_yaml(folder / "study.yaml").run(folder / "out", figures=False)
    (folder / "second.yaml").write_text(EXTENDING, encoding="utf-8")
    (folder / "again.yaml").write_text(
        text.replace("building: building.yaml", "building: second.yaml"), encoding="utf-8"
    )
    return Bench(folder)


def test_the_calibrated_building_has_its_posterior(bench: Bench) -> None:
    building = mc.load(bench.folder / "out" / "calibrated.yaml")
    posterior = building.posterior
    assert posterior is not None
    assert tuple(posterior.intervals) == tuple(TRUTH)
    assert "surfaces.wall.outside.convection.coefficient" in posterior.numbers
    assert posterior.draws.shape == (100, len(posterior.paths))
    low, high = np.quantile(posterior.draws, [0.025, 0.975], axis=0)
    for k, (path, (estimate, bottom, top)) in enumerate(posterior.intervals.items()):
        assert building.parameter(path).value == pytest.approx(estimate, rel=1e-5)
        assert bottom < TRUTH[path] < top
        # The sample has the intervals of the report, to the scatter of 100 draws.
        assert low[k] == pytest.approx(bottom, abs=0.15 * (top - bottom))
        assert high[k] == pytest.approx(top, abs=0.15 * (top - bottom))
    assert set(posterior.sensors) == {"joint", "core"}
    assert "offset" in posterior.sensors["joint"].errors
    assert posterior.weather["air_temperature"][0] < posterior.weather["air_temperature"][1]


def test_it_is_read_as_it_was_written_and_changes_no_run(bench: Bench, tmp_path: Path) -> None:
    building = mc.load(bench.folder / "out" / "calibrated.yaml")
    building.to_yaml(tmp_path / "copy.yaml")
    assert mc.load(tmp_path / "copy.yaml") == building
    without = building.replace({"posterior": None})
    assert [p.path for p in without.parameters()] == [p.path for p in building.parameters()]
    assert str(without.to_engine()) == str(building.to_engine())


def test_an_edited_posterior_is_refused(bench: Bench, tmp_path: Path) -> None:
    text = (bench.folder / "out" / "calibrated.yaml").read_text(encoding="utf-8")
    assert text.count("days: 4") == 1
    (tmp_path / "edited.yaml").write_text(text.replace("days: 4", "days: 40"), encoding="utf-8")
    with pytest.raises(InputError, match="edited or merged"):
        mc.load(tmp_path / "edited.yaml")


def test_bands_of_the_same_season_hold_and_name_no_extrapolation_of_weather(bench: Bench) -> None:
    validation = Study.from_yaml(bench.folder / "again.yaml").validate(bench.folder / "compared")
    for name, entry in validation.bands.items():
        assert (entry.held["identification"] or 0.0) > 0.95, name
        assert 0.2 < (entry.half_width or 0.0) < 1.5
    table = validation.to_dataframe()
    assert table["joint.prediction_band [K]"].notna().all()
    assert (bench.folder / "compared" / "series.csv").read_text(encoding="utf-8").startswith("time,")


def test_another_season_widens_the_bands_and_says_so(bench: Bench) -> None:
    """The same wall in an air that is 25 K warmer: the laws are the same, the study has not seen it."""
    building = mc.load(bench.folder / "second.yaml")
    table = drivers().assign(air=lambda t: t["air"] + 25.0)
    climate = open_climate(table)
    logger = mc.Measurements.from_table(table, timezone="UTC+1")
    run = mc.simulate(
        building.replace(TRUTH), climate, step="30min", measurements=logger,
        outputs=["wall.interface_1_temperature", "core.temperature"],
    )  # fmt: skip
    measured = run.to_dataframe().iloc[:-1]
    measured.index = pd.DatetimeIndex(measured.index).tz_localize(None)
    both = (
        table.resample("30min")
        .first()
        .join(measured.rename(columns={"wall.interface_1_temperature": "joint", "core.temperature": "core"}))
    )
    summer = Study(
        building=building,
        climate=climate,
        measurements=mc.Measurements.from_table(both, timezone="UTC+1"),
        sensors={
            "joint": {"column": "joint", "output": "wall.interface_1_temperature", "offset": 0.1},
            "core": {"column": "core", "output": "core.temperature", "offset": 0.1},
        },
        periods={"warm_up": ("2023-03-01", "2023-03-02"), "identification": ("2023-03-02", "2023-03-05")},
        step="30min",
    )
    validation = summer.validate()
    here = Study.from_yaml(bench.folder / "again.yaml").validate()
    assert any("air temperature" in text and "extrapolates" in text for text in validation.remarks)
    assert not any("extrapolates" in text and "air temperature: the daily means of 7" in text
                   for text in here.remarks)  # fmt: skip
    for name, entry in validation.bands.items():
        assert entry.extrapolated == 1.0
        assert (entry.half_width or 0.0) > 1.5 * (here.bands[name].half_width or math.inf)
        assert min(share for share in entry.held.values() if share is not None) > 0.9


def test_another_value_counts_as_known(bench: Bench) -> None:
    building = mc.load(bench.folder / "second.yaml").replace({INSULATION: 0.05})
    study = Study.from_yaml(bench.folder / "again.yaml")
    other = Study(
        building=building, climate=study.climate, measurements=study.measurements,
        sensors={"joint": {"column": "joint", "output": "wall.inside_temperature", "offset": 0.1}},
        periods={"identification": ("2023-03-02", "2023-03-05")}, step="30min",
    )  # fmt: skip
    remarks = " ".join(other.validate().remarks)
    assert f"other values than their estimates, which count as known: {INSULATION}" in remarks
    assert "wall.inside_temperature was not measured in the identification" in remarks


def test_days_are_those_of_the_clock_on_the_wall() -> None:
    index = pd.DatetimeIndex(drivers(2).index).tz_localize("UTC+01:00")
    assert np.bincount(day_numbers(index)).tolist() == [144, 144]


def test_a_study_samples_its_posterior_and_writes_the_chains(bench: Bench, tmp_path: Path) -> None:
    text = (bench.folder / "study.yaml").read_text(encoding="utf-8")
    sampled = bench.folder / "sampled.yaml"
    sampled.write_text(
        text.replace("  starts: 2", "  starts: 2\n  posterior: sampled\n  draws: 150"), encoding="utf-8"
    )
    results = Study.from_yaml(sampled).run(tmp_path / "out", figures=False)
    chains = results.calibration.posterior
    assert chains is not None
    assert chains.names == (*TRUTH, "joint offset", "core offset")
    assert chains.draws.shape == (16, 150, 6)
    assert (tmp_path / "out" / "posterior.nc").is_file()
    assert "sampled with the model itself" in results.calibration.uncertainty_method
    plain = mc.load(bench.folder / "out" / "calibrated.yaml").posterior
    assert plain is not None
    for path, low, high in zip(TRUTH, results.calibration.low, results.calibration.high, strict=True):
        assert low < TRUTH[path] < high
        _, bottom, top = plain.intervals[path]
        assert 0.4 < (high - low) / (top - bottom) < 2.5, path


def test_what_is_not_estimated_cannot_be_sampled(bench: Bench) -> None:
    text = (bench.folder / "study.yaml").read_text(encoding="utf-8")
    file = bench.folder / "refused.yaml"
    scatter = text.replace("offset: 0.1, repeatability: 0.03", "offset: 0, uncertainty: 0.1")
    file.write_text(scatter.replace("  starts: 2", "  starts: 2\n  posterior: sampled"), encoding="utf-8")
    with pytest.raises(InputError, match="posterior: found sampled, expected linearized"):
        Study.from_yaml(file)


def test_a_fit_that_is_worse_than_the_description_has_no_bands_elsewhere(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its own bands stay, because they hold there; the report and another study say why."""
    for name in ("building.yaml", "study.yaml", "logger.csv", "second.yaml", "again.yaml"):
        (tmp_path / name).write_bytes((bench.folder / name).read_bytes())

    def worse(described: dict[str, float], *_: object) -> list[Contradiction]:
        return of_fit(*(dict.fromkeys(described, size) for size in (0.1, 0.2, 1.0)))

    monkeypatch.setattr(predictive_checks, "of_fit", worse)
    results = Study.from_yaml(tmp_path / "study.yaml").run(tmp_path / "out", figures=False)
    assert any("2.00 times, most in" in one.text for one in results.contradictions)
    document = json.loads((tmp_path / "out" / "study.json").read_text(encoding="utf-8"))
    assert document["band"]["joint"].get("stated", True)
    posterior = mc.load(tmp_path / "out" / "calibrated.yaml").posterior
    assert posterior is not None
    assert not posterior.stated
    again = Study.from_yaml(tmp_path / "again.yaml").validate()
    assert any("no bands: those of the study 'Test wall' are not stated" in text for text in again.remarks)
    assert not again.bands
