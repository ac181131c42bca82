"""Thermal bridges: heat through joints and fixings, beside that through plane walls."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.dimensions import System
from mascarin.building.base.names import Name, ZoneName
from mascarin.building.base.number import Number, Remark, problem, quantity_of
from mascarin.building.base.part import Part
from mascarin.building.base.time_series import Columns
from mascarin.building.parts.envelope.surface import Ground

_ENDS = ("outdoors", "zone", "ground", "measured")


class ThermalBridge(Part):
    """A thermal bridge from the air of a zone to outdoors, another zone, ground or a measured temperature.

    A linear bridge has ``psi`` and ``length``, a point bridge ``chi`` and ``number``.

    Examples
    --------
    >>> corner = ThermalBridge(psi=0.05, length=12)
    >>> float(corner.psi * corner.length), corner.faces
    (0.6000000000000001, 'outdoors')
    """

    advice: ClassVar[Mapping[str, str]] = {
        "to": "Write 'zone: NAME', 'ground: {temperature: 10}' or 'measured: COLUMN'; none: outdoors.",
        "u_value": "A bridge has 'psi' [W/(m K)] and 'length', or 'chi' [W/K] and 'number'.",
    }

    psi: q.LinearTransmittance | None = None
    length: q.BridgeLength | None = None
    chi: q.PointTransmittance | None = None
    number: q.BridgeNumber | None = None
    outdoors: Literal[True] | None = Field(None, description="Ends outdoors: true, or nothing at all")
    zone: ZoneName | None = Field(None, description="Ends in this zone")
    ground: Ground | None = Field(None, description="Ends in ground of this temperature")
    measured: Columns | None = Field(
        None, description="Ends in air of this measured column, or of the mean of several"
    )

    dimensions: System | Literal["any"] | None = Field(
        None,
        description="Dimensions that psi or chi belongs to: internal, overall_internal or external; any: the "
        "same in all, as the edge of a glass; none: those of the building",
    )
    excess: dict[Name, q.AreaExcess] = Field(
        default_factory=dict,
        description="Surface -> its area as described less its area in the dimensions of psi or chi, at this "
        "bridge; it is converted by psi - sum U dA / l. [m2]",
    )
    converted: q.ConvertedTransmittance | None = None

    @model_validator(mode="after")
    def _sound(self) -> ThermalBridge:
        if (self.psi is None) == (self.chi is None):
            raise problem(
                "psi and chi" if self.psi is not None else "neither psi nor chi",
                "psi [W/(m K)] with length, or chi [W/K] with number",
                "Describe linear and point bridges by parts of their own.",
            )
        if self.psi is not None and self.length is None:
            raise problem(
                "psi without length",
                "the length of the joint [m]",
                "Add 'length:', or give the whole conductance as 'chi:' [W/K].",
            )
        stray = "number" if self.psi is not None else "length"
        size = getattr(self, stray)
        if size is not None and not size.derived:
            coefficient = "psi" if self.psi is not None else "chi"
            raise problem(f"'{stray}' beside {coefficient}", "none", f"Remove '{stray}:'.")
        if self.number is None and (self.chi is not None or self.excess):
            quantity = quantity_of(type(self).model_fields["number"])
            self._fill(number=Number(1.0, source=Remark("not given: one"), derived=True, quantity=quantity))
        ends = [key for key in _ENDS if getattr(self, key) is not None]
        if len(ends) > 1:
            raise problem(
                " and ".join(ends), f"at most one of {', '.join(_ENDS)}", "A bridge has one other end."
            )
        return self

    @property
    def faces(self) -> str:
        """Which kind of surroundings the other end has."""
        return next((key for key in _ENDS if getattr(self, key) is not None), "outdoors")

    @property
    def measured_columns(self) -> tuple[str, ...]:
        """Measured columns of the temperature at the other end."""
        if self.measured is None:
            return ()
        return (self.measured,) if isinstance(self.measured, str) else self.measured

    @property
    def conductance(self) -> float:
        """Heat per degree, converted to the dimensions of the areas. [W/K]"""
        return self.stated_conductance + float(self.converted or 0.0) * float(self.number or 0.0)

    @property
    def stated_conductance(self) -> float:
        """Heat per degree in the dimensions of psi or chi. [W/K]"""
        if self.psi is not None:
            return float(self.psi) * float(self.length or 0.0)
        return float(self.chi or 0.0) * float(self.number or 0.0)
