"""Surface heat transfer coefficients of the algorithms of EnergyPlus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mascarin.energyplus.envelope.idf_surfaces import OPENINGS, SURFACES
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfModel, IdfObject

#: Coefficients D + E V + F V^2 of the algorithm SimpleCombined by roughness, radiation included
#: (ASHRAE Handbook of Fundamentals 1989, p. 22.4, as in the EnergyPlus Engineering Reference).
_COMBINED: Final = {
    "very_rough": (11.58, 5.894, 0.0),
    "rough": (12.49, 4.065, 0.028),
    "medium_rough": (10.79, 4.192, 0.0),
    "medium_smooth": (8.23, 4.0, -0.057),
    "smooth": (10.22, 3.1, 0.0),
    "very_smooth": (8.23, 3.33, -0.036),
}
#: Natural convection inside by the algorithm Simple: vertical, heat flow up and down, and both for tilted
#: surfaces [W/(m2 K)] (Walton 1983, as in the EnergyPlus Engineering Reference).
_SIMPLE: Final = (3.076, 4.040, 0.948, 3.870, 2.281)
#: Kinds of surfaces in a group, where they are not of its name.
_GROUPS: Final = {
    "roof": ("roof", "ceiling"),
    "ceiling": ("roof", "ceiling"),
    "window": ("window", "glassdoor", "glazeddoor"),
}
#: Wind speeds between which the quadratic is replaced by a power [m/s].
_WINDS: Final = (1.0, 8.0)


@dataclass(frozen=True)
class OuterCoefficient:
    """A coefficient of the description.

    Attributes
    ----------
    convection : dict, str or float
        The coefficient.
    combined : bool
        Whether it contains the long-wave radiation.
    """

    convection: Any
    combined: bool = False


class ConvectionCoefficients:
    """Coefficients of the surfaces, by the algorithms and the values that the file names.

    Parameters
    ----------
    context : Context
        The conversion.
    """

    def __init__(self, context: Context) -> None:
        self._context, self.model = context, context.model
        self._by_surface = self._stated_coefficients()

    @reads("SurfaceProperty:ConvectionCoefficients", "SurfaceProperty:ConvectionCoefficients:MultipleSurface")
    def _stated_coefficients(self) -> dict[tuple[str, str], IdfObject]:
        by_surface: dict[tuple[str, str], IdfObject] = {}
        for item in self.model.of("SurfaceProperty:ConvectionCoefficients"):
            for k in (1, 2):
                side = item.word(f"convection_coefficient_{k}_location")
                if side:
                    by_surface[item.word("surface_name"), side] = item
        groups = self.model.of("SurfaceProperty:ConvectionCoefficients:MultipleSurface")
        faces = _faces(self.model) if groups else []
        for item in groups:
            word = item.word("surface_type")
            named = [name for name, kind, outdoors in faces if _in_group(word, name, kind, outdoors)]
            for k in (1, 2):
                side = item.word(f"convection_coefficient_{k}_location")
                by_surface |= {
                    (name, side): item for name in named if side and (name, side) not in by_surface
                }
        return by_surface

    @reads("SurfaceConvectionAlgorithm:Inside")
    def inside(self, user: IdfObject, zone: IdfObject | None, tilt: float, *, window: bool = False) -> Any:
        """Coefficient of an inner surface."""
        own_coefficient = self._stated(user, "inside")
        if own_coefficient is not None:
            return own_coefficient
        main = self.model.one("SurfaceConvectionAlgorithm:Inside")
        word = zone.word("zone_inside_convection_algorithm") if zone is not None else ""
        source = zone if word else main
        word = word or (main.word("algorithm") if main is not None else "") or "tarp"
        if word == "simple":
            return _simple(tilt)
        if word not in ("tarp", "detailed", "bldgdetailed") and source is not None:
            self._context.findings.approximated(
                source,
                f"inside convection by {word}",
                "the algorithm TARP is used: coefficients differ",
            )
        return "iso15099" if window else "tarp"

    @reads("SurfaceConvectionAlgorithm:Outside")
    def outside(self, user: IdfObject, zone: IdfObject | None, roughness: str) -> OuterCoefficient:
        """Coefficient of a surface outdoors."""
        own_coefficient = self._stated(user, "outside")
        if own_coefficient is not None:
            return OuterCoefficient(own_coefficient)
        main = self.model.one("SurfaceConvectionAlgorithm:Outside")
        word = zone.word("zone_outside_convection_algorithm") if zone is not None else ""
        source = zone if word else main
        word = word or (main.word("algorithm") if main is not None else "") or "doe-2"
        if word == "simplecombined":
            return OuterCoefficient(combined(roughness), combined=True)
        if word == "mowitt":
            return OuterCoefficient("mowitt")
        if word in ("tarp", "detailed", "blast"):
            return OuterCoefficient({"kind": "tarp", "roughness": roughness})
        if word != "doe-2" and source is not None:
            self._context.findings.approximated(
                source, f"outside convection by {word}", "the algorithm TARP is used: coefficients differ"
            )
            return OuterCoefficient({"kind": "tarp", "roughness": roughness})
        return OuterCoefficient({"kind": "doe2", "roughness": roughness})

    def _stated(self, user: IdfObject, side: str) -> Any:
        """Coefficient that the file gives for one surface; None without it."""
        item = self._by_surface.get((user.name.casefold(), side))
        if item is None:
            return None
        k = 1 if item.word("convection_coefficient_1_location") == side else 2
        kind = item.word(f"convection_coefficient_{k}_type")
        value = item.number(f"convection_coefficient_{k}")
        if kind == "value" and value is not None:
            return value
        word = {"tarp": "tarp", "mowitt": "mowitt", "doe2": "doe2", "simple": None}.get(kind)
        if word is None or (side == "inside" and word != "tarp"):
            self._context.findings.left_out(
                item, f"a coefficient by {kind}", "that of the algorithm of the building is used"
            )
        return word if side == "outside" or word == "tarp" else None


def _faces(model: IdfModel) -> list[tuple[str, str, bool]]:
    """Name, kind, and whether it is outdoors, of all surfaces and openings."""
    faces = []
    outdoors: dict[str, bool] = {}
    for kind in (*SURFACES, *OPENINGS):
        for item in model.of_class(kind):
            word = item.word("surface_type") or kind.partition(":")[0].casefold()
            base = item.word("building_surface_name")
            entered = item.word("outside_boundary_condition")
            simple = kind in ("Wall:Exterior", "Roof")
            outside = outdoors.get(base, False) if base else entered == "outdoors" or simple
            outdoors[item.name.casefold()] = outside
            faces.append((item.name.casefold(), word, outside))
    return faces


def _in_group(word: str, name: str, kind: str, outdoors: bool) -> bool:
    """Whether a surface belongs to a group such as AllExteriorWalls."""
    if word == name:
        return True
    if not word.startswith(("allexterior", "allinterior")) or word.startswith("allexterior") != outdoors:
        return False
    group = word.removeprefix("allexterior").removeprefix("allinterior").removesuffix("s")
    return kind in _GROUPS.get(group, (group,))


def _simple(tilt: float) -> Any:
    steep = abs(np.cos(np.radians(tilt)))
    vertical, up, down, tilted_up, tilted_down = _SIMPLE
    if steep < 0.3827:
        return vertical
    upward, downward = (up, down) if steep >= 0.9239 else (tilted_up, tilted_down)
    return {"kind": "power", "upward": {"a": upward}, "downward": {"a": downward}}


def combined(roughness: str) -> dict[str, Any]:
    """A coefficient ``D + E V + F V^2`` as ``a + c V^m``, fitted from 1 to 8 m/s."""
    d, e, f = _COMBINED[roughness]
    wind = np.linspace(*_WINDS, 47)
    slope, offset = np.polyfit(np.log(wind), np.log(e * wind + f * wind**2), 1)
    law = {"a": d, "c": round(float(np.exp(offset)), 4), "m": round(float(slope), 4)}
    return {"kind": "power", "upward": law, "downward": dict(law)}
