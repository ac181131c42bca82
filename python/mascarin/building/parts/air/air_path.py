"""Air between zones, and openings to outdoors: flows, doors and controlled openings."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ControlName, ScheduleName, ZoneName
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part
from mascarin.building.parts.air.flow_density import DENSITY, FlowDensity
from mascarin.building.parts.envelope.measured_values import Driven

BROWN_SOLVASON = "Brown & Solvason 1962, doi:10.1016/0017-9310(62)90184-9 (two-way flow through a door)"
ASHRAE_OPENING = (
    "ASHRAE Handbook of Fundamentals 2017, ch. 16, eqs. 37, 38 (flow through openings by wind and buoyancy)"
)


class Door(Part):
    """A door or another large opening through which a temperature difference drives air both ways.

    ``C_d W H/3 sqrt(g H |dT|/T)`` flows in each direction.

    Examples
    --------
    >>> Door(width=0.9, height=2)
    Door(width=0.9 m, height=2 m, discharge=0.65, open=1)
    """

    width: q.DoorWidth
    height: q.DoorHeight
    discharge: q.Discharge = Number(0.65, source=BROWN_SOLVASON, assumed=True)
    open: q.OpenFraction = Number(1.0, source=Remark("not given: fully open"))


class AirPath(Driven):
    """Air between two zones: the same flow both ways, a flow from one to the other, or through a door.

    Examples
    --------
    >>> AirPath(between=("office", "corridor"), flow=0.02)
    AirPath(between=[office, corridor], flow=0.02 m3/s, one_way=False)
    >>> AirPath(between=("office", "corridor"), flow=0.02, one_way=True).one_way
    True
    >>> AirPath(between=("office", "corridor"), door={"width": 0.9, "height": 2}).flow is None
    True
    """

    NUMBER: ClassVar = "flow"
    KIND: ClassVar = "flow"

    between: tuple[ZoneName, ZoneName] = Field(description="Names of the two zones")
    flow: q.VolumeFlow | None = None
    unit: Literal["m3/s", "m3/h", "L/s"] | None = Field(None, description="Unit of the column; none: m3/s")
    one_way: bool = Field(
        False, description="Whether air flows from the first zone to the second, driven by fans"
    )
    door: Door | None = Field(None, description="Flow by temperature difference; none: a given flow")
    density: FlowDensity | None = Field(None, description=DENSITY)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )
    control: ControlName | None = Field(
        None, description="Name of the control that lets it flow; none: not controlled"
    )

    def _needs_none(self) -> bool:
        return self.door is not None

    @model_validator(mode="after")
    def _two(self) -> AirPath:
        if self.between[0] == self.between[1]:
            raise problem(f"'{self.between[0]}' twice", "two different zones", "Name the other zone.")
        stated = "flow" if self.flow is not None else "column" if self.column is not None else ""
        stated = stated or ("one_way" if self.one_way else "density" if self.density is not None else "")
        if self.door is not None and stated:
            raise problem(
                f"door and {stated}",
                "one of them: the flow through a door follows from temperatures",
                "Describe the other flow as an air path of its own.",
            )
        if self.one_way and self.control is not None:
            raise problem(
                "one_way and control",
                "a flow in both directions, or one that is not controlled",
                "A flow that stops leaves its zones without balance: remove 'one_way', or use a schedule.",
            )
        return self


class Opening(Part):
    """An opening to outdoors, with a flow of air by wind and buoyancy.

    Examples
    --------
    >>> Opening(zone="attic", area=0.02, height=0.3)
    Opening(zone=attic, area=0.02 m2, height=0.3 m, discharge=0.65, wind_coefficient=0.3)
    """

    zone: ZoneName = Field(description="Name of the zone")
    area: q.OpeningArea
    height: q.OpeningHeight
    discharge: q.Discharge = Number(0.65, source=ASHRAE_OPENING, assumed=True)
    wind_coefficient: q.WindCoefficient = Number(0.3, source=ASHRAE_OPENING, assumed=True)
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the area that is open; none: always 1"
    )
    control: ControlName | None = Field(
        None, description="Name of the control that opens and closes it; none: not controlled"
    )
