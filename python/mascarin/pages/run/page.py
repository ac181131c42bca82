"""The summary of one run as one HTML file without scripts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

import numpy as np

from mascarin._io import atomic, units
from mascarin.building.outputs.kinds import KINDS
from mascarin.figures import text
from mascarin.figures.svg.axes import short_day, time_axis
from mascarin.figures.svg.chart import Axis, Chart
from mascarin.pages.frame.template import environment, frame
from mascarin.pages.study.data.series import Array
from mascarin.pages.study.sections.energy import ledger_bars
from mascarin.simulation.records.provenance import words_of
from mascarin.study_document.comparison import LedgerEntry, LedgerTerm

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.building.outputs.output import Output
    from mascarin.simulation.results import Results

    _Numbered: TypeAlias = tuple[int, Output]

#: Kinds of outputs that are shown without being asked for, in their order.
_FIGURES: Final = (
    "air_temperature",
    "operative_temperature",
    "relative_humidity",
    "liquid_fraction",
    "heating_load",
    "cooling_load",
)
#: Curves in one figure, and intervals of a curve: more of them are averaged.
_CURVES, _POINTS = 8, 700
#: Kinds that every zone has, of which rooms are shown apart from cavities and attics.
_OF_ZONES: Final = ("air_temperature", "operative_temperature", "relative_humidity")
_KINDS_OF_LOADS: Final = ("heating_load", "cooling_load")
_FLOWS: Final = {
    "solar": "Solar radiation on surfaces",
    "convection": "Convection outdoors",
    "longwave": "Long-wave radiation outdoors",
    "boundary": "Ground and measured boundaries",
    "infiltration": "Infiltration",
    "ventilation": "Ventilation",
    "interzone": "Air between zones",
    "gains": "Internal gains",
    "heating": "Heating",
    "cooling": "Cooling",
    "transmitted": "Sun through windows",
    "glass": "Through panes",
    "bridges": "Thermal bridges",
    "sources": "Heat sources in surfaces, and soil",
}


class Notes(NamedTuple):
    """What a page says beside the results.

    Parameters
    ----------
    outdoors : ndarray, shape (rows,), or None
        Outdoor air temperature at the recorded times. [degC]
    warnings : sequence of str
        Warnings about the building.
    inputs : sequence of (str, str)
        Files and options, by name.
    rooms : sequence of str
        Zones that are shown first; empty: all.
    other_zones : str
        What the other zones are, such as 'cavities'.
    """

    outdoors: Array | None = None
    warnings: Sequence[str] = ()
    inputs: Sequence[tuple[str, str]] = ()
    rooms: Sequence[str] = ()
    other_zones: str = "cavities"

    def in_room(self, output: str) -> bool:
        """Whether an output is that of a room."""
        return not self.rooms or output.partition(".")[0] in self.rooms


def needed(building: Building) -> list[str]:
    """Outputs that the page shows.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> needed(box())[0]
    'room.air_temperature'
    """
    return [output.name for output in building.outputs() if output.kind in _FIGURES]


def write(path: Path, results: Results, notes: Notes) -> Path:
    """Write the page of a run to a file.

    Parameters
    ----------
    path : Path
        Where to.
    results : Results
        The run.
    notes : Notes
        What else the page says.

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(results, notes))


def render(results: Results, notes: Notes) -> str:
    """Make the page; the parameters are those of `write`.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> page = render(mc.simulate(box(), box_climate(), step="1h"), Notes())
    >>> "Energy balance" in page
    True
    """
    warnings = list(dict.fromkeys([*notes.warnings, *results.warnings]))
    sections = [
        {"id": key, "title": title, "content": content}
        for key, title, content in (
            ("warnings", "Warnings", warnings),
            ("series", "Series", _figures(results, notes)),
            ("loads", "Ideal heating and cooling", _loads(results)),
            ("energy", "Energy balance", _energy(results)),
            ("outputs", "All outputs", _outputs(results)),
            ("inputs", "How it was run", how_it_was_run(results, notes)),
        )
        if content
    ]
    provenance = results.provenance
    return (
        environment()
        .get_template("pages/run/run.html")
        .render(
            frame(styles=["pages/run/run.css"]),
            title=provenance.building,
            version=provenance.version,
            sections=sections,
            facts=_facts(results, notes),
            period=text.span_of(results.index[0], results.index[-1]),
            climate=_climate(provenance.climate),
        )
    )


def _climate(climate: Mapping[str, Any]) -> str:
    return Path(str(climate.get("file") or climate.get("source") or "")).name


def _facts(results: Results, notes: Notes) -> list[dict[str, str]]:
    facts = []
    air = [
        k
        for k, output in enumerate(results.outputs)
        if output.kind == "air_temperature" and notes.in_room(output.name)
    ]
    if air:
        low, high = (float(f(results.records[:, air])) for f in (np.min, np.max))
        span = f"{text.fixed(low, 1)} to {text.fixed(high, 1)}\u00a0°C"
        facts.append(("Air temperature", span, "lowest and highest of all rooms", ""))
    for kind, title in (("heating", "Heating"), ("cooling", "Cooling")):
        if any(output.kind == f"{kind}_load" for output in results.outputs):
            heat = abs(results.energy.into[kind]) / 3.6e6
            facts.append((title, text.with_unit(heat, "kWh"), "ideal, over the period", ""))
    kind = "pass" if results.energy.closes else "fail"
    closure = text.significant(results.energy.relative_residual, 2)
    facts.append(("Energy-balance residual", closure, "relative to the total heat exchanged", kind))
    return [dict(zip(("name", "value", "note", "kind"), fact, strict=True)) for fact in facts]


# ------------------------------------------------------------------ series


def _figures(results: Results, notes: Notes) -> list[dict[str, Any]]:
    figures = []
    requested_kinds = [o.kind for o in results.outputs if o.kind not in _FIGURES and not o.usual]
    for kind in dict.fromkeys((*_FIGURES, *requested_kinds)):  # those that were asked for follow
        outputs = [(k, output) for k, output in enumerate(results.outputs) if output.kind == kind]
        of_rooms = [(k, output) for k, output in outputs if notes.in_room(output.name)]
        for title, part in _apart(kind, outputs, of_rooms, notes.other_zones):
            curves = [
                (output.name.rpartition(".")[0], results.records[:, k], output.mean) for k, output in part
            ]
            if not curves or (kind in _KINDS_OF_LOADS and not any(values.any() for _, values, _ in curves)):
                continue
            left_out = len(curves) - _CURVES
            shown = curves[:_CURVES]
            if kind == "air_temperature" and notes.outdoors is not None:
                shown = [*shown, ("outdoors", notes.outdoors, False)]
            figures.append(_figure(title, KINDS[kind].unit, shown, results.index, max(left_out, 0)))
    return figures


def _apart(
    kind: str, outputs: list[_Numbered], of_rooms: list[_Numbered], other_zones: str
) -> list[tuple[str, list[_Numbered]]]:
    """Air temperatures of rooms apart from those of other zones; all else together."""
    title = KINDS[kind].label
    if kind not in _OF_ZONES or len(of_rooms) in (0, len(outputs)):
        return [(title, outputs)]
    beside = [entry for entry in outputs if entry not in of_rooms]
    return [(title, of_rooms), (f"{title} of {other_zones}", beside)]


def _figure(
    title: str, unit: str, curves: Sequence[tuple[str, Array, bool]], index: pd.DatetimeIndex, left_out: int
) -> dict[str, Any]:
    hours = np.asarray((index - index[0]).total_seconds(), dtype=np.float64) / 3600.0
    each = max(1, -(-(len(hours) - 1) // _POINTS))
    thinned_curves = [(name, *_thinned(hours, values, each, mean=mean)) for name, values, mean in curves]
    around = 0.0 if unit in ("W", "-") else None
    y = Axis.over(
        *[values for _, _, values, _, _ in thinned_curves], *_ends(thinned_curves, each), around=around
    )
    sign = units.shown(unit)
    x = time_axis(index[0].to_pydatetime(), float(hours[-1]))
    # Room for the unit above the highest mark and for the last date, in the large letters of a telephone too.
    chart = Chart(x, y, width=720.0, height=246.0, y_label=sign, margin_top=36.0, margin_right=30.0)
    legend = []
    for number, (name, times, values, low, high) in enumerate(thinned_curves):
        look = "outdoors" if name == "outdoors" else f"s{number}"
        if each > 1:
            chart.band(times, low, high, f"band-{look}")
        chart.curve(times, values, look)
        legend.append((name, look))
    said = "; ".join(
        f"{name} {text.fixed(float(np.min(low)), 1)} to {text.fixed(float(np.max(high)), 1)} {sign}".strip()
        for name, _, _, low, high in thinned_curves
    )
    caption = (
        f"Means of {_duration(float(hours[1] - hours[0]) * each)}, with their range." if each > 1 else ""
    )
    if left_out:
        caption = f"{caption} {left_out} more are in the table of all outputs.".strip()
    return {
        "title": title,
        "drawing": chart.markup(f"{title}, {short_day(index[0])} to {short_day(index[-1])}. {said}"),
        "keys": legend,
        "caption": caption,
    }


def _duration(hours: float) -> str:
    """A length of time: in minutes below an hour."""
    return f"{text.significant(hours)} h" if hours >= 1.0 else f"{text.significant(60.0 * hours)} min"


def _ends(thinned_curves: Sequence[tuple[str, Array, Array, Array, Array]], each: int) -> list[Array]:
    return [end for curve in thinned_curves for end in curve[3:]] if each > 1 else []


def _thinned(hours: Array, values: Array, each: int, *, mean: bool) -> tuple[Array, Array, Array, Array]:
    """Times, means, lowest and highest values of so many steps each."""
    if mean:  # the first record of a mean stands before the first step
        values = np.concatenate([values[1:2], values[1:]])
    if each == 1:
        return hours, values, values, values
    count = (len(values) - 1) // each
    parts = values[1 : 1 + count * each].reshape(count, each)
    times = hours[1 : 1 + count * each].reshape(count, each)
    return times.mean(axis=1), parts.mean(axis=1), parts.min(axis=1), parts.max(axis=1)


# ------------------------------------------------------------------ tables


def flow_words(flow: str) -> str:
    """A heat flow of the energy balance in words.

    Examples
    --------
    >>> flow_words("bridges")
    'Thermal bridges'
    """
    return _FLOWS[flow]


def _loads(results: Results) -> list[dict[str, str]]:
    rows = []
    for k, output in enumerate(results.outputs):
        if output.kind not in _KINDS_OF_LOADS:
            continue
        watts = results.records[1:, k]
        top = int(np.argmax(watts))
        on = bool(watts[top] > 0.0)
        when = results.index[1 + top]
        rows.append(
            {
                "zone": output.name.rpartition(".")[0],
                "kind": output.kind.removesuffix("_load"),
                "heat": text.significant(results.heat(output.name) / 3.6e6, 4),
                "peak": text.significant(float(watts[top]), 4),
                "when": f"{text.day(when)} {when:%H:%M}" if on else text.NONE,
            }
        )
    return rows


def _energy(results: Results) -> dict[str, Any]:
    into = {flow_words(flow): value / 1e6 for flow, value in results.energy.into.items() if value}
    heats = [*into.items(), ("Stored in walls and air", results.energy.stored / 1e6)]
    rows = [(label, text.significant(heat / 3.6, 4)) for label, heat in heats]
    ledger = LedgerEntry(terms=[LedgerTerm(label=label, value=heat) for label, heat in heats])
    return {
        "drawing": ledger_bars(ledger),
        "narrow": ledger_bars(ledger, narrow=True),
        "rows": rows,
        "closure": text.significant(results.energy.relative_residual, 2),
        "closes": results.energy.closes,
    }


def _outputs(results: Results) -> list[tuple[str, str, str, str, str]]:
    rows = []
    for k, output in enumerate(results.outputs):
        values = results.records[1:, k] if output.mean else results.records[:, k]
        low, mean, high = text.alike([float(values.min()), float(values.mean()), float(values.max())], 4)
        rows.append((output.name, units.shown(output.unit), low, mean, high))
    return rows


def how_it_was_run(results: Results, notes: Notes) -> list[tuple[str, str]]:
    """Files, options, weather, period and scheme of a run, by name.

    Parameters
    ----------
    results : Results
        The run.
    notes : Notes
        Has files and options.
    """
    provenance = results.provenance
    rows = [*notes.inputs, ("Mascarin", provenance.version), ("Building, SHA-256", provenance.building_hash)]
    rows += [_row("Weather", key, value) for key, value in provenance.climate.items() if value]
    rows += [
        _row("Measurements", key, value) for key, value in (provenance.measurements or {}).items() if value
    ]
    rows += [
        ("Period", f"{results.index[0]:%Y-%m-%d %H:%M} to {results.index[-1]:%Y-%m-%d %H:%M}"),
        ("Time zone", str(results.index.tz)),
        ("Step", text.with_unit(provenance.step_seconds, "s", 6)),
        *([] if provenance.steps is None else [("Steps", words_of(provenance.steps))]),
        ("Scheme", provenance.scheme),
        ("Start", provenance.start),
        *((path, text.significant(value, 6)) for path, value in provenance.changed.items()),
        ("Newton iterations", text.significant(provenance.newton_iterations, 9)),
        ("Halved steps", str(provenance.halved_steps)),
    ]
    return rows


def _row(of: str, key: str, value: Any) -> tuple[str, str]:
    """Name and words of what is known of a file."""
    if key == "step_seconds":
        return f"{of}, step", text.with_unit(float(value), "s", 6)
    return f"{of}, {key.replace('_', ' ').replace('sha256', 'SHA-256')}", _words(value)


def _words(value: Any) -> str:
    if isinstance(value, Mapping):
        return "; ".join(f"{key}: {_words(part)}" for key, part in value.items() if part != "")
    if isinstance(value, list | tuple):
        parts = [_words(part) for part in value]
        return (" " if all(part.endswith(".") for part in parts) else ", ").join(parts)
    return str(value)
