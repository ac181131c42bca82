"""Simulation of the cases over the year of the weather file, two at a time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import _engine
from mascarin.progress import ProgressOption, Report, reporting
from mascarin.verification.bestest.catalogue import CASES, Case
from mascarin.verification.bestest.quantities import (
    HOURS,
    ONTO_GLASS,
    ORIENTATIONS,
    THROUGH_GLASS,
    BestestYear,
    facing,
    has_solar_quantities,
    partners,
)

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

STEP: Final = "15min"
"""Time step of the cases."""
WARM_UP_DAYS: Final = 30
"""Days of December that are run before the year."""
WORKERS: Final = 2
"""Cases that run at a time."""
GLASS_AREA: Final = 6.0
"""Area of each window. [m2]"""
YEAR: Final = 2001
"""Year that the weather is labelled with: 365 days."""


def run(
    cases: Sequence[Case],
    climate: Climate,
    *,
    files: Sequence[Path] = (),
    step: str | float = STEP,
    workers: int = WORKERS,
    progress: ProgressOption = False,
) -> tuple[dict[str, BestestYear], dict[Path, dict[str, Array]]]:
    """Simulate cases, those that their quantities refer to, and buildings of the user in the same way.

    Parameters
    ----------
    cases : sequence of Case
        The cases.
    climate : Climate
        The weather, from `weather.read`.
    files : sequence of Path
        Building files.
    step : str or float
        Time step. [s]
    workers : int
        Number of cases that run at a time.
    progress : bool or callable, optional
        Shows progress; a function is called with the number of runs done and their total.

    Returns
    -------
    dict of str to BestestYear
        Hourly means by case.
    dict of Path to dict of str to ndarray, shape (8760,)
        Hourly means of loads and air temperatures by file and output. [W, degC]

    Raises
    ------
    InputError
        A file cannot be used, or the weather is not a whole year.
    SolverError
        A step did not converge.
    """
    from mascarin.building import load

    buildings = {file: load(file) for file in files}  # errors in them are found before the first run
    names = dict.fromkeys(name for case in cases for name in (case.name, *partners(case)))
    with reporting(progress, "cases") as report, ThreadPoolExecutor(workers) as pool:
        years = {name: pool.submit(run_one, CASES[name], climate, step) for name in names}
        file_runs = {
            file: pool.submit(_run_own, building, climate, step) for file, building in buildings.items()
        }
        try:
            _await([*years.values(), *file_runs.values()], report)
        except BaseException:
            # Ctrl-C reaches the first thread only; runs on the others are stopped here.
            pool.shutdown(wait=False, cancel_futures=True)
            unfinished: set[Future[Any]] = {*years.values(), *file_runs.values()}
            while unfinished := wait(unfinished, timeout=0.1).not_done:
                _engine.interrupt()
            raise
    return {name: f.result() for name, f in years.items()}, {
        file: f.result() for file, f in file_runs.items()
    }


def _await(futures: Sequence[Future[Any]], report: Report) -> None:
    """Wait for all, or for the first that fails."""
    for done, future in enumerate(as_completed(futures)):
        report(done, len(futures))
        future.result()
    report(len(futures), len(futures))


def run_one(case: Case, climate: Climate, step: str | float = STEP) -> BestestYear:
    """Simulate a case over the year, after 30 days of December."""
    from mascarin.building import load

    hourly, residual = _simulate(load(case.file), climate, step, outputs(case))
    return BestestYear(case, dict(_series(case, hourly)), residual)


def _run_own(building: Building, climate: Climate, step: str | float) -> dict[str, Array]:
    names = [f"{zone}.air_temperature" for zone in building.zones]
    names += [f"{name}.{load}_load" for name, zone in building.zones.items() for load in zone.loads]
    return _simulate(building, climate, step, names)[0]


def _simulate(
    building: Building, climate: Climate, step: str | float, output_names: Iterable[str]
) -> tuple[dict[str, Array], float]:
    """Hourly means over the year by output, and the relative energy-balance residual."""
    from datetime import datetime, timedelta

    from mascarin.simulation.run import simulate

    new_year = datetime(YEAR, 1, 1)
    results = simulate(
        building,
        climate,
        step=step,
        start=str(new_year - timedelta(days=WARM_UP_DAYS)),
        end=f"{YEAR + 1}-01-01",
        outputs=sorted(output_names),
    )
    hourly: dict[str, Array] = {
        name: np.asarray(results.hourly(name), dtype=np.float64)[-HOURS:] for name in results
    }
    return hourly, results.energy.closure


def outputs(case: Case) -> set[str]:
    """Return the outputs of a case."""
    names = {f"{zone}.air_temperature" for zone in {case.zone, case.floating or case.zone}}
    if case.conditioned:
        names.add(f"{case.zone}.cooling_load")
        if case.thermostat != "day cooling":
            names.add(f"{case.zone}.heating_load")
    if case.name == "600":
        names |= {*ORIENTATIONS.values(), "sky_temperature"}
    if has_solar_quantities(case):
        names |= {f"{window}.{kind}" for window in _glass(case) for kind in _SUN}
    return names


_SUN: Final = ("incident_solar", "transmitted_solar")


def _glass(case: Case) -> list[str]:
    """Windows whose solar radiation is compared."""
    return [window for window in case.windows if window.startswith(facing(case))]


def _series(case: Case, hourly: Mapping[str, Array]) -> Iterator[tuple[str, Array]]:
    """Mean solar radiation on and through the compared windows, and all other series."""
    sunny = {f"{window}.{kind}" for window in _glass(case) for kind in _SUN}
    yield from ((name, values) for name, values in hourly.items() if name not in sunny)
    if has_solar_quantities(case):
        onto, through = ([hourly[f"{window}.{kind}"] for window in _glass(case)] for kind in _SUN)
        yield ONTO_GLASS, np.mean(onto, axis=0)
        yield THROUGH_GLASS, np.mean(through, axis=0) / GLASS_AREA
