"""The cases of ANSI/ASHRAE Standard 140-2020, building thermal fabric: one row of properties for each.

The standard itself was not available: the properties are those of public models of these cases
(docs/bestest.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Final, Literal

from mascarin.errors import InputError

Opening = Literal["south", "east_west", "panels", "none"]
Thermostat = Literal["20,27", "20,20", "setback", "day cooling", "none"]


@dataclass(frozen=True)
class Case:
    """One case: its properties, and how it differs from its base case.

    Attributes
    ----------
    name : str
        Its number in the standard.
    base : str
        The case that it is compared with; itself for the first of a series.
    change : str
        How it differs from its base case.
    heavy : bool
        High-mass walls and floor.
    opening : str
        Glass in the south wall, in the east and west walls, high-conductance opaque panels in place of the
        south glass, or nothing.
    shaded : bool
        Overhang over the south wall, or overhang and fins at the east and west windows.
    gain : float
        Constant internal gain. [W]
    air_changes : float
        Infiltration. [1/h]
    thermostat : str
        Set points of heating and cooling, or the control.
    fan : bool
        Night ventilation.
    emissivity_inside, emissivity_outside : float
        Long-wave emissivity of opaque surfaces. [-]
    absorptance_inside, absorptance_outside : float
        Solar absorptance of opaque surfaces. [-]
    sunspace : bool
        The two zones of case 960.
    """

    name: str
    base: str
    change: str
    heavy: bool = False
    opening: Opening = "south"
    shaded: bool = False
    gain: float = 200.0
    air_changes: float = 0.5
    thermostat: Thermostat = "20,27"
    fan: bool = False
    emissivity_inside: float = 0.9
    emissivity_outside: float = 0.9
    absorptance_inside: float = 0.6
    absorptance_outside: float = 0.6
    sunspace: bool = False

    @property
    def conditioned(self) -> bool:
        """Whether it has heating or cooling loads."""
        return self.thermostat != "none"

    @property
    def floating(self) -> str | None:
        """Zone whose free-floating temperature is compared; None where there is none."""
        if self.sunspace:
            return "sunspace"
        return None if self.conditioned else "room"

    @property
    def zone(self) -> str:
        """Zone with heating and cooling, or the only one."""
        return "back" if self.sunspace else "room"

    @property
    def windows(self) -> tuple[str, ...]:
        """Names of its windows."""
        match self.opening:
            case "south":
                return ("south_west_window", "south_east_window")
            case "east_west":
                return ("east_window", "west_window")
            case _:
                return ()

    @property
    def file(self) -> Path:
        """Its building file."""
        return FOLDER / f"{self.name}.yaml"


FOLDER: Final = Path(str(files("mascarin.verification.bestest"))) / "buildings"
"""Where the building files are."""

_600: Final = Case("600", "600", "base of the main series: low mass, south windows, heating 20, cooling 27")
_220: Final = Case(
    "220",
    "220",
    "base of the in-depth series: low mass, opaque panels in place of glass, no gain, no infiltration, "
    "heating and cooling 20",
    opening="panels",
    gain=0.0,
    air_changes=0.0,
    thermostat="20,20",
    absorptance_outside=0.1,
)


def _but(base: Case, name: str, change: str, **facts: object) -> Case:
    return replace(base, name=name, base=base.name, change=change, **facts)  # type: ignore[arg-type]


def _main(base: Case, names: Sequence[str]) -> list[Case]:
    """Cases of the series of 600 or 900, which differ in the same way."""
    overhang, east_west, fins, setback, fan, free, fan_free = names
    turned = _but(base, east_west, "windows to east and west instead of south", opening="east_west")
    vented = _but(
        base, fan, "night ventilation, no heating, cooling by day only", thermostat="day cooling", fan=True
    )
    return [
        base,
        _but(base, overhang, "overhang over the south wall", shaded=True),
        turned,
        _but(turned, fins, "overhang and fins at the windows", shaded=True),
        _but(base, setback, "heating set point lowered at night", thermostat="setback"),
        vented,
        _but(base, free, "no heating, no cooling", thermostat="none"),
        _but(vented, fan_free, "no cooling", thermostat="none"),
    ]


_LIGHT: Final = _main(_600, ("610", "620", "630", "640", "650", "600FF", "650FF"))
_900: Final = _but(_600, "900", "high mass walls and floor", heavy=True)
_HEAVY: Final = _main(_900, ("910", "920", "930", "940", "950", "900FF", "950FF"))

MAIN: Final = (
    *_LIGHT,
    *_HEAVY,
    _but(_600, "960", "no windows; a sunspace of high mass along the south wall", sunspace=True),
)
"""The main cases, in the order of the standard."""

_215: Final = _but(_220, "215", "emissivity outside 0.1", emissivity_outside=0.1)
_210: Final = _but(_220, "210", "emissivity inside 0.1", emissivity_inside=0.1)
_200: Final = _but(_210, "200", "emissivity outside 0.1", emissivity_outside=0.1)
_270: Final = _but(
    _220, "270", "south windows, absorptance inside 0.9", opening="south", absorptance_inside=0.9
)
_300: Final = _but(_270, "300", "windows to east and west instead of south", opening="east_west")
_400: Final = _but(_220, "400", "heating 20, cooling 27", thermostat="20,27")
_410: Final = _but(_400, "410", "infiltration 0.5 /h", air_changes=0.5)
_420: Final = _but(_410, "420", "gain 200 W", gain=200.0)
_430: Final = _but(_420, "430", "absorptance outside 0.6", absorptance_outside=0.6)

IN_DEPTH: Final = (
    _but(_200, "195", "plain wall in place of the panels", opening="none"),
    _200,
    _210,
    _215,
    _220,
    _but(_220, "230", "infiltration 1 /h", air_changes=1.0),
    _but(_220, "240", "gain 200 W", gain=200.0),
    _but(_220, "250", "absorptance outside 0.9", absorptance_outside=0.9),
    _270,
    _but(_270, "280", "absorptance inside 0.1", absorptance_inside=0.1),
    _but(_270, "290", "overhang over the south wall", shaded=True),
    _300,
    _but(_300, "310", "overhang and fins at the windows", shaded=True),
    _but(_270, "320", "heating 20, cooling 27", thermostat="20,27"),
    _but(_400, "395", "plain wall in place of the panels", opening="none"),
    _400,
    _410,
    _420,
    _430,
    _but(_600, "440", "absorptance inside 0.1", absorptance_inside=0.1),
    _but(_430, "800", "high mass walls and floor", heavy=True),
    _but(_900, "810", "absorptance inside 0.1", absorptance_inside=0.1),
)
"""The in-depth cases, by number."""

CASES: Final = {case.name: case for case in (*MAIN, *IN_DEPTH)}
"""Every case by its name."""


def chosen(names: Sequence[str]) -> list[Case]:
    """Select cases by their names, in the order of the catalogue.

    Parameters
    ----------
    names : sequence of str
        Numbers of cases, in upper or lower case.

    Returns
    -------
    list of Case

    Raises
    ------
    InputError
        There is no such case.

    Examples
    --------
    >>> [case.change for case in chosen(["900FF"])]
    ['no heating, no cooling']
    """
    for name in names:
        if name.upper() not in CASES:
            raise InputError(
                f"case: found '{name}'; expected one of {', '.join(CASES)}, or a building file (.yaml)."
            )
    selected = {name.upper() for name in names}
    return [case for case in CASES.values() if case.name in selected]
