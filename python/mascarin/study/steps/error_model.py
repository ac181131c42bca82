"""Errors of the sensors and of the model in a study: what is stated, and calibrations that estimate them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.calibration import SearchOptions
from mascarin.calibration.base.joined_problem import shares_of
from mascarin.calibration.errors.joint_estimation import estimate_experiments
from mascarin.calibration.errors.linear_estimation import ErrorStatement
from mascarin.calibration.errors.sensor_errors import error_columns
from mascarin.calibration.errors.stated_errors import shared_errors, sizes_of
from mascarin.measurements.scatter import scatter
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study.context.step_cache import kept, kept_series
from mascarin.study.file.description import DiscrepancyPlan

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.calibration.base.joined_problem import Share
    from mascarin.calibration.errors.joint_posterior import JointPosterior
    from mascarin.calibration.errors.sensor_errors import SensorError
    from mascarin.measurements.observation import Observation
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext

    Array = npt.NDArray[np.float64]

#: Part of a standard uncertainty by which a quantity is moved for its derivative.
_STEP: Final = 0.2
#: Standard deviation of a parameter that is not estimated, as a part of its range.
RANGES: Final = 0.25
#: Directions whose effect in the identification, as a root mean square, is smaller than this part of the
#: uncertainty of the sensors are not estimated: the data cannot tell them.
_SMALL: Final = 0.03
_ROWS: Final = 300


@dataclass(frozen=True, eq=False)
class Unknown:
    """A number of the building that is not estimated, but not known either.

    Attributes
    ----------
    path : str
        Path in the building.
    uncertainty : float
        Standard uncertainty. [unit of the number]
    """

    path: str
    uncertainty: float


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Numbers that are not estimated, and the few combinations of them that the identification can tell.

    Attributes
    ----------
    numbers : tuple of Unknown, length K
        The numbers.
    directions : ndarray, shape (K, r)
        Orthonormal combinations, in standard uncertainties. [-]
    """

    numbers: tuple[Unknown, ...]
    directions: Array


def used_sensors(study: StudyContext) -> list[str]:
    """Names of the sensors of the identification, in the order of its series."""
    return [name for name in study.observation.names if study.plan.sensors[name].use]


def sensor_errors(study: StudyContext, names: list[str]) -> tuple[SensorError, ...]:
    """Errors that the readings of some sensors share."""
    errors = []
    for name in names:
        sensor = study.plan.sensors[name]
        unit = study.building.output(sensor.output).unit
        stated = sensor.uncertainty(unit, f"sensors.{name}")
        errors.append(shared_errors(sensor, stated, scatter_of(study, name)))
    return tuple(errors)


def stated_sizes(study: StudyContext) -> dict[str, float]:
    """Standard uncertainty of each error of the used sensors, by its name in the joint distribution."""
    names = used_sensors(study)
    return sizes_of(names, sensor_errors(study, names))


def scatter_of(study: StudyContext, name: str) -> float:
    """Scatter of the readings of a sensor, as its record shows it; NaN if the record is too short. [unit]"""
    readings = study.observation.measured[:, study.observation.names.index(name)]
    return scatter(readings)


def local_hours(study: StudyContext) -> Array:
    """Local time of all instants of the comparison, from the midnight before the first, shape (n,). [h]"""
    local = study.observation.times.tz_localize(None)
    return np.asarray((local - local[0].normalize()).total_seconds() / 3600.0, dtype=np.float64)


def unknowns(study: StudyContext, simulation: Simulation, known: set[str]) -> list[Unknown]:
    """Numbers that are not estimated: all others with a range, and the depths of sensors.

    A range contains a number with a probability of 95 %, so that its quarter is the standard uncertainty.
    """
    depth: dict[str, float] = {}
    for name in used_sensors(study):
        sensor = study.plan.sensors[name]
        if sensor.depth is not None:
            probe = study.building.output(sensor.output).name.split(".")[0]
            depth[f"sensors.{probe}.depth"] = sensor.depth
    found = {
        factor.path: RANGES * (factor.high - factor.low)
        for factor in factors_of(simulation.building)
        if factor.path not in known and not factor.path.startswith("sensors.")
    }
    return [Unknown(path, uncertainty) for path, uncertainty in (found | depth).items()]


def persistence_of(study: StudyContext) -> float:
    """Correlation time of the errors of days. [d]"""
    plan = study.inputs.calibration_plan.discrepancy or DiscrepancyPlan()
    return seconds_of(plan.persistence) / 86400.0


def statement(study: StudyContext, share: Share) -> ErrorStatement:
    """What is known of the errors of an experiment before the calibration."""
    plan = study.inputs.calibration_plan.discrepancy or DiscrepancyPlan()
    rows, sensors = study.rows, share.problem.sensors
    names = tuple(sensor.name for sensor in sensors)
    return ErrorStatement(
        sensor_errors(study, list(names)),
        local_hours(study)[rows],
        study.observation.interval,
        np.array([max(plan.limit * sensor.span, 1e-9) for sensor in sensors]),
        persistence_of(study),
        rows=share.rows,
        columns=share.sensors,
        names=names,
    )


@dataclass(frozen=True, eq=False)
class _Experiment:
    """One experiment of a calibration: its part of the problem, its model, and what is not known of it."""

    study: StudyContext
    share: Share
    simulation: Simulation
    unknown: tuple[Unknown, ...]

    def effects(self, values: Array) -> Array:
        """Effects of the unknown numbers on its used sensors, from the values of all parameters (P,)."""
        study, sensors = self.study, self.study.plan.sensors
        columns = [s for s, name in enumerate(study.observation.names) if sensors[name].use]
        own = dict(zip(self.share.problem.paths, values[list(self.share.columns)].tolist(), strict=True))
        if self._begins_the_record:
            whole = study.models.over_record()
            effects = effects_of_unknowns(study, study.observation, whole, whole.vector(own), self.unknown)
            return effects[study.rows][:, columns]
        seen, base = _part(study.observation, study.rows), self.simulation.vector(own)
        return effects_of_unknowns(study, seen, self.simulation, base, self.unknown)[:, columns]

    @property
    def _begins_the_record(self) -> bool:
        """Whether its runs are the beginning of those over the record, which bands and diagnosis need too.

        Forms of a model are many, and bands need the effects of one of them.
        """
        study = self.study
        alone = study.workspace is not None and not study.plan.alternatives
        return alone and self.simulation.start == study.models.over_record().start

    def names(self, own: str) -> list[str]:
        """Names of the unknown numbers: a depth of a sensor is of the experiment, all others are shared."""
        paths = (number.path for number in self.unknown)
        return [f"{own} {path}" if path.startswith("sensors.") else path for path in paths]


def with_errors(
    study: StudyContext, variant: str | None, fit: Calibration
) -> tuple[Calibration, tuple[JointPosterior, ...], tuple[Unknowns, ...]]:
    """Estimate the parameters of a calibration again, together with the errors.

    Parameters
    ----------
    study : StudyContext
        Gives sensors and plan.
    variant : str or None
        Which model.
    fit : Calibration
        Its calibration without errors, of all experiments.

    Returns
    -------
    Calibration
        With estimates and intervals that account for the errors.
    tuple of JointPosterior
        Parameters and errors together, as each experiment has them.
    tuple of Unknowns
        Numbers of each that are not estimated; their directions are the last effects of sensors of the joint
        distribution.
    """
    experiments = []
    for context, share in zip(study.experiments.values(), shares_of(fit.problem), strict=True):
        short = context.models.for_calibration(variant)
        unknown = unknowns(context, short, set(share.problem.paths))
        experiments.append(_Experiment(context, share, short, tuple(unknown)))
    named = [each.names(name) for name, each in zip(study.experiments, experiments, strict=True)]
    every = list(dict.fromkeys(name for names in named for name in names))
    places = [[every.index(name) for name in names] for names in named]
    basis: list[Array] = []

    def further(values: Array) -> Array:
        effects = np.zeros((*fit.problem.measured.shape, len(every)))
        for each, place in zip(experiments, places, strict=True):
            effects[each.share.rows, each.share.sensors, place] = each.effects(values)
        basis[:] = [_directions(effects, fit.problem.sigma, fit.problem.mask)]
        return np.asarray(effects @ basis[0])

    identities = [each.simulation.identity for each in experiments]
    identity = identities[0] if len(identities) == 1 else identities

    def keep(key: object, make: Callable[[], tuple[Array, Array]]) -> tuple[Array, Array]:
        return kept(study.workspace, ("linear", identity, fit.problem.fingerprint(), key), make)

    plan = study.inputs.calibration_plan
    rules = SearchOptions(slopes=plan.slopes, posterior=plan.posterior, draws=plan.draws)
    stated = [statement(each.study, each.share) for each in experiments]
    estimate, joints = estimate_experiments(fit, stated, rules, further, keep=keep)
    notes = tuple(
        Unknowns(each.unknown, basis[0][place]) for each, place in zip(experiments, places, strict=True)
    )
    return estimate, joints, notes


def _directions(effects: Array, sigma: Array, mask: npt.NDArray[np.bool_]) -> Array:
    """Combinations of numbers, (K, r), that the identification can tell, from their effects (T, S, K)."""
    scaled = (effects / np.where(mask, sigma, 1.0)[:, :, None])[mask]
    # A thinned series has the same combinations; the product would take longer than all else.
    thinned = scaled[:: max(1, len(scaled) // _ROWS)]
    value, vector = np.linalg.eigh(thinned.T @ thinned / max(len(thinned), 1))
    return np.asarray(vector[:, value > _SMALL**2][:, ::-1])


def effects_of_sensors(study: StudyContext, simulated: Array) -> Array:
    """Effects of the errors of used sensors on simulated series (n, S), shape (n, S, k). [unit of each]"""
    named = used_sensors(study)
    errors = sensor_errors(study, named)
    columns = [study.observation.names.index(name) for name in named]
    found, _ = error_columns(named, errors, simulated[:, columns], study.observation.interval)
    wide = np.zeros((*simulated.shape, found.shape[2]))
    wide[:, columns] = found
    return wide


def _part(observation: Observation, use: npt.NDArray[np.bool_]) -> Observation:
    """The same observation at some of its instants."""
    return replace(observation, times=observation.times[use], measured=observation.measured[use])


def effects_of_unknowns(
    study: StudyContext,
    observation: Observation,
    simulation: Simulation,
    base: Array,
    unknown: Sequence[Unknown],
) -> Array:
    """Effects of numbers that are not estimated on all series.

    With the same parameter vector the diagnosis has the same runs.

    Parameters
    ----------
    study : StudyContext
        Has the folder where runs are kept.
    observation : Observation
        Gives the instants.
    simulation : Simulation
        The model.
    base : ndarray
        Its parameter vector. [unit of each]
    unknown : sequence of Unknown
        The numbers.

    Returns
    -------
    ndarray, shape (n, S, K)
        For one standard uncertainty; 0 where the model cannot be run. [unit of each sensor]
    """
    moved, steps = [base], []
    for one in unknown:
        parameter = simulation.building.parameter(one.path)
        value = simulation.value_in(base, one.path)
        step = _STEP * one.uncertainty
        step = step if value + step <= min(parameter.upper, parameter.high) else -step
        moved.append(simulation.varied([one.path], np.array([[value + step]]), base)[0])
        steps.append(step / one.uncertainty)
    series = kept_series(study, simulation, np.array(moved), observation)
    found = (series[1:] - series[0]) / np.array(steps).reshape(-1, 1, 1)
    return np.moveaxis(np.nan_to_num(found), 0, -1)
