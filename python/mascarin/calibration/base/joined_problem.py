"""Calibration problems of several experiments as one: they share parameters, and each has its own sensors.

The series of the experiments stand one after the other, and a sensor is compared in its own experiment alone.
Errors of different experiments are independent, so that the log-likelihood is the sum of theirs.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem, FitParameter, FitSensor, Model
from mascarin.calibration.base.result import Calibration, Minimum
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Share:
    """An experiment and its part of the problem of all.

    Attributes
    ----------
    problem : CalibrationProblem
        Of the experiment alone.
    columns : tuple of int
        Its parameters among those of all.
    rows, sensors : slice
        Its samples and sensors.
    """

    problem: CalibrationProblem
    columns: tuple[int, ...]
    rows: slice
    sensors: slice


@dataclass(frozen=True, eq=False)
class JoinedProblem(CalibrationProblem):
    """The problem of several experiments.

    Attributes
    ----------
    shares : dict of str to Share
        The experiments by name.
    """

    shares: dict[str, Share] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class _Series:
    """Series of all experiments, one after the other; 0 where a sensor is of another one."""

    shares: tuple[Share, ...]
    samples: int
    sensors: int

    def __call__(self, x: Floats) -> Floats:
        """Simulate parameter vectors (M, P), shape (M, T, S). [unit of each sensor]"""
        series = np.zeros((len(x), self.samples, self.sensors))
        for share in self.shares:
            series[:, share.rows, share.sensors] = share.problem.model(x[:, share.columns])
        return series

    def slopes(self, x: Floats) -> Floats:
        """Differentiate the series at a parameter vector (P,), shape (T, S, P). [unit of each]"""
        slopes = np.zeros((self.samples, self.sensors, x.size))
        for share in self.shares:
            slopes_of_share = share.problem.require_slopes()(x[list(share.columns)])
            slopes[share.rows, share.sensors, list(share.columns)] = slopes_of_share
        return slopes


def joined(
    problems: Mapping[str, CalibrationProblem], *, own_paths: Collection[str] = ()
) -> CalibrationProblem:
    """Join the problems of experiments that share parameters.

    Parameters
    ----------
    problems : mapping of str to CalibrationProblem
        Problem of each experiment by its name. Parameters of one path are one parameter.
    own_paths : collection of str
        Paths of which every experiment has its own value; their names get that of the experiment.

    Returns
    -------
    CalibrationProblem
        That of the experiment if there is one only, else a `JoinedProblem`.

    Raises
    ------
    InputError
        A shared parameter has other bounds, another prior or another value in two experiments.

    Examples
    --------
    Two rooms share a level, which each measures with its own sensor:

    >>> def room(value):
    ...     return CalibrationProblem(
    ...         (FitParameter("level", 0.0, 10.0),),
    ...         (FitSensor("air", np.array([value, value + 0.1]), 0.1),),
    ...         lambda x: np.tile(x[:, :, None], (1, 2, 1)),
    ...     )
    >>> both = joined({"south": room(4.0), "north": room(5.0)})
    >>> [sensor.name for sensor in both.sensors], both.measured.shape
    (['south air', 'north air'], (4, 2))
    """
    if len(problems) == 1:
        return next(iter(problems.values()))
    parameters: dict[str, FitParameter] = {}
    first: dict[str, str] = {}
    shares: dict[str, Share] = {}
    row, sensor = 0, 0
    for name, problem in problems.items():
        columns = []
        for parameter in problem.parameters:
            path = f"{parameter.path} ({name})" if parameter.path in own_paths else parameter.path
            if path in parameters:
                _require_same(parameters[path], parameter, first[path], name)
            else:
                parameters[path], first[path] = replace(parameter, path=path), name
            columns.append(list(parameters).index(path))
        length, count = problem.measured.shape
        shares[name] = Share(problem, tuple(columns), slice(row, row + length), slice(sensor, sensor + count))
        row, sensor = row + length, sensor + count
    series = _Series(tuple(shares.values()), row, sensor)
    model: Model = series
    steps = {problem.step for problem in problems.values()}
    exact = all(problem.slopes is not None for problem in problems.values())
    identity = hashlib.sha256(repr([(n, p.identity) for n, p in problems.items()]).encode()).hexdigest()
    return JoinedProblem(
        tuple(parameters.values()),
        tuple(
            _among(own_sensor, name, share, row)
            for name, share in shares.items()
            for own_sensor in share.problem.sensors
        ),
        model,
        identity=identity,
        step=steps.pop() if len(steps) == 1 else None,
        slopes=series.slopes if exact else None,
        shares=shares,
    )


def _among(sensor: FitSensor, name: str, share: Share, samples: int) -> FitSensor:
    """A sensor with the samples of all experiments."""
    measured, use = np.full(samples, np.nan), np.zeros(samples, dtype=np.bool_)
    measured[share.rows], use[share.rows] = sensor.measured, sensor.mask
    return replace(sensor, name=f"{name} {sensor.name}", measured=measured, use=use)


def _require_same(shared: FitParameter, other: FitParameter, first: str, name: str) -> None:
    """Refuse a shared parameter of which two experiments say different things."""
    for what, first_value, other_value in (
        ("the value", shared.nominal, other.nominal),
        ("the range", (shared.lower, shared.upper), (other.lower, other.upper)),
        ("the prior", shared.prior, other.prior),
        ("the scale", shared.scale, other.scale),
    ):
        if first_value != other_value:
            raise InputError(
                f"{other.path}: found {what} {_words(first_value)} in '{first}' and {_words(other_value)} in "
                f"'{name}', expected the same in all experiments that share it: state it for all, write "
                "per_experiment: true so that each has its own, or tie the numbers of a path with * by a "
                "factor"
            )


def _words(value: object) -> str:
    match value:
        case float():
            return f"{value:g}"
        case tuple():
            return f"[{', '.join(f'{end:g}' for end in value)}]"
        case _:
            return str(value)


def shares_of(problem: CalibrationProblem) -> Sequence[Share]:
    """Parts of a problem: those of its experiments, or the problem itself.

    Parameters
    ----------
    problem : CalibrationProblem
        From `joined`.
    """
    if isinstance(problem, JoinedProblem):
        return tuple(problem.shares.values())
    columns = tuple(range(len(problem.parameters)))
    return (Share(problem, columns, slice(None), slice(None)),)


def of_experiment(fit: Calibration, share: Share, building: Building | None) -> Calibration:
    """A calibration of several experiments as one of them has it.

    Parameters
    ----------
    fit : Calibration
        Of the problem of all.
    share : Share
        Which one, from `shares_of`.
    building : Building or None
        That of the experiment before the calibration.

    Returns
    -------
    Calibration
        Its own parameters and sensors; the cost is that of all. The calibration itself if there is one
        experiment only.
    """
    if not isinstance(fit.problem, JoinedProblem):
        return fit
    names = fit.problem.paths
    paths = {names[k]: p.path for k, p in zip(share.columns, share.problem.parameters, strict=True)}
    columns, sensors = list(share.columns), share.sensors
    square = np.ix_(columns, columns)
    joint, trace = fit.uncertainty, fit.trace
    uncertainty = replace(
        joint,
        low=joint.low[columns],
        high=joint.high[columns],
        sd=joint.sd[columns],
        correlation=joint.correlation[square],
        effective_samples=joint.effective_samples[sensors],
        order=joint.order[sensors],
        quantile=joint.quantile[columns],
        covariance=joint.covariance[square],
        information=_marginal(joint.information, columns),
        error=joint.error[sensors],
        stretch=joint.stretch[square],
    )
    return replace(
        fit,
        problem=share.problem,
        x=fit.x[columns],
        low=fit.low[columns],
        high=fit.high[columns],
        correlation=fit.correlation[square],
        of_sensors=fit.of_sensors[sensors],
        residuals=fit.residuals[share.rows, sensors],
        uncertainty=uncertainty,
        on_bound={paths[name]: reason for name, reason in fit.on_bound.items() if name in paths},
        minima=tuple(_minimum(minimum, columns) for minimum in fit.minima),
        trace=replace(trace, x=trace.x[:, columns], of_sensors=trace.of_sensors[:, sensors]),
        samples=None if fit.samples is None else fit.samples[:, columns],
        nominal_building=building,
    )


def _minimum(minimum: Minimum, columns: list[int]) -> Minimum:
    return replace(minimum, start=minimum.start[columns], x=minimum.x[columns])


def _marginal(information: Floats, columns: list[int]) -> Floats:
    """Information of some parameters where all others are estimated, too."""
    if len(columns) == len(information):
        return np.asarray(information[np.ix_(columns, columns)])
    inverse = np.linalg.pinv(information)
    return np.asarray(np.linalg.pinv(inverse[np.ix_(columns, columns)]))
