"""Heating and cooling in the rows of a calorimeter file: segments, holds, supercooling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.materials.units import DscColumn

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Rows over which a temperature must move.
_WINDOW: Final = 8
#: Part of the usual step below which a temperature is held.
_STILL: Final = 0.2
#: Part of the range of temperatures within which a hold is one at its end.
_NEAR_END: Final = 0.02
#: Rise of the temperature while it cools that is more than noise. [K]
_RISE: Final = 0.1


def segments_of(
    temperature: Array,
    labels: Sequence[str],
    signal: DscColumn,
    labels_to_take: Sequence[str],
    location: str,
) -> tuple[list[tuple[int, int, str]], int]:
    """First and last row of each run, and its direction; holds are left out.

    Parameters
    ----------
    temperature : ndarray, shape (N,)
        In the order of the file [degC].
    labels : sequence of str
        Label of the segment of each row; empty where there is none.
    signal : DscColumn
        Its name can contain the direction.
    labels_to_take : sequence of str
        Labels to use; empty: all.
    location : str
        File and line, for errors.

    Returns
    -------
    segments : list of (int, int, str)
        Runs.
    held : int
        Rows at a constant temperature, which are in none.

    Raises
    ------
    InputError
        A label is not known, or temperatures are in no order.
    """
    if signal.direction is not None:
        return [(0, len(temperature), signal.direction)], 0
    if any(labels):
        return _labelled(temperature, labels, labels_to_take, location)
    if labels_to_take:
        raise InputError(
            f"{location}: segment: found {', '.join(labels_to_take)}, but the file has no column of "
            "segments; expected none. Leave the option out"
        )
    first, last = _without_holds(temperature)
    held = len(temperature) - (last - first)
    inner = temperature[first:last]
    turn = _turning_point(inner, location)
    if turn in (0, len(inner) - 1):
        direction = "heating" if inner[-1] > inner[0] else "cooling"
        return [(first, last, direction)], held
    direction = "heating" if inner[turn] > inner[0] else "cooling"
    other = "cooling" if direction == "heating" else "heating"
    before, after = _hold_around(inner, turn)
    held += after - before
    return [(first, first + before + 1, direction), (first + after, last, other)], held


def _moves(temperature: Array) -> npt.NDArray[np.bool_]:
    """Whether the temperature moves over the rows around each row."""
    reach = min(_WINDOW, len(temperature) - 1)
    steps = np.abs(temperature[reach:] - temperature[:-reach])
    usual = float(np.quantile(steps, 0.75))
    moving = steps > _STILL * usual
    return np.asarray(np.concatenate([moving, np.full(reach, moving[-1])]))


def _without_holds(temperature: Array) -> tuple[int, int]:
    """First row and row past the end of what lies between holds at both ends of the file."""
    reach = _NEAR_END * float(np.ptp(temperature))
    first = int(np.argmax(_moves(temperature)))
    last = len(temperature) - int(np.argmax(_moves(temperature[::-1])))
    # A hold is one near the first or the last temperature: a sample that melts slowly is none.
    if np.ptp(temperature[: first + 1]) > reach or first < _WINDOW:
        first = 0
    if np.ptp(temperature[last - 1 :]) > reach or len(temperature) - last < _WINDOW:
        last = len(temperature)
    # The last rows of a hold are those at its temperatures.
    if first:
        hold = temperature[:first]
        while first < last and hold.min() <= temperature[first] <= hold.max():
            first += 1
    if last < len(temperature):
        hold = temperature[last:]
        while last > first and hold.min() <= temperature[last - 1] <= hold.max():
            last -= 1
    return first, last


def _hold_around(temperature: Array, turn: int) -> tuple[int, int]:
    """Rows before and after a hold at the turning point; both are that point where there is none."""
    reach = 0.5 * _NEAR_END * float(np.ptp(temperature))
    still = np.abs(temperature - temperature[turn]) < reach
    before, after = turn, turn
    while before > 0 and still[before - 1]:
        before -= 1
    while after < len(temperature) - 1 and still[after + 1]:
        after += 1
    inside = temperature[before : after + 1]
    moving = _moves(temperature)[before : after + 1]
    if len(inside) < 4 * _WINDOW or moving.mean() > 0.5:
        return turn, turn
    held = np.flatnonzero(~moving) + before
    return int(held[0]), min(int(held[-1]) + _WINDOW, len(temperature) - 1)


def _labelled(
    temperature: Array, labels: Sequence[str], labels_to_take: Sequence[str], location: str
) -> tuple[list[tuple[int, int, str]], int]:
    blocks: list[tuple[int, int]] = []
    first = 0
    for k in range(1, len(labels) + 1):
        if k == len(labels) or labels[k] != labels[first]:
            blocks.append((first, k))
            first = k
    folded = list(dict.fromkeys(labels[first] for first, _ in blocks))
    for label in labels_to_take:
        if label.casefold() not in folded:
            raise InputError(f"{location}: segment: found '{label}'; expected one of {', '.join(folded)}")
    chosen = [label.casefold() for label in labels_to_take]
    span = float(np.ptp(temperature))
    segments, held = [], 0
    for start, end in blocks:
        label = labels[start]
        if chosen and label not in chosen:
            continue
        direction = next((word for word in ("heating", "cooling") if label.startswith(word[:4])), None)
        if direction is None and not label.replace(".", "").lstrip("s").isdigit():
            raise InputError(
                f"{location}: found the direction '{label}'; expected heating or cooling, or the number of a "
                "segment"
            )
        change = float(temperature[end - 1] - temperature[start])
        if direction is None and abs(change) < _NEAR_END * span:
            held += end - start
            continue
        segments.append((start, end, direction or ("heating" if change > 0.0 else "cooling")))
    if not segments:
        raise InputError(
            f"{location}: found only segments at a constant temperature; expected heating or cooling"
        )
    return segments, held


def _turning_point(temperature: Array, location: str) -> int:
    """Row at which heating changes to cooling or cooling to heating; the first or last if it does not."""
    total = abs(temperature[-1] - temperature[0])
    top, bottom = int(np.argmax(temperature)), int(np.argmin(temperature))
    turn = top if temperature[top] - max(temperature[0], temperature[-1]) > 0.02 * np.ptp(temperature) else 0
    if min(temperature[0], temperature[-1]) - temperature[bottom] > 0.02 * np.ptp(temperature):
        turn = bottom
    way = np.abs(np.diff(temperature)).sum()
    expected = (
        total
        if turn == 0
        else abs(temperature[turn] - temperature[0]) + abs(temperature[-1] - temperature[turn])
    )
    # A supercooled sample warms itself once while it cools.
    falling = temperature[: turn + 1] if turn == bottom else temperature[turn:]
    warmed = float(np.max(falling - np.minimum.accumulate(falling)))
    if way - 2.0 * warmed > 1.2 * expected:
        jump = int(np.argmax(np.abs(np.diff(temperature))))
        raise InputError(
            f"{location}: row {jump + 3}: found {temperature[jump + 1]:.2f} degC after "
            f"{temperature[jump]:.2f} degC; expected temperatures in the order of the run: rising, "
            "falling, or one after the other. Restore the order, or put heating and cooling into "
            "different columns"
        )
    return turn


def recalescence(temperature: Array, direction: str) -> tuple[float, float] | None:
    """Where freezing begins in a cooling run whose temperature rises, and by how much it rises.

    Parameters
    ----------
    temperature : ndarray, shape (N,)
        Of one run, in the order of the file [degC].
    direction : str
        ``heating`` or ``cooling``.

    Returns
    -------
    (float, float) or None
        Temperature of nucleation [degC] and rise [K]; None where it does not rise.

    Examples
    --------
    >>> recalescence(np.array([25.0, 22.0, 20.0, 22.5, 22.0, 15.0]), "cooling")
    (20.0, 2.5)
    """
    if direction != "cooling" or temperature[-1] > temperature[0]:
        return None
    lowest = np.minimum.accumulate(temperature)
    rise = temperature - lowest
    top = int(np.argmax(rise))
    return (float(lowest[top]), float(rise[top])) if rise[top] > _RISE else None


def supercooling(temperature: Array, direction: str) -> list[str]:
    """What is to be said of a temperature that rises while the oven cools: the sample was supercooled.

    Parameters
    ----------
    temperature : ndarray, shape (N,)
        Of one run, in the order of the file [degC].
    direction : str
        ``heating`` or ``cooling``.

    Examples
    --------
    >>> supercooling(np.array([25.0, 22.0, 20.0, 22.5, 22.0, 15.0]), "cooling")
    ['cooling: the temperature rises by 2.5 K from 20.00 degC on: the sample was ...
    """
    freezing = recalescence(temperature, direction)
    if freezing is None:
        return []
    return [
        f"cooling: the temperature rises by {freezing[1]:.1f} K from {freezing[0]:.2f} degC on: the "
        "sample was supercooled, and the curve over temperature does not show how it freezes; use the "
        "heating run, and --supercooling (in Python supercooling=True) for the law of its freezing"
    ]
