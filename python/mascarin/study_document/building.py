"""The building of a study in its results."""

from __future__ import annotations

from mascarin.study_document.entry import Num, ResultEntry


class LayerEntry(ResultEntry):
    """A layer of a construction; two numbers are those of the solid and of the liquid."""

    name: str = ""
    material: str | None = None
    kind: str = "solid"
    """``solid``, ``resistance`` or ``pcm``."""
    thickness: Num | None = None
    """[m]"""
    conductivity: Num | list[Num] | None = None
    """[W/(m K)]"""
    density: Num | list[Num] | None = None
    """[kg/m3]"""
    specific_heat: Num | list[Num] | None = None
    """[J/(kg K)]"""
    resistance: Num | None = None
    """[m2 K/W]"""
    latent_heat: Num | list[Num] | None = None
    """[J/kg]"""
    melting_temperature: Num | list[Num] | None = None
    """[degC]"""
    nodes: int | None = None


class ConstructionEntry(ResultEntry):
    """A construction, from outside to inside."""

    name: str = ""
    layers: list[LayerEntry] = []


class SurfaceEntry(ResultEntry):
    """A surface of the building."""

    name: str = ""
    construction: str = ""
    area: Num | None = None
    """[m2]"""
    tilt: Num | None = None
    """[deg]"""
    azimuth: Num | None = None
    """[deg]"""
    outside: str = ""
    """What is on the outside: ``outdoors``, a zone, ``ground``, the measured column, ``adiabatic``."""
    inside: str = ""
    vertices: list[list[Num]] = []
    """[m]"""
    film_outside: str = ""
    film_inside: str = ""


class ZoneEntry(ResultEntry):
    """A zone."""

    name: str = ""
    volume: Num | None = None
    """[m3]"""


class WindowEntry(ResultEntry):
    """A window and the surface that it is in."""

    name: str = ""
    surface: str = ""


class ProbeEntry(ResultEntry):
    """A thermometer in a wall."""

    name: str = ""
    surface: str = ""
    depth: Num = 0.0
    """From the outside. [m]"""


class BuildingEntry(ResultEntry):
    """The building."""

    name: str = ""
    site: list[list[str]] = []
    """Rows of name and value, as text with units."""
    zones: list[ZoneEntry] = []
    constructions: list[ConstructionEntry] = []
    surfaces: list[SurfaceEntry] = []
    windows: list[WindowEntry] = []
    doors: list[list[str]] = []
    """Pairs of zones that a door joins."""
    probes: list[ProbeEntry] = []
    equipment: list[list[str]] = []
    """Rows of name and value: windows and blinds, vents, air paths, ventilation, gains, loads, schedules."""
    choices: list[list[str]] = []
    """Rows of name and value of modeling choices."""


class AssumptionEntry(ResultEntry):
    """An assumed value."""

    path: str = ""
    value: Num | None = None
    unit: str = ""
    low: Num | None = None
    high: Num | None = None
    source: str | None = ""
    assumed: bool = True
