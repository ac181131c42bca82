"""Solar transmittance and reflectance of a blind of slats, from the radiation between two of them."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from mascarin.energyplus.model.geometry import Array

#: Strips of each side of a slat, and the profile angles of the sun of which the mean is taken [deg].
_STRIPS: Final = 6
_PROFILES: Final = (10, 20, 30, 40, 50, 60, 70)


def slats(width: float, separation: float, angle: float, front: float, back: float) -> tuple[float, float]:
    """Transmittance and reflectance from outside: the mean of those of the sky and of the sun.

    Two slats and the openings between them are an enclosure in two dimensions; its view factors are those of
    crossed strings, its radiation diffuse (ISO 15099:2003, 7.3).

    Parameters
    ----------
    width, separation : float
        Width of the slats, and distance between two of them. [m]
    angle : float
        Between the outward normals of glass and slat: 90 where slats are horizontal. [deg]
    front, back : float
        Solar reflectance of the side that faces outwards or up, and of the other. [-]

    Returns
    -------
    tuple of (float, float)
        Transmittance and reflectance. [-]
    """
    tilt = math.radians(min(max(angle, 1.0), 179.0))
    # Outwards and up; the lower slat begins at the origin, inside.
    along = np.array([math.sin(tilt), -math.cos(tilt)]) * width
    up = np.array([0.0, separation])
    ends = [along * k / _STRIPS for k in range(_STRIPS + 1)]
    strips = [(ends[k], ends[k + 1]) for k in range(_STRIPS)]
    # The front of the lower slat, the back of the upper one, the outer and the inner opening.
    lines = [*strips, *((a + up, b + up) for a, b in strips), (along, along + up), (up * 0.0, up)]
    views = np.array([[_view(line, other_line) for other_line in lines] for line in lines])
    np.fill_diagonal(views, 0.0)
    reflectance = np.array([front] * _STRIPS + [back] * _STRIPS)
    inner, outer = 2 * _STRIPS + 1, 2 * _STRIPS
    between = views[:outer, :outer]
    lengths = np.array([np.linalg.norm(b - a) for a, b in lines[:outer]])

    def passed(source: Array, through: float) -> tuple[float, float]:
        """What leaves by the inner and the outer opening for a source of radiosity, over the opening."""
        radiosity = np.linalg.solve(np.eye(outer) - reflectance[:, None] * between, source)
        leaving = lengths * radiosity / separation
        return through + float(leaving @ views[:outer, inner]), float(leaving @ views[:outer, outer])

    results = [passed(reflectance * views[:outer, outer], float(views[outer, inner]))]
    beams = []
    for profile in _PROFILES:
        height = math.radians(profile)
        facing = math.cos(tilt - height)
        open_share = max(1.0 - width * abs(facing) / (separation * math.cos(height)), 0.0)
        source = np.zeros(outer)
        lit_width = min(separation * math.cos(height) / max(abs(facing), 1e-9), width)
        shares = [
            min(max((lit_width - k * width / _STRIPS) / (width / _STRIPS), 0.0), 1.0) for k in range(_STRIPS)
        ]
        # The sun falls on the strips from the outer edge on.
        shares.reverse()
        first = 0 if facing > 0.0 else _STRIPS
        part = np.array(shares) * width / _STRIPS
        caught = (1.0 - open_share) * separation
        source[first : first + _STRIPS] = caught * np.array(shares) / max(float(part.sum()), 1e-9)
        beams.append(passed(reflectance * source, open_share))
    results.append((float(np.mean([b[0] for b in beams])), float(np.mean([b[1] for b in beams]))))
    through, back_out = np.mean(np.array(results), axis=0)
    return float(min(through, 1.0)), float(min(back_out, 1.0 - through))


def _view(line: tuple[Array, Array], other_line: tuple[Array, Array]) -> float:
    """View factor between two lines by crossed strings; 0 for lines that lie in one."""
    (a, b), (c, d) = line, other_line
    size = float(np.linalg.norm(b - a))
    crossed = float(np.linalg.norm(a - d) + np.linalg.norm(b - c))
    straight = float(np.linalg.norm(a - c) + np.linalg.norm(b - d))
    return abs(crossed - straight) / (2.0 * size)
