"""Parameters: every number of a description by its path.

Sensitivity analysis, calibration, sweeps and GenOpt files name numbers by these paths.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from mascarin._io.listing import Listing
from mascarin.building.base.leaves import leaves
from mascarin.building.base.number import Number
from mascarin.building.base.part import cached_on
from mascarin.building.parameters.set_point_pairs import cut_ranges
from mascarin.building.parameters.unused_parameters import without_effect
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description


_MEASURED: Final = "follows a measured column: give a range if it is uncertain"


@dataclass(frozen=True)
class Parameter:
    """One number of a building.

    Attributes
    ----------
    path : str
        Dotted path in the description.
    value : float
        Nominal value. [unit]
    unit : str
        Unit of value, limits and range.
    lower, upper : float
        Smallest and largest value that has a meaning; may be infinite. [unit]
    low, high : float
        Plausible range: as given in the description, else the default of the quantity. [unit]
    description : str
        What the number is.
    source : str or None
        Where the value comes from.
    assumed : bool
        Whether it is an assumption, neither measured nor looked up.
    structural : bool
        Whether it changes the structure of the calculation, so that it cannot vary within a compiled run.
    reason : str or None
        Why it is structural or has no effect in this building; None: it has an effect.
    range_reason : str
        Reason for the width of the range.
    members : tuple of str
        Paths that vary as one with it, where it is a tied parameter; see ``ties`` of the building.
    above : float or None
        Where the smallest value is one just above this number, which has no meaning itself. [unit]

    Examples
    --------
    >>> from mascarin import examples
    >>> import mascarin as mc
    >>> cell = mc.load(examples.FOLDER / "lgi" / "building.yaml")
    >>> conductivity = cell.parameter("materials.energain.conductivity.solid")
    >>> conductivity.unit, conductivity.varies
    ('W/(m K)', True)
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
    members: tuple[str, ...] = ()
    above: float | None = None

    @property
    def allowed(self) -> str:
        """The limits in words, such as ``a value above 0 and at most 500 W/(m K)``."""
        first = f"from {self.lower:g}" if self.above is None else f"above {self.above:g}"
        second = f" to {self.upper:g}" if self.above is None else f" and at most {self.upper:g}"
        if math.isinf(self.upper):
            second = ""
        return f"a value {first}{second} {self.unit}".removesuffix(" -").rstrip()

    def inside(self, low: float) -> float:
        """The low end of a range; just inside where it lies on a limit that has no meaning itself. [unit]"""
        return self.lower if low == self.above else low

    @property
    def varies(self) -> bool:
        """Whether a sensitivity analysis can vary it with an effect."""
        return self.reason is None and self.low < self.high


def listed(entries: Iterable[Parameter]) -> Listing[Parameter]:
    """The parameters as a list that is shown with values and units."""
    all_parameters = list(entries)
    count = sum(parameter.varies for parameter in all_parameters)
    title = f"{len(all_parameters)} parameters, {count} of which may vary"
    return Listing(all_parameters, title, ("path", "value", "unit"))


def parameters(building: Description) -> list[Parameter]:
    """All numbers of a building, in the order of the description; the list must not be changed."""
    return cached_on(building, "_numbers", lambda: _all_parameters(building))


def _all_parameters(building: Description) -> list[Parameter]:
    inactive, cut = without_effect(building), cut_ranges(building)
    measured = _measured_powers(building)
    inactive = {**dict.fromkeys(measured, _MEASURED), **inactive}
    cut |= measured
    return [
        _parameter(path, number, source, inactive.get(path), cut.get(path))
        for path, number, source in leaves(building)
    ]


def _measured_powers(building: Description) -> dict[str, tuple[float, float]]:
    """Powers that follow a measured column and have no range of their own: they are as they were measured."""
    powers = {}
    for name, zone in building.zones.items():
        for gain, numbers in zone.gains.items():
            power, named = numbers.power, numbers.schedule
            measured = named is not None and building.schedules[named].column is not None
            if measured and power is not None and power.range is None:
                powers[f"zones.{name}.gains.{gain}.power"] = (float(power), float(power))
    return powers


def _parameter(
    path: str, number: Number, source: str, inactive: str | None, cut: tuple[float, float] | None
) -> Parameter:
    """One number; ``cut``: its range where the default one would cross that of another number."""
    quantity = number.quantity
    if quantity is None:
        raise TypeError(f"{path} measures no quantity")
    low, high = cut or number.plausible
    structural = number.structural
    if not low < high:
        inactive = inactive or "its default range has no width: give a range"
    return Parameter(
        path=path,
        value=float(number),
        unit=quantity.unit,
        lower=quantity.limits.least,
        upper=quantity.limits.upper,
        low=low,
        high=high,
        description=quantity.description,
        source=source or None,
        assumed=number.assumed,
        structural=structural,
        reason=quantity.spread.reason if structural else inactive,
        range_reason=_range_reason(quantity.spread.reason, number, cut),
        above=quantity.limits.above,
    )


def _range_reason(usual: str, number: Number, cut: tuple[float, float] | None) -> str:
    if number.range is not None:
        return "given in the description"
    return usual if cut is None else f"{usual}; cut between the set points of heating and cooling"


def resolve(building: Description, path: str, by_path: Mapping[str, Any]) -> str:
    """Find the path that a user means: itself, or a short form of it.

    Raises
    ------
    InputError
        If nothing has that path; the text names the nearest ones.
    """
    if not isinstance(path, str):
        raise InputError(
            f"parameters: found {path!r}, expected a path such as 'zones.room.volume', "
            "as Building.parameters() lists"
        )
    path_found = lookup(building, path, by_path)
    if path_found is None:
        steps = path.split(".")
        if steps[:2] == ["weather", "columns"] and len(steps) == 4:
            raise InputError(
                f"{path}: found no such parameter; expected a column that the building states. Write "
                f"weather: {{columns: {{{steps[2]}: {{}}}}}} in the building or the study"
            )
        raise InputError(
            f"{path}: found no such parameter; expected a path as listed by 'mascarin parameters'. "
            f"{did_you_mean(path, by_path)}".rstrip()
        )
    return path_found


def lookup(building: Description, path: str, by_path: Mapping[str, Any]) -> str | None:
    """Find the path that a user means; None if there is none."""
    return next((candidate for candidate in (path, *_aliases(building, path)) if candidate in by_path), None)


def _aliases(building: Description, path: str) -> Iterator[str]:
    match path.split("."):
        case ["constructions", construction, "layers", layer, *tail] if (
            construction in building.constructions
        ):
            for entry in building.constructions[construction].layers:
                if entry.name == layer:
                    yield ".".join(["materials", entry.material, *tail])
        case ["surfaces", _, _, "convection"]:
            yield f"{path}.coefficient"
        case ["zones", _, "infiltration"]:
            yield f"{path}.constant"
        case ["zones", _, "heating" | "cooling", "setpoint"]:
            yield f"{path}.temperature"
        case ["humidity", "zones", _, "drying" | "humidifying", "relative_humidity" | "humidity_ratio"]:
            yield f"{path}.constant"
        case ["surfaces", _, _, "ground", "temperature"]:
            yield f"{path.removesuffix('temperature')}mean"
