"""Units for co-simulation in the tests: their buildings, and an instance that keeps its messages."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi3 import FMU3Slave
from numpy.typing import NDArray

from mascarin.building import Building
from mascarin.examples import clear_days
from mascarin.simulation import Simulation
from mascarin.weather import Climate

Array = NDArray[np.float64]

HOUR = 3600.0


def heated(folder: Path) -> Building:
    """A room with a schedule of its set point, gains and ventilation, and a second zone above it."""
    text = """\
name: heated
site: {latitude: 45, longitude: 5, altitude: 200, timezone: UTC, diffuse: hay_davies, sky: {kind: offset}}
materials: {brick: {conductivity: 0.8, density: 1700, specific_heat: 850}}
constructions: {wall: {layers: [{material: brick, thickness: 0.2}]}}
schedules:
  at_home: {kind: fraction, days: {all: [{at: "00:00", value: 1}, {at: "07:00", value: 0.25},
                                         {at: "18:00", value: 0.75}]}}
  warm: {kind: temperature, days: {all: [{at: "00:00", value: 17}, {at: "06:00", value: 20.5}]}}
zones:
  room: {volume: 50, infiltration: 0.5, gains: {people: {power: 200, schedule: at_home}},
         heating: {setpoint: {schedule: warm}}, cooling: {setpoint: 26}}
surfaces:
  wall: {construction: wall, area: 40, tilt: 90, azimuth: 180,
         outside: {outdoors: true, convection: 20, emissivity: 0.9, absorptance: 0.6},
         inside: {zone: room, convection: 3, emissivity: 0.9}}
"""
    file = folder / "heated.yaml"
    file.write_text(text, encoding="utf-8")
    return Building.from_yaml(file)


def winter() -> Climate:
    """Three cold clear days."""
    return clear_days(45, 5, timezone="UTC", start="2024-01-10", days=3, mean=2, swing=4, altitude=200)


class Unit:
    """An instance of version 3.0, driven call by call.

    Attributes
    ----------
    heard : list of (int, str)
        Status and text of its messages.
    """

    def __init__(self, file: Path, folder: Path) -> None:
        self.described = fmpy.read_model_description(str(file))
        self.references = {v.name: v.valueReference for v in self.described.modelVariables}
        self.heard: list[tuple[int, str]] = []
        self.slave = FMU3Slave(
            guid=self.described.guid,
            unzipDirectory=fmpy.extract(str(file), str(folder)),
            modelIdentifier="mascarin",
            instanceName="unit",
        )

    def hear(self, _environment: Any, status: int, _category: bytes, message: bytes) -> None:
        self.heard.append((status, message.decode()))

    def start(self, at: float = 0.0, stop: float | None = None, **values: float) -> None:
        self.slave.instantiate(loggingOn=True, logMessage=self.hear)
        self.slave.enterInitializationMode(startTime=at, stopTime=stop)
        self.set(values)
        self.slave.exitInitializationMode()

    def set(self, values: Mapping[str, float]) -> None:
        if values:
            self.slave.setFloat64([self.references[name] for name in values], list(values.values()))

    def get(self, *names: str) -> list[float]:
        found: list[float] = self.slave.getFloat64([self.references[name] for name in names])
        return found

    def run(self, names: list[str], first: int, last: int, step: float) -> Array:
        """Steps from one to another; the outputs after each."""
        rows = []
        for k in range(first, last):
            self.slave.doStep(k * step, step)
            rows.append(self.get(*names))
        return np.array(rows)

    def saved(self) -> bytes:
        """The present state as bytes."""
        state = self.slave.getFMUState()
        found = bytes(self.slave.serializeFMUState(state))
        self.slave.freeFMUState(state)
        return found

    def restore(self, state: bytes) -> None:
        kept = self.slave.deserializeFMUState(state)
        self.slave.setFMUState(kept)
        self.slave.freeFMUState(kept)


@contextmanager
def instance(file: Path) -> Iterator[Unit]:
    """An instance that is given back."""
    with tempfile.TemporaryDirectory() as folder:
        unit = Unit(file, Path(folder))
        try:
            yield unit
        finally:
            if getattr(unit.slave, "component", None):
                unit.slave.fmi3FreeInstance(unit.slave.component)


def simulated(file: Path, simulation: Simulation, **options: Any) -> Array:
    """Outputs over the period as FMPy records them, shape (rows, outputs)."""
    names = [output.name for output in simulation.outputs]
    dt = simulation.step_seconds
    found = fmpy.simulate_fmu(
        str(file),
        output=names,
        output_interval=dt,
        stop_time=dt * len(simulation.compiled.forcing),
        **options,
    )
    return np.stack([found[name] for name in names], axis=-1)


def undefined_symbols(library: bytes) -> bool:
    """Whether a library names functions of Python."""
    return b"PyObject" in library or b"PyErr_" in library or b"Py_Initialize" in library
