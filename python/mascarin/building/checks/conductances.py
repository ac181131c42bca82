"""What the zones of a building lose heat through, and to: every element, bridge and exchange of air.

The zones have entry temperature and each destination another entry. Surface resistances are those that are
described (see `mascarin.building.checks.u_values`): laws by wind at 4 m/s, correlations as in ISO 6946.
Infiltration is taken at the same wind and a temperature difference of 10 K.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

from mascarin.building.checks.u_values import described_u_value, described_window_u_value
from mascarin.building.parts.air.zone import TextInfiltration
from mascarin.building.parts.site_air import heat_capacity
from mascarin.physics import leakage_air_changes

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from mascarin.building.parts.air.leakage import LeakageLaw
    from mascarin.building.parts.air.zone import Zone
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Surface
    from mascarin.building.parts.openings.window import Window

#: Wind [m/s] and temperature difference [K] at which infiltration is taken.
WIND: Final = 4.0
DIFFERENCE: Final = 10.0

Kind = Literal["surface", "window", "thermal bridge", "infiltration", "ventilation", "air path"]
#: Kinds in the order of sums, with what several of them are called.
KINDS: Final[dict[str, str]] = {
    "surface": "surfaces",
    "window": "windows",
    "thermal bridge": "thermal bridges",
    "infiltration": "infiltration",
    "ventilation": "ventilation",
    "air path": "air paths",
}
#: How the numbers are meant.
BASIS: Final = (
    "Surface resistances as described: laws by wind at 4 m/s, correlations as in ISO 6946; infiltration, "
    "with that of pressure tests, at 4 m/s and 10 K; ventilation and air paths with their whole constant "
    "flow. Flows of measured columns, doors, openings and vents are left out: they change with time."
)


@dataclass(frozen=True, slots=True)
class Conductance:
    """Heat per degree from a zone to a destination through entry element.

    Attributes
    ----------
    zone, element : str
        The zone that loses heat, and the surface, window, bridge or exchange of air.
    kind : str
        What the element is.
    destination : str
        ``outdoors``, ``ground``, the columns or the schedule of a temperature, or ``zone NAME``.
    value : float
        Heat per degree. [W/K]

    Examples
    --------
    >>> Conductance("room", "south", "surface", "outdoors", 12.5).value
    12.5
    """

    zone: str
    element: str
    kind: Kind
    destination: str
    value: float

    def to_dict(self) -> dict[str, Any]:
        """Return plain values."""
        keys = ("zone", "element", "kind", "destination", "value")
        return {key: getattr(self, key) for key in keys}


def conductances(building: Description) -> list[Conductance]:
    """Conductances of all zones by destination.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of Conductance
        Those to other zones stand once, with the zone of the inner side.

    References
    ----------
    ISO 13789:2017 (heat transfer coefficients of transmission and ventilation).

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [(entry.element, entry.destination) for entry in conductances(box())]
    [('facade', 'outdoors'), ('infiltration', 'outdoors')]
    """
    entries = [*_surfaces(building), *_bridges(building), *_air(building)]
    order = {zone: number for number, zone in enumerate(building.zones)}
    return sorted((entry for entry in entries if entry.value != 0.0), key=lambda entry: order[entry.zone])


def destination_of(surface: Surface) -> str | None:
    """What a surface loses heat to, in words; None for mass in a zone and where a side is adiabatic."""
    if surface.internal_mass or surface.outside.closed or surface.inside.closed:
        return None
    inner, outer = surface.inside, surface.outside
    if inner.zone is None:
        inner, outer = outer, inner
    if inner.zone is None:
        return None
    return f"zone {outer.zone}" if outer.zone is not None else outer.in_words()


def opaque_area(building: Description, name: str) -> float:
    """Area of a surface without its windows. [m2]"""
    inside = building.connections.windows_in(name).values()
    glazed = sum(float(window.area or 0.0) for window in inside)
    return max(float(building.surfaces[name].area or 0.0) - glazed, 0.0)


def window_conductance(building: Description, window: Window) -> float:
    """Heat per degree through a window with its frame, by the coefficients described. [W/K]"""
    glass, area = described_window_u_value(building, window), float(window.area or 0.0)
    if window.frame is None:
        return glass * area
    share = float(window.frame.fraction)
    return ((1.0 - share) * glass + share * float(window.frame.u_value)) * area


def infiltration_rate(zone: Zone) -> float:
    """Air changes of infiltration at 4 m/s and 10 K, with those of a pressure test. [1/h]"""
    leak = zone.infiltration
    rate = float(leak.constant) + float(leak.wind) * WIND + float(leak.temperature) * DIFFERENCE
    if isinstance(leak, TextInfiltration):
        rate += float(leak.value(DIFFERENCE, WIND))
    return rate + (0.0 if leak.blower_door is None else leakage_rate(leak.blower_door))


def leakage_rate(test: LeakageLaw) -> float:
    """Air changes by a pressure test at 4 m/s and 10 K. [1/h]"""
    numbers = {number.name: float(getattr(test, number.name)) for number in test.row.numbers}
    return leakage_air_changes(test.kind, numbers, WIND, DIFFERENCE)


def totals(entries: Iterable[Conductance]) -> dict[str, dict[str, float]]:
    """Sums by destination and kind, those to other zones left out. [W/K]"""
    sums: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for entry in entries:
        if not entry.destination.startswith("zone "):
            sums[entry.destination][entry.kind] += entry.value
    return {to: {kind: kinds[kind] for kind in KINDS if kind in kinds} for to, kinds in sums.items()}


#: Title of the table of a page.
TITLE: Final = "Conductances by destination"
#: What a row of sums has in place of an element.
SUM: Final = "all"


def by_destination(entries: Iterable[Conductance]) -> list[Conductance]:
    """Sort conductances by destination and kind, each destination led by its sum.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [entry.element for entry in by_destination(conductances(box()))]
    ['all', 'facade', 'infiltration']
    """
    order = {kind: number for number, kind in enumerate(KINDS)}
    groups: dict[str, list[Conductance]] = defaultdict(list)
    for entry in entries:
        groups[entry.destination].append(entry)
    rows = []
    for to, group in sorted(groups.items(), key=lambda pair: pair[0].startswith("zone ")):
        rows.append(Conductance(SUM, SUM, "surface", to, sum(entry.value for entry in group)))
        rows += sorted(group, key=lambda entry: order[entry.kind])
    return rows


def conductance_lines(building: Description) -> Iterator[str]:
    """Sums by destination, then those of each zone and those between zones, in words."""
    entries = conductances(building)
    by_destination = totals(entries)
    for destination, kinds in by_destination.items():
        parts = ", ".join(f"{KINDS[kind]} {value:.2f}" for kind, value in kinds.items())
        yield f"heat loss to {destination}: {sum(kinds.values()):.2f} W/K ({parts})"
    if len(by_destination) > 1:
        total = sum(sum(kinds.values()) for kinds in by_destination.values())
        yield f"heat loss in all: {total:.2f} W/K"
    if len(building.zones) > 1:
        for zone in building.zones:
            sums: dict[str, float] = defaultdict(float)
            for entry in entries:
                if entry.zone == zone:
                    sums[entry.destination] += entry.value
                elif entry.destination == f"zone {zone}":
                    sums[f"zone {entry.zone}"] += entry.value
            if sums:
                parts = ", ".join(f"{value:.2f} to {to}" for to, value in sums.items())
                yield f"zone {zone}: conductances [W/K] {parts}"


def _surfaces(building: Description) -> Iterator[Conductance]:
    for name, surface in building.surfaces.items():
        destination = destination_of(surface)
        if destination is None:
            continue
        zone = str(surface.inside.zone or surface.outside.zone)
        u_value = described_u_value(building, surface)
        yield Conductance(zone, name, "surface", destination, u_value * opaque_area(building, name))
        for key, window in building.connections.windows_in(name).items():
            yield Conductance(zone, key, "window", destination, window_conductance(building, window))


def _bridges(building: Description) -> Iterator[Conductance]:
    for zone, part in building.zones.items():
        for name, bridge in part.thermal_bridges.items():
            measured = " and ".join(bridge.measured_columns)
            to = f"measured {measured}" if measured else bridge.faces
            if bridge.zone is not None:
                to = f"zone {bridge.zone}"
            yield Conductance(zone, name, "thermal bridge", to, bridge.conductance)


def _air(building: Description) -> Iterator[Conductance]:
    heat = heat_capacity(building.site)
    for zone, part in building.zones.items():
        volume = float(part.volume or 0.0)
        rate = infiltration_rate(part)
        yield Conductance(zone, "infiltration", "infiltration", "outdoors", heat * volume * rate / 3600.0)
        for name, air in part.ventilation.items():
            flow = float(air.flow or 0.0) + float(air.air_changes or 0.0) * volume / 3600.0
            yield Conductance(zone, name, "ventilation", "outdoors", heat * flow)
    for name, path in building.air_paths.items():
        to, zone = path.between if path.one_way else path.between[::-1]
        yield Conductance(zone, name, "air path", f"zone {to}", heat * path.number)
    for name, unit in building.ventilation_units.items():
        lost = 1.0 - float(unit.recovery or 0.0)
        to = "outdoors" if unit.temperature is None else f"air of {unit.temperature.words}"
        for zone, supplied in unit.supply.items():
            yield Conductance(zone, name, "ventilation", to, heat * supplied.number * lost)
