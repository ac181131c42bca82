"""Blinds and shutters of windows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ScheduleName
from mascarin.building.base.number import Number, Remark, problem, quantity_of
from mascarin.building.base.part import Part

NET_RADIATION = "EN 13363-2:2005 (radiation between a blind and the glass)"
SHUTTER = "EN ISO 10077-1:2017, annex (additional resistance of closed shutters by the classes of EN 13125)"

VENTILATED = "0.4 to 0.55 by ISO 15099 for air at 0.2 to 0.3 m/s in a gap of 50 mm, 0.7 by EN 13363-1:2003"
#: See `VENTILATED`, and the range that it leaves. [-]
_TO_AIR: Final = 0.5
_TO_AIR_RANGE: Final = (0.3, 0.7)

#: Additional resistance ``a + b R`` of a closed shutter of the resistance R, by its air permeability: a
#: [m2 K/W] and b [-].
_BY_PERMEABILITY: Final = {
    "very_high": (0.08, 0.0),
    "high": (0.09, 0.25),
    "average": (0.11, 0.55),
    "low": (0.14, 0.80),
    "tight": (0.17, 0.95),
}


class Blind(Part):
    """A blind or shutter on the outer or the inner side of a window.

    What it transmits and reflects is diffuse. Slats are described by their values at the angle in use. The
    resistance is that of the blind and of the air between it and the glass, long-wave radiation included:
    given, or found from that of the shutter alone and its air permeability by EN ISO 10077-1.

    Examples
    --------
    >>> shutter = Blind(
    ...     position="outside", transmittance=0, reflectance=0.6, resistance=0.17, schedule="nights"
    ... )
    >>> float(shutter.cover)
    1.0
    >>> roller = Blind(
    ...     position="outside",
    ...     transmittance=0,
    ...     reflectance=0.6,
    ...     shutter_resistance=0.1,
    ...     air_permeability="average",
    ... )
    >>> round(float(roller.resistance), 3)
    0.165
    """

    advice: ClassVar[Mapping[str, str]] = {
        "slats": "Give 'transmittance' and 'reflectance' of the slats at the angle in use.",
        "absorptance": "What is neither transmitted nor reflected is absorbed: leave it out.",
        "column": "Write 'schedule: NAME' and a schedule '{kind: fraction, column: NAME}'.",
        "closed": "Write 'schedule: NAME', a fraction that is 1 where the blind is closed.",
    }

    position: Literal["outside", "inside"] = Field(
        description="Side of the window: outside, or inside in the room; blinds between panes are not "
        "simulated"
    )
    transmittance: q.BlindTransmittance
    reflectance: q.BlindReflectance
    resistance: q.BlindResistance | None = None
    shutter_resistance: q.ShutterResistance | None = None
    air_permeability: Literal["very_high", "high", "average", "low", "tight"] | None = Field(
        None,
        description="Class of the closed shutter by the gaps at its edges: very_high above 35 mm, high above "
        "15 mm, average above 8 mm, low, or tight up to 3 mm; with 'shutter_resistance' in place of "
        "'resistance'",
    )
    emissivity: q.Emissivity = Number(0.9, source="EN 13363-2:2005: not metallic", assumed=True)
    cover: q.BlindCover = Number(1.0, source=Remark("not given: all of the glass"), assumed=True)
    to_air: q.BlindToAir | None = None
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction that is closed; none: always closed"
    )
    radiation: q.BlindRadiation | None = None

    @model_validator(mode="after")
    def _sound(self) -> Blind:
        both = float(self.transmittance) + float(self.reflectance)
        if both > 1.0:
            raise problem(
                f"a transmittance of {self.transmittance:g} and a reflectance of {self.reflectance:g}",
                "a sum of at most 1: the rest is absorbed",
                "Correct one of them.",
            )
        return self

    @model_validator(mode="after")
    def _carrying(self) -> Blind:
        if self.position == "outside":
            if self.to_air is not None:
                raise problem(
                    "'to_air' of a blind outside, behind which the air is that of outdoors",
                    "'to_air' of a blind in the room only",
                    "Leave it out, or write 'position: inside'.",
                )
            return self
        if self.to_air is None:
            quantity = quantity_of(type(self).model_fields["to_air"])
            number = Number(_TO_AIR, range=_TO_AIR_RANGE, source=VENTILATED, assumed=True, quantity=quantity)
            self._fill(to_air=number)
        return self

    @model_validator(mode="after")
    def _resisting(self) -> Blind:
        # A value that is given counts: varied in a sweep, or calibrated.
        if self.resistance is not None:
            return self
        if self.shutter_resistance is None or self.air_permeability is None:
            raise problem(
                "no 'resistance'",
                "'resistance' of the closed blind with the air behind it [m2 K/W], or 'shutter_resistance' "
                "and 'air_permeability'",
                "Add 'resistance:' of the data sheet; EN ISO 10077-1 has 0.08 to 0.25 m2 K/W.",
            )
        constant, slope = _BY_PERMEABILITY[self.air_permeability]
        value = constant + slope * float(self.shutter_resistance)
        quantity = quantity_of(type(self).model_fields["resistance"])
        self._fill(resistance=Number(value, source=SHUTTER, derived=True, quantity=quantity))
        return self

    @property
    def words(self) -> str:
        """Where it is, what closes it and what the closed blind does with the sun."""
        closed = f"as schedule {self.schedule}" if self.schedule else "always"
        if self.radiation is not None:
            limit = f"above {self.radiation:g} W/m2 on the window"
            closed = f"{closed} {limit}" if self.schedule else limit
        return (
            f"{self.position}, closed {closed}, transmits {100 * self.transmittance:g} % and reflects "
            f"{100 * self.reflectance:g} % of the sun"
        )
