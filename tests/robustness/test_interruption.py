"""An interruption acts at once in every phase of the work: within the time of a fixed piece of work.

A timer counts the processor time of this process, and what follows the interruption is compared with a sum in
Python that takes about half a second on a machine of 2024: a slow or busy machine takes longer for both.
"""

from __future__ import annotations

import gc
import json
import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fuzz_buildings import climate
from mascarin.building import Building, check
from mascarin.building.reading import parse
from mascarin.ensemble import sweep
from mascarin.simulation.linear_model import state_space
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.simulation import Simulation

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no timer of processor time")

#: Numbers in the sum that an interruption may take as long as.
NUMBERS = 8_000_000
AIR = "z0.air_temperature"


def blocks(count: int, *, linear: bool = False, nodes: int | None = None) -> dict[str, Any]:
    """Boxes of different heights beside each other, each a zone of six surfaces, which shade each other."""
    layer = {"material": "m", "thickness": 0.2, **({} if nodes is None else {"nodes": nodes})}
    long_wave = {"longwave": "none"} if linear else {}
    zones: dict[str, dict[str, Any]] = {}
    surfaces: dict[str, dict[str, Any]] = {}
    row = math.ceil(math.sqrt(count))
    for k in range(count):
        x, y, high, zone = 6.0 * (k % row), 6.0 * (k // row), 3.0 + 0.3 * (k % 5), f"z{k}"
        ring = [(x, y), (x + 4.0, y), (x + 4.0, y + 4.0), (x, y + 4.0)]
        zones[zone] = {"infiltration": 0.5}
        if linear:
            zones[zone]["longwave"] = {"kind": "linearised", "reference": 20}
        walls = [
            [(*ring[i], 0.0), (*ring[i - 3], 0.0), (*ring[i - 3], high), (*ring[i], high)] for i in range(4)
        ]
        roof, floor = [(*at, high) for at in ring], [(*at, 0.0) for at in reversed(ring)]
        for i, corners in enumerate((*walls, roof, floor)):
            outside: dict[str, Any] = {
                "outdoors": True, "convection": 10 if linear else "doe2", "emissivity": 0.9,
                "absorptance": 0.6, **long_wave,
            }  # fmt: skip
            surfaces[f"s{k}_{i}"] = {
                "construction": "c", "vertices": [list(corner) for corner in corners],
                "outside": {"adiabatic": True} if corners is floor else outside,
                "inside": {"zone": zone, "convection": 3 if linear else "tarp", "emissivity": 0.9},
            }  # fmt: skip
    return {
        "site": {"latitude": 48, "longitude": 2, "altitude": 100, "timezone": "UTC"},
        "materials": {"m": {"conductivity": 0.5, "density": 1500, "specific_heat": 900}},
        "constructions": {"c": {"layers": [layer]}},
        "zones": zones,
        "surfaces": surfaces,
    }  # fmt: skip


@cache
def text() -> str:
    """A large description as YAML."""
    return json.dumps(blocks(200), indent=1)  # JSON is YAML


@cache
def large() -> Building:
    return Building.from_dict(blocks(100))


@cache
def simulation() -> Simulation:
    """Two days in steps of five seconds."""
    return Simulation(Building.from_dict(blocks(9)), climate(), step=5.0, initial=15.0, outputs=[AIR])


def repeated() -> Simulation:
    """A heavy building whose first day, in steps of five seconds, is repeated."""
    tree = blocks(9)
    tree["constructions"]["c"]["layers"] = [{"material": "m", "thickness": 3.0}]
    return Simulation(Building.from_dict(tree), climate(), step=5.0, first_period="1d", outputs=[AIR])


def run_members() -> object:
    samples = {"zones.z0.infiltration.constant": np.linspace(0.1, 1.0, 64)}
    return sweep(Building.from_dict(blocks(9)), climate(), samples, step=10.0, initial=15.0, outputs=[AIR])


def matrices() -> Callable[[], object]:
    building = Building.from_dict(blocks(6, linear=True, nodes=120))
    return lambda: state_space(building)


#: What prepares a phase and gives the call that is interrupted.
PHASES: dict[str, Callable[[], Callable[[], object]]] = {
    "load": lambda: partial(parse, text(), "large.yaml"),
    "check": lambda: partial(check, large()),
    "compile": lambda: partial(Simulation, large(), climate(), step="1h", initial=15.0),
    "warm-up": lambda: repeated().run,
    "run": lambda: simulation().run,
    "ensemble": lambda: run_members,
    "derivatives": lambda: lambda: simulation().jacobian(["zones.z0.infiltration.constant"]),
    "gradient": lambda: lambda: simulation().gradient(Mean(AIR)),
    "state space": matrices,
}


@pytest.fixture
def interrupt() -> Iterator[Callable[[Callable[[], object], float], float]]:
    """Interrupt a call after some processor time; what it takes from then on."""
    signalled: list[float] = []

    def handler(number: int, frame: object) -> None:
        signalled.append(time.process_time())
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGPROF, handler)
    # An exception in a callback of the garbage collector is lost; test tools register one.
    callbacks, gc.callbacks[:] = gc.callbacks[:], []

    def ended(call: Callable[[], object]) -> None:
        try:
            call()
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)

    def stopped(call: Callable[[], object], after: float) -> float:
        # Again and again: Python loses an exception that is raised in a callback of a weak reference.
        signal.setitimer(signal.ITIMER_PROF, after, 0.05)
        with pytest.raises(KeyboardInterrupt):
            ended(call)
        return time.process_time() - signalled[0]

    yield stopped
    signal.setitimer(signal.ITIMER_PROF, 0.0)
    signal.signal(signal.SIGPROF, before)
    gc.callbacks[:] = callbacks


def work() -> float:
    """Processor time of a sum in Python. [s]"""
    start = time.process_time()
    sum(k * k % 7 for k in range(NUMBERS))
    return time.process_time() - start


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("after", [0.02, 0.3])
def test_an_interruption_acts_at_once(
    phase: str, after: float, interrupt: Callable[[Callable[[], object], float], float]
) -> None:
    call = PHASES[phase]()
    taken = interrupt(call, after)
    assert taken < work()


def test_matrices_beyond_the_memory_are_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from mascarin._io import memory
    from mascarin.errors import InputError

    building = Building.from_dict(blocks(6, linear=True, nodes=120))
    monkeypatch.setattr(memory, "available", lambda: 2**28)
    with pytest.raises(InputError, match=r"state_space: matrices of \d+ states would take .* are free"):
        state_space(building)


SIGNAL_DURING_IMPORT = """
import os, sys
import mascarin.__main__ as start

class Sender:
    def find_spec(self, name, path=None, target=None):
        if name == "mascarin.cli":
            os.kill(os.getpid(), {number})

sys.meta_path.insert(0, Sender())
sys.exit(start.main())
"""


@pytest.mark.parametrize(
    ("number", "code", "words"),
    [(signal.SIGINT, 130, "interrupted\n"), (signal.SIGTERM, 143, "terminated\n")],
)
def test_a_signal_while_modules_are_imported_ends_the_command_in_one_line(
    number: signal.Signals, code: int, words: str
) -> None:
    script = SIGNAL_DURING_IMPORT.format(number=int(number))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (code, "", words)
