"""Laws written as text that are none of convection or melting; the engine reads and computes them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from mascarin import _engine
from mascarin.building.base.number import Interval
from mascarin.building.base.part import Location, insist, text_fault
from mascarin.building.parts.materials.formula import Formula, names_in, stated_unit
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt
    from pydantic_core import InitErrorDetails

#: Name, value, range and unit, where they are stated.
StatedNumbers = tuple[tuple[str, float, Interval | None, str | None], ...]
#: Temperature at which a conductivity by temperature is said as one number. [degC]
_USUAL = 20.0


class TextLaw(Formula):
    """A law of names that change during a run, and of numbers that stand beside the formula."""

    formula: str = Field(description="The law, with names of numbers that stand beside it")
    valid: str | None = Field(None, description="Where it holds; it is looked at only there")

    @property
    def law_of(self) -> str:
        """What it is a law of, in the words of the engine."""
        raise NotImplementedError  # each law below says what it is of; this class itself is none

    @property
    def names(self) -> frozenset[str]:
        """Names that the formula and its validity use, functions included."""
        return names_in(self.formula) | names_in(self.valid)

    @property
    def stated(self) -> StatedNumbers:
        """Names, values, ranges and units of its numbers."""
        return tuple(
            (name, float(number), number.range, stated_unit(number)) for name, number in self.numbers.items()
        )

    @model_validator(mode="after")
    def _is_a_law(self) -> Self:
        insist(*self.faults(()))
        return self

    def faults(self, location: Location) -> Iterator[InitErrorDetails]:
        """What is wrong with it.

        Parameters
        ----------
        location : tuple
            Path of the law.
        """
        defect = _checked(self.law_of, self.formula, self.valid, self.stated)
        if defect is not None:
            key, line, column, *words = defect
            in_text = key in ("formula", "valid")
            yield text_fault((*location, key), words, (line, column) if in_text else None)

    def at_values(self, values: Mapping[str, float]) -> Iterator[InitErrorDetails]:
        """What is wrong with it at other values of its numbers."""
        changed = tuple((name, values.get(name, value), None, unit) for name, value, _, unit in self.stated)
        defect = _checked(self.law_of, self.formula, self.valid, changed)
        if defect is not None:
            key, _, _, *words = defect
            yield text_fault((key,), words, None)

    def _values(self, *points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Values at points: the names that change, in their order."""
        arrays = np.broadcast_arrays(*(np.asarray(point, dtype=np.float64) for point in points))
        flat = [np.ascontiguousarray(array.ravel()) for array in arrays]
        try:
            values = _engine.function_values(self.law_of, self.formula, list(self.stated), flat)
        except _engine.EngineInputError as error:
            raise InputError(f"formula: {error}") from None
        return values.reshape(arrays[0].shape)


@lru_cache(maxsize=512)
def _checked(
    law_of: str, formula: str, valid: str | None, stated: StatedNumbers
) -> tuple[str, int, int, str, str, str] | None:
    return _engine.check_function(law_of, formula, valid, list(stated))


class ConductivityLaw(TextLaw):
    """Conductivity as a formula of the temperature ``T`` [degC]: [W/(m K)].

    Examples
    --------
    >>> law = ConductivityLaw(formula="0.035*(1 + a*T)", a={"value": 0.004, "unit": "1/K"})
    >>> law.value([0.0, 20.0]).round(4).tolist(), round(float(law), 4)
    ([0.035, 0.0378], 0.0378)
    """

    formula: str = Field(description="The conductivity [W/(m K)], such as 0.035*(1 + 0.004*T)")

    @property
    def law_of(self) -> str:
        """What it is a law of, in the words of the engine."""
        return "conductivity"

    def value(self, temperature: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The conductivity, as written.

        Parameters
        ----------
        temperature : array_like
            Temperature of the material. [degC]

        Returns
        -------
        ndarray
            In the shape of the temperatures. [W/(m K)]
        """
        return self._values(temperature)

    def __float__(self) -> float:
        """The conductivity at 20 degC, for U values and meshes. [W/(m K)]"""
        return float(self._values(_USUAL))


class InfiltrationLaw(TextLaw):
    """Air changes as a formula: [1/h].

    The formula may use ``dT`` (air of the zone minus outdoor air [K]), ``V`` (wind at the mast [m/s]), ``Ti``
    and ``To`` (air of the zone and outdoor air [degC]), and the numbers given with it.

    Examples
    --------
    >>> law = InfiltrationLaw(formula="c*sqrt(0.02*abs(dT) + 0.01*V^2)", c={"value": 0.8, "range": [0.2, 2]})
    >>> law.value(20.0, 3.0).round(4).tolist()
    0.56
    """

    kind: Literal["text"] = "text"
    formula: str = Field(description="The air changes [1/h], such as 0.1 + 0.02*abs(dT)^0.5 + 0.05*V")

    @property
    def law_of(self) -> str:
        """What it is a law of, in the words of the engine."""
        return "infiltration"

    def value(
        self, difference: npt.ArrayLike, wind: npt.ArrayLike = 0.0, outdoor: npt.ArrayLike = 10.0
    ) -> npt.NDArray[np.float64]:
        """The air changes, as written.

        Parameters
        ----------
        difference : array_like
            Air of the zone minus outdoor air. [K]
        wind : array_like
            Wind at the mast. [m/s]
        outdoor : array_like
            Outdoor air. [degC]

        Returns
        -------
        ndarray
            In the shape of all arrays together. [1/h]
        """
        return self._values(difference, wind, outdoor)


class TextSky(TextLaw):
    """Emission of the sky as a formula: an emissivity [-], or a temperature [degC] with ``of: temperature``.

    The formula may use ``To`` (outdoor air [degC]), ``Td`` (dew point [degC]), ``pw`` (vapour pressure [Pa]),
    ``cloud`` (cover [tenths]) and the numbers given with it. An emissivity without ``cloud`` is that of the
    clear sky, which ``site.cloud`` adds clouds to; others have no other effect of clouds.

    Examples
    --------
    >>> sky = TextSky(formula="a + b*sqrt(pw/100)", a=0.52, b=0.065)
    >>> sky.value(20.0, 10.0, 1228.0).round(4).tolist()
    0.7478
    """

    kind: Literal["text"] = "text"
    formula: str = Field(
        description="The emissivity [-] or the temperature [degC], such as 0.52 + 0.0065*pw^0.5"
    )
    of: Literal["emissivity", "temperature"] = Field(
        "emissivity", description="What the formula gives: the emissivity, or the temperature of the sky"
    )

    @property
    def law_of(self) -> str:
        """What it is a law of, in the words of the engine."""
        return f"sky_{self.of}"

    @property
    def clouded(self) -> bool:
        """Whether `Site.cloud` has no effect: clouds are in the formula, or a temperature is given."""
        return self.of == "temperature" or "cloud" in names_in(self.formula)

    @property
    def weather(self) -> frozenset[str]:
        """Columns of the weather that it needs."""
        return frozenset({"dew_point", "cloud_cover"})

    def value(
        self,
        outdoor: npt.ArrayLike,
        dew_point: npt.ArrayLike,
        vapour_pressure: npt.ArrayLike,
        cloud: npt.ArrayLike = 0.0,
    ) -> npt.NDArray[np.float64]:
        """The emissivity or the temperature, as written.

        Parameters
        ----------
        outdoor, dew_point : array_like
            Outdoor air and dew point. [degC]
        vapour_pressure : array_like
            Vapour pressure. [Pa]
        cloud : array_like
            Cloud cover. [tenths]

        Returns
        -------
        ndarray
            In the shape of all arrays together. [- or degC]
        """
        return self._values(outdoor, dew_point, vapour_pressure, cloud)


def numbers_of(law: TextLaw, ids: Any, prefix: str) -> dict[str, Any]:
    """Describe a law to the engine: its formula, and the ids of its numbers."""
    numbers = [{"name": name, "value": ids(f"{prefix}{name}")} for name in law.numbers]
    return {"formula": law.formula, "valid": law.valid, "numbers": numbers}
