"""Windows, blinds, air, gains and loads of a building, in words for the report."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.building import Building


def equipment(building: Building) -> list[list[str]]:
    """Rows of name and value: what the building has beside its surfaces.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin import load
    >>> from mascarin.examples import FOLDER
    >>> equipment(load(FOLDER / "reunion_house" / "building.yaml"))[0]
    ['window jalousie_living_north', '3.6 m2 in living_north, glazing clear']
    """
    parts = (_windows, _vents, _openings, _paths, _units, _of_zones, _heat_sources, _schedules)
    return [list(row) for part in parts for row in part(building)]


def _windows(building: Building) -> Iterator[tuple[str, str]]:
    for name, window in building.windows.items():
        blind = window.blind
        shaded = "" if blind is None else f", blind {blind.position}{_schedule(blind.schedule)}"
        yield f"window {name}", f"{_area(window.area)}in {window.surface}, glazing {window.glazing}{shaded}"


def _vents(building: Building) -> Iterator[tuple[str, str]]:
    for name, vent in building.vents.items():
        where = f"between {' and '.join(vent.between)}" if vent.between else f"of {vent.zone} to outdoors"
        control = "" if vent.control is None else ", controlled"
        yield f"vent {name}", f"{_area(vent.area)}{where}{_schedule(vent.schedule)}{control}"


def _openings(building: Building) -> Iterator[tuple[str, str]]:
    for name, opening in building.openings.items():
        yield f"opening {name}", f"of {opening.zone} to outdoors{_schedule(opening.schedule)}"


def _units(building: Building) -> Iterator[tuple[str, str]]:
    for name, unit in building.ventilation_units.items():
        flows = (("supply to", unit.supply), ("exhaust from", unit.exhaust))
        yield f"ventilation unit {name}", ", ".join(f"{way} {' and '.join(of)}" for way, of in flows if of)


def _heat_sources(building: Building) -> Iterator[tuple[str, str]]:
    for name, source in building.heat_sources.items():
        means = "electric" if source.electric is not None else "water"
        yield f"heat source {name}", f"{means}, in {source.surface} after {source.after}"


def _paths(building: Building) -> Iterator[tuple[str, str]]:
    for name, path in building.air_paths.items():
        kind = "door" if path.door is not None else "air"
        yield f"air path {name}", f"{kind} between {' and '.join(path.between)}{_schedule(path.schedule)}"


def _of_zones(building: Building) -> Iterator[tuple[str, str]]:
    for zone, part in building.zones.items():
        for name, air in part.ventilation.items():
            size = (
                f"{float(air.flow):.4g} m3/s"
                if air.flow is not None
                else f"{float(air.air_changes or 0.0):.4g} 1/h"
            )
            yield f"ventilation {name} of {zone}", f"{size}{_schedule(air.schedule)}"
        for name, gain in part.gains.items():
            size = f"column {gain.column}" if gain.column is not None else f"{float(gain.power or 0.0):.4g} W"
            yield f"internal gain {name} of {zone}", f"{size}{_schedule(gain.schedule)}"
        for what, loads in (("heating", part.heating), ("cooling", part.cooling)):
            if loads is not None:
                yield f"{what} of {zone}", f"ideal{_schedule(loads.schedule)}"


def _schedules(building: Building) -> Iterator[tuple[str, str]]:
    for name, schedule in building.schedules.items():
        column = getattr(schedule, "column", None)
        yield f"schedule {name}", f"{schedule.kind}{f', column {column}' if column else ''}"


def _area(area: float | None) -> str:
    return "" if area is None else f"{float(area):.4g} m2 "


def _schedule(name: object) -> str:
    """The schedule of a part; nothing where it acts at all times."""
    return f", schedule {name}" if isinstance(name, str) else ""
