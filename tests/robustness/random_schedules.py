"""Random schedules, made when something of a random building needs one."""

from __future__ import annotations

from typing import Any

from mascarin.building.parts.air.schedule import DAYS
from random_draw import Draw, four

Json = dict[str, Any]

#: Measured columns by what they mean, with the lowest and the highest value that `random_weather` gives them.
COLUMNS: dict[str, tuple[float, float]] = {
    "T_a": (-15.0, 40.0),  # temperatures of surroundings [degC]
    "T_b": (5.0, 30.0),
    "T_low": (12.0, 19.0),  # set points [degC]
    "T_high": (24.0, 31.0),
    "T_held": (17.0, 27.0),
    "P_heater": (0.0, 2500.0),  # [W]
    "P_kilo": (-0.5, 1.5),  # [kW]
    "Q_fan": (0.0, 200.0),  # [m3/h]
    "n_fan": (0.0, 40.0),  # [1/h]
    "q_foil": (-15.0, 30.0),  # [W/m2]
    "G_wall": (0.0, 900.0),  # [W/m2]
    "G_pane": (0.0, 900.0),
    "h_film": (0.5, 25.0),  # [W/(m2 K)]
    "rain": (0.0, 4.0),  # [mm/h]
    "vapour": (0.0, 300.0),  # [g/h]
    "phi_high": (55.0, 75.0),  # [%]
    "phi_low": (20.0, 45.0),
    "w_high": (9.0, 13.0),  # [g/kg]
    "w_low": (2.0, 6.0),
    "open": (0.0, 1.0),  # fractions [-]
    "f_high": (0.5, 0.8),
    "f_low": (0.2, 0.45),
    "x_high": (0.008, 0.013),  # [kg/kg]
    "x_low": (0.001, 0.006),
}

#: Range of the values of a schedule by its purpose: kind, lowest, highest, column.
PURPOSES: dict[str, tuple[str, float, float, str]] = {
    "on": ("fraction", 0.0, 1.0, "open"),
    "warm": ("temperature", 12.0, 20.0, "T_low"),
    "cool": ("temperature", 23.0, 30.0, "T_high"),
    "around": ("temperature", -20.0, 45.0, "T_a"),
    "damp": ("fraction", 0.5, 0.8, "f_high"),
    "dry": ("fraction", 0.2, 0.45, "f_low"),
    "humid": ("humidity_ratio", 0.008, 0.013, "x_high"),
    "arid": ("humidity_ratio", 0.001, 0.006, "x_low"),
}


class Schedules:
    """Schedules of a building by name; each purpose has one or two of them.

    Parameters
    ----------
    draw : Draw
        Random choices.
    """

    def __init__(self, draw: Draw) -> None:
        self._draw = draw
        self.made: Json = {}

    def named(self, purpose: str) -> str:
        """Name of a schedule for a purpose of `PURPOSES`."""
        name = f"{purpose}_{self._draw.whole(0, 1)}"
        if name not in self.made:
            self.made[name] = _schedule(self._draw, purpose)
        return name

    def maybe(self, purpose: str, probability: float) -> Json:
        """``{"schedule": name}``, or nothing."""
        return {"schedule": self.named(purpose)} if self._draw.chance(probability) else {}


def _schedule(draw: Draw, purpose: str) -> Json:
    kind, low, high, column = PURPOSES[purpose]
    way = draw.whole(0, 7)
    if way == 0:
        return {"kind": kind, "value": draw.number(low, high)}
    if way == 1:
        return {"kind": kind, "column": column}
    if way == 2:
        ends = draw.of(["03-31", "10-15", "12-31"], ["06-30", "12-31"])
        seasons = [{"until": end, "days": {"all": _points(draw, low, high)}} for end in ends]
        return {"kind": kind, "seasons": seasons}
    if way == 3:
        days = {"weekdays": _points(draw, low, high), "weekends": _points(draw, low, high)}
    elif way == 4:
        days = {day: _points(draw, low, high) for day in DAYS}
    else:
        days = {"all": _points(draw, low, high)}
    if draw.chance(0.2):
        days["holidays"] = _points(draw, low, high)
        return {"kind": kind, "days": days, "holidays": ["12-25", "01-01", "2024-05-20"]}
    return {"kind": kind, "days": days}


def _points(draw: Draw, low: float, high: float) -> list[Json]:
    """Values of a day: some jump from one end to the other, some have ramps."""
    times = sorted({draw.whole(1, 1439) for _ in range(draw.whole(0, 4))})
    points: list[Json] = []
    for minutes in [0, *times]:
        value = draw.of(low, high, draw.number(low, high))
        point: Json = {"at": f"{minutes // 60:02d}:{minutes % 60:02d}", "value": four(value)}
        if draw.chance(0.25):
            point["ramp_to"] = draw.number(low, high)
        points.append(point)
    return points
