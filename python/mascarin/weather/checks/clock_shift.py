"""How much later than the sun the radiation of a record is, with the uncertainty of that.

By the balance of irradiances, where global and direct irradiance were both measured, and by the symmetry
of clear hours about solar noon. Every time of a row is compared with the sun a little earlier or later;
the shift for which most clear hours have the form of a clear sky, or for which the balance closes best, is
taken.

References
----------
Haurwitz 1945, Journal of Meteorology 2(3), 154-166, doi:10.1175/1520-0469(1945)002<0154:IIRTCA>2.0.CO;2.
Long & Shi 2008, The Open Atmospheric Science Journal 2, 23-37, doi:10.2174/1874282300802010023 (the same
balance of components as a check of instruments).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from mascarin.tables.arrays import Array, Flags
from mascarin.weather.derived.sun_position import sun_over
from mascarin.weather.records.channels import RADIATION
from mascarin.weather.records.record import WeatherRecord

NODE: Final = 300.0
"""Step of the sun and of the shifts that are tried. [s]"""
_MOST: Final = 30
"""Largest shift that is tried, in nodes: two and a half hours."""
_MOST_DAYS: Final = 60
"""Days that are used of a longer record, evenly spread."""
_ROWS: Final = (1800.0, 3600.0)
"""Lengths of rows that are compared; shorter steps are averaged. [s]"""
_LONGEST: Final = 3600.0
"""Longer rows do not show the form of a day. [s]"""
_CLEAR: Final = 1098.0
_DECAYS: Final = (0.02, 0.057, 0.11)
"""Decay of the clear sky: clean, Haurwitz's, and turbid air. [-]"""
_WIDTH: Final = 0.02
"""Standard deviation of clear hours from a smooth form. [-]"""
_LOW: Final = 0.08
"""Sine of the elevation below which hours are not compared with a form. [-]"""
_CLEAR_PART: Final = 0.6
"""Part of the hours of a day with the form of a clear sky from which a day is a clear one. [-]"""
_CLEAN: Final = 0.03
"""Decay of a clear sky that is cleaner than most. [-]"""
_LOW_SUN: Final = 0.35
"""Sine of 20 deg."""
_TWILIGHT: Final = 6.0
"""Light of a clear sky with the sun at the horizon, means of half an hour. [W/m2]"""
_SAMPLES: Final = 200
_FLOOR: Final = 100.0
"""Uncertainty that remains with any number of days: tilt and cosine error of instruments. [s]"""
_FLOOR_WITHOUT_DIFFUSE: Final = 240.0
"""The same where diffuse irradiance was not measured: fog makes it uneven over a day. [s]"""
_BEAM: Final = 100.0
"""Least direct irradiance that is used in the balance. [W/m2]"""
_ROUNDING: Final = 1.5
"""Residual of the balance up to which a model has made the direct irradiance: rounded numbers. [W/m2]"""


@dataclass(frozen=True)
class ClockShift:
    """How much later than the sun the radiation is.

    Attributes
    ----------
    late : float
        Positive where the stamps of the radiation are too late. [s]
    uncertainty : float
        Standard uncertainty. [s]
    by : str
        `balance` of the irradiances, or `symmetry` of clear hours.
    days : int
        Days that were used.
    split : bool
        Whether the direct irradiance was calculated from the global one: its balance closes by construction.
    outside : float
        Part of the radiation that is more than a clear sky gives at the stated time, on the side of the
        day to which the record is shifted. Haze and fog that change over a day look like a small shift,
        but they never make the low sun brighter. [-]
    """

    late: float
    uncertainty: float
    by: Literal["balance", "symmetry"]
    days: int
    split: bool = False
    outside: float = 1.0

    @property
    def minutes(self) -> str:
        """Shift and uncertainty as text. [min]"""
        shift, uncertain = abs(self.late) / 60.0, self.uncertainty / 60.0
        return f"{shift:.0f} min (standard uncertainty {uncertain:.1f} min)"

    def exceeds(self, limit: float) -> bool:
        """Whether the shift exceeds a limit [s] and three times its uncertainty."""
        return abs(self.late) > max(limit, 3.0 * self.uncertainty)


@dataclass(frozen=True)
class Days:
    """Rows of a record by solar day, and the sun around them.

    Attributes
    ----------
    values : dict
        Irradiances, shape (days, rows). [W/m2]
    sines : ndarray, shape (days, nodes)
        Sine of the elevation, not below zero, from `_MOST` nodes before the first row on. [-]
    directions : ndarray, shape (days, nodes, 3)
        Unit vector to the sun at the nodes: east, north, up. [-]
    width : int
        Nodes of a row.
    """

    values: dict[str, Array]
    sines: Array
    directions: Array
    width: int

    @property
    def rows(self) -> int:
        """Rows of a day."""
        return int(next(iter(self.values.values())).shape[1])

    def means(self, nodes: Array, late: int) -> Array:
        """Means over the rows of what is known at the nodes, for a record that is late by some nodes."""
        total = np.concatenate(
            [np.zeros((len(nodes), 1)), np.cumsum(0.5 * (nodes[:, 1:] + nodes[:, :-1]), axis=1)], axis=1
        )
        first = np.arange(self.rows) * self.width + _MOST - late
        return np.asarray((total[:, first + self.width] - total[:, first]) / self.width)


def shifts_of(record: WeatherRecord, latitude: float, longitude: float) -> tuple[ClockShift, ...]:
    """Shifts of the clock against the sun that the radiation shows.

    Parameters
    ----------
    record : WeatherRecord
        As read, before anything is derived.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    tuple of ClockShift
        By the balance and by symmetry, each where the record shows it.
    """
    days = days_of(record, latitude, longitude)
    if days is None:
        return ()
    shifts = (_by_balance(days), _by_symmetry(days))
    return tuple(shift for shift in shifts if shift is not None)


def days_of(
    record: WeatherRecord, latitude: float, longitude: float, further: Mapping[str, Array] | None = None
) -> Days | None:
    """Rows by solar day; None where the record is too short or its step does not divide a day.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]
    further : mapping of str to ndarray, shape (rows,), optional
        Irradiances of planes on the grid of the record. [W/m2]
    """
    grid, step = record.grid, record.grid.interval
    width = next((w for w in _ROWS if w >= step and abs(w / step - round(w / step)) < 1e-9), step)
    per = round(width / step)
    if width > _LONGEST or width % NODE or 86400.0 % width or "global_horizontal" not in record.columns:
        return None
    midnight = -longitude * 240.0
    skipped = int(np.ceil(((midnight - grid.start) % 86400.0) / step))
    rows = round(86400.0 / width)
    count = (grid.count - skipped) // (rows * per)
    if count < 1:
        return None
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_DAYS)).astype(int))
    names = [name for name in RADIATION if name in record.columns and name not in record.assumed]
    columns = {name: record.columns[name] for name in names} | dict(further or {})
    values = {
        name: column[skipped : skipped + count * rows * per].reshape(count, rows, per)[chosen].mean(axis=2)
        for name, column in columns.items()
    }
    early = 0.5 * step if record.kinds["global_horizontal"] == "instant" else 0.0
    starts = grid.start + skipped * step - early + 86400.0 * chosen
    nodes = NODE * np.arange(-_MOST, round(86400.0 / NODE) + _MOST + 1)
    sun = sun_over(record, latitude, longitude, (starts[0] + nodes[0] - 1.0, starts[-1] + nodes[-1] + 1.0))
    directions = sun.vector(starts[:, None] + nodes)
    sines = np.maximum(directions[..., 2], 0.0)
    sunlit = sines.max(axis=1) > _LOW
    if not sunlit.any() or "global_horizontal" not in values:
        return None
    lit_values = {name: column[sunlit] for name, column in values.items()}
    return Days(lit_values, sines[sunlit], directions[sunlit], round(width / NODE))


LAGS: Final = np.arange(-_MOST, _MOST + 1, 2)


def _best(scores: Array) -> float:
    """Shift with the highest score, between those that were tried. [s]"""
    peak = int(np.argmax(scores))
    inner = min(max(peak, 1), len(scores) - 2)
    before, centre, after = scores[inner - 1 : inner + 2]
    bend = before - 2.0 * centre + after
    part = 0.5 * (before - after) / bend if bend < 0.0 and inner == peak else 0.0
    return float((LAGS[peak] + 2.0 * part) * NODE)


def _with_uncertainty(scores: Array, floor: float) -> tuple[float, float]:
    """Shift for the sum of the scores of days, shape (days, shifts), and its uncertainty by bootstrap. [s]"""
    best = _best(scores.sum(axis=0))
    rng = np.random.default_rng(0)
    sample_counts = rng.multinomial(len(scores), np.full(len(scores), 1.0 / len(scores)), size=_SAMPLES)
    spread = float(np.std([_best(row) for row in sample_counts.astype(np.float64) @ scores]))
    return best, float(np.hypot(spread, floor * (1.0 + 3.0 / len(scores))))


def _by_balance(days: Days) -> ClockShift | None:
    """The shift that closes global = direct x sine + diffuse."""
    if "direct_normal" not in days.values:
        return None
    total, beam = days.values["global_horizontal"], days.values["direct_normal"]
    diffuse = days.values.get("diffuse_horizontal")
    used = np.isfinite(total) & (beam > _BEAM) & (total > 0.0)
    if diffuse is not None:
        used &= np.isfinite(diffuse)
    least = 3 if diffuse is not None else 6
    enough = used.sum(axis=1) >= least
    if not enough.any():
        return None
    residuals = np.stack([_residuals(days, used, lag) for lag in LAGS.tolist()], axis=-1)[enough]
    sizes = np.abs(residuals[used[enough]])
    typical = float(np.median(sizes[:, int(np.argmin((sizes**2).mean(axis=0)))]))
    limit = max(6.0 * typical, 1.0)  # single wrong rows decide nothing
    scores = -(np.minimum(np.abs(residuals), limit) ** 2)
    floor = _FLOOR if diffuse is not None else _FLOOR_WITHOUT_DIFFUSE
    late, uncertainty = _with_uncertainty(np.where(used[enough][..., None], scores, 0.0).sum(axis=1), floor)
    split = diffuse is not None and _is_split(days, used, round(late / NODE))
    return ClockShift(late, uncertainty, "balance", int(enough.sum()), split)


def _residuals(days: Days, used: Flags, late: int) -> Array:
    """Residual of the balance in each row; the gain of the beam is fitted, and without diffuse also that."""
    sine = days.means(days.sines, late)
    total, beam = days.values["global_horizontal"], np.where(used, days.values["direct_normal"], 0.0) * sine
    diffuse = days.values.get("diffuse_horizontal")
    weight = used.astype(np.float64)
    if diffuse is not None:
        target = np.where(used, total - diffuse, 0.0)
        gain = float(np.clip((target * beam).sum() / max((beam * beam).sum(), 1e-9), 0.8, 1.25))
        return np.asarray(target - gain * beam)
    target = np.where(used, total, 0.0)
    terms = np.stack([beam, sine * weight, weight], axis=-1)
    scale = np.array([500.0, 1.0, 1.0])
    terms /= scale
    matrix = np.einsum("dri,drj->dij", terms, terms) + 1e-6 * np.eye(3)
    right = np.einsum("dri,dr->di", terms, target)
    fitted = np.linalg.solve(matrix, right[..., None])[..., 0]
    return np.asarray((target - np.einsum("dri,di->dr", terms, fitted)) * weight)


def _is_split(days: Days, used: Flags, late: int) -> bool:
    """Whether the components close more exactly than instruments do: one was calculated from the others."""
    total, beam, diffuse = (
        days.values[name] for name in ("global_horizontal", "direct_normal", "diffuse_horizontal")
    )
    ends = [days.means(days.sines, late)]
    middle = np.arange(total.shape[1]) * days.width + _MOST - late + days.width // 2
    ends.append(days.sines[:, middle])
    if days.width % 2:
        ends[-1] = 0.5 * (days.sines[:, middle] + days.sines[:, middle + 1])
    return any(
        float(np.quantile(np.abs((total - diffuse - beam * sine)[used]), 0.8)) < _ROUNDING for sine in ends
    )


def _by_symmetry(days: Days) -> ClockShift | None:
    """The shift for which most hours of clear days have the form of a clear sky."""
    sunlit = days.sines.max(axis=0) > _LOW  # rows that are dark on all days are left out
    sunlit_rows = [
        bool(sunlit[k * days.width : (k + 1) * days.width + 2 * _MOST].any()) for k in range(days.rows)
    ]
    total = days.values["global_horizontal"][:, sunlit_rows]
    scores = np.zeros((len(total), len(LAGS)))
    forms = [_CLEAR * days.sines * np.exp(-decay / np.maximum(days.sines, 1e-3)) for decay in _DECAYS]
    for column, lag in enumerate(LAGS.tolist()):
        usable = (days.means(days.sines, lag)[:, sunlit_rows] > _LOW) & (total > 0.0)
        for form in forms:
            expected = days.means(form, lag)[:, sunlit_rows]
            ratio = np.log(np.where(usable, total, 1.0) / np.where(usable, expected, 1.0))
            apart = (ratio[:, :, None] - ratio[:, None, :]) / _WIDTH
            agreement = np.exp(-0.5 * apart * apart) * (usable[:, None, :] & usable[:, :, None])
            scores[:, column] = np.maximum(scores[:, column], agreement.sum(axis=2).max(axis=1))
    rows = np.maximum((days.means(days.sines, 0) > _LOW).sum(axis=1), 1)
    clear = (scores.max(axis=1) >= _CLEAR_PART * rows) & (rows >= 4)
    if not clear.any():
        return None
    late, uncertainty = _with_uncertainty(scores[clear], _FLOOR)
    return ClockShift(late, uncertainty, "symmetry", int(clear.sum()), outside=_outside(days, late))


def _outside(days: Days, late: float) -> float:
    """Part of the radiation that is more than a clear sky gives, in the morning or the evening."""
    total = np.nan_to_num(days.values["global_horizontal"])
    sine = days.means(days.sines, 0)
    clear = days.means(_CLEAR * days.sines * np.exp(-_CLEAN / np.maximum(days.sines, 1e-3)), 0)
    high = sine > 0.7 * sine.max()
    gain = max(1.0, float(np.quantile(total[high] / clear[high], 0.9)))
    noon = np.argmax(sine, axis=1)[:, None]
    row = np.arange(days.rows)
    side = row > noon if late > 0.0 else row < noon
    low = side & (sine < _LOW_SUN)
    return float(np.maximum(total - gain * clear - _TWILIGHT, 0.0)[low].sum() / max(total.sum(), 1e-9))
