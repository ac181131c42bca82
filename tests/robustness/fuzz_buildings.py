"""Random valid buildings, and what must hold for every one of them.

From a random description to a plan and a run: records are finite, the energy balance closes, a member of
an ensemble has the bits of a run alone, the order of objects in the file changes nothing but rounding, and
backward Euler obeys the maximum principle: without sources no temperature leaves the range of those that
drive it.
"""

from __future__ import annotations

import random
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from mascarin.building import Building
from mascarin.errors import InputError, SolverError
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate

HOURS = 49
STEP = "30min"
CLOSED = 1e-10
#: Processor time for a simulated day. [s]
SLOWEST = 5.0


def climate() -> Climate:
    """Two days without sun at 48 N, hourly."""
    index = pd.date_range("2001-01-01", periods=HOURS, freq="1h", tz="UTC")
    day = 2.0 * np.pi * np.arange(HOURS) / 24.0
    frame = pd.DataFrame(
        {
            "air_temperature": 10.0 - 8.0 * np.cos(day - 0.6),
            "dew_point": 4.0 + np.sin(day / 3.0),
            "cloud_cover": 5.0 + 3.0 * np.sin(day / 2.0),
            "wind_speed": 3.0 - np.cos(day),
            "wind_direction": 40.0 + 30.0 * np.sin(day / 2.0),
        },
        index=index,
    )
    return Climate.from_table(
        frame,
        timezone="UTC",
        columns={str(name): str(name) for name in frame},
        absent=["global_horizontal", "diffuse_horizontal", "direct_normal"],
        instant=[str(name) for name in frame],
    )


@dataclass
class Ways:
    """Which parts a random building may have."""

    melting: bool = True
    plant: bool = True
    windows: bool = True
    #: Only heat between temperatures: the maximum principle holds.
    passive: bool = False


def description(draw: random.Random, ways: Ways) -> dict[str, Any]:
    """A valid building: one to three zones in a row, each with a floor, a roof and a facade."""
    zones = [f"z{k}" for k in range(draw.choice((1, 1, 2, 3)))]
    tree: dict[str, Any] = {
        "site": {"latitude": 48, "longitude": 2, "altitude": 100, "timezone": "UTC"},
        "materials": {
            "heavy": solid(draw),
            "light": solid(draw),
            "gap": {"kind": "resistance", "resistance": 0.15},
        },
        "constructions": {},
        "zones": {zone: {"volume": round(draw.uniform(5.0, 300.0), 3)} for zone in zones},
        "surfaces": {},
    }
    names = ["heavy", "light"]
    if ways.melting and draw.random() < 0.6:
        tree["materials"]["wax"] = melting(draw)
        names.append("wax")
    for k in range(draw.choice((1, 2, 3))):
        layers = [layer(draw, draw.choice(names), f"l{n}") for n in range(draw.choice((1, 1, 2, 3)))]
        if len(layers) > 1 and draw.random() < 0.3:
            layers.insert(1, {"material": "gap", "name": "air"})
        tree["constructions"][f"c{k}"] = {"layers": layers}
    for at, zone in enumerate(zones):
        outside = passive_outside if ways.passive else outdoors
        surfaces, walls = tree["surfaces"], list(tree["constructions"])
        surfaces[f"{zone}_floor"] = {
            "construction": draw.choice(walls), "area": 12.0, "tilt": 180, "outside": draw.choice((
                {"adiabatic": True}, {"ground": {"temperature": 9}})), "inside": inside(draw, zone),
        }  # fmt: skip
        surfaces[f"{zone}_roof"] = {
            "construction": draw.choice(walls), "area": 12.0, "tilt": draw.choice((0, 30)), "azimuth": 180,
            "outside": outside(draw), "inside": inside(draw, zone),
        }  # fmt: skip
        surfaces[f"{zone}_wall"] = {
            "construction": draw.choice(walls), "area": round(draw.uniform(3.0, 40.0), 3), "tilt": 90,
            "azimuth": draw.choice((0, 90, 142.7)), "outside": outside(draw), "inside": inside(draw, zone),
        }  # fmt: skip
        if at:
            surfaces[f"{zone}_between"] = {
                "construction": draw.choice(walls), "area": 9.0, "tilt": 90, "azimuth": 90,
                "outside": inside(draw, zones[at - 1]), "inside": inside(draw, zone),
            }  # fmt: skip
        if draw.random() < 0.6:
            tree["zones"][zone]["infiltration"] = round(draw.uniform(0.0, 3.0), 3)
        if ways.plant and not ways.passive and draw.random() < 0.4:
            tree["zones"][zone]["heating"] = {"setpoint": 20, "capacity": draw.choice((50, 500, 5000))}
            tree["zones"][zone]["cooling"] = {"setpoint": draw.choice((20, 24, 26))}
        if not ways.passive and draw.random() < 0.4:
            tree["zones"][zone]["gains"] = {"lamp": {"power": draw.choice((0, 30, 300)), "radiative": 0.4}}
    if ways.windows and not ways.passive and draw.random() < 0.4:
        tree["glazings"] = {"g": _glazing(draw)}
        tree["windows"] = {
            "pane": {"surface": "z0_wall", "glazing": "g", "area": 1.5, "outside": {"convection": 15},
                     "inside": {"convection": 3}},
        }  # fmt: skip
    return tree


def solid(draw: random.Random) -> dict[str, Any]:
    return {
        "conductivity": round(10.0 ** draw.uniform(-1.7, 2.0), 5),
        "density": round(10.0 ** draw.uniform(1.3, 3.9), 2),
        "specific_heat": round(draw.uniform(300.0, 4000.0), 1),
    }


def melting(draw: random.Random) -> dict[str, Any]:
    law = draw.choice(
        (
            {"kind": "tanh", "width": round(10.0 ** draw.uniform(-1.0, 0.5), 3)},
            {"kind": "tanh", "gamma": 0.04, "delta_t": 0.01},
            {"kind": "gaussian", "width": round(10.0 ** draw.uniform(-0.5, 0.5), 3)},
        )
    )
    return {
        "kind": "pcm", "density": 855, "conductivity": [0.22, 0.18], "specific_heat": [3000, 2800],
        "latent_heat": round(10.0 ** draw.uniform(4.0, 5.4)), "law": law,
        "melting_temperature": round(draw.uniform(5.0, 26.0), 2),
    }  # fmt: skip


def layer(draw: random.Random, material: str, name: str) -> dict[str, Any]:
    layer = {"name": name, "material": material, "thickness": round(10.0 ** draw.uniform(-2.5, -0.5), 5)}
    if draw.random() < 0.3:
        layer["nodes"] = draw.choice((1, 2, 5, 30))
    return layer


def inside(draw: random.Random, zone: str) -> dict[str, Any]:
    convection = draw.choice((3.0, 0.5, "tarp", "alamdari_hammond", "iso15099"))
    emissivity = round(draw.uniform(0.05, 0.95), 3)
    return {"zone": zone, "convection": convection, "emissivity": emissivity, "absorptance": 0.6}


def outdoors(draw: random.Random) -> dict[str, Any]:
    return {
        "outdoors": True, "convection": draw.choice((15.0, "doe2", "mowitt", "tarp")),
        "emissivity": round(draw.uniform(0.05, 0.95), 3), "absorptance": round(draw.uniform(0.1, 0.9), 3),
    }  # fmt: skip


def passive_outside(draw: random.Random) -> dict[str, Any]:
    return {
        "outdoors": True,
        "convection": draw.choice((5.0, 15.0)),
        "longwave": "none",
        "emissivity": 0.9,
        "absorptance": 0.5,
    }


def _glazing(draw: random.Random) -> dict[str, Any]:
    pane = {"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}
    return draw.choice(
        (
            {"kind": "panes", "panes": [pane]},
            {"kind": "panes", "panes": [pane, pane], "gaps": [{"thickness": 0.012, "gas": "argon"}]},
            {"kind": "simple", "u_value": 1.8, "solar_heat_gain": 0.6},
        )
    )


@dataclass
class Found:
    """What became of random buildings."""

    buildings: int = 0
    runs: int = 0
    refused: int = 0
    unsolved: int = 0
    slow: int = 0
    largest_closure: float = 0.0
    faults: list[str] = field(default_factory=list)

    def add(self, other: Found) -> None:
        """Count the buildings of another one, too."""
        self.buildings += other.buildings
        self.runs += other.runs
        self.refused += other.refused
        self.unsolved += other.unsolved
        self.slow += other.slow
        self.largest_closure = max(self.largest_closure, other.largest_closure)
        self.faults += other.faults


def check(
    tree: dict[str, Any], weather: Climate, draw: random.Random, found: Found, *, passive: bool
) -> None:
    """Run a building in all ways and collect what does not hold.

    Raises
    ------
    AssertionError
        Never: faults are collected in `found`, each with the description that shows it.
    """
    found.buildings += 1
    began = time.process_time()
    try:
        _check(tree, weather, draw, found, passive=passive)
    except InputError:
        found.refused += 1
    except SolverError:
        found.unsolved += 1
    except Exception as error:
        found.faults.append(f"{error!r}: {tree!r}")
    # Six runs of two days.
    found.slow += time.process_time() - began > SLOWEST * 2.0 * 6.0


def _check(
    tree: dict[str, Any], weather: Climate, draw: random.Random, found: Found, *, passive: bool
) -> None:
    building = Building.from_dict(tree)
    options: dict[str, Any] = {"step": STEP}
    if passive:
        options |= {"scheme": "backward-euler", "initial": 12.0}
    simulation = Simulation(building, weather, **options)
    alone = simulation.run()
    found.runs += 1
    problems = []
    if not np.isfinite(alone.records).all():
        problems.append("records that are not finite")
    closure = float(alone.energy.closure)
    found.largest_closure = max(found.largest_closure, closure)
    flagged = any("balance" in line for line in alone.warnings)
    if not closure <= CLOSED and not flagged:
        problems.append(f"a relative energy-balance residual of {closure:.3g} without a warning")
    members = draw.choice((2, 9))
    records, _, failures = simulation.ensemble(np.tile(simulation.values, (members, 1)))
    found.runs += members
    if failures or not all((one == alone.records).all() for one in records):
        problems.append(f"members of an ensemble of {members} that differ from a run alone")
    other = Simulation(Building.from_dict(shuffled(tree, draw)), weather, **options).run()
    found.runs += 1
    names = [output.name for output in alone.outputs]
    place = [[output.name for output in other.outputs].index(name) for name in names]
    off = float(np.abs(other.records[:, place] - alone.records).max())
    if off > ORDER:
        problems.append(f"another order of the objects that changes the records by {off:.3g}")
    if not passive:
        problems += _linearly_implicit(building, weather)
        found.runs += 2
    if passive:
        air = weather.data["air_temperature"]
        low, high = min(float(air.min()), 9.0, 12.0), max(float(air.max()), 9.0, 12.0)
        degrees = alone.records[:, [k for k, output in enumerate(alone.outputs) if output.unit == "degC"]]
        if degrees.min() < low - MAXIMUM or degrees.max() > high + MAXIMUM:
            problems.append(
                f"temperatures from {degrees.min():.9g} to {degrees.max():.9g} where all that drives them is "
                f"from {low:.9g} to {high:.9g}"
            )
    found.faults += [f"{problem}: {tree!r}" for problem in problems]


def _linearly_implicit(building: Building, weather: Climate) -> list[str]:
    """What does not hold in a run with one linear solve a stage, beside the run of the default scheme.

    Both begin at one temperature. Periodic starts end where a repetition changes little: two of a building
    of very heavy walls were 0.16 K apart, while the schemes agree within 1e-8 K from one start.
    """
    options: dict[str, Any] = {"step": STEP, "initial": START}
    alone = Simulation(building, weather, **options).run()
    run = Simulation(building, weather, scheme="linearly-implicit", **options).run()
    if not np.isfinite(run.records).all():
        return ["records of the linearly implicit scheme that are not finite"]
    problems = []
    if not run.energy.closure <= CLOSED and not any("balance" in line for line in run.warnings):
        problems.append(f"linearly implicit: a relative energy-balance residual of {run.energy.closure:.3g}")
    airs = [k for k, output in enumerate(run.outputs) if output.kind == "air_temperature"]
    off = run.records[:, airs] - alone.records[:, airs]
    rms = float(np.sqrt(np.mean(off**2, axis=0)).max())
    if rms > NEAR:
        problems.append(f"linearly implicit: airs that differ from the default scheme by {rms:.3g} K (rms)")
    return problems


#: Temperature that runs of both schemes begin at. [degC]
START = 18.0
#: Airs of the linearly implicit scheme beside the default one, root mean square. [K]
NEAR = 0.1
#: Records of the same building in another order: the solver stops at other residuals. [K]
ORDER = 1e-3
#: Residuals of the solver, by which a temperature can pass a limit. [K]
MAXIMUM = 1e-6


def shuffled(tree: dict[str, Any], draw: random.Random) -> dict[str, Any]:
    """The same building with its objects in another order; layers keep theirs."""
    whole = {}
    for part in draw.sample(list(tree), len(tree)):
        content = tree[part]
        if part in ("materials", "constructions", "zones", "surfaces") and isinstance(content, dict):
            content = {name: content[name] for name in draw.sample(list(content), len(content))}
        whole[part] = content
    return whole


def one(n: int, seed: int, weather: Climate) -> Found:
    """Check one random building; it depends on the seed and n only."""
    draw, found = random.Random(f"building {seed} {n}"), Found()
    passive = draw.random() < 0.3
    ways = Ways(melting=not passive, passive=passive)
    check(description(draw, ways), weather, draw, found, passive=passive)
    return found


def run(count: int, seed: int) -> Found:
    """Check random buildings."""
    found, weather = Found(), climate()
    for n in range(count):
        found.add(one(n, seed, weather))
    return found
