"""Time and error of case 900 of Standard 140 over a year, on one core, compared with EnergyPlus.

    python bench/bestest_speed.py 725650TYCST.epw [--energyplus PATH] [--repeat 5] [--json FILE]

Mascarin runs the year at 15 min, with hourly results and their evaluation. Times are user and system time,
the shortest of several. What is done once before a year (reading weather and building, position of the sun)
is given separately. EnergyPlus runs the same case, which this program writes, at 15 min and at 1 min; its
time is that of its process minus that of a run of one day. EnergyPlus is no dependency: it is found by
--energyplus or on the PATH, and left out otherwise (bench/energyplus.py says how to get it).

The error of a row is the largest of the errors of the two annual loads and the two peak loads. It is given
relative to the same program at its finest step, which shows numerical errors only, and relative to Mascarin
at 10 s, which includes the differences between the models of the programs.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mascarin.building import load
from mascarin.simulation.simulation import Simulation
from mascarin.verification.bestest.catalogue import CASES
from mascarin.verification.bestest.quantities import HOURS, BestestYear, quantities
from mascarin.verification.bestest.running import outputs
from mascarin.verification.bestest.weather import read
from mascarin.weather import Climate

CASE = CASES["900"]


def main(words: Sequence[str] | None = None) -> None:
    """Measure, and print a table."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("weather", type=Path)
    options.add_argument("--energyplus", default=shutil.which("energyplus"), help="the program")
    options.add_argument("--repeat", type=int, default=5)
    options.add_argument("--json", type=Path, help="file for the rows")
    given = options.parse_args(words)
    rows = mascarin(given.weather, given.repeat)
    if given.energyplus is not None:
        rows += energyplus(Path(given.energyplus), given.weather, given.repeat)
    report(rows)
    if given.json is not None:
        given.json.write_text(json.dumps(rows, indent=2), encoding="utf-8")


Row = dict[str, Any]


def mascarin(weather: Path, repeat: int) -> list[Row]:
    """Runs at 15 min, at 1 min and at 10 s."""
    climate = read(weather)
    return [one_run(climate, step, times) for step, times in (("15min", repeat), ("1min", 1), ("10s", 1))]


def one_run(climate: Climate, step: str, repeat: int) -> Row:
    """Run the year several times; the shortest time."""
    before = time.process_time()
    wanted = sorted(outputs(CASE))
    simulation = Simulation(load(CASE.file), climate, step=step, start="2000-12-31", outputs=wanted)
    ready = time.process_time() - before
    found: dict[str, float] = {}

    def year() -> None:
        results = simulation.run()
        series = {name: np.asarray(results.hourly(name), dtype=np.float64)[-HOURS:] for name in wanted}
        rows = quantities({CASE.name: BestestYear(CASE, series, results.energy.closure)}, CASE)
        found.update({row.quantity: row.value for row in rows})

    seconds = best(year, repeat, time.process_time)
    return {"program": "Mascarin", "step": step, "seconds": seconds, "ready": ready, "loads": found}


def best(work: Callable[[], object], repeat: int, clock: Callable[[], float]) -> float:
    """Shortest time of several. [s]"""
    times = []
    for _ in range(repeat):
        before = clock()
        work()
        times.append(clock() - before)
    return min(times)


def energyplus(program: Path, weather: Path, repeat: int) -> list[Row]:
    """Runs at 15 min and at 1 min, and a run of one day for the start-up time."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        start_up = best(lambda: process(program, weather, folder, 4, days=1), repeat, children)
        rows = []
        for per_hour, step, times in ((4, "15min", repeat), (60, "1min", 1)):
            seconds = best(lambda n=per_hour: process(program, weather, folder, n, days=365), times, children)
            loads = read_loads(folder / "eplusout.eso")
            row = {"program": "EnergyPlus", "step": step, "seconds": seconds - start_up, "ready": start_up}
            rows.append(row | {"loads": loads})
        return rows


def children() -> float:
    """User and system time of the programs that have ended. [s]"""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def process(program: Path, weather: Path, folder: Path, per_hour: int, *, days: int) -> None:
    """Run EnergyPlus once."""
    file = folder / "in.idf"
    file.write_text(idf(per_hour, days), encoding="ascii")
    subprocess.run(  # noqa: S603
        [str(program), "-w", str(weather.resolve()), "-d", str(folder), str(file)],
        check=True,
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )


def read_loads(file: Path) -> dict[str, float]:
    """Annual loads and hourly peaks from an ESO file of two hourly energies [J]."""
    names: dict[str, str] = {}
    values: dict[str, list[float]] = {"heating": [], "cooling": []}
    head, _, data = file.read_text(encoding="latin-1").partition("End of Data Dictionary")
    for line in head.splitlines():
        for kind in values:
            if f"Ideal Loads Zone Sensible {kind.capitalize()} Energy" in line:
                names[line.split(",")[0]] = kind
    for line in data.splitlines():
        fields = line.split(",")
        if fields[0] in names and len(fields) == 2:
            values[names[fields[0]]].append(float(fields[1]))
    hourly = {kind: np.asarray(joules) / 3600.0 for kind, joules in values.items()}
    return {f"annual_{kind}": float(watts.sum()) / 1e6 for kind, watts in hourly.items()} | {
        f"peak_{kind}": float(watts.max()) / 1e3 for kind, watts in hourly.items()
    }


LOADS = ("annual_heating", "annual_cooling", "peak_heating", "peak_cooling")


def report(rows: Sequence[Row]) -> None:
    """Print what was found."""
    heads = ("program", "step", "year [s]", "before [s]", *LOADS, "error, own", "error, Mascarin")
    print("| " + " | ".join(heads) + " |\n" + "|---" * len(heads) + "|")
    finest = {row["program"]: row["loads"] for row in rows}
    for row in rows:
        loads = row["loads"]
        cells = [row["program"], row["step"], f"{row['seconds']:.3f}", f"{row['ready']:.2f}"]
        cells += [f"{loads[word]:.4f}" for word in LOADS]
        for other in (finest[row["program"]], finest["Mascarin"]):
            cells.append(f"{100 * max(abs(loads[word] / other[word] - 1.0) for word in LOADS):.2f} %")
        print("| " + " | ".join(cells) + " |")
    for row in rows:
        if row["program"] == "EnergyPlus":
            ratio = row["seconds"] / rows[0]["seconds"]
            print(f"\nEnergyPlus at {row['step']} takes {ratio:.0f} times as long as Mascarin at 15min")


# ------------------------------------------------------------------ the case for EnergyPlus


def idf(per_hour: int, days: int) -> str:
    """Case 900 for EnergyPlus: TARP inside, DOE-2 outside, beam radiation traced, panes by their optics."""
    last = "12, 31" if days == 365 else "1, 1"
    objects = [
        "Version, 25.2",
        "SimulationControl, No, No, No, No, Yes",
        "Building, case 900, 0, Country, 0.04, 0.004, FullInteriorAndExterior, 25, 6",
        "SurfaceConvectionAlgorithm:Inside, TARP",
        "SurfaceConvectionAlgorithm:Outside, DOE-2",
        "HeatBalanceAlgorithm, ConductionTransferFunction",
        f"Timestep, {per_hour}",
        f"RunPeriod, year, 1, 1, , {last}, , Sunday, No, No, No, No, No",
        "Site:GroundReflectance" + ", 0.2" * 12,
        "Site:GroundReflectance:SnowModifier, 1, 1",
        "GlobalGeometryRules, LowerLeftCorner, Counterclockwise, World",
        "ScheduleTypeLimits, any",
        *(f"Schedule:Constant, {name}, any, {value}" for name, value in (
            ("always", 1), ("heat", 20), ("cool", 27), ("dual", 4))),
        *_fabric(),
        "Zone, room, 0, 0, 0, 0, 1, 1, 2.7, 129.6",
        *_walls(),
        *(f"FenestrationSurface:Detailed, window {k}, Window, glass, south, , , , 1, 4, {_corners(points)}"
          for k, points in enumerate(
              [(x, 0, 0.2), (x + 3, 0, 0.2), (x + 3, 0, 2.2), (x, 0, 2.2)] for x in (0.5, 4.5))),
        "ZoneInfiltration:DesignFlowRate, air, room, always, AirChanges/Hour, , , , 0.5, 1, 0, 0, 0",
        "OtherEquipment, gain, None, room, always, EquipmentLevel, 200, , , 0, 0.6, 0",
        "ZoneControl:Thermostat, control, room, dual, ThermostatSetpoint:DualSetpoint, both",
        "ThermostatSetpoint:DualSetpoint, both, heat, cool",
        "ZoneHVAC:EquipmentConnections, room, list, inlet, , node, outlet",
        "ZoneHVAC:EquipmentList, list, SequentialLoad, ZoneHVAC:IdealLoadsAirSystem, ideal, 1, 1, , ",
        "ZoneHVAC:IdealLoadsAirSystem, ideal, always, inlet, , , 50, 10, 0.0156, 0.0077, NoLimit, , , "
        "NoLimit",
        *(f"Output:Variable, *, Zone Ideal Loads Zone Sensible {kind} Energy, Hourly"
          for kind in ("Heating", "Cooling")),
    ]  # fmt: skip
    return ";\n".join(objects) + ";\n"


def _fabric() -> list[str]:
    solids = (
        ("siding", "Rough", 0.009, 0.14, 530, 900),
        ("foam", "Rough", 0.0615, 0.04, 10, 1400),
        ("block", "Rough", 0.100, 0.51, 1400, 1000),
        ("slab", "Rough", 0.080, 1.13, 1400, 1000),
        ("deck", "Rough", 0.019, 0.14, 530, 900),
        ("quilt", "Rough", 0.1118, 0.04, 12, 840),
        ("plasterboard", "Rough", 0.010, 0.16, 950, 840),
    )
    return [
        *(f"Material, {', '.join(map(str, row))}, 0.9, 0.6, 0.6" for row in solids),
        "Material:NoMass, underfloor, Rough, 25.175, 0.9, 0.6, 0.6",
        "WindowMaterial:Glazing, pane, SpectralAverage, , 0.003048, 0.834, 0.075, 0.075, 0.834, 0.075, "
        "0.075, 0, 0.84, 0.84, 1.0, 1, No",
        "WindowMaterial:Gas, gap, Air, 0.012",
        "Construction, wall, siding, foam, block",
        "Construction, floor, underfloor, slab",
        "Construction, roof, deck, quilt, plasterboard",
        "Construction, glass, pane, gap, pane",
    ]


Point = tuple[float, float, float]


def _walls() -> list[str]:
    corners = [(0, 0), (8, 0), (8, 6), (0, 6)]
    found = []
    for k, name in enumerate(("south", "east", "north", "west")):
        (x0, y0), (x1, y1) = corners[k], corners[(k + 1) % 4]
        points = [(x0, y0, 0), (x1, y1, 0), (x1, y1, 2.7), (x0, y0, 2.7)]
        found.append(_surface(name, "Wall", "wall", "SunExposed, WindExposed", points))
    found.append(_surface("roof", "Roof", "roof", "SunExposed, WindExposed", [(*p, 2.7) for p in corners]))
    below = [(*corners[k], 0) for k in (0, 3, 2, 1)]
    found.append(_surface("floor", "Floor", "floor", "NoSun, NoWind", below))
    return found


def _surface(name: str, kind: str, construction: str, exposure: str, points: Sequence[Point]) -> str:
    ends = f"room, , Outdoors, , {exposure}, autocalculate, 4, {_corners(points)}"
    return f"BuildingSurface:Detailed, {name}, {kind}, {construction}, {ends}"


def _corners(points: Sequence[Point]) -> str:
    return ", ".join(str(c) for point in points for c in point)


if __name__ == "__main__":
    main()
