"""The page of Standard 140: its cases compared with six programs, as one HTML file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin._io import atomic, units
from mascarin._io.limits import at_least, at_most
from mascarin.figures import text
from mascarin.figures.svg.chart import Axis, Chart
from mascarin.pages.frame.template import environment, frame
from mascarin.verification.bestest.catalogue import CASES, IN_DEPTH, MAIN, Case
from mascarin.verification.bestest.quantities import (
    COLDEST_BIN,
    MONTHS,
    ORIENTATIONS,
    THROUGH_GLASS,
    BestestQuantity,
    BestestYear,
    bins,
    energy,
    hours_of,
    months,
    when,
)
from mascarin.verification.bestest.reference import PROGRAMS, Range, ranges

if TYPE_CHECKING:
    from mascarin.verification.bestest.quantities import Array

_WORDS: Final = {
    "annual_heating": "Annual heating",
    "annual_cooling": "Annual sensible cooling",
    "peak_heating": "Peak heating",
    "peak_cooling": "Peak sensible cooling",
    "max_temperature": "Highest temperature",
    "min_temperature": "Lowest temperature",
    "mean_temperature": "Mean temperature",
}
_CLASSES: Final = ("c0", "c1", "c2", "c3", "c6", "c7")
"""Color of each program."""
_HOURS: Final = np.arange(24, dtype=np.float64) + 0.5


def write(
    path: Path, rows: Sequence[BestestQuantity], years: Mapping[str, BestestYear], facts: Mapping[str, str]
) -> Path:
    """Write the page to a file.

    Parameters
    ----------
    path : Path
        Where to.
    rows : sequence of BestestQuantity
        All quantities.
    years : mapping of str to BestestYear
        Hourly means by case.
    facts : mapping of str to str
        How to reproduce the results, as name and value.

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(rows, years, facts))


def render(
    rows: Sequence[BestestQuantity], years: Mapping[str, BestestYear], facts: Mapping[str, str]
) -> str:
    """Make the page; the parameters are those of `write`."""
    held = [row for row in rows if row.range is not None]
    rows_by_case = {(row.case, row.quantity): row for row in held}
    sections = [
        {"id": key, "title": title, "content": content}
        for key, title, content in (
            ("loads", "Annual loads", _bars(rows_by_case, ("annual_heating", "annual_cooling"), "MWh")),
            ("peaks", "Peak loads", _bars(rows_by_case, ("peak_heating", "peak_cooling"), "kW")),
            ("floating", "Free-floating temperatures", _floating(rows_by_case)),
            ("sun", "Solar radiation", _sun(rows_by_case)),
            ("differences", "Differences between cases", _differences(rows_by_case)),
            ("days", "Hourly values of three days", _days(years)),
            ("months", "Monthly values", _months(years)),
            ("bins", "Hours at each temperature", _bins(years)),
            ("table", "All values", _table(rows)),
            ("repeat", "How to reproduce the results", dict(facts)),
        )
        if content
    ]
    outside = [row for row in held if not row.passed]
    return (
        environment()
        .get_template("pages/suites/bestest.html")
        .render(
            frame(styles=["pages/suites/bestest.css"]),
            title="Standard 140 with Mascarin",
            version=__version__,
            sections=sections,
            programs=list(zip(PROGRAMS, _CLASSES, strict=True)),
            count=len(held),
            inside=len(held) - len(outside),
            outside=[_outside(row) for row in outside],
            cases=len({row.case for row in held}),
            closure=text.significant(max((year.closure for year in years.values()), default=0.0), 2),
        )
    )


def _words(quantity: str) -> str:
    if quantity in _WORDS:
        return _WORDS[quantity]
    kind, _, plane = quantity.rpartition("_")
    return f"{kind.replace('_', ' ').replace('solar', 'solar radiation').capitalize()}, {plane}"


# ------------------------------------------------------------------ bars

Rows = Mapping[tuple[str, str], BestestQuantity]
Group = tuple[str, tuple[Case, ...]]
_GROUPS: Final[tuple[Group, ...]] = (
    ("low mass", MAIN[:8]),
    ("high mass and sunspace", MAIN[8:]),
    ("in depth, 195 to 250", tuple(case for case in IN_DEPTH if case.name < "260")),
    ("in depth, 270 to 320", tuple(case for case in IN_DEPTH if "260" < case.name < "330")),
    ("in depth, 395 to 440, 800 and 810", tuple(case for case in IN_DEPTH if case.name > "330")),
)


def _bars(rows_by_case: Rows, quantities: Sequence[str], unit: str) -> list[dict[str, Any]]:
    figures = []
    for quantity in quantities:
        for title, cases in _GROUPS:
            rows = [rows_by_case[key] for case in cases if (key := (case.name, quantity)) in rows_by_case]
            if rows:
                figures.append(_bar_chart(f"{_words(quantity)}, {title}", [(r.case, r) for r in rows], unit))
    return figures


def _bar_chart(title: str, rows: Sequence[tuple[str, BestestQuantity]], unit: str) -> dict[str, Any]:
    """A group of bars for each row: the six programs, then Mascarin, and a band over their range."""
    values = [v for _, row in rows for v in (*_theirs(row).programs.values(), row.value)]
    y = Axis.over(values, around=0.0)
    centres = np.arange(len(rows)) + 0.5
    axis = Axis(0.0, float(len(rows)), tuple(centres), tuple(name for name, _ in rows))
    chart = Chart(axis, y, width=max(340.0, 90.0 + 62.0 * len(rows)), height=210.0, y_label=units.shown(unit))
    width = 0.105
    for centre, (_, row) in zip(centres, rows, strict=True):
        group_start = centre - 3.5 * width
        theirs = _theirs(row)
        chart.bar(group_start - 0.03, group_start + 7 * width + 0.03, theirs.low, theirs.high, "sensor-band")
        for index, program in enumerate(PROGRAMS):
            if program in theirs.programs:
                x = group_start + index * width
                chart.bar(x, x + 0.85 * width, 0.0, theirs.programs[program], _CLASSES[index])
        x = group_start + 6 * width
        chart.bar(x, x + width, 0.0, row.value, "ours" if row.passed else "ours outside")
    said = "; ".join(f"{name}: {_shown(row, row.value)} of {_span(row)}" for name, row in rows)
    return {"title": f"{title}, {units.shown(unit)}", "drawing": chart.markup(f"{title}. {said}")}


def _outside(row: BestestQuantity) -> str:
    shown_value = f"{_shown(row, row.value)} {units.shown(row.unit)}"
    whose = "the six programs" if (row.case, row.quantity) in ranges() else "--ranges"
    return f"{row.case}: {_words(row.quantity)}, {shown_value} outside of the range {_span(row)} of {whose}"


def _span(row: BestestQuantity) -> str:
    # With as many digits as the value: rounded, they could suggest the opposite.
    return f"{_shown(row, _theirs(row).low)} to {_shown(row, _theirs(row).high)}"


def _theirs(row: BestestQuantity) -> Range:
    """The range of a quantity: that of the six programs, or that of the user for an own case."""
    return row.range or ranges()[row.case, row.quantity]


def _floating(rows_by_case: Rows) -> list[dict[str, Any]]:
    figures = []
    for quantity in ("max_temperature", "min_temperature", "mean_temperature"):
        rows = [(case, row) for (case, name), row in rows_by_case.items() if name == quantity]
        if rows:
            figures.append(_bar_chart(_words(quantity), rows, "degC"))
    return figures


def _sun(rows_by_case: Rows) -> list[dict[str, Any]]:
    kinds = (
        ("incident_solar", "Solar irradiation of each plane over the year, case 600", "kWh/m2"),
        ("transmitted_solar", "Solar radiation through the window over the year", "kWh/m2"),
        ("transmissivity", "Solar transmittance of the window over the year", "-"),
        ("shading_coefficient", "Fraction of the solar radiation blocked by the shades", "-"),
    )
    figures = []
    for start, title, unit in kinds:
        rows = [
            (f"{name.removeprefix(start + '_')}" if start == "incident_solar" else case, row)
            for (case, name), row in rows_by_case.items()
            if name.startswith(start)
        ]
        if rows:
            figures.append(_bar_chart(title, rows, unit))
    return figures


# ------------------------------------------------------------------ differences between cases


def _differences(rows_by_case: Rows) -> list[dict[str, Any]]:
    """Each case minus its base, which isolates one part of the model."""
    rows = []
    for case in CASES.values():
        cells: list[dict[str, Any]] = []
        for quantity in ("annual_heating", "annual_cooling", "peak_heating", "peak_cooling"):
            case_row, base_row = (
                rows_by_case.get((case.name, quantity)),
                rows_by_case.get((case.base, quantity)),
            )
            if case.name == case.base or case_row is None or base_row is None:
                break
            cells.append(_difference(case_row, base_row))
        else:
            rows.append({"name": f"{case.name} − {case.base}", "change": case.change, "cells": cells})
    return rows


def _difference(case_row: BestestQuantity, base_row: BestestQuantity) -> dict[str, Any]:
    theirs = [
        value - _theirs(base_row).programs[program]
        for program, value in _theirs(case_row).programs.items()
        if program in _theirs(base_row).programs
    ]
    ours = case_row.value - base_row.value
    low, high = min(theirs), max(theirs)
    return {
        "ours": text.fixed(ours, sign=True),
        "theirs": f"{text.fixed(low, sign=True)} to {text.fixed(high, sign=True)}",
        "inside": bool(at_least(ours, low) and at_most(ours, high)),
    }


# ------------------------------------------------------------------ hourly days, months, bins


def _days(years: Mapping[str, BestestYear]) -> list[dict[str, Any]]:
    """The charts that the standard requires, without cases that were not run."""
    figures = []
    for title, month, day, unit, curves in _DAYS:
        labeled_curves = [
            (label, _day_values(years[case], series, month, day))
            for label, case, series in curves
            if case in years and (series in ("load", "temperature") or series in years[case].series)
        ]
        if labeled_curves:
            figures.append(_curves(f"{title}, {day} {month}", labeled_curves, unit))
    return figures


def _day_values(year: BestestYear, series: str, month: str, day: int) -> Array:
    hours = hours_of(month, day)
    if series == "load":
        return (year.heating[hours] - year.cooling[hours]) / 1e3
    values = year.temperature if series == "temperature" else year.series[series]
    return values[hours]


def _curves(title: str, labeled_curves: Sequence[tuple[str, Array]], unit: str) -> dict[str, Any]:
    y = Axis.over(*[values for _, values in labeled_curves], around=0.0 if unit != "degC" else None)
    x = Axis(0.0, 24.0, (0.0, 6.0, 12.0, 18.0, 24.0), ("0", "6", "12", "18", "24"))
    chart = Chart(x, y, width=340.0, height=200.0, x_label="hour", y_label=units.shown(unit))
    for index, (_, values) in enumerate(labeled_curves):
        chart.curve(np.asarray(_HOURS, dtype=np.float64), values, f"s{index}")
    said = "; ".join(
        f"{label}: {text.significant(float(values.min()))} to {text.significant(float(values.max()))}"
        for label, values in labeled_curves
    )
    return {
        "title": title,
        "drawing": chart.markup(f"{title}, {units.shown(unit)}. {said}"),
        "keys": [(label, f"s{index}") for index, (label, _) in enumerate(labeled_curves)],
    }


def _each(cases: Sequence[str], series: str) -> list[tuple[str, str, str]]:
    return [(case, case, series) for case in cases]


_PLANES: Final = [(plane, "600", ORIENTATIONS[plane]) for plane in ("horizontal", "south", "west")]
_DAYS: Final = (
    ("Load, heating above zero", "Feb", 1, "kW", _each(("600", "640", "900", "940"), "load")),
    ("Air temperature", "Feb", 1, "degC", _each(("640", "940"), "temperature")),
    ("Free-floating temperature", "Feb", 1, "degC", _each(("600FF", "900FF"), "temperature")),
    ("Load, cooling below zero", "Jul", 14, "kW", _each(("600", "900"), "load")),
    ("Free-floating temperature", "Jul", 14, "degC", _each(("650FF", "950FF"), "temperature")),
    ("Solar irradiance on three planes", "May", 4, "W/m2", _PLANES),
    ("Solar irradiance on three planes", "Jul", 14, "W/m2", _PLANES),
    *(
        (title, month, day, unit, [(label, "600", series)])
        for title, unit, label, series in (
            ("Solar radiation through the south window", "W/m2", "600", THROUGH_GLASS),
            ("Sky temperature", "degC", "600", "sky_temperature"),
        )
        for month, day in (("Feb", 1), ("May", 4), ("Jul", 14))
    ),
)  # fmt: skip


def _months(years: Mapping[str, BestestYear]) -> list[dict[str, Any]]:
    return [
        {
            "case": name,
            "rows": [_month(years[name], hours, word) for word, hours in zip(MONTHS, months(), strict=True)],
        }
        for name in ("600", "900")
        if name in years
    ]


def _month(year: BestestYear, hours: slice, word: str) -> dict[str, str]:
    cells = {"name": word}
    for kind, watts in (("heating", year.heating), ("cooling", year.cooling)):
        part = watts[hours]
        top = int(np.argmax(part))
        cells[kind] = text.fixed(1e3 * energy(part), 1)
        cells[f"{kind}_peak"] = text.fixed(float(part[top]) / 1e3, 3)
        cells[f"{kind}_when"] = when(hours.start + top) if part[top] > 0.0 else text.NONE
    return cells


def _bins(years: Mapping[str, BestestYear]) -> list[dict[str, Any]]:
    if "900FF" not in years:
        return []
    counts = bins(years["900FF"].temperature)
    shown = np.flatnonzero(counts)
    first, last = int(shown[0]) - 1, int(shown[-1]) + 2
    ticks = [float(t) for t in range(COLDEST_BIN + first, COLDEST_BIN + last + 1) if t % 5 == 0]
    x = Axis(float(COLDEST_BIN + first), float(COLDEST_BIN + last), ticks, [text.fixed(t, 0) for t in ticks])
    chart = Chart(x, Axis.over(counts, around=0.0), width=680.0, height=220.0, x_label="°C", y_label="hours")
    for index in shown:
        chart.bar(COLDEST_BIN + index + 0.06, COLDEST_BIN + index + 0.94, 0.0, float(counts[index]), "ours")
    title = "Case 900FF, hours in each bin of 1 K"
    return [
        {
            "title": title,
            "drawing": chart.markup(f"{title}; most at {COLDEST_BIN + int(np.argmax(counts))} °C"),
        }
    ]


def _table(rows: Sequence[BestestQuantity]) -> list[dict[str, Any]]:
    return [
        {
            "case": row.case,
            "quantity": _words(row.quantity),
            "unit": units.shown(row.unit),
            "value": _shown(row, row.value),
            "when": row.when,
            "passed": row.passed,
        }
        | _beside(row)
        for row in rows
    ]


def _beside(row: BestestQuantity) -> dict[str, str]:
    theirs = row.range
    if theirs is None:
        return dict.fromkeys(("low", "mean", "high"), text.NONE)
    return {key: _shown(row, getattr(theirs, key)) for key in ("low", "mean", "high")}


def _shown(row: BestestQuantity, value: float) -> str:
    return text.fixed(value, {"kWh/m2": 0, "degC": 1}.get(row.unit, 3))
