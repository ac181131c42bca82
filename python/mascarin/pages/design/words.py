"""The answer of a design study in sentences, and its main results."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mascarin.design.variants.results import ALL
from mascarin.design.variants.runs import UNDEFINED
from mascarin.figures import text

if TYPE_CHECKING:
    from mascarin.design.variants.ranking import Ranking
    from mascarin.design.variants.results import DesignResults


def facts(results: DesignResults) -> list[tuple[str, str, str]]:
    """Main results for the head of the page: name, value and note.

    Parameters
    ----------
    results : DesignResults
        The results.
    """
    ranking = results.rankings[ALL]
    name, unit = results.ranked_by, results.inputs.objective(results.ranked_by).unit
    best = ranking.order[0]
    reference = reference_value(results, name, ALL)
    shown = [
        (name, text.with_unit(float(ranking.mean[best]), unit), f"best design, mean of {_mean_of(results)}"),
        ("Designs", text.significant(len(results.designs), 7), _in_climates(results)),
        (
            "Tied with the best",
            str(int(ranking.tied.sum()) - 1),
            f"of {len(ranking.order)} that were compared",
        ),
    ]
    if np.isfinite(reference):
        shown.insert(1, ("Reference", text.with_unit(reference, unit), "without the choices of this study"))
    return shown


def verdict(results: DesignResults) -> list[str]:
    """The answer in sentences.

    Parameters
    ----------
    results : DesignResults
        The results.
    """
    ranking, name = results.rankings[ALL], results.ranked_by
    objective = results.inputs.objective(name)
    order = ranking.order
    best = results.best[order[0]]
    mean = float(ranking.mean[order[0]])
    said = [
        f"Best for “{name}”: {results.label(best)}, {text.with_unit(mean, objective.unit)} as the mean of "
        f"{_mean_of(results)}."
    ]
    reference = reference_value(results, name, ALL)
    if np.isfinite(reference) and reference:
        # Both with the building as described: there are no samples of the reference.
        described = float(results.values(name)[best])
        change = (described - reference) / abs(reference)
        said.append(
            f"As described, it has {text.with_unit(described, objective.unit, 4)} and the reference "
            f"{text.with_unit(reference, objective.unit, 4)}: a change of "
            f"{text.fixed(100.0 * change, 1, sign=True)} %."
        )
    tied = [results.best[k] for k in order[1:] if ranking.tied[k]]
    said.append(_ties(results, ranking, tied))
    for column in [key for key in results.nominal.columns if key.endswith(UNDEFINED)]:
        worst = float(results.nominal[column].max())
        if worst > 0.0:
            said.append(
                f"The index of “{column.removesuffix(UNDEFINED)}” has no value in up to "
                f"{text.significant(worst)} h of a run, outside its validity; these hours do not count."
            )
    firsts = {results.best[ranked.order[0]] for climate, ranked in results.rankings.items() if climate != ALL}
    if len(firsts) > 1:
        said.append("No single design is first in all climates; the table below gives the first of each.")
    count = len(warnings(results))
    if count:
        said.append(f"{'One warning' if count == 1 else f'{count} warnings'} about the runs: see below.")
    return said


def warnings(results: DesignResults) -> list[str]:
    """Warnings about the runs; one that holds in several climates is said once.

    Parameters
    ----------
    results : DesignResults
        The results.
    """
    climates: dict[str, list[str]] = {}
    for line in results.warnings:
        climate, _, words = line.partition(": ")
        of_climate = climate in {site.name for site in results.inputs.sites}
        climates.setdefault(words if of_climate else line, []).extend([climate] if of_climate else [])
    climate_count = len(results.inputs.sites)
    return [
        f"{'all climates' if len(names) == climate_count > 1 else ', '.join(names)}: {words}"
        if names
        else words
        for words, names in ((words, list(dict.fromkeys(names))) for words, names in climates.items())
    ]


def _mean_of(results: DesignResults) -> str:
    """Over what the numbers of the ranking are means."""
    sampled = "samples" if results.inputs.file.uncertainty is not None else ""
    climates = "climates" if len(results.inputs.sites) > 1 else ""
    words = " and ".join(filter(None, (sampled, climates)))
    return f"the {words}" if words else "the building as described"


def _in_climates(results: DesignResults) -> str:
    count = len(results.inputs.sites)
    return f"in {count} climate{'s' * (count > 1)}"


def _ties(results: DesignResults, ranking: Ranking, tied: Sequence[int]) -> str:
    order = ranking.order
    if results.inputs.file.uncertainty is None:
        return (
            "No uncertainty was given: the ranking is that of the building as described, and differences may "
            "not hold."
        )
    if tied:
        names = "; ".join(results.label(k) for k in tied[:4]) + ("; …" if len(tied) > 4 else "")
        return f"{len(tied)} designs cannot be told from it over {ranking.samples} samples: {names}."
    if len(order) < 2:
        return "There is no other design."
    second = order[1]
    unit = results.inputs.objective(results.ranked_by).unit
    relative = 100.0 * abs(float(ranking.difference[second])) / max(abs(float(ranking.mean[order[0]])), 1e-12)
    share = text.fixed(100.0 * float(ranking.better[second]), 0)
    return (
        f"The second, {results.label(results.best[second])}, is worse over {ranking.samples} samples, by "
        f"{text.with_unit(abs(float(ranking.difference[second])), unit)} ({text.significant(relative, 2)} "
        f"%); it is "
        f"the better one in {share} % of the samples."
    )


def reference_value(results: DesignResults, objective: str, climate: str) -> float:
    """An objective of the reference, as the mean of the climates or in one; NaN where it has none.

    Parameters
    ----------
    results : DesignResults
        The results.
    objective : str
        Its name.
    climate : str
        Its name, or `ALL`.
    """
    values = [
        results.reference[site.name].get(objective, np.nan)
        for site in results.inputs.sites
        if climate in (ALL, site.name)
    ]
    return float(np.mean(values))
