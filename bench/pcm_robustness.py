"""Robustness with phase change: failed runs, steps that needed more than Newton's iteration, energy balance.

The LGI cell over ten days for several values of gamma and step, with one curve and with hysteresis; its
ceiling alone with rapidly varying air temperature; Stefan's melting front for several sizes of volumes and
steps. Prints three Markdown tables and ends with 1 if a run failed or a relative energy-balance residual is
above 1e-10.

    python bench/pcm_robustness.py
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import cell

from mascarin.errors import SolverError
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.verification.analytical import melting
from mascarin.verification.analytical.phase import stefan

GAMMAS = (0.01, 0.04, 0.2, 1.0, 5.0, 25.0, 100.0)
STEPS = (60.0, 300.0, 900.0, 1800.0, 3600.0)
MODELS = ("", *melting.MODELS)
CELLS = (2e-3, 1e-3, 0.5e-3, 0.25e-3)
FRONT_STEPS = (15.0, 60.0, 300.0, 900.0)
CLOSURE = 1e-10


@dataclass
class Tally:
    """Numbers of a row: runs, failures, and what the solver needed."""

    runs: int = 0
    failed: int = 0
    nested: int = 0
    halved: int = 0
    reversals: int = 0
    closure: float = 0.0

    def add(self, run: Callable[[], Results]) -> None:
        """Carry out one run and add its numbers."""
        self.runs += 1
        try:
            results = run()
        except SolverError as error:
            self.failed += 1
            print(error, file=sys.stderr)
            return
        notes = results.provenance
        self.nested += notes.nested_stages
        self.halved += notes.halved_steps
        self.reversals += notes.reversals
        self.closure = max(self.closure, results.energy.closure)

    @property
    def bad(self) -> bool:
        """Whether a run failed or an energy-balance residual is too large."""
        return self.failed > 0 or self.closure > CLOSURE

    def row(self, *names: str) -> str:
        """As a line of a table."""
        counts = (self.runs, self.failed, self.nested, self.halved, self.reversals)
        return f"| {' | '.join([*names, *map(str, counts)])} | {self.closure:.0e} |"


def table(first: Sequence[str], rows: Iterator[tuple[Sequence[str], Tally]]) -> bool:
    """Print a table; true if a row is bad."""
    titles = (*first, "runs", "failed", "nested stages", "halved steps", "reversals", "closure")
    print(f"| {' | '.join(titles)} |\n|{'---|' * len(titles)}")
    bad = False
    for names, tally in rows:
        print(tally.row(*names), flush=True)
        bad |= tally.bad
    print()
    return bad


def in_the_cell() -> Iterator[tuple[Sequence[str], Tally]]:
    """The LGI cell, ten days, all steps, by model and gamma."""
    building, weather = cell.building(), cell.climate(cell.table())
    for model in MODELS:
        for gamma in GAMMAS:
            changes: dict[str, object] = {
                "materials.energain.law": {"kind": "tanh", "gamma": gamma, "delta_t": 0.01}
            }
            if model:
                changes["materials.energain.hysteresis"] = {"model": model, "freezing_temperature": 19.9}
            changed, tally = building.replace(changes), Tally()
            for step in STEPS:
                tally.add(
                    Simulation(
                        changed,
                        weather,
                        step=step,
                        start=cell.START,
                        end="2010-08-11",
                        outputs=["ceiling.energain_liquid_fraction"],
                        initial=20.0,
                    ).run
                )
            yield (model or "one curve", f"{gamma:g}"), tally


def in_the_ceiling() -> Iterator[tuple[Sequence[str], Tally]]:
    """The ceiling alone with rapidly varying air temperature, by model and gamma."""
    for model in MODELS:
        for gamma in GAMMAS:
            tally = Tally()
            for step in STEPS:
                tally.add(melting.ceiling(0.04 / gamma, model, step, days=10).run)
            yield (model or "one curve", f"{gamma:g}"), tally


def at_the_front() -> Iterator[tuple[Sequence[str], Tally]]:
    """Stefan's front, sixty steps, by volume and step."""
    for volume in CELLS:
        for step in FRONT_STEPS:
            tally = Tally()
            tally.add(lambda volume=volume, step=step: stefan(volume, step, 60))  # type: ignore[misc]
            yield (f"{1000 * volume:g} mm", f"{step:g} s"), tally


def main() -> int:
    """Print all tables."""
    print("## The LGI cell, ten days, steps of 60 to 3600 s\n")
    bad = table(("hysteresis", "gamma"), in_the_cell())
    print("## Its ceiling alone, driven hard, ten days, steps of 60 to 3600 s\n")
    bad |= table(("hysteresis", "gamma"), in_the_ceiling())
    print("## Stefan's front, sixty steps\n")
    bad |= table(("volume", "step"), at_the_front())
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
