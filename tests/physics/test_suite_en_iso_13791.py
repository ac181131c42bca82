"""Causes of the misses of EN ISO 13791: a second calculation, and the distribution of the sun."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.verification.suites.case_data import CaseData
from mascarin.verification.suites.catalogue.en_iso_13791 import whole
from mascarin.verification.suites.catalogue.en_iso_13791.whole import Case, Sunshine
from mascarin.verification.suites.suite import suites
from room_13791 import operative

NAME = "en_iso_13791"
#: Score of each choice, of 54 numbers, as the suite lists them.
SCORES = {
    "0: 45": Sunshine(0.0),
    "0.1: 46": Sunshine(0.1),
    "0.5: 48": Sunshine(0.5),
    "half: 47": Sunshine(0.1, 0.5),
    "all: 46": Sunshine(0.1, 1.0),
}


@pytest.fixture(scope="module")
def data(data_dir: Path) -> CaseData:
    return CaseData(data_dir / "suites" / "cen13791")


@pytest.mark.parametrize("name", ["A.1.b", "B.1.a", "B.1.b", "A.2.c"])
def test_a_network_of_heat_flows_gives_the_same(name: str, data: CaseData) -> None:
    """Own numerics, glass and blind: highest and lowest differ by less than 0.2 K, means by 0.1 K."""
    second = operative(Case(name), whole.SUNSHINE.to_air)
    first = Case(name).operative(data, whole.SUNSHINE)
    assert second.mean() == pytest.approx(first.mean(), abs=0.1)
    assert second.max() == pytest.approx(first.max(), abs=0.2)
    assert second.min() == pytest.approx(first.min(), abs=0.2)


def test_every_choice_of_the_sun_is_listed_with_its_score(data: CaseData) -> None:
    (setting,) = (words for words in suites()[NAME].settings if words.startswith("sun behind"))
    insides = {}
    for words, choice in SCORES.items():
        insides[choice] = {
            (line.case, line.quantity): bool(line.inside) for line in whole.lines(data, choice)
        }
        assert words in setting
        assert f": {sum(insides[choice].values())}" in f": {words.split(': ')[1]}"
    # The setting that counts is not the one with the best score.
    assert sum(insides[whole.SUNSHINE].values()) < max(sum(inside.values()) for inside in insides.values())
    for key, miss in suites()[NAME].known_misses.items():
        half_to_air = insides[Sunshine(0.5)][key]
        assert half_to_air == miss.cause.startswith("the distribution of the sun"), key
        if not half_to_air:
            assert not any(inside[key] for inside in insides.values()), key
