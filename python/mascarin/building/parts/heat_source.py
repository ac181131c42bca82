"""Heat that is released between two layers of a surface: electric mats and pipes of water."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ControlName, ScheduleName, SurfaceName, ZoneName
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.parts.air.set_point import SetPoint
from mascarin.building.parts.envelope.measured_values import Driven

#: Specific heat of water, within 0.1 % from 20 to 60 degC [J/(kg K)].
_WATER = "Wagner and Pruss 2002, doi:10.1063/1.1461829"
#: Law of the water, and of thermostats with a throttling range.
SOURCE = "Strand and Pedersen 1997, ASHRAE Trans. 103(1), 949-958 (water in a wall, throttling range)"


class ElectricMat(Driven):
    """Power of an electric mat, whatever its temperature.

    Examples
    --------
    >>> ElectricMat(power=80)
    ElectricMat(power=80 W/m2)
    """

    NUMBER: ClassVar = "power"
    KIND: ClassVar = "heat_flux"

    power: q.MatPower | None = None
    unit: Literal["W/m2", "kW/m2"] | None = Field(None, description="Unit of the column; none: W/m2")
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the power; none: always 1"
    )


class WaterFlow(Driven):
    """Flow of water through all pipes of a surface.

    Examples
    --------
    >>> WaterFlow(column="m_floor", unit="kg/h").course.name
    'm_floor [kg/h]'
    """

    NUMBER: ClassVar = "flow"
    KIND: ClassVar = "water_flow"

    flow: q.WaterFlow | None = None
    unit: Literal["kg/s", "kg/h"] | None = Field(None, description="Unit of the column; none: kg/s")
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flow; none: always 1"
    )


class SupplyTemperature(SetPoint):
    """Temperature of the water that enters: a number, a schedule or a measured column.

    Examples
    --------
    >>> SupplyTemperature(temperature=35)
    SupplyTemperature(temperature=35 degC)
    """

    advice: ClassVar[Mapping[str, str]] = {
        "measured": "Write 'supply: {column: NAME}', or 'supply: {schedule: NAME}' with a schedule of kind "
        "temperature."
    }

    temperature: q.SupplyTemperature | None = None


class WaterPipes(Part):
    """Pipes of water in a plane: ``m c_p eps (T_supply - T_plane)``.

    ``eps`` is the effectiveness: given, or ``1 - exp(-U A/(m c_p))`` with the conductance ``U`` from the
    water to the plane.

    Examples
    --------
    >>> pipes = WaterPipes(flow=0.05, supply=35, conductance=12)
    >>> float(pipes.specific_heat)
    4180.0
    """

    flow: Annotated[WaterFlow, Shorthand(number="flow")] = Field(
        description="Flow through all pipes of the surface: a number [kg/s], or with a schedule or column"
    )
    supply: Annotated[SupplyTemperature, Shorthand(number="temperature")] = Field(
        description="Temperature of the water that enters: a number [degC], a schedule or a column"
    )
    conductance: q.WaterConductance | None = None
    effectiveness: q.Effectiveness | None = None
    specific_heat: q.WaterSpecificHeat = Number(4180.0, source=Remark(_WATER), assumed=True)

    @model_validator(mode="after")
    def _one_exchange(self) -> WaterPipes:
        if (self.conductance is None) == (self.effectiveness is None):
            raise problem(
                "both 'conductance' and 'effectiveness'"
                if self.conductance is not None
                else "neither 'conductance' nor 'effectiveness'",
                "one of them",
                "Give the conductance from the water to the plane [W/(m2 K)], or the effectiveness [-].",
            )
        return self


class Thermostat(Part):
    """A thermostat with a throttling range, by the air of a zone at the beginning of each step.

    At the set point power or flow is one half, half of the range below it (``heating``) or above it
    (``cooling``) all, and on the other side nothing.

    Examples
    --------
    >>> float(Thermostat(zone="room", setpoint=20, mode="heating").range)
    2.0
    """

    zone: ZoneName = Field(description="Name of the zone whose air temperature it measures")
    setpoint: Annotated[SetPoint, Shorthand(number="temperature")] = Field(
        description="Temperature at half of the power or flow: a number [degC], a schedule or a column"
    )
    range: q.ThrottlingRange = Number(
        2.0, source=Remark("not given: the default of EnergyPlus for radiant systems"), assumed=True
    )
    mode: Literal["heating", "cooling"] = Field(
        description="heating: more the colder the air is; cooling: more the warmer it is"
    )


class HeatSource(Part):
    """Heat in a plane between two layers of a surface: floor heating, a cooled ceiling, a heating foil.

    Examples
    --------
    >>> mat = HeatSource(surface="floor", after="insulation", electric=80)
    >>> float(mat.electric.power)
    80.0
    """

    advice: ClassVar[Mapping[str, str]] = {
        "layer": "Write 'after: LAYER': the plane is the inner side of this layer.",
        "power": "Write 'electric: 80' for a mat of 80 W/m2.",
        "flow": "Write 'water: {flow: 0.05, supply: 35, conductance: 12}'.",
    }

    surface: SurfaceName = Field(description="Name of a surface")
    after: str = Field(description="Name of the layer whose inner side the plane is; another one lies behind")
    electric: Annotated[ElectricMat, Shorthand(number="power")] | None = Field(
        None,
        description="Electric power: a number [W/m2], or a part with a schedule or column; or `water`",
    )
    water: WaterPipes | None = Field(None, description="Water in pipes; or `electric`")
    thermostat: Thermostat | None = Field(
        None, description="What turns it down by the air of a zone; none: all of its power or flow"
    )
    control: ControlName | None = Field(
        None,
        description="Name of the control that turns it on where it lets openings open; none: not controlled",
    )

    @model_validator(mode="after")
    def _one_means(self) -> HeatSource:
        if (self.electric is None) == (self.water is None):
            raise problem(
                "both 'electric' and 'water'" if self.water else "neither 'electric' nor 'water'",
                "one of them",
                "Write 'electric: 80' [W/m2], or 'water: {flow: 0.05, supply: 35, conductance: 12}'.",
            )
        return self

    @property
    def driven(self) -> tuple[str, Driven]:
        """Its power or flow, and the path of it."""
        if self.electric is not None:
            return "electric", self.electric
        return "water.flow", self._pipes.flow

    @property
    def _pipes(self) -> WaterPipes:
        """The pipes of a source without an electric mat."""
        if self.water is None:
            raise ValueError("a heat source has an electric mat or pipes of water")
        return self.water

    @property
    def temperatures(self) -> dict[str, SetPoint]:
        """Temperatures that may follow schedules or columns, by their paths."""
        by_path: dict[str, SetPoint] = {}
        if self.water is not None:
            by_path["water.supply"] = self.water.supply
        if self.thermostat is not None:
            by_path["thermostat.setpoint"] = self.thermostat.setpoint
        return by_path
