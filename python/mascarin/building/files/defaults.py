"""Keys that many parts of a building share, written once: the section `defaults`.

`outdoors` and `indoors` hold keys of sides that face the weather and a zone; a surface without `outside` or
`inside` has such a side. `materials`, `windows` and `zones` hold keys of all parts of these sections. A part
that has a key keeps it. The section is put in when the file is read, so that a building has no defaults.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from mascarin.building.base.error_texts import KeyPath
from mascarin.building.base.part import fault, insist
from mascarin.errors import InputError, did_you_mean

DEFAULTS: Final = "defaults"
SIDES: Final = {
    "outdoors": "Keys of every side outdoors; a surface without 'outside' has such a side",
    "indoors": "Keys of every side that faces a zone; a surface without 'inside' faces the only zone",
}
SECTIONS: Final = {
    "materials": "Keys of every material that is neither a product nor of another kind",
    "windows": "Keys of every window",
    "zones": "Keys of every zone",
}
#: Keys that make a part another one, for which the defaults are not meant.
_OF_ANOTHER: Final = ("kind", "product")

Put = Callable[[KeyPath, KeyPath], None]
"""Told the place of what was put in, and of the default that it is."""


def names_a_building(data: Mapping[str, Any]) -> bool:
    """Whether the content of a file is that of a study or a design study: it names a building."""
    return "building" in data and "surfaces" not in data


def require_building(data: Any) -> Any:
    """Refuse the content of a study or of a design study, which names a building.

    Parameters
    ----------
    data : object
        Content of a file.

    Returns
    -------
    object
        The same.
    """
    if not isinstance(data, Mapping) or not names_a_building(data):
        return data
    design = "objectives" in data or "variables" in data
    what, command = ("a design study", "design") if design else ("a study", "study")
    remedy = (
        f"Run it with 'mascarin {command} FILE -o FOLDER', or take the file that its key 'building' names."
    )
    insist(fault((), what, "a building: site, materials, constructions, zones, surfaces", remedy))
    return data


def with_defaults(plain: Mapping[str, Any], put: Put = lambda position, source: None) -> dict[str, Any]:
    """Put the section `defaults` into the parts of a description.

    Parameters
    ----------
    plain : mapping
        Plain values of a building.
    put : callable, optional
        Told the place of each part that was put in, and of the default.

    Returns
    -------
    dict
        The description without the section.

    Raises
    ------
    InputError
        The section has another key, or one that is no mapping.

    Examples
    --------
    >>> wool = {"conductivity": 0.04, "density": 30}
    >>> with_defaults({"defaults": {"materials": {"specific_heat": 1000}}, "materials": {"wool": wool}})
    {'materials': {'wool': {'conductivity': 0.04, 'density': 30, 'specific_heat': 1000}}}
    """
    described = {key: value for key, value in plain.items() if key != DEFAULTS}
    if DEFAULTS not in plain:
        return described
    shared = _checked(plain[DEFAULTS])
    for section in SECTIONS:
        parts = described.get(section)
        if section in shared and isinstance(parts, Mapping):
            described[section] = {
                name: _filled(part, shared[section], (section, name), (DEFAULTS, section), put)
                for name, part in parts.items()
            }
    surfaces = described.get("surfaces")
    if isinstance(surfaces, Mapping):
        zones = described.get("zones")
        zone = next(iter(zones)) if isinstance(zones, Mapping) and len(zones) == 1 else None
        described["surfaces"] = {
            name: _with_sides(surface, shared, zone, ("surfaces", name), put)
            for name, surface in surfaces.items()
        }
    return described


def _checked(shared: Any) -> dict[str, Mapping[str, Any]]:
    sections = (*SIDES, *SECTIONS)
    if not isinstance(shared, Mapping):
        raise InputError(
            f"{DEFAULTS}: found {shared!r}; expected a mapping with some of {', '.join(sections)}. Write "
            f"'{DEFAULTS}: {{indoors: {{convection: tarp, emissivity: 0.9}}}}'"
        )
    for key, value in shared.items():
        if key not in sections:
            raise InputError(
                f"{DEFAULTS}: found the key '{key}'; expected one of {', '.join(sections)}. "
                f"{did_you_mean(str(key), sections, known=False)}".rstrip()
            )
        if not isinstance(value, Mapping):
            raise InputError(
                f"{DEFAULTS}.{key}: found {value!r}; expected a mapping. {(SIDES | SECTIONS)[key]}"
            )
    return dict(shared)


def _filled(part: Any, shared: Mapping[str, Any], position: KeyPath, source: KeyPath, put: Put) -> Any:
    """A part with the keys that it does not have."""
    if not isinstance(part, Mapping) or (
        source[-1] == "materials" and any(key in part for key in _OF_ANOTHER if key not in shared)
    ):
        return part
    missing = {key: value for key, value in shared.items() if key not in part}
    for key in missing:
        put((*position, key), (*source, key))
    return {**part, **missing}


def _with_sides(
    surface: Any, shared: Mapping[str, Mapping[str, Any]], zone: Any, position: KeyPath, put: Put
) -> Any:
    """A surface whose sides have the keys of their kind."""
    if not isinstance(surface, Mapping):
        return surface
    sides = dict(surface)
    if "outside" not in sides and "outdoors" in shared:
        sides["outside"] = {"outdoors": True}
    if "inside" not in sides and "indoors" in shared and zone is not None:
        sides["inside"] = {"zone": zone}
    for side in ("outside", "inside"):
        stated = sides.get(side)
        if not isinstance(stated, Mapping):
            continue
        if side not in surface:
            put((*position, side), position)
        for kind, key in (("outdoors", "outdoors"), ("indoors", "zone")):
            if key in stated and kind in shared:
                sides[side] = _filled(stated, shared[kind], (*position, side), (DEFAULTS, kind), put)
    return sides
