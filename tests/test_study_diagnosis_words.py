"""What a study says of the causes of the remaining error."""

from __future__ import annotations

import pytest

from mascarin.study import diagnosis_words


@pytest.mark.parametrize(
    ("share", "said"),
    [
        (0.123, "takes away 12 % of the remaining sum of squares (p 0.004)"),
        (0.002, "over all falls by less than 1 % (p 0.004)"),
        (-0.025, "over all rises by 2 % (p 0.004)"),
        (-0.06, "over all rises by 6 % (p 0.004)"),
    ],
)
def test_a_sum_of_squares_that_rises_is_said_to_rise(share: float, said: str) -> None:
    cause = diagnosis_words.of_form("site.sky", "brunt", 0.004, share, 30.0, [])
    assert said in cause.text
    assert cause.share == share
