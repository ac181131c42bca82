"""The keys of a study file that say where weather, measurements and further data sets come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal

from pydantic import Field, model_validator

from mascarin.building.base.part import Part, fault, insist
from mascarin.measurements.time_fields import Duration, Shift
from mascarin.study.file.field_types import Columns, TimeZone

if TYPE_CHECKING:
    from typing import Self

#: Keys of a table that hold for weather and measurements where both are in it.
OF_THE_TABLE: Final = (
    "table", "timezone", "stamps", "separator", "decimal", "time", "time_format", "skip_lines", "missing",
    "tolerance", "shift",
)  # fmt: skip

#: Keys of a study that name files.
FILE_KEYS: Final = ("building", "epw", "tmy", "table", "study")


class TableSource(Part):
    """A table of measured columns."""

    table: str = Field(
        description="CSV or Parquet file, its path starting at the folder of the study, or data:NAME of a "
        "known data set"
    )
    timezone: TimeZone = Field(
        description="Time zone of the stamps: IANA name (Europe/Paris) or offset (UTC+4)"
    )
    stamps: Literal["start", "end"] = Field(
        "start", description="Whether a stamp marks the start or the end of its interval"
    )
    mean: tuple[str, ...] = Field((), description="Columns that are means over their interval")
    separator: str | None = Field(None, description="Column separator; detected by default")
    decimal: str | None = Field(None, description="Decimal mark; detected by default")
    time: str | tuple[str, ...] | None = Field(
        None, description="Time column or columns; detected by default"
    )
    time_format: str | None = Field(None, description="Format of the stamps, as in strptime")
    skip_lines: int | None = Field(
        None, ge=0, description="Lines before the names of the columns; detected by default"
    )
    missing: tuple[str | float, ...] = Field(
        (), description="Entries that mark a missing value, such as -999"
    )
    tolerance: Duration | None = Field(
        None,
        description="Largest deviation of a stamp from the regular grid, to which it is moved; by default a "
        "tenth of the step",
    )
    shift: Shift | None = Field(
        None, description="Added to every stamp, such as -30min where the clock of the logger was fast"
    )
    fill_gaps: Duration | None = Field(
        None,
        description="Gaps up to this length are filled by linear interpolation in the inputs of the model, "
        "never in "
        "the columns of the sensors",
    )
    inspect: tuple[str, ...] = Field(
        (),
        description="Further columns to check for suspicious values; by default all columns of numbers",
    )

    @property
    def options(self) -> dict[str, Any]:
        """Options that every table reader takes."""
        keys = (
            "timezone",
            "stamps",
            "separator",
            "decimal",
            "time",
            "time_format",
            "skip_lines",
            "mean",
            "missing",
            "tolerance",
            "shift",
        )
        return {key: getattr(self, key) for key in keys}


class MeasuredTable(TableSource):
    """A table of measurements, whose columns may have other names in the study and in the building."""

    columns: dict[str, str | dict[str, Any]] = Field(
        default_factory=dict,
        description="Name in the study and in the building -> column of the table; a * in both stands for "
        "the same text, and the longest pattern counts. By default names are those of the table",
    )

    @model_validator(mode="after")
    def _stars(self) -> Self:
        for name, entry in self.columns.items():
            column = entry if isinstance(entry, str) else str(entry.get("column", ""))
            if name.count("*") > 1 or name.count("*") != column.count("*"):
                insist(
                    fault(
                        ("columns", name),
                        f"'{name}' for '{column}'",
                        "at most one *, in both or in none",
                        "Write 'house_*: N2_*', or one name for one column.",
                    )
                )
        return self

    def column_of(self, name: str) -> str | dict[str, Any]:
        """Column of the table for a name of the study, with its unit and more where these are stated."""
        if name in self.columns:
            return self.columns[name]
        for pattern in sorted(self.columns, key=len, reverse=True):
            first, star, last = pattern.partition("*")
            if star and len(name) >= len(first + last) and name.startswith(first) and name.endswith(last):
                text = name[len(first) : len(name) - len(last)]
                entry = self.columns[pattern]
                if isinstance(entry, str):
                    return entry.replace("*", text)
                return {**entry, "column": str(entry["column"]).replace("*", text)}
        return name


class MeasuredWeather(TableSource):
    """Weather from a measured table."""

    columns: dict[str, Columns] = Field(description="Climate channel -> column")
    absent: tuple[str, ...] = Field(
        (), description="Channels that were not measured; they get a neutral value"
    )


def with_shared_table(data: Any) -> Any:
    """Weather and measurements in one table: what one of them says of it holds for the other one too."""
    if not isinstance(data, dict) or not isinstance(data.get("climate"), dict):
        return data
    weather, measured = data["climate"].get("measured"), data.get("measurements")
    measured = {} if measured is None else measured
    if not isinstance(weather, dict) or not isinstance(measured, dict):
        return data
    if "table" in weather and "table" in measured and weather["table"] != measured["table"]:
        return data
    said = {key: value for key, value in (weather | measured).items() if key in OF_THE_TABLE}
    both = {**data["climate"], "measured": {**said, **weather}}
    return {**data, "climate": both, "measurements": {**said, **measured}}


class ClimateSource(Part):
    """Source of the weather data; exactly one kind."""

    epw: str | None = Field(None, description="EPW file, or shipped:NAME of a climate of Mascarin")
    tmy: str | None = Field(None, description="TMY3 file, or TMY2 (.tm2)")
    measured: MeasuredWeather | None = Field(None, description="A measured table")
    check_sun: bool = Field(True, description="Refuse radiation that does not follow the sun of the place")
    shift: Shift | None = Field(
        None, description="Added to all times of a weather file; that of a table is stated beside its columns"
    )

    @model_validator(mode="after")
    def _one(self) -> Self:
        given = [key for key in ("epw", "tmy", "measured") if getattr(self, key) is not None]
        if len(given) != 1:
            insist(fault((), ", ".join(given) or "nothing", "one of epw, tmy, measured", "Keep exactly one."))
        if self.shift is not None and self.measured is not None:
            insist(fault(("shift",), f"{self.shift} beside measured", "the shift of a table under measured",
                         f"Write shift: {self.shift} under measured."))  # fmt: skip
        return self


class Transfer(Part):
    """Another house, season or phase, on which the calibrated building is validated."""

    study: str = Field(
        description="Study file of it; the estimates are put into its building, nothing of it is identified"
    )


class Experiment(Part):
    """One data set of several: what differs from the keys of the study."""

    role: Literal["identification", "validation"] = Field(
        description="identification: its data are identified together with those of all others of this role; "
        "validation: nothing of it is identified, it is compared as described and calibrated"
    )
    building: str | None = Field(None, description="Building file, such as one that extends another one")
    set: dict[str, Any] = Field(
        default_factory=dict, description="Path -> value that replaces the one of the building file"
    )
    weather: dict[str, Any] | None = Field(None, description="Errors of columns of its weather")
    climate: dict[str, Any] | None = Field(None, description="Its weather data")
    measurements: dict[str, Any] | None = Field(None, description="Its table of measurements")
    sensors: dict[str, Any] = Field(default_factory=dict, description="Sensors that it has beside or others")
    periods: dict[str, Any] = Field(default_factory=dict, description="Which part of its record is for what")
    initial: Any = Field(None, description="Initial state of its runs")
    quality: dict[str, Any] | None = Field(None, description="What to do with suspicious values")
