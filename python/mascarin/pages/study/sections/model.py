"""The model: building, layers, assumptions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg import building_drawings
from mascarin.pages.study.data.labels import label_of
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.figures import rooms

TITLE = "Model"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    building = study.get("building")
    if not building:
        return None
    sensors = study.get("sensor_info", {})
    numbered = [
        {"number": n, "label": label_of(study, key), "output": info.get("output", "")}
        for n, (key, info) in enumerate(sensors.items(), start=1)
    ]
    return {
        "name": building.get("name", ""),
        "view": building_drawings.view(building),
        "rooms": _rooms(study),
        "section": building_drawings.section(building, sensors),
        "sensors": numbered,
        "layers": [
            {
                "name": text.plain_path(str(c.get("name"))),
                "drawing": building_drawings.layers(building, c, sensors),
                "surfaces": _built_so(building, str(c.get("name"))),
            }
            for c in building.get("constructions", [])
        ],
        "zones": [
            {"name": text.plain_path(str(z.get("name"))), "volume": text.with_unit(z.get("volume"), "m3")}
            for z in building.get("zones", [])
        ],
        "surfaces": [_surface(s) for s in building.get("surfaces", [])],
        "site": [[text.plain_path(str(k)), text.typeset(str(v))] for k, v in building.get("site", [])],
        "choices": [
            *([text.plain_path(str(k)), text.choice(str(v))] for k, v in building.get("choices", [])),
            *([["state at the start", text.typeset(str(study["start"]))]] if study.get("start") else []),
        ],
        "assumptions": _assumptions(study),
    }


def _rooms(study: Mapping[str, Any]) -> dict[str, Any] | None:
    """The plan of the rooms, and what its caption says."""
    room_drawing = rooms.plan_drawing(study)
    if room_drawing is None:
        return None
    drawing_of_rooms, plan, period = room_drawing
    return {"drawing": drawing_of_rooms, "exact": plan.exact, "period": period}


def _built_so(building: Mapping[str, Any], construction: str) -> list[str]:
    """Surfaces of a construction; none if the only one has the same name."""
    names = [
        text.plain_path(str(surface.get("name")))
        for surface in building.get("surfaces", [])
        if surface.get("construction") == construction
    ]
    return [] if names == [text.plain_path(construction)] else names


def _surface(surface: Mapping[str, Any]) -> dict[str, str]:
    return {
        "name": text.plain_path(str(surface.get("name"))),
        "construction": text.plain_path(str(surface.get("construction"))),
        "area": text.fixed(surface.get("area")),
        "tilt": text.fixed(surface.get("tilt"), 0),
        "azimuth": text.NONE
        if surface.get("tilt") in (0.0, 180.0)
        else text.fixed(surface.get("azimuth"), 0),
        "outside": text.plain_path(str(surface.get("outside", ""))),
        "inside": text.plain_path(str(surface.get("inside", ""))),
        "film_outside": text.choice(str(surface.get("film_outside", "") or text.NONE)),
        "film_inside": text.choice(str(surface.get("film_inside", "") or text.NONE)),
    }


def _assumptions(study: Mapping[str, Any]) -> list[dict[str, str]]:
    return [
        {
            "path": str(entry.get("path", "")),
            "value": text.significant(entry.get("value")),
            "range": f"{text.significant(entry.get('low'))} to {text.significant(entry.get('high'))}",
            "unit": units.shown(str(entry.get("unit", ""))),
            "source": str(entry.get("source", "")),
        }
        for entry in study.get("assumptions", [])
    ]
