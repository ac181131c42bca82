"""Digits of numbers by their uncertainty, or by the distance to a limit."""

from __future__ import annotations

import pytest

from mascarin._io.numbers import beside_limit, decimals_for, fixed, with_interval
from mascarin.figures import text
from mascarin.pages.study.sections import criteria, parameters
from mascarin.study_document.document import StudyDocument


@pytest.mark.parametrize(
    ("uncertainty", "decimals"), [(0.043, 3), (0.25, 2), (1.0, 1), (0.0996, 2), (9.96, 0), (250.0, -1)]
)
def test_an_uncertainty_has_two_digits(uncertainty: float, decimals: int) -> None:
    assert decimals_for(uncertainty) == decimals


@pytest.mark.parametrize(
    ("numbers", "shown"),
    [
        ((24.0, 23.96, 24.05), ("24.000", "23.960", "24.050")),
        ((24.0, 23.6, 24.4), ("24.00", "23.60", "24.40")),
        ((2467.0, 2210.0, 2730.0), ("2470", "2210", "2730")),
        ((-0.00123, -0.0015, -0.00093), ("-0.00123", "-0.00150", "-0.00093")),
        ((21.4567, None, None), ("21.46", "", "")),
        ((21.4567, float("nan"), float("nan")), ("21.46", "", "")),
    ],
)
def test_an_estimate_and_its_interval_have_the_same_decimals(
    numbers: tuple[float, float | None, float | None], shown: tuple[str, str, str]
) -> None:
    assert with_interval(*numbers) == shown


@pytest.mark.parametrize(
    ("value", "limit", "shown"),
    [
        (0.25004, 0.25, ("0.25004", "0.25")),
        (0.24996, 0.25, ("0.24996", "0.25")),
        (-0.25004, 0.25, ("-0.25004", "0.25")),
        (0.25, 0.25, ("0.25", "0.25")),
        (0.3, 0.25, ("0.30", "0.25")),
        (0.3, 0.125, ("0.30", "0.125")),
        (1.004, 1.0, ("1.004", "1.00")),
        (float("nan"), 0.5, ("nan", "0.50")),
    ],
)
def test_a_value_beside_its_limit_shows_on_which_side_it_is(
    value: float, limit: float, shown: tuple[str, str]
) -> None:
    assert beside_limit(value, limit) == shown


def test_no_negative_zero() -> None:
    assert fixed(-0.0004, 2) == "0.00"


def test_the_report_shows_the_digits_of_the_interval() -> None:
    entry = {
        "nominal": 24.0,
        "fitted": 24.02,
        "low": 23.978,
        "high": 24.062,
        "unit": "degC",
        "range": [20, 30],
    }
    study = StudyDocument.read({"parameters": {"materials.pcm.law.temperature": entry}})
    [row] = parameters.content(study, None)["rows"]  # type: ignore[arg-type, index]
    assert (row["fitted"], row["interval"]) == ("24.020", "23.978 to 24.062")


def test_the_report_keeps_signs_and_thousands() -> None:
    assert text.with_interval(-0.5, -0.75, -0.25) == ("−0.50", "−0.75 to −0.25")
    assert text.with_interval(12467.0, 12210.0, 12730.0)[0] == "12\u202f470"


def test_the_report_shows_that_a_limit_is_missed() -> None:
    verdict = {
        "model": "fitted", "name": "|rmse| <= 0.25 K", "sensor": "room", "period": "identification",
        "metric": "rmse", "value": 0.2503, "limit": 0.25, "unit": "K", "passed": False,
    }  # fmt: skip
    [group] = criteria.content(StudyDocument.read({"criteria": [verdict]}), None)  # type: ignore[arg-type, misc]
    assert (group["rows"][0]["value"], group["rows"][0]["limit"]) == ("0.2503", "0.25")
