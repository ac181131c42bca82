"""Time that `mascarin optimize` adds to the simulation program, per evaluation.

Runs a grid of points with a program that takes nearly no time, once by `mascarin optimize` and once without
it, and prints the difference. With a C compiler the program is compiled, otherwise it is a Python script.

    python bench/genopt_overhead.py [points]
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mascarin.genopt import Options, optimize

C_PROGRAM = r"""
#include <stdio.h>
int main(void) {
  double a, b;
  FILE *f = fopen("in.txt", "r");
  if (!f || fscanf(f, "x1 = %lf x2 = %lf", &a, &b) != 2) return 1;
  fclose(f);
  f = fopen("out.txt", "w"); fprintf(f, "cost= %.17g\n", a * a + b * b); fclose(f);
  f = fopen("log.txt", "w"); fprintf(f, "fine\n"); fclose(f);
  return 0;
}
"""
PYTHON_PROGRAM = """
a, b = (float(line.split(" = ")[1]) for line in open("in.txt"))
open("out.txt", "w").write(f"cost= {a * a + b * b!r}\\n")
open("log.txt", "w").write("fine\\n")
"""


def program(folder: Path) -> list[str]:
    """Make the program; the words that start it."""
    compiler = shutil.which("cc")
    if compiler is None:
        script = folder / "simulate.py"
        script.write_text(PYTHON_PROGRAM, encoding="utf-8")
        return [sys.executable, "-I", "-S", str(script)]
    source, target = folder / "simulate.c", folder / "simulate.exe"
    source.write_text(C_PROGRAM, encoding="utf-8")
    subprocess.run([compiler, "-O2", "-o", str(target), str(source)], check=True)  # noqa: S603
    return [str(target)]


def write_project(folder: Path, words: list[str], points: int) -> Path:
    """A project that runs a grid; its initialization file."""
    (folder / "template.txt").write_text("x1 = %x1%\nx2 = %x2%\n", encoding="utf-8")
    command = " ".join(f'\\"{w}\\"' for w in words)
    (folder / "sim.cfg").write_text(
        f"""SimulationError {{ ErrorMessage = "Fatal"; }}
IO {{ NumberFormat = Double; }}
SimulationStart {{ Command = "{command}"; WriteInputFileExtension = true; }}
""",
        encoding="utf-8",
    )
    (folder / "command.txt").write_text(
        f"""Vary {{
  Parameter {{ Name = x1; Min = 0; Ini = 0; Max = 1; Step = {points // 2 - 1}; }}
  Parameter {{ Name = x2; Min = 0; Ini = 0; Max = 1; Step = 1; }}
}}
OptimizationSettings {{ MaxIte = 1; WriteStepNumber = false; UnitsOfExecution = 1; }}
Algorithm {{ Main = Mesh; StopAtError = true; }}
""",
        encoding="utf-8",
    )
    ini = folder / "opt.ini"
    ini.write_text(
        """Simulation {
  Files {
    Template { File1 = template.txt; }
    Input { File1 = in.txt; }
    Log { File1 = log.txt; }
    Output { File1 = out.txt; }
    Configuration { File1 = sim.cfg; }
  }
  ObjectiveFunctionLocation { Name1 = cost; Delimiter1 = "cost="; }
}
Optimization { Files { Command { File1 = command.txt; } } }
""",
        encoding="utf-8",
    )
    return ini


def bare(folder: Path, words: list[str], points: int) -> float:
    """Time of the program alone, started the same way. [s]"""
    work = folder / "bare"
    work.mkdir(exist_ok=True)
    (work / "in.txt").write_text("x1 = 0.5\nx2 = 0.5\n", encoding="utf-8")
    began = time.perf_counter()
    for _ in range(points):
        subprocess.run(words, cwd=work, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)  # noqa: S603
    return (time.perf_counter() - began) / points


def main(points: int = 400) -> None:
    """Measure three times and print the median."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = program(folder)
        ini = write_project(folder, words, points)
        rows = []
        for _ in range(3):
            alone = bare(folder, words, points)
            began = time.perf_counter()
            outcome = optimize(ini, Options(progress=False))
            whole = (time.perf_counter() - began) / outcome.simulations
            rows.append((whole, alone, whole - alone))
        whole, alone, added = (1e3 * statistics.median(column) for column in zip(*rows, strict=True))
        sys.stdout.write(
            f"{outcome.simulations} evaluations: {whole:.2f} ms each, program alone {alone:.2f} ms, "
            f"added {added:.2f} ms\n"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 400)
