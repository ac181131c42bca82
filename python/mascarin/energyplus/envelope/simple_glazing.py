"""Glazings by U value and solar heat gain, as EnergyPlus makes them: one pane with an angular table.

Procedure: Arasteh, Kohler & Griffith 2009, Modeling windows in EnergyPlus with simple performance indices,
LBNL-2804E (doi:10.2172/975375), steps 1 to 7. The pane has a constant conductance; its angular curves are
those of ten glazings, between which ratings are interpolated.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Final

from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.idf import IdfObject

#: U value above which the resistance inside has another fit [W/(m2 K)].
_SINGLE: Final = 5.85
#: U values between which the fits of the solar properties are interpolated [W/(m2 K)].
_LOW, _HIGH = 3.4, 4.5
#: Least resistance of the pane [m2 K/W].
_LEAST_RESISTANCE: Final = 1e-3
_ANGLES: Final = (*range(0, 80, 10), 75, 80, 83, 86, 88, 90)
_EMISSIVITY: Final = 0.84

#: Powers 1 to 4 of the cosine in the transmittance over that at normal incidence, and in 1 less the
#: transmittance and the reflectance of the curves A to J.
_THROUGH: Final = {
    "A": (3.36, -3.85, 1.49, 0.01), "B": (2.83, -2.42, 0.04, 0.55), "C": (2.45, -1.58, -0.64, 0.77),
    "D": (2.85, -2.58, 0.40, 0.35), "E": (1.51, 2.49, -5.87, 2.88), "F": (1.21, 3.14, -6.37, 3.03),
    "G": (1.09, 3.54, -6.84, 3.23), "H": (0.98, 3.83, -7.13, 3.33), "I": (0.79, 3.93, -6.86, 3.15),
    "J": (0.08, 6.02, -8.84, 3.74),
}  # fmt: skip
_BOTH: Final = {
    "A": (-0.70, 2.57, -3.20, 1.33), "B": (-1.87, 6.50, -7.86, 3.23), "C": (-2.52, 8.40, -9.86, 3.99),
    "D": (-1.85, 6.40, -7.64, 3.11), "E": (-1.57, 5.60, -6.82, 2.80), "F": (-3.15, 10.98, -13.14, 5.32),
    "G": (-3.25, 11.32, -13.54, 5.49), "H": (-3.39, 11.70, -13.94, 5.64), "I": (-4.06, 13.55, -15.74, 6.27),
    "J": (-4.35, 14.27, -16.32, 6.39),
}  # fmt: skip
#: Curves whose mean holds, by U value [W/(m2 K)] and then by solar heat gain [-]; linear between both.
_MEANS: Final = (
    (1.4195, ((0.35, "J"), (0.45, "E"))),
    (1.7034, ((0.25, "FH"), (0.30, "FGHI"), (0.50, "FGHI"), (0.55, "E"))),
    (3.4068, ((0.25, "FH"), (0.30, "FGHI"), (0.50, "FGHI"), (0.55, "E"))),
    (4.5424, ((0.30, "D"), (0.45, "BDCD"), (0.60, "BDCD"), (0.65, "A"))),
)  # fmt: skip


def simple_glazing(context: Context, item: IdfObject) -> Section:
    """A glazing by U value and solar heat gain as one pane.

    Parameters
    ----------
    context : Context
        The conversion.
    item : IdfObject
        A ``WindowMaterial:SimpleGlazingSystem``.

    Returns
    -------
    dict
        The glazing of the description.
    """
    u, gain = item.needed("u_factor"), item.needed("solar_heat_gain_coefficient")
    resistance = 1.0 / u - sum(_films(u))
    if resistance < _LEAST_RESISTANCE:
        context.findings.approximated(
            item, f"a U value of {u:g} W/(m2 K)", "a glazing of nearly no resistance of its own"
        )
        resistance = _LEAST_RESISTANCE
    through = min(max(_transmittance(u, gain), 1e-4), 0.99)
    absorbed = min(max((gain - through) / _inward(u, gain - through, resistance), 0.0), 1.0 - through)
    rows = [_optics_at(math.cos(math.radians(angle)), u, gain, (through, absorbed)) for angle in _ANGLES]
    thickness = 0.002 if resistance < 1.0 / 7.0 else 0.05914 - 0.00714 / resistance
    return {
        "kind": "panes",
        "panes": [
            {
                "thickness": round(thickness, 6),
                "conductivity": round(thickness / resistance, 8),
                "emissivity": _EMISSIVITY,
            }
        ],
        "angular": {
            "angles": list(_ANGLES),
            "transmittance": [round(row[0], 6) for row in rows],
            "absorptance": [[round(row[1], 6) for row in rows]],
        },
    }


def _films(u: float) -> tuple[float, float]:
    """Resistances outside and inside in the rating of the U value, in winter. [m2 K/W]"""
    inside = 1.0 / (0.359073 * math.log(u) + 6.949915) if u < _SINGLE else 1.0 / (1.788041 * u - 2.886625)
    return 1.0 / (0.025342 * u + 29.163853), inside


def _between(u: float, low: float, high: float) -> float:
    """What holds below and above two U values, and linear between them."""
    share = min(max((u - _LOW) / (_HIGH - _LOW), 0.0), 1.0)
    return low + share * (high - low)


def _transmittance(u: float, gain: float) -> float:
    """Solar transmittance at normal incidence. [-]"""
    low = 0.41040 * gain if gain < 0.15 else 0.085775 * gain**2 + 0.963954 * gain - 0.084958
    high = 0.939998 * gain**2 + 0.20332 * gain if gain < 0.7206 else 1.30415 * gain - 0.30515
    return _between(u, low, high)


def _inward(u: float, absorbed_gain: float, resistance: float) -> float:
    """Part of what the pane absorbs that enters the room, with the films in summer. [-]"""
    high = 29.436546 * absorbed_gain**3 - 21.943415 * absorbed_gain**2 + 9.945872 * absorbed_gain + 7.426151
    low = 199.8208128 * absorbed_gain**3 - 90.639733 * absorbed_gain**2 + 19.737055 * absorbed_gain + 6.766575
    inside = _between(u, 1.0 / low, 1.0 / high)
    outside = _between(
        u, 1.0 / (5.763355 * absorbed_gain + 20.541528), 1.0 / (2.225824 * absorbed_gain + 20.577080)
    )
    return (outside + 0.5 * resistance) / (outside + resistance + inside)


def _optics_at(cosine: float, u: float, gain: float, normal: tuple[float, float]) -> tuple[float, float]:
    """Transmittance and absorptance at an angle of incidence, from those at normal incidence. [-]"""
    through, absorbed = normal
    if cosine > 1.0 - 1e-12:
        return through, absorbed
    share = _mean(_THROUGH, cosine, u, gain)
    mirrored = 1.0 + _mean(_BOTH, cosine, u, gain) - share
    reflected = 1.0 - through - absorbed
    passed = min(max(through * share, 0.0), 1.0)
    back = min(max(reflected * (1.0 - mirrored) + mirrored, 0.0), 1.0 - passed)
    return (0.0, 0.0) if cosine < 1e-9 else (passed, 1.0 - passed - back)


def _mean(curves: Mapping[str, tuple[float, ...]], cosine: float, u: float, gain: float) -> float:
    """A curve between those of the ratings around a U value and a solar heat gain. [-]"""
    values = {
        name: sum(factor * cosine ** (k + 1) for k, factor in enumerate(factors))
        for name, factors in curves.items()
    }

    def line(points: tuple[tuple[float, float], ...], rating: float) -> float:
        if rating <= points[0][0]:
            return points[0][1]
        for (low, first), (high, second) in pairwise(points):
            if rating <= high:
                return first + (rating - low) / (high - low) * (second - first)
        return points[-1][1]

    rows = tuple(
        (limit, line(tuple((g, sum(values[c] for c in names) / len(names)) for g, names in row), gain))
        for limit, row in _MEANS
    )
    return line(rows, u)
