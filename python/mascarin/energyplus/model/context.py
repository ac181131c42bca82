"""What the parts of a conversion share: the file, the findings, names, and the sections so far."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Final

from mascarin.building.parts.description import Description
from mascarin.energyplus.model.findings import Findings
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfModel, IdfObject
from mascarin.energyplus.model.year import Year

Section = dict[str, Any]
#: Sections of a description, in its order: that of the written file.
SECTIONS: Final = tuple(name for name in Description.model_fields if name != "name")

#: Sections whose parts have results.
_WITH_RESULTS: Final = ("zones", "surfaces", "windows", "vents", "controls", "heat_sources")


@dataclass
class Names:
    """Names of Mascarin for names of EnergyPlus.

    Attributes
    ----------
    by_original : dict of (str, str) to str
        Name by section and name in the file, in small letters.
    original : dict of str to dict of str to str
        Name by name in the file, by section.
    """

    by_original: dict[tuple[str, str], str] = field(default_factory=dict)
    original: dict[str, dict[str, str]] = field(default_factory=dict)
    taken: set[tuple[str, str]] = field(default_factory=set)

    def of(self, section: str, name: str, kind: str = "") -> str:
        """Name of a part: letters, digits and ``_``; the same for the same name without regard to case.

        Parameters
        ----------
        section : str
            Section of the description.
        name : str
            Name in the file.
        kind : str
            Class of the object, where objects of several classes may have one name.
        """
        key = (section, f"{kind}|{name.strip()}".casefold())
        if key not in self.by_original:
            self.by_original[key] = self.new(section, name)
            held = self.original.setdefault(section, {})
            original = f"{kind} {name.strip()}" if kind and name.strip() in held else name.strip()
            held[original] = self.by_original[key]
        return self.by_original[key]

    def entered(self, section: str, name: str) -> str | None:
        """Name of a part that was described before; None where there is none.

        Parameters
        ----------
        section, name : str
            As for `of`, without a class.
        """
        return self.by_original.get((section, f"|{name.strip()}".casefold()))

    def new(self, section: str, name: str) -> str:
        """A name like this one that no other part has."""
        # Results are named after them: one set of names.
        room = "parts" if section in _WITH_RESULTS else section
        plain = re.sub(r"\W+", "_", name.strip()).strip("_") or section.rstrip("s")
        if not plain.isidentifier():
            # Gains and the like are held by zone: the first word says what they are.
            plain = f"{section.split()[0].rstrip('s')}_{plain}"
        candidate, count = plain, 1
        while (room, candidate.casefold()) in self.taken:
            count += 1
            candidate = f"{plain}_{count}"
        self.taken.add((room, candidate.casefold()))
        return candidate


@dataclass(frozen=True)
class Vapour:
    """A source of vapour in a zone.

    Attributes
    ----------
    item : IdfObject
        The object.
    zone : str
        Name of the zone in the description.
    latent : Year
        Latent heat; of people all heat. [W]
    activity : float or None
        Heat of the activity of a person, where it is all heat of people. [W]
    """

    item: IdfObject
    zone: str
    latent: Year
    activity: float | None = None


@dataclass
class Context:
    """A conversion in progress.

    Attributes
    ----------
    model : IdfModel
        The file.
    findings : Findings
        What is not carried over as it is.
    names : Names
        Names of the parts.
    sections : dict of str to dict
        The description, as far as it is made.
    years : dict of str to Year
        Schedules of the file that were read, by name in small letters.
    shapes : dict of str to str
        Schedules of the description by what they say.
    resistances : dict of str to float
        Whole resistance of the materials without mass, which may be several layers. [m2 K/W]
    systems : dict of str to str
        Zone in the file by the name of its ideal loads system.
    moist : dict of str to bool
        Whether EnergyPlus solves vapour in the skin of a surface, by its name in the description; that of
        surfaces that are not named under ``''``.
    vapour : list of Vapour
        Sources of vapour.
    special_days : dict of str to bool
        Whether the weather file has ``daylight saving`` and ``holidays``; empty without a weather file.
    yearly_air : float or None
        Yearly mean of the outdoor air; None without a weather file. [degC]
    """

    model: IdfModel
    findings: Findings = field(default_factory=Findings)
    names: Names = field(default_factory=Names)
    sections: dict[str, Section] = field(default_factory=dict)
    years: dict[str, Year] = field(default_factory=dict)
    shapes: dict[str, str] = field(default_factory=dict)
    resistances: dict[str, float] = field(default_factory=dict)
    systems: dict[str, str] = field(default_factory=dict)
    moist: dict[str, bool] = field(default_factory=dict)
    vapour: list[Vapour] = field(default_factory=list)
    special_days: dict[str, bool] = field(default_factory=dict)
    yearly_air: float | None = None

    def section(self, name: str) -> Section:
        """A section of the description.

        Raises
        ------
        KeyError
            A description has no such section: it would be lost.
        """
        if name not in SECTIONS:
            raise KeyError(f"{name}: expected one of {', '.join(SECTIONS)}")
        return self.sections.setdefault(name, {})

    @property
    def has_vapour(self) -> bool:
        """Whether EnergyPlus solves vapour in the skin of any surface."""
        return any(self.moist.values())

    def ordered(self) -> Section:
        """All sections that are not empty, in the order of the description."""
        return {name: self.sections[name] for name in SECTIONS if self.sections.get(name)}

    @reads("Zone")
    def zone_items(self) -> list[IdfObject]:
        """Zones of the file."""
        return self.model.of("Zone")

    def zones_of(self, user: IdfObject, *keys: str) -> list[IdfObject]:
        """Zones that a field names: a zone, a list of zones, a space or a list of spaces.

        Raises
        ------
        InputError
            There is no such zone.
        """
        return [zone for zone, _ in self.places_of(user, *keys)]

    @reads("Zone", "ZoneList", "Space", "SpaceList")
    def places_of(self, user: IdfObject, *keys: str) -> list[tuple[IdfObject, IdfObject | None]]:
        """Zones that a field names, each with the space in it where one is named.

        Raises
        ------
        InputError
            There is no such zone.
        """
        model, name_of_target = self.model, user.text(*keys)
        if (zone := model.named(name_of_target, "Zone")) is not None:
            return [(zone, None)]
        if (zones := model.named(name_of_target, "ZoneList")) is not None:
            return [
                (model.require(zones, "zone_name", "Zone", name=name), None)
                for name in listed(zones, "zones")
            ]
        if (space := model.named(name_of_target, "Space")) is not None:
            return [(model.require(space, "zone_name", "Zone"), space)]
        if (spaces := model.named(name_of_target, "SpaceList")) is not None:
            space_objects = [
                model.require(spaces, "space_name", "Space", name=n) for n in listed(spaces, "spaces")
            ]
            return [(model.require(space, "zone_name", "Zone"), space) for space in space_objects]
        # Named so that the error lists the zones.
        key = next((key for key in keys if user.text(key)), keys[0])
        target = model.require(user, key, "Zone", "ZoneList", "Space", "SpaceList", name=name_of_target)
        return [(target, None)]


def listed(item: IdfObject, wrapper: str) -> list[str]:
    """Names in the groups of a list."""
    return [str(value) for row in item.rows(wrapper) for value in row.values()]
