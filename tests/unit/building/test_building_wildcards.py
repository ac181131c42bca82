"""Stars in paths: both rules of the module, whole paths and single steps, say the same."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from mascarin.building.base.wildcards import fits, matching
from mascarin.errors import InputError

NAMES = st.text("ab[]+\n*?", min_size=1, max_size=3)
STEPS = st.lists(NAMES, min_size=1, max_size=3)


@given(STEPS, st.lists(STEPS, min_size=1, max_size=6))
def test_a_pattern_finds_the_paths_whose_steps_all_fit(pattern: list[str], paths: list[list[str]]) -> None:
    expected = [
        ".".join(steps) for steps in paths if len(steps) == len(pattern) and all(map(fits, steps, pattern))
    ]
    try:
        found = matching(".".join(pattern), [".".join(steps) for steps in paths])
    except InputError:
        found = []
    assert found == list(dict.fromkeys(expected))
