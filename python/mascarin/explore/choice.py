"""Which parameters have a slider, and which outputs a curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.wildcards import is_pattern, matching
from mascarin.errors import InputError, SolverError

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters import Parameter
    from mascarin.simulation.objectives import Array
    from mascarin.simulation.simulation import Simulation

#: Sliders without a choice, and the most that a page has.
USUAL: Final = 6
MOST: Final = 40
#: Zones whose operative temperature is drawn without a choice.
ZONES: Final = 6


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
    known = {one.path: one for one in building.parameters()}
    found: dict[str, Parameter] = {}
    for pattern in patterns:
        paths = _paths(building, pattern, known)
        fixed = [known[path] for path in paths if known[path].structural]
        if len(fixed) == len(paths):
            raise InputError(
                f"--parameters: {pattern}: found a structural number ({fixed[0].reason}), which cannot "
                "follow a slider; expected one that varies within a compiled run. Give it with --set"
            )
        found |= {path: known[path] for path in paths if not known[path].structural}
    if len(found) > MOST:
        raise InputError(
            f"--parameters: found {len(found)} parameters; expected {MOST} sliders at most. Narrow the "
            "pattern"
        )
    return list(found.values())


def _paths(building: Building, pattern: str, known: Mapping[str, Parameter]) -> list[str]:
    """What a pattern matches; what is tied has one slider, that of the tie."""
    if pattern in known or not is_pattern(pattern):  # the path of a tie has a star, too
        return [building.parameter(pattern).path]
    paths = list(matching(pattern, known))
    tied = {member for path in paths for member in known[path].members}
    return [path for path in paths if path not in tied]


def strongest(building: Building, simulation: Simulation, most: int = USUAL) -> list[Parameter]:
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
    without = {member for one in everything for member in one.members}
    # The sky of the run may be that of the weather: a slider for its parameters could not be saved.
    without |= {one.path for one in everything} - {one.path for one in simulation.building.parameters()}
    varying = {
        one.path: one for one in everything if one.varies and not one.structural and one.path not in without
    }
    try:
        slopes = simulation.gradient(_mean_of_all).slopes
        width = {path: abs(slopes.get(path, 0.0)) * (one.high - one.low) for path, one in varying.items()}
    except SolverError:
        width = {path: _relative_width(one) for path, one in varying.items()}
    order = sorted(varying, key=lambda path: -width[path])
    return [varying[path] for path in order[:most] if np.isfinite(width[path])]


def _mean_of_all(series: Mapping[str, Array]) -> tuple[float, Mapping[str, Array]]:
    count = sum(len(values) for values in series.values())
    total = sum(float(values.sum()) for values in series.values())
    return total / count, {name: np.full(len(values), 1.0 / count) for name, values in series.items()}


def _relative_width(one: Parameter) -> float:
    return (one.high - one.low) / (abs(one.high) + abs(one.low))


def curves(building: Building) -> list[str]:
    """Outputs that are drawn without a choice: operative temperatures, then ideal loads, of the first zones.

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
    found = building.outputs()
    operative = [one.name for one in found if one.kind == "operative_temperature"][:ZONES]
    loads = [one.name for one in found if one.kind in ("heating_load", "cooling_load")]
    kept = {name.rpartition(".")[0] for name in operative}
    chosen = operative + [name for name in loads if name.rpartition(".")[0] in kept]
    return chosen or [one.name for one in found if one.kind == "face_temperature"][: 2 * ZONES]
