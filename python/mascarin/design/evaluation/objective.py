"""What every objective of a design study has: a unit, what is kept of its runs, and its value."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic import Field

from mascarin.building.base.part import Part
from mascarin.design.evaluation.checks import require_zone

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.design.evaluation.layers import LayerFacts
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]
    Reductions = dict[str, Callable[[Any], Any]]


class Objective(Part):
    """Base of the objectives."""

    #: Whether small values are good.
    least: ClassVar[bool] = True
    #: Reductions that the value is the sum of, and that are shown beside it where all of them are kept.
    PARTS: ClassVar[tuple[str, ...]] = ()

    @property
    @abstractmethod
    def unit(self) -> str:
        """Unit of the value."""

    def changes(self) -> dict[str, Any]:
        """What is replaced in the building for the runs of this objective."""
        return {}

    def check(self, building: Building) -> None:
        """Refuse what the building, with its changes, does not have."""

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """What is kept of each run of a building in a climate, by name; empty where no run is needed."""
        return {}

    def outputs(self, building: Building) -> tuple[str, ...]:
        """Outputs of the building that the reductions read."""
        return ()

    def basis(self, building: Building) -> tuple[object, ...]:
        """What the reductions depend on in a building: the same for all designs."""
        return self.outputs(building)

    def parts(self, values: Mapping[str, Array]) -> dict[str, Array]:
        """What the value is the sum of, by name; empty where not all of `PARTS` were kept."""
        return {part: values[part] for part in self.PARTS} if set(self.PARTS) <= set(values) else {}

    def value(self, values: Mapping[str, Array], facts: LayerFacts) -> Array:
        """The objective of each member, shape (members,), from what was kept and from its layers."""
        return np.asarray(next(iter(values.values())), dtype=np.float64)


class ZoneObjective(Objective):
    """Base of the objectives of some zones."""

    zones: tuple[str, ...] = Field(min_length=1, description="Zones; the value is the mean over them")

    def outputs(self, building: Building) -> tuple[str, ...]:
        """One output for each zone."""
        return self._temperatures()

    def _temperatures(self) -> tuple[str, ...]:
        return tuple(f"{zone}.operative_temperature" for zone in self.zones)

    def check(self, building: Building) -> None:
        """Refuse a zone that the building does not have."""
        for zone in self.zones:
            require_zone(building, zone)


def column_of_part(objective: str, part: str) -> str:
    """Column of a part of an objective, such as the latent heat of the cooling energy."""
    return f"{objective}, {part}"
