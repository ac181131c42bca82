"""Which parameters have a slider, and which outputs a curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io import units
from mascarin.building.base.wildcards import is_pattern, matching
from mascarin.building.outputs.kinds import KINDS
from mascarin.building.rooms import lived_in
from mascarin.errors import InputError, SolverError
from mascarin.figures import text

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.simulation.preparation.objectives import Array
    from mascarin.simulation.simulation import Simulation

#: Sliders without a choice, and the most that a page has.
DEFAULT_SLIDERS: Final = 6
MAX_SLIDERS: Final = 40
#: Rooms whose operative temperature is drawn without a choice.
MAX_ZONES: Final = 6


def labels(building: Building, names: Sequence[str]) -> dict[str, dict[str, str]]:
    """Names of curves for readers, and the quantity that those of one unit have in common.

    Parameters
    ----------
    building : Building
        The building.
    names : sequence of str
        Outputs.

    Returns
    -------
    dict of str to dict
        By output ``label``, ``quantity`` (of the axis, empty where curves of its unit have several) and
        ``unit``.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> labels(box(), ["room.operative_temperature"])["room.operative_temperature"]["label"]
    'room'
    """
    outputs = {name: building.output(name) for name in names}
    kinds: dict[str, set[str]] = {}
    for output in outputs.values():
        kinds.setdefault(output.unit, set()).add(output.kind)
    readable = {}
    for name, output in outputs.items():
        alone = len(kinds[output.unit]) == 1
        words = text.plain_path(name.rpartition(".")[0] or name) if alone else text.plain_path(name)
        quantity = KINDS[output.kind].label if alone else "Temperature" if output.unit == "degC" else ""
        readable[name] = {"label": words, "quantity": quantity, "unit": units.shown(output.unit)}
    repeated = {entry["label"] for entry in readable.values() if _count(readable, entry) > 1}
    for name, entry in readable.items():
        if entry["label"] in repeated:
            entry["label"] = text.plain_path(name)
    return readable


def _count(readable: Mapping[str, Mapping[str, str]], entry: Mapping[str, str]) -> int:
    """How many curves of a unit have the label of one."""
    return sum(e["label"] == entry["label"] and e["unit"] == entry["unit"] for e in readable.values())


def named(building: Building, patterns: Sequence[str]) -> list[Parameter]:
    """Parameters by path, where ``*`` stands for any name or part of one.

    Parameters
    ----------
    building : Building
        The building.
    patterns : sequence of str
        Paths.

    Returns
    -------
    list of Parameter
        Those that can vary, each once.

    Raises
    ------
    InputError
        Nothing matches, what matches cannot vary within a compiled run, or there are too many.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [one.path for one in named(box(), ["surfaces.*.outside.absorptance"])][0]
    'surfaces.facade.outside.absorptance'
    """
    by_path = {parameter.path: parameter for parameter in building.parameters()}
    chosen: dict[str, Parameter] = {}
    for pattern in patterns:
        paths = _paths(building, pattern, by_path)
        fixed = [by_path[path] for path in paths if by_path[path].structural]
        if len(fixed) == len(paths):
            raise InputError(
                f"--parameters: {pattern}: found a structural number ({fixed[0].reason}), which cannot "
                "follow a slider; expected one that varies within a compiled run. Give it with --set"
            )
        chosen |= {path: by_path[path] for path in paths if not by_path[path].structural}
    if len(chosen) > MAX_SLIDERS:
        raise InputError(
            f"--parameters: found {len(chosen)} parameters; expected {MAX_SLIDERS} sliders at most. Narrow "
            "the pattern"
        )
    return list(chosen.values())


def _paths(building: Building, pattern: str, by_path: Mapping[str, Parameter]) -> list[str]:
    """What a pattern matches; what is tied has one slider, that of the tie."""
    if pattern in by_path or not is_pattern(pattern):  # the path of a tie has a star, too
        return [building.parameter(pattern).path]
    paths = list(matching(pattern, by_path))
    tied = {member for path in paths for member in by_path[path].members}
    return [path for path in paths if path not in tied]


def strongest(building: Building, simulation: Simulation, most: int = DEFAULT_SLIDERS) -> list[Parameter]:
    """Parameters whose ranges change the recorded temperatures most, by one run with derivatives.

    Parameters
    ----------
    building : Building
        The building as it is described.
    simulation : Simulation
        A compiled run that records temperatures.
    most : int
        How many.

    Returns
    -------
    list of Parameter
        The one with the largest effect first: derivative of the mean of all recorded temperatures times the
        width of the range. Where there are no derivatives, those with the widest ranges.
    """
    everything = building.parameters()
    without = {member for parameter in everything for member in parameter.members}
    # The sky of the run may be that of the weather: a slider for its parameters could not be saved.
    without |= {parameter.path for parameter in everything} - {
        parameter.path for parameter in simulation.building.parameters()
    }
    varying = {
        parameter.path: parameter
        for parameter in everything
        if parameter.varies and not parameter.structural and parameter.path not in without
    }
    try:
        slopes = simulation.gradient(_mean_of_all).slopes
        width = {
            path: abs(slopes.get(path, 0.0)) * (parameter.high - parameter.low)
            for path, parameter in varying.items()
        }
    except SolverError:
        width = {path: _relative_width(parameter) for path, parameter in varying.items()}
    order = sorted(varying, key=lambda path: -width[path])
    return [varying[path] for path in order[:most] if np.isfinite(width[path])]


def _mean_of_all(series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
    count = sum(len(values) for values in series.values())
    total = sum(float(values.sum()) for values in series.values())
    return total / count, {name: np.full(len(values), 1.0 / count) for name, values in series.items()}


def _relative_width(parameter: Parameter) -> float:
    return (parameter.high - parameter.low) / (abs(parameter.high) + abs(parameter.low))


def curves(building: Building) -> list[str]:
    """Outputs that are drawn without a choice: operative temperatures, then ideal loads, of the first rooms.

    Attics, cavities and other zones in which nobody lives are drawn when they are asked for.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> curves(box())
    ['room.operative_temperature']
    """
    outputs = building.outputs()
    inhabited = lived_in(building)[:MAX_ZONES]
    chosen = [
        output.name
        for kinds in (("operative_temperature",), ("heating_load", "cooling_load"))
        for output in outputs
        if output.kind in kinds and output.name.rpartition(".")[0] in inhabited
    ]
    return chosen or [output.name for output in outputs if output.kind == "face_temperature"][: 2 * MAX_ZONES]


def slider(parameter: Parameter) -> dict[str, Any]:
    """What a page says of a parameter, and the ends of its slider.

    Parameters
    ----------
    parameter : Parameter
        The parameter.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> slider(box().parameter("surfaces.facade.outside.absorptance"))["unit"]
    ''
    """
    low, high = (parameter.low, parameter.high) if parameter.low < parameter.high else _range_of(parameter)
    return {
        "path": parameter.path,
        "value": parameter.value,
        "low": min(low, parameter.value),
        "high": max(high, parameter.value),
        "unit": units.shown(parameter.unit),
        "description": parameter.description,
        "limits": f"{text.significant(parameter.lower)} to {text.significant(parameter.upper)}",
        "note": parameter.reason or "",
    }


def _range_of(parameter: Parameter) -> tuple[float, float]:
    """A range for a parameter that has none: half to twice its value, within its limits."""
    ends = sorted((0.5 * parameter.value, 2.0 * parameter.value)) if parameter.value else [0.0, 1.0]
    return max(ends[0], parameter.lower), min(ends[1], parameter.upper)
