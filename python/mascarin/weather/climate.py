"""The climate of a site: weather on a regular grid of times.

Long because every way to make a climate is described with its parameters and an example.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mascarin._io.arguments import require_type
from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Halvings
from mascarin.tables.quality import Stretch, find
from mascarin.tables.quality.gaps import filled
from mascarin.tables.reading.files import file_hash
from mascarin.tables.reading.table import Stamps, read_table
from mascarin.tables.reading.table_cache import cached_record
from mascarin.tables.steps import Steps
from mascarin.weather.archives.tmy2 import ENDING, read_tmy2
from mascarin.weather.checks.brightness import bright_parts, with_findings, with_notes
from mascarin.weather.checks.missing_infrared import with_whole_infrared
from mascarin.weather.checks.place_check import require_place
from mascarin.weather.checks.sun_check import check_clock, is_polar_night
from mascarin.weather.derived import derive
from mascarin.weather.derived.completion import complete
from mascarin.weather.forcing import forcing, require_period
from mascarin.weather.reading import measured
from mascarin.weather.reading.measured import Columns, record_of_table
from mascarin.weather.reading.measurements import Measurements
from mascarin.weather.reading.pvlib_frames import PvlibStamps, record_of_pvlib
from mascarin.weather.reading.readers import read_epw, read_tmy3
from mascarin.weather.reading.shipped import PREFIX, found
from mascarin.weather.reading.yearly import record_of_year, shifted
from mascarin.weather.records.channels import LIMITS
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import Place, SiteLike
from mascarin.weather.records.view import RecordView

if TYPE_CHECKING:
    import pandas as pd


class Climate(RecordView[WeatherRecord]):
    """Weather on a regular grid of times.

    Made by `from_epw`, `from_tmy`, `from_table` or `from_pvlib`; never changed afterwards. Times follow the
    rule in `mascarin.weather`. Columns are the channels of `mascarin.weather.CHANNELS` that were found, then
    measured columns by their own names.

    Parameters
    ----------
    record : WeatherRecord
        The columns with their origin; use one of the functions above.

    Examples
    --------
    >>> import pandas as pd
    >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="UTC")
    >>> climate = Climate.from_table(
    ...     pd.DataFrame({"T": [12.0, 13.0, 15.0, 16.0]}, index=index),
    ...     columns={"air_temperature": "T"},
    ...     absent=["radiation", "dew_point", "wind_speed", "wind_direction"],
    ... )
    >>> climate.to_dataframe()["air_temperature"].tolist()
    [12.0, 13.0, 15.0, 16.0]
    """

    def __init__(self, record: WeatherRecord) -> None:
        super().__init__(record)
        self._completed: dict[tuple[float, float], Climate] = {}

    @classmethod
    def from_epw(
        cls,
        path: str | Path,
        *,
        typical: bool | None = None,
        year: int | None = None,
        elsewhere: bool = False,
        check_sun: bool = True,
        shift: str | float | None = None,
    ) -> Climate:
        r"""Read an EnergyPlus weather file (EPW).

        Parameters
        ----------
        path : str or Path
            The file; hourly, one year; or ``shipped:NAME`` of a climate that comes with Mascarin.
        typical : bool, optional
            True: a typical year, which represents any year and is repeated at its end. False: the calendar
            year in the file. Default: True where the months of the file come from different years.
        year : int, optional
            Year by which a typical file is labeled; default 2001.
        elsewhere : bool
            Allow a building at another place, which is otherwise refused.
        check_sun : bool
            Refuse radiation that does not follow the sun.
        shift : str or float, optional
            Added to all times of the file, such as `-30min`. [s]

        Returns
        -------
        Climate
            The weather, with its site.

        Raises
        ------
        InputError
            The file is damaged; the text names the line.

        Notes
        -----
        Stamps mark the end of an hour: radiation is the mean of the hour before, all other quantities are
        values at the stamp ("EnergyPlus Auxiliary Programs", Data Dictionary).

        Examples
        --------
        A file with the same weather in every hour, to have one to read:

        >>> import pandas as pd, tempfile
        >>> hour = "20.0,10.0,52,101325,0,0,300,0,0,0,0,0,0,0,180,2.0,5,5" + 11 * ",0"
        >>> lines = ["LOCATION,Lyon,-,FRA,-,-,45.8,4.8,1.0,170.0", *6 * ["-"], "DATA PERIODS,1,1"]
        >>> for t in pd.date_range("2023-01-01", periods=8760, freq="1h"):
        ...     lines.append(f"{t.year},{t.month},{t.day},{t.hour + 1},0,-,{hour}")
        >>> path = Path(tempfile.mkdtemp()) / "lyon.epw"
        >>> size = path.write_text("\n".join(lines))
        >>> climate = Climate.from_epw(path)
        >>> climate.site.altitude, climate.timezone, len(climate.to_dataframe())
        (170.0, 'UTC+1', 8760)
        """
        require_type("path", path, (str, Path), "the path of an EPW file")
        record = record_of_year(read_epw(found(path)), typical, year, elsewhere)
        return cls(replace(shifted(record, shift), check_sun=check_sun))

    @classmethod
    def shipped(cls, name: str, *, elsewhere: bool = False) -> Climate:
        """A climate that comes with Mascarin, such as ``tampa``: `mascarin weather` lists them."""
        return cls.from_epw(f"{PREFIX}{name}", elsewhere=elsewhere)

    @classmethod
    def from_tmy(
        cls,
        path: str | Path,
        *,
        typical: bool | None = None,
        year: int | None = None,
        elsewhere: bool = False,
        check_sun: bool = True,
        shift: str | float | None = None,
    ) -> Climate:
        """Read a TMY3 CSV file, or a TMY2 file (.tm2).

        Parameters
        ----------
        path : str or Path
            The file; hourly, one year. A TMY2 file is always a typical year.
        typical, year, elsewhere, check_sun, shift
            As in `from_epw`.

        Returns
        -------
        Climate
            The weather, with its site. TMY3 has no infrared radiation; the engine estimates it.

        Raises
        ------
        InputError
            The file is damaged; the text names the line.

        Examples
        --------
        >>> import pvlib
        >>> climate = Climate.from_tmy(Path(pvlib.__file__).parent / "data" / "723170TYA.CSV")
        >>> climate.site.latitude, climate.timezone
        (36.1, 'UTC-5')
        """
        require_type("path", path, (str, Path), "the path of a TMY3 or TMY2 file")
        if Path(path).suffix.lower() == ENDING:
            pvlib_record = record_of_pvlib(
                read_tmy2(Path(path)), latitude=None, longitude=None, altitude=None, stamps="end",
                typical=True, timezone=None, absent=(),
            )  # fmt: skip
            record = replace(
                pvlib_record, file=Path(path).name, sha256=file_hash(Path(path)), elsewhere=elsewhere
            )
            return cls(replace(shifted(record, shift), check_sun=check_sun)).completed()
        record = record_of_year(read_tmy3(Path(path)), typical, year, elsewhere)
        return cls(replace(shifted(record, shift), check_sun=check_sun))

    @classmethod
    def from_table(
        cls,
        source: str | Path | pd.DataFrame,
        *,
        timezone: str | None = None,
        columns: Columns,
        extra: Iterable[str] | Columns = (),
        absent: Iterable[str] | Mapping[str, float] = (),
        stamps: Stamps = "start",
        instant: Iterable[str] = (),
        mean: Iterable[str] = (),
        step: str | float | None = None,
        time: str | Sequence[str] | None = None,
        time_format: str | None = None,
        separator: str | None = None,
        decimal: str | None = None,
        skip_lines: int | None = None,
        missing: Sequence[str | float] = (),
        tolerance: str | float | None = None,
        shift: str | float | None = None,
        latitude: float | None = None,
        longitude: float | None = None,
        altitude: float = 0.0,
        check_sun: bool = True,
    ) -> Climate:
        """Read a measured table with any regular step: a CSV or Parquet file, or a pandas frame.

        Parameters
        ----------
        source : str, Path or pandas.DataFrame
            The table.
        timezone : str, optional
            IANA name (`Europe/Paris`) or fixed offset (`UTC+4`) of the stamps. Required, except for a
            frame whose stamps have a time zone.
        columns : mapping
            Channel -> name of its column, or `{column, unit, scale, offset, kind, overrule}`, or a `Column`.
            Beside
            the channels, `relative_humidity` [%] is understood; the dew point is computed from it.
        extra : iterable or mapping
            Further measured columns, by their names: temperatures of boundaries, irradiances on planes.
        absent : iterable or mapping
            Channels that the table does not hold; a neutral value is assumed, or the one given here.
            Infrared, pressure and cloud cover need not be stated.
        stamps : str
            `start` or `end`: which end of its interval a stamp marks. Means are moved to the start; values
            at the stamp stay there.
        instant, mean : iterable of str
            Columns whose kind differs from the usual one (radiation and infrared are means, the rest
            instants).
        step : str or float, optional
            Expected step; default: derived from the stamps.
        time : str or list of str, optional
            Column with the stamps; several are joined by a space. Default: the first column, or the index.
        time_format : str, optional
            strptime format of the stamps; default ISO 8601.
        separator : str, optional
            Between the entries of a CSV file; default: derived from the header.
        decimal : str, optional
            Decimal mark.
        skip_lines : int
            Lines before the header.
        missing : sequence
            Entries that mean that there is no value, beside the empty one.
        tolerance : str or float
            Largest deviation of a stamp from the regular grid, to which it is moved; default a tenth of the
            step. [s]
        shift : str or float, optional
            Added to every stamp, such as `-30min` where the clock of the logger was half an hour fast. [s]
        latitude, longitude : float, optional
            Place of the measurement, positive north and east. [deg]
        altitude : float
            Height above sea level. [m]
        check_sun : bool
            Refuse radiation that does not follow the sun at the place where it is used.

        Returns
        -------
        Climate
            The weather. Missing irradiances are derived as soon as the place is known.

        Raises
        ------
        InputError
            A column or the time zone is missing, or a unit or a time cannot be used.

        Examples
        --------
        >>> import pandas as pd
        >>> logger = pd.DataFrame(
        ...     {
        ...         "time": ["2024-06-01 00:00", "2024-06-01 01:00", "2024-06-01 02:00"],
        ...         "T": [285.15, 286.15, 287.15],
        ...         "RH": [80.0, 75.0, 70.0],
        ...     }
        ... )
        >>> climate = Climate.from_table(
        ...     logger,
        ...     timezone="Europe/Paris",
        ...     columns={"air_temperature": {"column": "T", "unit": "K"}, "relative_humidity": "RH"},
        ...     absent={"radiation": 0.0, "wind_speed": 1.0, "wind_direction": 0.0},
        ... )
        >>> climate.to_dataframe()["air_temperature"].round(2).tolist()
        [12.0, 13.0, 14.0]
        """
        reading: dict[str, Any] = {
            "time": time, "time_format": time_format, "separator": separator, "decimal": decimal,
            "skip_lines": skip_lines, "step": step, "missing": missing, "tolerance": tolerance,
            "shift": shift,
        }  # fmt: skip
        further, gone = (
            entries if isinstance(entries, Mapping) else tuple(entries) for entries in (extra, absent)
        )
        choice = (columns, further, gone, stamps, tuple(instant), tuple(mean))
        record = cached_record(
            WeatherRecord, source, timezone, (reading, *choice), [measured, derive],
            lambda: record_of_table(read_table(source, timezone=timezone, **reading), *choice),
        )  # fmt: skip
        return cls(replace(record, check_sun=check_sun))._at_site(latitude, longitude, altitude)

    @classmethod
    def from_pvlib(
        cls,
        data: pd.DataFrame | tuple[pd.DataFrame, Mapping[str, Any]],
        *,
        latitude: float | None = None,
        longitude: float | None = None,
        altitude: float | None = None,
        stamps: PvlibStamps | None = None,
        typical: bool | None = None,
        timezone: str | None = None,
        absent: Iterable[str] | Mapping[str, float] = (),
        check_sun: bool = True,
    ) -> Climate:
        """Take weather that a function of `pvlib.iotools` has read.

        Parameters
        ----------
        data : pandas.DataFrame or (pandas.DataFrame, dict)
            Frame with the names of pvlib (``map_variables=True``): `ghi`, `dni`, `dhi`, `temp_air`,
            `relative_humidity` or `temp_dew`, `wind_speed`, `wind_direction`, `pressure`, `longwave_down`
            and the like; or the pair of frame and metadata that the function returns.
        latitude, longitude : float, optional
            Place, positive north and east; default from the metadata. [deg]
        altitude : float, optional
            Height above sea level; default from the metadata, else 0. [m]
        stamps : str, optional
            What a stamp marks: the `start`, `middle` or `end` of the interval over which irradiances are
            means, or `instant` where all values are those at the stamp. It may be left out for frames of
            `read_epw`, `read_tmy3` and `get_era5`, whose stamps are known.
        typical : bool, optional
            True: a typical year, which represents any year. Default: True where months come from different
            years.
        timezone : str, optional
            IANA name or fixed offset of the local time; default that of the stamps.
        absent : iterable or mapping
            Channels that the frame does not hold, as in `from_table`.
        check_sun : bool
            Refuse radiation that does not follow the sun.

        Returns
        -------
        Climate
            The weather, with its site.

        Raises
        ------
        InputError
            A quantity is missing, or it is not known what the stamps mark.

        Notes
        -----
        ======================================  ===========
        Source                                  `stamps`
        ======================================  ===========
        PVGIS, SARAH satellite data             `instant`
        PVGIS, ERA5 data                        `middle`
        NSRDB PSM                               `middle`
        ERA5 (`get_era5`)                       `end`
        TMY3 (`read_tmy3`)                      `end`
        ======================================  ===========

        In frames of `read_epw` a stamp marks the start of the hour, and temperatures, humidity and wind are
        those at the end of the hour; `from_epw` reads the file itself. With `middle`, all values are taken
        as means of the interval around the stamp.

        References
        ----------
        Anderson et al. 2023, pvlib python: 2023 project update, doi:10.21105/joss.05994.

        Examples
        --------
        >>> import pandas as pd
        >>> index = pd.date_range("2024-06-01", periods=48, freq="1h", tz="UTC")
        >>> frame = pd.DataFrame({"temp_air": 15.0, "relative_humidity": 60.0, "ghi": 0.0}, index=index)
        >>> climate = Climate.from_pvlib(
        ...     frame,
        ...     latitude=45.8,
        ...     longitude=4.8,
        ...     stamps="end",
        ...     absent=["wind_speed", "wind_direction"],
        ... )
        >>> climate.index[0].isoformat()
        '2024-05-31T23:00:00+00:00'
        """
        record = record_of_pvlib(
            data, latitude=latitude, longitude=longitude, altitude=altitude, stamps=stamps, typical=typical,
            timezone=timezone, absent=absent,
        )  # fmt: skip
        return cls(replace(record, check_sun=check_sun)).completed()

    @property
    def site(self) -> Place | None:
        """Where the weather was measured, if known."""
        return self.record.site

    def quality(self) -> list[Stretch]:
        """Suspicious parts of every column that was measured: missing, stuck, out of range, spikes.

        Returns
        -------
        list of Stretch
            In order of column, then start; see `mascarin.tables.quality.find`.
        """
        parts = [part for part in find(self.data, limits=LIMITS) if not is_polar_night(part, self.record)]
        return [*parts, *bright_parts(self.record, self.data.index)]

    def fill_gaps(self, longest: str | float, columns: Iterable[str] | None = None) -> Climate:
        """Fill short gaps linearly.

        Parameters
        ----------
        longest : str or float
            Longest gap to fill, such as `2h`, or seconds. [s]
        columns : iterable of str, optional
            Default: all.

        Returns
        -------
        Climate
            A new climate, whose provenance lists what was filled.

        Raises
        ------
        InputError
            There is no such column, or no length can be read.
        """
        return Climate(filled(self.record, longest, columns, hold_end=True))

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
        location = site if site is not None else self.site
        if location is None:
            raise InputError(
                f"{self.file}: latitude and longitude are needed to derive radiation from what was measured."
            )
        key = (float(location.latitude), float(location.longitude))
        if key not in self._completed:
            said = check_clock(self.record, *key) if self.record.check_sun else ()
            filled_record = with_whole_infrared(complete(self.record, *key))
            complete_record = with_findings(filled_record, self.record, *key)
            climate = Climate(with_notes(complete_record, said))
            climate._completed[key] = self._completed[key] = climate
        return self._completed[key]

    @property
    def used(self) -> Climate:
        """The climate as completed for the place where it was last used; itself before that."""
        return list(self._completed.values())[-1] if self._completed else self

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
        further: int = 0,
        halvings: Halvings | None = None,
    ) -> Array:
        """What the engine takes as input: channels at the stages of every step of a period.

        Parameters
        ----------
        site : object with latitude and longitude
            Place of the building.
        start, end : str, datetime or pandas.Timestamp
            Period; without an offset, local time of the climate. A whole number of steps.
        step_seconds : float
            Step. [s]
        scheme : str
            A key of `mascarin.weather.STAGES`.
        channels : sequence of str
            Measured columns to append, from the climate's extra columns or from the measurements.
        measurements : Measurements, optional
            Where to look for columns that the climate does not hold.
        limits : mapping of str to (float, float), optional
            Lowest and highest possible value of measured columns, by their use: `TEMPERATURES`,
            `IRRADIANCES` or `COEFFICIENTS`. [unit of the column]
        further : int
            Channels at the end that the caller fills.
        halvings : ndarray of uint8, shape (steps,), optional
            How often the step is halved for each step that is taken. Default: never.

        Returns
        -------
        ndarray, shape (steps, stages, len(CHANNELS) + len(channels) + further)
            In the units of `CHANNELS`; measured columns in their own. See `mascarin.weather.forcing`.

        Raises
        ------
        InputError
            The climate is of another place, the period is outside the data, a value in it is missing or
            impossible, or a column is unknown.
        """
        require_place(self.record, site)
        steps = Steps.over(self.grid.zone, start, end, step_seconds, scheme, halvings)
        require_period(self.record, steps)
        measured = None if measurements is None else measurements.record
        complete = self.completed(site).record
        return forcing(self.record, complete, site, steps, channels, measured, limits, further)

    def _at_site(self, latitude: float | None, longitude: float | None, altitude: float) -> Climate:
        """The climate at a place, with what can be derived there; as it is where the place is not known."""
        if latitude is None or longitude is None:
            return self
        return Climate(replace(self.record, site=Place(latitude, longitude, altitude))).completed()

    def _rows(self) -> list[tuple[str, str]]:
        location = self.site
        site_text = "not known" if location is None else (
            f"{location.name + ': ' if location.name else ''}{location.latitude:g} deg north, "
            f"{location.longitude:g} deg east, {location.altitude:g} m"
        )  # fmt: skip
        return [("site", site_text), *super()._rows()]
