"""A climate shifted and stretched by monthly changes, such as those of a warmer climate.

The temperature is shifted by its monthly change and stretched around the mean of the month, such that its
daily maxima and minima change as stated. Radiation and wind are stretched. The relative humidity is shifted;
where no change is given it stays as it is, and the dew point follows. The radiation of the sky grows as the
fourth power of the air temperature. Hours, clouds and the order of the days stay.

References
----------
Belcher, Hacker & Powell 2005, Constructing design weather data for future climates, Building Services
Engineering Research and Technology 26(1), 49-61, doi:10.1191/0143624405bt112oa.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from mascarin._io.arguments import require_type
from mascarin._io.regular import require_regular
from mascarin._io.tables import read_csv
from mascarin.errors import InputError, did_you_mean
from mascarin.physics import KELVIN, dew_point, humidity_of_dew_point
from mascarin.weather.climate import Climate
from mascarin.weather.records.channels import RADIATION

if TYPE_CHECKING:
    import pandas as pd

Floats = npt.NDArray[np.float64]
Monthly = float | Sequence[float]

_KELVIN: Final = KELVIN
#: Lowest and highest change that is believed, and its unit.
_LIMITS: Final = {
    "temperature": (-20.0, 20.0, "K"),
    "daily_maximum": (-20.0, 20.0, "K"),
    "daily_minimum": (-20.0, 20.0, "K"),
    "relative_humidity": (-60.0, 60.0, "percentage points"),
    "radiation": (-60.0, 60.0, "%"),
    "wind_speed": (-90.0, 200.0, "%"),
}


@dataclass(frozen=True)
class MonthlyChanges:
    """Changes of a climate, one number for the year or twelve for its months.

    Attributes
    ----------
    temperature : float or sequence of float
        Change of the mean temperature. [K]
    daily_maximum, daily_minimum : float or sequence of float, optional
        Change of the mean of the daily maxima and minima; both or none. [K]
    relative_humidity : float or sequence of float
        Change of the relative humidity. [percentage points]
    radiation : float or sequence of float
        Change of the solar radiation, of all its parts alike. [%]
    wind_speed : float or sequence of float
        Change of the wind speed. [%]

    Examples
    --------
    >>> MonthlyChanges(temperature=2.0).of("temperature")[[0, 6]]
    array([2., 2.])
    """

    temperature: Monthly = 0.0
    daily_maximum: Monthly | None = None
    daily_minimum: Monthly | None = None
    relative_humidity: Monthly = 0.0
    radiation: Monthly = 0.0
    wind_speed: Monthly = 0.0

    def __post_init__(self) -> None:
        for key in _LIMITS:
            self.of(key)
        if (self.daily_maximum is None) != (self.daily_minimum is None):
            raise InputError(
                "changes: found one of daily_maximum and daily_minimum; expected both, or none of them"
            )

    def of(self, key: str) -> Floats:
        """The changes of the twelve months; NaN where none is given.

        Parameters
        ----------
        key : str
            One of the attributes.

        Returns
        -------
        ndarray, shape (12,)
            From January on. [unit of the change]
        """
        changes, (low, high, unit) = getattr(self, key), _LIMITS[key]
        if changes is None:
            return np.full(12, np.nan)
        try:
            numbers = np.asarray(changes, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"changes: {key}: found {changes!r}; expected numbers [{unit}]") from None
        if numbers.ndim > 1 or numbers.size not in (1, 12):
            raise InputError(
                f"changes: {key}: found {numbers.size} numbers; expected one, or twelve from January to "
                f"December [{unit}]"
            )
        wrong = numbers[~((numbers >= low) & (numbers <= high))]
        if wrong.size:
            raise InputError(
                f"changes: {key}: found {wrong[0]:g}; expected a change from {low:g} to {high:g} {unit}"
            )
        return np.broadcast_to(numbers.ravel(), (12,)).copy()

    @classmethod
    def read(cls, path: str | Path) -> MonthlyChanges:
        r"""Read a table of monthly changes.

        Parameters
        ----------
        path : str or Path
            CSV file: a column ``month`` from 1 to 12, and columns named as the attributes.

        Returns
        -------
        MonthlyChanges
            The changes.

        Raises
        ------
        InputError
            The file cannot be read, a column is not known, or the months are not complete.

        Examples
        --------
        >>> import tempfile
        >>> file = Path(tempfile.mkdtemp()) / "changes.csv"
        >>> rows = "\n".join(f"{month},{1.5 + 0.1 * month}" for month in range(1, 13))
        >>> size = file.write_text("month,temperature\n" + rows)
        >>> float(MonthlyChanges.read(file).of("temperature")[11].round(1))
        2.7
        """
        file = Path(path)
        require_regular(file)
        try:
            table = read_csv(file, comment="#", skipinitialspace=True)
        except FileNotFoundError:
            raise InputError(f"{path}: no such file; give the path from the folder you work in.") from None
        except (ValueError, OSError) as error:  # errors of the parser are values
            raise InputError(f"{path}: cannot be read as a CSV table: {error}") from None
        table.columns = [str(name).strip() for name in table.columns]
        columns = [field.name for field in fields(cls)]
        for name in table.columns:
            if name != "month" and name not in columns:
                raise InputError(
                    f"{path}:1: found the column '{name}'; expected month and some of {', '.join(columns)}. "
                    f"{did_you_mean(name, columns, known=False)}".rstrip()
                )
        months = sorted(table["month"].tolist()) if "month" in table else []
        if months != list(range(1, 13)):
            raise InputError(
                f"{path}: found {len(table)} rows with the months {months[:14]}; expected a column month "
                "with each month from 1 to 12 once"
            )
        ordered = table.set_index("month").sort_index()
        try:
            return cls(**{str(name): [float(x) for x in ordered[name]] for name in ordered.columns})
        except (InputError, ValueError, TypeError) as error:
            raise InputError(f"{path}: {error}") from None


def morphed(climate: Climate, changes: MonthlyChanges | Mapping[str, Monthly]) -> Climate:
    """A climate shifted and stretched by monthly changes.

    Parameters
    ----------
    climate : Climate
        The climate of today.
    changes : MonthlyChanges or mapping
        Changes by month.

    Returns
    -------
    Climate
        The changed climate; its provenance says what was changed.

    Raises
    ------
    InputError
        A change is not known or not believed, or the climate has no air temperature.

    Examples
    --------
    >>> warmer = morphed(Climate.shipped("tampa"), MonthlyChanges(temperature=2.0))
    >>> shift = warmer.data["air_temperature"] - Climate.shipped("tampa").data["air_temperature"]
    >>> float(shift.mean().round(6))
    2.0
    """
    require_type("climate", climate, Climate, "a mascarin.Climate")
    if isinstance(changes, Mapping):
        wrong = [key for key in changes if key not in _LIMITS]
        if wrong:
            raise InputError(f"changes: found '{wrong[0]}'; {did_you_mean(str(wrong[0]), _LIMITS)}".rstrip())
        changes = MonthlyChanges(**changes)
    record, data = climate.record, climate.data
    month = np.asarray(data.index.month) - 1  # type: ignore[attr-defined]
    closing = dict(record.closing)
    before = data["air_temperature"].to_numpy(dtype=np.float64)
    after = _temperature(data, month, before, changes)
    warmed = {"air_temperature": after}
    if "dew_point" in data:
        humid = humidity_of_dew_point(before, data["dew_point"].to_numpy(dtype=np.float64))
        humid = np.clip(humid + changes.of("relative_humidity")[month], 1.0, 100.0)
        warmed["dew_point"] = dew_point(after, humid)
    if "infrared" in data:
        ratio = (after + _KELVIN) / (before + _KELVIN)
        warmed["infrared"] = data["infrared"].to_numpy(dtype=np.float64) * ratio**4
    factor = 1.0 + changes.of("radiation")[month] / 100.0
    for name in RADIATION:
        if name in data:
            warmed[name] = data[name].to_numpy(dtype=np.float64) * factor
    if "wind_speed" in data:
        speed = 1.0 + changes.of("wind_speed")[month] / 100.0
        warmed["wind_speed"] = data["wind_speed"].to_numpy(dtype=np.float64) * speed
    for name, values in warmed.items():
        if name in closing:
            # A typical year ends with the value that it starts with.
            last = _closed(name, closing[name], data, values)
            closing[name] = float(values[0]) if record.grid.periodic else last
    note = f"{record.file}: changed by months (Belcher et al. 2005): {_in_words(changes)}."
    columns, notes = {**record.columns, **warmed}, (*record.provenance, note)
    return Climate(replace(record, columns=columns, closing=closing, provenance=notes, sha256=None))


def _temperature(
    data: pd.DataFrame, month: npt.NDArray[np.int64], before: Floats, changes: MonthlyChanges
) -> Floats:
    """``T + dT + a (T - mean of the month)``, with ``a`` from the change of the daily range."""
    shift = changes.of("temperature")[month]
    if changes.daily_maximum is None:
        return before + shift
    series = data["air_temperature"]
    days = series.groupby([month, np.asarray(data.index.day)])  # type: ignore[attr-defined]
    ranges = (days.max() - days.min()).groupby(level=0).mean()
    means = series.groupby(month).mean()
    wider = changes.of("daily_maximum") - changes.of("daily_minimum")
    stretch = np.array([wider[m] / ranges[m] if m in ranges and ranges[m] > 0.0 else 0.0 for m in range(12)])
    middle = np.array([means.get(m, math.nan) for m in range(12)])
    return np.asarray(before + shift + stretch[month] * (before - middle[month]), dtype=np.float64)


def _closed(name: str, closing: float, data: pd.DataFrame, after: Floats) -> float:
    """The value at the end of the record, changed as the last value before it."""
    last, changed = float(data[name].iloc[-1]), float(after[-1])
    if name in ("air_temperature", "dew_point"):
        return closing + changed - last
    return closing * changed / last if last else closing


def _in_words(changes: MonthlyChanges) -> str:
    said = []
    for key, (_, _, unit) in _LIMITS.items():
        values = changes.of(key)
        if np.isfinite(values).all() and (values != 0.0).any():
            low, high = float(values.min()), float(values.max())
            amount = f"{low:+g}" if low == high else f"{low:+g} to {high:+g}"
            said.append(f"{key.replace('_', ' ')} {amount} {unit}")
    return ", ".join(said) or "by nothing"
