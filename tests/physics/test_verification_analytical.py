from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin import cli
from mascarin.errors import SolverError
from mascarin.simulation.results import Results
from mascarin.verification.analytical import (
    Case,
    Check,
    cases,
    catalogue,
    conduction,
    page,
    phase,
    radiation,
    setup,
)


@pytest.fixture(scope="module")
def rows() -> dict[str, list[Check]]:
    """Every case, run once."""
    return {case.name: case.run() for case in cases()}


@pytest.mark.parametrize("name", [case.name for case in cases()])
def test_case(name: str, rows: dict[str, list[Check]]) -> None:
    assert rows[name]
    for row in rows[name]:
        assert row.name == name
        assert row.passed, row.to_dict()


def test_only_one_case_is_without_bounds(rows: dict[str, list[Check]]) -> None:
    informing = [name for name, found in rows.items() if all(row.informs for row in found)]
    assert informing == ["apparent capacity"]
    # The scheme of the paper loses heat in proportion to the step.
    loss, *orders = rows["apparent capacity"]
    assert 1e-4 < loss.value < 1e-1
    assert all(0.9 < order.value < 1.1 for order in orders)


# --- checks ---


def test_bounds() -> None:
    assert Check("c", "q", "-", 1.0, 1.0, 0.9, 1.1).passed
    assert not Check("c", "q", "-", 1.2, 1.0, 0.9, 1.1).passed
    assert not Check("c", "q", "-", 0.8, 1.0, 0.9, None).passed
    assert not Check.near("c", "q", "-", math.nan, 1.0, within=1e9).passed
    assert Check.most("c", "q", "-", 0.0, high=0.0).passed
    assert not Check.most("c", "q", "-", 5e-324, high=0.0).passed
    assert Check("c", "q", "-", 1.0).informs
    assert Check("c", "q", "-", 1.0).passed


@pytest.mark.parametrize(
    "name",
    [
        "semi-infinite sinusoid",
        "Stefan, two phases",
        "lumped zone",
        "enclosures",
        "surface heat transfer coefficients",
    ],
)
def test_an_error_of_one_percent_is_found(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    true_run = setup.run

    def wrong(*args: Any, **options: Any) -> Results:
        results = true_run(*args, **options)
        results.records[:, 0] *= 1.01
        return results

    monkeypatch.setattr(setup, "run", wrong)
    case = next(case for case in cases() if case.name == name)
    assert not all(row.passed for row in case.run())


def test_a_case_that_cannot_be_run_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_name: str) -> list[Check]:
        raise SolverError("step 3 did not converge")

    case = Case("c", "", "", "", "", ("building",), broken)
    monkeypatch.setattr(catalogue, "cases", lambda _topic: [case])
    (row,) = catalogue.run("building")
    assert not row.passed
    assert "step 3 did not converge" in row.quantity


# --- the analytical solutions ---


def test_neumann_constant_of_the_published_cases() -> None:
    assert phase.Front(1.5, 1.5, 36.0, 26.0).root() == pytest.approx(0.258415, abs=5e-7)
    assert phase.Front(1.5, 0.024, 36.0, 16.0).root() == pytest.approx(0.241097, abs=5e-7)
    front = phase.Front(1.5, 0.024, 36.0, 16.0)
    assert front.at(front.time(0.05)) == pytest.approx(0.05)


def test_transfer_matrix_conserves_and_tends_to_the_resistance() -> None:
    layers = [
        conduction.ConductionLayer(0.2, 0.8, 1700.0, 900.0, 1),
        conduction.ConductionLayer(0.1, 0.04, 30.0, 1000.0, 1),
    ]
    assert np.linalg.det(conduction.transfer(layers)) == pytest.approx(1.0)
    light = [one._replace(density=1e-6) for one in layers]
    transmittance = -1.0 / conduction.transfer(light)[0, 1]
    assert transmittance == pytest.approx(conduction.conductance(layers), rel=1e-6)


def test_radiosity_of_two_plates_is_the_textbook_formula() -> None:
    surfaces = [radiation.EnclosureSurface(2.0, 0.9, 0.0), radiation.EnclosureSurface(2.0, 0.25, 0.0)]
    matrix = radiation.exchange(surfaces, np.array([[0.0, 1.0], [1.0, 0.0]]))
    conductance = 2.0 / (1.0 / 0.9 + 1.0 / 0.25 - 1.0)
    assert matrix == pytest.approx(conductance * np.array([[1.0, -1.0], [-1.0, 1.0]]))


def test_harmonic_gives_amplitude_and_phase_of_a_series_with_drift() -> None:
    t = 60.0 * np.arange(2881)
    series = 3.0 + 1e-5 * t + 4.0 * np.sin(2.0 * np.pi * t / 86400.0 - 0.7)
    found = setup.harmonic(series, 60.0, 86400.0)
    assert abs(found) == pytest.approx(4.0)
    assert math.atan2(found.imag, found.real) == pytest.approx(-0.7)


# --- the command and the page ---


def quick(monkeypatch: pytest.MonkeyPatch, *found: Check) -> None:
    case = Case("quick", "", "", "", "", ("building", "pcm"), lambda _name: list(found))
    monkeypatch.setattr(catalogue, "cases", lambda _topic: [case])


GOOD = Check.near("quick", "two", "K", 2.0, 2.0, within=0.1)
BAD = Check.near("quick", "three", "K", 2.0, 3.0, within=0.1)


def test_verify_json(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    quick(monkeypatch, GOOD, Check("quick", "shown", "-", 7.0))
    assert cli.main(["verify", "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out) == [
        {"name": "quick", "quantity": "two", "unit": "K", "value": 2.0, "min": 1.9, "max": 2.1,
         "expected": 2.0, "passed": True},
        {"name": "quick", "quantity": "shown", "unit": "-", "value": 7.0, "min": None, "max": None,
         "expected": None, "passed": True},
    ]  # fmt: skip
    assert err == "1 of 1 numbers within their bounds\n"


def test_verify_ends_with_1_when_a_number_is_outside_its_bounds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    quick(monkeypatch, GOOD, BAD)
    assert cli.main(["verify", "--pcm"]) == 1
    out, err = capsys.readouterr()
    assert out.splitlines()[1].split()[-1] == "passed"
    assert out.splitlines()[2].split()[-1] == "FAILED"
    assert err == "1 of 2 numbers within their bounds\n"


def test_the_page_agrees_with_the_command(rows: dict[str, list[Check]], repository: Path) -> None:
    text = (repository / "docs" / "verification.md").read_text(encoding="utf-8")
    shown = [
        tuple(cell.strip() for cell in line.split("|")[1:-1])
        for line in text.splitlines()
        if line.startswith("| ")
    ]
    printed = [
        (row.name, row.quantity, row.unit, page.sentence(row))
        for topic in ("building", "pcm")
        for case in cases()
        if topic in case.topics
        for row in rows[case.name]
    ]
    assert [(*row[:3], row[-1]) for row in shown if row[0] != "case"] == printed
    for case in cases():
        assert page.section(case) in text, (
            f"{case.name}: write the page again, see verification/analytical/page.py"
        )
