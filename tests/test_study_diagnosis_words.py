"""What a study says of the causes of the remaining error."""

from __future__ import annotations

import pytest

from mascarin.study import diagnosis_words


@pytest.mark.parametrize(
    ("share", "said"),
    [
        (0.123, "takes away 12 % of the remaining sum of squares (p 0.004)"),
        (0.002, "over all falls by less than 1 % (p 0.004)"),
    ],
)
def test_a_small_share_is_said_to_be_small(share: float, said: str) -> None:
    cause = diagnosis_words.of_form("site.sky", "brunt", 0.004, share, 30.0, [])
    assert said in cause.text
    assert cause.share == share
