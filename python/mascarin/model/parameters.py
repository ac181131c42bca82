"""The language of parameters: every numeric leaf of a description has a path.

Sensitivity, calibration, sweeps and GenOpt files all name numbers by these paths.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mascarin.errors import InputError, did_you_mean
from mascarin.model.number import Fixed, Number
from mascarin.model.part import Part

if TYPE_CHECKING:
    from mascarin.model.building import Building


@dataclass(frozen=True)
class Parameter:
    """One numeric leaf of a building.

    Attributes
    ----------
    path : str
        Dotted path in the description.
    value : float
        Nominal value. [unit]
    unit : str
        Unit of all its numbers.
    lower, upper : float
        Hard limits; may be infinite. [unit]
    low, high : float
        Believable range: as written in the description, else by default for the quantity. [unit]
    description : str
        What the number is.
    source : str or None
        Where the value comes from.
    assumed : bool
        Whether nobody measured it or looked it up.
    structural : bool
        Whether it shapes the calculation itself, so that changing it means a new plan.
    reason : str or None
        Why it is structural or has no effect in this building; none: it acts.
    range_reason : str
        Why the range is as wide as it is.
    """

    path: str
    value: float
    unit: str
    lower: float
    upper: float
    low: float
    high: float
    description: str
    source: str | None
    assumed: bool
    structural: bool
    reason: str | None
    range_reason: str

    @property
    def varies(self) -> bool:
        """Whether a sensitivity analysis can vary it and see something."""
        return self.reason is None and self.low < self.high


Leaf = tuple[str, Number, str]


def leaves(part: Any, path: str = "", source: str | None = None) -> Iterator[Leaf]:
    """Walk over all numbers of a part: path, number, source."""
    if isinstance(part, Number):
        yield path, part, part.source or source or ""
        return
    if isinstance(part, Part):
        source = getattr(part, "source", None) or source
    for key, value in steps(part):
        yield from leaves(value, f"{path}.{key}" if path else str(key), source)


def steps(part: Any) -> Iterator[tuple[str, Any]]:
    """Name the pieces of a part, one step of a path each; layers go by name, points by position."""
    if isinstance(part, Part):
        yield from ((key, getattr(part, key)) for key in type(part).model_fields)
    elif isinstance(part, Mapping):
        yield from part.items()
    elif isinstance(part, tuple):
        yield from ((getattr(piece, "name", str(index)), piece) for index, piece in enumerate(part))


def parameters(building: Building) -> list[Parameter]:
    """All numeric leaves of a building, in the order of the description."""
    idle = without_effect(building)
    return [_parameter(path, number, source, idle.get(path)) for path, number, source in leaves(building)]


def _parameter(path: str, number: Number, source: str, idle: str | None) -> Parameter:
    quantity = number.quantity
    if quantity is None:
        raise TypeError(f"{path} measures no quantity")
    low, high = number.believable
    fixed = isinstance(quantity.spread, Fixed)
    return Parameter(
        path=path,
        value=float(number),
        unit=quantity.unit,
        lower=quantity.limits.lower,
        upper=quantity.limits.upper,
        low=low,
        high=high,
        description=quantity.description,
        source=source or None,
        assumed=number.assumed,
        structural=fixed,
        reason=quantity.spread.reason if fixed else idle,
        range_reason=quantity.spread.reason if number.range is None else "written in the description",
    )


def resolve(building: Building, path: str, known: Mapping[str, Any]) -> str:
    """Find the path that a user means: itself, or one of the short ways to write it.

    Raises
    ------
    InputError
        If nothing goes by that path; the text names the nearest ones.
    """
    for candidate in (path, *_aliases(building, path)):
        if candidate in known:
            return candidate
    raise InputError(
        f"{path}: found no such parameter; expected a path as listed by 'mascarin parameters'. "
        f"{did_you_mean(path, known)}".rstrip()
    )


def _aliases(building: Building, path: str) -> Iterator[str]:
    match path.split("."):
        case ["constructions", construction, "layers", layer, *rest] if (
            construction in building.constructions
        ):
            for one in building.constructions[construction].layers:
                if one.name == layer:
                    yield ".".join(["materials", one.material, *rest])
        case ["surfaces", _, _, "convection"]:
            yield f"{path}.coefficient"
        case ["zones", _, "infiltration"]:
            yield f"{path}.constant"
        case ["surfaces", _, _, "ground", "temperature"]:
            yield f"{path.removesuffix('temperature')}mean"


def without_effect(building: Building) -> dict[str, str]:
    """Leaves that no result of this building depends on, and why."""
    return dict(_idle(building))


def _idle(building: Building) -> Iterator[tuple[str, str]]:
    sides = [
        (f"surfaces.{name}.{which}", side)
        for name, s in building.surfaces.items()
        for which, side in (("outside", s.outside), ("inside", s.inside))
    ]
    used_constructions = {surface.construction for surface in building.surfaces.values()}
    used_materials = set()
    for name, construction in building.constructions.items():
        if name in used_constructions:
            used_materials |= {layer.material for layer in construction.layers}
        else:
            yield from _all_of(f"constructions.{name}", construction, "no surface is built this way")
    for name, material in building.materials.items():
        if name not in used_materials:
            yield from _all_of(f"materials.{name}", material, "no surface contains this material")
    yield from _idle_in_site(building, [side for _, side in sides])
    for path, side in sides:
        yield from _idle_on_side(path, side)
    for name, surface in building.surfaces.items():
        if surface.tilt in (0.0, 180.0):
            yield f"surfaces.{name}.azimuth", "a horizontal surface has no direction"
    for name, surface in building.surfaces.items():
        if surface.azimuth is not None and surface.azimuth.settled and surface.vertices is None:
            yield f"surfaces.{name}.azimuth", "no sun and no zone see the direction of this surface"


def _idle_in_site(building: Building, sides: list[Any]) -> Iterator[tuple[str, str]]:
    from mascarin.model.envelope import NoLongwave

    site = building.site
    outdoors = [side for side in sides if side.outdoors]
    sunlit = [side for side in outdoors if side.irradiance is None]
    radiating = [side for side in outdoors if not isinstance(side.longwave, NoLongwave)]
    if not sunlit:
        yield "site.ground_reflectance", "no side takes its irradiance from the climate"
    if not radiating:
        yield from _all_of("site.sky", site.sky, "no side exchanges long-wave with the sky")
    if not radiating or site.sky.kind in ("measured", "offset"):
        yield from _all_of("site.cloud", site.cloud, "the emissivity of the sky is not used")
    if not any(side.height is not None for side in sides):
        yield from _all_of("site.wind", site.wind, "no side has a height: mast wind is used as it is")
    elif not any(_windy(side) for side in sides if side.height is not None):
        yield from _all_of("site.wind", site.wind, "no film on a side with a height depends on wind")
    if not building.zones:
        yield "site.altitude", "there is no zone whose air would have a density"


def _windy(side: Any) -> bool:
    film = side.convection
    if film is None or film.kind in ("constant", "alamdari_hammond", "paper_eq5"):
        return False
    return film.kind != "power" or bool(film.upward.c > 0.0 or film.downward.c > 0.0)


def _idle_on_side(path: str, side: Any) -> Iterator[tuple[str, str]]:
    if side.ground is not None and side.ground.amplitude == 0.0:
        yield f"{path}.ground.coldest_day", "the amplitude is 0"
    if side.height is not None and not _windy(side):
        yield f"{path}.height", "the film does not depend on wind"
    film = side.convection
    if film is not None and film.kind == "power":
        for direction in ("upward", "downward"):
            law = getattr(film, direction)
            if law.b == 0.0:
                yield f"{path}.convection.{direction}.n", "b is 0"
            if law.c == 0.0:
                yield f"{path}.convection.{direction}.m", "c is 0"


def _all_of(path: str, part: Any, reason: str) -> Iterator[tuple[str, str]]:
    yield from ((leaf, reason) for leaf, _, _ in leaves(part, path))
