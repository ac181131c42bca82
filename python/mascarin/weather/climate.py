"""The climate of a site: weather on a regular grid, and the forcing that the engine takes from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol, cast

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.arrays import Array, Lines
from mascarin.weather.channels import BY_NAME, RADIATION, SOURCE_CHANNELS, Kind
from mascarin.weather.grid import Grid
from mascarin.weather.radiation import Basis
from mascarin.weather.table import Column, Stamps, read_table
from mascarin.weather.timezones import zone_name

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.weather.measurements import Measurements
    from mascarin.weather.quality import Stretch


NEUTRAL: Final[Mapping[str, float]] = {
    "dew_point": np.nan,
    "relative_humidity": 70.0,
    "wind_speed": 0.0,
    "wind_direction": 0.0,
    "direct_normal": 0.0,
    "diffuse_horizontal": 0.0,
    "global_horizontal": 0.0,
    "cloud_cover": 0.0,
    "infrared": np.nan,
    "pressure": np.nan,
}
"""Values taken for channels that a table does not hold, once the user has stated that they are absent."""

_NAMES: Final = (*SOURCE_CHANNELS, "relative_humidity")
_FREE: Final = ("infrared", "pressure", "cloud_cover")


class SiteLike(Protocol):
    """Anything with a place on the earth; a building's site is one."""

    @property
    def latitude(self) -> float:
        """Positive north [deg]."""
        ...

    @property
    def longitude(self) -> float:
        """Positive east [deg]."""
        ...


@dataclass(frozen=True)
class Place:
    """A place on the earth.

    Attributes
    ----------
    latitude, longitude : float
        Positive north and east [deg].
    altitude : float
        Height above the sea [m].
    name : str
        Name of the station.
    """

    latitude: float
    longitude: float
    altitude: float = 0.0
    name: str = ""


@dataclass(frozen=True, eq=False)
class Climate:
    """Weather on a regular grid of intervals.

    Made by `from_epw`, `from_tmy` or `from_table`; never changed afterwards.

    Attributes
    ----------
    data : pandas.DataFrame
        One row for each interval, labelled by its start in the climate's time zone. An `instant` column holds
        the value at the label, a `mean` column the mean over the interval that starts there. Columns are
        climate channels, then measured columns by their own names.
    kinds : mapping of str to str
        `instant` or `mean` for each column.
    grid : Grid
        The intervals.
    closing : mapping of str to float
        Values of the instant columns at the end of the record.
    site : Place or None
        Where the weather was measured, if known.
    file : str
        File name, or `table`.
    sha256 : str or None
        Hash of the file.
    provenance : tuple of str
        What was read, converted, derived and assumed, as sentences.
    lines : ndarray
        Line of each row in the file; 0 where the row was missing.
    check_sun : bool
        Refuse radiation that does not follow the sun.
    knots : ndarray, optional
        Line of the instants at the start of each interval and at the end of the last; without it that of
        the row, shape (n + 1,).
    of_year : bool
        Read from a weather file of a year, whose clock is that of its place.
    elsewhere : bool
        May be used for a building at another place than where it was measured.
    """

    data: pd.DataFrame
    kinds: Mapping[str, Kind]
    grid: Grid
    closing: Mapping[str, float]
    site: Place | None
    file: str
    sha256: str | None
    provenance: tuple[str, ...]
    lines: Lines
    check_sun: bool = True
    knots: Lines | None = None
    of_year: bool = False
    elsewhere: bool = False
    _ready: dict[tuple[float, float], Climate] = field(default_factory=dict, repr=False)

    # ------------------------------------------------------------------ readers

    @classmethod
    def from_epw(
        cls,
        path: str | Path,
        *,
        typical: bool | None = None,
        year: int | None = None,
        elsewhere: bool = False,
    ) -> Climate:
        """Read an EnergyPlus weather file.

        Parameters
        ----------
        path : path
            The file; hourly, one year.
        typical : bool, optional
            True: the year stands for any year and wraps at its end. False: it is the calendar year that it
            says. Default: True where the file's months come from different years.
        year : int, optional
            Year to label a typical file with; default 2001.
        elsewhere : bool
            The weather may be used for a building at another place, which is otherwise refused.

        Returns
        -------
        Climate
            The weather, with its site.

        Raises
        ------
        InputError
            The file is damaged; the line is named.
        """
        from mascarin.weather.readers import read_epw
        from mascarin.weather.yearly import climate_of

        return replace(climate_of(read_epw(Path(path)), typical, year), elsewhere=elsewhere, _ready={})

    @classmethod
    def from_tmy(
        cls,
        path: str | Path,
        *,
        typical: bool | None = None,
        year: int | None = None,
        elsewhere: bool = False,
    ) -> Climate:
        """Read a TMY3 CSV file.

        Parameters, result and errors are those of `from_epw`. TMY3 gives no infrared: that channel is NaN.
        """
        from mascarin.weather.readers import read_tmy3
        from mascarin.weather.yearly import climate_of

        return replace(climate_of(read_tmy3(Path(path)), typical, year), elsewhere=elsewhere, _ready={})

    @classmethod
    def from_table(
        cls,
        source: str | Path | pd.DataFrame,
        *,
        timezone: str | None = None,
        columns: Mapping[str, str | Column | Mapping[str, object]],
        extra: Iterable[str] | Mapping[str, str | Column | Mapping[str, object]] = (),
        absent: Iterable[str] | Mapping[str, float] = (),
        stamps: Stamps = "start",
        instant: Iterable[str] = (),
        mean: Iterable[str] = (),
        step: str | float | None = None,
        time: str | Sequence[str] | None = None,
        time_format: str | None = None,
        separator: str | None = None,
        decimal: str = ".",
        skip_lines: int = 0,
        missing: Sequence[str | float] = (),
        latitude: float | None = None,
        longitude: float | None = None,
        altitude: float = 0.0,
        check_sun: bool = True,
    ) -> Climate:
        """Read a measured table: CSV, Parquet or a pandas frame with any regular step.

        Parameters
        ----------
        source : path or pandas.DataFrame
            The table.
        timezone : str
            IANA name or fixed offset (`UTC+4`) of the stamps. Required.
        columns : mapping
            Climate channel -> column name, or `{column, unit, scale, offset, kind}`. Beside the channels,
            `relative_humidity` [%] is understood; the dew point follows from it.
        extra : iterable or mapping
            Further measured columns to carry along for boundaries and irradiances on planes, by their names.
        absent : iterable or mapping
            Channels that the table does not hold; a neutral value (`NEUTRAL`) is taken, or the one given
            here. Infrared, pressure and cloud cover need not be stated.
        stamps : str
            `start` or `end`: which end of its interval a stamp marks. Means are moved to the start; spot
            values stay at their stamp.
        instant, mean : iterable of str
            Channels or extra columns that differ from the usual kind (radiation and infrared are means, the
            rest instants).
        step : str or float, optional
            Expected step; default: found.
        time, time_format, separator, decimal, skip_lines, missing
            As in `read_table`.
        latitude, longitude : float, optional
            Place of the measurement, positive north and east [deg].
        altitude : float
            Height above the sea [m].
        check_sun : bool
            Refuse radiation that does not follow the sun at the place where it is used.

        Returns
        -------
        Climate
            The weather. What has to be derived with the sun is derived when the place is known.

        Raises
        ------
        InputError
            A column or the time zone is missing, a unit or a time cannot be used.
        """
        from mascarin.weather.measured import climate_of

        table = read_table(
            source, timezone=timezone, time=time, time_format=time_format, separator=separator,
            decimal=decimal, skip_lines=skip_lines, step=step, missing=missing,
        )  # fmt: skip
        climate = climate_of(table, columns, extra, absent, stamps, instant, mean)
        climate = replace(climate, check_sun=check_sun, _ready={})
        if latitude is None or longitude is None:
            return climate
        return replace(climate, site=Place(latitude, longitude, altitude), _ready={}).completed()

    # ------------------------------------------------------------------ what it says of itself

    @property
    def index(self) -> pd.DatetimeIndex:
        """Starts of the intervals, with the time zone."""
        return cast("pd.DatetimeIndex", self.data.index)

    @property
    def timezone(self) -> str:
        """Time zone of the labels."""
        return zone_name(self.grid.zone)

    @property
    def step_seconds(self) -> float:
        """Length of a source interval [s]."""
        return self.grid.interval

    def quality(self) -> list[Stretch]:
        """Suspicious stretches of every column that was measured; see `quality.find`."""
        from mascarin.weather.quality import find

        return find(
            self.data, self.kinds, limits={name: (BY_NAME[name].low, BY_NAME[name].high) for name in BY_NAME}
        )

    def fill_gaps(self, longest: str | float, columns: Iterable[str] | None = None) -> Climate:
        """Fill short gaps linearly.

        Parameters
        ----------
        longest : str or float
            Longest gap to fill, such as `2h` or seconds [s].
        columns : iterable of str, optional
            Default: all.

        Returns
        -------
        Climate
            A new climate, whose provenance lists what was filled.
        """
        from mascarin.weather.gaps import filled

        return filled(self, longest, columns)

    # ------------------------------------------------------------------ what needs the sun

    def completed(self, site: SiteLike | None = None) -> Climate:
        """The climate with all channels that can be derived from the others and the sun.

        Parameters
        ----------
        site : object with latitude and longitude, optional
            Default: the climate's own site.

        Returns
        -------
        Climate
            With direct, diffuse and global irradiance and cloud cover; NaN stays NaN.

        Raises
        ------
        InputError
            There is no site, or the radiation does not follow the sun there.
        """
        from mascarin.weather.completion import complete
        from mascarin.weather.sun_check import check_clock

        place = site if site is not None else self.site
        if place is None:
            raise InputError(
                f"{self.file}: latitude and longitude are needed to derive radiation from what was measured."
            )
        key = (float(place.latitude), float(place.longitude))
        if key not in self._ready:
            if self.check_sun:
                check_clock(self, *key)
            self._ready[key] = complete(self, *key)
        return self._ready[key]

    def radiation_basis(self) -> Basis:
        """The irradiances whose means are kept; a third that is not given follows from two and the sun."""
        if all(name in self.data.columns for name in RADIATION):
            return "all"
        return "direct+diffuse" if "direct_normal" in self.data.columns else "global+diffuse"

    def forcing(
        self,
        site: SiteLike,
        start: object,
        end: object,
        step_seconds: float,
        scheme: str = "sdirk2",
        channels: Sequence[str] = (),
        measurements: Measurements | None = None,
        limits: Mapping[str, tuple[float, float]] | None = None,
    ) -> Array:
        """The engine's forcing; see `forcing.forcing`."""
        from mascarin.weather.forcing import forcing

        return forcing(self, site, start, end, step_seconds, scheme, channels, measurements, limits)


def summary(climate: Climate) -> dict[str, Any]:
    """What a report prints of a climate: file, hash, range, step, site and provenance.

    The provenance includes what was derived for the place where the climate was last used.
    """
    place = climate.site
    used = list(climate._ready.values())[-1:] or [climate]
    return {
        "file": climate.file,
        "sha256": climate.sha256,
        "range": climate.grid.span(),
        "step_seconds": climate.grid.interval,
        "timezone": climate.timezone,
        "site": None if place is None else {"latitude": place.latitude, "longitude": place.longitude,
                                           "altitude": place.altitude, "name": place.name},
        "provenance": list(used[0].provenance),
    }  # fmt: skip
