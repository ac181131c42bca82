"""Public test suites: their verdicts on this version, and that each fails without its physics."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from mascarin import cli
from mascarin.errors import InputError
from mascarin.verification.bestest.reference import ranges
from mascarin.verification.suites.case_data import CaseData, Tree
from mascarin.verification.suites.peers import in_words, standing
from mascarin.verification.suites.suite import Suite, chosen, suites
from mascarin.verification.suites.verdict import (
    WITHOUT_NUMBER,
    KnownMiss,
    SuiteVerdict,
    VerdictLine,
    around,
    largest,
)

#: Its cases are tested in tests/physics/test_verification_bestest.py.
OF_BESTEST = "standard_140"


def folder(suite: Suite, data_dir: Path) -> Path:
    return data_dir / "suites" / suite.data


@cache
def lines_of(name: str, data_dir: Path) -> list[VerdictLine]:
    suite = suites()[name]
    return list(suite.lines(CaseData(folder(suite, data_dir))))


#: Number of lines by suite and verdict.
EXPECTED = {
    "airflow": {SuiteVerdict.INSIDE: 15},
    "bland": {SuiteVerdict.INSIDE: 15},
    "en_iso_13791": {SuiteVerdict.INSIDE: 76, SuiteVerdict.KNOWN_MISS: 8},
    "etna": {SuiteVerdict.INSIDE: 8},
    "ground_coupling": {
        SuiteVerdict.INSIDE: 24,
        SuiteVerdict.KNOWN_MISS: 11,
        SuiteVerdict.NOT_EXPRESSIBLE: 1,
        SuiteVerdict.NOT_RUN: 1,
    },
    "multizone": {SuiteVerdict.INSIDE: 3, SuiteVerdict.NOT_RUN: 1},
    "rp1052": {SuiteVerdict.INSIDE: 98, SuiteVerdict.NOT_EXPRESSIBLE: 3},
    "simquality": {SuiteVerdict.INSIDE: 63, SuiteVerdict.NOT_EXPRESSIBLE: 2},
    "weather_drivers": {SuiteVerdict.INSIDE: 60},
}


def test_every_suite_is_tested() -> None:
    assert suites().keys() == {*EXPECTED, OF_BESTEST}
    assert REMOVED.keys() == EXPECTED.keys()


@pytest.mark.parametrize("name", EXPECTED)
def test_numbers_of_a_suite(name: str, data_dir: Path) -> None:
    suite, lines = suites()[name], lines_of(name, data_dir)
    counts: dict[SuiteVerdict, int] = {}
    for line in lines:
        counts[line.verdict] = counts.get(line.verdict, 0) + 1
    assert counts == EXPECTED[name], [line for line in lines if line.verdict == SuiteVerdict.MISS]
    # A known miss that is none any more has to leave the list.
    missed = {(line.case, line.quantity) for line in lines if line.verdict == SuiteVerdict.KNOWN_MISS}
    assert missed == suite.known_misses.keys()
    assert all(math.isfinite(line.value) for line in lines if line.verdict not in WITHOUT_NUMBER)


@pytest.mark.parametrize("name", EXPECTED)
def test_the_page_states_the_numbers(name: str, data_dir: Path, repository: Path) -> None:
    page = (repository / "docs" / "suites.md").read_text(encoding="utf-8")
    row, beside = (line for line in page.splitlines() if line.startswith(f"| `{name}` |"))
    counts = EXPECTED[name]
    judged = sum(count for verdict, count in counts.items() if verdict not in WITHOUT_NUMBER)
    result = f"{counts[SuiteVerdict.INSIDE]} of {judged}"
    assert f"| {result} |" in row
    # The table of all suites beside all programs is made of the data.
    assert beside == f"| `{name}` | {result} | {in_words(standing(lines_of(name, data_dir)))} |"


def test_the_page_states_the_programs_of_standard_140(repository: Path) -> None:
    """Of the published table; what Mascarin has inside is all but the known misses."""
    page = (repository / "docs" / "suites.md").read_text(encoding="utf-8")
    published = ranges().values()
    lines = [
        VerdictLine(row.case, row.quantity, row.unit, math.nan, row.mean, (row.low, row.high), row.programs)
        for row in published
    ]
    inside = len(lines) - len(suites()[OF_BESTEST].known_misses)
    row, beside = (line for line in page.splitlines() if line.startswith(f"| `{OF_BESTEST}` |"))
    assert f"| {inside} of {len(lines)} |" in row
    assert beside == f"| `{OF_BESTEST}` | {inside} of {len(lines)} | {in_words(standing(lines))} |"


def test_simquality_is_perfect_in_every_variable(data_dir: Path) -> None:
    """The limits that the suite calls perfect, from 90 on, and the mean beside TRNSYS and NANDRAD."""
    lines = lines_of("simquality", data_dir)
    scores = [line.value for line in lines if line.verdict not in WITHOUT_NUMBER]
    assert min(scores) > 91.9
    assert sum(scores) / len(scores) > 98.2


def without_storage(tree: Tree) -> Tree:
    for material in tree["materials"].values():
        material["specific_heat"] = 100.0
    return tree


def without_ground(tree: Tree) -> Tree:
    tree["site"]["ground_reflectance"] = 0.0
    return tree


def without_height(tree: Tree) -> Tree:
    for opening in tree["vents"].values():
        opening["elevation"] = 1.0
    return tree


def without_conduction(tree: Tree) -> Tree:
    for material in tree["materials"].values():
        material["conductivity"] *= 0.01
    return tree


def without_emission(tree: Tree) -> Tree:
    for surface in tree["surfaces"].values():
        if "zone" in surface["inside"]:
            surface["inside"]["emissivity"] = 0.01
    return tree


def without_shades(tree: Tree) -> Tree:
    tree.pop("shades", None)
    return tree


def without_common_walls(tree: Tree) -> Tree:
    tree["materials"]["common"]["conductivity"] = 0.001
    return tree


def without_soil(tree: Tree) -> Tree:
    tree["materials"]["floor_soil"]["conductivity"] = 100.0
    return tree


#: What takes away the physical terms that a suite is about.
REMOVED: dict[str, tuple[Callable[[Tree], Tree], ...]] = {
    "airflow": (without_height,),
    "bland": (without_storage,),
    "en_iso_13791": (without_storage, without_emission, without_shades),
    "etna": (without_conduction,),
    "ground_coupling": (without_soil,),
    "multizone": (without_common_walls,),
    "rp1052": (without_storage, without_emission, without_shades),
    "simquality": (without_storage,),
    "weather_drivers": (without_ground,),
}


@pytest.mark.parametrize(
    ("name", "change"), [(name, change) for name, changes in REMOVED.items() for change in changes]
)
def test_a_suite_fails_without_its_physics(name: str, change: Callable[[Tree], Tree], data_dir: Path) -> None:
    suite = suites()[name]
    lines = suite.lines(CaseData(folder(suite, data_dir), change))
    assert any(line.verdict == SuiteVerdict.MISS for line in lines)


def test_known_misses_may_not_grow() -> None:
    line = VerdictLine("1", "load", "W", 105.0, 100.0, around(100.0, 2.0), {"A": 101.0})
    assert line.rank == (2, 2)
    for deviation, verdict in (
        (5.0, SuiteVerdict.KNOWN_MISS),
        (4.7, SuiteVerdict.MISS),
        (-5.0, SuiteVerdict.MISS),
    ):
        known = {("1", "load"): KnownMiss(deviation, "films")}
        assert line.judged(known, {}).verdict == verdict
    assert line.judged({}, {"1": "surfaces by area or not"}).verdict == SuiteVerdict.AMBIGUOUS
    worst = largest("1", "load", "W", ([1, 2, 3], [5.0, 8.0, 7.0], [5.0, 7.0, 9.0]), 1.5)
    assert (worst.value, worst.reference, worst.inside) == (7.0, 9.0, False)
    nothing = VerdictLine("1", "load", "W", math.nan, 100.0, around(100.0, 2.0))
    assert nothing.judged({}, {}).verdict == SuiteVerdict.MISS
    assert nothing.to_dict()["value"] is None


def test_names_and_keys_are_checked(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="found 'blnd', expected one of airflow, bland"):
        chosen(("blnd",))
    (tmp_path / "suite.yaml").write_text("title: a\nabout: b\n", encoding="utf-8")
    with pytest.raises(InputError, match="no key 'term'"):
        Suite.read(tmp_path)
    (tmp_path / "suite.yaml").write_text("titel: a\n", encoding="utf-8")
    with pytest.raises(InputError, match="found the key 'titel'"):
        Suite.read(tmp_path)
    with pytest.raises(InputError, match=r"no file 'reference.csv'"):
        CaseData(tmp_path).file("reference.csv")


def test_the_command(
    tmp_path: Path, data_dir: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MASCARIN_DATA", str(data_dir))
    assert cli.main(["suites", "etna", "--json", "-o", str(tmp_path / "out")]) == 0
    told = capsys.readouterr()
    (result,) = json.loads(told.out)
    assert result["suite"] == "etna"
    assert len(result["lines"]) == 8
    assert "etna: 8 of 8 inside" in told.err
    page = (tmp_path / "out" / "suites.html").read_text(encoding="utf-8")
    assert all(words in page for words in ("8 of 8", "20.7 air changes", "natural convection (TARP)"))
    assert json.loads((tmp_path / "out" / "suites.json").read_text(encoding="utf-8")) == [result]
    # Without data a suite says so; by name that is an error.
    monkeypatch.setenv("MASCARIN_DATA", str(tmp_path))
    assert cli.main(["suites", "etna"]) == 2
    refusal = capsys.readouterr().err
    assert "no folder suites/etna in MASCARIN_DATA. Set the environment variable MASCARIN_DATA" in refusal
    assert cli.main(["suites"]) == 2
    assert cli.main(["suites", "--list"]) == 0
    assert "cse-sim/std140-cse" in capsys.readouterr().out
