"""A surface heat transfer coefficient written as text; the engine reads and computes it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from pydantic import Field

from mascarin import _engine
from mascarin.building.base.number import Interval
from mascarin.building.base.part import Location, text_fault
from mascarin.building.parts.materials.formula import Formula, names_in, stated_unit
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt

#: Names that Mascarin derives from the shape of a surface where a formula uses them.
LENGTH: Final = "length"
PERIMETER: Final = "perimeter"

#: Name, value, range and unit, where they are stated.
StatedNumbers = tuple[tuple[str, float, Interval | None, str | None], ...]


#: Whether wind reaches a side, whether its irradiance is known, whether it faces a zone; tilt of the normal
#: into the air [deg], area [m2], density of the air [kg/m3], height above ground, where it has one [m].
LawSide = tuple[tuple[bool, bool, bool], tuple[float, float, float, float | None]]


class FormulaLaw(Formula):
    """A coefficient as a formula of the temperature difference and the wind; its numbers stand beside it.

    The formula may use ``dT`` (surface minus air [K]), ``V`` (wind at the surface [m/s]), ``windward`` (holds
    where the wind blows onto the surface), ``tilt`` [deg] and ``upward`` [-] of the normal into the air,
    ``area`` [m2], ``density`` of the air [kg/m3], ``length`` and ``perimeter`` [m] of the surface, the
    temperatures ``Ts`` of the surface and ``Ta`` of the air [degC], ``wind_angle`` [deg], ``sun`` on the
    plane of the side [W/m2] and ``height`` [m] outdoors, ``air_change`` and ``total_air_change`` of the zone
    [1/h] indoors, and the numbers given with it.

    Examples
    --------
    >>> law = FormulaLaw(formula="c*abs(dT)^n", c={"value": 2.3, "unit": "W/(m2 K^(1+n))"}, n=0.24)
    >>> law.numbers["c"], law.valid
    (2.3, None)
    """

    kind: Literal["text"] = "text"
    formula: str = Field(description="The coefficient [W/(m2 K)], such as 2.3*abs(dT)^0.24")
    valid: str | None = Field(
        None, description="Where it holds, such as abs(dT) < 30; a run outside of it has a warning"
    )

    @property
    def names(self) -> frozenset[str]:
        """Names that the formula and its validity use, functions included."""
        return names_in(self.formula) | names_in(self.valid)

    def uses(self, name: str) -> bool:
        """Whether a name is used."""
        return name in self.names

    @property
    def stated(self) -> StatedNumbers:
        """Names, values, ranges and units of its numbers."""
        return tuple(
            (name, float(number), number.range, stated_unit(number)) for name, number in self.numbers.items()
        )

    def coefficient(
        self,
        difference: npt.ArrayLike,
        wind: npt.ArrayLike = 0.0,
        *,
        air: npt.ArrayLike = 20.0,
        wind_angle: npt.ArrayLike = 0.0,
        sun: npt.ArrayLike = 0.0,
        air_change: npt.ArrayLike = 0.0,
        total_air_change: npt.ArrayLike = 0.0,
        tilt: float = 90.0,
        area: float = 10.0,
        density: float = 1.2,
        height: float = 3.0,
    ) -> npt.NDArray[np.float64]:
        """The coefficient as written, where the wind blows onto the surface.

        Parameters
        ----------
        difference : array_like
            Temperature of the surface minus that of the air. [K]
        wind : array_like
            Wind at the surface. [m/s]
        air : array_like
            Temperature of the air. [degC]
        wind_angle : array_like
            Angle between the normal and the direction that the wind comes from. [deg]
        sun : array_like
            Irradiance of the plane of the side. [W/m2]
        air_change : array_like
            Outdoor air that flows into the zone. [1/h]
        total_air_change : array_like
            All air that flows into the zone or moves within it. [1/h]
        tilt : float
            Angle between upwards and the normal into the air. [deg]
        area : float
            Area of the surface. [m2]
        density : float
            Density of the air. [kg/m3]
        height : float
            Height of the side above ground. [m]

        Returns
        -------
        ndarray
            In the shape of all arrays together. [W/(m2 K)]

        Raises
        ------
        InputError
            If the formula has a fault.

        Examples
        --------
        >>> FormulaLaw(formula="2*abs(dT)^(1/3)").coefficient([8.0, -8.0]).round(6).tolist()
        [4.0, 4.0]
        """
        inputs = (difference, wind, air, wind_angle, sun, air_change, total_air_change)
        arrays = np.broadcast_arrays(*(np.asarray(values, float) for values in inputs))
        flat = [np.ascontiguousarray(array.ravel()) for array in arrays]
        side = (tilt, area, density, height)
        try:
            values = _engine.formula_values(self.formula, list(self.stated), side, flat)
        except _engine.EngineInputError as error:
            raise InputError(f"formula: {error}") from None
        return values.reshape(arrays[0].shape)

    def at_values(self, values: Mapping[str, float]) -> FormulaLaw:
        """The same law with other values of its numbers, without their ranges."""
        numbers = {name: float(values.get(name, number)) for name, number in self.numbers.items()}
        return FormulaLaw(formula=self.formula, valid=self.valid, numbers=numbers)

    def faults(self, location: Location, side: LawSide) -> Iterator[Any]:
        """What is wrong with it at a side of a surface.

        Parameters
        ----------
        location : tuple
            Path of the law.
        side : tuple
            What the side gives to the law.
        """
        defect = _checked(self.formula, self.valid, self.stated, side)
        if defect is not None:
            key, line, column, *words = defect
            in_text = key in ("formula", "valid")
            yield text_fault((*location, key), words, (line, column) if in_text else None)


@lru_cache(maxsize=512)
def _checked(
    formula: str, valid: str | None, stated: StatedNumbers, side: LawSide
) -> tuple[str, int, int, str, str, str] | None:
    return _engine.check_formula(formula, valid, list(stated), side)
