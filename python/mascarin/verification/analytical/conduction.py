"""Conduction in walls: analytical solutions for sinusoids and steps, and the order in space."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from mascarin.verification.analytical import setup
from mascarin.verification.analytical.check import Case, Check

if TYPE_CHECKING:
    import numpy.typing as npt

    Complex = npt.NDArray[np.complex128]

OMEGA: Final = 2.0 * math.pi / setup.DAY
AMPLITUDE: Final = 10.0  # K
#: z^3 coefficient of exp(z) - R(z) of SDIRK2, gamma = 1 - sqrt(1/2): its relative error in frequency.
STEP_ERROR: Final = 0.0404
#: Bounds are this many times the leading term of the discretization error, for the higher-order terms.
MARGIN: Final = 2.0


class ConductionLayer(NamedTuple):
    """A layer of a test wall: m, W/(m K), kg/m3, J/(kg K), finite volumes."""

    thickness: float
    conductivity: float
    density: float
    specific_heat: float
    nodes: int

    @property
    def depth(self) -> float:
        """Penetration depth of a daily oscillation, where it is damped to 1/e. [m]"""
        return math.sqrt(2.0 * self.conductivity / (self.density * self.specific_heat * OMEGA))

    @property
    def error(self) -> float:
        """Leading relative error of damping and lag over the layer by its finite volumes. [-]"""
        return self.error_at(self.thickness)

    def error_at(self, depth: float) -> float:
        """Compute `error` up to a depth [m]: of half a volume at the surface and the path behind it. [-]"""
        cell = self.thickness / self.nodes / self.depth
        return cell**2 * (0.25 + depth / self.depth / 12.0)


def materials(layers: Sequence[ConductionLayer]) -> str:
    """Write the materials and the construction `wall` of a list of layers as YAML."""
    lines = ["materials:"]
    for k, layer in enumerate(layers):
        lines.append(
            f"  m{k}: {{conductivity: {layer.conductivity}, density: {layer.density}, "
            f"specific_heat: {layer.specific_heat}}}"
        )
    lines += ["constructions:", "  wall:", "    layers:"]
    lines += [
        f"      - {{material: m{k}, thickness: {layer.thickness}, nodes: {layer.nodes}}}"
        for k, layer in enumerate(layers)
    ]
    return "\n".join(lines) + "\n"


# --- a sinusoid into a thick wall --------------------------------------------------------------------------

_THICK: Final = ConductionLayer(1.5, 1.75, 2240.0, 900.0, 300)
_DEPTHS: Final = (0.0775, 0.1525, 0.3075)  # centres of volumes


def _semi_infinite(name: str) -> Iterator[Check]:
    sensors = "\n".join(f"  at{k}: {{surface: w, depth: {depth}}}" for k, depth in enumerate(_DEPTHS))
    text = (
        f"{materials([_THICK])}surfaces:\n  w: {{construction: wall, area: 1, tilt: 90, "
        f"outside: {{measured: surface}}, inside: {{adiabatic: true}}}}\nsensors:\n{sensors}\n"
    )
    step = 300.0
    t = setup.times(60 * setup.DAY, 60.0)
    surface = 20.0 + AMPLITUDE * np.sin(OMEGA * t)
    outputs = [f"at{k}.temperature" for k in range(len(_DEPTHS))]
    series = setup.run(text, 60.0, {"surface": surface}, step=step, outputs=outputs).records
    for k, depth in enumerate(_DEPTHS):
        oscillation = setup.harmonic(series[:, k], step, setup.DAY)
        x = depth / _THICK.depth
        expected = AMPLITUDE * math.exp(-x)
        bound = MARGIN * (_THICK.error_at(depth) + STEP_ERROR * (OMEGA * step) ** 2 * x)
        where = f"at {1000 * depth:g} mm"
        yield Check.near(name, f"amplitude {where}", "K", abs(oscillation), expected, within=bound * expected)
        lag, hours = -math.atan2(oscillation.imag, oscillation.real), 1.0 / OMEGA / setup.HOUR
        yield Check.near(name, f"lag {where}", "h", lag * hours, x * hours, within=bound * hours)


# --- the periodic response of a wall of layers -------------------------------------------------------------

_OUTER, _INNER = 25.0, 1.0 / 0.13  # surface heat transfer coefficients of ISO 6946, W/(m2 K)
_WALL: Final = (
    ConductionLayer(0.020, 0.87, 1800.0, 1000.0, 10),
    ConductionLayer(0.100, 0.035, 20.0, 1450.0, 20),
    ConductionLayer(0.240, 0.80, 1700.0, 900.0, 60),
    ConductionLayer(0.015, 0.40, 1100.0, 1000.0, 8),
)


def transfer(layers: Sequence[ConductionLayer]) -> Complex:
    """Compute the transfer matrix of a wall for a daily oscillation (ISO 13786:2017, 7.2).

    It maps (temperature, flux) inside to outside, with the signs of the standard, surface resistances
    included.

    Parameters
    ----------
    layers : sequence of ConductionLayer
        Outside to inside.

    Returns
    -------
    ndarray, shape (2, 2)
        Z.
    """

    def surface(coefficient: float) -> Complex:
        return np.array([[1.0, -1.0 / coefficient], [0.0, 1.0]], dtype=np.complex128)

    product = surface(_INNER)
    for layer in reversed(layers):
        x = (1.0 + 1j) * layer.thickness / layer.depth
        impedance = layer.depth / (layer.conductivity * (1.0 + 1j))
        matrix = np.array(
            [[np.cosh(x), -impedance * np.sinh(x)], [-np.sinh(x) / impedance, np.cosh(x)]],
            dtype=np.complex128,
        )
        product = matrix @ product
    return surface(_OUTER) @ product


def conductance(layers: Sequence[ConductionLayer]) -> float:
    """Compute the thermal transmittance with surface resistances. [W/(m2 K)]"""
    return 1.0 / (1.0 / _OUTER + 1.0 / _INNER + sum(layer.thickness / layer.conductivity for layer in layers))


def _response(layers: Sequence[ConductionLayer], step: float, *, inside: bool) -> tuple[complex, float]:
    """Inside flux per kelvin of a daily oscillation of the air of one side; mean flux. [W/(m2 K), W/m2]"""
    days = 20
    t = setup.times(days * setup.DAY, 60.0)
    wave, still = 20.0 + AMPLITUDE * np.sin(OMEGA * t), np.full(len(t), 20.0)
    columns = {"outer": still - 15.0, "inner": wave} if inside else {"outer": wave - 15.0, "inner": still}
    text = (
        f"{materials(layers)}surfaces:\n  w: {{construction: wall, area: 1, tilt: 90, "
        f"outside: {{measured: outer, convection: {_OUTER}}}, "
        f"inside: {{measured: inner, convection: {_INNER!r}}}}}\n"
    )
    flux = setup.run(text, 60.0, columns, step=step, outputs=["w.inside_flux"]).records[:, 0]
    last_day = flux[-round(setup.DAY / step) :]
    return setup.harmonic(flux, step, setup.DAY) / AMPLITUDE, float(last_day.mean())


def _periodic(name: str) -> Iterator[Check]:
    step = 300.0
    z = transfer(_WALL)
    u = conductance(_WALL)
    relative = MARGIN * (sum(layer.error for layer in _WALL) + STEP_ERROR * (OMEGA * step) ** 2)
    hours = 1.0 / OMEGA / setup.HOUR
    through, mean = _response(_WALL, step, inside=False)
    into, _ = _response(_WALL, step, inside=True)
    transmittance, admittance = -1.0 / z[0, 1], z[0, 0] / z[0, 1]
    yield Check.near(
        name, "decrement factor", "-", abs(through) / u, abs(transmittance) / u,
        within=relative * abs(transmittance) / u,
    )  # fmt: skip
    lag = _angle(1.0 / through) * hours
    expected = _angle(1.0 / transmittance) * hours
    yield Check.near(name, "time shift of the transmittance", "h", lag, expected, within=relative * hours)
    yield Check.near(
        name, "inside admittance", "W/(m2 K)", abs(into), abs(admittance), within=relative * abs(admittance)
    )
    lead, expected = _angle(-into) * hours, _angle(-admittance) * hours
    yield Check.near(name, "lead of the inside admittance", "h", lead, expected, within=relative * hours)
    yield Check.near(name, "mean flux", "W/m2", mean, -15.0 * u, within=1e-6 * 15.0 * u)


def _angle(value: complex) -> float:
    """Argument between 0 and 2 pi. [rad]"""
    return math.atan2(value.imag, value.real) % (2.0 * math.pi)


# --- a step of the air before a thick wall -----------------------------------------------------------------


def _convective_step(name: str) -> Iterator[Check]:
    from scipy.special import erfc, erfcx

    h, rise, step, end = 8.0, 20.0, 60.0, 4 * setup.HOUR
    layer = ConductionLayer(1.2, 0.8, 1700.0, 900.0, 960)
    a = layer.conductivity / (layer.density * layer.specific_heat)
    depth = 0.05 + 0.5 * layer.thickness / layer.nodes
    text = (
        f"{materials([layer])}surfaces:\n  w: {{construction: wall, area: 1, tilt: 90, "
        f"outside: {{measured: air, convection: {h}}}, inside: {{adiabatic: true}}}}\n"
        f"sensors: {{deep: {{surface: w, depth: {depth}}}}}\n"
    )
    temperatures = setup.run(
        text,
        end,
        {"air": setup.steady(20.0 + rise)},
        step=step,
        outputs=["w.outside_temperature", "deep.temperature"],
    ).records[-1]
    reach = math.sqrt(a * end)
    cell = layer.thickness / layer.nodes
    # Second order in both: cell over the depth k/h, step over the time.
    bound = MARGIN * rise * ((cell * h / layer.conductivity) ** 2 + (cell / reach) ** 2 + (step / end) ** 2)
    for what, x, value in (
        ("of the surface", 0.0, temperatures[0]),
        (f"at {1000 * depth:g} mm", depth, temperatures[1]),
    ):
        u, v = x / (2.0 * reach), h * reach / layer.conductivity
        # exp(h x/k + h^2 a t/k^2) erfc(u + v), in a form that does not overflow.
        ratio = erfc(u) - math.exp(-u * u) * erfcx(u + v)
        yield Check.near(name, f"temperature {what}", "degC", value, 20.0 + rise * float(ratio), within=bound)


# --- order of convergence in dx ----------------------------------------------------------------------------


def _order_in_space(name: str) -> Iterator[Check]:
    expected = -1.0 / transfer(_WALL)[0, 1]
    errors = []
    for coarseness in (4, 2, 1):
        layers = [layer._replace(nodes=max(layer.nodes // coarseness // 2, 1)) for layer in _WALL]
        errors.append(abs(_response(layers, 60.0, inside=False)[0] - expected) / abs(expected))
    for k, (coarse, fine) in enumerate(pairwise(errors)):
        order = math.log2(coarse / fine)
        yield Check.near(name, f"order, halving {k + 1}", "-", order, 2.0, within=0.1)
    yield Check(name, "relative error on the finest mesh", "-", errors[-1])


_ISO: Final = (
    "ISO 13786:2017, Thermal performance of building components, dynamic thermal characteristics, 7.2"
)
_CARSLAW: Final = "Carslaw & Jaeger 1959, Conduction of Heat in Solids, 2nd ed."

CASES: Final = (
    Case(
        name="semi-infinite sinusoid",
        problem="Concrete of 1.5 m (1.75 W/(m K), 2240 kg/m3, 900 J/(kg K)), 300 volumes, 300 s; its surface"
        " follows a daily sinusoid of 10 K, given as a measured column. The last of 60 days.",
        answer="T = A exp(-x/d) sin(w t - x/d), d = sqrt(2 a/w)",
        source=f"{_CARSLAW}, 2.6",
        tolerance="Twice the leading terms of the discretization error: (dx/d)^2 (1/4 + x/(12 d)) in "
        "space and 0.04 (w dt)^2 x/d in time.",
        topics=("building",),
        work=_semi_infinite,
    ),
    Case(
        name="periodic wall",
        problem="Render, insulation, brick and plaster with surface heat transfer coefficients of 25 "
        "and 7.69 W/(m2 K); the air of one side follows a daily sinusoid, outdoors 15 K colder"
        " on average. Flux through the inside surface, day 20.",
        answer="Z = Z_se Z_1 ... Z_n Z_si; Y12 = -1/Z12, f = |Y12|/U, Y11 = -Z11/Z12",
        source=_ISO,
        tolerance="Twice the leading terms of the discretization error: (dx/d)^2 (1/4 + thickness/(12 "
        "d)) summed over the layers, and 0.04 (w dt)^2. The mean flux: the effect of the "
        "initial state that remains after 20 days.",
        topics=("building",),
        work=_periodic,
    ),
    Case(
        name="air step at a thick wall",
        problem="Brick of 1.2 m at 20 degC; the air before it changes to 40 degC, surface heat transfer "
        "coefficient 8 W/(m2 K). After 4 h.",
        answer="theta = erfc(u) - exp(h x/k + h^2 a t/k^2) erfc(u + h sqrt(a t)/k), u = x/(2 sqrt(a t))",
        source=f"{_CARSLAW}, 2.7",
        tolerance="Twice the change of the air times (dx h/k)^2 + (dx/sqrt(a t))^2 + (dt/t)^2: second "
        "order in both.",
        topics=("building",),
        work=_convective_step,
    ),
    Case(
        name="order in dx",
        problem="The periodic wall on three meshes, each twice as fine as the previous one, at 60 s.",
        answer="error of Y12 ~ dx^2",
        source=_ISO,
        tolerance="2 within 0.1: the effect of the next order on these meshes is smaller.",
        topics=("building",),
        work=_order_in_space,
    ),
)
