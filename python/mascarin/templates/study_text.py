"""A study of a new wall or cell: what was measured, which days, and a few parameters to identify."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError, did_you_mean
from mascarin.templates.short_texts import name_of, quoted

if TYPE_CHECKING:
    import pandas as pd

#: Parts of the record for the start of the run and the identification; all else validates.
_WARM_UP: Final = 0.1
_IDENTIFICATION: Final = 0.5
#: Days of the identification at most. [d]
_MOST_DAYS: Final = 10
_FEWEST_DAYS: Final = 3.0


@dataclass(frozen=True, slots=True)
class LoggerRecord:
    """A logger file.

    Attributes
    ----------
    path : Path
        The file.
    timezone : str
        Of its clock.
    columns : tuple of str
        Names of its columns.
    first, last : Timestamp
        First and last stamp, in that clock.
    """

    path: Path
    timezone: str
    columns: tuple[str, ...]
    first: pd.Timestamp
    last: pd.Timestamp

    @classmethod
    def of_file(cls, path: Path, timezone: str) -> LoggerRecord:
        """Read the names of the columns and the length of a logger file.

        Parameters
        ----------
        path : Path
            The file.
        timezone : str
            Of its clock.

        Raises
        ------
        InputError
            It cannot be read, or has fewer than three days.
        """
        from mascarin.weather import Measurements

        index = Measurements.from_table(path, timezone=timezone).data
        first, last = index.index[0], index.index[-1]
        days = (last - first).total_seconds() / 86400.0
        if days < _FEWEST_DAYS:
            raise InputError(
                f"--data: found {path.name} with {days:.1f} days; expected at least {_FEWEST_DAYS:g}: a part "
                "of the record is for the start, a part to identify, and a part to validate"
            )
        return cls(path, timezone, tuple(map(str, index.columns)), first, last)

    def require(self, column: str, option: str) -> str:
        """Refuse a column that the file does not have.

        Parameters
        ----------
        column : str
            Its name.
        option : str
            Named in the error.

        Raises
        ------
        InputError
            There is no such column.
        """
        if column not in self.columns:
            raise InputError(
                f"{option}: found no column '{column}' in {self.path.name}; expected one of "
                f"{', '.join(self.columns)}. {did_you_mean(column, self.columns, known=False)}".rstrip()
            )
        return column

    def periods(self) -> tuple[str, str, str]:
        """Start of the run, start and end of the identification, as stamps at midnight."""
        import pandas as pd

        local = [stamp.tz_localize(None) for stamp in (self.first, self.last)]
        start, end = local[0].ceil("D"), local[1].floor("D")
        days = max((end - start).days, 2)
        warm_up = min(max(round(_WARM_UP * days), 1), 3)
        identified = min(max(round(_IDENTIFICATION * days), 1), _MOST_DAYS)
        stamps = [start, start + pd.Timedelta(days=warm_up), start + pd.Timedelta(days=warm_up + identified)]
        first, middle, last = (f"{stamp:%Y-%m-%d}" for stamp in stamps)
        return first, middle, last


def study_lines(
    record: LoggerRecord,
    name: str,
    climate: Iterator[str],
    sensors: Mapping[str, str],
    parameters: Iterator[str],
) -> Iterator[str]:
    """Lines of the study of a logger file.

    Parameters
    ----------
    record : LoggerRecord
        The logger file.
    name : str
        Name of the study.
    climate : iterator of str
        Lines of the section `climate`.
    sensors : mapping of str to str
        Column -> output of the building.
    parameters : iterator of str
        Paths to identify.
    """
    start, first, last = record.periods()
    yield f"name: {name}"
    yield "building: building.yaml"
    yield from climate
    yield "measurements:"
    yield f"  table: {quoted(record.path.name)}"
    yield f"  timezone: {quoted(record.timezone)}"
    yield "# The uncertainty of a data sheet is mostly an offset that all readings of a sensor share."
    yield "sensors:"
    for column, output in sensors.items():
        yield (
            f"  {name_of(column)}: {{column: {quoted(column)}, output: {output}, expanded_uncertainty: 0.5}}"
        )
    yield "periods:"
    yield "  # The run starts before it is compared: the state of the walls is not known."
    yield f'  warm_up: ["{start}", "{first}"]'
    yield f'  identification: ["{first}", "{last}"]'
    yield "identification:"
    yield "  parameters:"
    for path in parameters:
        yield f"    {path}:"
    yield "# All other days validate what was identified."
    yield "criteria:"
    yield "  - {metric: max_error, limit: 2}"
