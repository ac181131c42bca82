"""Glazings: panes with gaps, rated values, and reports of the program WINDOW."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from mascarin.energyplus.envelope.materials import layers_of
from mascarin.energyplus.envelope.simple_glazing import simple_glazing
from mascarin.energyplus.envelope.window_data import DataFile, read_data_file
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

_SHADES: Final = ("shade", "blind", "screen", "drape", "complexshade")
_GASES: Final = ("air", "argon", "krypton", "xenon")


@dataclass(frozen=True)
class Glazed:
    """A glazing of the description.

    Attributes
    ----------
    name : str
        Its name.
    frame : tuple of (float, float, float, float) or None
        Frame that its data file describes: width [m], U value [W/(m2 K)], absorptance and emissivity [-].
    """

    name: str
    frame: tuple[float, float, float, float] | None = None


def glazing(context: Context, user: IdfObject, construction: IdfObject) -> Glazed | None:
    """Enter a glazing, if it is not there; None where it cannot be carried over.

    Parameters
    ----------
    context : Context
        The conversion.
    user : IdfObject
        The window.
    construction : IdfObject
        Its construction.
    """
    name = context.names.of("glazings", construction.name)
    held = context.section("glazings")
    if construction.kind == "Construction:WindowDataFile":
        return _from_data_file(context, construction, name)
    if construction.kind != "Construction":
        _no_glazing(context, user, f"a {construction.kind}")
        return None
    if name not in held:
        layers = layers_of(context, construction)
        section = _glazing(context, construction, layers)
        if section is None:
            _no_glazing(context, user, f"the construction '{construction.name}'")
            return None
        held[name] = section | {"source": f"EnergyPlus {construction.label}"}
    return Glazed(name)


def _no_glazing(context: Context, user: IdfObject, what: str) -> None:
    context.findings.left_out(
        user, f"{what}, which has no counterpart here", "its wall is opaque there: no sun enters, less heat"
    )


def _from_data_file(context: Context, item: IdfObject, name: str) -> Glazed | None:
    held = context.section("glazings")
    data = read_data_file(item, context.model.file.parent)
    held[name] = _of_data(data) | {"source": f"WINDOW report {data.file}, '{item.name}'"}
    if data.dividers:
        context.findings.left_out(
            item, "dividers", "more sun enters, by their fraction of the glass, and less heat is conducted"
        )
    if data.systems > 1:
        context.findings.left_out(
            item, "a second glazing system of a window with a mullion", "the first one is used for both parts"
        )
    return Glazed(name, data.frame)


def _of_data(data: DataFile) -> Section:
    gaps = [{"thickness": thickness, "gas": gas} for thickness, gas in data.gaps]
    return {"kind": "panes", "panes": data.panes, "gaps": gaps, "angular": data.angular}


def _glazing(context: Context, construction: IdfObject, layers: list[IdfObject]) -> Section | None:
    """A glazing by its layers; None where a layer has no counterpart."""
    simple = [item for item in layers if item.kind == "WindowMaterial:SimpleGlazingSystem"]
    if simple:
        return simple_glazing(context, simple[0])
    unshaded_layers = _without_shades(context, construction, layers)
    panes: list[Section] = []
    gaps: list[Section] = []
    for item in unshaded_layers:
        kind = item.kind.partition(":")[2].casefold()
        if kind == "glazing":
            pane = _pane(context, item)
        elif kind == "glazing:refractionextinctionmethod":
            pane = _pane_by_index(item)
        elif kind in ("gas", "gasmixture"):
            gaps.append(_gap(context, item))
            continue
        else:
            context.findings.left_out(
                item, "a layer that has no counterpart here", "see the windows that use it"
            )
            return None
        if pane is None:
            return None
        panes.append(pane)
    if not panes or len(gaps) != len(panes) - 1:
        raise construction.error(
            f"{len(panes)} panes and {len(gaps)} gaps", "a gap between two panes each", "Correct the layers"
        )
    return {"kind": "panes", "panes": panes} | ({"gaps": gaps} if gaps else {})


def _without_shades(context: Context, construction: IdfObject, layers: list[IdfObject]) -> list[IdfObject]:
    """Layers without shading devices; of the two gaps around one between panes, one with both widths."""
    shaded = [item for item in layers if any(word in item.kind.casefold() for word in _SHADES)]
    for item in shaded:
        context.findings.left_out(
            construction,
            f"the shading device '{item.name}' in it",
            "the glazing is unshaded: more sun enters, more heat is lost at night",
        )
    unshaded_layers: list[IdfObject] = []
    for item in layers:
        gas = item.kind in ("WindowMaterial:Gas", "WindowMaterial:GasMixture")
        if item in shaded or (gas and unshaded_layers and unshaded_layers[-1].kind == item.kind):
            continue
        unshaded_layers.append(item)
    return unshaded_layers


def _pane(context: Context, item: IdfObject) -> Section | None:
    if item.word("optical_data_type") in ("spectral", "spectralandangle", "bsdf"):
        return _spectral(context, item)
    through = item.needed("solar_transmittance_at_normal_incidence")
    through *= item.number("dirt_correction_factor_for_solar_and_visible_transmittance") or 1.0
    front = item.number("front_side_solar_reflectance_at_normal_incidence") or 0.0
    back = item.number("back_side_solar_reflectance_at_normal_incidence") or 0.0
    if item.word("solar_diffusing") == "yes":
        context.findings.approximated(item, "diffusing glass", "beams pass it without being scattered")
    return _body(context, item) | {
        "transmittance": max(through, 1e-3),
        "reflectance": front if front == back else [front, back],
    }


def _body(context: Context, item: IdfObject) -> Section:
    emissivity = [
        item.number(f"{s}_side_infrared_hemispherical_emissivity") or 0.84 for s in ("front", "back")
    ]
    if item.number("infrared_transmittance_at_normal_incidence"):
        context.findings.approximated(
            item, "transmittance of infrared", "long-wave radiation does not pass the pane"
        )
    return {
        "thickness": item.needed("thickness"),
        "conductivity": item.number("conductivity") or 0.9,
        "emissivity": emissivity[0] if emissivity[0] == emissivity[1] else emissivity,
    }


@reads("MaterialProperty:GlazingSpectralData")
def _spectral(context: Context, item: IdfObject) -> Section | None:
    """Solar means of a table over the wavelength, weighted by the intervals; no solar spectrum is at hand."""
    data = context.model.named(
        item.text("window_glass_spectral_data_set_name"), "MaterialProperty:GlazingSpectralData"
    )
    if data is None:
        context.findings.left_out(
            item, "optics by angle or of an unknown data set", "see the windows that use it"
        )
        return None
    rows = [*_numbered(data), *data.rows("extensions"), *data.rows("data")]
    by_wavelength = {float(row.get("wavelength", 0.0)): row for row in rows}
    solar = [(length, by_wavelength[length]) for length in sorted(by_wavelength) if 0.3 <= length <= 2.5]
    if len(solar) < 2:
        raise data.error(f"{len(solar)} wavelengths from 0.3 to 2.5 um", "at least 2", "Complete the table")
    context.findings.approximated(
        item,
        "optics by wavelength",
        "their means are used, weighted by the black body at 5800 K: a few hundredths of transmittance",
    )

    def mean(key: str) -> float:
        total = weight = 0.0
        for (a, first), (b, second) in pairwise(solar):
            share = (b - a) * _sunlight(0.5 * (a + b))
            total += 0.5 * (float(first.get(key, 0.0)) + float(second.get(key, 0.0))) * share
            weight += share
        return round(total / weight, 5)

    front, back = mean("front_reflectance"), mean("back_reflectance")
    return _body(context, item) | {
        "transmittance": max(mean("transmittance"), 1e-3),
        "reflectance": front if abs(front - back) < 1e-4 else [front, back],
    }


def _numbered(data: IdfObject) -> list[dict[str, Any]]:
    """The first wavelengths of a table, which the schema numbers; the others are groups."""
    keys = ("wavelength", "transmittance", "front_reflectance", "back_reflectance")
    numbers = [k for k in range(1, len(data.fields) + 1) if f"wavelength_{k}" in data.fields]
    return [{key: data.number(f"{key}_{k}") or 0.0 for key in keys} for k in numbers]


def _sunlight(wavelength: float) -> float:
    """Planck's law at 5800 K, in any unit, over the wavelength [um]."""
    return 1.0 / (wavelength**5 * math.expm1(14387.77 / (wavelength * 5800.0)))


def _pane_by_index(item: IdfObject) -> Section:
    """A pane by refractive index and extinction coefficient: a homogeneous plate at normal incidence."""
    index, extinction = item.needed("solar_index_of_refraction"), item.needed("solar_extinction_coefficient")
    thickness = item.needed("thickness")
    surface = ((index - 1.0) / (index + 1.0)) ** 2
    inner = math.exp(-extinction * thickness)
    through = (1.0 - surface) ** 2 * inner / (1.0 - (surface * inner) ** 2)
    return {
        "thickness": thickness,
        "conductivity": item.number("conductivity") or 0.9,
        "emissivity": item.number("infrared_hemispherical_emissivity") or 0.84,
        "transmittance": round(max(through, 1e-3), 5),
        "reflectance": round(surface * (1.0 + through * inner), 5),
    }


def _gap(context: Context, item: IdfObject) -> Section:
    thickness = item.needed("thickness")
    if item.kind == "WindowMaterial:Gas":
        gas = item.word("gas_type")
        if gas in _GASES:
            return {"thickness": thickness, "gas": gas}
        context.findings.approximated(item, f"a gas '{gas}'", "air is used: the gap conducts more or less")
        return {"thickness": thickness, "gas": "air"}
    count = round(item.number("number_of_gases_in_mixture") or 2)
    parts = [
        (item.number(f"gas_{k}_fraction") or 0.0, item.word(f"gas_{k}_type")) for k in range(1, count + 1)
    ]
    share, gas = max(parts)
    gas = gas if gas in _GASES else "air"
    context.findings.approximated(
        item, f"a mixture with {share:.0%} of {gas}", f"{gas} alone: some percent of the gap's conductance"
    )
    return {"thickness": thickness, "gas": gas}


CONSTRUCTIONS: Final = (
    "Construction",
    "Construction:CfactorUndergroundWall",
    "Construction:FfactorGroundFloor",
    "Construction:InternalSource",
    "Construction:AirBoundary",
    "Construction:WindowDataFile",
    "Construction:WindowEquivalentLayer",
    "Construction:ComplexFenestrationState",
    "Construction:WindowTransitions",
)


@reads(*CONSTRUCTIONS)
def construction_of(context: Context, user: IdfObject, *, name: str | None = None) -> IdfObject:
    """Construction that a surface or window names.

    Raises
    ------
    InputError
        There is none.
    """
    return context.model.require(user, "construction_name", *CONSTRUCTIONS, name=name)
