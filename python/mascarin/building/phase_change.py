"""How a phase-change material melts and freezes: laws of the liquid fraction, measured curves, hysteresis."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.number import Number, Remark, problem
from mascarin.building.part import Part, fault, insist

#: Share of the transition cut off at either end of a curve with tails, where hysteresis needs an end.
CUT: Final = 1e-3


class ClosedLaw(Part):
    """A law of the liquid fraction in closed form, about the melting temperature."""

    #: Whether the fraction reaches 0 and 1 only in the infinite.
    tails: ClassVar[bool] = False

    @property
    def half_width(self) -> float:
        """Half-width of the melting range, or of most of it [K]."""
        raise TypeError("a law has a width of its own")

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, from the melting temperature, tails cut at `CUT` [K]."""
        raise TypeError("a law has a reach of its own")

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the melting temperature [K]."""
        raise TypeError("a law has a fraction of its own")


class TanhLaw(ClosedLaw):
    """Liquid fraction ``(1 + tanh((T - Tm)/w))/2``.

    Either the half-width ``w`` is given, or ``gamma`` and ``delta_t`` of Guichard et al., with which
    ``w = 4 delta_t/gamma``.
    """

    tails: ClassVar[bool] = True
    kind: Literal["tanh"] = "tanh"
    width: q.MeltingWidth | None = None
    gamma: q.Gamma | None = None
    delta_t: q.DeltaT | None = None

    @model_validator(mode="after")
    def _one_form(self) -> TanhLaw:
        given = [name for name in ("width", "gamma", "delta_t") if getattr(self, name) is not None]
        if given not in (["width"], ["gamma", "delta_t"]):
            raise problem(
                ", ".join(given) or "neither",
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

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, tails cut [K]."""
        end = self.half_width * math.atanh(1.0 - 2.0 * CUT)
        return (-end, end)

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the melting temperature [K]."""
        return 0.5 + 0.5 * math.tanh(above / self.half_width)


class SmoothStepLaw(ClosedLaw):
    """A polynomial between ``Tm - w`` and ``Tm + w``, with one or two continuous derivatives."""

    kind: Literal["smooth_step"] = "smooth_step"
    width: q.EndToMiddle
    continuity: q.Continuity = Number(1.0, source=Remark("an enthalpy with a continuous capacity"))

    @property
    def half_width(self) -> float:
        """Half-width w [K]."""
        return float(self.width)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete [K]."""
        return (-self.half_width, self.half_width)

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the melting temperature [K]."""
        v = _held(0.5 + 0.5 * above / self.width)
        return (
            v * v * (3.0 - 2.0 * v)
            if float(self.continuity) < 2.0
            else v**3 * (10.0 - 15.0 * v + 6.0 * v * v)
        )


class GaussianLaw(ClosedLaw):
    """The latent capacity is a normal distribution about Tm with the standard deviation ``width``."""

    tails: ClassVar[bool] = True
    kind: Literal["gaussian"] = "gaussian"
    width: q.Deviation

    @property
    def half_width(self) -> float:
        """Standard deviation [K]."""
        return float(self.width)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, tails cut [K]."""
        from statistics import NormalDist

        end = self.width * NormalDist().inv_cdf(1.0 - CUT)
        return (-end, end)

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the melting temperature [K]."""
        return 0.5 * math.erfc(-above / self.width / math.sqrt(2.0))


class GumbelLaw(ClosedLaw):
    """A skewed law: the latent capacity peaks at Tm and has a long tail on one side.

    With the tail towards low temperatures the fraction is ``1 - exp(-exp((T - Tm)/w))``.
    """

    tails: ClassVar[bool] = True
    kind: Literal["gumbel"] = "gumbel"
    width: q.GumbelScale
    tail: Literal["low", "high"] = Field(
        "low", description="Where the long tail is: low (melting starts slowly) or high temperatures"
    )

    @property
    def half_width(self) -> float:
        """Scale of the distribution [K]."""
        return float(self.width)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete, tails cut [K]."""
        ends = sorted(-self.width * math.log(-math.log(share)) for share in (CUT, 1.0 - CUT))
        return (ends[0], ends[1]) if self.tail == "high" else (-ends[1], -ends[0])

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the peak [K]."""
        sign = 1.0 if self.tail == "low" else -1.0
        left = math.exp(-math.exp(max(min(sign * above / self.width, 30.0), -30.0)))
        return 1.0 - left if self.tail == "low" else left


class LinearLaw(ClosedLaw):
    """The liquid fraction rises straight from 0 at ``Tm - w`` to 1 at ``Tm + w``."""

    kind: Literal["linear"] = "linear"
    width: q.EndToMiddle

    @property
    def half_width(self) -> float:
        """Half-width w [K]."""
        return float(self.width)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete [K]."""
        return (-self.half_width, self.half_width)

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the melting temperature [K]."""
        return _held(0.5 + 0.5 * above / self.width)


class TriangleLaw(ClosedLaw):
    """The latent capacity is a triangle with its peak at Tm."""

    kind: Literal["triangle"] = "triangle"
    below: q.Flank
    above: q.Flank

    @property
    def half_width(self) -> float:
        """Half of the melting range [K]."""
        return 0.5 * (self.below + self.above)

    @property
    def reach(self) -> tuple[float, float]:
        """Where melting starts and is complete [K]."""
        return (-float(self.below), float(self.above))

    def fraction(self, above: float) -> float:
        """Liquid fraction so far above the peak [K]."""
        rising, falling = _held(1.0 + above / self.below), _held(1.0 - above / self.above)
        total = self.below + self.above
        return (self.below * rising**2 + self.above * (1.0 - falling**2)) / total


def _held(value: float) -> float:
    return min(max(float(value), 0.0), 1.0)


class FractionsLaw(Part):
    """Measured liquid fraction over temperature, interpolated monotonically; needs a latent heat beside."""

    tails: ClassVar[bool] = False
    kind: Literal["fractions"] = "fractions"
    temperatures: tuple[q.CurveTemperature, ...]
    fractions: tuple[q.CurveFraction, ...]
    temperature_shift: q.TemperatureShift = Number(0.0, source=Remark("the curve as measured"))

    @model_validator(mode="after")
    def _complete(self) -> FractionsLaw:
        faults = [*rising("temperatures", self.temperatures), *rising("fractions", self.fractions)]
        faults += _as_many("temperatures", self.temperatures, "fractions", self.fractions)
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

    def fraction(self, above: float) -> float:
        """Liquid fraction at a temperature of the table, by monotone cubics as in the engine [degC]."""
        return monotone(self.temperatures, self.fractions)(above)


class _Table(Part):
    """A measured curve over temperature that holds sensible and latent heat."""

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
        raise TypeError("a table has a curve of its own")


class TableLaw(_Table):
    """Measured enthalpy over temperature, interpolated monotonically."""

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
            *_as_many("temperatures", self.temperatures, "enthalpies", self.enthalpies),
            *self._melting_outside(),
        )
        return self

    def rise(self, low: float, high: float) -> float:
        """Rise of the specific enthalpy between two temperatures of the table [J/kg]."""
        curve = monotone(self.temperatures, self.enthalpies)
        return self.enthalpy_scale * (curve(high) - curve(low))


class CapacityLaw(_Table):
    """Measured apparent specific heat over temperature, interpolated linearly and integrated."""

    kind: Literal["capacity"] = "capacity"
    capacities: tuple[q.CurveCapacity, ...]

    @model_validator(mode="after")
    def _monotone(self) -> CapacityLaw:
        insist(
            *rising("temperatures", self.temperatures),
            *_as_many("temperatures", self.temperatures, "capacities", self.capacities),
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
    | CapacityLaw,
    Field(discriminator="kind"),
]
#: Laws of the liquid fraction alone: what hysteresis can be made of.
FractionLaw = Annotated[
    TanhLaw | SmoothStepLaw | GaussianLaw | GumbelLaw | LinearLaw | TriangleLaw | FractionsLaw,
    Field(discriminator="kind"),
]


class Hysteresis(Part):
    """A cooling curve of its own, and what happens on a reversal within the range.

    ``curve_track`` stays on its curve until all has melted or frozen. ``curve_switch`` keeps the liquid
    fraction until the other curve is met. ``curve_scale`` follows the other curve, scaled to what is left.
    The law of the material is the heating curve.

    References
    ----------
    Barz et al. 2019, J. Build. Perf. Simul. 12(6), doi:10.1080/19401493.2019.1657953
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


def rising(key: str, values: tuple[Number, ...]) -> list[InitErrorDetails]:
    """Find where a column of a table does not rise."""
    if len(values) < 2:
        return [fault((key,), f"{len(values)} points", "at least two points", "Complete the table.")]
    return [
        fault(
            (key, i + 1),
            f"{after:g} after {before:g}",
            "strictly rising values: heat must raise enthalpy",
            "Sort the table, remove repeated points; a plateau needs a small slope.",
        )
        for i, (before, after) in enumerate(pairwise(values))
        if not after > before
    ]


def _as_many(
    one: str, first: tuple[Number, ...], other: str, second: tuple[Number, ...]
) -> list[InitErrorDetails]:
    if len(first) == len(second):
        return []
    found = f"{len(first)} {one} and {len(second)} {other}"
    return [fault((), found, "as many of one as of the other", "Complete the table.")]


def monotone(x: tuple[Number, ...], y: tuple[Number, ...]) -> Callable[[float], float]:
    """Monotone cubic through points, as the engine draws it; constant beyond the ends.

    References
    ----------
    Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5(2), doi:10.1137/0905021
    """
    lengths = [b - a for a, b in pairwise(x)]
    secants = [(b - a) / length for (a, b), length in zip(pairwise(y), lengths, strict=True)]
    slopes = [secants[0]]
    for (left, right), (before, after) in zip(pairwise(lengths), pairwise(secants), strict=True):
        near, far = 2.0 * right + left, right + 2.0 * left
        slopes.append((near + far) / (near / before + far / after) if before > 0.0 < after else 0.0)
    slopes.append(secants[-1])

    def at(place: float) -> float:
        if place <= x[0]:
            return float(y[0])
        for i, length in enumerate(lengths):
            if place < x[i + 1]:
                u = (place - x[i]) / length
                s0, s1, m = slopes[i], slopes[i + 1], secants[i]
                cubic = (3.0 * m - 2.0 * s0 - s1) + u * (s0 + s1 - 2.0 * m)
                return float(y[i] + length * u * (s0 + u * cubic))
        return float(y[-1])

    return at
