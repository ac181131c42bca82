"""What makes a design good: each objective says which run it needs, what is kept of it, and its value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, ClassVar, Final, Literal

import numpy as np
from pydantic import Field, model_validator

from mascarin.building.base.part import Shorthand, fault, insist
from mascarin.comfort import ComfortSettings
from mascarin.design.evaluation.checks import require_layer
from mascarin.design.evaluation.cooling import CoolingEnergy, PeakCooling
from mascarin.design.evaluation.objective import Objective, ZoneObjective
from mascarin.design.evaluation.reductions import Assessed, Beyond, CycleDays, Highest, Melted
from mascarin.ensemble import Statistic
from mascarin.errors import InputError
from mascarin.measurements.time_fields import Hours

if TYPE_CHECKING:
    from typing import Self

    from mascarin.building import Building
    from mascarin.comfort import SeatView
    from mascarin.design.evaluation.layers import LayerFacts
    from mascarin.design.evaluation.objective import Array, Reductions
    from mascarin.weather import Climate

#: Higher indoor limits of EN 16798-1:2019, table B.4, by the air speed that occupants control. [m/s] -> [K]
AIR_SPEED: Final[dict[float, float]] = {0.0: 0.0, 0.6: 1.2, 0.9: 1.8, 1.2: 2.2}


class _Limited(ZoneObjective):
    above: float | None = Field(None, description="Operative temperature above which it is too hot [degC]")
    below: float | None = Field(None, description="Operative temperature below which it is too cold [degC]")
    hours: Hours | None = Field(
        None,
        description='First and last hour of the day that counts, such as ["22:00", "06:00"]; all if none',
    )
    air_speed: float = Field(
        0.0,
        description="Air speed of fans that occupants control: 0, 0.6, 0.9 or 1.2 m/s; raises `above` "
        "by 0, 1.2, 1.8 or 2.2 K (EN 16798-1:2019, table B.4) [m/s]",
    )

    @model_validator(mode="after")
    def _one_limit(self) -> Self:
        if (self.above is None) == (self.below is None):
            actual = "no limit" if self.above is None else "above and below"
            insist(fault((), actual, "one of above, below [degC]", "Write an objective for each."))
        if self.air_speed not in AIR_SPEED:
            insist(
                fault(
                    ("air_speed",),
                    f"{self.air_speed:g} m/s",
                    "0, 0.6, 0.9 or 1.2 m/s: the standard has no other value, and none between them",
                    "Choose one of them.",
                )
            )
        limit = self.above if self.above is not None else self.below
        if self.above is not None and self.air_speed and self.above < 25.0:
            insist(
                fault(
                    ("air_speed",),
                    f"above: {self.above:g} degC",
                    "a limit above 25 degC: only there does the standard count the air speed",
                    "Remove air_speed, or raise the limit.",
                )
            )
        if limit is not None and not 0.0 <= limit <= 60.0:
            insist(fault((), f"a limit of {limit:g} degC", "0 to 60 degC", "Give it in degC."))
        return self

    @property
    def limit(self) -> float:
        """The limit with the effect of the air speed. [degC]"""
        if self.above is not None:
            return self.above + AIR_SPEED[self.air_speed]
        return float(self.below or 0.0)

    @property
    def words(self) -> str:
        """The limit in words."""
        side = "above" if self.above is not None else "below"
        when = "" if self.hours is None else f", {self.hours[0]} to {self.hours[1]}"
        fans = f" ({self.above:g} and {AIR_SPEED[self.air_speed]:g} K for fans)" if self.air_speed else ""
        return (
            f"operative temperature {side} {self.limit:g} degC{fans}{when}, mean of {', '.join(self.zones)}"
        )

    def _beyond(self, *, weighted: bool) -> Reductions:
        return {
            "beyond": Beyond(
                self._temperatures(), self.limit, self.above is not None, span_of(self.hours), weighted
            )
        }


class DegreeHours(_Limited):
    """Degree-hours of discomfort: how long and by how much a limit is exceeded."""

    kind: Literal["degree_hours"] = "degree_hours"

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "K h"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """Degree-hours."""
        return self._beyond(weighted=True)


class DiscomfortHours(_Limited):
    """Hours of discomfort: how long a limit is exceeded."""

    kind: Literal["hours"] = "hours"

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "h"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """Hours."""
        return self._beyond(weighted=False)


class Comfort(ZoneObjective):
    """Degree-hours outside of the limits of a comfort index."""

    kind: Literal["comfort"] = "comfort"
    comfort: ComfortSettings = Field(description="Index with its limits, as in `comfort:` of a study")
    side: Literal["both", "hot", "cold"] = Field("both", description="Which discomfort counts")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return self.comfort.index_used.excess_unit

    @property
    def words(self) -> str:
        """What it is."""
        return (
            f"{self.comfort.index_used.title}, limits {self.comfort.limits}, mean of {', '.join(self.zones)}"
        )

    def check(self, building: Building) -> None:
        """Refuse a simulated humidity of a building without one, and a seat that is not in each zone."""
        super().check(building)
        self._views(building)
        if self.comfort.humidity == "simulated" and building.humidity is None:
            raise InputError(
                "found humidity: simulated, and a building without humidity; expected the section "
                "'humidity:' in the building. Add it, or give a relative humidity in percent, such as 70, or "
                "'outdoor'"
            )

    def outputs(self, building: Building) -> tuple[str, ...]:
        """Temperatures of the air and of the surfaces, and the humidity where it is simulated."""
        humid = ("relative_humidity",) if self.comfort.humidity == "simulated" else ()
        outputs: list[str] = []
        for zone, view in zip(self.zones, self._views(building), strict=True):
            radiant = (f"{zone}.mean_radiant_temperature",) if view is None else view.outputs
            outputs += [f"{zone}.air_temperature", *radiant, *(f"{zone}.{kind}" for kind in humid)]
        return tuple(dict.fromkeys(outputs))

    def _views(self, building: Building) -> tuple[SeatView | None, ...]:
        """What is seen from the seat, in each zone."""
        return tuple(self.comfort.view(building, zone) for zone in self.zones)

    def basis(self, building: Building) -> tuple[object, ...]:
        """The outputs, and what is seen from the seat."""
        return (*super().basis(building), *self._views(building))

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """Degree-hours, and hours in which the index has no value."""
        return {
            key: Assessed(self.zones, key, self.side, self.comfort, climate, self._views(building))
            for key in ("degrees", "undefined")
        }


class PeakTemperature(ZoneObjective):
    """Highest operative temperature of some zones."""

    kind: Literal["peak_temperature"] = "peak_temperature"
    hours: Hours | None = Field(None, description="First and last hour of the day that counts")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "degC"

    @property
    def words(self) -> str:
        """What it is."""
        return f"highest operative temperature of {', '.join(self.zones)}"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """The highest value."""
        return {"peak": Highest(self._temperatures(), span_of(self.hours))}


class _LayerObjective(Objective):
    layer: str = Field(description="Phase-change layer: SURFACE.LAYER, such as ceiling.pcm")
    least: ClassVar[bool] = False

    def outputs(self, building: Building) -> tuple[str, ...]:
        """The liquid fraction."""
        return (self._fraction,)

    @property
    def _fraction(self) -> str:
        return f"{self.layer}_liquid_fraction"

    def check(self, building: Building) -> None:
        """Refuse a layer that is not there or does not melt."""
        require_layer(building, self.layer, melts=True)


class LatentUse(_LayerObjective):
    """Latent heat that a layer takes up in a day, as the mean over the days."""

    kind: Literal["latent_use"] = "latent_use"

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "Wh/(m2 d)"

    @property
    def words(self) -> str:
        """What it is."""
        return f"latent heat taken up in a day by {self.layer}"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """The fraction that melts in a day."""
        return {"melted": Melted(self._fraction)}

    def value(self, values: Mapping[str, Array], facts: LayerFacts) -> Array:
        """Latent heat of a square metre times the fraction that melts."""
        return np.asarray(values["melted"] * facts.latent(self.layer) / 3600.0, dtype=np.float64)


class Cycles(_LayerObjective):
    """Days on which a layer really cycles: its liquid fraction changes by at least so much."""

    kind: Literal["cycle_days"] = "cycle_days"
    change: float = Field(0.5, gt=0.0, le=1.0, description="Least change of the liquid fraction in a day [-]")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "d"

    @property
    def words(self) -> str:
        """What it is."""
        return f"days on which the liquid fraction of {self.layer} changes by {self.change:g} or more"

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """The days."""
        return {"days": CycleDays(self._fraction, self.change)}


class Mass(Objective):
    """Mass of some layers."""

    kind: Literal["mass"] = "mass"
    layers: tuple[str, ...] = Field(min_length=1, description="SURFACE.LAYER of each")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "kg"

    @property
    def words(self) -> str:
        """What it is."""
        return f"mass of {', '.join(self.layers)}"

    def check(self, building: Building) -> None:
        """Refuse a layer that is not there or has no mass."""
        for layer in self.layers:
            require_layer(building, layer, melts=False)

    def value(self, values: Mapping[str, Array], facts: LayerFacts) -> Array:
        """Density times thickness times area."""
        return np.asarray(np.sum([facts.mass(layer) for layer in self.layers], axis=0), dtype=np.float64)


class Cost(Objective):
    """Cost, of prices that you give."""

    kind: Literal["cost"] = "cost"
    currency: str = Field("EUR", description="Currency of all prices")
    per_kg: dict[str, float] = Field(default_factory=dict, description="SURFACE.LAYER -> price of a kilogram")
    products: dict[str, float] = Field(
        default_factory=dict, description="Product -> price of a kilogram, instead of that of the layer"
    )
    choices: dict[str, dict[str, float]] = Field(
        default_factory=dict, description="Variable -> variant or value as text -> price"
    )
    fixed: float = Field(0.0, description="What every design costs")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return self.currency

    @property
    def words(self) -> str:
        """What it is."""
        return "cost of the prices that were given"

    def check(self, building: Building) -> None:
        """Refuse a layer that is not there or has no mass."""
        for layer in self.per_kg:
            require_layer(building, layer, melts=False)

    def value(self, values: Mapping[str, Array], facts: LayerFacts) -> Array:
        """Prices of the layers and of the choices."""
        total = np.full(facts.count, self.fixed)
        for layer, price in self.per_kg.items():
            prices = [self.products.get(product or "", price) for product in facts.products(layer)]
            total = total + facts.mass(layer) * np.asarray(prices)
        for variable, prices_of in self.choices.items():
            total = total + np.array([prices_of.get(label, 0.0) for label in facts.chosen(variable)])
        return np.asarray(total, dtype=np.float64)


class Plain(Objective):
    """A statistic of one output, as in ``mascarin sweep``: ``max:room.air_temperature``; small is good."""

    kind: Literal["statistic"] = "statistic"
    statistic: str = Field(description="min:, mean:, max:, sd:, above:LIMIT: or below:LIMIT: and an output")

    @property
    def unit(self) -> str:
        """Unit of the value."""
        return "h" if self._read().kind in ("above", "below") else "unit of the output"

    @property
    def words(self) -> str:
        """What it is."""
        return self.statistic

    def _read(self) -> Statistic:
        return Statistic.read(self.statistic)

    def check(self, building: Building) -> None:
        """Refuse an output that the building does not have."""
        building.output(self._read().output)

    def outputs(self, building: Building) -> tuple[str, ...]:
        """The output."""
        return (self._read().output,)

    def reductions(self, climate: Climate, building: Building) -> Reductions:
        """The statistic."""
        return {"statistic": self._read()}


AnyObjective = Annotated[
    Annotated[
        DegreeHours
        | DiscomfortHours
        | Comfort
        | PeakTemperature
        | CoolingEnergy
        | PeakCooling
        | LatentUse
        | Cycles
        | Mass
        | Cost
        | Plain,
        Field(discriminator="kind"),
    ],
    Shorthand(word="statistic", kind="statistic"),
]


def span_of(hours: Hours | None) -> tuple[float, float] | None:
    """Hours of the day as numbers. [h]"""
    if hours is None:
        return None
    first, last = ((int(a) + int(b) / 60.0) for a, b in (clock.split(":") for clock in hours))
    return first, last
