"""A daily sinusoid at steps of an hour and less against closed forms: amplitude, delay, order in the step.

Wall: a half-space behind a surface coefficient, with the admittance ``e sqrt(i w)`` of the effusivity ``e``.
Zone: air of a heat capacity with infiltration and such a wall. Load: the transmission matrix of a slab
between two surface coefficients (Carslaw & Jaeger 1959, Conduction of heat in solids, chapter 3), as the mean
over the step that ends at the time of a record.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.simulation.preparation.options import Scheme
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate

PERIOD = 86400.0
W = 2.0 * math.pi / PERIOD
K, RHO, C = 1.75, 2240.0, 900.0
ADMITTANCE = math.sqrt(K * RHO * C) * cmath.sqrt(1j * W)
OUTSIDE, INSIDE, AREA, SLAB = 15.0, 3.0, 10.0, 0.2
AIR_CAPACITY, AIR_FLOW = 1.2 * 1000.0 * 100.0 * 5.0, 1.2 * 1000.0 * 100.0 / 3600.0
DAYS = 20


def climate(step: float) -> Climate:
    """Outdoor air of 20 degC + 10 K cos(w t)."""
    seconds = step * np.arange(round(DAYS * PERIOD / step) + 1)
    index = pd.date_range("2001-01-01", periods=len(seconds), freq=f"{step:g}s", tz="UTC")
    frame = pd.DataFrame({"air_temperature": 20.0 + 10.0 * np.cos(W * seconds)}, index=index)
    absent = ["wind_speed", "wind_direction", "dew_point", "global_horizontal", "diffuse_horizontal",
              "direct_normal"]  # fmt: skip
    return Climate.from_table(
        frame, timezone="UTC", columns={"air_temperature": "air_temperature"}, instant=["air_temperature"],
        absent=absent,
    )  # fmt: skip


def building(thickness: float, outside: dict[str, Any], inside: dict[str, Any], **zone: Any) -> Building:
    wall = {
        "construction": "wall", "area": AREA, "tilt": 90, "azimuth": 180, "outside": outside,
        "inside": inside,
    }  # fmt: skip
    return Building.from_dict(
        {
            "site": {
                "latitude": 48, "longitude": 0, "altitude": 0, "timezone": "UTC", "air_density": 1.2,
                "air_specific_heat": 1000.0,
            },
            "materials": {"concrete": {"conductivity": K, "density": RHO, "specific_heat": C}},
            "constructions": {"wall": {"layers": [{"material": "concrete", "thickness": thickness}]}},
            "surfaces": {"wall": wall},
            **({"zones": {"room": {"volume": 100, "longwave": "none", **zone}}} if zone else {}),
        }
    )  # fmt: skip


OUTDOORS = {
    "outdoors": True, "convection": OUTSIDE, "emissivity": 0.9, "longwave": "none",
    "exposure": {"sun": False},
}  # fmt: skip
ROOM = {"zone": "room", "convection": INSIDE, "emissivity": 0.9}


def response(case: Building, output: str, step: float, scheme: Scheme = "sdirk2") -> complex:
    """Complex amplitude of an output per kelvin of the outdoor air, from the last five days."""
    run = Simulation(case, climate(step), step=step, scheme=scheme, initial=20.0, outputs=[output]).run()
    seconds = (run.index.tz_convert("UTC") - pd.Timestamp("2001-01-01", tz="UTC")).total_seconds().to_numpy()
    last = (seconds > seconds[-1] - 5.0 * PERIOD + 1.0) & (seconds <= seconds[-1] + 1.0)
    columns = np.column_stack([np.ones(last.sum()), np.cos(W * seconds[last]), np.sin(W * seconds[last])])
    _, cosine, sine = np.linalg.lstsq(columns, run.records[last, 0], rcond=None)[0]
    return complex(cosine, -sine) / 10.0


def error(found: complex, exact: complex) -> tuple[float, float]:
    """Relative error of the amplitude [%], and how much later it is [min]."""
    ratio = found / exact
    return 100.0 * (abs(ratio) - 1.0), -cmath.phase(ratio) / W / 60.0


def slab() -> complex:
    """Heat load per kelvin of the outdoor air at a constant room temperature. [W/K]"""
    root = SLAB * cmath.sqrt(1j * W * RHO * C / K)
    across = cmath.sinh(root) / ADMITTANCE
    # Temperature difference per heat flow: both surface coefficients and the slab in a row.
    through = (
        across
        + cmath.cosh(root) * (1.0 / OUTSIDE + 1.0 / INSIDE)
        + ADMITTANCE * cmath.sinh(root) / (OUTSIDE * INSIDE)
    )
    return -AREA / through


def mean_over_step(step: float) -> complex:
    """Mean of exp(i w t) over the step that ends at 0."""
    return (1.0 - cmath.exp(-1j * W * step)) / (1j * W * step)


def test_the_surface_of_a_thick_wall() -> None:
    case = building(1.9, OUTDOORS, {"adiabatic": True})
    exact = OUTSIDE / (OUTSIDE + ADMITTANCE)
    for step, amplitude, minutes in ((3600.0, 0.8, 3.0), (900.0, 0.3, 1.5)):
        off = error(response(case, "wall.outside_temperature", step), exact)
        assert abs(off[0]) < amplitude, (step, off)
        assert abs(off[1]) < minutes, (step, off)


def test_the_air_of_a_zone_with_capacity() -> None:
    case = building(1.9, {"adiabatic": True}, ROOM, infiltration=1.0, capacity_factor=5)
    wall = 1.0 / (1.0 / INSIDE + 1.0 / ADMITTANCE)
    exact = AIR_FLOW / (AIR_FLOW + AREA * wall + 1j * W * AIR_CAPACITY)
    for step, amplitude, minutes in ((3600.0, 0.4, 0.5), (900.0, 0.1, 0.1)):
        off = error(response(case, "room.air_temperature", step), exact)
        assert abs(off[0]) < amplitude, (step, off)
        assert abs(off[1]) < minutes, (step, off)
    # Backward Euler has first order.
    slow = [
        error(response(case, "room.air_temperature", step, "backward-euler"), exact)
        for step in (3600.0, 1800.0)
    ]
    assert slow[0][0] == pytest.approx(-4.9, abs=0.2)
    assert slow[0][1] == pytest.approx(-11.6, abs=0.5)
    assert slow[0][0] / slow[1][0] == pytest.approx(2.0, abs=0.2)


def test_an_ideal_load_has_first_order() -> None:
    case = building(SLAB, OUTDOORS, ROOM, heating={"setpoint": 40})
    off = {
        step: error(response(case, "room.heating_load", step), slab() * mean_over_step(step))
        for step in (3600.0, 1800.0, 900.0)
    }
    assert off[3600.0][0] == pytest.approx(-2.2, abs=0.2)
    assert off[3600.0][1] == pytest.approx(-4.8, abs=0.4)
    assert off[900.0][0] == pytest.approx(-0.45, abs=0.1)
    assert off[900.0][1] == pytest.approx(-1.1, abs=0.2)
    assert 1.7 < off[3600.0][0] / off[1800.0][0] < 2.9
    # Against the load at the end of the step the mean over it is half a step late, and this outweighs it.
    late = error(response(case, "room.heating_load", 3600.0), slab())
    assert late[1] == pytest.approx(25.2, abs=0.5)
