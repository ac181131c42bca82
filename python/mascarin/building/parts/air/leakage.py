"""Infiltration from the air changes of a pressure test."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.number import Number, Remark, quantity_of
from mascarin.building.base.part import Part, Shorthand

ISO_13789 = "EN ISO 13789:2017 (air changes of infiltration from n50)"
BASIC_MODEL = (
    "Sherman & Grimsrud 1980, ASHRAE Trans. 86(2), 778-807, as in ASHRAE Handbook of Fundamentals 2017, "
    "ch. 16, eq. 48 (infiltration by stack and wind)"
)

#: Stack coefficients by the number of storeys [(L/s)2/(cm4 K)].
_STACK: Final = {1: 0.000145, 2: 0.000290, 3: 0.000435}
#: Wind coefficients by the number of storeys, for the shelter classes 1 to 5 [(L/s)2/(cm4 (m/s)2)].
_WIND: Final = {
    1: (0.000319, 0.000246, 0.000174, 0.000104, 0.000032),
    2: (0.000420, 0.000325, 0.000231, 0.000137, 0.000042),
    3: (0.000494, 0.000382, 0.000271, 0.000161, 0.000049),
}


class LeakageFactor(Part):
    """Constant infiltration: ``factor n50``.

    The factor depends on shielding: with several exposed facades 0.10 without, 0.07 with moderate and 0.04
    with heavy shielding, with one 0.03, 0.02 and 0.01.

    Examples
    --------
    >>> test = LeakageFactor(n50=2.2)
    >>> float(test.n50 * test.factor)
    0.15400000000000003
    """

    kind: Literal["factor"] = "factor"
    n50: q.AirChangeOfTest
    factor: q.LeakageFactor = Number(0.07, source=ISO_13789, assumed=True)


class LeakageStackWind(Part):
    """Infiltration by stack and wind through the leakage area of the test.

    ``Q = A sqrt(C_s |dT| + C_w U^2)``, with the leakage area A at 4 Pa and the wind U at the mast.

    Examples
    --------
    >>> test = LeakageStackWind(n50=2.2, storeys=1, shelter=3)
    >>> float(test.stack), float(test.wind)
    (0.000145, 0.000174)
    """

    kind: Literal["stack_wind"] = "stack_wind"
    n50: q.AirChangeOfTest
    exponent: q.LeakageExponent = Number(0.65, source=BASIC_MODEL, assumed=True)
    storeys: Literal[1, 2, 3] = Field(1, description="Number of storeys of the house: 1, 2 or 3")
    shelter: Literal[1, 2, 3, 4, 5] = Field(
        3, description="Shelter class: 1 none, 2 isolated rural house, 3 across a street, 4 dense, 5 close"
    )
    stack: q.StackCoefficient | None = None
    wind: q.WindLeakageCoefficient | None = None

    @model_validator(mode="after")
    def _from_tables(self) -> LeakageStackWind:
        tabulated = {"stack": _STACK[self.storeys], "wind": _WIND[self.storeys][self.shelter - 1]}
        for key, value in tabulated.items():
            if getattr(self, key) is None:
                quantity = quantity_of(type(self).model_fields[key])
                number = Number(
                    value, source=Remark("by storeys and shelter"), derived=True, quantity=quantity
                )
                self._fill(**{key: number})
        return self


PressureTest = Annotated[
    LeakageFactor | LeakageStackWind,
    Field(discriminator="kind"),
    Shorthand(number="n50", kind="factor"),
]
