"""Sliders of a page in which the model runs: which parameters can have one, and between which limits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.parameters.text_laws import text_laws
from mascarin.errors import InputError
from mascarin.figures import text
from mascarin.pages.explore import choice
from mascarin.simulation.preparation.limits import set_point_pairs
from mascarin.simulation.preparation.weather_inputs import is_of_weather

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.simulation.simulation import Simulation


def chosen(building: Building, simulation: Simulation, patterns: Sequence[str]) -> list[Parameter]:
    """Parameters with a slider.

    Parameters
    ----------
    building : Building
        The building.
    simulation : Simulation
        A run of it that records temperatures.
    patterns : sequence of str
        Paths, with ``*``. None: what a study has calibrated in this building, else the parameters whose
        ranges change the temperatures most.

    Returns
    -------
    list of Parameter
        Each once.

    Raises
    ------
    InputError
        A path that fits nothing, or a parameter that a page cannot change.
    """
    if patterns:
        parameters = choice.named(building, patterns)
        for parameter in parameters:
            reason = _refusal(building, parameter)
            if reason is not None:
                raise InputError(f"--parameter: {parameter.path}: {reason}")
        return parameters
    if building.posterior is not None:
        able, _ = calibrated(building)
        if able:
            return able
    ordered = choice.strongest(building, simulation, choice.MAX_SLIDERS)
    able = [parameter for parameter in ordered if _refusal(building, parameter) is None]
    return able[: choice.DEFAULT_SLIDERS]


def calibrated(building: Building) -> tuple[list[Parameter], dict[str, str]]:
    """What a study has calibrated: the parameters with a slider, and why the others have none.

    Parameters
    ----------
    building : Building
        Perhaps with the posterior of a study.
    """
    able: list[Parameter] = []
    without: dict[str, str] = {}
    for path in () if building.posterior is None else building.posterior.intervals:
        parameter = building.parameter(path)
        reason = _refusal(building, parameter)
        if parameter.structural:
            reason = f"found a structural number ({parameter.reason}), which cannot follow a slider"
        elif reason is None and len(able) == choice.MAX_SLIDERS:
            reason = f"a page has {choice.MAX_SLIDERS} sliders at most"
        if reason is None:
            able.append(parameter)
        else:
            without[path] = reason
    return able, without


def _refusal(building: Building, parameter: Parameter) -> str | None:
    """Why a page cannot change a parameter; None: it can."""
    paths = parameter.members or (parameter.path,)
    if any(is_of_weather(path) for path in paths):
        return (
            "found a gain, offset or clock of the weather, which the page has as it is; expected a parameter "
            "of the building. Give it with --set, or move it with 'mascarin explore'"
        )
    if any(path in _of_humidity_courses(building) for path in paths):
        return (
            "found a set point of humidity beside one from a schedule or a column, which Python alone "
            "compares at all times; expected another parameter. Give it with --set, or use 'mascarin explore'"
        )
    if any(low > high for low, high in (_law_range(building, path) for path in paths)):
        return (
            "found a number of a law written as text without a range, within which the law was checked; give "
            "it one in the building: {value: ..., range: [..., ...]}"
        )
    return None


def _of_humidity_courses(building: Building) -> set[str]:
    """Set points of humidity whose counterpart is no number."""
    pairs = [pair.points for pair in set_point_pairs(building) if pair.where.startswith("humidity.")]
    return {path for points in pairs for path, course in points if course is None}


def _laws(building: Building) -> Iterator[tuple[str, Any]]:
    yield from text_laws(building)
    yield from ((side.path, side.law) for side in formula_sides(building))


def _law_range(building: Building, path: str) -> tuple[float, float]:
    """Values within which a number of a law was checked; empty (low above high) where it has no range.

    All values for any other parameter.
    """
    for law_path, law in _laws(building):
        name = path.removeprefix(f"{law_path}.")
        if name != path and name in law.numbers:
            ends = law.numbers[name].range
            return (1.0, 0.0) if ends is None else (float(ends[0]), float(ends[1]))
    return -math.inf, math.inf


def plain(simulation: Simulation, parameter: Parameter) -> dict[str, Any]:
    """What the script of a page knows of a slider.

    Parameters
    ----------
    simulation : Simulation
        The run.
    parameter : Parameter
        The parameter.

    Returns
    -------
    dict
        That of `choice.slider`, with limits as numbers and in words, the interval of a calibration, and
        positions and weights in the parameter vector.
    """
    building = simulation.building
    entry = choice.slider(parameter)
    lower, upper, allowed = parameter.lower, parameter.upper, parameter.allowed
    for path in parameter.members or (parameter.path,):
        low, high = _law_range(building, path)
        if math.isfinite(low):
            lower, upper = max(lower, low), min(upper, high)
            allowed = f"a value from {lower:g} to {upper:g}, within which the law was checked"
        if path.startswith("controls.") and path.endswith("_time"):
            longest = (simulation.times.last - simulation.times.first) / 60.0
            upper = min(upper, longest)
            allowed = f"a value from {lower:g} to {upper:g}, within the run"
    entry |= {
        "low": max(entry["low"], lower),
        "high": min(entry["high"], upper),
        "limits": [bound if math.isfinite(bound) else None for bound in (lower, upper)],
        "allowed": allowed,
        "positions": [[position, weight] for position, weight in simulation.spread_of(parameter.path)],
    }
    posterior = building.posterior
    if posterior is not None and parameter.path in posterior.intervals:
        estimate, low, high = posterior.intervals[parameter.path]
        if not posterior.stated:
            # The study does not state intervals where its model contradicts its own data.
            return entry | {"estimate": f"Estimate {text.significant(estimate, 3)} {entry['unit']}".rstrip()}
        entry["low"], entry["high"] = min(entry["low"], low), max(entry["high"], high)
        confidence = text.significant(100.0 * posterior.confidence)
        ends = " to ".join(text.alike([low, high], 3))
        entry["interval"] = [low, high]
        entry["estimate"] = (
            f"Estimate {text.significant(estimate, 3)}, {confidence} % interval {ends} {entry['unit']}"
        ).rstrip()
    return entry
