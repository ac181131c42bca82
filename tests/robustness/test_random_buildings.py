"""A small part of the campaign of random buildings; ``random_campaign.py`` is the long one."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import random_buildings
import random_campaign
from mascarin.building import Building
from mascarin.errors import InputError
from random_cases import case
from random_judges import faults

#: Cases that are run here, in parts of about the same time.
PARTS = 6
CASES = 60
#: Its start is repeated 406 times in each of its runs: the campaign (`make fuzz`) runs it.
LONG = {37}
#: Cases whose descriptions are drawn and not run.
DRAWN = 300
#: Cases of a part that a run may refuse or not solve.
MOST_ENDED = 1
#: Least part of the drawn descriptions that can be used.
USABLE = 0.9


@cache
def drawn() -> list[Building]:
    """Buildings of some seeds; those that are refused are left out."""
    buildings = []
    for seed in range(DRAWN):
        try:
            buildings.append(case(seed).building())
        except InputError:
            continue
    return buildings


def test_nearly_all_descriptions_can_be_used() -> None:
    assert len(drawn()) >= USABLE * DRAWN


def test_every_key_of_a_description_is_drawn() -> None:
    missing = random_buildings.undrawn(drawn())
    assert missing == [], (
        f"keys that no random building has: {missing}. Draw them in random_buildings.py, or in the "
        "module beside it that makes their part (random_shells, random_materials, random_air, ...)"
    )


def test_a_seed_gives_one_case() -> None:
    first, second = case(7), case(7)
    assert first.tree == second.tree
    assert first.options == second.options
    assert first.weather.frame.equals(second.weather.frame)
    assert random_campaign.shown(first) == random_campaign.shown(second)


def test_a_printed_case_is_the_same_building() -> None:
    from mascarin.building.reading import parse

    drawn_case = case(12)
    assert parse(random_campaign.shown(drawn_case), "case.yaml") == drawn_case.building()


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_impossible_comes_out(part: int) -> None:
    lines = [random_campaign.judged(seed) for seed in range(part, CASES, PARTS) if seed not in LONG]
    faults = [(line["seed"], *fault) for line in lines for fault in line["faults"]]
    assert faults == []
    ended = [(line["seed"], line.get("error")) for line in lines if line["outcome"] != "run"]
    assert len(ended) <= MOST_ENDED, ended


def test_judges_find_what_is_impossible() -> None:
    damp = next(damp for damp in map(case, range(18, 99)) if damp.building().humidity is not None)
    building = damp.building()
    outputs = list(building.outputs())
    good = np.full((2, len(outputs)), 0.5)
    assert faults(damp, building, outputs, good) == []
    kinds = set()
    for value in (-300.0, 2000.0, -0.1, 1.5, np.nan):
        bad = good.copy()
        bad[1] = value
        kinds |= {fault.kind for fault in faults(damp, building, outputs, bad)}
    assert kinds >= {
        "below absolute zero", "above 2000 K", "negative humidity", "fraction above 1: relative_humidity",
        "irradiance", "not finite", "negative air_changes",
    }  # fmt: skip
