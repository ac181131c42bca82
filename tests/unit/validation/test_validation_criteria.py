from __future__ import annotations

import pytest
from pydantic import ValidationError

from mascarin.errors import InputError
from mascarin.validation.comparison import Metrics, compare
from mascarin.validation.criteria import Criterion, judge, parse_criteria

MEASURED = [20.0, 25.0, 30.0]


def _metrics() -> dict[str, dict[str, Metrics]]:
    return {
        "room": {"identification": compare(MEASURED, [20.0, 24.2, 30.0])},
        "sheet": {
            "identification": compare(MEASURED, [20.0, 26.9, 30.0]),
            "blind": compare(MEASURED, [20.0, 22.5, 30.0]),
        },
    }


def test_the_criteria_of_the_reference_study() -> None:
    criteria = parse_criteria(
        [
            {"metric": "max_error_percent", "limit": 10},
            {"metric": "max_error", "limit": 2, "sensors": ["sheet"]},
            {"metric": "max_error", "limit": 1, "sensors": "room"},
        ]
    )
    verdicts = judge(criteria, _metrics())
    found = {(v.sensor, v.period, v.metric): v.passed for v in verdicts}
    assert found == {
        ("room", "identification", "max_error_percent"): True,
        ("sheet", "identification", "max_error_percent"): False,
        ("sheet", "blind", "max_error_percent"): False,
        ("sheet", "identification", "max_error"): True,
        ("sheet", "blind", "max_error"): False,
        ("room", "identification", "max_error"): True,
    }
    blind = next(v for v in verdicts if v.period == "blind" and v.metric == "max_error")
    assert blind.value == pytest.approx(-2.5)  # its size counts, its sign is kept
    assert (blind.name, blind.unit) == ("|max error| <= 2 K", "degC")
    assert verdicts[0].unit == "%"


def test_a_value_on_the_limit_passes() -> None:
    criterion = Criterion(metric="max_error", limit=2.0)
    metrics = {"a": {"p": compare([20.0, 30.0], [20.0, 32.0])}}
    assert judge([criterion], metrics)[0].passed


def test_a_criterion_with_nothing_to_compare_is_not_met() -> None:
    verdict = judge([Criterion(metric="rmse", limit=1.0)], {"a": {"p": compare([float("nan")], [1.0])}})[0]
    assert not verdict.passed
    assert verdict.to_dict()["value"] is None


def test_criteria_are_frozen() -> None:
    with pytest.raises(ValidationError):
        Criterion(metric="rmse", limit=1.0).limit = 2.0  # type: ignore[misc]


@pytest.mark.parametrize(
    ("item", "text"),
    [
        ({"metric": "max_error", "limits": 2}, "unknown key. Did you mean 'limit'"),
        ({"metric": "max_eror", "limit": 2}, "not a metric. Did you mean 'max_error'"),
        ({"metric": "max_error"}, "limit: missing"),
        ({"metric": "max_error", "limit": -1}, r"criteria\[0\].limit"),
        ({"metric": "max_error", "limit": float("nan")}, r"criteria\[0\].limit"),
        ({"metric": "max_error", "limit": 1, "sensors": []}, r"criteria\[0\].sensors"),
    ],
)
def test_impossible_criteria_are_refused(item: dict[str, object], text: str) -> None:
    with pytest.raises(InputError, match=text):
        parse_criteria([item])


def test_unknown_sensors_and_periods_are_named() -> None:
    with pytest.raises(InputError, match=r"sensor 'rooom' was not compared. Did you mean 'room'"):
        judge(parse_criteria([{"metric": "sd", "limit": 1, "sensors": "rooom"}]), _metrics())
    with pytest.raises(InputError, match=r"period 'blnd'.*'blind'"):
        judge(parse_criteria([{"metric": "sd", "limit": 1, "periods": "blnd"}]), _metrics())


def test_criteria_of_the_guideline_apply_to_energy() -> None:
    found = {
        "heating": {"july": compare([300.0, 500.0, 400.0], [310.0, 520.0, 390.0], unit="W")},
        "room": {"july": compare([20.0, 25.0, 30.0], [20.0, 24.0, 30.0])},
    }
    criteria = parse_criteria(
        [
            {"metric": "cv_rmse", "limit": 30, "sensors": "heating"},
            {"metric": "nmbe", "limit": 2, "sensors": "heating"},
            {"metric": "rmse_over_range", "limit": 10},
            {"metric": "bias_over_range", "limit": 3, "sensors": "room"},
        ]
    )
    verdicts = judge(criteria, found)
    assert [v.passed for v in verdicts] == [True, False, True, True, False]
    assert [v.name for v in verdicts[:2]] == ["CV(RMSE) <= 30 %", "|NMBE| <= 2 %"]
    assert verdicts[2].name == "rmse <= 10 % of the measured range"
    assert {v.unit for v in verdicts} == {"%"}


def test_a_criterion_over_the_mean_of_a_temperature_is_refused() -> None:
    with pytest.raises(
        InputError, match=r"criteria\[0\]: found cv_rmse for sensor 'room' in degC.*rmse_over_range"
    ):
        judge(parse_criteria([{"metric": "cv_rmse", "limit": 30}]), _metrics())
