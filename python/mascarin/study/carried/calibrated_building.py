"""The calibrated building with its posterior: written as calibrated.yaml, extended by other buildings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin import __version__
from mascarin.building.parts.posterior import Posterior, SensorPosterior, table_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.calibration import Calibration
    from mascarin.calibration.errors.joint_posterior import JointPosterior

    Array = npt.NDArray[np.float64]

FILE: Final = "calibrated.yaml"
"""Name of the file in the folder of a study."""

#: Rows of the sample that is written.
_ROWS: Final = 100
_SEED: Final = 41


@dataclass(frozen=True, slots=True)
class SensorRecord:
    """A sensor of an identification and the errors there.

    Attributes
    ----------
    name, output, unit : str
        The sensor, the output of the model and its unit.
    simulated : ndarray, shape (n,)
        Series of the calibrated model in the identification. [unit]
    limit : float
        Largest standard deviation of an error of the model that the study allows. [unit]
    repeating, daily, independent : float
        Standard deviations of the errors of the model: one that repeats every day, one that differs from day
        to day, and what differs from value to value. [unit]
    """

    name: str
    output: str
    unit: str
    simulated: Array
    limit: float
    repeating: float
    daily: float
    independent: float


@dataclass(frozen=True, slots=True)
class OtherNumbers:
    """Numbers of the building that are not estimated, and what the identification tells of them.

    Attributes
    ----------
    paths : tuple of str, length K
        The numbers.
    uncertainty : ndarray, shape (K,)
        Standard uncertainty before the identification. [unit of each]
    directions : ndarray, shape (K, r)
        Combinations that the identification tells, in standard uncertainties: the last errors of sensors of
        the joint distribution. [-]
    """

    paths: tuple[str, ...]
    uncertainty: Array
    directions: Array


def with_posterior(
    fit: Calibration,
    joint: JointPosterior | None,
    numbers: OtherNumbers | None,
    sensors: Sequence[SensorRecord],
    weather: Mapping[str, Array],
    *,
    study: str,
    days: int,
    stated: bool,
) -> Building:
    """The calibrated building with the section `posterior`.

    Parameters
    ----------
    fit : Calibration
        Estimates and intervals, those of the report.
    joint : JointPosterior, optional
        Joint distribution with the errors of sensors and model, where these are estimated.
    numbers : OtherNumbers, optional
        Numbers that are not estimated, of the same distribution.
    sensors : sequence of SensorRecord
        Sensors that were used.
    weather : mapping of str to ndarray
        Daily means of the weather in the identification, by channel. [unit of each]
    study : str
        Name of the study.
    days : int
        Days of the identification.
    stated : bool
        Whether bands are to be stated.
    """
    building = fit.building
    # A factor of tied numbers is one of the calibrated building: its estimate is in their values already.
    factors = [building.ties.get(path) == "factor" for path in fit.problem.paths]
    scale = np.where(factors, fit.x, 1.0)
    intervals = {
        path: (_short(x), _short(low), _short(high))
        for path, x, low, high in zip(
            fit.problem.paths,
            (fit.x / scale).tolist(),
            (fit.low / scale).tolist(),
            (fit.high / scale).tolist(),
            strict=True,
        )
    }
    positions = _positions(fit, joint)
    sample = as_reported(fit, positions) / scale
    described: dict[str, float] = {}
    if joint is not None and numbers is not None:
        described, columns = _other_numbers(building, joint, numbers, positions)
        sample = np.column_stack([sample, columns])
    ranges = {name: (_short(np.min(v)), _short(np.max(v))) for name, v in weather.items() if v.size}
    return building.replace(
        {
            "posterior": Posterior.sealed(
                study=study,
                mascarin=__version__,
                confidence=fit.confidence,
                days=max(days, 1),
                stated=stated,
                intervals=intervals,
                numbers=described,
                sample=table_of((*intervals, *described), sample),
                sensors={sensor.name: _sensor(sensor, joint) for sensor in sensors},
                weather=ranges,
            )
        }
    )


def _positions(fit: Calibration, joint: JointPosterior | None) -> Array:
    """Sample of the positions of the parameters in their ranges, shape (n, P). [-]"""
    rng = np.random.default_rng(_SEED)
    if joint is not None:
        return np.asarray(rng.permutation(joint.widened())[:_ROWS])
    value, vectors = np.linalg.eigh(np.nan_to_num(np.atleast_2d(fit.uncertainty.covariance)))
    root = vectors * np.sqrt(np.maximum(value, 0.0))
    center = fit.problem.positions(fit.x)
    return np.asarray(np.clip(center + rng.standard_normal((_ROWS, center.size)) @ root.T, 0.0, 1.0))


def as_reported(fit: Calibration, positions: Array) -> Array:
    """A sample of positions (n, P) as values with the intervals of the report, shape (n, P). [unit of each]

    The intervals account for other forms of the model and for what contradicts it; the distances from the
    median are scaled to them, below and above.
    """
    problem, tail = fit.problem, 0.5 * (1.0 - fit.confidence)
    ends = problem.positions(np.where(np.isfinite(fit.low), fit.low, fit.x))
    tops = problem.positions(np.where(np.isfinite(fit.high), fit.high, fit.x))
    low, middle, high = np.quantile(positions, [tail, 0.5, 1.0 - tail], axis=0)
    away = positions - middle
    below = np.maximum(middle - ends, 0.0) / np.maximum(middle - low, 1e-12)
    above = np.maximum(tops - middle, 0.0) / np.maximum(high - middle, 1e-12)
    return problem.values(np.clip(middle + np.where(away < 0.0, below, above) * away, 0.0, 1.0))


def _other_numbers(
    building: Building, joint: JointPosterior, numbers: OtherNumbers, positions: Array
) -> tuple[dict[str, float], Array]:
    """Numbers that are not estimated: their values as described, and a sample of them (n, K).

    Given the parameters the combinations that the identification tells are normal; all others are as
    uncertain as they were.
    """
    rng = np.random.default_rng(_SEED)
    count, direction_count = joint.z.size, numbers.directions.shape[1]
    first = count + len(joint.names) - direction_count
    block = slice(first, first + direction_count)
    covariance = joint.covariance
    ridge = 1e-12 * np.eye(count)
    gain = np.linalg.solve(covariance[:count, :count] + ridge, covariance[:count, block]).T
    conditional = covariance[block, block] - gain @ covariance[:count, block]
    value, vectors = np.linalg.eigh(0.5 * (conditional + conditional.T))
    root = vectors * np.sqrt(np.maximum(value, 0.0))
    along = joint.mean[block] + (positions - joint.mean[:count]) @ gain.T
    along = along + rng.standard_normal((len(positions), direction_count)) @ root.T
    free = rng.standard_normal((len(positions), len(numbers.paths)))
    free -= free @ numbers.directions @ numbers.directions.T
    moved = (along @ numbers.directions.T + free) * numbers.uncertainty
    described, columns = {}, []
    for k, path in enumerate(numbers.paths):
        if path.startswith("sensors."):
            continue  # of the experiment, not of the building
        parameter = building.parameter(path)
        described[path] = _short(parameter.value)
        columns.append(np.clip(parameter.value + moved[:, k], parameter.low, parameter.high))
    return described, np.array(columns).reshape(len(columns), len(positions)).T


def _sensor(sensor: SensorRecord, joint: JointPosterior | None) -> SensorPosterior:
    errors = {}
    if joint is not None:
        first = joint.z.size
        spread = np.sqrt(np.diag(joint.covariance))
        for k, name in enumerate(joint.names):
            if name.startswith(f"{sensor.name} "):
                kind = name.removeprefix(f"{sensor.name} ")
                errors[kind] = (_short(joint.mean[first + k]), _short(spread[first + k]))
    return SensorPosterior(
        output=sensor.output,
        unit=sensor.unit,
        range=(_short(np.nanmin(sensor.simulated)), _short(np.nanmax(sensor.simulated))),
        repeating=_short(sensor.repeating),
        daily=_short(sensor.daily),
        independent=_short(sensor.independent),
        limit=_short(sensor.limit),
        errors=errors,
    )


def _short(value: float) -> float:
    """A number with six digits."""
    return float(f"{float(value):.6g}")
