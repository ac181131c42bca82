"""How a phase-change material melts and freezes: laws of the liquid fraction, measured curves, hysteresis."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand, fault, insist
from mascarin.building.parts.materials.closed_law import ClosedLaw
from mascarin.building.parts.materials.formula_curve import FormulaCurve
from mascarin.building.parts.materials.interpolation import as_many, monotone, rising
from mascarin.physics import MeltingCurve

Floats = npt.NDArray[np.float64]


class TanhLaw(ClosedLaw):
    """Liquid fraction ``(1 + tanh((T - Tm)/w))/2``.

    Either the half-width ``w`` is given, or ``gamma`` and ``delta_t`` of Guichard et al. 2016,
    ``w = 4 delta_t/gamma``.

    Examples
    --------
    >>> law = TanhLaw(gamma=0.04, delta_t=0.01)
    >>> law.half_width, float(law.fraction(0.0))
    (1.0, 0.5)
    """

    tails: ClassVar[bool] = True
    _KIND: ClassVar[str] = "tanh_width"
    kind: Literal["tanh"] = "tanh"
    width: q.MeltingWidth | None = None
    gamma: q.Gamma | None = None
    delta_t: q.DeltaT | None = None

    @model_validator(mode="after")
    def _one_form(self) -> TanhLaw:
        stated = [name for name in ("width", "gamma", "delta_t") if getattr(self, name) is not None]
        if stated not in (["width"], ["gamma", "delta_t"]):
            raise problem(
                ", ".join(stated) or "neither",
                "either width or both gamma and delta_t",
                "width = 4 delta_t/gamma; give one form.",
            )
        return self

    @property
    def half_width(self) -> float:
        """Half-width w [K]."""
        if self.gamma is None or self.delta_t is None:
            return float(self.width or 0.0)
        return 4.0 * self.delta_t / self.gamma


class SmoothStepLaw(ClosedLaw):
    """A polynomial between ``Tm - w`` and ``Tm + w``, with one or two continuous derivatives.

    Examples
    --------
    >>> SmoothStepLaw(width=1, continuity=2)
    SmoothStepLaw(width=1 K, continuity=2)
    """

    _KIND: ClassVar[str] = "smooth_step"
    kind: Literal["smooth_step"] = "smooth_step"
    width: q.EndToMiddle
    continuity: q.Continuity = Number(1.0, source=Remark("the enthalpy has a continuous derivative"))

    @property
    def half_width(self) -> float:
        """Half-width w [K]."""
        return float(self.width)

    def _shape(self) -> dict[str, Any]:
        return {"continuity": int(self.continuity)}


class GaussianLaw(ClosedLaw):
    """The latent capacity is a normal distribution about Tm with the standard deviation ``width``.

    Examples
    --------
    >>> GaussianLaw(width=0.8)
    GaussianLaw(width=0.8 K)
    """

    tails: ClassVar[bool] = True
    _KIND: ClassVar[str] = "gaussian"
    kind: Literal["gaussian"] = "gaussian"
    width: q.Deviation

    @property
    def half_width(self) -> float:
        """Standard deviation [K]."""
        return float(self.width)


class GumbelLaw(ClosedLaw):
    """A skewed law: the latent capacity has its peak at Tm and a long tail on one side.

    With the tail towards low temperatures the fraction is ``1 - exp(-exp((T - Tm)/w))``.

    Examples
    --------
    >>> GumbelLaw(width=0.8, tail="high")
    GumbelLaw(width=0.8 K, tail=high)
    """

    tails: ClassVar[bool] = True
    _KIND: ClassVar[str] = "gumbel"
    kind: Literal["gumbel"] = "gumbel"
    width: q.GumbelScale
    tail: Literal["low", "high"] = Field(
        "low", description="Side of the long tail: low (melting starts slowly) or high temperatures"
    )

    @property
    def half_width(self) -> float:
        """Scale of the distribution [K]."""
        return float(self.width)

    def _shape(self) -> dict[str, Any]:
        return {"tail": self.tail}


class LinearLaw(ClosedLaw):
    """The liquid fraction is linear from 0 at ``Tm - w`` to 1 at ``Tm + w``.

    Examples
    --------
    >>> LinearLaw(width=1)
    LinearLaw(width=1 K)
    """

    _KIND: ClassVar[str] = "linear"
    kind: Literal["linear"] = "linear"
    width: q.EndToMiddle

    @property
    def half_width(self) -> float:
        """Half-width w [K]."""
        return float(self.width)


class TriangleLaw(ClosedLaw):
    """The latent capacity is a triangle with its peak at Tm.

    Examples
    --------
    >>> TriangleLaw(below=2, above=1)
    TriangleLaw(below=2 K, above=1 K)
    """

    _KIND: ClassVar[str] = "triangle"
    kind: Literal["triangle"] = "triangle"
    below: q.Flank
    above: q.Flank

    @property
    def half_width(self) -> float:
        """Half of the melting range [K]."""
        return 0.5 * (self.below + self.above)

    def _as_engine(self, centre: float) -> MeltingCurve:
        numbers = {
            "melting_temperature": centre, "below": float(self.below), "above": float(self.above)
        }  # fmt: skip
        return MeltingCurve(self._KIND, numbers)


class FractionsLaw(Part):
    """Measured liquid fraction over temperature, interpolated monotonically; needs a latent heat.

    Examples
    --------
    >>> FractionsLaw(temperatures=[19, 21, 22], fractions=[0, 0.6, 1])
    FractionsLaw(temperatures=[19 degC, 21 degC, 22 degC], fractions=[0, 0.6, 1], temperature_shift=0 K)
    """

    tails: ClassVar[bool] = False
    kind: Literal["fractions"] = "fractions"
    temperatures: tuple[q.CurveTemperature, ...]
    fractions: tuple[q.CurveFraction, ...]
    temperature_shift: q.TemperatureShift = Number(0.0, source=Remark("the curve as measured"))
    curve: Literal["heating", "cooling"] | None = Field(
        None, description="Curve of the product that the fractions are; only beside 'product:'"
    )

    @model_validator(mode="after")
    def _complete(self) -> FractionsLaw:
        faults = [*rising("temperatures", self.temperatures), *rising("fractions", self.fractions)]
        faults += as_many("temperatures", self.temperatures, "fractions", self.fractions)
        ends = [(0, 0.0), (len(self.fractions) - 1, 1.0)] if len(self.fractions) > 1 else []
        faults += [
            fault(
                ("fractions", index),
                f"{self.fractions[index]:g}",
                f"{end:g}: a curve from all solid to all liquid",
                "Extend the table, or scale its ends to 0 and 1.",
            )
            for index, end in ends
            if self.fractions[index] != end
        ]
        insist(*faults)
        return self

    @property
    def half_width(self) -> float:
        """Half of the melting range [K]."""
        return 0.5 * (self.temperatures[-1] - self.temperatures[0])

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, before the shift [degC]."""
        return (float(self.temperatures[0]), float(self.temperatures[-1]))

    def fraction(self, above: npt.ArrayLike) -> Floats:
        """Liquid fraction at temperatures of the table, before the shift [degC], with their shape. [-]"""
        table = {"temperatures": self.temperatures, "fractions": self.fractions}
        points = {name: [float(number) for number in column] for name, column in table.items()}
        return MeltingCurve("fractions", {"temperature_shift": 0.0}, points)(above)


class _Table(Part):
    """A measured curve over temperature that includes sensible and latent heat."""

    temperatures: tuple[q.CurveTemperature, ...]
    melting_range: tuple[q.CurveTemperature, q.CurveTemperature] | None = Field(
        None, description="Temperatures at which melting starts and is complete; none: the ends of the table"
    )
    temperature_shift: q.TemperatureShift = Number(0.0, source=Remark("the curve as measured"))
    enthalpy_scale: q.EnthalpyScale = Number(1.0, source=Remark("the curve as measured"))

    def _melting_outside(self) -> list[InitErrorDetails]:
        if self.melting_range is None or not self.temperatures:
            return []
        (start, end), first, last = self.melting_range, self.temperatures[0], self.temperatures[-1]
        if first <= start < end <= last:
            return []
        expected = f"[start, end] with start < end, between {first:g} and {last:g} degC"
        return [
            fault(("melting_range",), f"[{start:g}, {end:g}]", expected, "Swap the two or extend the table.")
        ]

    @property
    def melting(self) -> tuple[float, float]:
        """Temperatures at which melting starts and is complete [degC]."""
        low, high = self.melting_range or (self.temperatures[0], self.temperatures[-1])
        return (float(low), float(high))

    @property
    def half_width(self) -> float:
        """Half of the melting range [K]."""
        low, high = self.melting
        return 0.5 * (high - low)

    def rise(self, low: float, high: float) -> float:
        """Rise of the specific enthalpy between two temperatures of the table [J/kg]."""
        raise TypeError("each table defines its curve")


class TableLaw(_Table):
    """Measured enthalpy over temperature, interpolated monotonically.

    Examples
    --------
    >>> TableLaw(temperatures=[15, 20, 25], enthalpies=[0, 2.0e4, 2.2e5])
    TableLaw(temperatures=[15 degC, 20 degC, 25 degC], temperature_shift=0 K, enthalpy_scale=1, enth...)
    """

    kind: Literal["table"] = "table"
    enthalpies: tuple[q.CurveEnthalpy, ...]
    curve: Literal["heating", "cooling"] | None = Field(
        None, description="Curve of the product that the table holds; only beside 'product:'"
    )

    @model_validator(mode="after")
    def _monotone(self) -> TableLaw:
        insist(
            *rising("temperatures", self.temperatures),
            *rising("enthalpies", self.enthalpies),
            *as_many("temperatures", self.temperatures, "enthalpies", self.enthalpies),
            *self._melting_outside(),
        )
        return self

    def rise(self, low: float, high: float) -> float:
        """Rise of the specific enthalpy between two temperatures of the table [J/kg]."""
        curve = monotone(self.temperatures, self.enthalpies)
        return self.enthalpy_scale * (curve(high) - curve(low))


class CapacityLaw(_Table):
    """Measured apparent specific heat over temperature, interpolated linearly and integrated.

    Examples
    --------
    >>> CapacityLaw(temperatures=[18, 21, 24], capacities=[2000, 60000, 2000])
    CapacityLaw(temperatures=[18 degC, 21 degC, 24 degC], temperature_shift=0 K, enthalpy_scale=1, c...)
    """

    kind: Literal["capacity"] = "capacity"
    capacities: tuple[q.CurveCapacity, ...]

    @model_validator(mode="after")
    def _monotone(self) -> CapacityLaw:
        insist(
            *rising("temperatures", self.temperatures),
            *as_many("temperatures", self.temperatures, "capacities", self.capacities),
            *self._melting_outside(),
        )
        return self

    def rise(self, low: float, high: float) -> float:
        """Rise of the specific enthalpy between two temperatures of the table [J/kg]."""

        def at(temperature: float) -> float:
            for (t0, t1), (c0, c1) in zip(
                pairwise(self.temperatures), pairwise(self.capacities), strict=True
            ):
                if temperature <= t1:
                    return float(c0 + (c1 - c0) * (temperature - t0) / (t1 - t0))
            return float(self.capacities[-1])

        inner = [t for t in self.temperatures if low < t < high]
        parts = pairwise([low, *inner, high])
        return self.enthalpy_scale * sum(0.5 * (at(a) + at(b)) * (b - a) for a, b in parts)


Law = Annotated[
    TanhLaw
    | SmoothStepLaw
    | GaussianLaw
    | GumbelLaw
    | LinearLaw
    | TriangleLaw
    | FractionsLaw
    | TableLaw
    | CapacityLaw
    | FormulaCurve,
    Field(discriminator="kind"),
    Shorthand(implied=("formula", "text")),
]
#: Laws of the liquid fraction alone, which hysteresis needs.
FractionLaw = Annotated[
    TanhLaw | SmoothStepLaw | GaussianLaw | GumbelLaw | LinearLaw | TriangleLaw | FractionsLaw | FormulaCurve,
    Field(discriminator="kind"),
    Shorthand(implied=("formula", "text")),
]


class Hysteresis(Part):
    """A cooling curve, and what happens at a reversal within the melting range.

    ``curve_track`` stays on its curve until all has melted or frozen. ``curve_switch`` keeps the liquid
    fraction until the other curve is reached. ``curve_scale`` follows the other curve, scaled to the rest.
    The law of the material is the heating curve.

    References
    ----------
    Barz et al. 2019, J. Build. Perf. Simul. 12(6), doi:10.1080/19401493.2019.1657953

    Examples
    --------
    >>> Hysteresis(model="curve_switch", freezing_temperature=18.5).model
    'curve_switch'
    """

    model: Literal["curve_track", "curve_switch", "curve_scale"] = Field(
        description="curve_track, curve_switch or curve_scale"
    )
    freezing_temperature: q.FreezingTemperature | None = None
    law: FractionLaw | None = Field(
        None, description="Shape of the cooling curve; none: that of the heating curve"
    )

    @model_validator(mode="before")
    @classmethod
    def _either_dash(cls, raw: Any) -> Any:
        """Read ``curve-track`` as ``curve_track``."""
        if isinstance(raw, dict) and isinstance(raw.get("model"), str):
            return raw | {"model": raw["model"].replace("-", "_")}
        return raw
