"""Small GenOpt projects and a simulation program that runs inside the test."""

from __future__ import annotations

import builtins
import io
import math
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from types import CodeType
from typing import IO, Any

import pytest

from mascarin.genopt.program import Program, Result, RunFailed
from mascarin.optimization import Point

HOOKE_JEEVES = """
    Main = GPSHookeJeeves;
    MeshSizeDivider = 2;
    InitialMeshSizeExponent = 0;
    MeshSizeExponentIncrement = 1;
    NumberOfStepReduction = 4;
"""

TWO_CONTINUOUS = """
    Parameter { Name = x1; Min = -1; Ini = 0.9; Max = 1; Step = 0.1; }
    Parameter { Name = x2; Min = -1; Ini = 0.9; Max = 1; Step = 0.1; }
"""

SWARM = """
    NeighborhoodTopology = lbest; NeighborhoodSize = 1; NumberOfParticle = 6; NumberOfGeneration = 4;
    Seed = 1; CognitiveAcceleration = 2.8; SocialAcceleration = 1.3; MaxVelocityGainContinuous = 0.5;
    MaxVelocityDiscrete = 4; ConstrictionGain = 0.5;
"""

# Reads "name = value" lines and writes the sum of squares around 0.3.
PROGRAM = """
import sys
values = dict(line.split(" = ") for line in open(sys.argv[1]).read().splitlines())
cost = sum((float(v) - 0.3) ** 2 for v in values.values())
open("out.txt", "w").write(f"cost= {cost!r}\\n")
open("log.txt", "w").write("fine\\n")
"""


def write_project(
    folder: Path,
    *,
    vary: str = TWO_CONTINUOUS,
    algorithm: str = HOOKE_JEEVES,
    settings: str = "MaxIte = 500; WriteStepNumber = false; UnitsOfExecution = 1;",
    objectives: str = 'Name1 = cost; Delimiter1 = "cost=";',
    template: str = "x1 = %x1%\nx2 = %x2%\n",
    command: str | None = None,
    program: str = PROGRAM,
    files: str = "",
    ini_extra: str = "",
    io_format: str = "Double",
    extension: str = "true",
) -> Path:
    """Write a project whose program is a Python script; the path of its initialization file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "simulate.py").write_text(textwrap.dedent(program), encoding="utf-8")
    (folder / "template.txt").write_text(template, encoding="utf-8")
    python = f'\\"{sys.executable}\\"'.replace("\\\\", "/")
    line = command or f"{python} -I -S ./simulate.py %Simulation.Files.Input.File1%"
    (folder / "sim.cfg").write_text(
        f"""SimulationError {{ ErrorMessage = "Fatal"; }}
IO {{ NumberFormat = {io_format}; }}
SimulationStart {{ Command = "{line}"; WriteInputFileExtension = {extension}; }}
""",
        encoding="utf-8",
    )
    (folder / "command.txt").write_text(
        f"""Vary {{{vary}}}
OptimizationSettings {{ {settings} }}
Algorithm {{{algorithm}}}
""",
        encoding="utf-8",
    )
    default = """
    Input { File1 = in.txt; }
    Log { File1 = log.txt; }
    Output { File1 = out.txt; }"""
    ini = folder / "opt.ini"
    ini.write_text(
        f"""Simulation {{
  Files {{
    Template {{ File1 = template.txt; }}{files or default}
    Configuration {{ File1 = sim.cfg; }}
  }}
  {ini_extra}
  ObjectiveFunctionLocation {{ {objectives} }}
}}
Optimization {{ Files {{ Command {{ File1 = command.txt; }} }} }}
""",
        encoding="utf-8",
    )
    return ini


def in_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the script of a project run inside this process: starting Python takes too long for many runs."""
    scripts: dict[str, CodeType] = {}

    def start(program: Program, folder: Path) -> None:
        words = program.command(folder)
        at = next(i for i, w in enumerate(words) if w.endswith(".py"))
        path = words[at]
        if path not in scripts:
            scripts[path] = compile(Path(path).read_text(encoding="utf-8"), path, "exec")

        opened: list[IO[Any]] = []

        def open_in_folder(name: str, mode: str = "r") -> IO[Any]:
            # Scripts leave closing to the end of their process.
            opened.append(builtins.open(folder / name, mode))  # noqa: PTH123, SIM115
            return opened[-1]

        said = io.StringIO()
        with monkeypatch.context() as patch:
            patch.setattr(sys, "argv", words[at:])
            patch.setattr(sys, "stderr", said)
            try:
                exec(scripts[path], {"__name__": "__main__", "open": open_in_folder})  # noqa: S102
            except SystemExit as end:
                if end.code not in (None, 0):
                    raise program._failed(folder, f"exit value {end.code}: {said.getvalue()}") from None
            finally:
                for file in opened:
                    file.close()

    monkeypatch.setattr(Program, "_start", start)


def runner(
    function: Callable[[Point], float], fails: Callable[[Point], bool] | None = None
) -> Callable[[Point, Path], Result]:
    """A stand-in for the simulation program."""

    def run(point: Point, folder: Path) -> Result:
        if fails is not None and fails(point):
            folder.mkdir(exist_ok=True)
            (folder / "in.txt").write_text("inputs", encoding="utf-8")
            raise RunFailed(f"run {folder.name}: broken on purpose")
        return Result((function(point),), 0.0)

    return run


def two_wells(p: Point) -> float:
    a, b = p.x
    return 0.1 * (a * a + b * b) + 2 - math.cos(2 * a) - math.cos(2 * b) + 0.05 * a


def body(listing: Path) -> list[str]:
    """Rows of a listing from the line of its column titles on."""
    lines = listing.read_text(encoding="utf-8").split("\n")
    return lines[next(i for i, line in enumerate(lines) if line.startswith("Simulation Number\t")) :]
