"""Laws of convection that moving air drives, and the air that moves in their zones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from mascarin.building.base.part import fault
from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.parts.air.zone import TextInfiltration

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.parts.description import Description

#: The name of the air that drives a law, and that of a law's own number of air changes in addition.
DRIVER: Final = "total_air_change"
MIXING: Final = "mixing"


def air_of_zone(building: Description, name: str) -> list[str]:
    """Parts that move air through a zone or within it, in words."""
    zone = building.zones[name]
    leaks = zone.infiltration
    parts = []
    if zone.mixing_air_change is not None:
        parts.append(f"{zone.mixing_air_change.in_words('1/h')} of mixing")
    stated = max(float(number) for number in (leaks.constant, leaks.temperature, leaks.wind))
    if stated > 0.0 or leaks.blower_door is not None or isinstance(leaks, TextInfiltration):
        parts.append("infiltration")
    parts += [f"ventilation {key}" for key in zone.ventilation]
    parts += [f"ventilation unit {key}" for key, unit in building.ventilation_units.items()
              if name in unit.supply or name in unit.exhaust]  # fmt: skip
    parts += [f"air path {key}" for key, path in building.air_paths.items()
              if path.one_way and path.between[1] == name]  # fmt: skip
    parts += [f"opening {key}" for key, opening in building.openings.items() if opening.zone == name]
    parts += [f"vent {key}" for key, vent in building.vents.items()
              if name in (vent.zone, *(vent.between or ()))]  # fmt: skip
    return parts


def driven_laws(building: Description) -> Iterator[tuple[str, str, bool]]:
    """Laws that moving air drives: path of the law, its zone, and whether it has air of its own."""
    for side in formula_sides(building):
        if not side.law.uses(DRIVER):
            continue
        section, name, which, _ = side.path.split(".")
        if section == "windows":
            zone = building.surfaces[building.windows[name].surface].inside.zone
        else:
            zone = getattr(building.surfaces[name], which).zone
        if zone is not None:
            mixing = side.law.numbers.get(MIXING)
            yield side.path, zone, mixing is not None and float(mixing) > 0.0


def forced_convection_faults(building: Description) -> Iterator[InitErrorDetails]:
    """Laws driven by the air that moves, in zones where none does."""
    for path, zone, has_air in driven_laws(building):
        if not has_air and not air_of_zone(building, zone):
            yield fault(
                tuple(path.split(".")),
                f"a law of convection that moving air drives, in zone '{zone}' where nothing moves any",
                "air that flows into the zone or that a fan moves within it",
                f"Write 'mixing_air_change: 10' [1/h] or 'ventilation:' in zone '{zone}', or take a law of "
                "natural convection such as tarp.",
            )


def forced_convection_lines(building: Description) -> Iterator[str]:
    """Which laws follow which air, for the summary."""
    by_zone: dict[str, list[str]] = {}
    for path, zone, _ in driven_laws(building):
        by_zone.setdefault(zone, []).append(path.removesuffix(".convection"))
    for zone, paths in by_zone.items():
        air = ", ".join(air_of_zone(building, zone)) or "air of the law's own number"
        words = f"zone {zone}: forced convection by {air} at {', '.join(paths)}"
        yield f"{words}; recorded as {zone}.total_air_changes"
