"""Check that the radiation follows the sun; if not, the time zone, the stamps or the place are wrong."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array
from mascarin.tables.quality import Stretch
from mascarin.tables.times import stamps_of
from mascarin.tables.timezones import fixed_offset, fixed_zone, standard_offset, zone_name
from mascarin.weather.checks import clock_shift
from mascarin.weather.checks.brightness import findings
from mascarin.weather.checks.clock_shift import ClockShift, shifts_of
from mascarin.weather.checks.once import said_once
from mascarin.weather.derived import sun as sun_module
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.derived.sun_position import Sun, angle_from_path, states_position, sun_over
from mascarin.weather.records.channels import RADIATION, SUN_POSITION
from mascarin.weather.records.record import WeatherRecord, plain_warning

if TYPE_CHECKING:
    import numpy.typing as npt

_LARGEST_SHIFT: Final = 600.0
"""A clock that is wrong by more than this and three times the uncertainty is refused. [s]"""
_OUTSIDE: Final = 5e-4
"""Part of the radiation above a clear sky from which clouds do not explain a shift. [-]"""
_NAMED_SHIFT: Final = 180.0
"""One that is wrong by more than this and three times the uncertainty is named. [s]"""
_SHORTEST: Final = 2.0 * 86400.0
_POSITION_OFF: Final = 1.0
"""A stated position of the sun that is farther from that of place and time is named; four minutes are one
degree, and refraction is half a degree. [deg]"""
_DARK: Final = -0.02
"""Sine of the elevation below which daylight is neglected (1.1 deg below the horizon)."""
_NIGHT_MOST: Final = 0.005
"""More radiation than this part at night is refused. [-]"""
_NIGHT_TRACE: Final = 0.0003
"""More than this part at night is refused where the center is off by `_NOON_OFF` as well. [-]"""
_NOON_OFF: Final = 0.75
"""See `_NIGHT_TRACE`. [h]"""
_JUMP: Final = 0.7
"""A center that moves by more than this between some weeks and the next ones is refused. In five years of
weather files from 21 S to 42 N the largest movement is 0.5 h; with a clock of summer time it is 0.86 h or
more. [h]"""
_FEWEST_DAYS: Final = 14
_MOST_DAYS: Final = 21
"""Days on each side of such a movement. Clouds move the center of single weeks by up to 0.9 h."""


def check_clock(record: WeatherRecord, latitude: float, longitude: float) -> tuple[str, ...]:
    """Refuse a climate whose radiation does not follow the sun over the given place.

    The shift of the clock is determined from the balance of measured irradiances and from the form of clear
    hours (`mascarin.weather.checks.clock_shift`), and refused where it exceeds ten minutes and three times
    its uncertainty. Beside it three numbers are checked: the part of the radiation that is recorded while the
    sun is below the horizon, the hour angle around which the radiation is centered, and in records of four
    weeks or more how far this center moves at once, as with a clock that follows summer time. Clouds and
    hills shift the center, by more than an hour where mornings are in fog: a center alone proves nothing. A
    wrong time zone shifts it by whole hours and puts radiation into the night.

    Parameters
    ----------
    record : WeatherRecord
        With at least one irradiance; a record without radiation, or with a constant one, passes.
    latitude, longitude : float
        Positive north and east [deg].

    Returns
    -------
    tuple of str
        Warnings: smaller shifts, and such that are not certain.

    Raises
    ------
    InputError
        The radiation and the sun do not agree; the shift is named.
    """
    values = _radiation(record)
    grid = record.grid
    if states_position(record):
        return tuple(_stated_position(record, latitude, longitude))
    if values is None or grid.count * grid.interval < _SHORTEST or np.ptp(values) == 0.0:
        return ()
    # The sun over a year takes half as long as a run over three months: what has passed once is remembered.
    measured = sorted({*RADIATION} & {*record.columns} - record.assumed)
    return said_once(
        record,
        [record.columns[name] for name in RADIATION if name in record.columns],
        ("clock", record.kinds[_name(record)], measured, latitude, longitude),
        [sys.modules[__name__], clock_shift, sun_module],
        lambda: _refuse(record, values, latitude, longitude),
    )


def sun_warnings(record: WeatherRecord, latitude: float, longitude: float) -> tuple[str, ...]:
    """Warnings about the radiation of a record: brighter than possible, or not at the time of the sun.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]
    """
    clock = check_clock(record, latitude, longitude) if record.check_sun else ()
    return (*findings(record, latitude, longitude), *(plain_warning(text) for text in clock))


def _shift_findings(record: WeatherRecord, latitude: float, longitude: float) -> list[str]:
    """Warnings about the shift of the clock against the sun; one that is certain is refused."""
    shifts = {shift.by: shift for shift in shifts_of(record, latitude, longitude)}
    balance, symmetry = shifts.get("balance"), shifts.get("symmetry")
    said = []
    if balance is not None and not balance.split and not balance.exceeds(_NAMED_SHIFT):
        symmetry = None  # instruments agree with the sun: what is not symmetrical are clouds
    if balance is not None and _proves_nothing(balance, symmetry, record.grid.interval):
        if abs(balance.late) > max(_LARGEST_SHIFT, 3.0 * balance.uncertainty):
            said.append(
                f"{record.file}: warning: global, direct and diffuse irradiance balance with a sun that is "
                f"{balance.minutes} {'earlier' if balance.late > 0.0 else 'later'} than that of the stated "
                "clock, and clear hours do not show the same shift: direct and diffuse irradiance were "
                "probably calculated with the sun at another time of the interval."
            )
        balance = None
    for shift in (balance, symmetry):
        if shift is None:
            continue
        if shift.exceeds(_LARGEST_SHIFT) and shift.outside > _OUTSIDE:
            raise InputError(_shift_text(record, shift, latitude, longitude))
        if shift.exceeds(_NAMED_SHIFT) or abs(shift.late) > _LARGEST_SHIFT:
            said.append(f"{record.file}: warning: {_shift_sentence(shift)}; the clock is used as stated.")
    return said


def _proves_nothing(balance: ClockShift, symmetry: ClockShift | None, interval: float) -> bool:
    """Whether direct irradiance was calculated: the balance closes by construction, for any clock.

    It does so with the sun at another time of the interval, too, which is no error of the clock.
    """
    contradicted = symmetry is not None and abs(balance.late - symmetry.late) > 3.0 * np.hypot(
        balance.uncertainty, symmetry.uncertainty
    )
    at_an_end = abs(abs(balance.late) - 0.5 * interval) < 180.0 or abs(balance.late) < 180.0
    return bool(contradicted or (balance.split and at_an_end and symmetry is None))


def _shift_sentence(shift: ClockShift) -> str:
    reason = (
        "the balance of global, direct and diffuse irradiance closes"
        if shift.by == "balance"
        else "clear hours are symmetrical"
    )
    side = "later" if shift.late > 0.0 else "earlier"
    return (
        f"the radiation is {shift.minutes} {side} than the sun: {reason} with this shift ({shift.days} days)"
    )


def _shift_text(record: WeatherRecord, shift: ClockShift, latitude: float, longitude: float) -> str:
    """Text of the refusal of a shifted clock."""
    minutes = -round(shift.late / 60.0)
    instant = record.kinds[_name(record)] == "instant"
    half = 0.5 * record.grid.interval
    hints = []
    if abs(abs(shift.late) - 2.0 * half) < 300.0 and not instant:
        hints.append(f"stamps: {'end' if shift.late > 0.0 else 'start'}, if stamps mark that end")
    if abs(abs(shift.late) - half) < 300.0 and not instant and not record.of_year:
        hints.append("kind: instant in the columns of irradiance, if values are those at the stamp")
    also = f" Or {', or '.join(hints)}." if hints else ""
    return (
        f"{record.file}: the radiation does not follow the sun at latitude {latitude:g}, longitude "
        f"{longitude:g}: {_shift_sentence(shift)}; expected less than {_LARGEST_SHIFT / 60.0:g} min. "
        f"Check the "
        f"time zone (now {zone_name(record.grid.zone)}), whether stamps mark the start or the end of their "
        f"interval, and the place (east is positive). If the clock was wrong, state shift: {minutes}min "
        f"(on the command line --shift={minutes}min, in Python shift='{minutes}min').{also} "
        "If all of these are right, read the record "
        "as it is with check_sun: false (on the command line --no-check-sun, in Python check_sun=False)."
    )


def _refuse(record: WeatherRecord, values: Array, latitude: float, longitude: float) -> list[str]:
    """Refuse radiation [W/m2] that does not follow the sun; warnings about smaller shifts."""
    grid = record.grid
    shift = 0.0 if record.kinds[_name(record)] == "instant" else 0.5
    middle = grid.start + grid.interval * (np.arange(grid.count) + shift)
    sun = SunPath.over(latitude, longitude, grid.start - grid.interval, grid.end + grid.interval)
    night = _night_part(values, sun, middle, grid.interval)
    turns = _turns(values, sun.vector(middle), latitude)
    if night > 0.0:
        _refuse_jump(record, middle, turns)
    late = float(np.degrees(np.angle(turns.sum())) / 15.0)
    said = _shift_findings(record, latitude, longitude)
    # Clouds and hills move the center as far as they like: what lies at night alone shows a wrong clock.
    if night <= _NIGHT_MOST and (night <= _NIGHT_TRACE or abs(late) <= _NOON_OFF):
        return said
    when = "after" if late > 0.0 else "before"
    raise InputError(
        f"{record.file}: the radiation does not follow the sun at latitude {latitude:g}, longitude "
        f"{longitude:g}: it is centered {abs(late):.1f} h {when} solar noon, and {100.0 * night:.2g} % of it "
        "is recorded while the sun is below the horizon; expected less than one hour, and none. Check the "
        f"time zone (now {zone_name(grid.zone)}), whether stamps mark the start or the end of their "
        "interval, and the sign of the longitude (east is positive). If all of these are right, the record "
        "itself is wrong: repair the file, or read it as it is with check_sun: false (on the command line "
        "--no-check-sun, in Python check_sun=False)."
    )


def _stated_position(record: WeatherRecord, latitude: float, longitude: float) -> list[str]:
    """Warnings about a stated position of the sun; radiation while it is below the horizon is refused."""
    names = " and ".join(SUN_POSITION)
    night = _below_stated_horizon(record, latitude, longitude)
    if night > _NIGHT_MOST:
        raise InputError(
            f"{record.file}: {100.0 * night:.2g} % of the radiation is recorded while the sun of the columns "
            f"{names} is below the horizon; expected less than {100.0 * _NIGHT_MOST:g} %. Check their stamps "
            "and units (the elevation is an angle above the horizon in deg, no zenith angle), or read the "
            "record as it is with check_sun: false (on the command line --no-check-sun, in Python "
            "check_sun=False)."
        )
    away = angle_from_path(record, latitude, longitude)
    if away <= _POSITION_OFF:
        return []
    return [
        f"{record.file}: warning: the position of the sun that the columns {names} state is up to {away:.2g} "
        f"deg away from that at latitude {latitude:g}, longitude {longitude:g}; the stated one is used."
    ]


def _below_stated_horizon(record: WeatherRecord, latitude: float, longitude: float) -> float:
    """Part of the brightest irradiance while the stated sun is below the horizon. [-]"""
    columns = [name for name in RADIATION if name in record.columns and np.any(record.columns[name] > 0.0)]
    if not columns:
        return 0.0
    brightest = max(columns, key=lambda name: float(np.nansum(record.columns[name])))
    values = np.maximum(np.nan_to_num(record.columns[brightest]), 0.0)
    grid = record.grid
    middle = grid.start + grid.interval * (
        np.arange(grid.count) + (0.5 if record.kinds[brightest] == "mean" else 0.0)
    )
    sun = sun_over(record, latitude, longitude, (grid.start, grid.end))
    return _night_part(values, sun, middle, grid.interval)


def is_polar_night(part: Stretch, record: WeatherRecord) -> bool:
    """Whether a stretch of zeros of an irradiance is one over which the sun never rises.

    Parameters
    ----------
    part : Stretch
        Of the quality of a record.
    record : WeatherRecord
        With the place of the weather.
    """
    if part.channel not in RADIATION or part.kind not in ("stuck", "forward_filled") or record.site is None:
        return False
    first, last = part.start.timestamp(), part.end.timestamp()
    grid = record.grid
    rows = slice(
        *np.round((np.array([first, last + grid.interval]) - grid.start) / grid.interval).astype(int)
    )
    if np.any(record.columns[part.channel][rows] != 0.0):
        return False
    # The first and the last day may have a little sun beside the zeros.
    sun = sun_over(record, record.site.latitude, record.site.longitude, (first, last))
    return bool(np.mean(sun.vector(np.arange(first, last, 1800.0))[:, 2] > -_DARK) < 0.02)


def _name(record: WeatherRecord) -> str:
    return next(name for name in reversed(RADIATION) if name in record.columns)


def _radiation(record: WeatherRecord) -> Array | None:
    if not any(name in record.columns for name in RADIATION):
        return None
    values = record.columns[_name(record)]
    values = np.maximum(np.nan_to_num(values), 0.0)
    return values if values.sum() > 0.0 else None


def _night_part(values: Array, sun: Sun, middle: Array, interval: float) -> float:
    """Part of the radiation in intervals that are dark from start to end. [-]"""
    highest = np.max([sun.vector(middle + part * interval)[:, 2] for part in (-0.5, 0.0, 0.5)], axis=0)
    return float(values[highest < _DARK].sum() / values.sum())


def _turns(values: Array, vector: Array, latitude: float) -> npt.NDArray[np.complex128]:
    """Radiation of each row as a number whose argument is the hour angle of the sun. [W/m2]"""
    sine, cosine = np.sin(np.radians(latitude)), np.cos(np.radians(latitude))
    angle = np.arctan2(-vector[:, 0], cosine * vector[:, 2] - sine * vector[:, 1])
    return np.asarray(values * np.exp(1j * angle))


def _refuse_jump(record: WeatherRecord, middle: Array, turns: npt.NDArray[np.complex128]) -> None:
    """Refuse a record whose radiation moves by about an hour against the sun from one day to the next."""
    grid = record.grid
    noon = float(middle[0])
    day = np.floor((middle - noon) / 86400.0).astype(np.int64)
    days = np.zeros(day[-1] + 1, dtype=np.complex128)
    np.add.at(days, day, turns)
    size = np.abs(days)
    if len(days) < 2 * _FEWEST_DAYS or not size.any():
        return
    # A bright day counts no more than a usual one.
    usual = float(np.median(size[size > 0.0]))
    days *= np.minimum(1.0, usual / np.maximum(size, 1e-9))
    total = np.concatenate([[0.0], np.cumsum(days)])
    split = np.arange(_FEWEST_DAYS, len(days) - _FEWEST_DAYS + 1)
    before = total[split] - total[np.maximum(split - _MOST_DAYS, 0)]
    after = total[np.minimum(split + _MOST_DAYS, len(days))] - total[split]
    jumps = np.degrees(np.angle(after * np.conj(before))) / 15.0
    worst = int(np.argmax(np.abs(jumps)))
    jump = float(jumps[worst])
    if abs(jump) < _JUMP:
        return
    when = stamps_of(np.array([noon + 86400.0 * float(split[worst])]), grid.zone)[0]
    fixed = fixed_offset(grid.zone)
    advice = (
        "The clock of the file probably follows daylight saving time: state the zone of the place, such as "
        f"timezone: Europe/Paris, instead of {zone_name(grid.zone)}."
        if fixed
        else "The clock of the file probably does not follow daylight saving time: state its offset, such as "
        f"timezone: {zone_name(fixed_zone(standard_offset(grid.zone, when.year).total_seconds() / 3600.0))}."
    )
    raise InputError(
        f"{record.file}: the radiation moves by {abs(jump):.1f} h against the sun about {when:%Y-%m-%d} "
        f"({'later' if jump > 0.0 else 'earlier'} from then on), expected less than {_JUMP:g} h. {advice} "
        "If it "
        "does not, the clock of the logger was set: repair the stamps, or read the "
        "record as it is with check_sun: false (on the command line --no-check-sun, in Python "
        "check_sun=False)."
    )
