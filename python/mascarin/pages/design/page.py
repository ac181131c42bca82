"""The report of a design study: one HTML file without scripts, and without anything outside of it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin._io import atomic, units
from mascarin.design.evaluation.reductions import BINS
from mascarin.design.variants.details import REFERENCE, detail, grouped_gains, layers_of, zones_of
from mascarin.design.variants.results import ALL
from mascarin.figures import text
from mascarin.pages.design import charts
from mascarin.pages.design.single_variables import single_variables, with_unit_of
from mascarin.pages.design.words import facts, reference_value, verdict, warnings
from mascarin.pages.frame.template import environment, frame
from mascarin.pages.run.page import flow_words

if TYPE_CHECKING:
    from mascarin.design.variants.details import Detail
    from mascarin.design.variants.results import DesignResults
    from mascarin.design.variants.variables import Choice

#: Rows of the table of all designs; the rest is in the CSV file.
_MAX_ROWS: Final = 40
#: Options of a variable that a map shows side by side.
_MAX_OPTIONS: Final = 40


def write_page(results: DesignResults, path: Path) -> Path:
    """Write the report to a file.

    Parameters
    ----------
    results : DesignResults
        The results.
    path : Path
        Where to.

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(results))


def render(results: DesignResults) -> str:
    """Make the page.

    Parameters
    ----------
    results : DesignResults
        The results.

    Returns
    -------
    str
        HTML.
    """
    details = _details(results)
    reference = reference_value(results, results.ranked_by, ALL)
    sections = [
        {"id": key, "title": title, "content": content}
        for key, title, content in (
            ("warnings", "Warnings", warnings(results)),
            ("ranking", "Ranking", _rankings(results)),
            ("climates", "What it brings in each climate", _climates(results)),
            ("single", "One variable at a time", single_variables(results, reference)),
            ("fronts", "Objectives against each other", _fronts(results)),
            ("maps", "Maps of the variables", _maps(results)),
            ("cycling", "How often the material really cycles", _cycling(results, details)),
            ("why", "Why the best design works", _why(results, details)),
            ("designs", "All designs", _designs(results)),
            ("method", "How it was calculated", _method(results)),
        )
        if content
    ]
    return (
        environment()
        .get_template("pages/design/page.html")
        .render(
            frame(styles=["pages/design/page.css"]),
            title=results.inputs.file.name,
            version=__version__,
            name=results.inputs.file.name,
            about=results.inputs.file.about,
            negligible=text.significant(100.0 * results.inputs.file.negligible),
            verdict=verdict(results),
            facts=facts(results),
            sections=sections,
        )
    )


# ------------------------------------------------------------------ ranking


def _rankings(results: DesignResults) -> list[dict[str, Any]]:
    unit = results.inputs.objective(results.ranked_by).unit
    tables = []
    climates = results.rankings if len(results.inputs.sites) > 1 else {ALL: results.rankings[ALL]}
    for climate in climates:
        ranking = results.rankings[climate]
        rows = []
        for number, k in enumerate(ranking.order, start=1):
            low, high = float(ranking.low[k]), float(ranking.high[k])
            rows.append(
                {
                    "rank": number,
                    "design": results.best[k],
                    "label": results.label(results.best[k]),
                    "mean": text.significant(float(ranking.mean[k]), 4),
                    "spread": text.significant(float(ranking.spread[k]), 2),
                    "difference": "" if number == 1 else text.significant(float(ranking.difference[k]), 3),
                    "interval": "" if number == 1 else f"{text.significant(low)} to {text.significant(high)}",
                    "better": "" if number == 1 else text.percent(float(ranking.better[k]), 0),
                    "tied": bool(ranking.tied[k]),
                    "verdict": results.verdict(ranking, int(k)),
                }
            )
        names = [f"design {results.best[k]}" for k in ranking.order]
        title = f"Difference from the best design, {climate}"
        tables.append(
            {
                "climate": climate,
                "rows": rows,
                "unit": units.shown(unit).replace(" ", "\u00a0"),
                "samples": ranking.samples,
                "drawing": charts.intervals(ranking, names, title, unit),
            }
        )
    return tables


def _climates(results: DesignResults) -> dict[str, Any]:
    """Objectives of the reference and of the best design, climate by climate."""
    best = results.best[results.rankings[ALL].order[0]]
    columns = results.columns
    rows = []
    for site in results.inputs.sites:
        local_best = results.best[results.rankings[site.name].order[0]]
        cells = []
        for name in columns:
            reference = results.reference[site.name].get(name, np.nan)
            value = float(results.values(name, site.name)[best])
            both = np.isfinite(reference) and reference
            change = 100.0 * (value - reference) / abs(reference) if both else np.nan
            cells.append(
                {
                    "reference": text.significant(reference),
                    "value": text.significant(value),
                    "change": text.fixed(change, 0, sign=True) if both else text.NONE,
                }
            )
        rows.append(
            {
                "name": site.name,
                "place": site.words,
                "days": text.significant(site.days, 4),
                "cells": cells,
                "first": results.label(local_best),
            }
        )
    heads = [
        {
            "name": name,
            "unit": units.shown(results.inputs.objective(objective).unit),
            "words": getattr(results.inputs.objective(objective), "words", "") if name == objective else "",
        }
        for name, objective in columns.items()
    ]
    return {"heads": heads, "rows": rows, "best": results.label(best)}


# ------------------------------------------------------------------ all designs


def _fronts(results: DesignResults) -> list[dict[str, Any]]:
    names = list(results.inputs.file.objectives)
    first = results.ranked_by
    winners = results.winners()
    fronts: list[dict[str, Any]] = []
    for other in [name for name in names if name != first]:
        front = results.front([first, other])
        x, y = results.values(other), results.values(first)
        if not (np.isfinite(x).any() and len(results.designs) > 1):
            continue
        axes = (_named(results, other), _named(results, first))
        if np.nanmax(x) - np.nanmin(x) <= 1e-9 * np.nanmax(np.abs(x)):
            alike = text.with_unit(float(np.nanmax(x)), results.inputs.objective(other).unit)
            fronts.append({"title": f"{other}: {alike} in all designs", "drawing": "", "rows": []})
            continue
        title = f"{first} and {other}, mean of the climates"
        rows = [
            {
                "label": results.label(int(k)),
                "first": text.significant(float(y[k])),
                "other": text.significant(float(x[k])),
            }
            for k in sorted(
                np.flatnonzero(front), key=lambda k: y[k] if results.inputs.objective(first).least else -y[k]
            )
        ][:12]
        fronts.append(
            {
                "title": title,
                "drawing": charts.scatter(x, y, front, winners, axes, title),
                "rows": rows,
                "heads": axes,
            }
        )
    return fronts


def _named(results: DesignResults, objective: str, column: str | None = None) -> str:
    """An objective, or a column that belongs to it, with the unit."""
    unit = units.shown(results.inputs.objective(objective).unit)
    return f"{column or objective}, {unit}" if unit else column or objective


def _maps(results: DesignResults) -> list[dict[str, Any]]:
    """The objective of the ranking over two variables; the others are those of the best design."""
    if results.inputs.choices.free:
        return []
    pair = _pair(results.inputs.choices.all)
    if pair is None:
        return []
    across, down = (results.inputs.choices.all[k] for k in pair)
    best = results.designs[results.best[results.rankings[ALL].order[0]]]
    objective = results.inputs.objective(results.ranked_by)
    indices = {design: k for k, design in enumerate(results.designs)}
    maps = []
    climates = (
        [ALL, *[site.name for site in results.inputs.sites]] if len(results.inputs.sites) > 1 else [ALL]
    )
    for climate in climates:
        values = results.values(results.ranked_by, climate)
        grid = np.full((len(down.options), len(across.options)), np.nan)
        for i in range(len(down.options)):
            for j in range(len(across.options)):
                design = list(best)
                design[pair[0]], design[pair[1]] = float(j), float(i)
                grid[i, j] = values[indices[tuple(design)]]
        title = f"{_named(results, results.ranked_by)}, {climate}"
        labels = (_axis(across), _axis(down))
        columns = [_column(option.label, option.value, across) for option in across.options]
        rows = [option.label for option in down.options]
        maps.append(
            {
                "title": title,
                "drawing": charts.heat_map(columns, rows, grid, labels, title, least=objective.least),
            }
        )
    return maps


def _pair(choices: Sequence[Choice]) -> tuple[int, int] | None:
    """A variable of products, or one with many options, and a variable of numbers."""
    wide = [k for k, choice in enumerate(choices) if 1 < len(choice.options) <= _MAX_OPTIONS]
    products = [k for k in wide if choices[k].unit == "degC" and choices[k].structural]
    numbers = [k for k in wide if choices[k].paths and k not in products]
    numbers.sort(key=lambda k: not any(path.endswith(".thickness") for path in choices[k].paths))
    across = (products or numbers[1:] or [k for k in wide if k not in numbers])[:1]
    return (across[0], numbers[0]) if across and numbers else None


def _axis(choice: Choice) -> str:
    if choice.structural and choice.unit == "degC":
        return f"{choice.name}, by melting temperature in °C"
    return with_unit_of(choice)


def _column(label: str, value: float | None, choice: Choice) -> str:
    return f"{label} {value:.1f}" if choice.structural and value is not None else label


def _designs(results: DesignResults) -> dict[str, Any]:
    names = results.columns
    cost = results.cost(results.ranked_by)
    order = np.argsort(np.where(np.isfinite(cost), cost, np.inf), kind="stable")[:_MAX_ROWS]
    labels = results.inputs.choices.labels([results.designs[k] for k in order])
    columns = [results.values(name) for name in names]
    rows = [
        {
            "design": int(k),
            "labels": [column[row] for column in labels.values()],
            "values": [text.significant(float(values[k])) for values in columns],
        }
        for row, k in enumerate(order)
    ]
    failed = results.nominal["failure"].dropna()
    return {
        "variables": list(labels),
        "heads": [_named(results, objective, name) for name, objective in names.items()],
        "rows": rows,
        "count": len(results.designs),
        "failed": len(failed),
        "reason": next(iter(failed), ""),
    }


# ------------------------------------------------------------------ single designs


def _details(results: DesignResults) -> dict[str, list[Detail]]:
    """The reference, the best design, and that of each climate if it is another one, by climate."""
    best = results.best[results.rankings[ALL].order[0]]
    details = {}
    for site in results.inputs.sites:
        local_best = results.best[results.rankings[site.name].order[0]]
        chosen = {f"design {best}": best} | (
            {f"design {local_best}": local_best} if local_best != best else {}
        )
        runs = [detail(results.inputs, site, None, REFERENCE)]
        runs += [detail(results.inputs, site, results.designs[k], name) for name, k in chosen.items()]
        details[site.name] = runs
    return details


def _cycling(results: DesignResults, details: dict[str, list[Detail]]) -> list[dict[str, Any]]:
    """Days by the change of the liquid fraction, and the range of every day."""
    bins = [key for key in results.nominal.columns if key.startswith("bin ")]
    sites = []
    for site in results.inputs.sites:
        figures = []
        for output in dict.fromkeys(key.split(" ", 2)[2] for key in bins):
            layer = output.removesuffix("_liquid_fraction")
            counts = np.column_stack(
                [results.values(f"bin {k} {output}", site.name)[results.best] for k in range(BINS)]
            )
            title = f"{layer}, {site.name}"
            names = [f"design {k}" for k in results.best]
            figures.append({"title": title, "drawing": charts.cycling(counts, names, title)})
        daily = [
            {
                "title": f"{run.label}, {layer}",
                "drawing": charts.daily_fraction(run, layer, f"{run.label}, {layer}"),
            }
            for run in details[site.name]
            for layer in run.fractions
        ]
        if figures or daily:
            sites.append({"name": site.name, "figures": figures, "daily": daily})
    return sites


def _why(results: DesignResults, details: dict[str, list[Detail]]) -> list[dict[str, Any]]:
    """Mean days of temperature and heat flows, and the heat flows of the period."""
    zone = zones_of(results.inputs)[0]
    layers = layers_of(results.inputs.building)
    sections = []
    for climate, runs in details.items():
        curves = {charts.OUTDOORS: runs[0].outdoors} | {run.label: run.temperature[zone] for run in runs}
        figures = [
            {
                "title": f"Operative temperature of {zone}",
                "legend": charts.legend(curves),
                "drawing": charts.day_curves(curves, "degC", f"Operative temperature of {zone}, {climate}"),
            }
        ]
        groups = {run.label: grouped_gains(run, layers) for run in runs}
        for name in next(iter(groups.values())):
            gains = {label: group[name] for label, group in groups.items()}
            if any(np.abs(values).max() > 0.0 for values in gains.values()):
                title = f"Heat into {zone}: {name}"
                figures.append(
                    {
                        "title": title,
                        "legend": charts.legend(gains),
                        "drawing": charts.day_curves(gains, "W", f"{title}, {climate}", around=0.0),
                    }
                )
        flows = [name for name in runs[0].flows if any(abs(run.flows[name]) > 3.6e3 for run in runs)]
        table = [
            {"name": flow_words(name), "values": [text.significant(run.flows[name] / 3.6e6) for run in runs]}
            for name in flows
        ]
        sections.append(
            {"name": climate, "figures": figures, "labels": [run.label for run in runs], "flows": table}
        )
    return sections


def _method(results: DesignResults) -> dict[str, Any]:
    file = results.inputs.file
    uncertain = file.uncertainty
    pairs = {
        "Mascarin": __version__,
        "Building": results.inputs.building.name,
        "Time step": f"{file.step}, {file.scheme}",
        "Designs chosen by": file.search.method
        if file.search.method == "grid"
        else f"{file.search.method}, seed {file.search.seed}",
        "Largest energy-balance residual": text.significant(results.summary()["closure"], 2),
    }
    if uncertain is not None:
        pairs["Samples"] = f"{uncertain.samples}, Latin hypercube, seed {uncertain.seed}"
        pairs["Uncertain parameters"] = str(len(results.inputs.uncertain))
    for site in results.inputs.sites:
        pairs[f"Climate {site.name}"] = (
            f"{site.words}, {site.start:%Y-%m-%d} to {site.end:%Y-%m-%d}, SHA-256 {site.hash[:12]}"
        )
    return {"pairs": pairs, "uncertain": list(results.inputs.uncertain)}
