"""What the border of a unit for co-simulation costs: steps of a unit beside the steps of a run.

The LGI cell over 92 days. A small loop in C drives the library of the unit, as an importing program does: one
call for each step, and one that reads all outputs. Beside it the same run in one call of the engine. The
processor time of start and steps counts, without reading the unit. Both are measured in turn; the medians are
compared.

    python bench/fmu.py [--times 15]
"""

from __future__ import annotations

import argparse
import ctypes
import shutil
import statistics
import subprocess
import tempfile
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from mascarin.building import load
from mascarin.commands.options.tables import run_inputs
from mascarin.examples import FOLDER
from mascarin.fmu import export
from mascarin.simulation import Simulation

ASKED = 0.05
PERIOD = ("2010-08-01", "2010-11-01")

#: The loop of an importing program.
LOOP = r"""
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
typedef int (*DoStep)(void *, double, double, bool, bool *, bool *, bool *, double *);
typedef int (*Get)(void *, const uint32_t *, size_t, double *, size_t);
int drive(void *unit, DoStep step, Get get, const uint32_t *outputs, size_t count, size_t steps, double dt,
          double *records) {
    bool event, terminate, early;
    double last;
    for (size_t k = 0; k < steps; ++k) {
        int status = step(unit, (double)k * dt, dt, true, &event, &terminate, &early, &last);
        if (status == 0) status = get(unit, outputs, count, records + (k + 1) * count, count);
        if (status != 0) return status;
    }
    return 0;
}
"""


def cell() -> Simulation:
    """The LGI cell with its default outputs."""
    building = load(FOLDER / "lgi" / "building.yaml")
    climate, measured = run_inputs(
        building, FOLDER / "lgi" / "study.yaml", None, columns=[], timezone=None, stamps="start"
    )
    return Simulation(building, climate, measurements=measured, start=PERIOD[0], end=PERIOD[1])


class Unit:
    """The library of a unit, driven by the loop in C."""

    def __init__(self, file: Path, folder: Path, steps: int, dt: float) -> None:
        with zipfile.ZipFile(file) as archive:
            archive.extractall(folder)
        root = ET.parse(folder / "modelDescription.xml").getroot()  # noqa: S314 (our own file)
        variables = root.findall("ModelVariables/Float64")
        chosen = [int(v.attrib["valueReference"]) for v in variables if v.get("causality") == "output"]
        self.token = root.attrib["instantiationToken"].encode()
        self.resources = f"{folder / 'resources'}/".encode()
        self.library = ctypes.CDLL(str(next((folder / "binaries").rglob("mascarin.*"))))
        self.library.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p
        self.outputs = (ctypes.c_uint32 * len(chosen))(*chosen)
        self.steps, self.dt = steps, dt
        self.loop = compiled(folder)
        self.records = np.empty((steps + 1, len(chosen)))

    def started(self) -> ctypes.c_void_p:
        """A new instance at its start."""
        none = ctypes.c_void_p(None)
        no = ctypes.c_bool(False)
        unit = ctypes.c_void_p(
            self.library.fmi3InstantiateCoSimulation(
                b"cell",
                self.token,
                self.resources,
                no,
                no,
                no,
                no,
                none,
                ctypes.c_size_t(0),
                none,
                none,
                none,
            )
        )  # fmt: skip
        assert unit.value, "the unit cannot be made"
        zero = ctypes.c_double(0.0)
        assert self.library.fmi3EnterInitializationMode(unit, no, zero, zero, no, zero) == 0
        return unit

    def timed(self) -> float:
        """Processor time of the initialization and all steps. [s]"""
        unit = self.started()
        place = self.records.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        count = ctypes.c_size_t(len(self.outputs))
        before = time.process_time()
        assert self.library.fmi3ExitInitializationMode(unit) == 0
        assert self.library.fmi3GetFloat64(unit, self.outputs, count, place, count) == 0
        status = self.loop.drive(
            unit, self.library.fmi3DoStep, self.library.fmi3GetFloat64, self.outputs, count,
            ctypes.c_size_t(self.steps), ctypes.c_double(self.dt), place,
        )  # fmt: skip
        taken = time.process_time() - before
        assert status == 0
        self.library.fmi3FreeInstance(unit)
        return taken


def compiled(folder: Path) -> ctypes.CDLL:
    """The loop as a library."""
    compiler = shutil.which("cc")
    assert compiler, "cc: not found; install a C compiler"
    (folder / "loop.c").write_text(LOOP, encoding="ascii")
    target = folder / "loop.so"
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", target, folder / "loop.c"], check=True)  # noqa: S603
    return ctypes.CDLL(str(target))


def timed(work: Callable[[], object]) -> float:
    """Processor time. [s]"""
    before = time.process_time()
    work()
    return time.process_time() - before


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--times", type=int, default=15, help="repetitions")
    times = parser.parse_args().times
    simulation = cell()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = folder / "cell.fmu"
        export(simulation, file)
        steps = len(simulation.compiled.forcing)
        unit = Unit(file, folder, steps, simulation.step_seconds)
        run: list[float] = []
        driven: list[float] = []
        for _ in range(times):
            run.append(timed(lambda: simulation.compiled.run(simulation.values)))
            driven.append(unit.timed())
        records, _ = simulation.compiled.run(simulation.values)
        assert np.array_equal(records, unit.records), "the unit gives other numbers than the run"
        size = file.stat().st_size / 2**20
    one, other = statistics.median(run), statistics.median(driven)
    print(f"{steps} steps, {records.shape[1]} outputs, equal to the bit; the unit has {size:.2f} MB")
    print(f"run {1e3 * one:.1f} ms, unit {1e3 * other:.1f} ms: {100.0 * (other / one - 1.0):+.1f} % "
          f"(asked: {100.0 * ASKED:.0f} %), {1e6 * (other - one) / steps:+.2f} us a step")  # fmt: skip
    print(f"smallest: run {1e3 * min(run):.1f} ms, unit {1e3 * min(driven):.1f} ms: "
          f"{100.0 * (min(driven) / min(run) - 1.0):+.1f} %")  # fmt: skip


if __name__ == "__main__":
    main()
