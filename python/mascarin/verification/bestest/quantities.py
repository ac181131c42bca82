"""Quantities of Standard 140 from the hourly means of a year.

An hour has the number of the hour that ends: hour 1 is 00:00 to 01:00, local standard time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from pathlib import PurePath
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.limits import TOLERANCE, at_least, at_most
from mascarin.errors import InputError
from mascarin.verification.bestest.catalogue import Case
from mascarin.verification.bestest.reference import Range, ranges

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

HOURS: Final = 8760
"""Hours of the year."""
MONTHS: Final = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
_LENGTHS: Final = (31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
_STARTS: Final = tuple(accumulate(_LENGTHS, initial=0))
COLDEST_BIN: Final = -50
"""Lowest bin of the histogram, which contains all lower temperatures. [degC]"""
HOTTEST_BIN: Final = 98
"""Highest bin of the histogram. [degC]"""
ORIENTATIONS: Final = {
    "horizontal": "roof.incident_solar",
    "north": "north_wall.incident_solar",
    "east": "east_wall.incident_solar",
    "south": "south_wall.incident_solar",
    "west": "west_wall.incident_solar",
}
"""Output with the incident solar radiation on each surface of case 600. [W/m2]"""
ONTO_GLASS: Final = "glass.incident_solar"
"""Series of the incident solar radiation on the glass that is compared, south or west. [W/m2]"""
THROUGH_GLASS: Final = "glass.transmitted_solar"
"""Series of the solar radiation transmitted by this glass, per area of glass. [W/m2]"""


@dataclass(frozen=True)
class BestestQuantity:
    """A number of a case, with the results of the six programs.

    Attributes
    ----------
    case, quantity, unit : str
        What it is.
    value : float
        Result of Mascarin. [unit]
    when : str
        Hour of a peak or an extreme: month, day, hour that ends.
    range : Range or None
        Results of the programs; None for a building of the user.
    """

    case: str
    quantity: str
    unit: str
    value: float
    when: str
    range: Range | None

    @property
    def passed(self) -> bool | None:
        """Whether it is between the smallest and largest result of the programs; None without them."""
        if self.range is None:
            return None
        return bool(at_least(self.value, self.range.low) and at_most(self.value, self.range.high))

    def to_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        programs = self.range
        return {
            "case": self.case,
            "quantity": self.quantity,
            "unit": self.unit,
            "value": self.value,
            "when": self.when,
            "min": None if programs is None else programs.low,
            "max": None if programs is None else programs.high,
            "expected": None if programs is None else programs.mean,
            "programs": {} if programs is None else dict(programs.programs),
            "passed": self.passed,
        }


@dataclass(frozen=True)
class BestestYear:
    """The hourly means of a case.

    Attributes
    ----------
    case : Case
        The case.
    series : mapping of str to ndarray, shape (8760,)
        Hourly means by output name. [W, degC, W/m2]
    closure : float
        Relative energy-balance residual. [-]
    """

    case: Case
    series: Mapping[str, Array]
    closure: float

    def __post_init__(self) -> None:
        """Refuse series that are not a whole year."""
        for name, values in self.series.items():
            if values.shape != (HOURS,):
                raise InputError(
                    f"case {self.case.name}: found {values.shape} hours of {name}, expected {HOURS}"
                )

    @property
    def heating(self) -> Array:
        """Heating load. [W]"""
        return self._load("heating")

    @property
    def cooling(self) -> Array:
        """Sensible cooling load, positive. [W]"""
        return self._load("cooling")

    def _load(self, kind: str) -> Array:
        """Return a load; zero where the case has none. [W]"""
        return self.series.get(f"{self.case.zone}.{kind}_load", np.zeros(HOURS))

    @property
    def temperature(self) -> Array:
        """Air temperature of the free-floating zone, or of the conditioned one. [degC]"""
        return self.series[f"{self.case.floating or self.case.zone}.air_temperature"]


def when(hour: int) -> str:
    """Name an hour of the year, counted from 0, by month, day and the hour that ends.

    Parameters
    ----------
    hour : int
        Hour of the year, from 0.

    Returns
    -------
    str

    Examples
    --------
    >>> when(0), when(8759)
    ('Jan 1 1', 'Dec 31 24')
    """
    day, within = divmod(hour, 24)
    month = next(index for index in range(12) if day < _STARTS[index + 1])
    return f"{MONTHS[month]} {day - _STARTS[month] + 1} {within + 1}"


def hours_of(month: str, day: int) -> slice:
    """Return the 24 hours of a day, counted from 0."""
    first = 24 * (_STARTS[MONTHS.index(month)] + day - 1)
    return slice(first, first + 24)


def months() -> list[slice]:
    """Return the hours of each month, counted from 0."""
    return [slice(24 * start, 24 * end) for start, end in pairwise(_STARTS)]


def bins(temperatures: Array) -> Array:
    """Count the hours in each bin of 1 K, from -50 to 98 degC; the lowest has all lower temperatures.

    Parameters
    ----------
    temperatures : ndarray, shape (n,)
        Hourly means. [degC]

    Returns
    -------
    ndarray, shape (149,)
        Number of hours with ``n <= T < n + 1``.
    """
    bin_numbers = (
        np.clip(np.floor(temperatures + TOLERANCE), COLDEST_BIN, HOTTEST_BIN).astype(np.int64) - COLDEST_BIN
    )
    return np.bincount(bin_numbers, minlength=HOTTEST_BIN - COLDEST_BIN + 1).astype(np.float64)


def energy(watts: Array) -> float:
    """Sum hourly means. [MWh from W, kWh/m2 x 1e-3 from W/m2]"""
    return float(watts.sum()) / 1e6


def quantities(years: Mapping[str, BestestYear], case: Case) -> list[BestestQuantity]:
    """Compute every quantity of a case for which the six programs have results.

    Parameters
    ----------
    years : mapping of str to BestestYear
        Years by case, with those that the quantities of the case refer to.
    case : Case
        The case.

    Returns
    -------
    list of BestestQuantity
    """
    values = {**_loads(years[case.name]), **_floating(years[case.name]), **_sun(years, case)}
    reference_ranges = ranges()
    return [
        BestestQuantity(
            case.name,
            name,
            reference_ranges[case.name, name].unit,
            value,
            when,
            reference_ranges[case.name, name],
        )
        for name, (value, when) in values.items()
        if (case.name, name) in reference_ranges
    ]


def quantities_of(
    name: str, series: Mapping[str, Array], reference_ranges: Mapping[tuple[str, str], Range] | None = None
) -> list[BestestQuantity]:
    """Compute loads and temperatures of any building.

    Parameters
    ----------
    name : str
        Name of the building.
    series : mapping of str to ndarray, shape (8760,)
        Hourly means of loads and air temperatures, by output name. [W, degC]
    reference_ranges : mapping of (str, str) to Range, optional
        Ranges by case and quantity, from `read_ranges`. A case is the name, or its file with or without
        ending; in a building of one zone the quantity may be written without the zone.

    Returns
    -------
    list of BestestQuantity
        Annual and peak loads, and extremes and mean of the air temperature, as ``zone.quantity``.
    """
    computed = []
    for output, values in series.items():
        zone, _, kind = output.partition(".")
        numbers = (
            _extremes(values) if kind == "air_temperature" else _load(kind.removesuffix("_load"), values)
        )
        for quantity, (value, when) in numbers.items():
            unit = _UNITS[quantity.split("_")[0]]
            computed.append(BestestQuantity(name, f"{zone}.{quantity}", unit, value, when, None))
    zones = {output.partition(".")[0] for output in series}
    return (
        computed
        if reference_ranges is None
        else [_with_range(row, reference_ranges, lone=len(zones) == 1) for row in computed]
    )


def _with_range(
    computed: BestestQuantity, reference_ranges: Mapping[tuple[str, str], Range], *, lone: bool
) -> BestestQuantity:
    """The same quantity with its range, if there is one."""
    short = computed.quantity.partition(".")[2]
    for name in case_names(computed.case):
        for quantity in (computed.quantity, *((short,) if lone else ())):
            reference = reference_ranges.get((name, quantity))
            if reference is not None and reference.unit not in ("", computed.unit):
                raise InputError(
                    f"--ranges: found {quantity} of {name} in {reference.unit!r}; expected "
                    f"{computed.unit}: convert it"
                )
            if reference is not None:
                return replace(computed, range=reference)
    return computed


def case_names(file: str) -> tuple[str, ...]:
    """Names under which ranges may have a building file: as given, its name, its name without ending."""
    path = PurePath(file)
    return file, path.name, path.stem


_UNITS: Final = {"annual": "MWh", "peak": "kW", "max": "degC", "min": "degC", "mean": "degC"}


def partners(case: Case) -> tuple[str, ...]:
    """Return further cases that the quantities of a case refer to."""
    return (case.base,) if (case.name, _shading(case)) in ranges() else ()


def has_solar_quantities(case: Case) -> bool:
    """Whether the solar radiation through its glass is compared."""
    return (case.name, f"transmitted_solar_{facing(case)}") in ranges()


def _shading(case: Case) -> str:
    return f"shading_coefficient_{facing(case)}"


def facing(case: Case) -> str:
    """Return the orientation of the glass that is compared."""
    return "west" if case.opening == "east_west" else "south"


def _loads(year: BestestYear) -> dict[str, tuple[float, str]]:
    if not year.case.conditioned:
        return {}
    return {**_load("heating", year.heating), **_load("cooling", year.cooling)}


def _load(kind: str, watts: Array) -> dict[str, tuple[float, str]]:
    top = int(np.argmax(watts))
    return {
        f"annual_{kind}": (energy(watts), ""),
        # A load that is always zero has no hour of its peak.
        f"peak_{kind}": (float(watts[top]) / 1e3, when(top) if watts[top] > 0.0 else ""),
    }


def _floating(year: BestestYear) -> dict[str, tuple[float, str]]:
    if year.case.floating is None:
        return {}
    return _extremes(year.temperature)


def _extremes(air: Array) -> dict[str, tuple[float, str]]:
    return {
        "max_temperature": (float(air.max()), when(int(np.argmax(air)))),
        "min_temperature": (float(air.min()), when(int(np.argmin(air)))),
        "mean_temperature": (float(air.mean()), ""),
    }


def _sun(years: Mapping[str, BestestYear], case: Case) -> dict[str, tuple[float, str]]:
    """Incident and transmitted solar radiation; transmitted is per area of glass."""
    year = years[case.name]
    orientation = facing(case)
    values = {
        f"incident_solar_{plane}": (1e3 * energy(year.series[output]), "")
        for plane, output in ORIENTATIONS.items()
        if output in year.series
    }
    if THROUGH_GLASS not in year.series:
        return values
    through = 1e3 * energy(year.series[THROUGH_GLASS])
    values[f"transmitted_solar_{orientation}"] = (through, "")
    values[f"transmissivity_{orientation}"] = (through / (1e3 * energy(year.series[ONTO_GLASS])), "")
    if case.base in years and case.shaded:
        unshaded = 1e3 * energy(years[case.base].series[THROUGH_GLASS])
        values[_shading(case)] = (1.0 - through / unshaded, "")
    return values
