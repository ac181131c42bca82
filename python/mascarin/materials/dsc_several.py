"""Several calorimeter files of one material: mean of the slowest runs, spread, heating rates."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.materials.dsc import DscMaterial, from_dsc
from mascarin.materials.dsc_melting import MeasuredMelting
from mascarin.materials.laws import LAWS, fit

_EQUAL: Final = 0.1
"""Rates that differ by less than this part of each other are the same."""
_LEVELS: Final = 400
_QUANTITIES: Final[Mapping[str, tuple[Callable[[MeasuredMelting], float], str, float]]] = {
    "latent heat": (lambda run: run.latent_heat, "kJ/kg", 1e-3),
    "onset": (lambda run: run.onset, "degC", 1.0),
    "peak": (lambda run: run.peak, "degC", 1.0),
    "end": (lambda run: run.end, "degC", 1.0),
    "half liquid at": (lambda run: run.half, "degC", 1.0),
}


@dataclass(frozen=True)
class Spread:
    """A quantity of several runs of one direction and rate.

    Attributes
    ----------
    mean, deviation : float
        Mean and standard deviation of the single run. [unit of the quantity]
    count : int
        Runs.
    """

    mean: float
    deviation: float
    count: int


def from_dsc_files(paths: Sequence[str | Path], **options: Any) -> DscMaterial:
    """Make one material from several calorimeter files.

    Heating and cooling are averaged each, over the runs with the lowest rate: a slower run is nearer to
    equilibrium. Curves are averaged at equal liquid fraction, so that a shift between runs does not make the
    mean broader than each of them.

    Parameters
    ----------
    paths : sequence of str or Path
        The files; each may have heating and cooling.
    **options
        As in `from_dsc`, for all of them.

    Returns
    -------
    DscMaterial
        Its warnings state the spread of the runs and the change with the rate.

    Raises
    ------
    InputError
        There is no file, or one cannot be used.

    Examples
    --------
    >>> from_dsc_files([])
    Traceback (most recent call last):
    mascarin.errors.InputError: files: found none; expected calorimeter files of one material
    """
    if not paths:
        raise InputError("files: found none; expected calorimeter files of one material")
    materials = [from_dsc(path, **options) for path in paths]
    if len(materials) == 1:
        return materials[0]
    runs, said = [], [f"{material.name}: {text}" for material in materials for text in material.warnings]
    for direction in ("heating", "cooling"):
        runs_of_direction = [
            run for material in materials for run in material.runs if run.direction == direction
        ]
        if runs_of_direction:
            slow = _slowest(runs_of_direction)
            runs.append(_mean(slow))
            said += [
                *_spread_lines(direction, slow, len(runs_of_direction)),
                *_rate_lines(direction, runs_of_direction),
            ]
    return DscMaterial(
        "+".join(material.name for material in materials), tuple(runs), tuple(dict.fromkeys(said))
    )


def spread_of(runs: Sequence[MeasuredMelting]) -> dict[str, Spread]:
    """Mean and standard deviation of latent heat, onset, peak, end and half.

    Parameters
    ----------
    runs : sequence of MeasuredMelting
        Of one direction and rate.

    Returns
    -------
    dict of str to Spread
        By quantity; a deviation of NaN where there is one run. [kJ/kg, degC]
    """
    spread = {}
    for name, (value, _, scale) in _QUANTITIES.items():
        values = scale * np.array([value(run) for run in runs])
        deviation = float(values.std(ddof=1)) if len(values) > 1 else float("nan")
        spread[name] = Spread(float(values.mean()), deviation, len(values))
    return spread


def _slowest(runs: Sequence[MeasuredMelting]) -> list[MeasuredMelting]:
    """Runs with the lowest rate; all where a rate is not known."""
    rates = [run.rate for run in runs]
    stated = [rate for rate in rates if rate is not None]
    if len(stated) < len(rates):
        return list(runs)
    return [run for run, rate in zip(runs, stated, strict=True) if rate <= min(stated) * (1.0 + _EQUAL)]


def _mean(runs: Sequence[MeasuredMelting]) -> MeasuredMelting:
    """The mean of runs at equal liquid fraction."""
    if len(runs) == 1:
        return runs[0]
    low, high = (
        max(run.temperature[0] for run in runs), min(run.temperature[-1] for run in runs)
    )  # fmt: skip
    levels = np.linspace(0.0, 1.0, _LEVELS + 1)[1:-1]
    inner = np.mean([np.interp(levels, run.fraction, run.temperature) for run in runs], axis=0)
    first, last = (float(np.mean([run.melting_range[k] for run in runs])) for k in (0, 1))
    temperature = np.concatenate([[min(low, first - 1.0)], [first], inner, [last], [max(high, last + 1.0)]])
    fraction = np.concatenate([[0.0], [0.0], levels, [1.0], [1.0]])
    rising = np.concatenate([[True], np.diff(np.maximum.accumulate(temperature)) > 0.0])
    even = np.linspace(temperature[0], temperature[-1], 4 * _LEVELS)
    fraction = np.interp(even, temperature[rising], fraction[rising])
    solid, liquid = (float(np.mean([run.specific_heat[k] for run in runs])) for k in (0, 1))
    latent = float(np.mean([run.latent_heat for run in runs]))
    half = float(np.interp(0.5, fraction, even))
    heat = solid + (liquid - solid) * fraction + np.gradient(fraction, even) * (
        latent + (liquid - solid) * (even - half)
    )  # fmt: skip
    onset, peak, end = (
        float(np.mean([value(run) for run in runs]))
        for value, _, _ in (_QUANTITIES[name] for name in ("onset", "peak", "end"))
    )
    fits = tuple(sorted((fit(law, even, fraction) for law in LAWS), key=lambda law_fit: law_fit.residual))
    return replace(
        runs[0], temperature=even, fraction=fraction, heat=heat, specific_heat=(solid, liquid),
        latent_heat=latent, onset=onset, peak=peak, end=end, fits=fits, course=None,
    )  # fmt: skip


def _spread_lines(direction: str, runs: Sequence[MeasuredMelting], of: int) -> list[str]:
    rate_words = "" if runs[0].rate is None else f" at {runs[0].rate:.3g} K/min"
    head = f"{direction}: mean of {len(runs)} of {of} runs{rate_words}"
    if len(runs) == 1:
        return [f"{head}: their spread is not known"]
    parts = [
        f"{name} {spread.mean:.4g} +- {spread.deviation:.2g} {_QUANTITIES[name][1]}"
        for name, spread in spread_of(runs).items()
    ]
    return [f"{head}, +- standard deviation of a run: {', '.join(parts)}"]


def _rate_lines(direction: str, runs: Sequence[MeasuredMelting]) -> list[str]:
    """How the curve moves with the rate, and where it would be in equilibrium."""
    rates = [run.rate for run in runs if run.rate is not None]
    if len(rates) < len(runs) or max(rates) < min(rates) * (1.0 + _EQUAL):
        return []
    peaks = [run.peak for run in runs]
    slope, at_rest = (float(x) for x in np.polyfit(rates, peaks, 1))
    return [
        f"{direction}: rates from {min(rates):.3g} to {max(rates):.3g} K/min: the peak moves by "
        f"{slope:+.3g} K for "
        f"each K/min, to {at_rest:.2f} degC without lag (straight line); the slowest runs are used, "
        f"which are "
        "nearest to equilibrium"
    ]
