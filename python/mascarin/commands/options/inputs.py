"""Options shared by the commands: a building with ``--set``, a time step."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal

from cyclopts import Parameter

from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate

Flag: Final = Parameter(negative="", show_default=False)
"""An option without a value."""

Settings = Annotated[
    list[str] | None,
    Parameter(
        name="--set", negative="", help="New value of a parameter, as PATH=VALUE; can be given several times."
    ),
]
AsJson = Annotated[bool, Flag, Parameter(name="--json", help="Print the result as JSON.")]
Outside = Annotated[
    bool,
    Flag,
    Parameter(
        help="Let the study read files outside its folder and the data folder (MASCARIN_DATA); for "
        "studies that you trust."
    ),
]
Step = Annotated[str, Parameter(help="Time step, such as 900, 15min or 1h.")]
RunStep = Annotated[
    str,
    Parameter(
        help="Time step, such as 900, 15min or 1h; or 'auto 0.05K every 1h': steps that follow the weather, "
        "with a tolerance and the interval of the records."
    ),
]


Weather = Annotated[
    Path,
    Parameter(
        help="Weather: an EPW file, TMY3 as CSV, a measured table (CSV with --column, or Parquet), or a YAML "
        "file with the keys climate and measurements of a study, such as the study itself."
    ),
]
MeasuredTable = Annotated[
    Path | None,
    Parameter(
        help="Table with the measured columns that the building names. Default: the table of --weather."
    ),
]
Columns = Annotated[
    list[str] | None,
    Parameter(
        name="--column",
        negative="",
        help="Column of a measured table for --weather, as CHANNEL=COLUMN or CHANNEL=COLUMN [UNIT], such as "
        '"air_temperature=T_out" or "wind_speed=wind [km/h]"; CHANNEL=none for what was not measured. A unit '
        "that the file states is used without being repeated; [km/h!] holds although the file states another "
        "one. Can be given several times.",
    ),
]
Zone = Annotated[str | None, Parameter(help="Time zone of measured tables. Default: that of the site.")]
CheckSun = Annotated[
    bool,
    Parameter(help="Refuse a weather file or table whose radiation does not follow the sun of its place."),
]
Shift = Annotated[
    str | None,
    Parameter(
        negative="",
        help="Added to all times of the weather and of measured tables, such as 30min; a negative "
        "one is written "
        "--shift=-30min.",
    ),
]
Compared = Annotated[
    list[str] | None,
    Parameter(
        name="--compare",
        negative="",
        help="Output and the measured column that it is compared with, as OUTPUT=COLUMN, such as "
        "room.air_temperature=T_room; the column is in the table of --measurements, or of --weather. Where "
        "the weather represents any year, the run covers the whole days of that table. Can be given several "
        "times.",
    ),
]
Stamps = Annotated[
    Literal["start", "end"],
    Parameter(help="Which end of its interval a stamp of a measured table marks."),
]


def read_building(file: Path, settings: Sequence[str] | None) -> Building:
    """Read a building and set the values of ``--set``.

    Parameters
    ----------
    file : Path
        File of the building.
    settings : sequence of str or None
        Each as ``path=value``.

    Raises
    ------
    InputError
        If the description or a setting cannot be used.
    """
    from mascarin.building import load

    building = load(file)
    values = set_values(settings)
    return building.replace(values) if values else building


def set_values(settings: Sequence[str] | None) -> dict[str, float]:
    """Values of ``--set`` by path.

    Raises
    ------
    InputError
        A setting is not ``path=number``.
    """
    return dict(_setting(text) for text in settings or ())


def _setting(text: str) -> tuple[str, float]:
    path, equals, value = text.partition("=")
    try:
        if equals and path.strip():
            return path.strip(), float(value)
    except ValueError:
        pass
    raise InputError(f"--set: found '{text}'; expected PATH=NUMBER, such as zones.room.volume=27")


def seconds(text: str) -> float:
    """Read a time step.

    Parameters
    ----------
    text : str
        A number with the unit ``s``, ``min`` or ``h``; without a unit in seconds.

    Returns
    -------
    float
        The step. [s]

    Raises
    ------
    InputError
        The text is not a positive time.
    """
    from mascarin._io.durations import seconds_of

    return seconds_of(text, "--step")


def step_of(text: str) -> str | float:
    """Step of a run: a length, or `auto`.

    Parameters
    ----------
    text : str
        As of `seconds`, or such as ``auto 0.05K every 1h``.

    Returns
    -------
    float or str
        The step [s], or the text that steps are chosen by.

    Raises
    ------
    InputError
        The text is neither.
    """
    from mascarin._io.durations import auto_step

    return seconds(text) if auto_step(text, "--step") is None else text


def matching_outputs(building: Building, patterns: Sequence[str] | None) -> list[str] | None:
    """Names of the outputs that fit patterns; None for the default outputs.

    Parameters
    ----------
    building : Building
        Has the outputs.
    patterns : sequence of str or None
        Values of ``--output``.

    Raises
    ------
    InputError
        A pattern fits no output.
    """
    if patterns is None:
        return None
    names = [output.name for output in building.outputs()]
    names_found: dict[str, None] = {}
    for pattern in patterns:
        meant = [name for name in names if fnmatchcase(name, pattern)]
        if not meant and any(sign in pattern for sign in "*?["):
            raise InputError(
                f"--output: found no output that fits '{pattern}'; expected a pattern that fits one. "
                f"{_suggestion(pattern, names)}".rstrip()
            )
        if not meant:
            building.output(pattern)
        names_found |= dict.fromkeys(meant or [pattern])
    return list(names_found)


def _suggestion(pattern: str, names: Sequence[str]) -> str:
    """Suggest patterns that fit: with the zone or surface, or the quantity, taken from an existing name."""
    owner, _, what = pattern.partition(".")
    pairs = [(part, right) for part, _, right in (name.partition(".") for name in names)]
    candidates = {f"{part}.{what}" for part, right in pairs if fnmatchcase(right, what)}
    candidates |= {f"{owner}.{right}" for part, right in pairs if fnmatchcase(part, owner)}
    return did_you_mean(pattern, candidates or names)


def read_weather(file: Path, *, check_sun: bool = True, shift: str | None = None) -> Climate:
    """Read a weather file, whose name gives its format, or a climate that comes with Mascarin.

    Raises
    ------
    InputError
        If it is neither EPW nor TMY3, or damaged.
    """
    from mascarin.weather import Climate
    from mascarin.weather.reading.shipped import PREFIX

    if str(file).startswith(PREFIX):
        return Climate.from_epw(file, check_sun=check_sun, shift=shift)
    match file.suffix.lower():
        case ".epw":
            return Climate.from_epw(file, check_sun=check_sun, shift=shift)
        case ".csv" | ".tm2":
            return Climate.from_tmy(file, check_sun=check_sun, shift=shift)
        case suffix:
            raise InputError(
                f"--weather: found '{file}', a file ending in '{suffix}'; expected .epw, .tm2, .csv (TMY3, "
                "or another table with --column), .parquet (with --column), .yaml or shipped:NAME"
            )
