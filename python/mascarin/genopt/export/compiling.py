"""Makes the compiled case of a study."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin.building.reading import files_of
from mascarin.errors import InputError
from mascarin.genopt.export.case import Case, Observed, inputs_of, open_case
from mascarin.simulation.preparation.weather_inputs import is_of_weather
from mascarin.study import Study
from mascarin.study.file.inputs import Beside, find
from mascarin.tables.times import epoch_seconds

if TYPE_CHECKING:
    from mascarin.study.file.description import StudyFile


def compiled(study: Path, saved: Path | None = None, *, allow_outside: bool = False) -> Case:
    """The case of a study: the saved one if it is valid, else a new one, which is then saved.

    Parameters
    ----------
    study : Path
        The study file.
    saved : Path, optional
        File of the case.
    allow_outside : bool
        Whether the study may name files outside its folder.

    Raises
    ------
    InputError
        The study cannot be used.
    """
    name = str(study.resolve())
    case = None if saved is None else open_case(saved, name)
    if case is None:
        case = compile_study(Study(study, allow_outside=allow_outside))
        if saved is not None:
            case.save(saved)
    return case


def compile_study(study: Study) -> Case:
    """Compile the identification of a study.

    Parameters
    ----------
    study : Study
        The study.

    Raises
    ------
    InputError
        A parameter or a sensor that cannot be used.
    """
    context, inputs = study.context, study.context.inputs
    inputs.require_alone("a GenOpt project has the model of one", validated=False)
    problem, simulation, observation = (
        context.problem(),
        context.models.for_calibration(),
        context.observation,
    )
    for path, other in simulation.followers(problem.paths).items():
        raise InputError(
            f"{path}: found the same set point as {other}, which would follow it; expected set points that "
            "differ in a GenOpt project: lower the heating set point or raise the cooling set point"
        )
    for path in problem.paths:
        if is_of_weather(path):
            raise InputError(
                f"{path}: found a correction of the weather, expected parameters of the building in a GenOpt "
                "project, whose weather is the same in all evaluations; leave it out here, or identify it "
                "with `mascarin study`"
            )
        if simulation.building.parameter(path).members:
            raise InputError(
                f"{path}: found a tied parameter, expected parameters of one number in a GenOpt project; "
                "leave it out, or write each number alone"
            )
    seconds, observed_seconds = epoch_seconds(simulation.index), epoch_seconds(observation.times)
    step = seconds[1] - seconds[0]
    columns = [observation.names.index(sensor.name) for sensor in problem.sensors]
    observed = Observed(
        columns=columns,
        kinds=[observation.kinds[c] for c in columns],
        reach=float(observation.interval / step),
    )
    return Case(
        run=simulation.compiled,
        observed=observed,
        positions=np.array([simulation.position(path) for path in problem.paths], dtype=np.int64),
        instants=((observed_seconds - seconds[0]) / step)[np.flatnonzero(context.rows)],
        parameters=problem.parameters,
        sensors=problem.sensors,
        cost=inputs.calibration_plan.cost,
        step=observation.interval,
        inputs=inputs_of(str(inputs.source_file.resolve()), _files(inputs.source_file, inputs.file_plan)),
    )


def _files(path: Path, file: StudyFile) -> list[str]:
    """Every file that a study reads."""
    climate = file.climate
    measured = None if climate.measured is None else climate.measured.table
    names = [file.building, climate.epw, climate.tmy, measured, file.measurements.table]
    beside = Beside(path.parent, allow_outside=True)  # they have been read
    named = [find(name, beside) for name in names if name is not None]
    sources = [*files_of(path), *files_of(named[0]), *named[1:]]
    return sorted({str(source.resolve()) for source in sources})
