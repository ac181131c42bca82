"""Outputs that are derived from other outputs by a formula."""

from __future__ import annotations

import re
from typing import Annotated, Final

from pydantic import Field

from mascarin.building.base.part import Shorthand
from mascarin.building.parts.materials.formula import Formula

#: A name in a formula; names of outputs have dots inside.
_NAME: Final = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")


class Derived(Formula):
    """A result of a run that follows from others by a formula; short form: the formula alone.

    The formula may use every output of the building by its name, other derived outputs, and the numbers given
    with it.

    Examples
    --------
    >>> gain = Derived(formula="a*roof.inside_flux", unit="W", a={"value": 12, "unit": "m2"})
    >>> gain.used, gain.unit
    (('a', 'roof.inside_flux'), 'W')
    """

    formula: str = Field(description="The output, such as room.air_temperature - roof.inside_temperature")
    unit: str = Field(
        "-", description="Its unit, such as W/m2; none: any, and units are not compared with it"
    )

    @property
    def used(self) -> tuple[str, ...]:
        """Names in the formula, in their order, functions included."""
        return tuple(dict.fromkeys(_NAME.findall(self.formula)))


DerivedOutput = Annotated[Derived, Shorthand(word="formula")]
