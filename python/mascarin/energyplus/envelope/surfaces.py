"""Surfaces with their two sides, by the boundary conditions of EnergyPlus."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from mascarin.building.geometry import Polygon
from mascarin.energyplus.envelope.constructions import construction
from mascarin.energyplus.envelope.convection import ConvectionCoefficients
from mascarin.energyplus.envelope.foundations import above_grade, foundation, insulated
from mascarin.energyplus.envelope.glazings import construction_of
from mascarin.energyplus.envelope.idf_surfaces import IdfSurface
from mascarin.energyplus.envelope.materials import layers_of, skin
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.dates import steps_per_hour
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import temperature, year
from mascarin.energyplus.model.site import ground
from mascarin.energyplus.model.year import DAYS, Year, combined, constant, year_of
from mascarin.errors import InputError

#: Boundary conditions that stand for ground whose temperature another program or model finds.
_OTHER_GROUND: Final = (
    "groundslabpreprocessoraverage", "groundslabpreprocessorcore", "groundslabpreprocessorperimeter",
    "groundbasementpreprocessoraveragewall", "groundbasementpreprocessoraveragefloor",
    "groundbasementpreprocessorupperwall", "groundbasementpreprocessorlowerwall", "foundation",
)  # fmt: skip
#: What the outside of a surface is: a side, and whether the construction is cut at its plane without flow.
Outside = tuple[Section, bool]


_ALGORITHMS: Final = tuple(
    f"SurfaceProperty:HeatTransferAlgorithm{ending}"
    for ending in ("", ":Construction", ":SurfaceList", ":MultipleSurface")
)


@dataclass
class Surfaces:
    """What has become of the surfaces of the file.

    Attributes
    ----------
    placed : dict of str to str
        Surface of the description by the name in the file, in small letters.
    has_vertices : dict of str to bool
        Whether a surface of the description has vertices.
    reversed_names : set of str
        Surfaces of the file that are the outer side of another one.
    """

    placed: dict[str, str] = field(default_factory=dict)
    has_vertices: dict[str, bool] = field(default_factory=dict)
    reversed_names: set[str] = field(default_factory=set)


def describe_surfaces(
    context: Context, all_surfaces: list[IdfSurface], coefficients: ConvectionCoefficients
) -> Surfaces:
    """Enter all surfaces.

    Raises
    ------
    InputError
        A boundary condition or a construction that does not exist.
    """
    done = Surfaces()
    by_name = {surface.item.name.casefold(): surface for surface in all_surfaces}
    solvers = _solvers(context)
    context.moist[""] = _is_moist(solvers[""])
    for surface in all_surfaces:
        if surface.item.name.casefold() in done.reversed_names:
            continue
        outside, cut = _outside(context, surface, by_name, coefficients, done)
        parts = above_grade(context, surface) if "soil" in outside else None
        below = surface if parts is None else parts[0]
        item = construction_of(context, surface.item)
        name = context.names.of("surfaces", surface.item.name)
        inside = _toward_zone(context, surface, coefficients, item, outer=False)
        if item.kind == "Construction:AirBoundary":
            layers = _air_boundary(context, surface, item)
        else:
            solver = solvers.get(surface.item.name.casefold(), solvers.get(item.name.casefold(), solvers[""]))
            layers = construction(
                context, item, cut=cut, finite_differences=_is_finite(solver), on_soil="soil" in outside
            )
            context.moist[name] = _is_moist(solver)
        shape, has_vertices = _shape(context, below)
        section = {"construction": layers, **shape, "outside": outside, "inside": inside}
        if outside.get("zone") == inside["zone"]:
            section["internal_mass"] = True
        context.section("surfaces")[name] = section
        done.placed[surface.item.name.casefold()], done.has_vertices[name] = name, has_vertices
        if parts is not None:
            top = context.names.of("surfaces", f"{surface.item.name} above the ground")
            plain = construction(context, item, cut=False, finite_differences=_is_finite(solver))
            context.section("surfaces")[top] = {
                "construction": insulated(context, surface, plain),
                "vertices": g.rounded(parts[1].points),
                "outside": _outdoors(context, parts[1], coefficients),
                "inside": inside,
            }
            done.has_vertices[top] = True
    _masses(context, coefficients, _is_finite(solvers[""]))
    return done


def _shape(context: Context, surface: IdfSurface) -> tuple[Section, bool]:
    """Corners of a surface, or its area and direction where they are not accepted."""
    points = g.without_repeats(surface.points)
    try:
        Polygon.of(surface.item.name, g.rounded(points))
    except InputError as error:
        context.findings.approximated(
            surface.item, str(error).split("; expected")[0], "area and direction alone: it shades nothing"
        )
        return g.flat(surface.points), False
    return {"vertices": g.rounded(points)}, True


def _toward_zone(
    context: Context,
    surface: IdfSurface,
    coefficients: ConvectionCoefficients,
    item: IdfObject,
    *,
    outer: bool,
) -> Section:
    """The side of a surface in the zone of a face; `outer` where it is the outer side of a construction."""
    side = skin(context, item, outer)
    return {
        "zone": context.names.of("zones", surface.zone.name),
        "convection": coefficients.inside(surface.item, surface.zone, g.tilt_of(surface.points)),
        "emissivity": side["emissivity"],
        "absorptance": side["absorptance"],
    }


def _outside(
    context: Context,
    surface: IdfSurface,
    by_name: Mapping[str, IdfSurface],
    coefficients: ConvectionCoefficients,
    done: Surfaces,
) -> tuple[Section, bool]:
    """What the outer side of a surface faces."""
    boundary, item = surface.boundary, surface.item
    if boundary == "outdoors":
        return _outdoors(context, surface, coefficients), False
    if boundary == "adiabatic" or (
        boundary == "surface" and surface.beyond.casefold() in ("", item.name.casefold())
    ):
        return {"adiabatic": True}, True
    if boundary == "surface":
        return _between_zones(context, surface, by_name, coefficients, done), False
    if boundary == "zone":
        other = context.model.require(item, "outside_boundary_condition_object", "Zone", name=surface.beyond)
        side = _toward_zone(context, surface, coefficients, construction_of(context, item), outer=True)
        return side | {"zone": context.names.of("zones", other.name)}, False
    if boundary in ("ground", "groundfcfactormethod"):
        kind = "BuildingSurface" if boundary == "ground" else "FCfactorMethod"
        return held_at(context, f"ground {kind}", ground(context, kind)), False
    if boundary == "othersidecoefficients":
        return _other_side(context, surface)
    soil = foundation(context, surface, by_name.values()) if boundary == "foundation" else None
    if soil is not None:
        return soil, False
    if boundary in _OTHER_GROUND:
        context.findings.left_out(
            item,
            f"ground by {boundary}",
            "the temperatures of Site:GroundTemperature:BuildingSurface, or 18 degC",
        )
        return held_at(context, "ground", ground(context)), False
    if boundary == "othersideconditionsmodel":
        context.findings.left_out(item, "a model of its other side", "no heat flows through this surface")
        return {"adiabatic": True}, False
    conditions = "Outdoors, Surface, Zone, Adiabatic, Ground, OtherSideCoefficients"
    raise item.error(f"outside_boundary_condition: found '{boundary}'", f"one of {conditions}", "Correct it")


def held_at(context: Context, name: str, values: Year) -> Section:
    """A side that touches something of a given temperature. [degC]"""
    temperature_value = temperature(context, name, values)
    return (
        {"scheduled": temperature_value}
        if isinstance(temperature_value, str)
        else {"ground": {"temperature": temperature_value}}
    )


def _outdoors(context: Context, surface: IdfSurface, coefficients: ConvectionCoefficients) -> Section:
    side = skin(context, construction_of(context, surface.item), outer=True)
    coefficient = coefficients.outside(surface.item, surface.zone, side["roughness"])
    side_section = {"outdoors": True, "convection": coefficient.convection, "emissivity": side["emissivity"]}
    if surface.sun:
        side_section["absorptance"] = side["absorptance"]
        side_section |= {} if surface.ground is None else {"ground_view": surface.ground}
    if coefficient.combined:
        side_section["longwave"] = "none"
    # EnergyPlus has no wind at and below the ground.
    windy = surface.wind and float(surface.points[:, 2].mean()) > 0.0
    hidden = {key: False for key, on in (("sun", surface.sun), ("wind", windy)) if not on}
    if hidden:
        side_section["exposure"] = hidden
    return side_section


def _between_zones(
    context: Context,
    surface: IdfSurface,
    by_name: Mapping[str, IdfSurface],
    coefficients: ConvectionCoefficients,
    done: Surfaces,
) -> Section:
    other = by_name.get(surface.beyond.casefold())
    if other is None:
        raise surface.item.error(
            f"outside_boundary_condition_object: found '{surface.beyond}'",
            "the name of a surface of the file",
            "Correct it",
        )
    if other.beyond.casefold() != surface.item.name.casefold():
        return _one_sided(context, surface, other, coefficients)
    areas = g.area_of(surface.points), g.area_of(other.points)
    if abs(areas[0] - areas[1]) > 0.02 * max(areas):
        context.findings.approximated(
            other.item, f"{areas[1]:.2f} m2, on its other side {areas[0]:.2f} m2", "the first area is used"
        )
    first, second = construction_of(context, surface.item), construction_of(context, other.item)
    if first.kind == second.kind == "Construction" and first is not second:
        layers = [[layer.name for layer in layers_of(context, item)] for item in (first, second)]
        if layers[0] != layers[1][::-1]:
            context.findings.approximated(
                other.item,
                f"layers of '{second.name}' that are not those of '{first.name}' on its other side",
                f"those of '{first.name}' are used on both sides",
            )
    done.reversed_names.add(other.item.name.casefold())
    done.placed[other.item.name.casefold()] = context.names.of("surfaces", surface.item.name)
    outer = _toward_zone(context, other, coefficients, construction_of(context, surface.item), outer=True)
    if other.zone is surface.zone:
        context.findings.approximated(surface.item, "both sides in one zone", "an internal mass of the zone")
    return outer


def _one_sided(
    context: Context, surface: IdfSurface, other: IdfSurface, coefficients: ConvectionCoefficients
) -> Section:
    """A surface whose other side is a surface that names another one."""
    context.findings.approximated(
        surface.item,
        f"'{other.item.name}' on its other side, which names '{other.beyond or other.boundary}'",
        f"the other side is in zone '{other.zone.name}': its heat comes from there; in EnergyPlus it has "
        "the temperature of that surface, and its heat comes from nowhere",
    )
    outer = _toward_zone(context, other, coefficients, construction_of(context, surface.item), outer=True)
    return outer | {"convection": coefficients.inside(other.item, other.zone, g.tilt_of(other.points))}


@reads("SurfaceProperty:OtherSideCoefficients")
def _other_side(context: Context, surface: IdfSurface) -> Outside:
    """A side of a given temperature, as far as it depends on no weather."""
    item = context.model.require(
        surface.item,
        "outside_boundary_condition_object",
        "SurfaceProperty:OtherSideCoefficients",
        name=surface.beyond,
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
    coefficient = item.number("combined_convective_radiative_film_coefficient") or 0.0
    if weather_coefficients or (air and (abs(air - 1.0) > 1e-9 or weight or soil)):
        what = ", ".join(weather_coefficients) or "outdoor air mixed with other temperatures"
        context.findings.left_out(
            item, f"{what}, at '{surface.item.name}'", "no heat flows through this surface"
        )
        return {"adiabatic": True}, False
    if air:
        exposure = {"sun": False, "wind": False, "sky": False}
        convection = coefficient if coefficient > 0.0 else 1000.0
        outdoor_side = {"outdoors": True, "convection": convection, "emissivity": 0.9, "longwave": "none"}
        return outdoor_side | {"exposure": exposure}, False
    fixed = item.number("constant_temperature") or 0.0
    values = year(context, item, "constant_temperature_schedule_name", default=fixed)
    if item.word("sinusoidal_variation_of_constant_temperature_coefficient") == "yes":
        values = _wave(context, item, values)
        weight = 1.0
    below = ground(context) if soil else constant(0.0)
    total = combined(lambda fixed_value, soil_value: weight * fixed_value + soil * soil_value, values, below)
    side = held_at(context, item.name, total)
    if coefficient <= 0.0:
        return side, False
    if "ground" in side:
        return {"scheduled": _as_schedule(context, item.name, total), "convection": coefficient}, False
    return side | {"convection": coefficient}, False


def _wave(context: Context, item: IdfObject, values: Year) -> Year:
    """A constant temperature times a sine of the time, in the steps of EnergyPlus. [degC]"""
    period = item.number("period_of_sinusoidal_variation") or 24.0
    if 24.0 % period > 1e-9:
        context.findings.left_out(
            item, f"a sine of {period:g} h, which does not divide a day", "its mean, 0 degC, is used"
        )
        return constant(0.0)
    step = 60 // steps_per_hour(context)
    day = tuple(
        (start, math.sin(2.0 * math.pi * (start + step) / (60.0 * period))) for start in range(0, 1440, step)
    )
    return combined(lambda value, share: value * share, values, year_of([("12-31", (day,) * len(DAYS))]))


def _as_schedule(context: Context, name: str, values: Year) -> str:
    free = context.names.of("schedules", name)
    context.section("schedules")[free] = {"kind": "temperature", "value": values.constant}
    return free


def _air_boundary(context: Context, surface: IdfSurface, item: IdfObject) -> str:
    """A boundary of air alone: a black sheet of nearly no resistance, with the mixing that the file gives."""
    context.findings.approximated(
        surface.item,
        f"the boundary of air '{item.name}'",
        "a black sheet without resistance: sun does not pass it, heat does",
    )
    materials, name = context.section("materials"), context.names.of("materials", "air boundary")
    materials[name] = {"kind": "resistance", "resistance": 0.001}
    layers = context.names.of("constructions", "air boundary")
    context.section("constructions")[layers] = {"layers": [{"material": name}]}
    return layers


@reads("InternalMass")
def _masses(context: Context, coefficients: ConvectionCoefficients, finite: bool) -> None:
    """Internal masses: their area, and the part of their construction inside of its plane without flow."""
    for item in context.model.of("InternalMass"):
        zones = context.zones_of(item, "zone_or_zonelist_name", "zone_name", "space_or_spacelist_name")
        mass_construction = construction_of(context, item)
        side = skin(context, mass_construction, outer=False)
        for zone in zones:
            name = context.names.of("surfaces", item.name if len(zones) == 1 else f"{item.name} {zone.name}")
            context.section("surfaces")[name] = {
                "construction": construction(context, mass_construction, cut=True, finite_differences=finite),
                "area": item.needed("surface_area"),
                "tilt": 90,
                "azimuth": 0,
                "outside": {"adiabatic": True},
                "inside": {
                    "zone": context.names.of("zones", zone.name),
                    "convection": coefficients.inside(item, zone, 90.0),
                    "emissivity": side["emissivity"],
                    "absorptance": side["absorptance"],
                },
            }


@reads("HeatBalanceAlgorithm", *_ALGORITHMS)
def _solvers(context: Context) -> dict[str, str]:
    """Algorithm of EnergyPlus for each surface or construction that names one, and for the rest under ''."""
    main = context.model.one("HeatBalanceAlgorithm")
    word = main.word("algorithm") if main is not None else ""
    if main is not None:
        _note_moisture(context, main, word)
    solvers = {"": word}
    named: dict[str, tuple[IdfObject, str]] = {}
    for item in context.model.of("SurfaceProperty:HeatTransferAlgorithm"):
        named[item.word("surface_name")] = item, item.word("algorithm")
    for item in context.model.of("SurfaceProperty:HeatTransferAlgorithm:Construction"):
        named[item.word("construction_name")] = item, item.word("algorithm")
    for item in context.model.of("SurfaceProperty:HeatTransferAlgorithm:SurfaceList"):
        words: list[Any] = [value for row in item.rows("surface") for value in row.values()]
        words += item.fields.starting("surface_name_")
        named |= {str(name).strip().casefold(): (item, item.word("algorithm")) for name in words}
    for item in context.model.of("SurfaceProperty:HeatTransferAlgorithm:MultipleSurface"):
        context.findings.left_out(
            item, "an algorithm for a group of surfaces", "that of the building is used"
        )
    for key, (item, algorithm) in named.items():
        _note_moisture(context, item, algorithm)
        solvers[key] = algorithm
    return solvers


def _is_finite(solver: str) -> bool:
    return solver.startswith("conductionfinite")


def _is_moist(solver: str) -> bool:
    """Whether vapour goes into the skin of a surface (effective moisture penetration depth)."""
    return solver.startswith("moisturepenetration")


def _note_moisture(context: Context, item: IdfObject, algorithm: str) -> None:
    if _is_moist(algorithm):
        context.findings.approximated(
            item,
            f"moisture in walls by {algorithm}",
            "a section 'humidity': vapour is carried over, its heat of sorption is not",
        )
    elif "moisture" in algorithm:
        context.findings.left_out(
            item,
            f"moisture in walls by {algorithm}",
            "heat alone is conducted: the heat of sorption and the conductivity of moist layers are missing",
        )
