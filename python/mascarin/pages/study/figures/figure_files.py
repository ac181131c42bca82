"""Figures of a comparison as files: all sensors together and each by itself, for each short period."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin._io.units import bracketed, difference, shown
from mascarin.figures import colors, text
from mascarin.figures.comparison import Compared, errors, errors_together, series, together
from mascarin.figures.files import save, save_both
from mascarin.pages.study.data.labels import label_of, model_label, period_label, short_periods, unit_of
from mascarin.pages.study.data.series import Series, moment
from mascarin.pages.study.figures.comparison_data import by_unit, compared_sensors, model_looks, sensor_looks
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH: Final = 9.0  # inches
_MAX_SAMPLES: Final = 1_000_000
"""More points than a record has: none is left out of a file."""


Once = Callable[[str, Callable[[], Sequence[Path]]], list[Path]]
"""Calls a function that writes files, or names the files that it wrote before under this name."""


def write_figures(
    folder: Path,
    study: StudyDocument,
    curves: Series,
    once: Once = lambda _, write: list(write()),
) -> list[Path]:
    """Write the figures of a study that compare models with measurements.

    Parameters
    ----------
    folder : Path
        Where to. ``PERIOD-all`` has all sensors, ``PERIOD-SENSOR`` one with the prediction interval, both as
        SVG and PDF, for periods of at most 16 days; ``SENSOR.svg`` has the whole record.
    study : StudyDocument
        The results.
    curves : Series
        Curves.
    once : callable, optional
        Leaves out figures that were written before a study was interrupted.

    Returns
    -------
    list of Path
        The files.
    """
    written: list[Path] = []
    for period in short_periods(study):
        start, end = study.periods[period].spans[0]
        times, sensors = compared_sensors(study, curves, curves.slice_of(start, end), _MAX_SAMPLES)
        if not sensors:
            continue
        title = f"{period_label(study, period)}, {text.span_of(moment(start), moment(end))}"
        all_sensors = partial(_all, study, times, sensors, title)
        written += once(f"{period}-all", partial(_save, all_sensors, folder / f"{period}-all"))
        for sensor, compared in sensors.items():
            single = partial(_single, study, times, sensor, compared, f"{compared.label}: {title}")
            written += once(f"{period}-{sensor}", partial(_save, single, folder / f"{period}-{sensor}"))
    times, sensors = compared_sensors(study, curves, slice(0, len(curves)), _MAX_SAMPLES)
    for sensor, compared in sensors.items():
        title = f"{compared.label}: whole record"
        single = partial(_single, study, times, sensor, compared, title, shaded=True)
        path = folder / f"{sensor}.svg"
        written += once(sensor, partial(_save, single, path))
    return written


def _save(draw: Callable[[], Figure], path: Path) -> list[Path]:
    """Draw a figure and save it: as SVG where the path says so, else as SVG and PDF."""
    return [save(draw(), path)] if path.suffix == ".svg" else list(save_both(draw(), path))


def _all(study: StudyDocument, times: list[datetime], sensors: Mapping[str, Compared], title: str) -> Figure:
    """Values and errors of all sensors, on axes for each unit."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    looks, groups = sensor_looks(study), by_unit(study, sensors)
    figure = Figure(figsize=(_WIDTH, 5.2 * len(groups) + 0.6), layout="constrained")
    axes = figure.subplots(2 * len(groups), 1, sharex=True, height_ratios=(2, 1) * len(groups))
    for row, (unit, names) in enumerate(groups.items()):
        upper, lower = axes[2 * row], axes[2 * row + 1]
        compared_looks = [(sensors[name], looks[name]) for name in names]
        together(upper, times, compared_looks)
        errors_together(lower, times, compared_looks)
        upper.set_ylabel(bracketed("", shown(unit)))
        lower.set_ylabel(bracketed("error", difference(unit)))
    axes[0].set_title(title, loc="left", fontsize=11)
    observed = study.observed.label
    main = model_label(study, next(iter(sensors.values())).main)
    handles = [
        Line2D([], [], color=looks[name].color, linestyle=looks[name].dash, label=sensors[name].label)  # type: ignore[arg-type]
        for name in sensors
    ]
    handles += [
        Line2D(
            [],
            [],
            color=colors.INK,
            marker="o",
            markerfacecolor="none",
            linestyle="",
            markersize=3.2,
            label=f"points: {observed}",
        ),
        Line2D([], [], color=colors.INK, label=f"lines: {main}"),
    ]
    figure.legend(handles=handles, loc="outside lower left", ncols=4, fontsize="small", frameon=False)
    _days(axes[-1], study)
    return figure


def _single(
    study: StudyDocument,
    times: list[datetime],
    sensor: str,
    compared: Compared,
    title: str,
    *,
    shaded: bool = False,
) -> Figure:
    """Values of one sensor with the prediction interval, and the errors below."""
    from matplotlib.figure import Figure

    unit = unit_of(study, sensor)
    named = Compared(
        label_of(study, sensor),
        compared.measured,
        {model_label(study, model): values for model, values in compared.models.items()},
        model_label(study, compared.main),
        half=compared.half,
        center=compared.center,
        uncertainty=compared.uncertainty,
    )
    figure = Figure(figsize=(_WIDTH, 5.0), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    looks, observed = model_looks(study), study.observed.label
    series(upper, times, named, looks=looks, label=observed)
    errors(lower, times, named, looks=looks)
    handles, labels = upper.get_legend_handles_labels()
    if compared.half is not None:
        handles.append(upper.collections[0])
        labels.append("95 % prediction interval")
    if shaded:
        _shade(study, (upper, lower))
    upper.set_title(title, loc="left", fontsize=11)
    upper.set_ylabel(bracketed("", shown(unit)))
    lower.set_ylabel(bracketed("error", difference(unit)))
    figure.legend(handles, labels, loc="outside lower left", ncols=5, fontsize="small", frameon=False)
    _days(lower, study)
    return figure


def _shade(study: StudyDocument, axes: tuple[Axes, ...]) -> None:
    """Tint the identification period."""
    identification = study.periods.get("identification")
    for start, end in [] if identification is None else identification.spans:
        for ax in axes:
            ax.axvspan(moment(start), moment(end), color=colors.REMAINDER, alpha=0.18, lw=0, zorder=0)  # type: ignore[arg-type]


def _days(ax: Axes, study: StudyDocument) -> None:
    from matplotlib import dates

    locator = dates.AutoDateLocator()  # type: ignore[no-untyped-call]
    ax.xaxis.set_major_locator(locator)
    ax.xaxis.set_major_formatter(dates.ConciseDateFormatter(locator))  # type: ignore[no-untyped-call]
    zone = study.timezone
    ax.set_xlabel(f"local time ({zone})" if zone else "local time")
