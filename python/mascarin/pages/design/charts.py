"""The drawings of the report of a design study, as SVG without scripts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io import units
from mascarin.design.evaluation.reductions import BINS
from mascarin.figures import text
from mascarin.figures.svg.chart import Axis, Chart, round_marks, tick_names

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.design.variants.details import Detail
    from mascarin.design.variants.ranking import Ranking

    Array = npt.NDArray[np.float64]

#: Outdoor air, in charts of temperatures.
OUTDOORS: Final = "outdoor air"
#: Shades of the scale of a map.
_SHADES: Final = 9
#: Classes of the lines of the reference and of designs, in their order.
_LINES: Final = ("of-reference", "of-best", "of-other")


def intervals(ranking: Ranking, names: Sequence[str], title: str, unit: str) -> Any:
    """Differences from the best design with their intervals, the best at the top."""
    order = list(ranking.order)
    x = Axis.over(ranking.low, ranking.high, around=0.0)
    margin = 14.0 + 6.2 * max((len(name) for name in names), default=0)
    height = 40.0 + 20.0 * len(order) + 20.0
    chart = Chart(
        x,
        Axis(0.0, float(len(order))),
        width=margin + 380.0,
        height=height,
        x_label=units.shown(unit),
        margin_left=margin,
    )
    zero = chart.px(0.0)
    chart.svg.line(zero, 20.0, zero, height - 34.0, "grid zero")
    for row, k in enumerate(order):
        y = chart.py(len(order) - row - 0.5)
        low, high, mid = chart.px(ranking.low[k]), chart.px(ranking.high[k]), chart.px(ranking.difference[k])
        chart.svg.label(margin - 8.0, y + 4.0, names[row], "tick", "end")
        chart.svg.add("rect", x=low, y=y - 4.0, width=max(high - low, 1.0), height=8.0, class_="interval")
        chart.svg.add("circle", cx=mid, cy=y, r=3.5, class_="mark-tied" if ranking.tied[k] else "mark-apart")
    said = "; ".join(
        f"{names[row]}: {text.significant(float(ranking.difference[k]))}" for row, k in enumerate(order)
    )
    return chart.markup(f"{title}. {said}")


def beside_reference(values: Array, names: Sequence[str], reference: float, axis: str, title: str) -> Any:
    """Values as distances from the reference, which is a line over all of them, the first at the top."""
    with_reference = np.append(values, reference)
    x = Axis.over(with_reference[np.isfinite(with_reference)])
    margin = 14.0 + 6.2 * max((len(name) for name in names), default=0)
    height = 52.0 + 22.0 * len(names)
    chart = Chart(
        x,
        Axis(0.0, float(len(names))),
        width=margin + 380.0,
        height=height,
        x_label=axis,
        margin_left=margin,
    )
    if np.isfinite(reference):
        line = chart.px(reference)
        chart.svg.line(line, 14.0, line, height - 34.0, "zero of-reference")
        # Beside the line, on the side that has more room.
        side, anchor = (4.0, "start") if line < margin + 190.0 else (-4.0, "end")
        chart.svg.label(line + side, 12.0, "reference", "tick", anchor)
    for row, (name, value) in enumerate(zip(names, values, strict=True)):
        y = chart.py(len(names) - row - 0.5)
        chart.svg.label(margin - 8.0, y + 4.0, name, "tick", "end")
        if not np.isfinite(value):
            continue
        if np.isfinite(reference):
            low, high = sorted((chart.px(reference), chart.px(float(value))))
            chart.svg.add("rect", x=low, y=y - 4.0, width=max(high - low, 0.5), height=8.0, class_="interval")
        chart.svg.add("circle", cx=chart.px(float(value)), cy=y, r=3.5, class_="mark-apart")
    said = "; ".join(
        f"{name}: {text.significant(float(value))}" for name, value in zip(names, values, strict=True)
    )
    return chart.markup(f"{title}. {said}; reference: {text.significant(reference)}")


def scatter(
    x: Array, y: Array, front: npt.NDArray[np.bool_], best: Sequence[int], axes: tuple[str, str], title: str
) -> Any:
    """All designs by two objectives; those that no other one beats in both are joined by a line."""
    chart = Chart(
        Axis.over(x),
        Axis.over(y),
        width=460.0,
        height=320.0,
        x_label=axes[0],
        y_label=axes[1],
        margin_left=52.0,
    )
    finite = np.isfinite(x) & np.isfinite(y)
    for k in _thinned(np.flatnonzero(finite & ~front), 1500):
        chart.svg.add("circle", cx=chart.px(x[k]), cy=chart.py(y[k]), r=2.2, class_="dot-design")
    members = np.flatnonzero(front & finite)
    members = members[np.argsort(x[members], kind="stable")]
    if members.size:
        chart.curve(x[members], y[members], "front")
    for k in members:
        chart.svg.add("circle", cx=chart.px(x[k]), cy=chart.py(y[k]), r=3.2, class_="dot-front")
    for k in best:
        if finite[k]:
            chart.svg.add("circle", cx=chart.px(x[k]), cy=chart.py(y[k]), r=6.0, class_="ring-best")
    return chart.markup(f"{title}; {members.size} designs on the Pareto front")


def heat_map(
    columns: Sequence[str],
    rows: Sequence[str],
    values: Array,
    labels: tuple[str, str],
    title: str,
    *,
    least: bool,
) -> Any:
    """Values over two variables, dark where they are good; the best cell has a frame."""
    width = max(460.0, 90.0 + 26.0 * len(columns))
    names = list(columns)
    # Room for the inclined names, and for the label below them.
    bottom = 30.0 + 5.0 * max((len(name) for name in names), default=0)
    scale = 34.0  # for the scale at the foot
    bottom += scale
    height = 26.0 + bottom + 22.0 * len(rows)
    x = Axis(0.0, float(len(names)), (), ())
    chart = Chart(
        x,
        Axis(0.0, float(len(rows))),
        width=width,
        height=height,
        y_label=labels[1],
        margin_left=60.0,
        margin_bottom=bottom,
    )
    good = np.where(np.isfinite(values), values if least else -values, np.nan)
    low, high = (np.nanmin(good), np.nanmax(good)) if np.isfinite(good).any() else (0.0, 1.0)
    span = max(high - low, 1e-12)
    for i in range(len(rows)):
        y = chart.py(i + 0.5)
        chart.svg.label(54.0, y + 3.5, rows[i], "tick", "end")
        for j in range(len(names)):
            if np.isfinite(good[i, j]):
                shade = 0.06 + 0.86 * (high - good[i, j]) / span
                _cell(chart, i, j, "heat", shade)
    for j, name in enumerate(names):
        rotation = f"rotate(-60 {chart.px(j + 0.62):.1f} {height - bottom + 10.0:.1f})"
        chart.svg.add(
            "text",
            name,
            x=chart.px(j + 0.62),
            y=height - bottom + 10.0,
            class_="t tick",
            text_anchor="end",
            transform=rotation,
        )
    chart.svg.label(width - 8.0, height - scale - 3.0, labels[0], "axis-label", "end")
    if np.isfinite(good).any():
        _scale(chart, (low, high) if least else (-low, -high), height - 20.0)
        row, column = (int(k) for k in np.unravel_index(np.nanargmin(good), good.shape))
        _cell(chart, row, column, "cell-best", None)
        best = f"best {text.significant(float(values[row, column]))} at {names[column]}, {rows[row]}"
    else:
        best = "no value"
    return chart.markup(f"{title}; {best}")


def _scale(chart: Chart, ends: tuple[float, float], y: float) -> None:
    """The shades of a map from the best to the worst value, with numbers below three of them."""
    x_start, width = 60.0, 26.0
    for k in range(_SHADES):
        part = k / (_SHADES - 1)
        chart.svg.add(
            "rect", x=x_start + width * k, y=y - 10.0, width=width, height=10.0, class_="heat",
            fill_opacity=f"{0.92 - 0.86 * part:.3f}",
        )  # fmt: skip
        if k % 4 == 0:
            value = ends[0] + part * (ends[1] - ends[0])
            chart.svg.label(
                x_start + width * (k + 0.5), y + 13.0, text.significant(value, 4), "tick", "middle"
            )


def _cell(chart: Chart, i: int, j: int, class_: str, shade: float | None) -> None:
    x0, x1, y0, y1 = chart.px(j), chart.px(j + 1), chart.py(i + 1), chart.py(i)
    extra = {} if shade is None else {"fill_opacity": f"{shade:.3f}"}
    chart.svg.add(
        "rect", x=x0 + 0.5, y=y0 + 0.5, width=x1 - x0 - 1.0, height=y1 - y0 - 1.0, class_=class_, **extra
    )


def cycling(counts: Array, names: Sequence[str], title: str) -> Any:
    """Days by the daily change of the liquid fraction, a bar for each design, from no change to all."""
    margin = 14.0 + 6.2 * max((len(name) for name in names), default=0)
    total = float(counts.sum(axis=1).max()) or 1.0
    ticks = round_marks(0.0, total)
    x = Axis(0.0, max(total, ticks[-1]), ticks, tick_names(ticks))
    height = 60.0 + 22.0 * len(names)
    chart = Chart(
        x,
        Axis(0.0, float(len(names))),
        width=margin + 380.0,
        height=height,
        x_label="days",
        margin_left=margin,
    )
    for row, name in enumerate(names):
        start, y = 0.0, chart.py(len(names) - row - 0.5)
        chart.svg.label(margin - 8.0, y + 4.0, name, "tick", "end")
        for k in range(BINS):
            days = float(counts[row, k])
            if days > 0.0:
                x0, x1 = chart.px(start), chart.px(start + days)
                shade = f"{0.08 + 0.92 * k / (BINS - 1):.3f}"
                chart.svg.add(
                    "rect",
                    x=x0,
                    y=y - 7.0,
                    width=max(x1 - x0, 0.5),
                    height=14.0,
                    class_="heat",
                    fill_opacity=shade,
                )
            start += days
    half = BINS // 2
    said = "; ".join(
        f"{name}: {counts[row, half:].sum():g} days of half or more" for row, name in enumerate(names)
    )
    return chart.markup(f"{title}. {said}")


def day_curves(curves: Mapping[str, Array], unit: str, title: str, *, around: float | None = None) -> Any:
    """Mean values at each hour of the day, a line for each."""
    hours = np.arange(24, dtype=np.float64) + 0.5
    x = Axis(0.0, 24.0, (0.0, 6.0, 12.0, 18.0, 24.0), ("0", "6", "12", "18", "24"))
    y = Axis.over(*curves.values(), around=around)
    chart = Chart(
        x, y, width=400.0, height=230.0, x_label="hour", y_label=units.shown(unit), margin_left=46.0
    )
    classes = dict(legend(curves))
    for name, values in curves.items():
        chart.curve(hours, values, classes[name])
    said = "; ".join(
        f"{name}: {text.significant(float(v.min()))} to {text.significant(float(v.max()))}"
        for name, v in curves.items()
    )
    return chart.markup(f"{title}, {units.shown(unit)}. {said}")


def legend(curves: Mapping[str, Array]) -> list[tuple[str, str]]:
    """Names and classes of the curves of `day_curves`; a design has the same one in every chart."""
    designs = [name for name in curves if name != OUTDOORS]
    return [
        (name, "of-outdoors" if name == OUTDOORS else _LINES[min(designs.index(name), len(_LINES) - 1)])
        for name in curves
    ]


def daily_fraction(detail: Detail, layer: str, title: str) -> Any:
    """Range of the liquid fraction on every day of the period."""
    low, high = detail.fractions[layer]
    count = len(low)
    months = detail.days.astype("datetime64[M]")
    firsts = np.flatnonzero(np.concatenate([[True], months[1:] != months[:-1]]))
    names = [str(detail.days[k])[5:] for k in firsts]
    x = Axis(0.0, float(count), tuple(map(float, firsts)), tuple(names))
    y = Axis(0.0, 1.0, (0.0, 0.5, 1.0), ("0", "0.5", "1"))
    chart = Chart(x, y, width=460.0, height=144.0, x_label="month-day", y_label="liquid fraction")
    for day in range(count):
        chart.bar(day + 0.1, day + 0.9, float(low[day]), float(high[day]), "model-day")
    full = int((high - low >= 0.5).sum())
    return chart.markup(f"{title}: {full} of {count} days change by half or more")


def _thinned(rows: npt.NDArray[np.int64], most: int) -> npt.NDArray[np.int64]:
    """At most so many rows, evenly spaced; a page of all points would be too heavy."""
    return rows if len(rows) <= most else rows[np.linspace(0, len(rows) - 1, most).astype(np.int64)]
