"""The inputs of a study, read from its files or given as objects, with their names checked."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from mascarin._io.regular import requiring
from mascarin.building import Building, load
from mascarin.building.reading import explained, files_of
from mascarin.errors import InputError
from mascarin.simulation.preparation.prepare import in_climate, require_inputs
from mascarin.study.file.description import StudyFile, StudyPlan
from mascarin.study.file.experiments import ExperimentFile, read_experiments, with_parameters_of
from mascarin.study.file.inputs import (
    Beside,
    filled,
    find,
    open_climate,
    open_measurements,
    require_one_clock,
)
from mascarin.study.file.locations import Faults, Places
from mascarin.study.file.names import check_names
from mascarin.study.file.patterns import tied_building, with_combined_outputs, written_out
from mascarin.study.file.study_inputs import StudyInputs
from mascarin.tables.quality import mask
from mascarin.tables.quality.filled_values import filled_stretches
from mascarin.tables.reading.files import file_hash
from mascarin.validation.criteria import Criterion

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.tables.quality import Stretch
    from mascarin.weather import Climate, Measurements


def from_file(path: Path, *, allow_outside: bool = False) -> StudyInputs:
    """Read a study file and the files that it names.

    Parameters
    ----------
    path : Path
        The study file.
    allow_outside : bool
        Whether it may name files outside its folder.

    Returns
    -------
    StudyInputs
        The inputs.

    Raises
    ------
    InputError
        A file or a name cannot be used.
    """
    beside = Beside(path.parent, allow_outside)
    with requiring(beside.require_inside):  # also of what a description extends
        return _from_file(path, beside)


def _from_file(path: Path, beside: Beside, *, alone: bool = False) -> StudyInputs:
    experiments = read_experiments(path)
    first = experiments[0]
    if not first.name:
        return _with_transfer(_opened(first, first.file, path, beside), first, beside, alone=alone)
    described = [
        (each.name, _described(each, beside)[1]) for each in experiments if each.role == "identification"
    ]
    opened = {}
    for each in experiments:
        file = with_parameters_of(each, _described(each, beside)[1], described)
        opened[each.name] = _opened(each, file, path, beside)
    roles = {each.name: each.role for each in experiments if each is not first}
    every = [opened[each.name].hashes for each in experiments]
    return replace(
        opened[first.name],
        hashes={**opened[first.name].hashes, "study": _digest(every)},
        together={name: opened[name] for name, role in roles.items() if role == "identification"},
        transfer={name: opened[name] for name, role in roles.items() if role == "validation"},
    )


def _described(experiment: ExperimentFile, beside: Beside) -> tuple[Path, Building]:
    """The building file of an experiment, and the building with the values that it sets."""
    file, places = experiment.file, experiment.places
    with places.blame("building"):
        described = find(file.building, beside)
    as_described = load(described)
    with places.blame("set"):
        return described, as_described.replace(file.set)


def _opened(experiment: ExperimentFile, file: StudyFile, path: Path, beside: Beside) -> StudyInputs:
    """One experiment with its files."""
    places, faults = experiment.places, Faults()
    described, building = _described(experiment, beside)
    building = _with_weather(building, file, places)
    file, building = with_combined_outputs(file, building, places)
    building = tied_building(file, building, places)
    file = written_out(file, building, places)
    check_names(file, building, places, faults)
    with faults.kept():
        require_one_clock(file, places)
    with faults.kept():
        climate = open_climate(file.climate, beside, building, places)
    with faults.kept():
        read = open_measurements(file, beside, building, places, Places(described))
    faults.raise_all(path)
    building = _with_sky(building, climate, file)
    quality = read.quality() + filled_stretches(read.data, _columns(file)) + _weather_quality(file, climate)
    longest = file.measurements.fill_gaps
    if longest is not None:
        read = filled(read, building, longest)
    compared = _masked(read, file, quality)
    hashes = {
        "study": _hash_of_all(path),
        "building": _hash_of_all(described),
        "measurements": read.sha256 or "",
        "climate": climate.sha256 or "",
    }
    return StudyInputs(
        file, building, climate, compared, read, quality, places, hashes, path, experiment=experiment.name
    )


def _with_transfer(inputs: StudyInputs, study: ExperimentFile, beside: Beside, *, alone: bool) -> StudyInputs:
    """The same with the studies on which the calibrated building is validated."""
    hashes, others, path = dict(inputs.hashes), {}, inputs.source_file
    for name, entry in ({} if alone else study.file.transfer).items():
        with study.places.blame("transfer", name, "study"):
            other = find(entry.study, beside)
        if other.resolve() == path.resolve():
            continue  # one that extends a study has its entries, and may be one of them
        # What another study transfers to is its own affair.
        others[name] = _from_file(other, Beside(other.parent, beside.allow_outside), alone=True)
        hashes["study"] = _digest([hashes["study"], others[name].hashes])
    return replace(inputs, hashes=hashes, transfer=others)


def _with_weather(building: Building, plan: StudyPlan, places: Places) -> Building:
    """Take the errors of the weather that the study states."""
    if plan.weather is None:
        return building
    with places.blame("weather"):
        return building.replace({"weather": plan.weather})


def _with_sky(building: Building, climate: Climate, plan: StudyPlan) -> Building:
    """Take the infrared radiation of the weather, unless the study names a parameter of a sky model."""
    named: list[str] = list(plan.identification.parameters) if plan.identification else []
    if plan.sensitivity:
        named += [*plan.sensitivity.ranges, *plan.sensitivity.distributions, *plan.sensitivity.leave_out]
        named += plan.sensitivity.only or ()
    return in_climate(building, climate, varied=named)


def from_objects(
    building: Building, climate: Climate, measurements: Measurements, plan: Mapping[str, Any]
) -> StudyInputs:
    """Check a study that is made of objects.

    Parameters
    ----------
    building, climate, measurements
        The objects.
    plan : mapping
        The fields of `StudyPlan`, each as an object or as the plain values of a file.

    Returns
    -------
    StudyInputs
        The inputs.

    Raises
    ------
    InputError
        A value or a name cannot be used.
    """
    require_inputs(building, climate, measurements)
    plain = {key: _plain(value) for key, value in plan.items()}
    try:
        checked = StudyPlan.model_validate(plain)
    except ValidationError as error:
        raise explained(error, plain, "study") from None
    places, faults = Places(), Faults()
    checked, building = with_combined_outputs(checked, _with_weather(building, checked, places), places)
    building = tied_building(checked, building, places)
    checked = written_out(checked, building, places)
    check_names(checked, building, places, faults)
    faults.raise_all(places.file)
    building = _with_sky(building, climate, checked)
    quality = measurements.quality() + filled_stretches(measurements.data, _columns(checked))
    compared = _masked(measurements, checked, quality)
    hashes = {
        "study": _digest(checked.model_dump(mode="json")),
        "building": _digest(building.model_dump(mode="json")),
        "measurements": compared.sha256 or _digest_of_table(compared.data),
        "climate": climate.sha256 or _digest_of_table(climate.data),
    }
    return StudyInputs(checked, building, climate, compared, measurements, quality, places, hashes)


def with_measurements(inputs: StudyInputs, measurements: Measurements) -> StudyInputs:
    """The inputs of a study with other measurements, whose quality is checked.

    Parameters
    ----------
    inputs : StudyInputs
        Of a study.
    measurements : Measurements
        With the columns that its sensors name.

    Returns
    -------
    StudyInputs

    Raises
    ------
    InputError
        The study has several experiments.
    """
    inputs.require_alone("other measurements replace those of one data set", validated=False)
    plan = inputs.plan
    quality = measurements.quality() + filled_stretches(measurements.data, _columns(plan))
    compared = _masked(measurements, plan, quality)
    return replace(
        inputs,
        measurements=compared,
        driving=measurements,
        quality=quality,
        hashes={**inputs.hashes, "measurements": compared.sha256 or _digest_of_table(compared.data)},
    )


def identified(parameters: Sequence[str] | Mapping[str, Any], options: Mapping[str, Any]) -> dict[str, Any]:
    """The identification of a study from parameters as Python gives them.

    Parameters
    ----------
    parameters : sequence of str or mapping
        Paths, or path -> None, (low, high), a mapping with ``low``, ``high``, ``prior``, or an object with
        these attributes.
    options : mapping
        Other fields of the identification, such as ``method`` and ``starts``.

    Returns
    -------
    dict
        Plain values, as in a file.

    Raises
    ------
    InputError
        One text was given where several are expected.
    """
    if isinstance(parameters, str):
        raise InputError(
            f"parameters: found '{parameters}', expected a list of paths or a mapping; write ['{parameters}']"
        )
    given = parameters if isinstance(parameters, Mapping) else dict.fromkeys(parameters)
    return {**options, "parameters": {path: _free(value) for path, value in given.items()}}


def _free(value: Any) -> Any:
    """What is known of one parameter, as in a file."""
    if isinstance(value, tuple | list) and len(value) == 2:
        return {"low": value[0], "high": value[1]}
    if hasattr(value, "lower") and hasattr(value, "upper"):
        known = {"low": value.lower, "high": value.upper, "prior": getattr(value, "prior", None)}
        return {key: number for key, number in known.items() if number is not None}
    return _plain(value)


def _plain(value: Any) -> Any:
    """Times as texts and criteria as mappings, in lists and mappings as well."""
    if isinstance(value, Criterion):
        return value.model_dump(exclude_none=True)
    if isinstance(value, datetime):
        return str(value)
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value


def _weather_quality(file: StudyFile, climate: Climate) -> list[Stretch]:
    """Suspicious values of measured weather, unless it is in the table of the measurements."""
    weather = file.climate.measured
    if weather is None or weather.table == file.measurements.table:
        return []
    return climate.quality()


def _columns(plan: StudyPlan) -> list[str]:
    """Columns of the sensors."""
    return list(dict.fromkeys(column for sensor in plan.sensors.values() for column in sensor.columns))


def _masked(read: Measurements, plan: StudyPlan, quality: Sequence[Stretch]) -> Measurements:
    kinds = plan.quality.mask
    if not kinds:
        return read
    sensors = {column for sensor in plan.sensors.values() for column in sensor.columns}
    chosen = [stretch for stretch in quality if stretch.channel in sensors]
    return read.masked(mask(read.data, chosen, list(kinds)))


def _hash_of_all(path: Path) -> str:
    """SHA-256 of a file, and of the files that it extends."""
    hashes = [file_hash(file) for file in files_of(path)]
    return hashes[0] if len(hashes) == 1 else hashlib.sha256(" ".join(hashes).encode()).hexdigest()


def _digest(content: Any) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()


def _digest_of_table(table: pd.DataFrame) -> str:
    found = hashlib.sha256(",".join(map(str, table.columns)).encode())
    found.update(table.index.asi8.tobytes())  # type: ignore[attr-defined]
    found.update(table.to_numpy(dtype="float64").tobytes())
    return found.hexdigest()
