"""Surfaces with their two sides, by the boundary conditions of EnergyPlus."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from mascarin.building.geometry import Polygon
from mascarin.convert import geometry as g
from mascarin.convert.constructions import construction
from mascarin.convert.faces import Face
from mascarin.convert.films import Films
from mascarin.convert.glazings import construction_of
from mascarin.convert.materials import skin
from mascarin.convert.schedules import temperature, year
from mascarin.convert.site import ground
from mascarin.convert.source import Item
from mascarin.convert.work import Section, Work
from mascarin.convert.year import Year, combined, constant
from mascarin.errors import InputError

#: Boundary conditions that stand for ground whose temperature another program or model finds.
_OTHER_GROUND: Final = (
    "groundslabpreprocessoraverage", "groundslabpreprocessorcore", "groundslabpreprocessorperimeter",
    "groundbasementpreprocessoraveragewall", "groundbasementpreprocessoraveragefloor",
    "groundbasementpreprocessorupperwall", "groundbasementpreprocessorlowerwall", "foundation",
)  # fmt: skip
#: What the outside of a surface is: a side, and whether the construction is cut at its plane without flow.
Outside = tuple[Section, bool]


@dataclass
class Surfaces:
    """What has become of the surfaces of the file.

    Attributes
    ----------
    placed : dict of str to str
        Surface of the description by the name in the file, in small letters.
    drawn : dict of str to bool
        Whether a surface of the description has vertices.
    reversed_names : set of str
        Surfaces of the file that are the outer side of another one.
    """

    placed: dict[str, str] = field(default_factory=dict)
    drawn: dict[str, bool] = field(default_factory=dict)
    reversed_names: set[str] = field(default_factory=set)


def describe_surfaces(work: Work, all_surfaces: list[Face], films: Films) -> Surfaces:
    """Enter all surfaces.

    Raises
    ------
    InputError
        A boundary condition or a construction that does not exist.
    """
    done = Surfaces()
    by_name = {face.item.name.casefold(): face for face in all_surfaces}
    finite = _finite_differences(work)
    for face in all_surfaces:
        if face.item.name.casefold() in done.reversed_names:
            continue
        outside, cut = _outside(work, face, by_name, films, done)
        item = construction_of(work, face.item)
        name = work.names.of("surfaces", face.item.name)
        inside = _toward_zone(work, face, films, item, outer=False)
        if item.kind == "Construction:AirBoundary":
            layers = _air_boundary(work, face, item)
        else:
            solved = finite.get(face.item.name.casefold(), finite.get(item.name.casefold(), finite[""]))
            layers = construction(work, item, cut=cut, finite_differences=solved)
        shape, has_vertices = _shape(work, face)
        section = {"construction": layers, **shape, "outside": outside, "inside": inside}
        if outside.get("zone") == inside["zone"]:
            section["internal_mass"] = True
        work.section("surfaces")[name] = section
        done.placed[face.item.name.casefold()], done.drawn[name] = name, has_vertices
    _masses(work, films, finite[""])
    return done


def _shape(work: Work, face: Face) -> tuple[Section, bool]:
    """Corners of a surface, or its area and direction where they are not accepted."""
    points = g.without_repeats(face.points)
    try:
        Polygon.of(face.item.name, g.rounded(points))
    except InputError as error:
        work.findings.approximated(
            face.item, str(error).split("; expected")[0], "area and direction alone: it shades nothing"
        )
        return _flat(face.points), False
    return {"vertices": g.rounded(points)}, True


def _flat(points: g.Array) -> Section:
    geometry = {"area": g.area_of(points), "tilt": g.tilt_of(points), "azimuth": g.azimuth_of(points)}
    return {key: round(value, 5) for key, value in geometry.items()}


def _toward_zone(work: Work, face: Face, films: Films, item: Item, *, outer: bool) -> Section:
    """The side of a surface in the zone of a face; `outer` where it is the outer side of a construction."""
    side = skin(work, item, outer)
    return {
        "zone": work.names.of("zones", face.zone.name),
        "convection": films.inside(face.item, face.zone, g.tilt_of(face.points)),
        "emissivity": side["emissivity"],
        "absorptance": side["absorptance"],
    }


def _outside(
    work: Work, face: Face, by_name: Mapping[str, Face], films: Films, done: Surfaces
) -> tuple[Section, bool]:
    """What the outer side of a surface faces."""
    boundary, item = face.boundary, face.item
    if boundary == "outdoors":
        return _outdoors(work, face, films), False
    if boundary == "adiabatic" or (
        boundary == "surface" and face.beyond.casefold() in ("", item.name.casefold())
    ):
        return {"adiabatic": True}, True
    if boundary == "surface":
        return _between_zones(work, face, by_name, films, done), False
    if boundary == "zone":
        other = work.model.require(item, "outside_boundary_condition_object", "Zone", name=face.beyond)
        side = _toward_zone(work, face, films, construction_of(work, item), outer=True)
        return side | {"zone": work.names.of("zones", other.name)}, False
    if boundary in ("ground", "groundfcfactormethod"):
        kind = "BuildingSurface" if boundary == "ground" else "FCfactorMethod"
        return held_at(work, f"ground {kind}", ground(work, kind)), False
    if boundary == "othersidecoefficients":
        return _other_side(work, face)
    if boundary in _OTHER_GROUND:
        work.findings.left_out(
            item,
            f"ground by {boundary}",
            "the temperatures of Site:GroundTemperature:BuildingSurface, or 18 degC",
        )
        return held_at(work, "ground", ground(work)), False
    if boundary == "othersideconditionsmodel":
        work.findings.left_out(item, "a model of its other side", "no heat flows through this surface")
        return {"adiabatic": True}, False
    conditions = "Outdoors, Surface, Zone, Adiabatic, Ground, OtherSideCoefficients"
    raise item.error(f"outside_boundary_condition: found '{boundary}'", f"one of {conditions}", "Correct it")


def held_at(work: Work, name: str, values: Year) -> Section:
    """A side that touches something of a given temperature. [degC]"""
    temperature_value = temperature(work, name, values)
    return {"scheduled": temperature_value} if isinstance(temperature_value, str) else {"ground": {"temperature": temperature_value}}


def _outdoors(work: Work, face: Face, films: Films) -> Section:
    side = skin(work, construction_of(work, face.item), outer=True)
    film = films.outside(face.item, face.zone, side["roughness"])
    side_section = {"outdoors": True, "convection": film.convection, "emissivity": side["emissivity"]}
    if face.sun:
        side_section["absorptance"] = side["absorptance"]
    if film.combined:
        side_section["longwave"] = "none"
    hidden = {key: False for key, on in (("sun", face.sun), ("wind", face.wind)) if not on}
    if hidden:
        side_section["exposure"] = hidden
    return side_section


def _between_zones(
    work: Work, face: Face, by_name: Mapping[str, Face], films: Films, done: Surfaces
) -> Section:
    other = by_name.get(face.beyond.casefold())
    if other is None:
        raise face.item.error(
            f"outside_boundary_condition_object: found '{face.beyond}'",
            "the name of a surface of the file",
            "Correct it",
        )
    if other.beyond.casefold() != face.item.name.casefold():
        raise face.item.error(
            f"'{other.item.name}' on its other side, which names '{other.beyond or other.boundary}'",
            "two surfaces that name each other",
            "Correct one of them",
        )
    areas = g.area_of(face.points), g.area_of(other.points)
    if abs(areas[0] - areas[1]) > 0.02 * max(areas):
        work.findings.approximated(
            other.item, f"{areas[1]:.2f} m2, on its other side {areas[0]:.2f} m2", "the first area is used"
        )
    done.reversed_names.add(other.item.name.casefold())
    done.placed[other.item.name.casefold()] = work.names.of("surfaces", face.item.name)
    outer = _toward_zone(work, other, films, construction_of(work, face.item), outer=True)
    if other.zone is face.zone:
        work.findings.approximated(face.item, "both sides in one zone", "an internal mass of the zone")
    return outer


def _other_side(work: Work, face: Face) -> Outside:
    """A side of a given temperature, as far as it depends on no weather."""
    item = work.model.require(
        face.item,
        "outside_boundary_condition_object",
        "SurfaceProperty:OtherSideCoefficients",
        name=face.beyond,
    )
    weight = item.number("constant_temperature_coefficient") or 0.0
    air = item.number("external_dry_bulb_temperature_coefficient") or 0.0
    soil = item.number("ground_temperature_coefficient") or 0.0
    weather_coefficients = [
        key
        for key in (
            "wind_speed_coefficient",
            "zone_air_temperature_coefficient",
            "previous_other_side_temperature_coefficient",
        )
        if item.number(key)
    ]
    film = item.number("combined_convective_radiative_film_coefficient") or 0.0
    if weather_coefficients or (air and (abs(air - 1.0) > 1e-9 or weight or soil)):
        what = ", ".join(weather_coefficients) or "outdoor air mixed with other temperatures"
        work.findings.left_out(face.item, f"{item.label} with {what}", "no heat flows through this surface")
        return {"adiabatic": True}, False
    if air:
        exposure = {"sun": False, "wind": False, "sky": False}
        convection = film if film > 0.0 else 1000.0
        outdoor_side = {"outdoors": True, "convection": convection, "emissivity": 0.9, "longwave": "none"}
        return outdoor_side | {"exposure": exposure}, False
    fixed = item.number("constant_temperature") or 0.0
    values = year(work, item, "constant_temperature_schedule_name", default=fixed)
    if item.word("sinusoidal_variation_of_constant_temperature_coefficient") == "yes":
        work.findings.left_out(item, "a sinusoidal temperature", "its constant part alone is used")
    below = ground(work) if soil else constant(0.0)
    total = combined(lambda fixed_value, soil_value: weight * fixed_value + soil * soil_value, values, below)
    side = held_at(work, item.name, total)
    if film <= 0.0:
        return side, False
    if "ground" in side:
        return {"scheduled": _as_schedule(work, item.name, total), "convection": film}, False
    return side | {"convection": film}, False


def _as_schedule(work: Work, name: str, values: Year) -> str:
    free = work.names.of("schedules", name)
    work.section("schedules")[free] = {"kind": "temperature", "value": values.constant}
    return free


def _air_boundary(work: Work, face: Face, item: Item) -> str:
    """A boundary of air alone: a black sheet of nearly no resistance, with the mixing that the file gives."""
    work.findings.approximated(
        face.item,
        f"the boundary of air '{item.name}'",
        "a black sheet without resistance: sun does not pass it, heat does",
    )
    materials, name = work.section("materials"), work.names.of("materials", "air boundary")
    materials[name] = {"kind": "resistance", "resistance": 0.001}
    layers = work.names.of("constructions", "air boundary")
    work.section("constructions")[layers] = {"layers": [{"material": name}]}
    return layers


def _masses(work: Work, films: Films, finite: bool) -> None:
    """Internal masses: their area, and the part of their construction inside of its plane without flow."""
    for item in work.model.of("InternalMass"):
        zones = work.zones_of(item, "zone_or_zonelist_name", "zone_name", "space_or_spacelist_name")
        mass_construction = construction_of(work, item)
        side = skin(work, mass_construction, outer=False)
        for zone in zones:
            name = work.names.of("surfaces", item.name if len(zones) == 1 else f"{item.name} {zone.name}")
            work.section("surfaces")[name] = {
                "construction": construction(work, mass_construction, cut=True, finite_differences=finite),
                "area": item.needed("surface_area"),
                "tilt": 90,
                "azimuth": 0,
                "outside": {"adiabatic": True},
                "inside": {
                    "zone": work.names.of("zones", zone.name),
                    "convection": films.inside(item, zone, 90.0),
                    "emissivity": side["emissivity"],
                    "absorptance": side["absorptance"],
                },
            }


def _finite_differences(work: Work) -> dict[str, bool]:
    """Whether EnergyPlus uses finite differences: by surface, by construction, and for the rest under ''."""
    main = work.model.one("HeatBalanceAlgorithm")
    word = main.word("algorithm") if main is not None else ""
    if main is not None:
        _moisture(work, main, word)
    uses_finite_differences = {"": word.startswith("conductionfinite")}
    named: dict[str, tuple[Item, str]] = {}
    for item in work.model.of("SurfaceProperty:HeatTransferAlgorithm"):
        named[item.word("surface_name")] = item, item.word("algorithm")
    for item in work.model.of("SurfaceProperty:HeatTransferAlgorithm:Construction"):
        named[item.word("construction_name")] = item, item.word("algorithm")
    for item in work.model.of("SurfaceProperty:HeatTransferAlgorithm:SurfaceList"):
        words: list[Any] = [value for row in item.rows("surface") for value in row.values()]
        words += [value for key, value in item.fields.items() if key.startswith("surface_name_")]
        named |= {str(name).strip().casefold(): (item, item.word("algorithm")) for name in words}
    for item in work.model.of("SurfaceProperty:HeatTransferAlgorithm:MultipleSurface"):
        work.findings.left_out(item, "an algorithm for a group of surfaces", "that of the building is used")
    for key, (item, algorithm) in named.items():
        _moisture(work, item, algorithm)
        uses_finite_differences[key] = algorithm.startswith("conductionfinite")
    return uses_finite_differences


def _moisture(work: Work, item: Item, algorithm: str) -> None:
    if "moisture" in algorithm:
        work.findings.left_out(
            item,
            f"moisture in walls by {algorithm}",
            "heat alone is conducted: the heat of sorption and the conductivity of moist layers are missing",
        )
