"""A model of EnergyPlus as a building of Mascarin."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Final

import numpy as np

from mascarin.building import Building
from mascarin.energyplus.envelope.convection import ConvectionCoefficients
from mascarin.energyplus.envelope.idf_surfaces import read_openings, read_surfaces
from mascarin.energyplus.envelope.shades import describe_shades
from mascarin.energyplus.envelope.surfaces import describe_surfaces
from mascarin.energyplus.envelope.windows import describe_openings
from mascarin.energyplus.ledger import note_unread
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.dates import calendar_year, day_of, steps_per_hour
from mascarin.energyplus.model.findings import Finding
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject, read
from mascarin.energyplus.model.site import describe_site
from mascarin.energyplus.unsupported import note_unsupported
from mascarin.energyplus.zones.airflow import describe_air
from mascarin.energyplus.zones.conditioning import (
    describe_conditioning,
    usual_temperatures,
)
from mascarin.energyplus.zones.enclosures import describe_enclosures
from mascarin.energyplus.zones.gains import describe_gains
from mascarin.energyplus.zones.humidity import describe_humidity
from mascarin.energyplus.zones.radiant import Envelope
from mascarin.energyplus.zones.water import describe_water
from mascarin.energyplus.zones.zones import describe_zones
from mascarin.errors import InputError
from mascarin.weather.reading.shipped import found

#: Lines of an error that are shown.
_MOST_LINES: Final = 40


@dataclass(frozen=True)
class Conversion:
    """A converted model.

    Attributes
    ----------
    file : Path
        The file.
    version : str
        Version of EnergyPlus that it is written for.
    building : Building
        The building.
    description : dict
        Content of its YAML file.
    findings : tuple of Finding
        What is not carried over as it is, object by object; see `Finding`.
    names : dict of str to dict of str to str
        Names of the building by section and name in the file.
    start, end : str
        Period of the run, in a year with the same days of the week.
    steps_per_hour : int
        Number of time steps of EnergyPlus in an hour.
    systems : dict of str to str
        Zone in the file by the name of its ideal loads system.
    """

    file: Path
    version: str
    building: Building
    description: Section
    findings: tuple[Finding, ...]
    names: dict[str, dict[str, str]]
    start: str
    end: str
    steps_per_hour: int
    systems: dict[str, str]

    @property
    def complete(self) -> bool:
        """Whether nothing that changes the results was left out."""
        return not any(finding.level == "left out" for finding in self.findings)


def convert(file: str | Path, *, weather: str | Path | None = None) -> Conversion:
    """Convert a model of EnergyPlus.

    Parameters
    ----------
    file : str or Path
        IDF or epJSON file of version 8.9 or later.
    weather : str or Path, optional
        Weather file (EPW) that gives the site where the model has no ``Site:Location``; or
        ``shipped:NAME`` of a climate that comes with Mascarin.

    Returns
    -------
    Conversion
        The building, and what is not carried over.

    Raises
    ------
    InputError
        The file cannot be read, or an object cannot be used; the text names its line, class and name.

    Examples
    --------
    >>> from mascarin.energyplus import convert
    >>> convert("office.idf")  # doctest: +SKIP
    """
    context = Context(read(Path(file)))
    all_surfaces = read_surfaces(context)
    if not all_surfaces and not context.model.of("InternalMass"):
        count = len(context.model.of_class("Zone"))
        raise InputError(
            f"{file}: found {count or 'no'} Zone and no surfaces; expected walls, floors and roofs of zones. "
            "There is no building to convert where a file has plants or schedules alone"
        )
    inside = read_openings(context, all_surfaces)
    describe_site(context, None if weather is None else found(weather))
    zones = describe_zones(context, all_surfaces)
    coefficients = ConvectionCoefficients(context)
    surfaces = describe_surfaces(context, all_surfaces, coefficients)
    describe_openings(context, inside, coefficients, surfaces)
    describe_shades(context, all_surfaces, inside)
    air = usual_temperatures(context, zones)
    describe_gains(context, zones)
    describe_water(context, zones, air)
    describe_air(context, zones, all_surfaces, inside, air)
    by_name = {surface.item.name.casefold(): surface for surface in all_surfaces}
    describe_conditioning(context, zones, Envelope(by_name, inside, surfaces))
    describe_humidity(context, air)
    describe_enclosures(context, _built(context), zones)
    version = _version(context)
    start, end = _period(context)
    steps = steps_per_hour(context)
    note_unsupported(context)
    note_unread(context)
    building = _built(context)
    return Conversion(
        file=Path(file),
        version=version,
        building=building,
        description=_ordered(context),
        findings=tuple(context.findings.unique),
        names=context.names.original,
        start=start,
        end=end,
        steps_per_hour=steps,
        systems=context.systems,
    )


@reads("Version")
def _version(context: Context) -> str:
    return ".".join(str(part) for part in context.model.version[:2])


@reads("Building")
def _ordered(context: Context) -> Section:
    main = context.model.one("Building")
    title = (main.name if main is not None else "") or context.model.file.stem
    title = context.model.file.stem if title.casefold() == "none" else title
    return {"name": title} | context.ordered()


def _built(context: Context) -> Building:
    """The building as far as it is described.

    Parts whose corners a description refuses keep their areas and directions.

    Raises
    ------
    InputError
        What the file describes is refused; the text names its objects.
    """
    while True:
        try:
            return Building.from_dict(_ordered(context))
        except InputError as error:
            text = str(error)
            if not _flattened(context, text):
                text = _short(text)
                raise InputError(f"{context.model.file}: {text}{_origins(context, text)}") from None


def _flattened(context: Context, text: str) -> bool:
    """Whether corners that an error names were given up, in favour of areas."""
    surfaces, windows = context.section("surfaces"), context.section("windows")
    refused = {match[1] for match in re.finditer(r"windows\.(\w+)\.vertices\n", text)}
    for match in re.finditer(r"surfaces '([^']+)' and '([^']+)' cover the same area", text):
        twins = [name for name in match.groups() if "vertices" in surfaces.get(name, {})]
        for name in twins[-1:]:
            points = np.array(surfaces[name].pop("vertices"))
            surfaces[name] |= g.flat(points)
            refused |= {window for window, held in windows.items() if held["surface"] == name}
            _note_flat(context, "surfaces", name, "it covers another surface")
    done = bool(twins) if (twins := re.findall("cover the same area", text)) else False
    for name in refused:
        points = windows.get(name, {}).pop("vertices", None)
        if points is not None:
            windows[name].setdefault("area", round(g.area_of(np.array(points)), 6))
            _note_flat(context, "windows", name, "its corners do not fit its wall and what is in it")
            done = True
    return done


def _note_flat(context: Context, section: str, name: str, what: str) -> None:
    original = next(
        (key for key, entered in context.names.original.get(section, {}).items() if entered == name), name
    )
    for item in context.model.items:
        if item.name.casefold() == original.casefold() and item.kind.casefold() in context.model.read:
            context.findings.approximated(item, what, "area and direction alone: nothing shades it")
            return


def _short(text: str) -> str:
    """An error of many lines as far as one reads it."""
    lines = text.splitlines()
    if len(lines) <= _MOST_LINES:
        return text
    return "\n".join([*lines[:_MOST_LINES], f"and {len(lines) - _MOST_LINES} lines more"])


def _origins(context: Context, text: str) -> str:
    """Lines on the objects behind the names of an error."""
    lines = {item.name.casefold(): item for item in reversed(context.model.items)}
    lines_of_objects = []
    for section, names in context.names.original.items():
        for name, entered_name in names.items():
            item = lines.get(name.casefold())
            if item is not None and re.search(
                rf"\b{section}\.{re.escape(entered_name)}\b|'{re.escape(entered_name)}'", text
            ):
                lines_of_objects.append(f"\n  {section}.{entered_name} is {item.where}")
    return "".join(lines_of_objects)


@reads("RunPeriod")
def _period(context: Context) -> tuple[str, str]:
    """First day, and day after the last one, of the first run period; the others are noted."""
    year = calendar_year(context)
    items = context.model.of("RunPeriod")
    for item in items[1:]:
        start, end = _days_of(item, year)
        # The year and its first day of the week are those of the first period.
        for pattern in ("*_year", "day_of_week_for_start_day"):
            item.fields.pass_over(pattern)
        context.findings.no_effect(
            [item], "another run period", f"the same building, with --start {start} --end {end}"
        )
    return _days_of(items[0], year) if items else (f"{year}-01-01", f"{year + 1}-01-01")


def _days_of(item: IdfObject, year: int) -> tuple[str, str]:
    """First day of a run period, and day after its last one."""
    days = []
    for key, default in (("begin", (1, 1)), ("end", (12, 31))):
        month, day = item.number(f"{key}_month"), item.number(f"{key}_day_of_month")
        days.append(day_of(item, year, int(month or default[0]), int(day or default[1])))
    return days[0].isoformat(), (days[1] + timedelta(days=1)).isoformat()
