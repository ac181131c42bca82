"""A design study from beginning to end: designs, samples, ranking, tables and report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin._io import identity
from mascarin._io.locks import writing_into
from mascarin._io.sealed import own_files
from mascarin.design.variants.inputs import DesignInputs
from mascarin.design.variants.results import ALL, FILES, DesignResults, by_climate, rank_all, shortlist
from mascarin.design.variants.runs import FOLDER, Runs, runs_per_design
from mascarin.design.variants.search import searched
from mascarin.design.variants.variables import Choice, Choices
from mascarin.ensemble import latin_hypercube
from mascarin.progress import reporting

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.design.variants.variables import Design
    from mascarin.progress import ProgressOption


def run_design(
    inputs: DesignInputs, out: str | Path, *, workers: int | None = None, progress: ProgressOption = None
) -> DesignResults:
    """Run a design study; called again after it was stopped, it continues and gives the same files.

    Parameters
    ----------
    inputs : DesignInputs
        The study; see `read_design`.
    out : str or Path
        Folder of the results.
    workers : int, optional
        Processes; by default those of the machine where there is much to do.
    progress : bool or callable, optional
        Shows members done and the time left; a function is called with members done and expected.

    Returns
    -------
    DesignResults
        Tables and rankings, which are written to the folder as well, with the report.

    Raises
    ------
    InputError
        The folder cannot be written, or another process writes to it.
    SolverError
        All designs failed.
    """
    from mascarin.pages.design.page import write_page

    out = Path(out)
    identity.require_no_inputs_in(own_files.require_folder(out, FOLDER))
    for name in FILES:
        identity.require_no_input(out / name)
    with writing_into(out), reporting(progress, "members") as report:
        runs = Runs(inputs, out, workers, report, expected=planned_runs(inputs)["runs"])
        designs, nominal = _designs(inputs, runs)
        name = inputs.file.ranked_by
        least = inputs.objective(name).least
        count = (
            inputs.file.uncertainty.designs if inputs.file.uncertainty is not None else min(8, len(designs))
        )
        best = shortlist(nominal, name, len(designs), count, least=least)
        sampled = _sampled(inputs, runs, [designs[k] for k in best])
        results = DesignResults(
            inputs=inputs,
            designs=designs,
            nominal=nominal,
            best=best,
            sampled=sampled,
            rankings=rank_all(sampled, name, len(best), least=least, negligible=inputs.file.negligible),
            reference=_reference(inputs, runs),
            warnings=tuple(runs.warnings),
        )
        results.write(out)
        write_page(results, out / "report.html")
        runs.forget_others()
    return results


def planned_runs(inputs: DesignInputs) -> dict[str, Any]:
    """What a study runs, or at most runs where it searches.

    Parameters
    ----------
    inputs : DesignInputs
        The study.

    Returns
    -------
    dict
        Options of each variable, designs, climates, compared designs, samples and runs.
    """
    plan, uncertain = inputs.file.search, inputs.file.uncertainty
    count = len(inputs.choices.grid()) if plan.method == "grid" else plan.evaluations
    compared = min(8 if uncertain is None else uncertain.designs, count)
    samples = 1 if uncertain is None else uncertain.samples
    return {
        "variables": {choice.name: _options(choice) for choice in inputs.choices.all},
        "designs": count,
        "climates": [site.name for site in inputs.sites],
        "compared": compared,
        "samples": samples,
        "uncertain": len(inputs.uncertain),
        "runs": (count + compared * samples) * runs_per_design(inputs),
    }


def _options(choice: Choice) -> str:
    return f"{len(choice.options)}" + (" in a grid, any in a search" if choice.range is not None else "")


def _designs(inputs: DesignInputs, runs: Runs) -> tuple[list[Design], pd.DataFrame]:
    """All designs, and their objectives with the building as described."""
    import pandas as pd

    plan = inputs.file.search
    if plan.method == "grid":
        designs = inputs.choices.grid()
        return designs, runs.values(designs)
    tables: dict[Design, pd.DataFrame] = {}
    names = (
        list(plan.objectives or inputs.file.objectives) if plan.method == "nsga2" else [inputs.file.ranked_by]
    )

    def costs(asked: Sequence[Design]) -> Any:
        new = _by_structure(
            inputs.choices, [design for design in dict.fromkeys(asked) if design not in tables]
        )
        if new:
            table = runs.values(new)
            tables.update({design: table[table["design"] == k] for k, design in enumerate(new)})
        return np.array([[_cost(inputs, tables[design], name) for name in names] for design in asked])

    designs = searched(inputs.choices, plan.model_copy(update={"objectives": tuple(names)}), costs)
    rows = [tables[design].assign(design=k) for k, design in enumerate(designs)]
    joined = pd.concat(rows)
    # In the order of a grid: by climate, then by design.
    order = {site.name: k for k, site in enumerate(inputs.sites)}
    joined["order"] = joined["climate"].map(order)
    joined = joined.sort_values(["order", "design"], kind="stable").drop(columns="order")
    return designs, joined.reset_index(drop=True)


def _by_structure(choices: Choices, designs: Sequence[Design]) -> list[Design]:
    """Designs of one structure side by side, in the order of the first of each."""
    structural = [k for k, choice in enumerate(choices.all) if choice.structural]
    groups: dict[tuple[float, ...], list[Design]] = {}
    for design in designs:
        groups.setdefault(tuple(design[k] for k in structural), []).append(design)
    return [design for group in groups.values() for design in group]


def _cost(inputs: DesignInputs, rows: pd.DataFrame, name: str) -> float:
    """Mean of an objective over the climates, to be minimized; infinite for a design that failed."""
    if rows["failure"].notna().any():
        return float("inf")
    value = float(by_climate(rows, name, 1)[ALL][0])
    return value if inputs.objective(name).least else -value


def _sampled(inputs: DesignInputs, runs: Runs, best: Sequence[Design]) -> pd.DataFrame:
    """The best designs with every sample of what is uncertain; without uncertainty, as described."""
    plan = inputs.file.uncertainty
    if plan is None:
        return runs.values(best)
    table = latin_hypercube(inputs.building, plan.samples, seed=plan.seed, vary=inputs.uncertain)
    samples = {str(path): table[path].tolist() for path in table.columns}
    return runs.values(best, samples=samples)


def _reference(inputs: DesignInputs, runs: Runs) -> dict[str, dict[str, float]]:
    """Objectives of the reference, by climate."""
    table = runs.reference()
    return {
        str(row["climate"]): {str(name): float(row[name]) for name in table.columns if name != "climate"}
        for _, row in table.iterrows()
    }
