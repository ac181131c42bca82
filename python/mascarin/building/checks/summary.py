"""A building in short: rows for its text, tables for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from mascarin.building.checks.u_values import u_value, window_u_value
from mascarin.building.outputs.output import outputs
from mascarin.building.parameters.parameter import Parameter
from mascarin.building.parts.air.zone import IdealLoads
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.surface import Side

if TYPE_CHECKING:
    import pandas as pd

_NAMES = 8


def rows(building: Description, parameters: Sequence[Parameter]) -> list[tuple[str, str]]:
    """Site, sections and numbers of results and parameters.

    Parameters
    ----------
    building : Description
        The building.
    parameters : sequence of Parameter
        Its parameters.
    """
    site = building.site
    lines = [
        (
            "site",
            f"{site.latitude:g} deg N, {site.longitude:g} deg E, {site.altitude:g} m, {site.timezone}",
        )
    ]
    sections = (
        "zones",
        "surfaces",
        "windows",
        "constructions",
        "materials",
        "glazings",
        "schedules",
        "air_paths",
        "ventilation_units",
        "openings",
        "vents",
        "controls",
        "heat_sources",
        "shades",
        "sensors",
    )
    lines += [
        (section, f"{len(getattr(building, section))}: {_listed(getattr(building, section))}")
        for section in sections
        if getattr(building, section)
    ]
    lines.append(("parameters", f"{len(parameters)}, {sum(p.varies for p in parameters)} of which may vary"))
    lines.append(("outputs", str(len(outputs(building)))))
    return lines


def tables(building: Description, parameters: Sequence[Parameter]) -> dict[str, pd.DataFrame]:
    """Zones, surfaces, windows and parameters as tables by heading."""
    import pandas as pd

    by_title = {
        "Zones": pd.DataFrame(
            {
                "volume [m3]": {name: zone.volume for name, zone in building.zones.items()},
                "surfaces": {name: len(building.connections.sides(name)) for name in building.zones},
                "heating [degC]": {name: _set_point(zone.heating) for name, zone in building.zones.items()},
                "cooling [degC]": {name: _set_point(zone.cooling) for name, zone in building.zones.items()},
            }
        ),
        "Surfaces": pd.DataFrame.from_dict(
            {
                name: {
                    "construction": surface.construction,
                    "area [m2]": surface.area,
                    "tilt [deg]": surface.tilt,
                    "azimuth [deg]": surface.azimuth,
                    "outside": _facing(surface.outside),
                    "inside": _facing(surface.inside),
                    "U [W/(m2 K)]": round(u_value(building, surface), 3),
                }
                for name, surface in building.surfaces.items()
            },
            orient="index",
        ),
        "Windows": pd.DataFrame.from_dict(
            {
                name: {
                    "glazing": window.glazing,
                    "surface": window.surface,
                    "area [m2]": window.area,
                    "U [W/(m2 K)]": round(window_u_value(building, window), 3),
                }
                for name, window in building.windows.items()
            },
            orient="index",
        ),
        "Parameters": pd.DataFrame(
            [(p.path, p.value, p.unit, p.low, p.high, p.source or "") for p in parameters],
            columns=["path", "value", "unit", "low", "high", "source"],
        ).set_index("path"),
    }
    return {heading: table for heading, table in by_title.items() if len(table)}


def _listed(names: Iterable[str]) -> str:
    all_names = list(names)
    return ", ".join([*all_names[:_NAMES], *(["..."] if len(all_names) > _NAMES else [])])


def _set_point(loads: IdealLoads | None) -> str:
    if loads is None:
        return ""
    schedule = loads.setpoint.schedule
    return f"{loads.setpoint.temperature:g}" if schedule is None else f"schedule {schedule}"


def _facing(side: Side) -> str:
    return side.zone or side.in_words()
