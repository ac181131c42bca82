"""Long-wave exchange and convection: enclosures, a plate under the sky, correlations."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from mascarin.verification.analytical import moisture, setup
from mascarin.verification.analytical.check import Case, Check

SIGMA: Final = 5.670374419e-8  # W/(m2 K4), CODATA 2018
KELVIN: Final = 273.15
#: Tolerance of Newton's iteration: the only difference of a steady state from its balance. [K]
TOLERANCE: Final = 1e-6


def emission(temperature: float) -> float:
    """Compute black-body emission at a temperature in degC. [W/m2]"""
    return SIGMA * (temperature + KELVIN) ** 4


class EnclosureSurface(NamedTuple):
    """A surface of an enclosure: area [m2], emissivity [-], temperature behind it [degC]."""

    area: float
    emissivity: float
    behind: float


_RESISTANCE, _CONVECTION = 0.05, 2.0  # m2 K/W, W/(m2 K)


def exchange(surfaces: Sequence[EnclosureSurface], views: setup.Array) -> setup.Array:
    """Compute the matrix of net heat flows from black-body emissions by radiosity. [m2]

    Parameters
    ----------
    surfaces : sequence of EnclosureSurface
        The enclosure.
    views : ndarray, shape (n, n)
        View factors.

    Returns
    -------
    ndarray, shape (n, n)
        ``Q = M E``: Q [W] from black emissions E [W/m2].
    """
    e = np.array([surface.emissivity for surface in surfaces])
    area = np.array([surface.area for surface in surfaces])
    unit = np.eye(len(surfaces))
    # J = e E + (1 - e) F J; Q = A (J - F J).
    radiosity = np.linalg.solve(unit - (1.0 - e)[:, None] * views, np.diag(e))
    return area[:, None] * ((unit - views) @ radiosity)


def balance(surfaces: Sequence[EnclosureSurface], leaving: setup.Array) -> setup.Array:
    """Solve for the temperatures of surfaces and air of a steady room without air change. [degC]"""
    from scipy.optimize import root

    behind = np.array([wall.behind for wall in surfaces])
    area = np.array([wall.area for wall in surfaces])

    def residual(x: setup.Array) -> setup.Array:
        surface, air = x[:-1], x[-1]
        emitted = SIGMA * (surface + KELVIN) ** 4
        heat = area * ((behind - surface) / _RESISTANCE - _CONVECTION * (surface - air)) - leaving @ emitted
        return np.append(heat, np.sum(area * (surface - air)))

    answer = root(residual, np.append(behind, behind.mean()), tol=1e-13)
    return np.asarray(answer.x)


def _enclosure(
    name: str,
    title: str,
    surfaces: Sequence[EnclosureSurface],
    views: setup.Array | None,
    leaving: setup.Array,
) -> Iterator[Check]:
    rows = []
    if views is not None:
        for k, row in enumerate(views):
            cells = ", ".join(f"f{j}: {value!r}" for j, value in enumerate(row.tolist()) if value > 0.0)
            rows.append(f"f{k}: {{{cells}}}")
    factors = f", view_factors: {{{', '.join(rows)}}}" if rows else ""
    described = "".join(
        f"  f{k}: {{construction: panel, area: {surface.area!r}, tilt: {180 * (k % 2)}, "
        f"outside: {{measured: t{k}}}, "
        f"inside: {{zone: room, convection: {_CONVECTION}, emissivity: {surface.emissivity}}}}}\n"
        for k, surface in enumerate(surfaces)
    )
    text = (
        f"materials: {{panel: {{kind: resistance, resistance: {_RESISTANCE}}}}}\n"
        "constructions: {panel: {layers: [{material: panel}]}}\n"
        f"zones: {{room: {{volume: 10{factors}}}}}\nsurfaces:\n{described}"
    )
    columns = {f"t{k}": setup.steady(surface.behind) for k, surface in enumerate(surfaces)}
    outputs = [f"f{k}.inside_temperature" for k in range(len(surfaces))] + ["room.air_temperature"]
    end = 10 * setup.DAY
    temperatures = setup.run(text, end, columns, step=setup.HOUR, outputs=outputs).records[-1]
    for output, value, expected in zip(outputs, temperatures, balance(surfaces, leaving), strict=True):
        yield Check.near(name, f"{title}: {output}", "degC", value, float(expected), within=TOLERANCE)


def _enclosures(name: str) -> Iterator[Check]:
    plates = [EnclosureSurface(4.0, 0.9, 80.0), EnclosureSurface(4.0, 0.25, 5.0)]
    conductance = 4.0 / (1.0 / 0.9 + 1.0 / 0.25 - 1.0)
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    yield from _enclosure(name, "plates", plates, None, conductance * pair)
    body = [EnclosureSurface(1.5, 0.8, 90.0), EnclosureSurface(12.0, 0.6, 10.0)]
    small, large = body
    conductance = small.area / (
        1.0 / small.emissivity + small.area / large.area * (1.0 / large.emissivity - 1.0)
    )
    ratio = small.area / large.area
    yield from _enclosure(
        name, "body in a shell", body, np.array([[0.0, 1.0], [ratio, 1.0 - ratio]]), conductance * pair
    )
    # A long triangular duct: view factors by Hottel's crossed strings.
    sides = [
        EnclosureSurface(3.0, 0.9, 60.0),
        EnclosureSurface(4.0, 0.4, 20.0),
        EnclosureSurface(5.0, 0.7, 0.0),
    ]
    a = [side.area for side in sides]
    views = np.array(
        [[0.0 if i == j else (a[i] + a[j] - a[3 - i - j]) / (2.0 * a[i]) for j in range(3)] for i in range(3)]
    )
    yield from _enclosure(name, "triangular duct", sides, views, exchange(sides, views))


def _sky(name: str) -> Iterator[Check]:
    from scipy.optimize import brentq

    air, dew, cloud, convection, emissivity = 18.0, 9.0, 4.0, 6.0, 0.9
    skies: dict[str, float] = {
        "martin_berdahl": 0.711 + 0.56 * dew / 100.0 + 0.73 * (dew / 100.0) ** 2,
        "clark_allen": 0.787 + 0.764 * math.log((dew + KELVIN) / 273.0),
        "brunt": 0.618 + 0.056 * math.sqrt(0.01 * moisture.saturation(dew)),
    }
    factor = 1.0 + 0.0224 * cloud - 0.0035 * cloud**2 + 0.00028 * cloud**3
    layer = 0.1 * cloud * math.exp(-1200.0 / 8200.0)
    # Martin and Berdahl add an opaque layer, the others are used with the factor of Clark and Allen.
    emissivities = {
        sky: clear + (1.0 - clear) * layer if sky == "martin_berdahl" else min(clear * factor, 1.0)
        for sky, clear in skies.items()
    }
    columns = {
        "air_temperature": setup.steady(air),
        "dew_point": setup.steady(dew),
        "cloud_cover": setup.steady(cloud),
    }
    for sky, sky_emissivity in emissivities.items():
        for tilt, exponent in ((0.0, None), (60.0, None), (60.0, 1.0), (60.0, 2.0)):
            more = "" if exponent is None else f", sky_exponent: {exponent}"
            text = f"""\
site: {{latitude: 0, longitude: 0, altitude: 0, timezone: UTC, sky: {sky}{more}}}
materials: {{sheet: {{conductivity: 1, density: 1000, specific_heat: 1000}}}}
constructions: {{sheet: {{layers: [{{material: sheet, thickness: 0.01}}]}}}}
surfaces:
  plate: {{construction: sheet, area: 1, tilt: {tilt}, azimuth: 0, inside: {{adiabatic: true}},
          outside: {{outdoors: true, convection: {convection}, emissivity: {emissivity}, absorptance: 0.5}}}}
"""
            end = 5 * setup.DAY
            temperature = setup.run(
                text, end, columns, step=setup.HOUR, outputs=["plate.outside_temperature"]
            ).records[-1, 0]
            view = 0.5 * (1.0 + math.cos(math.radians(tilt)))
            of_sky = view ** (1.5 if exponent is None else exponent)
            # Radiation of the sky, which near the horizon is that of the air, and of a ground as warm.
            arriving = of_sky * sky_emissivity * emission(air) + (1.0 - of_sky) * emission(air)

            def heat(surface: float, arriving: float = arriving) -> float:
                return emissivity * (arriving - emission(surface)) + convection * (air - surface)

            expected = float(brentq(heat, air - 60.0, air + 20.0, xtol=1e-12))
            yield Check.near(
                name, f"plate of {tilt:g} deg, {sky}{more}", "degC", temperature, expected, within=TOLERANCE
            )


# --- surface heat transfer coefficients --------------------------------------------------------------------


class Convection(NamedTuple):
    """A correlation in YAML, the tilt of its surface, and the coefficient by hand from (|dT|, wind)."""

    law: str
    tilt: float
    by_hand: Callable[[float, float], float]


def _blend(a: float, b: float, difference: float, length: float) -> float:
    return float(((a * (difference / length) ** 0.25) ** 6 + (b * difference ** (1 / 3)) ** 6) ** (1 / 6))


_LENGTH, _AREA, _PERIMETER, _ROUGH = 2.5, 4.0, 8.0, 1.67
_STILL: Final = (
    Convection("{kind: constant, coefficient: 3.2}", 90, lambda d, _: 3.2),
    Convection("{kind: alamdari_hammond, length: 2.5}", 90, lambda d, _: _blend(1.5, 1.23, d, _LENGTH)),
    Convection("{kind: guichard2016_eq5, length: 2.5}", 90,
         lambda d, _: float(((1.51 * d**0.25 / _LENGTH) ** 6 + (1.33 * d ** (1 / 3)) ** 6) ** (1 / 6))),
    Convection("{kind: tarp}", 90, lambda d, _: 1.31 * d ** (1 / 3)),
    # The warm surface faces down where the tilt is 0 and up where it is 180: stable, unstable.
    Convection("{kind: alamdari_hammond, length: 2.5}", 0, lambda d, _: 0.6 * (d / _LENGTH**2) ** 0.2),
    Convection("{kind: alamdari_hammond, length: 2.5}", 180, lambda d, _: _blend(1.4, 1.63, d, _LENGTH)),
    Convection("{kind: tarp}", 0, lambda d, _: 1.810 * d ** (1 / 3) / 2.382),
    Convection("{kind: tarp}", 180, lambda d, _: 9.482 * d ** (1 / 3) / 6.238),
    Convection("{kind: tarp}", 45, lambda d, _: 1.810 * d ** (1 / 3) / (1.382 + math.sqrt(0.5))),
    Convection("{kind: power, upward: {a: 1, b: 2, n: 0.25}, downward: {a: 0.5, b: 1, n: 0.3}}", 180,
         lambda d, _: 1.0 + 2.0 * d**0.25),
    Convection("{kind: power, upward: {a: 1, b: 2, n: 0.25}, downward: {a: 0.5, b: 1, n: 0.3}}", 0,
         lambda d, _: 0.5 + 1.0 * d**0.3),
)  # fmt: skip


def _doe2(natural: float, wind: float) -> float:
    return natural + _ROUGH * (math.hypot(natural, wind) - natural)


def _forced(side: float, wind: float) -> float:
    return 2.537 * side * _ROUGH * math.sqrt(_PERIMETER * wind / _AREA)


_WINDY: Final = (
    Convection("{kind: linear_wind, constant: 5.7, wind: 3.8}", 90, lambda d, v: 5.7 + 3.8 * v),
    Convection("{kind: mowitt}", 90, lambda d, v: math.hypot(0.84 * d ** (1 / 3), 3.26 * v**0.89)),
    Convection("{kind: doe2, roughness: 1.67}", 90, lambda d, v: _doe2(1.31 * d ** (1 / 3), 3.26 * v**0.89)),
    Convection(
        "{kind: tarp, roughness: 1.67, perimeter: 8}", 90, lambda d, v: 1.31 * d ** (1 / 3) + _forced(1.0, v)
    ),
    Convection(
        "{kind: power, upward: {a: 2, c: 4, m: 0.8}, downward: {a: 1}}", 90, lambda d, v: 2.0 + 4.0 * v**0.8
    ),
)
_LEEWARD: Final = (
    Convection("{kind: mowitt}", 90, lambda d, v: math.hypot(0.84 * d ** (1 / 3), 3.55 * v**0.617)),
    Convection("{kind: doe2, roughness: 1.67}", 90, lambda d, v: _doe2(1.31 * d ** (1 / 3), 3.55 * v**0.617)),
    Convection(
        "{kind: tarp, roughness: 1.67, perimeter: 8}", 90, lambda d, v: 1.31 * d ** (1 / 3) + _forced(0.5, v)
    ),
)
_PANEL: Final = (
    "materials: {panel: {kind: resistance, resistance: 0.1}}\n"
    "constructions: {panel: {layers: [{material: panel}]}}\n"
)


def _correlations(name: str) -> Iterator[Check]:
    end = setup.DAY
    for law in _STILL:
        text = f"""\
{_PANEL}zones: {{room: {{volume: 5, longwave: none, infiltration: 5}}}}
surfaces:
  warm: {{construction: panel, area: {_AREA}, tilt: {law.tilt}, azimuth: 0, outside: {{measured: hot}},
         inside: {{zone: room, convection: {law.law}}}}}
  cold: {{construction: panel, area: 20, tilt: 90, azimuth: 180, outside: {{measured: cold}},
         inside: {{zone: room, convection: 5}}}}
"""
        columns = {
            "hot": setup.steady(60.0),
            "cold": setup.steady(10.0),
            "air_temperature": setup.steady(10.0),
        }
        yield from _correlation(
            name, law, text, columns, end, "warm.inside", "room.air_temperature", "no wind"
        )
    wind, height = 4.0, 6.0
    for laws, words, direction in ((_WINDY, "windward", 0.0), (_LEEWARD, "leeward", 180.0)):
        for law in laws:
            text = f"""\
{_PANEL}surfaces:
  warm: {{construction: panel, area: {_AREA}, tilt: {law.tilt}, azimuth: 0, inside: {{measured: hot}},
         outside: {{outdoors: true, convection: {law.law}, emissivity: 0.9, absorptance: 0.5, longwave: none,
                   height: {height}}}}}
"""
            columns = {
                "hot": setup.steady(60.0),
                "air_temperature": setup.steady(10.0),
                "wind_speed": setup.steady(wind),
                "wind_direction": setup.steady(direction),
            }
            yield from _correlation(
                name, law, text, columns, end, "warm.outside", 10.0, words, _at_height(wind, height)
            )


def _at_height(wind: float, height: float) -> float:
    """Wind at a height over open terrain, from that at 10 m over open terrain (ASHRAE power law). [m/s]"""
    return float(wind * (270.0 / 10.0) ** 0.14 * (height / 270.0) ** 0.14)


def _correlation(
    name: str,
    law: Convection,
    text: str,
    columns: dict[str, setup.Array],
    end: float,
    surface: str,
    air: str | float,
    words: str,
    wind: float = 0.0,
) -> Iterator[Check]:
    outputs = [f"{surface}_flux", f"{surface}_temperature", *([air] if isinstance(air, str) else [])]
    row = setup.run(text, end, columns, step=600.0, outputs=outputs).records[-1]
    difference = float(row[1]) - (float(row[2]) if isinstance(air, str) else float(air))
    coefficient = abs(float(row[0])) / difference
    expected = law.by_hand(difference, wind)
    kind = law.law.strip("{}").split(",")[0].removeprefix("kind: ")
    # |dT| is smoothed within 0.01 K of 0, by (0.01/dT)^2/2; no exponent is above 1. And 1e-6 K of Newton.
    bound = expected * (0.5 * (0.01 / difference) ** 2 + 2e-6 / difference)
    yield Check.near(
        name, f"{kind}, {law.tilt:g} deg, {words}", "W/(m2 K)", coefficient, expected, within=bound
    )


CASES: Final = (
    Case(
        name="enclosures",
        problem="Surfaces behind 0.05 m2 K/W with convection of 2 W/(m2 K) around still air: two plates, "
        "a body in a shell, a triangular duct; steady.",
        answer="Q = A s (T1^4 - T2^4)/(1/e1 + (A1/A2)(1/e2 - 1)) for two surfaces; radiosity with crossed "
        "strings for three; the balance with convection and panels by root finding",
        source="Hottel & Sarofim 1967, Radiative Transfer, ch. 2-3",
        tolerance="1e-6 K: the tolerance of Newton's iteration, the only difference.",
        topics=("building",),
        work=_enclosures,
    ),
    Case(
        name="plate under the sky",
        problem="An insulated plate, horizontal and at 60 deg, convection 6 W/(m2 K), emissivity 0.9, "
        "air 18 degC, dew point 9 degC, 4 tenths of cloud; steady, at night.",
        answer="e (E_in - s T^4) + h (Ta - T) = 0, E_in = F^n E_sky + (1 - F^n) E_air, n = 3/2, 1 and 2",
        source="Martin & Berdahl 1984, doi:10.1016/0038-092X(84)90162-2; Clark & Allen 1978; Li et al. "
        "2017, doi:10.1016/j.solener.2017.01.006; Walton 1983 (b)",
        tolerance="1e-6 K: the tolerance of Newton's iteration.",
        topics=("building",),
        work=_sky,
    ),
    Case(
        name="surface heat transfer coefficients",
        problem="A warm panel in a room, and one outdoors in a wind of 4 m/s at 10 m; the coefficient"
        " is the simulated flux over the simulated temperature difference.",
        answer="each correlation at that difference and wind",
        source="Alamdari & Hammond 1983, doi:10.1177/014362448300400304; Walton 1983, NBSSIR 83-2655; "
        "Yazdanian & Klems 1994; Guichard et al., eq. 5 as printed",
        tolerance="The smoothing of |dT| within 0.01 K, (0.01/dT)^2/2, and 1e-6 K of Newton's iteration.",
        topics=("building",),
        work=_correlations,
    ),
)
