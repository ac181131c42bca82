"""Temperatures that surroundings impose on a side: a class for each row of the engine's table.

The ground has a class and a key of its own (`mascarin.building.parts.envelope.surface.Ground`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import Field

from mascarin.building.base.law_classes import PublishedLaw, classes_of, union_of
from mascarin.building.base.law_table import IMPOSED

#: The law of the key ``ground``.
GROUND: Final = IMPOSED["ground"]


class ImposedLaw(PublishedLaw):
    """A law of the temperature of what a side is in contact with.

    Examples
    --------
    >>> from mascarin.building import ImposedLaw, ImposedSoil
    >>> isinstance(ImposedSoil(mean=12, amplitude=10, depth=1.5, coldest_day=40), ImposedLaw)
    True
    """

    if TYPE_CHECKING:

        def __init__(self, **numbers: Any) -> None: ...


#: Classes of the laws by their names: `ImposedSoil` and so on.
IMPOSED_LAWS: Final = classes_of(
    (row for row in IMPOSED.values() if row.kind != GROUND.kind), ImposedLaw, "Imposed{}"
)
globals().update(IMPOSED_LAWS)

if TYPE_CHECKING:
    ImposedTemperature = ImposedLaw
else:
    ImposedTemperature = Annotated[union_of(IMPOSED_LAWS.values()), Field(discriminator="kind")]
