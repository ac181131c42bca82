"""Measured tables as weather and as boundary conditions of a single run."""

from __future__ import annotations

import re
import sys
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin.commands.options.inputs import read_weather
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.tables.reading.table import Stamps
    from mascarin.validation.comparison import Metrics
    from mascarin.weather import Climate, Column, Measurements

_YAML: Final = (".yaml", ".yml")
_TABLES: Final = (".csv", ".txt", ".tsv", ".dat", ".parquet", ".pq", ".xlsx", ".xlsm")
_UNIT: Final = re.compile(r"(?P<column>.*\S)\s+\[(?P<unit>[^\]]+)\]")
_NONE: Final = "none"


def run_inputs(
    building: Building,
    weather: Path,
    table: Path | None,
    *,
    columns: Sequence[str],
    timezone: str | None,
    stamps: Stamps,
    allow_outside: bool = False,
    check_sun: bool = True,
    shift: str | None = None,
) -> tuple[Climate, Measurements | None]:
    """Read the weather of a run, and the measured columns that its building names.

    Parameters
    ----------
    building : Building
        Names the columns of its measured boundaries, and its site.
    weather : Path
        Weather file, measured table, or YAML file with ``climate`` and ``measurements``.
    table : Path or None
        Table of the measured columns; None: that of the weather.
    columns : sequence of str
        Channels of a measured table, as ``channel=column``.
    timezone : str or None
        Zone of the tables; None: that of the site.
    stamps : str
        Which end of its interval a stamp marks.
    allow_outside : bool
        Whether a YAML file may name files outside its folder.
    check_sun : bool
        Whether radiation that does not follow the sun is refused.
    shift : str or None
        Added to all times of the weather and of the tables.

    Raises
    ------
    InputError
        Something cannot be used; option or file is named.
    """
    from mascarin.building.engine_input import measured_columns
    from mascarin.weather import Measurements

    zone = timezone or str(building.site.timezone)
    needed = measured_columns(building)
    measured = None
    if weather.suffix.lower() in _YAML:
        if not check_sun:
            raise InputError(
                f"--no-check-sun: found beside {weather}; expected check_sun: false in that file, under "
                "climate"
            )
        if shift is not None:
            raise InputError(
                f"--shift: found beside {weather}; expected shift: {shift} in that file, beside the "
                f"table, or "
                "under climate for a weather file"
            )
        if columns:
            raise InputError(
                f"--column: found beside {weather}; expected the columns in that file, under climate"
            )
        from mascarin.building.files.yaml_document import merged
        from mascarin.study.file.run_inputs import open_run_inputs

        if "climate" not in merged(weather, "weather and measurements", blanks=True).plain:
            raise InputError(
                f"--weather: found '{weather}', a file without the key climate; expected .epw, a table, or a "
                "YAML file with climate and measurements as in a study"
            )
        climate, measured = open_run_inputs(weather, building, allow_outside=allow_outside)
    elif columns or weather.suffix.lower() in _TABLES[1:]:
        climate = _measured_weather(building, weather, columns, zone, stamps, check_sun, shift)
        table = table or weather
    else:
        climate = read_weather(weather, check_sun=check_sun, shift=shift)
    if table is not None and needed:
        measured = Measurements.from_table(table, columns=needed, timezone=zone, stamps=stamps, shift=shift)
    if needed and measured is None:
        raise InputError(
            f"--measurements: not given; expected a table with the measured columns of this building: "
            f"{', '.join(needed)}"
        )
    show_columns(climate, measured)
    return climate, measured


def compared_columns(
    texts: Sequence[str] | None,
    table: Path,
    building: Building,
    timezone: str | None,
    stamps: Stamps,
    shift: str | None,
) -> tuple[dict[str, str], Measurements | None]:
    """Outputs and columns of ``--compare``, and the table with these columns.

    Raises
    ------
    InputError
        A text is not OUTPUT=COLUMN, or the table is none.
    """
    from mascarin.weather import Measurements

    pairs: dict[str, str] = {}
    for text in texts or ():
        output, equals, column = (part.strip() for part in text.partition("="))
        if not (output and equals and column):
            raise InputError(
                f"--compare: found '{text}'; expected OUTPUT=COLUMN, such as room.air_temperature=T_room"
            )
        pairs[output] = column
    if not pairs:
        return {}, None
    if table.suffix.lower() in (*_YAML, ".epw", ".tm2") or str(table).startswith("shipped:"):
        raise InputError(
            f"--compare: found '{table}' as the table of the columns; expected a measured one: name it with "
            "--measurements"
        )
    zone = timezone or str(building.site.timezone)
    columns = list(dict.fromkeys(pairs.values()))
    measured = Measurements.from_table(table, columns=columns, timezone=zone, stamps=stamps, shift=shift)
    for name in columns:
        print(f"{measured.file}: {measured.record.origins[name].line}", file=sys.stderr)
    return pairs, measured


def period_of(
    climate: Climate, measured: Measurements | None, start: str | None, end: str | None
) -> tuple[str | None, str | None]:
    """Start and end of a run; with weather of any year those of the table it is compared with."""
    if measured is None or not climate.grid.periodic:
        return start, end
    index = measured.index
    return start or str(index[0].ceil("D")), end or str(index[-1].floor("D"))


def print_comparison(metrics: Mapping[str, Metrics], columns: Mapping[str, str]) -> None:
    """A line for each output that is compared with a column."""
    for name, each in metrics.items():
        print(
            f"{name} beside {columns[name]}: simulated minus measured {each.bias:+.2f}, standard deviation "
            f"{each.sd:.2f}, largest {each.max_error:+.2f} {each.unit.replace('degC', 'K')} ({each.n} values)"
        )


def show_columns(
    climate: Climate, measured: Measurements | None, columns: Collection[str] | None = None
) -> None:
    """Say on the terminal what was read of each column of a table: unit, conversion, range, missing values.

    Parameters
    ----------
    climate : Climate
        The weather; nothing is said of a weather file of a year.
    measured : Measurements or None
        Measured columns.
    columns : collection of str, optional
        Which of the measured columns are used. Default: all.
    """
    lines = [f"{climate.file}: {origin.line}" for origin in climate.record.origins.values()]
    if measured is not None:
        lines += [
            f"{measured.file}: {origin.line}"
            for name, origin in measured.record.origins.items()
            if columns is None or name in columns
        ]
    for line in dict.fromkeys(lines):
        print(line, file=sys.stderr)


def _measured_weather(
    building: Building,
    file: Path,
    columns: Sequence[str],
    zone: str,
    stamps: Stamps,
    check_sun: bool,
    shift: str | None,
) -> Climate:
    from mascarin.tables.reading.table import read_table
    from mascarin.weather import Climate

    names = [str(name) for name in read_table(file, timezone=zone).frame.columns]
    chosen: dict[str, Column] = {}
    absent = []
    for text in columns:
        channel, column = _pair(text, names)
        if column is None:
            absent.append(channel)
        else:
            chosen[channel] = column
    site = building.site
    try:
        return Climate.from_table(
            file, columns=chosen, absent=absent, timezone=zone, stamps=stamps, latitude=float(site.latitude),
            longitude=float(site.longitude), altitude=float(site.altitude), check_sun=check_sun, shift=shift,
        )  # fmt: skip
    except InputError as error:
        if "absent: [" not in str(error):
            raise
        raise InputError(
            f"{error} On the command line: --column CHANNEL=COLUMN, or --column CHANNEL=none for what was "
            "not "
            "measured."
        ) from None


def _pair(text: str, names: Sequence[str]) -> tuple[str, Column | None]:
    """Channel and column of ``--column``; None for a channel that was not measured.

    Brackets hold a unit, unless the table has a column (``names``) that is called so. With an exclamation
    mark it holds although the file states another one.
    """
    from mascarin.weather import Column

    channel, equals, name = (part.strip() for part in text.partition("="))
    if not (channel and equals and name):
        raise InputError(
            f"--column: found '{text}'; expected CHANNEL=COLUMN, such as air_temperature=T_out, or "
            "CHANNEL=none"
        )
    if name == _NONE and _NONE not in names:
        return channel, None
    unit = None if name in names else _UNIT.fullmatch(name)
    if unit is None:
        return channel, Column(name)
    text = unit["unit"]
    return channel, Column(unit["column"], unit=text.removesuffix("!"), overrule=text.endswith("!"))
