"""One rule for the exit codes of all commands: unsound and failed runs are said, and end with 1.

Commands come from the registry: one that is in none of the tables here fails
`test_every_command_has_a_rule`.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

from crossing_entrances import COMMANDS, WITHOUT_BUILDING, Bench, enter
from crossing_features import VARIED, description
from mascarin.simulation.preparation.engine_run import CompiledRun
from mascarin.simulation.preparation.run_results import EnsembleRun, Failure

#: Commands that end with 1 where a run is unsound.
JUDGED: Final = (
    "run", "sweep", "fmu", "page", "design", "study", "sensitivity", "calibrate", "validate", "genopt",
)  # fmt: skip
#: Commands that run ensembles whose members may fail, and their exit code then.
FAILING: Final = {"sweep": 1, "design": 1, "sensitivity": 3}
#: Other commands, with the reason.
UNJUDGED: Final = {
    "view": "makes no run",
    "explore": "a server: its page shows the warnings of each run",
    "cost": "one evaluation of a search: a program that ends with 1 stops GenOpt; genopt says it",
    "optimize": "any program; its exit codes are those of GenOpt",
    "check": "makes no run",
    "parameters": "makes no run",
    "outputs": "makes no run",
    "cite": "makes no run",
}
OUTLIER: Final = (5, "surface roof (inside)", -41.3, -2.0, 22.0)
WORDS: Final = ("do not use these results", "do not use their results")


def _unsound(patch: pytest.MonkeyPatch) -> None:
    """Every run, and every member of an ensemble, has a temperature without a cause."""
    run_into, ensemble = CompiledRun.run_into, CompiledRun.ensemble

    def judged(self: CompiledRun, *arguments: Any, **options: Any) -> dict[str, Any]:
        return {**run_into(self, *arguments, **options), "outside": 7.5, "outlier": OUTLIER}

    def members(self: CompiledRun, *arguments: Any, **options: Any) -> EnsembleRun:
        run = ensemble(self, *arguments, **options)
        return replace(run, outside=np.full_like(run.outside, 4.5))

    patch.setattr(CompiledRun, "run_into", judged)
    patch.setattr(CompiledRun, "ensemble", members)


def _failing(patch: pytest.MonkeyPatch) -> None:
    """The first member of each call of an ensemble of several fails."""
    ensemble = CompiledRun.ensemble

    def members(self: CompiledRun, *arguments: Any, **options: Any) -> EnsembleRun:
        run = ensemble(self, *arguments, **options)
        if len(run.records) == 1:
            return run
        records, residuals, outside = run.records.copy(), run.residuals.copy(), run.outside.copy()
        records[0], residuals[0], outside[0] = np.nan, np.nan, np.nan
        failures = [Failure(0, "the step does not converge"), *run.failures]
        return replace(run, records=records, residuals=residuals, outside=outside, failures=failures)

    patch.setattr(CompiledRun, "ensemble", members)


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    """A room of which nothing is warned."""
    return Bench(tmp_path / "room", description("nothing"))


def test_every_command_has_a_rule() -> None:
    assert sorted([*JUDGED, *UNJUDGED]) == sorted(COMMANDS)
    assert not set(COMMANDS) & set(WITHOUT_BUILDING)
    assert set(FAILING) <= set(JUDGED)
    assert VARIED


@pytest.mark.parametrize("name", JUDGED)
def test_an_unsound_run_ends_with_1_and_words(
    name: str, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    _unsound(monkeypatch)
    told = enter(name, bench)
    assert told.code == 1, told.text[-2000:]
    assert any(words in " ".join(told.text.split()) for words in WORDS), told.text[-2000:]
    if name != "run":  # whose driver prints a summary
        assert {path.name for path in bench.folder.iterdir()} - bench.made, "the results are not written"


@pytest.mark.parametrize("name", FAILING)
def test_a_failed_member_is_said(name: str, bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    _failing(monkeypatch)
    told = enter(name, bench)
    assert told.code == FAILING[name], told.text[-2000:]
    assert "failed" in told.text


def test_the_second_start_of_a_sensitivity_analysis_says_the_same(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    _unsound(monkeypatch)
    first = enter("sensitivity", bench)
    monkeypatch.undo()
    # The runs are kept with their judgement.
    again = enter("sensitivity", bench)
    assert first.code == again.code == 1
    assert "do not use their results" in again.text
