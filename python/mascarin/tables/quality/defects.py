"""Find suspicious parts of measured series: stuck, forward-filled, spikes, missing, out of range.

Nothing is corrected here. What is usual is derived from each channel: how often it repeats a value, how far
it changes in one step, where it is constant (night, no wind, saturation). A part of a series is reported when
it is far from that, so that the steps of a coarse logger are not reported. Columns that are switched
(heaters, set points, states) hold their values rightly and are never stuck, see
`mascarin.tables.quality.switched_signals`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

import numpy as np

from mascarin._io.limits import above, below
from mascarin.tables.arrays import Array, Flags, Lines
from mascarin.tables.quality.switched_signals import is_switched, switched_levels

if TYPE_CHECKING:
    import pandas as pd

Defect = Literal["stuck", "forward_filled", "interpolated", "copied", "spike", "missing", "out_of_range"]

_LONGER: Final = 3.0
"""A run of equal values is long when it exceeds the longest usual run of the channel by this factor."""
_FEWEST: Final = 6
"""Equal values in a row that one channel must show at least."""
_FEWEST_TOGETHER: Final = 4
"""The same for several channels at once."""
_SUPPORT: Final = 3
"""Number of runs of similar length that make that length usual."""
_TURNING: Final = 6.0
"""A coarse logger at a turning point may exceed its longest usual run by this factor."""
_CERTAIN: Final = 10.0
"""Beyond this factor, neither a turning point nor a calm period explains a run."""
_ALIKE: Final = 0.8
"""Runs of two channels are one event when they share this part of the rows that either covers."""
_DAY: Final = 86400.0
_SPIKE: Final = 5.0
"""A spike exceeds the channel's 99th percentile of steps by this factor."""
_SPIKE_RANGE: Final = 0.05
"""And this part of the channel's range."""
_SPIKE_WIDTH: Final = 3
_FAR: Final = 5.0
"""Without limits: a value so many ranges (5th to 95th percentile) from the median is out of range."""


@dataclass(frozen=True)
class Stretch:
    """A suspicious part of one channel.

    Attributes
    ----------
    channel : str
        Column.
    kind : str
        `stuck` (one channel repeats a value while it should change), `forward_filled` (several channels
        repeat their values over the same rows), `interpolated` and `copied` (see
        `tables.quality.filled_values`), `spike`,
        `missing`, `out_of_range`.
    start, end : pandas.Timestamp
        First and last row. Where a value is repeated, `start` is its first repetition.
    count : int
        Number of rows.
    detail : str
        What was found, as text.
    """

    channel: str
    kind: Defect
    start: pd.Timestamp
    end: pd.Timestamp
    count: int
    detail: str


def find(
    data: pd.DataFrame,
    *,
    limits: Mapping[str, tuple[float, float]] | None = None,
) -> list[Stretch]:
    """Find the suspicious parts of every column.

    Parameters
    ----------
    data : pandas.DataFrame
        Numbers on a regular time index, NaN where missing.
    limits : mapping of str to (float, float), optional
        Lowest and highest possible value of a column. Without limits only values that are far outside
        of what the column does are reported.

    Returns
    -------
    list of Stretch
        In order of channel, then start.
    """
    if len(data) < 2:
        return []
    interval = float((data.index[1] - data.index[0]).total_seconds())
    columns = {str(name): data[name].to_numpy(dtype=np.float64) for name in data.columns}
    defects: dict[str, list[tuple[Defect, int, int, str]]] = {name: [] for name in columns}
    stuck: dict[str, list[tuple[int, int]]] = {}
    for name, values in columns.items():
        defects[name] += _missing(values)
        outside = _out_of_range(values, (limits or {}).get(name))
        defects[name] += outside
        plausible = values.copy()
        for _, first, last, _ in outside:
            plausible[first:last] = np.nan
        stuck[name] = [] if is_switched(values) else _stuck(plausible, interval, (limits or {}).get(name, ()))
        defects[name] += _spikes(_unwound(plausible), values)
    sensed = {name: values for name, values in columns.items() if not is_switched(values)}
    for name, stretches in _repeated(sensed, stuck).items():
        defects[name] += stretches
    return [
        Stretch(name, kind, data.index[first], data.index[last - 1], last - first, detail)
        for name in columns
        for kind, first, last, detail in sorted(defects[name], key=lambda item: (item[1], item[0]))
    ]


def mask(
    data: pd.DataFrame, stretches: Sequence[Stretch], kinds: Sequence[str] | None = None
) -> pd.DataFrame:
    """Mark values that belong to suspicious parts, to leave them out.

    Parameters
    ----------
    data : pandas.DataFrame
        The table in which they were found.
    stretches : sequence of Stretch
        From `find`.
    kinds : sequence of str, optional
        Kinds to take; default all.

    Returns
    -------
    pandas.DataFrame
        True where a value belongs to one of them; same shape as `data`.
    """
    import pandas as pd

    where = pd.DataFrame(False, index=data.index, columns=data.columns)
    for stretch in stretches:
        if kinds is None or stretch.kind in kinds:
            where.loc[stretch.start : stretch.end, stretch.channel] = True
    return where


def runs(flags: Flags) -> list[tuple[int, int]]:
    """First row and row past the end of every run of True.

    Parameters
    ----------
    flags : ndarray of bool, shape (n,)
        Where.
    """
    padded = np.concatenate([[False], flags, [False]]).astype(np.int8)
    change = np.flatnonzero(np.diff(padded))
    return [(int(first), int(last)) for first, last in zip(change[::2], change[1::2], strict=True)]


# ---------------------------------------------------------------------- missing and out of range


def _missing(values: Array) -> list[tuple[Defect, int, int, str]]:
    return [
        ("missing", first, last, f"{last - first} values missing") for first, last in runs(np.isnan(values))
    ]


def _out_of_range(values: Array, limits: tuple[float, float] | None) -> list[tuple[Defect, int, int, str]]:
    low, high = limits if limits is not None else _usual_range(values)
    with np.errstate(invalid="ignore"):
        outside = below(values, low) | above(values, high)
    defects: list[tuple[Defect, int, int, str]] = []
    for first, last in runs(outside):
        part = values[first:last]
        worst = part[np.argmax(np.abs(part - 0.5 * (low + high)))]
        said = "possible range" if limits is not None else "range to be expected from the other values"
        defects.append(("out_of_range", first, last, f"{worst:g} is outside the {said}, {low:g} .. {high:g}"))
    return defects


def _usual_range(values: Array) -> tuple[float, float]:
    """Limits far outside the usual values; none for a column that is mostly constant (rain)."""
    valid = values[~np.isnan(values)]
    if len(valid) < 20:
        return -np.inf, np.inf
    low, middle, high = np.quantile(valid, [0.05, 0.5, 0.95])
    if not high > low or np.mean(valid == middle) > 0.4:
        return -np.inf, np.inf
    reach = _FAR * (high - low)
    return float(middle - reach), float(middle + reach)


# ---------------------------------------------------------------------- spikes


def _spikes(plausible: Array, shown: Array) -> list[tuple[Defect, int, int, str]]:
    """Excursions of at most three rows that come back to where they started.

    The usual change in one step is derived from the values that are possible (`plausible`, NaN elsewhere). An
    excursion may itself be impossible: it is then a spike as well as out of range. The text names the values
    as `shown`.
    """
    least = _least_spike(plausible[~np.isnan(plausible)])
    possible = ~np.isnan(plausible)
    combined = np.where(possible, plausible, shown)
    flags = np.zeros(len(plausible), dtype=bool)
    # Without the impossible values, so that a spike beside one is seen; then with them.
    for values in (plausible, combined):
        valid_rows = np.flatnonzero(~np.isnan(values))
        flags[valid_rows[_excursions(values[valid_rows], possible[valid_rows], least)]] = True
    valid_rows = np.flatnonzero(~np.isnan(combined))
    spikes: list[tuple[Defect, int, int, str]] = []
    for first, last in runs(flags[valid_rows]):
        row = valid_rows[
            first + int(np.argmax(np.abs(combined[valid_rows[first:last]] - combined[valid_rows[first - 1]])))
        ]
        after = valid_rows[min(last, len(valid_rows) - 1)]
        text = f"{shown[row]:g} between {shown[valid_rows[first - 1]]:g} and {shown[after]:g}"
        spikes.append(("spike", int(valid_rows[first]), int(valid_rows[last - 1]) + 1, text))
    return spikes


def _least_spike(series: Array) -> float:
    """Height from which on an excursion is a spike; infinite where the column has too few values."""
    steps = np.abs(np.diff(series))
    steps = steps[steps > 0.0]
    if len(series) < 20 or len(steps) < 10:
        return np.inf
    low, high = np.quantile(series, [0.01, 0.99])
    return max(_SPIKE * float(np.quantile(steps, 0.99)), _SPIKE_RANGE * float(high - low))


def _excursions(series: Array, possible: Flags, least: float) -> Lines:
    """Rows of excursions; what comes before and after one must be possible."""
    taken = np.zeros(len(series), dtype=bool)
    for width in range(1, min(_SPIKE_WIDTH, len(series) - 2) + 1):
        before, after = series[: -width - 1], series[width + 1 :]
        inner = np.stack([series[1 + k : len(series) - width + k] for k in range(width)])
        above = np.min(inner, axis=0) - np.maximum(before, after) > least
        below = np.minimum(before, after) - np.max(inner, axis=0) > least
        back = (np.abs(after - before) < 0.5 * least) & possible[: -width - 1] & possible[width + 1 :]
        for row in np.flatnonzero((above | below) & back):
            taken[row + 1 : row + 1 + width] = True
    return np.flatnonzero(taken)


def _unwound(values: Array) -> Array:
    """A direction in degrees without its jumps at north; any other column as it is."""
    valid = ~np.isnan(values)
    series = values[valid]
    if (
        len(series) < 2
        or series.min() < 0.0
        or series.max() > 360.0
        or np.max(np.abs(np.diff(series))) < 270.0
    ):
        return values
    unwound = values.copy()
    unwound[valid] = np.unwrap(series, period=360.0)
    return unwound


# ---------------------------------------------------------------------- repeated values


def _runs_of_equal(values: Array) -> tuple[Lines, Lines]:
    """Start and length of every run of equal values; a missing value equals nothing."""
    changes = np.concatenate([[True], ~(values[1:] == values[:-1])])
    start = np.flatnonzero(changes)
    return start, np.diff(np.concatenate([start, [len(values)]]))


def _usual_longest(lengths: Lines, least: int = 2) -> float:
    """Longest usual run: the least, or longer ones as far as several runs of similar length exist."""
    if not len(lengths):
        return float(least)
    ordered = np.sort(lengths)
    longest = float(max(least, np.quantile(ordered, 0.99, method="lower")))
    while True:
        within = ordered[(ordered > longest) & (ordered <= _LONGER * longest)]
        if len(within) < _SUPPORT:
            return longest
        longest = float(within[-1])


def _stuck(values: Array, interval: float, bounds: Sequence[float]) -> list[tuple[int, int]]:
    """Runs of equal values that are not usual for this channel: first and past-the-end row."""
    valid = values[~np.isnan(values)]
    if len(valid) < _FEWEST:
        return []
    if np.all(valid == valid[0]):
        # Never changes: a whole number was written by hand, any other number comes from a sensor.
        return [] if float(valid[0]).is_integer() else [(0, len(values))]
    start, length = _runs_of_equal(values)
    idle = _idle(values, start, length, interval) | np.isin(values[start], bounds) | np.isnan(values[start])
    idle |= switched_levels(values, start, length)
    longest = _usual_longest(length[~idle])
    long = ~idle & (length >= _FEWEST) & (length > _LONGER * longest)
    long &= ~_returning(values[start], length)
    candidates = [(int(a), int(a + n)) for a, n in zip(start[long], length[long], strict=True)]
    return [
        run
        for run in candidates
        if run[1] - run[0] > _CERTAIN * longest
        or (_elsewhere_moves(values, candidates, run) and not _turns(values, run, longest))
    ]


def _idle(values: Array, start: Lines, length: Lines, interval: float) -> Flags:
    """Runs at zero, of at most a day, of a channel that is never negative: night, calm."""
    return np.asarray((values[start] == 0.0) & (np.nanmin(values) >= 0.0) & (length * interval <= _DAY))


def _returning(value: Array, length: Lines) -> Flags:
    """Runs at a value to which the channel returns for long: saturation, dry spells."""
    rests = np.zeros(len(value), dtype=bool)
    for k in np.flatnonzero(length >= _FEWEST):
        same = (value == value[k]) & (length * _LONGER >= length[k])
        if np.count_nonzero(same) > _SUPPORT:
            rests[k] = True
    return rests


def _elsewhere_moves(values: Array, candidates: list[tuple[int, int]], run: tuple[int, int]) -> bool:
    """Whether the values change by two steps of the logger in other windows of similar length."""
    keep = ~np.isnan(values)
    for first, last in candidates:
        keep[first + 1 : last] = False
    edge = [value for value in (np.nanmin(values), np.nanmax(values)) if np.mean(values == value) > 0.01]
    for value in edge:
        keep &= values != value
    series = values[keep]
    if len(series) < 2:
        return False
    window = min(run[1] - run[0], max(2, len(series) // 20))
    count = len(series) // window
    blocks = series[: count * window].reshape(count, window)
    moves = np.ptp(blocks, axis=1) >= 1.99 * _resolution(values)
    return bool(np.mean(moves) >= 0.98)


def _resolution(values: Array) -> float:
    """Smallest usual change of the channel: the resolution of a coarse logger. [unit of the channel]"""
    steps = np.abs(np.diff(values))
    steps = steps[steps > 0.0]
    return float(np.quantile(steps, 0.05)) if len(steps) else 0.0


def _turns(values: Array, run: tuple[int, int], longest: float) -> bool:
    """Whether a coarse logger may be at a turning point: one step before and after, not too long."""
    first, last = run
    if longest <= 2.0 or last - first > _TURNING * longest:
        return False
    step = 1.5 * _resolution(values)
    before = first == 0 or abs(values[first - 1] - values[first]) <= step
    after = last == len(values) or abs(values[last] - values[first]) <= step
    return bool(before and after)


def _repeated(
    columns: Mapping[str, Array], stuck: Mapping[str, list[tuple[int, int]]]
) -> dict[str, list[tuple[Defect, int, int, str]]]:
    """Divide runs of repeated values into stuck and forward-filled ones."""
    if not columns:
        return {}
    together = _held_together(columns, stuck)
    defects: dict[str, list[tuple[Defect, int, int, str]]] = {name: [] for name in columns}
    count = len(next(iter(columns.values())))
    for name, values in columns.items():
        blocks = [block for block in together if _held(values, block) and _counts(values, block)]
        for first, last in blocks:
            end = ", to the end of the record" if last == count else ""
            text = f"repeats {values[first]:g} while several other channels repeat theirs{end}"
            defects[name].append(("forward_filled", first, last, text))
        for first, last in stuck[name]:
            if any(_alike((first + 1, last), block) for block in blocks):
                continue
            end = ", to the end of the record" if last == count else ""
            text = f"stuck at {values[first]:g} for {last - first} rows{end}"
            defects[name].append(("stuck", first + 1 if first else 0, last, text))
    return defects


def _held_together(
    columns: Mapping[str, Array], stuck: Mapping[str, list[tuple[int, int]]]
) -> list[tuple[int, int]]:
    """Blocks of rows in which several channels repeat their values; first repetition and past-the-end row."""
    blocks: list[tuple[int, int]] = []
    pool = [(run[0] + 1, run[1]) for stretches in stuck.values() for run in stretches]
    for block in sorted(set(pool)):
        same = [other for other in pool if _alike(block, other)]
        if len(same) >= 2:
            common = max(first for first, _ in same), min(last for _, last in same)
            blocks += [] if common in blocks else [common]
    for first, last in (*_still(columns, stuck), *_tail(columns, stuck)):
        if not any(a <= first and last <= b for a, b in blocks):
            blocks = [block for block in blocks if not (first <= block[0] and block[1] <= last)]
            blocks.append((first, last))
    return sorted(blocks)


def _still(columns: Mapping[str, Array], stuck: Mapping[str, list[tuple[int, int]]]) -> list[tuple[int, int]]:
    """Blocks of rows in which no channel changes, longer than usual."""
    count = len(next(iter(columns.values())))
    moving = np.zeros(count, dtype=bool)
    moving[0] = True
    for values in columns.values():
        moving[1:] |= values[1:] != values[:-1]
    still = runs(~moving)
    lengths = np.ones(max(int(moving.sum()), 1), dtype=np.int64)
    lengths[: len(still)] = [last - first + 1 for first, last in still]
    limit = max(_LONGER * _usual_longest(lengths, least=1), _FEWEST_TOGETHER - 1)
    return [
        block for block in still if block[1] - block[0] + 1 > limit and len(_free(columns, stuck, block)) >= 2
    ]


def _tail(columns: Mapping[str, Array], stuck: Mapping[str, list[tuple[int, int]]]) -> list[tuple[int, int]]:
    """Block at the end of the record in which several channels have their longest run."""
    count = len(next(iter(columns.values())))
    longest = []
    for name, values in columns.items():
        start, length = _runs_of_equal(values)
        block = (int(start[-1]) + 1, count)
        record = length[-1] >= _FEWEST_TOGETHER and length[-1] > 2.0 * np.max(length[:-1], initial=1)
        if record and name in _free(columns, stuck, block):
            longest.append(block)
    return [max(longest)] if len(longest) >= 2 else []


def _free(
    columns: Mapping[str, Array], stuck: Mapping[str, list[tuple[int, int]]], block: tuple[int, int]
) -> list[str]:
    """Channels that repeat a value in a block, and were not stuck at it long before."""
    first, last = block
    return [
        name
        for name, values in columns.items()
        if _held(values, block)
        and _counts(values, block)
        and not any(a < first - 1 - (last - first) and last <= b for a, b in stuck[name])
    ]


def _alike(run: tuple[int, int], other: tuple[int, int]) -> bool:
    """Whether two runs cover nearly the same rows."""
    shared = min(run[1], other[1]) - max(run[0], other[0])
    return shared >= _ALIKE * (max(run[1], other[1]) - min(run[0], other[0]))


def _held(values: Array, block: tuple[int, int]) -> bool:
    """Whether a column repeats its value in every row of a block."""
    first, last = block
    return bool(np.all(values[first:last] == values[first - 1 : last - 1]))


def _counts(values: Array, block: tuple[int, int]) -> bool:
    """Whether a repeated value is suspicious: the column changes elsewhere and rarely has this value."""
    value = values[block[0]]
    if np.isnan(value):
        return False
    outside = values[~np.isnan(values) & (values != value)]
    if value == 0.0 or not len(outside):
        return False
    resting = value < outside.min() or value > outside.max()
    return not (resting and len(values) - len(outside) - (block[1] - block[0]) > 0.01 * len(values))
