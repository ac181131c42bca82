from __future__ import annotations

import math

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.validation.metrics import compare, compare_sensors


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


def test_the_standard_deviation_is_blind_to_bias_and_the_rmse_is_not() -> None:
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


def test_nothing_to_compare_is_said_and_not_hidden() -> None:
    m = compare([np.nan, np.nan], [1.0, 2.0])
    assert m.n == 0
    assert m.to_dict()["rmse"] is None


def test_a_measured_value_that_never_moves_has_no_percentages() -> None:
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


def test_sensors_are_compared_by_name() -> None:
    measured = {"room": [20.0, 21.0], "flux": [5.0, np.nan]}
    simulated = {"flux": [7.0, 1.0], "room": [20.0, 22.0]}
    found = compare_sensors(measured, simulated, units={"flux": "W/m2"})
    assert list(found) == ["room", "flux"]
    assert found["flux"].unit == "W/m2"
    assert found["flux"].max_error == 2.0
    with pytest.raises(InputError, match="Did you mean 'room'"):
        compare_sensors({"rooom": [1.0]}, {"room": [1.0]})
    with pytest.raises(InputError, match="sensor 'room': simulated"):
        compare_sensors({"room": [1.0]}, {"room": [np.nan]})
