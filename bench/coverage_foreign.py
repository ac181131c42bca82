"""How often intervals and bands of a study contain the truths of an independent program.

``python bench/coverage_foreign.py FOLDER PROGRAM [count] [first] [days] [sky]`` takes experiments of that
program (`bench/diagnosis.py` says what PROGRAM is): the LGI cell with drawn truths, six sensors with offsets
and noise. Even seeds have laws that are among the forms of the study, odd seeds have laws that no form names.
Each is calibrated with 5 days (or 20), with six forms. Each result is a file of FOLDER and is not computed
again; the table of all is printed after each experiment, with intervals from resampled experiments.

The infrared radiation of the sky is that of the weather file, which no model of the study has. With ``sky``
``measured`` the study has a pyrgeometer (1 % of noise), so that all laws of even seeds are named; with
``modelled``, the default, one is not.

``TRUTHS`` has the numbers that mean the same in both programs. Factors of convection laws have no truth,
because none of the programs has the laws of the other outdoors; melting temperature, width and specific heat
have one where both have the same curve (even seeds).
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from diagnosis import BUILDING, LAST, PERIODS, WEATHER, experiment
from mascarin import Study
from mascarin.examples import STUDIES
from mascarin.linear_algebra import one_thread
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.model_averaging import combined_intervals, estimates_of
from mascarin.study.steps.model_runs import ModelRuns
from mascarin.weather import Climate, Measurements

Floats = NDArray[np.float64]

#: path -> name of the truth in the other program
TRUTHS = {
    "materials.plasterboard.conductivity": "k_pl",
    "surfaces.roof.outside.absorptance": "alpha_roof",
    "surfaces.roof.inside.emissivity": "eps_steel_in",
    "surfaces.ceiling.outside.emissivity": "eps_foil",
    "surfaces.wall_east.outside.absorptance": "alpha_wall",
    "surfaces.wall_west.outside.absorptance": "alpha_wall",
    "surfaces.wall_north.outside.absorptance": "alpha_wall",
    "surfaces.jalousie.outside.absorptance": "alpha_wall",
    "zones.room.infiltration.constant": "i_room",
    "zones.room.infiltration.wind": "iw_room",
    "zones.room.infiltration.temperature": "it_room",
    "zones.air_gap.infiltration.constant": "i_gap",
    "zones.air_gap.infiltration.wind": "iw_gap",
    "zones.air_gap.infiltration.temperature": "it_gap",
}
#: Standard deviation of a reading of the pyrgeometer, as a part of it. [-]
PYRGEOMETER = 0.01
#: That program has an isotropic sky in the infrared. (The range is that of the shipped cell.)
ISOTROPIC = {"site.sky_exponent": 1.0}
#: Numbers of the same melting curve, and what the program has where it draws none.
OF_CURVE = {
    "materials.energain.melting_temperature": "Tm",
    "materials.energain.law.width": "w",
    "materials.energain.specific_heat.liquid": "cl",
}
FIXED = {"cl": 2833.0, "rho_ground": 0.2}
DAYS = {5: PERIODS["identification"], 20: ["2023-06-09T00:00", "2023-06-29T00:00"]}
FORMS = ("outside convection", "diffuse radiation")
DRAWS = 2000


def infrared(folder: Path, program: Path, seed: int) -> pd.Series:
    """Readings of a pyrgeometer in an experiment. [W/m2]"""
    sys.path.insert(0, str(folder))
    import run_experiment as made  # written by `experiment`

    place = made.WEATHER["gillot"]
    weather = made.forcing(
        place["epw"], f"{place['year']}-05-25", f"{place['year']}-{LAST}", place["lat"], place["lon"],
        place["tz"], seed,
    )  # fmt: skip
    sky = weather["IR"].resample("15min").mean()
    return sky * (1.0 + np.random.default_rng(seed + 1000).normal(0.0, PYRGEOMETER, len(sky)))


def study_of(
    folder: Path, program: Path, seed: int, days: int, true_form: bool, measured_sky: bool = False
) -> Study:
    """The study of an experiment, with six forms or with the true one alone."""
    base = Study.from_yaml(STUDIES["lgi"])
    plan = base.plan.identification
    assert plan is not None
    identification = plan.model_dump(mode="json", exclude_unset=True)
    alternatives = {
        part: {
            name: form.model_dump(mode="json", exclude_unset=True)
            for name, form in base.plan.alternatives[part].items()
        }
        for part in FORMS
    }
    alternatives["outside convection"].pop("power of the wind")
    building = base.building.replace(BUILDING)
    if true_form:
        for part, form in zip(FORMS, ("TARP", "Hay and Davies"), strict=True):
            building = building.replace(alternatives[part][form]["changes"])
        alternatives, building = {}, building.replace(ISOTROPIC)
    table, columns = experiment(folder, program, seed), WEATHER
    parameters = identification.pop("parameters")
    if measured_sky:
        table["infrared"] = infrared(folder, program, seed).reindex(table.index)
        columns, building = columns | {"infrared": "infrared"}, building.replace({"site.sky": "measured"})
        parameters = {
            path: how for path, how in parameters.items() if not path.startswith(("site.sky.", "site.cloud."))
        }
    table = table.tz_localize("Etc/GMT-4")
    return Study(
        building=building,
        climate=Climate.from_table(table, columns=columns),
        measurements=Measurements.from_table(table),
        sensors={name: sensor.model_dump(exclude_unset=True) for name, sensor in base.plan.sensors.items()},
        periods={**PERIODS, "identification": DAYS[days]},
        parameters=parameters,
        identification=identification,
        alternatives=alternatives,
        step="15min",
    )


@one_thread()
def calibrated(study: Study) -> tuple[Any, Any, dict[str, str]]:
    """Estimates, bands and the form that is used."""
    with (
        tempfile.TemporaryDirectory() as folder,
        Workspace(Path(folder), study.context.identity()) as workspace,
    ):
        combination = ModelRuns(study.context, workspace, False).combination()
    best = {part: form for part, form in combination.forms[0].choice if form}
    return estimates_of(study.context, combination), combined_intervals(study.context, combination), best


def judged(folder: Path, program: Path, seed: int, days: int, measured_sky: bool) -> dict[str, Any]:
    """Calibrate one experiment and compare with its truths."""
    began, named = time.process_time(), seed % 2 == 0
    study = study_of(folder, program, seed, days, False, measured_sky)
    fit, bands, best = calibrated(study)
    truth = FIXED | json.loads((folder / f"exp{seed}_truth.json").read_text())["truth"]
    names = {**TRUTHS, "site.ground_reflectance": "rho_ground", **(OF_CURVE if named else {})}
    inside = {
        path: bool(fit.low[i] <= truth[names[path]] <= fit.high[i])
        for i, path in enumerate(fit.problem.paths)
        if path in names
    }
    sensors, half = study.context.observation.names, bands.half_width.mean(axis=0)
    result: dict[str, Any] = {
        "named": named,
        "days": days,
        "form": best,
        "inside": inside,
        "bands": {
            period: dict(zip(sensors, bands.coverage[period].tolist(), strict=True))
            for period in ("identification", "blind")
        },
        "half": dict(zip(sensors, half.tolist(), strict=True)),
    }
    if named:
        _, alone, _ = calibrated(study_of(folder, program, seed, days, True, measured_sky))
        result["wider"] = dict(zip(sensors, (half / alone.half_width.mean(axis=0)).tolist(), strict=True))
    return result | {"processor_seconds": time.process_time() - began}


def resampled(values: list[Any], share: Callable[[list[Any]], float]) -> str:
    """A share and its 95 % interval by resampling experiments."""
    rng = np.random.default_rng(7)
    draws = [share([values[k] for k in rng.integers(len(values), size=len(values))]) for _ in range(DRAWS)]
    low, high = np.quantile(draws, [0.025, 0.975])
    return f"{100 * share(values):.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def table(folder: Path, kind: str) -> None:
    """Print what all experiments of a folder have shown."""
    results = [json.loads(path.read_text()) for path in sorted(folder.glob(f"{kind}-[0-9]*.json"))]
    print(f"\n{kind} | experiments | parameters inside | blind values, by sensor")
    for named in (True, False):
        rows = [result for result in results if result["named"] is named]
        if not rows:
            continue
        parameters = resampled(
            [list(row["inside"].values()) for row in rows], lambda some: float(np.mean(np.concatenate(some)))
        )
        sensors = {
            name: resampled([row["bands"]["blind"][name] for row in rows], lambda some: float(np.mean(some)))
            for name in rows[0]["half"]
        }
        print(f"{'named' if named else 'not named'} | {len(rows)} | {parameters} | {sensors}")
        half = {name: round(float(np.mean([row["half"][name] for row in rows])), 2) for name in sensors}
        print(f"  mean half-width [K] {half}")
        if named:
            wider = {name: round(max(float(row["wider"][name]) for row in rows), 2) for name in sensors}
            print(f"  widest over that with the true form alone {wider}")
    sys.stdout.flush()


def main() -> None:
    """Run what is missing, and print the table after each."""
    if len(sys.argv) < 3:
        print(__doc__)
        return
    folder, program = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    options = sys.argv[3:]
    *numbers, sky = [*options, *("4", "0", "5", "modelled")[len(options) :]]
    count, first, days = (int(text) for text in numbers)
    kind = f"coverage-{days}" + ("-measured" if sky == "measured" else "")
    folder.mkdir(parents=True, exist_ok=True)
    for seed in range(first, first + count):
        path = folder / f"{kind}-{seed}.json"
        if path.exists():
            continue
        result = judged(folder, program, seed, days, sky == "measured")
        part = path.with_suffix(".part")
        part.write_text(json.dumps(result, indent=1))
        part.replace(path)
        missed = [name for name, held in result["inside"].items() if not held]
        blind = [round(100 * share) for share in result["bands"]["blind"].values()]
        print(f"{seed}: {result['form'] or 'as described'}; missed {missed}; blind {blind} %; "
              f"{result['processor_seconds']:.0f} s", flush=True)  # fmt: skip
        table(folder, kind)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    assert LAST  # the same experiments as those of the diagnosis
    main()
