"""What a building has beside its surfaces and layers, in words for the report.

Every section of a description is in `SECTIONS`: with the word by which its parts have rows, or with the place
of the report that shows them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part

if TYPE_CHECKING:
    from mascarin.building import Building

#: What a part of a section is called in its row; a section without a word has its place elsewhere.
SECTIONS: Final[Mapping[str, str]] = {
    "name": "", "site": "", "constructions": "", "zones": "", "surfaces": "", "sensors": "", "materials": "",
    "windows": "window", "glazings": "glazing", "shades": "shade", "vents": "vent", "openings": "opening",
    "air_paths": "air path", "ventilation_units": "ventilation unit", "controls": "control",
    "heat_sources": "heat source", "schedules": "schedule", "derived_outputs": "derived output",
    "soil_blocks": "block of soil", "ties": "tied", "humidity": "", "weather": "", "dimensions": "",
    "posterior": "",
}  # fmt: skip
#: Sections that are one part with rows of their own.
_SINGLE: Final = ("dimensions", "weather")
#: Numbers of a list that are shown.
_MOST: Final = 4
#: Keys that a part with nothing else does not need beside its own: a set point of 20 degC, a gain of 60 W.
_PLAIN: Final = ("temperature", "constant", "coefficient", "flow", "power", "flux", "air_changes", "rate")
#: Unit of numbers whose unit is that of a column.
_OF_COLUMN: Final = "unit of the column"


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
    >>> name, words = equipment(load(FOLDER / "reunion_house" / "building.yaml"))[0]
    >>> f"{name}: {words}"[:67]
    'window jalousie_living_north: 3.6 m2 in living_north, glazing clear'
    """
    parts = (_named, _of_zones, _of_surfaces, _of_materials, _of_building)
    return [list(row) for part in parts for row in part(building)]


def _named(building: Building) -> Iterator[tuple[str, str]]:
    """Parts of sections that have names, in the order of `SECTIONS`."""
    for section, word in SECTIONS.items():
        if word:
            for name, part in getattr(building, section).items():
                yield f"{word} {name}", _row(word, part)


def _row(word: str, part: Any) -> str:
    """The words of one part, what matters most first."""
    if isinstance(part, str):  # a tie
        return f"by a common {part}"
    if word == "window":
        return _joined(f"{_area(part.area)}in {part.surface}, glazing {part.glazing}", part, _WINDOW)
    if word == "vent":
        where = f"between {' and '.join(part.between)}" if part.between else f"of {part.zone} to outdoors"
        return _joined(f"{_area(part.area)}{where}", part, ("area", "between", "zone"))
    if word == "opening":
        return _joined(f"{_area(part.area)}of {part.zone} to outdoors", part, ("area", "zone"))
    if word == "air path":
        kind = "door" if part.door is not None else "air"
        return _joined(f"{kind} between {' and '.join(part.between)}", part, ("between",))
    if word == "ventilation unit":
        flows = (("supply to", part.supply), ("exhaust from", part.exhaust))
        ways = ", ".join(f"{way} {_flows(of)}" for way, of in flows if of)
        return _joined(ways, part, ("supply", "exhaust"))
    if word == "heat source":
        means = "electric" if part.electric is not None else "water"
        shown = part.electric if part.electric is not None else part.water
        return _joined(f"{means}, in {part.surface} after {part.after}", part, _SOURCE, _facts(shown))
    if word == "schedule":
        return _joined(part.kind, part, ("kind", "days", "seasons"), _profiles(part))
    if word == "derived output":
        return _joined(f"= {part.formula}", part, ("formula",))
    if word == "glazing":
        return _joined("" if part.kind == "panes" else part.kind, part, ("kind",))
    return _joined("", part, ())


#: Keys that the words above have already.
_WINDOW: Final = ("area", "surface", "glazing")
_SOURCE: Final = ("electric", "water", "surface", "after")


def _flows(by_zone: Mapping[str, Part]) -> str:
    return " and ".join(f"{zone} ({', '.join(_facts(flow))})" for zone, flow in by_zone.items())


def _bridged(faces: str) -> str:
    """Where a thermal bridge ends, where its keys do not say so."""
    return "to outdoors" if faces == "outdoors" else ""


def _profiles(schedule: Any) -> list[str]:
    """How a schedule changes: the lowest and the highest of its values."""
    values = [
        float(value)
        for days in schedule.profiles
        for key in type(days).model_fields
        for point in getattr(days, key) or ()
        for value in (point.value, point.ramp_to)
        if value is not None
    ]
    if not values:
        return []
    unit = schedule.profiles[0].profile(0)[0].value.with_unit().partition(" ")[2]
    by = f"{len(schedule.seasons)} seasons, " if getattr(schedule, "seasons", None) else ""
    return [f"{by}profiles of days from {min(values):g} to {max(values):g} {unit}".rstrip()]


def _of_zones(building: Building) -> Iterator[tuple[str, str]]:
    for zone, part in building.zones.items():
        for name, air in part.ventilation.items():
            yield f"ventilation {name} of {zone}", _joined("", air, ())
        for name, gain in part.gains.items():
            yield f"internal gain {name} of {zone}", _joined("", gain, ())
        for what, loads in part.loads.items():
            yield f"{what} of {zone}", _joined("ideal", loads, ())
        for name, bridge in part.thermal_bridges.items():
            yield f"thermal bridge {name} of {zone}", _joined(_bridged(bridge.faces), bridge, ("outdoors",))
        if infiltration := _facts(part.infiltration):
            yield f"infiltration of {zone}", ", ".join(infiltration)
        longwave = [f"long-wave exchange: {fact}" for fact in _facts(part.longwave, "kind")]
        if further := [*longwave, *_facts(part, *_OF_ZONE)]:
            yield f"zone {zone}", ", ".join(further)
    if building.humidity is not None:
        for zone, damp in building.humidity.zones.items():
            yield f"humidity of {zone}", _joined("vapour balance", damp, ())
        if sorption := _facts(building.humidity, "zones"):
            yield "sorption", ", ".join(sorption)


#: Keys of a zone with rows of their own, and what stands among its choices.
_OF_ZONE: Final = (
    "volume", "longwave", "infiltration", "ventilation", "gains", "heating", "cooling", "thermal_bridges",
)  # fmt: skip
#: Keys of a side that the table of the surfaces has.
_OF_SIDE: Final = (
    "outdoors", "zone", "adiabatic", "ground", "measured", "convection", "absorptance", "emissivity",
)  # fmt: skip
#: Keys of the site that stand with the site and among the choices.
_OF_SITE: Final = ("latitude", "longitude", "altitude", "timezone", "diffuse")


def _of_surfaces(building: Building) -> Iterator[tuple[str, str]]:
    for name, surface in building.surfaces.items():
        for word in ("outside", "inside"):
            if facts := _facts(getattr(surface, word), *_OF_SIDE):
                yield f"{word} of {name}", ", ".join(facts)


def _of_materials(building: Building) -> Iterator[tuple[str, str]]:
    """Laws of materials; their numbers stand with the layers."""
    for name, material in building.materials.items():
        laws = [
            _said(key, getattr(material, key))
            for key in type(material).model_fields
            if isinstance(getattr(material, key), Part) and not hasattr(getattr(material, key), "solid")
            if _facts(getattr(material, key))
        ]
        if laws:
            yield f"material {name}", ", ".join(laws)


def _of_building(building: Building) -> Iterator[tuple[str, str]]:
    """Sections that are about the building as a whole."""
    for section in _SINGLE:
        part = getattr(building, section)
        if part is not None:
            yield f"{section.replace('_', ' ')}", ", ".join(_facts(part)) or "as read"
    if building.posterior is not None:
        intervals = "" if building.posterior.stated else ", whose intervals are not stated"
        yield "calibrated", f"by the study “{building.posterior.study}”{intervals}"
    sky = [f"sky: {fact}" for fact in _facts(building.site.sky, "kind")]
    if facts := [*sky, *_facts(building.site, "sky", *_OF_SITE)]:
        yield "site", ", ".join(facts)


def _joined(first: str, part: Part, shown: tuple[str, ...], further: list[str] | None = None) -> str:
    return ", ".join(filter(None, (first, *(further or ()), *_facts(part, *shown))))


def _stated(part: Part, key: str) -> bool:
    """Whether a description says it: neither a default nor derived."""
    value = getattr(part, key)
    if value is None or (isinstance(value, Number) and (value.derived or isinstance(value.source, Remark))):
        return False
    if isinstance(value, Part) and not hasattr(value, "kind") and not _facts(value):
        return False
    return bool(value != type(part).model_fields[key].get_default(call_default_factory=True))


def _facts(part: Part, *shown: str) -> list[str]:
    """What is stated of a part, but the keys that are shown already."""
    return [
        _said(key, getattr(part, key))
        for key in type(part).model_fields
        if key not in shown and _stated(part, key)
    ]


def _said(key: str, value: Any) -> str:
    """One key with its value; names in a mapping stay as the user wrote them."""
    words = key.replace("_", " ")
    if isinstance(value, bool):
        return words if value else f"no {words}"
    if isinstance(value, tuple | list) and not _short(value):
        return f"{len(value)} {words}"
    if isinstance(value, Mapping):
        return f"{words}: {', '.join(f'{name} {_value(entry)}' for name, entry in value.items())}"
    return f"{words} {_value(value)}".strip()


def _value(value: Any) -> str:
    if isinstance(value, Number):
        return value.with_unit().removesuffix(_OF_COLUMN).rstrip()
    if isinstance(value, Part):
        kind = getattr(value, "kind", "")
        stated = [key for key in type(value).model_fields if key != "kind" and _stated(value, key)]
        if len(stated) == 1 and stated[0] in _PLAIN and kind in ("", "constant"):
            return _value(getattr(value, stated[0]))
        inner = ", ".join(_facts(value, "kind"))
        if not kind:
            return inner if len(stated) == 1 else f"({inner})"
        return f"{kind} ({inner})" if inner else str(kind)
    if isinstance(value, Mapping):
        return f"({', '.join(f'{name} {_value(entry)}' for name, entry in value.items())})"
    if isinstance(value, tuple | list):
        if all(isinstance(entry, str) for entry in value):
            return " and ".join(value)
        return (" + " if isinstance(value[0], Part) else ", ").join(map(_value, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def _short(values: tuple[Any, ...] | list[Any]) -> bool:
    """Whether a list is shown; else only how long it is."""
    return all(isinstance(entry, str) for entry in values) or (
        0 < len(values) <= _MOST and all(isinstance(entry, float | int | Part) for entry in values)
    )


def _area(area: float | None) -> str:
    return "" if area is None else f"{float(area):.4g} m2 "
