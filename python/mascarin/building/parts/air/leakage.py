"""Infiltration from the air changes of a pressure test: a class for each row of the engine's table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import Field

from mascarin.building.base.law_classes import PublishedLaw, classes_of, union_of
from mascarin.building.base.law_table import LEAKAGE
from mascarin.building.base.part import Shorthand


class LeakageLaw(PublishedLaw):
    """A published law of infiltration by a pressure test.

    Examples
    --------
    >>> from mascarin.building import LeakageFactor, LeakageLaw
    >>> isinstance(LeakageFactor(n50=2.2), LeakageLaw)
    True
    """

    if TYPE_CHECKING:

        def __init__(self, **numbers: Any) -> None: ...


#: Classes of the laws by their names: `LeakageFactor` and so on.
LEAKAGES: Final = classes_of(LEAKAGE.values(), LeakageLaw, "Leakage{}")
globals().update(LEAKAGES)

if TYPE_CHECKING:
    PressureTest = LeakageLaw
else:
    PressureTest = Annotated[
        union_of(LEAKAGES.values()),
        Field(discriminator="kind"),
        Shorthand(number="n50", kind="factor"),
    ]
