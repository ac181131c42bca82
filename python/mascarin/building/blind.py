"""Blinds and shutters of windows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.names import ScheduleName
from mascarin.building.number import Number, Remark, problem
from mascarin.building.part import Part

NET_RADIATION = "EN 13363-2:2005 (radiation between a blind and the glass)"
SHUTTER = "EN ISO 10077-1:2017, 7.2 (additional resistance of closed shutters)"


class Blind(Part):
    """A blind or shutter on the outer or the inner side of a window.

    What it transmits and reflects is diffuse. Slats are described by their values at the angle in use. The
    resistance is that of the blind and of the air between it and the glass, long-wave radiation included.

    Examples
    --------
    >>> shutter = Blind(
    ...     position="outside", transmittance=0, reflectance=0.6, resistance=0.17, schedule="nights"
    ... )
    >>> float(shutter.cover)
    1.0
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
    resistance: q.BlindResistance
    emissivity: q.Emissivity = Number(0.9, source="EN 13363-2:2005: not metallic", assumed=True)
    cover: q.BlindCover = Number(1.0, source=Remark("not given: all of the glass"), assumed=True)
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
