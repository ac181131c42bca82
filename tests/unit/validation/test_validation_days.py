"""The choice of days: leverage and information of single days by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mascarin.commands.studies.study import day_lines
from mascarin.errors import InputError
from mascarin.validation.days import choose_days

LABELS = ["Mon", "Tue", "Wed"]


def test_leverage_and_information_of_one_parameter() -> None:
    # Slopes 1, 2 and 0 with errors of 0.5: information 4, 16 and 0; the first day is used, no prior.
    slopes = np.array([1.0, 2.0, 0.0])[None, :, None]
    found = choose_days(slopes, [0.5], LABELS, [0, 1, 2], [True, False, False], precision=[0.0])
    assert found.leverage == pytest.approx([1.0, 4.0, 0.0])
    assert found.ratio == pytest.approx([1.0, 4.0, 0.0])
    assert found.extrapolated.tolist() == [False, True, False]
    assert found.information[1] == pytest.approx(0.5 * np.log(20.0 / 4.0))
    # Variance of the predictions on the other days falls from 16/4 to 16/20.
    assert found.reduction[1] == pytest.approx(0.8)
    assert found.proposed == (1,)
    assert found.to_dict()["proposed"] == ["Tue"]


def test_a_day_that_tells_of_another_parameter_comes_first() -> None:
    slopes = np.zeros((2, 3, 1))
    slopes[0, :, 0] = [3.0, 3.0, 0.0]
    slopes[1, :, 0] = [0.0, 0.0, 1.0]
    found = choose_days(slopes, [1.0], LABELS, [0, 1, 2], [True, False, False], precision=[0.1, 0.1])
    assert found.proposed[0] == 2
    assert found.information[2] == pytest.approx(0.5 * np.log(1.1 / 0.1))


def test_ranges_of_drivers() -> None:
    found = choose_days(
        np.ones((1, 4, 1)), [1.0], ["Mon", "Tue"], [0, 0, 1, 1], [True, True, False, False],
        precision=[1.0], drivers={"wind": [1.0, 3.0, 2.0, 5.0]},
    )  # fmt: skip
    (wind,) = found.ranges
    assert (wind.low, wind.high, wind.other_low, wind.other_high) == (1.0, 3.0, 2.0, 5.0)
    assert wind.outside == 0.5
    assert found.outside["wind"].tolist() == [0.0, 0.5]


def test_shapes_that_do_not_match_are_refused() -> None:
    with pytest.raises(InputError, match=r"found shape \(1, 2, 1\), expected \(parameters, 3, 1\)"):
        choose_days(np.ones((1, 2, 1)), [1.0], LABELS, [0, 1, 2], [True, False, False], precision=[0.0])


def test_the_terminal_says_in_words_what_an_extrapolation_is() -> None:
    slopes = np.array([1.0, 2.0, 0.0])[None, :, None]
    choice = choose_days(slopes, [0.5], LABELS, [0, 1, 2], [True, False, False], precision=[0.0])
    assert day_lines(choice) == [
        "1 of 2 days that the calibration did not use is an extrapolation: there the variance of the "
        "prediction from the parameters is more than 3 times that of the days used",
        "days that would tell most about the parameters, if measured or calibrated on: Tue",
    ]
    slopes[0, 1] = 1.0
    none = choose_days(slopes, [0.5], LABELS, [0, 1, 2], [True, False, False], precision=[0.0])
    assert day_lines(none)[0] == "none of 2 days that the calibration did not use is an extrapolation"
