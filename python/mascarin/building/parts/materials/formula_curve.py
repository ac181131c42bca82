"""A curve of the liquid fraction written as text; the engine reads and computes it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from pydantic import Field, model_validator

from mascarin import _engine
from mascarin.building import quantities as q
from mascarin.building.base.number import problem
from mascarin.building.base.part import Location, insist, text_fault
from mascarin.building.parts.materials.closed_law import ClosedLaw, Floats
from mascarin.building.parts.materials.formula import Formula, stated_unit

if TYPE_CHECKING:
    import numpy.typing as npt
    from pydantic_core import InitErrorDetails

#: Melting temperature with which formulas are looked at: they depend on the distance from it. [degC]
_MIDDLE: Final = 20.0
#: Temperatures at which the slope of a formula is looked at.
_STEPS: Final = 401


class FormulaCurve(Formula, ClosedLaw):
    """Liquid fraction as a formula of the temperature ``T`` and the melting temperature ``Tm``.

    What is missing to 0 and 1 at the ends of the range is shared out; it is at most 0.02.

    Examples
    --------
    >>> law = FormulaCurve(formula="1/(1 + exp(-(T - Tm)/w))", w={"value": 0.5, "unit": "K"}, range=[-5, 5])
    >>> round(float(law.fraction(0.0)), 6), law.reach
    (0.5, (-5.0, 5.0))
    """

    kind: Literal["text"] = "text"
    formula: str = Field(description="The liquid fraction, such as 1/(1 + exp(-(T - Tm)/w))")
    range: tuple[q.CurveEnd, q.CurveEnd] = Field(
        description="Where it melts, from all solid to all liquid, about the melting temperature [K]"
    )

    @model_validator(mode="after")
    def _rising(self) -> FormulaCurve:
        low, high = self.range
        if not low < high:
            raise problem(
                f"range: [{low:g}, {high:g}]",
                "two distances from the melting temperature that rise",
                "Swap them.",
            )
        insist(*self.faults(()))
        return self

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete [K]."""
        return (float(self.range[0]), float(self.range[1]))

    @property
    def half_width(self) -> float:
        """Half-width of a straight line with the largest slope of the curve [K]."""
        above = np.linspace(*self.reach, _STEPS)
        return float(0.5 * (above[1] - above[0]) / np.diff(self._values(above)).max())

    def fraction(self, above: npt.ArrayLike) -> Floats:
        """Liquid fraction at distances above the melting temperature [K], with their shape. [-]"""
        distances = np.asarray(above, dtype=np.float64)
        return self._values(distances.ravel()).reshape(distances.shape)

    def _stated(self, changes: Mapping[str, float]) -> list[tuple[str, float, None, str | None]]:
        """Names, values and units of the numbers, some of them changed."""
        return [
            (name, changes.get(name, float(number)), None, stated_unit(number))
            for name, number in self.numbers.items()
        ]

    def _values(self, above: Floats) -> Floats:
        numbers = self._stated({})
        return _engine.fraction_values(self.formula, numbers, _MIDDLE, self.reach, _MIDDLE + above)

    def faults(self, location: Location) -> Iterator[InitErrorDetails]:
        """What is wrong with the curve, with its numbers and at the ends of their ranges.

        Parameters
        ----------
        location : tuple
            Path of the law.
        """
        ranges = {name: number.range for name, number in self.numbers.items() if number.range is not None}
        alone = [{name: end} for name, ends in ranges.items() for end in ends]
        together = [{name: ends[k] for name, ends in ranges.items()} for k in (0, 1) if ranges]
        for changes in (dict[str, float](), *alone, *together):
            defect = _engine.check_fraction(self.formula, self._stated(changes), _MIDDLE, self.reach)
            if defect is not None:
                key, line, column, what, *details = defect
                varied = ", ".join(f"{name} = {value:g}" for name, value in changes.items())
                words = [f"{what}, with {varied}" if varied else what, *details]
                yield text_fault((*location, key), words, (line, column) if key == "formula" else None)
                return
