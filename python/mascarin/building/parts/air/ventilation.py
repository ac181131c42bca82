"""Mechanical ventilation: units that supply air to zones and extract it from others."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ScheduleName, ZoneName
from mascarin.building.base.number import problem
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.parts.air.flow_density import DENSITY, FlowDensity
from mascarin.building.parts.air.set_point import SetPoint
from mascarin.building.parts.envelope.measured_values import Driven

RECOVERY_SOURCE = "ASHRAE Handbook, HVAC Systems and Equipment 2020, ch. 26, eq. 2 (heat recovery)"

FlowUnit = Literal["m3/s", "m3/h", "L/s"]


class UnitFlow(Driven):
    """A flow of a ventilation unit into a zone or out of it.

    Examples
    --------
    >>> UnitFlow(flow=0.02)
    UnitFlow(flow=0.02 m3/s)
    >>> UnitFlow(column="exhaust", unit="m3/h", factor=0.5).course.name
    'exhaust [m3/h]'
    """

    NUMBER: ClassVar = "flow"
    KIND: ClassVar = "flow"

    flow: q.VolumeFlow | None = None
    unit: FlowUnit | None = Field(None, description="Unit of the column; none: m3/s")
    density: FlowDensity | None = Field(None, description=DENSITY)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )


ZoneFlow = Annotated[UnitFlow, Shorthand(number="flow")]


class VentilationUnit(Part):
    """Mechanical ventilation: air supplied to some zones and extracted from others.

    Supplied air has a given temperature, or that of the outdoor air raised by heat recovery. Recovery brings
    ``recovery C_min (T_x - T_o)`` from the extracted air, with its mean temperature ``T_x`` and the smaller
    of both flows.

    Examples
    --------
    >>> unit = VentilationUnit(supply={"living": 0.03}, exhaust={"bath": 0.03}, recovery=0.8)
    >>> float(unit.recovery)
    0.8
    """

    supply: dict[ZoneName, ZoneFlow] = Field(
        default_factory=dict, description="Flows into zones, by zone: a number [m3/s], or a column"
    )
    exhaust: dict[ZoneName, ZoneFlow] = Field(
        default_factory=dict, description="Flows out of zones, by zone: a number [m3/s], or a column"
    )
    temperature: Annotated[SetPoint, Shorthand(number="temperature")] | None = Field(
        None,
        description="Temperature of the supplied air: a number, {schedule: name} or {column: name}; none: "
        "that of the outdoor air, raised by recovery",
    )
    recovery: q.Recovery | None = None

    @model_validator(mode="after")
    def _sound(self) -> VentilationUnit:
        if not self.supply and not self.exhaust:
            raise problem(
                "a unit without flows",
                "supply or exhaust of at least one zone",
                "Add 'supply: {ZONE: 0.02}'.",
            )
        if self.temperature is not None and self.recovery is not None:
            raise problem(
                "temperature and recovery",
                "one of them: both give the temperature of the supplied air",
                "Keep the measured temperature, or the recovery.",
            )
        if (self.temperature is not None or self.recovery is not None) and not self.supply:
            key = "temperature" if self.temperature is not None else "recovery"
            raise problem(
                f"'{key}' in a unit that supplies no air", "none", f"Remove '{key}:', or add 'supply:'."
            )
        if self.recovery is not None and not self.exhaust:
            raise problem(
                "recovery in a unit that extracts no air",
                "exhaust of at least one zone, whose heat is recovered",
                "Add 'exhaust:', or give the temperature of the supplied air.",
            )
        return self
