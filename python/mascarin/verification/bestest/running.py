"""The cases run: hour by hour through the year of the weather file, two at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.bestest.catalogue import CASES, Case
from mascarin.verification.bestest.quantities import (
    HOURS,
    ONTO_GLASS,
    ORIENTATIONS,
    THROUGH_GLASS,
    Year,
    asked_about_sun,
    facing,
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
    own: Sequence[Path] = (),
    step: str | float = STEP,
    workers: int = WORKERS,
    progress: Callable[[float, float], object] | None = None,
) -> tuple[dict[str, Year], dict[Path, dict[str, Array]]]:
    """Run cases, and those that their quantities refer to; and buildings of the user's in the same way.

    Parameters
    ----------
    cases : sequence of Case
        Which.
    climate : Climate
        The weather, as `weather.read` gives it.
    own : sequence of Path
        Building files.
    step : str or float
        Time step. [s]
    workers : int
        How many run at a time.
    progress : callable, optional
        Called with the number of runs done and in all.

    Returns
    -------
    dict of str to Year
        Hourly means by case.
    dict of Path to dict of str to ndarray, shape (8760,)
        Hourly means of loads and air temperatures by file and output. [W, degC]

    Raises
    ------
    InputError
        A file cannot be used, or the weather is not that of a year.
    SolverError
        A step did not converge.
    """
    from mascarin.building import load

    buildings = {file: load(file) for file in own}  # what is wrong in them is told before the work
    names = dict.fromkeys(name for case in cases for name in (case.name, *partners(case)))
    with ThreadPoolExecutor(workers) as pool:
        years = {name: pool.submit(run_one, CASES[name], climate, step) for name in names}
        others = {file: pool.submit(_run_own, one, climate, step) for file, one in buildings.items()}
        try:
            _await([*years.values(), *others.values()], progress)
        finally:
            pool.shutdown(cancel_futures=True)
    return {name: f.result() for name, f in years.items()}, {file: f.result() for file, f in others.items()}


def _await(futures: Sequence[Future[Any]], progress: Callable[[float, float], object] | None) -> None:
    """Wait for all, or for the first that fails."""
    for done, future in enumerate(as_completed(futures)):
        if progress is not None:
            progress(done, len(futures))
        future.result()
    if progress is not None:
        progress(len(futures), len(futures))


def run_one(case: Case, climate: Climate, step: str | float = STEP) -> Year:
    """Run a case through the year, after 30 days of December."""
    from mascarin.building import load

    hourly, closure = _march(load(case.file), climate, step, outputs(case))
    return Year(case, dict(_series(case, hourly)), closure)


def _run_own(building: Building, climate: Climate, step: str | float) -> dict[str, Array]:
    wanted = [f"{zone}.air_temperature" for zone in building.zones]
    wanted += [f"{name}.{plant}_load" for name, zone in building.zones.items() for plant in zone.plants]
    return _march(building, climate, step, wanted)[0]


def _march(
    building: Building, climate: Climate, step: str | float, wanted: Iterable[str]
) -> tuple[dict[str, Array], float]:
    """Hourly means over the year by output, and the closure of the ledger."""
    from datetime import datetime, timedelta

    from mascarin.simulation.run import simulate

    new_year = datetime(YEAR, 1, 1)
    results = simulate(
        building,
        climate,
        step=step,
        start=str(new_year - timedelta(days=WARM_UP_DAYS)),
        end=f"{YEAR + 1}-01-01",
        outputs=sorted(wanted),
    )
    hourly: dict[str, Array] = {
        name: np.asarray(results.hourly(name), dtype=np.float64)[-HOURS:] for name in results
    }
    return hourly, results.energy.closure


def outputs(case: Case) -> set[str]:
    """What a case records."""
    wanted = {f"{zone}.air_temperature" for zone in {case.zone, case.floating or case.zone}}
    if case.conditioned:
        wanted.add(f"{case.zone}.cooling_load")
        if case.thermostat != "day cooling":
            wanted.add(f"{case.zone}.heating_load")
    if case.name == "600":
        wanted |= {*ORIENTATIONS.values(), "sky_temperature"}
    if asked_about_sun(case):
        wanted |= {f"{window}.{kind}" for window in _glass(case) for kind in _SUN}
    return wanted


_SUN: Final = ("incident_solar", "transmitted_solar")


def _glass(case: Case) -> list[str]:
    """Windows whose sun is asked for."""
    return [window for window in case.windows if window.startswith(facing(case))]


def _series(case: Case, hourly: Mapping[str, Array]) -> Iterator[tuple[str, Array]]:
    """The sun on and through the glass over all panes that are asked for, and everything else as it is."""
    sunny = {f"{window}.{kind}" for window in _glass(case) for kind in _SUN}
    yield from ((name, values) for name, values in hourly.items() if name not in sunny)
    if asked_about_sun(case):
        onto, through = ([hourly[f"{window}.{kind}"] for window in _glass(case)] for kind in _SUN)
        yield ONTO_GLASS, np.mean(onto, axis=0)
        yield THROUGH_GLASS, np.mean(through, axis=0) / GLASS_AREA
