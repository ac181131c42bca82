"""What a study states that its data contradict: said before the first run."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from mascarin.study import Study
from mascarin.study.steps.predictive_checks import statements
from study_support import BUILDING, STUDY, Bench, logger_table


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    found = Bench(tmp_path)
    found.building.write_text(BUILDING, encoding="utf-8")
    found.study.write_text(STUDY.replace("offset: 0, ", ""), encoding="utf-8")
    logger_table(found.building).to_csv(found.table)
    return found


def said(bench: Bench) -> dict[str, str]:
    return {one.subject: one.text for one in statements(Study.from_yaml(bench.study).context)}


def test_a_study_as_it_should_be_says_nothing(bench: Bench) -> None:
    assert said(bench) == {}


def test_two_columns_of_one_sensor_with_other_offsets_are_named(bench: Bench) -> None:
    table = pd.read_csv(bench.table, index_col="time")
    table["joint_2"] = table["joint"] + 0.9
    table.to_csv(bench.table)
    bench.edit("{column: joint,", "{column: [joint, joint_2],")
    found = said(bench)
    assert list(found) == ["joint"]
    # 0.9 K apart; both together allow 0.102 * sqrt(2) = 0.144 K of standard uncertainty.
    assert "differ by +0.9 K in the mean, 6.2 times" in found["joint"]


def test_errors_of_days_from_two_days_are_assumed_not_estimated(bench: Bench) -> None:
    bench.edit(
        'identification: ["2023-03-02 00:00", "2023-03-06', 'identification: ["2023-03-02 00:00", "2023-03-04'
    )
    bench.edit('["2023-03-06 00:00", "2023-03-08 00:00"]', '["2023-03-04 00:00", "2023-03-08 00:00"]')
    assert "estimated from 2 days" in said(bench)["discrepancy"]


def test_a_record_that_scatters_by_more_than_is_stated_is_named(bench: Bench) -> None:
    bench.edit("uncertainty: 0.2}", "uncertainty: 0.02}")
    assert "readings scatter by 0.0" in said(bench)["joint"]


@pytest.mark.parametrize(
    ("edit", "reason"),
    [
        (("  starts: 2", "  method: hooke-jeeves\n  cost: sd"), "the cost sd does not weigh them"),
        (("  starts: 2", "  starts: 2\n  profiles: true"), "the profiles hold them at zero"),
    ],
)
def test_uncertainties_that_count_as_scatter_are_said(
    bench: Bench, edit: tuple[str, str], reason: str
) -> None:
    bench.edit(*edit)
    study = Study.from_yaml(bench.study)
    assert not study.context.estimates_errors
    assert reason in said(bench)["sensors"]


def test_sensors_without_an_offset_say_so(bench: Bench) -> None:
    assert Study.from_yaml(bench.study).context.estimates_errors
    bench.edit("uncertainty: 0.2}", "uncertainty: 0.2, offset: 0}")
    bench.edit("uncertainty: 0.3}", "repeatability: 0.03}")
    assert not Study.from_yaml(bench.study).context.estimates_errors
    assert said(bench) == {}


def test_a_meter_that_reads_zero_has_no_offset(bench: Bench) -> None:
    """An offset of half of what was measured would be taken from the wall."""
    table = pd.read_csv(bench.table, index_col="time")
    hours = pd.DatetimeIndex(table.index).hour
    # The heater is off in the night, and the meter reads 0.2 W then.
    table["heater"] = [0.2 if hour < 8 else 300.0 + hour for hour in hours]
    table.to_csv(bench.table)
    stated = "expanded_uncertainty: 250, relative: 0.02"
    bench.edit("sensors:\n", f"sensors:\n  heater: {{column: heater, output: wall.inside_flux, {stated}}}\n")
    found = said(bench)["heater"]
    # 250 W/m2 / 1.96 less the scatter that the jumps of the record show.
    assert "reads 0.2 W/m2 where all is off, and an offset of 12" in found
    remedy = found.partition("write ")[2].partition(",")[0]
    bench.edit(stated, f"{remedy}, repeatability: 40, relative: 0.02")
    assert "heater" not in said(bench)
