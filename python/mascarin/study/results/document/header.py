"""Inputs, periods and building of a study, as the report shows them."""

from __future__ import annotations

import platform
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin import __version__
from mascarin.examples import STUDIES
from mascarin.measurements.observation import PERIODS
from mascarin.study.file.description import StudyFile
from mascarin.study.results.document.building import assumptions, building_entry
from mascarin.study_document.analysis import QualityEntry
from mascarin.study_document.comparison import PeriodEntry, ReferenceEntry, SensorEntry
from mascarin.study_document.document import InputEntry, ObservedEntry, SourceEntry, StudyDocument

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.study.context.context import StudyContext
    from mascarin.study.file.description import Publication, StudyPlan


_WORDS: Final = {
    "identification": ("Identification", "the parameters are calibrated in this period"),
    "corroboration": ("Corroboration", "validation period, not used for the calibration"),
    "blind": ("Blind days", "all other days, not used for the calibration"),
}


def header(study: StudyContext, command: str) -> StudyDocument:
    """Inputs, periods, sensors and building; part of every result.

    Parameters
    ----------
    study : StudyContext
        The inputs.
    command : str
        Name of the command.
    """
    file = study.plan
    reference = {} if file.reference is None else {"reference": _reference(file.reference)}
    return StudyDocument(
        mascarin_version=__version__,
        title=file.name,
        intro=[*(part.strip() for part in file.about.split("\n\n") if part.strip()), *_experiments(study)],
        observed=ObservedEntry(label=file.observed, note=file.observed_note),
        seed=_seed(file),
        timezone=study.climate.timezone,
        command=_command(study, command),
        inputs=_inputs(study),
        versions=_versions(),
        sources=[SourceEntry(text=text) for text in study.building.sources()],
        sensor_info=_sensor_info(study),
        periods=_periods(study),
        building=building_entry(study.building),
        assumptions=assumptions(study.building),
        quality=_quality(study),
        **reference,
    )


def _experiments(study: StudyContext) -> list[str]:
    """Which experiments the study has, and about which all is that names none."""
    inputs = study.inputs
    if not inputs.others:
        return []
    identified = ", ".join((inputs.experiment, *inputs.together))
    validated = f" Validated: {', '.join(inputs.transfer)}." if inputs.transfer else ""
    return [
        f"Experiments that are identified: {identified}.{validated} What names no experiment is about "
        f"{inputs.experiment}."
    ]


def _reference(reference: Publication) -> ReferenceEntry:
    """The publication, as the study states it."""
    return ReferenceEntry.model_validate(reference.model_dump())


def _command(study: StudyContext, command: str) -> list[str]:
    """The command that gives the same result; for a study made of objects there is none."""
    file = study.inputs.path
    return [] if file is None else [f"mascarin {command} {_called(file)} -o out/"]


def _called(file: Path) -> str:
    """Name of an example study, else the name of the file."""
    shipped = (name for name, path in STUDIES.items() if path.resolve() == file.resolve())
    return next(shipped, file.name)


def _seed(file: StudyPlan) -> int | None:
    """Where the random numbers start: those of the identification, else of the sensitivity."""
    return next((plan.seed for plan in (file.identification, file.sensitivity) if plan is not None), None)


def _inputs(study: StudyContext) -> list[InputEntry]:
    path, plan, hashes = study.inputs.path, study.plan, study.inputs.hashes
    named = [
        ("study", "" if path is None else path.name, hashes["study"]),
        (
            "building",
            plan.building if isinstance(plan, StudyFile) else study.building.name,
            hashes["building"],
        ),
        ("climate", study.climate.file, hashes["climate"]),
        ("measurements", study.measurements.file, hashes["measurements"]),
    ]
    said = {"climate": study.climate.provenance, "measurements": study.measurements.provenance}
    return [
        InputEntry(name=f"{role}: {name}" if name else role, sha256=digest, note=" ".join(said.get(role, ())))
        for role, name, digest in named
    ]


def _versions() -> dict[str, str]:
    packages = ("numpy", "scipy", "pandas", "pvlib", "pydantic")
    return {
        "mascarin": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in packages},
    }


def _sensor_info(study: StudyContext) -> dict[str, SensorEntry]:
    return {
        name: SensorEntry(
            label=sensor.label or name.replace("_", " "),
            output=sensor.output,
            unit=study.building.output(sensor.output).unit,
            uncertainty=sensor.expanded,
        )
        for name, sensor in study.plan.sensors.items()
    }


def _periods(study: StudyContext) -> dict[str, PeriodEntry]:
    return {
        name: PeriodEntry(
            label=_WORDS[name][0],
            note=_WORDS[name][1],
            spans=_spans(study.observation.times, study.during[name], study.observation.interval),
        )
        for name in PERIODS
    }


def _spans(times: pd.DatetimeIndex, use: npt.NDArray[np.bool_], interval: float) -> list[list[str]]:
    """Runs of True as pairs of local times."""
    import pandas as pd

    edges = np.flatnonzero(np.diff(np.concatenate([[False], use, [False]]).astype(np.int8)))
    local = times.tz_localize(None)
    step = pd.Timedelta(seconds=interval)
    return [
        [local[first].isoformat(), (local[last - 1] + step).isoformat()]
        for first, last in zip(edges[::2], edges[1::2], strict=True)
    ]


def _quality(study: StudyContext) -> list[QualityEntry]:
    compared = {column for sensor in study.plan.sensors.values() for column in sensor.columns}
    return [
        QualityEntry(
            channel=stretch.channel,
            kind=stretch.kind,
            start=stretch.start.tz_localize(None).isoformat(),
            end=stretch.end.tz_localize(None).isoformat(),
            count=stretch.count,
            detail=stretch.detail,
            masked=study.inputs.leaves_out(stretch),
            compared=stretch.channel in compared,
        )
        for stretch in study.quality
    ]
