"""Laws of melting with a state of their own, below ``hysteresis:``: their numbers, and what is said of them.

A law is a class here, a file of its name in ``crates/engine/src/physics/pcm/history``, and its
lines in the ``mod.rs`` beside it; the guide is ``docs/engine.md``.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.number import problem
from mascarin.building.base.part import Part
from mascarin.building.parts.materials.phase_change import Hysteresis


class OneCurveLaw(Part):
    """A law with a state whose only curve is that of the material: its numbers go to the engine by name."""

    #: What the report says of the path beside the curve.
    path: ClassVar[str]
    #: Schemes of time stepping that cannot follow it.
    excluded_schemes: ClassVar[tuple[str, ...]] = ()
    model: str

    def said(self, melting: float) -> str:
        """What ``check`` says of the law in a material with a melting temperature [degC]."""
        raise TypeError("each law describes itself")

    def coldest_liquid(self, melting: float) -> float:
        """Lowest temperature at which a material with a melting temperature may be wholly liquid [degC]."""
        return melting


class Supercooling(OneCurveLaw):
    """Supercooling: liquid below its melting temperature, then crystals that grow at a finite rate.

    What has melted wholly stays liquid until ``degree`` below the melting temperature. Then it crystallises,
    ``d xi/dt = -K (xi - f(T))`` with the liquid fraction xi and the melting curve f. ``K`` is
    ``1/time_constant``, or ``rate`` times the undercooling below the end of the melting range. The heat set
    free warms it back into its melting range (recalescence). It melts by the curve, without delay.

    References
    ----------
    Guenther et al. 2007, Modelling Simul. Mater. Sci. Eng. 15(8), doi:10.1088/0965-0393/15/8/005
    Davin et al. 2020, Int. J. Therm. Sci. 147, 106121, doi:10.1016/j.ijthermalsci.2019.106121

    Examples
    --------
    >>> Supercooling(degree=8, time_constant=600)
    Supercooling(model=supercooling, degree=8 K, time_constant=600 s)
    >>> Supercooling(degree=8, rate=0.0002)
    Supercooling(model=supercooling, degree=8 K, rate=0.0002 1/(s K))
    """

    path: ClassVar[str] = "it stays liquid below its melting range until it nucleates, and then crystallises"
    excluded_schemes: ClassVar[tuple[str, ...]] = ("apparent-capacity",)
    model: Literal["supercooling"] = Field("supercooling", description="The law, by its name")
    degree: q.SupercoolingDegree
    time_constant: q.CrystallisationTime | None = None
    rate: q.CrystallisationRate | None = None

    @model_validator(mode="after")
    def _one_kinetics(self) -> Supercooling:
        stated = [name for name in ("time_constant", "rate") if getattr(self, name) is not None]
        if len(stated) != 1:
            raise problem(
                " and ".join(stated) or "neither time_constant nor rate",
                "one of both: how fast it crystallises",
                "Write time_constant [s], or rate [1/(s K)] by the undercooling.",
            )
        return self

    def said(self, melting: float) -> str:
        """What ``check`` says of the law in a material with a melting temperature [degC]."""
        if self.rate is None:
            speed = f"with a time constant of {self.time_constant:g} s"
        else:
            speed = f"by {self.rate:g} of what is liquid per second and kelvin of undercooling"
        liquid = self.coldest_liquid(melting)
        return f"supercooling, wholly molten it stays liquid down to {liquid:.2f} degC, crystallises {speed}"

    def coldest_liquid(self, melting: float) -> float:
        """Temperature at which a material with a melting temperature nucleates [degC]."""
        return melting - float(self.degree)


def _kind(raw: Any) -> str:
    model = raw.get("model") if isinstance(raw, dict) else getattr(raw, "model", None)
    return model if isinstance(model, str) and model in _ONE_CURVE else "hysteresis"


HistoryLaw = Annotated[
    Annotated[Hysteresis, Tag("hysteresis")]
    # Laws with one curve: each has its name as the tag.
    | Annotated[Supercooling, Tag("supercooling")],
    Discriminator(_kind),
]
_ONE_CURVE: Final = frozenset(str(law.model_fields["model"].default) for law in OneCurveLaw.__subclasses__())
