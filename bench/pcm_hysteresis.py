"""Computing time with hysteresis relative to one curve: the ceiling of the LGI cell, and the whole cell.

Prints a Markdown table of the processor time of a run (the shortest of several) and of the number of
Newton's iterations. Ends with 1 if a run with hysteresis takes more than one and a half times as long.

    python bench/pcm_hysteresis.py
"""

from __future__ import annotations

import sys
import time

import cell

from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.verification.analytical import melting

MOST = 1.5
TRIALS = 7
WIDTH = 1.0
DAYS = 365
STEP = 900.0


def whole_cell(model: str) -> Simulation:
    """The cell over its three months."""
    building = cell.building()
    if model:
        hysteresis = {"model": model, "freezing_temperature": 19.9}
        building = building.replace({"materials.energain.hysteresis": hysteresis})
    return Simulation(
        building,
        cell.climate(cell.table()),
        step=STEP,
        start=cell.START,
        end=cell.END,
        outputs=["ceiling.energain_liquid_fraction"],
        initial=20.0,
    )


def measure(simulations: dict[str, Simulation]) -> dict[str, tuple[float, Results]]:
    """Shortest processor time [s] and results by model; the models take turns."""
    best: dict[str, tuple[float, Results]] = {}
    for _ in range(TRIALS):
        for model, simulation in simulations.items():
            begun = time.process_time()
            results = simulation.run()
            spent = time.process_time() - begun
            if model not in best or spent < best[model][0]:
                best[model] = (spent, results)
    return best


def main() -> int:
    """Measure and print."""
    places = {
        f"ceiling, {DAYS} days": {m: melting.ceiling(WIDTH, m, STEP, DAYS) for m in ("", *melting.MODELS)},
        "LGI cell, 92 days": {m: whole_cell(m) for m in ("", *melting.MODELS)},
    }
    print("| run | curves | ms | of one curve | iterations per stage |\n|---|---|---|---|---|")
    worst = 0.0
    for place, simulations in places.items():
        best = measure(simulations)
        plain = best[""][0]
        for model, (spent, results) in best.items():
            stages = 2 * (len(results.records) - 1)
            iterations = results.provenance.newton_iterations / stages
            worst = max(worst, spent / plain)
            print(
                f"| {place} | {model or 'one'} | {1e3 * spent:.1f} | {spent / plain:.2f} | {iterations:.2f} |"
            )
    print(f"\nAt most {worst:.2f} times one curve; {MOST} are allowed.")
    return 0 if worst <= MOST else 1


if __name__ == "__main__":
    sys.exit(main())
