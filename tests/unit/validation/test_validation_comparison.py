from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.validation.comparison import Metrics, compare, metrics


def test_every_metric_of_a_series_worked_out_by_hand() -> None:
    measured = [20.0, 22.0, 24.0, 30.0]
    simulated = [21.0, 22.0, 21.0, 32.0]  # differences 1, 0, -3, 2
    m = compare(measured, simulated)
    assert m.n == 4
    assert m.bias == 0.0
    assert m.sd == pytest.approx(math.sqrt(14 / 4))
    assert m.rmse == pytest.approx(math.sqrt(14 / 4))
    assert m.mean_error == 1.5
    assert m.max_error == -3.0
    assert m.measured_range == 10.0
    assert m.mean_error_percent == pytest.approx(15.0)
    assert m.max_error_percent == pytest.approx(-30.0)
    assert m.unit == "degC"


def test_the_rmse_contains_the_bias_and_the_standard_deviation_does_not() -> None:
    rng = np.random.default_rng(0)
    measured = rng.normal(25.0, 3.0, 500)
    error = rng.normal(0.0, 0.4, 500)
    plain, shifted = compare(measured, measured + error), compare(measured, measured + error + 2.0)
    assert shifted.sd == pytest.approx(plain.sd)
    assert shifted.bias == pytest.approx(plain.bias + 2.0)
    assert shifted.rmse**2 == pytest.approx(shifted.sd**2 + shifted.bias**2)


def test_gaps_and_masked_samples_are_left_out_of_everything() -> None:
    measured = [20.0, np.nan, 24.0, 90.0]
    simulated = [20.5, 50.0, 24.5, 10.0]
    m = compare(measured, simulated, use=[True, True, True, False])
    assert (m.n, m.bias, m.measured_range) == (2, 0.5, 4.0)
    # The mask that came in is not changed by the gaps.
    mask = np.ones(4, dtype=bool)
    compare(measured, simulated, use=mask)
    assert mask.all()


def test_without_values_all_metrics_are_missing() -> None:
    m = compare([np.nan, np.nan], [1.0, 2.0])
    assert m.n == 0
    assert m.to_dict()["rmse"] is None


def test_a_constant_measured_value_has_no_percentages_of_the_range() -> None:
    m = compare([21.0, 21.0], [22.0, 21.0])
    assert m.mean_error == 0.5
    assert math.isnan(m.mean_error_percent)


@pytest.mark.parametrize(
    ("measured", "simulated", "text"),
    [
        ([1.0, 2.0], [1.0, np.nan], "first at sample 1"),
        ([1.0, 2.0], [1.0], "one length"),
        ([1.0, np.inf], [1.0, 2.0], "infinite value at sample 1"),
    ],
)
def test_unusable_series_are_refused(measured: list[float], simulated: list[float], text: str) -> None:
    with pytest.raises(InputError, match=text):
        compare(measured, simulated)


# --- metrics over the mean: ASHRAE Guideline 14 ---------------------------------------------------------

POWER = [300.0, 500.0, 400.0, 800.0]  # mean 500 W
SIMULATED = [330.0, 490.0, 380.0, 820.0]  # differences 30, -10, -20, 20


def test_metrics_of_the_guideline_by_hand() -> None:
    m = metrics(POWER, SIMULATED, unit="W")
    # n - p = 4 - 1 degrees of freedom: sqrt(1800 / 3) / 500 and (20 / 3) / 500.
    assert m.cv_rmse == pytest.approx(100.0 * math.sqrt(600.0) / 500.0)
    assert m.nmbe == pytest.approx(100.0 * (20.0 / 3.0) / 500.0)
    assert m.rmse_over_range == pytest.approx(100.0 * math.sqrt(450.0) / 500.0)
    assert m.bias_over_range == pytest.approx(1.0)
    assert m.remark == ""


def test_the_sign_of_nmbe_is_that_of_the_bias() -> None:
    # Heat extracted, counted negative: the model is 10 W too high.
    m = metrics([-90.0, -110.0], [-80.0, -100.0], unit="W")
    assert m.bias == 10.0
    assert m.nmbe == pytest.approx(20.0)
    assert m.cv_rmse == pytest.approx(100.0 * math.sqrt(200.0) / 100.0)


@pytest.mark.parametrize(
    ("measured", "unit", "text"),
    [
        ([20.0, 22.0], "degC", "depends on the zero of its scale"),
        ([-100.0, 100.5], "W", "0.25 W, is nearly zero"),
        ([5.0], "W", "no degree of freedom"),
    ],
)
def test_a_metric_over_a_mean_without_meaning_is_missing(measured: list[float], unit: str, text: str) -> None:
    m = metrics(measured, measured, unit=unit)
    assert math.isnan(m.cv_rmse)
    assert math.isnan(m.nmbe)
    assert text in m.remark
    assert m.to_dict()["cv_rmse"] is None
    assert m.rmse == 0.0


def test_metrics_of_a_temperature_do_not_depend_on_its_scale() -> None:
    celsius = metrics([20.0, 22.0, 26.0], [21.0, 22.0, 24.0])
    kelvin = metrics([293.15, 295.15, 299.15], [294.15, 295.15, 297.15], unit="K")
    assert celsius.rmse_over_range == pytest.approx(kelvin.rmse_over_range)
    assert celsius.bias_over_range == pytest.approx(kelvin.bias_over_range)


def test_series_are_compared_at_their_common_times() -> None:
    times = pd.date_range("2024-07-01", periods=4, freq="1h", tz="Europe/Paris")
    measured = pd.Series(POWER, index=times)
    simulated = pd.Series([0.0, *SIMULATED], index=times[:1].append(times) - pd.Timedelta("1h")).iloc[1:]
    found = metrics(measured, simulated, unit="W")
    assert found.n == 3
    assert found.bias == pytest.approx(np.mean([490.0 - 300.0, 380.0 - 500.0, 820.0 - 400.0]))
    # The same instants in another time zone, and a part of them.
    same = metrics(measured, pd.Series(SIMULATED, index=times.tz_convert("UTC")), unit="W")
    assert same == metrics(POWER, SIMULATED, unit="W")
    part = metrics(measured, pd.Series(SIMULATED, index=times), use=[True, True, False, False], unit="W")
    assert (part.n, part.bias) == (2, 10.0)


def test_series_that_cannot_be_aligned_are_refused() -> None:
    times = pd.date_range("2024-07-01", periods=4, freq="1h", tz="UTC")
    measured = pd.Series(POWER, index=times)
    with pytest.raises(InputError, match="no common label"):
        metrics(measured, pd.Series(SIMULATED, index=times + pd.Timedelta("1min")))
    with pytest.raises(InputError, match=r"2024-07-01 00:00:00.*is there twice"):
        metrics(measured, pd.Series(SIMULATED, index=times[[0, 0, 1, 2]]))
    with pytest.raises(InputError, match="one flag for each of 4"):
        metrics(measured, pd.Series(SIMULATED, index=times), use=[True])


def test_metrics_are_shown_shortly_and_as_a_table() -> None:
    m = metrics([20.0, 22.0], [20.5, 22.5])
    assert len(repr(m).splitlines()) <= 15
    assert "not given           cv_rmse, nmbe: the unit is degC" in repr(m)
    assert "<table>" in m._repr_html_()
    table = m.to_dataframe()
    assert (table.loc["rmse", "value"], table.loc["rmse", "unit"]) == (0.5, "degC")
    assert table.loc["rmse_over_range", "unit"] == "%"
    assert set(Metrics.__slots__) >= set(table.index)
