"""Units as files write them: in names of columns and in rows of units, and their factors to ours."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from mascarin.physics import KELVIN

FACTORS: Final[Mapping[str, tuple[str, float, float]]] = {
    "degC": ("degC", 1.0, 0.0),
    "K": ("degC", 1.0, -KELVIN),
    "degF": ("degC", 5.0 / 9.0, -160.0 / 9.0),
    "W/m2": ("W/m2", 1.0, 0.0),
    "kW/m2": ("W/m2", 1000.0, 0.0),
    "mW/cm2": ("W/m2", 10.0, 0.0),
    "Btu/(h ft2)": ("W/m2", 1055.05585262 / (3600.0 * 0.3048**2), 0.0),
    "m/s": ("m/s", 1.0, 0.0),
    "km/h": ("m/s", 1.0 / 3.6, 0.0),
    "knot": ("m/s", 1852.0 / 3600.0, 0.0),
    "mph": ("m/s", 0.44704, 0.0),
    "ft/s": ("m/s", 0.3048, 0.0),
    "ft/min": ("m/s", 0.3048 / 60.0, 0.0),
    "m/min": ("m/s", 1.0 / 60.0, 0.0),
    "cm/s": ("m/s", 0.01, 0.0),
    "0.1 degC": ("degC", 0.1, 0.0),
    "0.1 m/s": ("m/s", 0.1, 0.0),
    "0.1 hPa": ("Pa", 10.0, 0.0),
    "Pa": ("Pa", 1.0, 0.0),
    "hPa": ("Pa", 100.0, 0.0),
    "mbar": ("Pa", 100.0, 0.0),
    "kPa": ("Pa", 1000.0, 0.0),
    "bar": ("Pa", 1e5, 0.0),
    "mmHg": ("Pa", 133.322387415, 0.0),
    "inHg": ("Pa", 3386.388640341, 0.0),
    "%": ("%", 1.0, 0.0),
    "1": ("%", 100.0, 0.0),
    "tenths": ("tenths", 1.0, 0.0),
    "oktas": ("tenths", 1.25, 0.0),
    "deg": ("deg", 1.0, 0.0),
    "rad": ("deg", 57.29577951308232, 0.0),
}
"""Units that a column may have: (unit after conversion, factor, offset).

Factors that are not exact by definition are those of NIST Special Publication 811 (2008), appendix B,
doi:10.6028/NIST.SP.811e2008.
"""

ENERGIES: Final[Mapping[str, float]] = {
    "J/cm2": 1e4,
    "J/m2": 1.0,
    "kJ/m2": 1e3,
    "MJ/m2": 1e6,
    "Wh/m2": 3600.0,
    "kWh/m2": 3.6e6,
    "cal/cm2": 4.184e4,
    "Btu/ft2": 1055.05585262 / 0.3048**2,
}
"""Energies per interval, in J/m2; divided by the interval they become W/m2."""

HEATS: Final[Mapping[str, float]] = {"Wh": 3600.0, "kWh": 3.6e6, "J": 1.0, "kJ": 1e3}
"""Heat or electricity of an interval, in J; divided by the interval it becomes W."""

_FRACTIONS: Final[Mapping[tuple[str, str], float]] = {("%", "tenths"): 0.1, ("1", "tenths"): 10.0}
"""Further conversions between a unit and the one that is wanted."""

CONVERTED: Final = frozenset({"degC", "W/m2", "m/s", "Pa"})
"""Units into which every measured column is converted, whatever it is used for."""

_SPELLINGS: Final[Mapping[str, str]] = {
    "degC": "degc °c c celsius degcelsius degreescelsius degreesc gradc gradcelsius degree_celsius "
    "degrees_celsius",
    "K": "k kelvin degk °k kelvins",
    "degF": "degf °f f fahrenheit degfahrenheit degreesf",
    "W/m2": "w/m2 wm-2 wm2 w/sqm w/qm watt/m2 watts/m2 w/msq",
    "kW/m2": "kw/m2 kwm-2 kwm2 kw/sqm",
    "mW/cm2": "mw/cm2 mwcm-2",
    "Btu/(h ft2)": "btu/hft2 btu/ft2h btu/hr/ft2 btu/h/ft2 btu/hrft2",
    "m/s": "m/s ms-1 m/sec mps m/sek metres/second meters/second",
    "km/h": "km/h kmh kph kmh-1 km/hr km/hour",
    "knot": "knot knots kt kts kn",
    "mph": "mph mi/h mi/hr miles/h miles/hour",
    "ft/s": "ft/s fps ft/sec fts-1",
    "ft/min": "ft/min fpm feet/min",
    "m/min": "m/min",
    "cm/s": "cm/s",
    "0.1 degC": "01degc 01°c 01c 0,1°c 1/10°c 01degreescelsius 01degreecelsius degc/10 °c/10",
    "0.1 m/s": "01m/s 0,1m/s 1/10m/s",
    "0.1 hPa": "01hpa 0,1hpa 1/10hpa 01mbar",
    "Pa": "pa pascal",
    "hPa": "hpa hectopascal",
    "mbar": "mbar mb millibar millibars mbars",
    "kPa": "kpa",
    "bar": "bar",
    "mmHg": "mmhg torr",
    "inHg": "inhg",
    "%": "% %rh rh% percent prozent %rf %hr %rel %relh pct",
    "tenths": "tenths",
    "oktas": "oktas okta octas 1/8",
    "deg": "deg ° degree degrees grad °n",
    "rad": "rad",
    "J/cm2": "j/cm2 jcm-2",
    "J/m2": "j/m2 jm-2",
    "kJ/m2": "kj/m2 kjm-2",
    "MJ/m2": "mj/m2 mjm-2",
    "Wh/m2": "wh/m2 whm-2 wh/sqm",
    "kWh/m2": "kwh/m2 kwhm-2",
    "cal/cm2": "cal/cm2 ly langley langleys",
    "Btu/ft2": "btu/ft2",
    "W": "w watt watts",
    "kW": "kw",
    "Btu/h": "btu/h btu/hr btuh",
    "Wh": "wh",
    "kWh": "kwh",
    "J": "j",
    "kJ": "kj",
    "m3/h": "m3/h cbm/h m3h-1",
    "m3/s": "m3/s m3s-1",
    "L/s": "l/s ls-1",
    "L/h": "l/h",
    "L/min": "l/min",
    "kg/s": "kg/s kgs-1",
    "kg/h": "kg/h kgh-1",
    "g/h": "g/h",
    "g/kg": "g/kg gkg-1",
    "kg/kg": "kg/kg",
    "mm": "mm",
    "mm/h": "mm/h mmh-1",
    "V": "v volt volts",
    "mV": "mv",
    "A": "a ampere",
    "ppm": "ppm",
    "lx": "lx lux",
}
"""Spellings of each unit, after `_key`."""

_UNITS: Final = {spelling: unit for unit, words in _SPELLINGS.items() for spelling in words.split()}
#: Mega and milli differ by their case alone: neither is taken for the other.
_MEGA: Final = re.compile(r"^(?:MW|mW|MV|Mbar|Mb|mJ)(?![A-Za-z/])|^(?:mJ|mWh|MWh)")
_ENDING: Final = re.compile(r"(?<=[_ ])[^_ ]+(?:/[^_ ]+)?$")
_COMMA: Final = re.compile(r",\s*([^,()]+?)\s*(?:\(|$)")
_BRACKETS: Final = re.compile(r"\[([^\][]*)\]|\(((?:[^()]|\([^()]*\))*)\)")


@dataclass(frozen=True)
class StatedUnit:
    """The unit that a file states for one of its columns.

    Attributes
    ----------
    unit : str
        Key of `FACTORS` or `ENERGIES`, or another unit that is known by name.
    text : str
        As it is written.
    place : str
        Where it is written, in words.
    """

    unit: str
    text: str
    place: str


def parse_unit(text: str) -> str | None:
    """The unit that a text writes.

    Parameters
    ----------
    text : str
        Such as ``Deg F``, ``W/m^2`` or ``km/h``.

    Returns
    -------
    str or None
        Its plain name; None where the text is no unit that is known.

    Examples
    --------
    >>> [parse_unit(text) for text in ("Deg F", "W/m²", "W m-2", "km/hr", "[hPa]", "room 1", "mW", "MW")]
    ['degF', 'W/m2', 'W/m2', 'km/h', 'hPa', None, None, None]
    """
    written = text.strip().strip("[]<>").strip()
    if _MEGA.match(written):
        return None
    return _UNITS.get(_key(written))


def _key(text: str) -> str:
    signs = text.replace("º", "°").replace("˚", "°").replace("−", "-")
    plain = unicodedata.normalize("NFKC", signs).lower()
    return re.sub(r"[\s^*·.()⋅]", "", plain)


def unit_in_name(name: str, column_names: Sequence[str] = ()) -> tuple[str, str] | None:
    """Unit in the name of a column: in brackets, after a comma, or at the end.

    Parameters
    ----------
    name : str
        Name of the column.
    column_names : sequence of str
        Names of all columns: beside ``temp_A`` and ``temp_B``, ``temp_F`` is the sixth sensor.

    Returns
    -------
    (str, str) or None
        The unit and its text.

    Examples
    --------
    >>> unit_in_name("Temp, °F (LGR S/N: 1)"), unit_in_name("wind [km/h]"), unit_in_name("T_degF")
    (('degF', '°F'), ('km/h', 'km/h'), ('degF', 'degF'))
    >>> unit_in_name("T (attic)"), unit_in_name("wall_C"), unit_in_name("G / W/m2")
    (None, None, ('W/m2', 'W/m2'))
    >>> unit_in_name("Temp_F"), unit_in_name("temp_F", ["temp_A", "temp_B", "temp_F"])
    (('degF', 'F'), None)
    """
    inside = [first or second for first, second in _BRACKETS.findall(name)]
    after = _COMMA.findall(name)
    for text in (*inside, *after):
        unit = parse_unit(text)
        if unit is not None and not (len(text.strip()) == 1 and text.strip().islower()):
            return unit, text.strip()
    temperature = _KNOWN_NAMES.fullmatch(name.strip())
    if temperature is not None and temperature["letter"] and _is_lettered(name.strip(), column_names):
        return None
    if temperature is not None:
        return (
            ("degF", temperature["fahrenheit"] or temperature["letter"])
            if (temperature["letter"] or "f") in "fF"
            else ("degC", temperature["letter"])
        )
    ending = _ENDING.search(name)
    wind = _WIND_NAMES.fullmatch(name.strip())
    if wind is not None:
        return str(parse_unit(wind["unit"])), wind["unit"]
    if ending is None or len(ending[0]) == 1 or ending[0].lower() in _ENDINGS_OF_NAMES:
        return None
    unit = parse_unit(ending[0])
    return None if unit is None else (unit, ending[0])


def _is_lettered(name: str, column_names: Sequence[str]) -> bool:
    """Whether the last letter of a name counts columns, as those of others do."""
    return any(
        other.strip()[:-1] == name[:-1] and other.strip()[-1:].isalpha() and other.strip()[-1] not in "CFK"
        for other in column_names
    )


#: Names of temperatures that end in the letter of their unit, and those of stations of Ecowitt. A bare T_F
#: may be that of a room.
_KNOWN_NAMES: Final = re.compile(
    r"(?i:[a-z0-9]*[_ ]?(?:temp(?:erature)?|air_?t|t_?air|dew_?p(?:oin)?t|dry_?bulb|wet_?bulb)\d*)"
    r"[_ ](?P<letter>[CF])|(?:temp(?:in|out)?\d*|dewpt|dewpoint|windchill|heatindex)(?P<fahrenheit>f)"
)
_WIND_NAMES: Final = re.compile(r"(?i:wind|gust)[a-z]*?(?i:speed|gust)?(?P<unit>mph|kmh|kph|knots)")
#: Endings of names that are words or numbers of rooms more often than units.
_ENDINGS_OF_NAMES: Final = frozenset({"ly", "mb", "kn", "deg", "rad", "bar", "grad", "mm", "mv", "ppm"})


def conversion(unit: str, target: str, interval: float) -> tuple[float, float] | None:
    """Factor and offset from a unit to another one.

    Parameters
    ----------
    unit : str
        Key of `FACTORS`, `ENERGIES` or `HEATS`.
    target : str
        Wanted unit; empty: that of `FACTORS`.
    interval : float
        Length of an interval, for energies [s].

    Returns
    -------
    (float, float) or None
        value = factor x + offset; None where the units are of different quantities.

    Examples
    --------
    >>> conversion("kW/m2", "W/m2", 3600.0), conversion("Wh/m2", "W/m2", 900.0), conversion("K", "m/s", 1.0)
    ((1000.0, 0.0), (4.0, 0.0), None)
    """
    if unit in ENERGIES and target in ("W/m2", ""):
        return ENERGIES[unit] / interval, 0.0
    if unit in HEATS and target in ("W", ""):
        return HEATS[unit] / interval, 0.0
    if (unit, target) in _FRACTIONS:
        return _FRACTIONS[unit, target], 0.0
    if unit in FACTORS and target in (FACTORS[unit][0], ""):
        return FACTORS[unit][1:]
    return None


def same_unit(first: str, second: str) -> bool:
    """Whether two units are converted alike, such as hPa and mbar.

    Parameters
    ----------
    first, second : str
        Names of units.
    """
    return first == second or (first in FACTORS and FACTORS[first] == FACTORS.get(second))


def units_of(target: str) -> list[str]:
    """Units that can be turned into a unit.

    Parameters
    ----------
    target : str
        Unit after conversion.
    """
    units = [name for name, entry in FACTORS.items() if entry[0] == target]
    units += [name for name, other in _FRACTIONS if other == target]
    return units + (list(ENERGIES) if target == "W/m2" else [])
