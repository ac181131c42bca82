"""A model of EnergyPlus as a building of Mascarin."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date, timedelta
from pathlib import Path
from typing import Any

from mascarin.building import Building
from mascarin.energyplus.envelope.convection import ConvectionCoefficients
from mascarin.energyplus.envelope.idf_surfaces import read_openings, read_surfaces
from mascarin.energyplus.envelope.shades import describe_shades
from mascarin.energyplus.envelope.surfaces import describe_surfaces
from mascarin.energyplus.envelope.windows import describe_openings
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.findings import Finding
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import read
from mascarin.energyplus.model.schedules import calendar_year, day_of
from mascarin.energyplus.model.site import describe_site
from mascarin.energyplus.unsupported import note_unsupported
from mascarin.energyplus.zones.airflow import describe_air
from mascarin.energyplus.zones.conditioning import describe_conditioning, usual_temperatures
from mascarin.energyplus.zones.enclosures import describe_enclosures
from mascarin.energyplus.zones.gains import describe_gains
from mascarin.energyplus.zones.zones import describe_zones
from mascarin.errors import InputError


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
        Weather file (EPW) that gives the site where the model has no ``Site:Location``.

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
        raise InputError(f"{file}: found no surfaces; expected walls, floors and roofs of the zones")
    inside = read_openings(context, all_surfaces)
    describe_site(context, None if weather is None else Path(weather))
    zones = describe_zones(context, all_surfaces)
    coefficients = ConvectionCoefficients(context)
    surfaces = describe_surfaces(context, all_surfaces, coefficients)
    describe_openings(context, inside, coefficients, surfaces)
    describe_shades(context, all_surfaces, inside)
    describe_gains(context, zones, usual_temperatures(context, zones))
    describe_air(context, zones, all_surfaces, inside)
    describe_conditioning(context, zones)
    describe_enclosures(context, _built(context), zones)
    version = _version(context)
    note_unsupported(context)
    building = _built(context)
    start, end = _period(context)
    return Conversion(
        file=Path(file),
        version=version,
        building=building,
        description=_ordered(context),
        findings=tuple(context.findings.unique),
        names=context.names.original,
        start=start,
        end=end,
        steps_per_hour=_steps_per_hour(context),
    )


@reads("Version")
def _version(context: Context) -> str:
    return ".".join(str(part) for part in context.model.version[:2])


@reads("Timestep")
def _steps_per_hour(context: Context) -> int:
    step = context.model.one("Timestep")
    return int((step.number("number_of_timesteps_per_hour") if step is not None else None) or 6)


@reads("Building")
def _ordered(context: Context) -> Section:
    main = context.model.one("Building")
    title = (main.name if main is not None else "") or context.model.file.stem
    title = context.model.file.stem if title.casefold() == "none" else title
    return {"name": title} | context.ordered()


def _built(context: Context) -> Building:
    """The building as far as it is described.

    Raises
    ------
    InputError
        What the file describes is refused; the text names its objects.
    """
    try:
        return Building.from_dict(_ordered(context))
    except InputError as error:
        text = str(error)
        raise InputError(f"{context.model.file}: {text}{_origins(context, text)}") from None


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
    """First day, and day after the last one, of the first run period."""
    year, item = calendar_year(context), context.model.one("RunPeriod")
    values: dict[str, Any] = {}
    for key, default in (("begin", (1, 1)), ("end", (12, 31))):
        month = item.number(f"{key}_month") if item is not None else None
        day = item.number(f"{key}_day_of_month") if item is not None else None
        first = int(month or default[0]), int(day or default[1])
        values[key] = date(year, *default) if item is None else day_of(item, year, *first)
    last = values["end"] + timedelta(days=1)
    return values["begin"].isoformat(), last.isoformat()
