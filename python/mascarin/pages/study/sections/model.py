"""The model: building, layers, assumptions."""

from __future__ import annotations

from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg import building_drawings
from mascarin.pages.study.data.labels import label_of
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.figures import rooms
from mascarin.study_document.building import BuildingEntry, SurfaceEntry
from mascarin.study_document.document import StudyDocument

TITLE = "Model"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    building = study.building
    if not study.states("building"):
        return None
    sensors = study.sensor_info
    numbered = [
        {"number": n, "label": label_of(study, key), "output": info.output}
        for n, (key, info) in enumerate(sensors.items(), start=1)
    ]
    drawings = [building_drawings.layers(building, c, sensors) for c in building.constructions]
    return {
        "name": building.name,
        "melting": any(layer.kind == "pcm" for c in building.constructions for layer in c.layers),
        "marked": any(building_drawings.SENSOR in drawing for drawing in drawings),
        "windows": bool(building.windows),
        "doors": bool(building.doors),
        "view": building_drawings.view(building),
        "rooms": _rooms(study),
        "section": building_drawings.section(building, sensors),
        "sensors": numbered,
        "layers": [
            {
                "name": text.plain_path(c.name),
                "drawing": drawing,
                "surfaces": _built_so(building, c.name),
            }
            for c, drawing in zip(building.constructions, drawings, strict=True)
        ],
        "zones": [
            {"name": text.plain_path(z.name), "volume": text.with_unit(z.volume, "m3")}
            for z in building.zones
        ],
        "surfaces": [_surface(s) for s in building.surfaces],
        "site": [[text.plain_path(str(k)), text.typeset(str(v))] for k, v in building.site],
        "equipment": [[text.plain_path(name), text.typeset(words)] for name, words in building.equipment],
        "choices": [
            *([text.plain_path(str(k)), text.choice(str(v))] for k, v in building.choices),
            *([["state at the start", text.typeset(study.start)]] if study.start else []),
        ],
        "assumptions": _assumptions(study),
    }


def _rooms(study: StudyDocument) -> dict[str, Any] | None:
    """The plan of the rooms, and what its caption says."""
    room_drawing = rooms.plan_drawing(study)
    if room_drawing is None:
        return None
    drawing_of_rooms, plan, period = room_drawing
    return {"drawing": drawing_of_rooms, "exact": plan.exact, "period": period}


def _built_so(building: BuildingEntry, construction: str) -> list[str]:
    """Surfaces of a construction; none if the only one has the same name."""
    names = [
        text.plain_path(surface.name) for surface in building.surfaces if surface.construction == construction
    ]
    return [] if names == [text.plain_path(construction)] else names


def _surface(surface: SurfaceEntry) -> dict[str, str]:
    return {
        "name": text.plain_path(surface.name),
        "construction": text.plain_path(surface.construction),
        "area": text.fixed(surface.area),
        "tilt": text.fixed(surface.tilt, 0),
        "azimuth": text.NONE if surface.tilt in (0.0, 180.0) else text.fixed(surface.azimuth, 0),
        "outside": text.plain_path(surface.outside),
        "inside": text.plain_path(surface.inside),
        "film_outside": text.choice(str(surface.film_outside or text.NONE)),
        "film_inside": text.choice(str(surface.film_inside or text.NONE)),
    }


def _assumptions(study: StudyDocument) -> list[dict[str, str]]:
    return [
        {
            "path": entry.path,
            "value": text.significant(entry.value),
            "range": f"{text.significant(entry.low)} to {text.significant(entry.high)}",
            "unit": units.shown(entry.unit),
            "source": entry.source or "",
        }
        for entry in study.assumptions
    ]
