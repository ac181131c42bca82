"""Effective mean convective heat transfer coefficients, so that a factor can be compared with a constant."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import CoefficientsEntry

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import ModelRun

    Array = npt.NDArray[np.float64]

_LAW: Final = re.compile(r"surfaces\.(?P<surface>[^.]+)\.(?P<side>[^.]+)\.convection")
_PERIOD: Final = "identification"


def coefficients(study: StudyContext, models: Mapping[str, ModelRun], paths: Iterable[str]) -> StudyDocument:
    """Effective mean coefficient of each convection law that has one of some parameters.

    It is the constant that exchanges as much heat: the mean of the heat flux without its sign, over the mean
    of the temperature difference without its sign, in the identification period. For tied parameters it is
    that of all their surfaces together.

    Parameters
    ----------
    study : StudyContext
        The study.
    models : mapping of str to ModelRun
        The models to compare.
    paths : iterable of str
        Parameters; those of other parts of the building are left out.

    Returns
    -------
    StudyDocument
        ``coefficients``; nothing where no parameter belongs to a convection law.
    """
    # The form of the model that is used may have parameters that the building as described does not have.
    buildings = [*(run.simulation.building for run in models.values()), study.building]
    laws = {law[0]: _members(buildings, path) for path in paths if (law := _LAW.match(path))}
    if not laws:
        return StudyDocument()
    means = {name: _means(study, run, laws) for name, run in models.items()}
    if not any(means.values()):
        return StudyDocument()
    return StudyDocument(coefficients=CoefficientsEntry(period=_PERIOD, unit="W/(m2 K)", models=means))


def _members(buildings: Iterable[Building], path: str) -> list[str]:
    """Laws that a parameter belongs to: one, or those that a tied parameter stands for."""
    members: Sequence[str] = (path,)
    for building in buildings:
        with contextlib.suppress(InputError):  # no such parameter
            members = building.parameter(path).members or members
            break
    return list(dict.fromkeys(match[0] for member in members if (match := _LAW.match(member))))


def _means(study: StudyContext, run: ModelRun, laws: Mapping[str, Sequence[str]]) -> dict[str, float]:
    """Effective mean coefficients of one model, W/(m2 K); laws that it does not have are left out."""
    building = run.simulation.building.replace(run.results.provenance.changed)
    output_names = {output.name for output in building.outputs()}
    outputs = {law: [_outputs(building, member) for member in members] for law, members in laws.items()}
    names = {
        law: [triple for triple in triples if triple[0] in output_names] for law, triples in outputs.items()
    }
    required = dict.fromkeys(
        name for triples in names.values() for triple in triples for name in triple if name is not None
    )
    if not required:
        return {}
    recorded = {building.output(sensor.output).name for sensor in study.plan.sensors.values()}
    simulation = study.models.of_building(building, [name for name in required if name not in recorded])
    results = simulation.run()
    first, last = study.periods.identification
    during = np.asarray((results.index >= first) & (results.index < last))
    air = simulation.weather("air_temperature")
    columns = [output.name for output in results.outputs]
    means = {}
    for law, triples in names.items():
        heat = weight = 0.0
        for coefficient, face, zone in triples:
            h, surface = (results.records[during, columns.index(name)] for name in (coefficient, face))
            beside = air[during] if zone is None else results.records[during, columns.index(zone)]
            area = float(building.surfaces[face.split(".")[0]].area or 0.0)
            difference = np.abs(surface - beside) * area
            heat, weight = heat + float(np.sum(h * difference)), weight + float(np.sum(difference))
        if weight > 0.0:
            means[law] = float(f"{heat / weight:.6g}")
    return means


def _outputs(building: Building, law: str) -> tuple[str, str, str | None]:
    """Outputs: the coefficient, the temperature of the face, that of the air (None outdoors)."""
    match = _LAW.match(law)
    assert match is not None  # noqa: S101 (laws are matches)
    surface, side = match["surface"], match["side"]
    zone = getattr(building.surfaces[surface], side).zone
    air = None if zone is None else f"{zone}.air_temperature"
    return f"{surface}.{side}_convection", f"{surface}.{side}_temperature", air
