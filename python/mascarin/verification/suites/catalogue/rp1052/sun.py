"""The sun of 21 August on walls, through glass, and behind an overhang, a fin and a reveal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, Tree, simulated
from mascarin.verification.suites.catalogue.rp1052.room import (
    CLOSED,
    LATITUDE,
    LONGITUDE,
    indoors,
    number,
    outdoors,
    room,
    rows,
    weather,
)
from mascarin.verification.suites.verdict import VerdictLine, largest

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

_STEP: Final = "1min"
_MINUTES: Final = 1
_COUNT: Final = 24 * 60 // _MINUTES
#: Middle of each step. [h]
_MIDDLE: Final = (np.arange(_COUNT) + 0.5) * _MINUTES / 60.0
#: Of the peak. [-]
_OF_SUN, _OF_LOAD, _OF_GLASS = 0.02, 0.03, 0.05
#: Of the area of a window. [-]
_OF_OVERHANG, _OF_REVEAL = 0.3 / 9.0, 0.02
_WALLS: Final = {
    "south": (180.0, "Test_ExtSolRad__ASHRAE-ExtSolRad"),
    "east": (90.0, "Test_ExtSolRad__ASHRAE-ExtSolRad-East"),
}
_CONCRETE: Final = ((0.1, 1.15, 1.0, 100.0), (0.1, 1.05, 1.0, 100.0), (0.1, 1.15, 1.0, 100.0))
_PLATE: Final = ((0.1, 1.0, 100.0, 1000.0),)
#: A pane of 3.175 mm.
_GLASS: Final = {
    "thickness": 0.003175, "conductivity": 1.06, "emissivity": 0.84,
    "transmittance": 0.86156, "reflectance": 0.07846,
}  # fmt: skip
_GLASS_FILM: Final = 8.23

#: Corners of a plane. [m]
Corners = Sequence[tuple[float, float, float]]

#: A window of 9 m2 with what stands before it, and one of 4 m2 that is set back by 0.3 m.
_WINDOW: Final[Corners] = ((0, 0, 3), (0, 0, 0), (3, 0, 0), (3, 0, 3))
_OVERHANG: Final[Corners] = ((-10, -0.6, 3), (-10, 0, 3), (13, 0, 3), (13, -0.6, 3))
_FIN: Final[Corners] = ((3, 0, 20), (3, 0, 0), (3, -1, 0), (3, -1, 20))
_SET_BACK: Final[Corners] = ((0.5, 0.3, 2.5), (0.5, 0.3, 0.5), (2.5, 0.3, 0.5), (2.5, 0.3, 2.5))
_REVEAL: Final[Sequence[Corners]] = (
    ((0.5, 0, 2.5), (0.5, 0.3, 2.5), (2.5, 0.3, 2.5), (2.5, 0, 2.5)),
    ((0.5, 0, 0.5), (2.5, 0, 0.5), (2.5, 0.3, 0.5), (0.5, 0.3, 0.5)),
    ((0.5, 0, 0.5), (0.5, 0.3, 0.5), (0.5, 0.3, 2.5), (0.5, 0, 2.5)),
    ((2.5, 0, 0.5), (2.5, 0, 2.5), (2.5, 0.3, 2.5), (2.5, 0.3, 0.5)),
)


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Walls, glass, shadows."""
    climate = _clear_day(data)
    for side in _WALLS:
        yield from _wall(data, climate, side)
    yield from _glass(data, climate)
    free = _incident(data, climate, _WINDOW, ())
    shades: dict[str, Sequence[Corners]] = {
        "overhang and fin": (_OVERHANG, _FIN),
        "overhang": (_OVERHANG,),
        "fin": (_FIN,),
    }
    for column, (name, planes) in enumerate(shades.items(), 2):
        reference = _series(data, "Test_SolRadShade__ASHRAE-Shade-South", 1, column)
        sunlit = _sunlit(_incident(data, climate, _WINDOW, planes), free)
        yield _area(f"SolRadShade south, {name}", 9.0, sunlit, reference, _OF_OVERHANG)
    reference = _series(data, "Test_WinReveal__ASHRAE_Data-Setback", 1, 2)
    behind = _incident(data, climate, _SET_BACK, _REVEAL)
    sunlit = _sunlit(behind, _incident(data, climate, _SET_BACK, ()))
    yield _area("WinReveal south", 4.0, sunlit, reference, _OF_REVEAL)


def _clear_day(data: CaseData) -> Climate:
    """Weather with the clear sky of the toolkit, A exp(-B/sin h), fitted to its irradiance on two walls."""
    import pandas as pd
    from scipy.optimize import least_squares

    from mascarin.weather.derived.sun import SunPath

    origin = pd.Timestamp("2001-08-21", tz="Etc/GMT+5").timestamp()
    path = SunPath.over(LATITUDE, LONGITUDE, origin, origin + 86400.0, origin)
    east, north, up = path.vector(3600.0 * _MIDDLE).T
    parts = []
    for side, (_, file) in _WALLS.items():
        cosine = np.maximum(-north if side == "south" else east, 0.0)
        hour, irradiance = _series(data, file, 0, 5)
        parts.append((np.interp(hour, _MIDDLE, cosine), np.interp(hour, _MIDDLE, up), irradiance))

    def normal(numbers: Array, height: Array) -> Array:
        return np.where(height > 0.0, numbers[0] * np.exp(-numbers[1] / np.maximum(height, 1e-3)), 0.0)

    def errors(numbers: Array) -> Array:
        return np.concatenate([normal(numbers, h) * cosine - measured for cosine, h, measured in parts])

    numbers = least_squares(errors, (1107.0, 0.2)).x
    dark = np.zeros(_COUNT)
    return weather(
        {
            "air_temperature": np.full(_COUNT, 20.0),
            "direct_normal": normal(numbers, up),
            "diffuse_horizontal": dark,
            "global_horizontal": dark,
        },
        step=_STEP,
    )


def _wall(data: CaseData, climate: Climate, side: str) -> Iterator[VerdictLine]:
    azimuth, file = _WALLS[side]
    tree = room(_CONCRETE, outdoors(10.22, 0.4), indoors(), zone={"held": 20.0}, azimuth=azimuth)
    outputs = ["wall.incident_solar", "room.net_load"]
    hours, run = simulated(data.building(tree), climate, outputs, _STEP, 20.0)
    case = f"ExtSolRad {side}"
    middle = hours - 0.5 * _MINUTES / 60.0
    incident = middle, run["wall.incident_solar"].to_numpy()
    yield _of_day(case, "incident sun", "W/m2", incident, _series(data, file, 0, 5), _OF_SUN)
    load = hours, -run["room.net_load"].to_numpy()
    yield _of_day(case, "load", "W", load, _series(data, file, 0, 8), _OF_LOAD)


def _glass(data: CaseData, climate: Climate) -> Iterator[VerdictLine]:
    file = "Test_SolRadGlazing__ASHRAE-SolRadGlazing"
    area = 9.0
    inside = indoors() | {"absorptance": 1.0}
    window = {
        "surface": "wall",
        "glazing": "pane",
        "area": area,
        "outside": {"convection": _GLASS_FILM, "longwave": "none"},
        "inside": {"convection": 3.076},
    }
    tree = room(
        ((0.1, 0.004, 1.0, 100.0),),
        outdoors(_GLASS_FILM),
        inside,
        zone={"held": 20.0, "solar_to_air": 1.0},
        area=area + 0.001,
        azimuth=180.0,
        glazings={"pane": {"kind": "panes", "panes": [dict(_GLASS)]}},
        windows={"window": window},
    )
    outputs = ["window.transmitted_solar", "window.inside_temperature"]
    hours, run = simulated(data.building(tree), climate, outputs, _STEP, 20.0)
    warm = run["window.inside_temperature"].to_numpy() - 20.0
    gain = run["window.transmitted_solar"].to_numpy() + area * 3.076 * warm
    middle = hours - 0.5 * _MINUTES / 60.0
    reference = _series(data, file, 0, 6)
    yield _of_day("SolRadGlazing south", "gain of the window", "W", (middle, gain), reference, _OF_SUN)
    hour, glass = _series(data, file, 0, 1)
    reference = hour, glass - 20.0
    yield _of_day("SolRadGlazing south", "glass above the air", "K", (hours, warm), reference, _OF_GLASS)


def _incident(data: CaseData, climate: Climate, window: Corners, shades: Sequence[Corners]) -> Array:
    """Irradiance of a plane by step (n,). [W/m2]"""
    tree: Tree = room(_PLATE, outdoors(_GLASS_FILM), CLOSED, vertices=window)
    if shades:
        corners = [[list(map(float, corner)) for corner in plane] for plane in shades]
        tree["shades"] = {f"shade{n}": {"vertices": plane} for n, plane in enumerate(corners)}
    _, run = simulated(data.building(tree), climate, ["wall.incident_solar"], _STEP, 20.0)
    incident: Array = run["wall.incident_solar"].to_numpy()[1:]
    return incident


def _sunlit(behind: Array, free: Array) -> Array:
    """Part of a plane that the sun reaches (n,); NaN where the sun is not before it. [-]"""
    sunny = free > 0.5
    return np.where(sunny, behind / np.where(sunny, free, 1.0), np.nan)


def _area(
    case: str, area: float, sunlit: Array, reference: tuple[Array, Array], tolerance: float
) -> VerdictLine:
    hour, expected = reference
    values = area * np.interp(hour, _MIDDLE[: len(sunlit)], sunlit)
    compared = np.isfinite(values) & np.isfinite(expected) & ((expected > 0.0) | (values > 0.0))
    series = hour[compared], values[compared], expected[compared]
    return largest(case, f"sunlit area, worst of {int(compared.sum())}", "m2", series, tolerance * area)


def _of_day(
    case: str,
    quantity: str,
    unit: str,
    values: tuple[Array, Any],
    reference: tuple[Array, Array],
    tolerance: float,
) -> VerdictLine:
    """A series of the day beside that of the toolkit, with a tolerance that is a part of its peak."""
    hour, expected = reference
    series = hour, np.interp(hour, *values), expected
    return largest(
        case, f"{quantity}, worst of {len(hour)}", unit, series, tolerance * float(np.abs(expected).max())
    )


def _series(data: CaseData, file: str, time: int, column: int) -> tuple[Array, Array]:
    """Hours and finite values of a column whose stamps have the form 06:10:00."""
    pairs = []
    for row in rows(data, file):
        if len(row) > column and row[time][:2].isdigit() and row[time][2:3] == ":":
            stamp = float(row[time][:2]) + float(row[time][3:5]) / 60.0
            pairs.append((stamp, number(row[column])))
    table = np.array([pair for pair in pairs if np.isfinite(pair[1])])
    return table[:, 0], table[:, 1]
