"""A calibration problem: parameters, measured series, and the model that computes the series."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError, SolverError
from mascarin.measurements.uncertainty import SensorUncertainty

Floats = NDArray[np.float64]
Model = Callable[[Floats], ArrayLike]
"""``(M, P) -> (M, T, S)``: simulated series of a batch of parameter vectors, in the units of the parameters
and
the sensors. A parameter vector that could not be simulated gives a row of NaN."""
Slopes = Callable[[Floats], ArrayLike]
"""``(P,) -> (T, S, P)``: exact derivatives of the simulated series at one parameter vector by each parameter,
in
the units of the sensors and the parameters."""


@dataclass(frozen=True, slots=True)
class FitParameter:
    """A parameter to estimate.

    Attributes
    ----------
    path : str
        Path of the parameter.
    lower, upper : float
        Range that is searched. [unit]
    start : float, optional
        Where the search begins: the nominal value when absent, else the middle of the range. [unit]
    nominal : float, optional
        Value before the calibration, shown beside the estimate. [unit]
    unit : str
        Unit of the parameter.
    limits : tuple of float
        Values that the parameter can have at all; the range must lie within. [unit]
    scale : str
        ``linear`` or ``log``: how distances are measured in the search.
    prior : tuple of float, optional
        Mean and standard deviation of a normal prior. [unit]

    Raises
    ------
    InputError
        A range, start or prior that cannot be used.

    Examples
    --------
    >>> FitParameter("zones.room.infiltration", 0.1, 2.0, scale="log").first
    0.447213595499958
    """

    path: str
    lower: float
    upper: float
    start: float | None = None
    nominal: float | None = None
    unit: str = ""
    limits: tuple[float, float] = (-math.inf, math.inf)
    scale: Literal["linear", "log"] = "linear"
    prior: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.lower) and math.isfinite(self.upper) and self.lower < self.upper):
            raise InputError(f"{self._range}: expected a finite lower bound below a finite upper bound")
        if self.lower < self.limits[0] or self.upper > self.limits[1]:
            low, high = self.limits
            msg = f"{self._range} is not within the possible values, [{low:g}, {high:g}]: narrow it"
            raise InputError(msg)
        if self.start is not None and not self.lower <= self.start <= self.upper:
            raise InputError(
                f"{self._range} does not contain the start {self.start:g}: move the start or widen the range"
            )
        if self.scale == "log" and self.lower <= 0.0:
            msg = f"{self._range} on a log scale must be positive"
            raise InputError(msg)
        if self.prior is not None and not (math.isfinite(self.prior[0]) and 0.0 < self.prior[1] < math.inf):
            msg = f"{self.path}: prior {self.prior} must be a mean and a positive standard deviation"
            raise InputError(msg)
        if self.prior is not None and self.prior[1] > self.upper - self.lower:
            raise InputError(
                f"{self._range} is narrower than the standard deviation of its prior, {self.prior[1]:g}: "
                "such a prior says nothing; make it smaller, widen the range, or leave the prior out"
            )

    @property
    def first(self) -> float:
        """Where the search begins. [unit]"""
        if self.start is not None:
            return self.start
        if self.nominal is not None and self.lower <= self.nominal <= self.upper:
            return self.nominal
        return self.value(0.5)

    def value(self, z: float) -> float:
        """Convert a position between 0 (lower) and 1 (upper) to a value. [unit]"""
        if z <= 0.0:
            return self.lower
        if z >= 1.0:
            return self.upper
        if self.scale == "log":
            return min(self.lower * math.pow(self.upper / self.lower, z), self.upper)
        return min(self.lower + z * (self.upper - self.lower), self.upper)

    def position(self, value: float) -> float:
        """Convert a value to a position between 0 (lower) and 1 (upper). [-]"""
        if self.scale == "log":
            return math.log(value / self.lower) / math.log(self.upper / self.lower)
        return (value - self.lower) / (self.upper - self.lower)

    def rate(self, z: float) -> float:
        """Differentiate the value by its position, at a position between 0 and 1. [unit]"""
        if self.scale == "log":
            return self.value(z) * math.log(self.upper / self.lower)
        return self.upper - self.lower

    @property
    def _range(self) -> str:
        return f"{self.path}: range [{self.lower:g}, {self.upper:g}] {self.unit}".rstrip()


@dataclass(frozen=True, eq=False)
class FitSensor:
    """A measured series that the model is compared with.

    Attributes
    ----------
    name : str
        Name of the sensor.
    measured : ndarray, shape (T,)
        Measured values, NaN where nothing was measured. [unit]
    standard_uncertainty : float, optional
        Standard deviation of the error of a measured value (GUM). For a sensor in degC 0.5 / 1.96 when
        absent; every other unit needs one. [unit]
    relative_standard_uncertainty : float, optional
        Further standard deviation in proportion to the measured value. [-]
    unit : str
        Unit of the sensor.
    use : ndarray of bool, shape (T,), optional
        Samples to compare; all that were measured when absent.
    weight : float
        How many times each sample counts, beside the weight by its uncertainty. [-]

    Raises
    ------
    InputError
        A series without samples or with one constant value, or an uncertainty that is missing or zero.

    Examples
    --------
    >>> sensor = FitSensor("flux", np.array([10.0, 20.0]), 1.0, 0.05, unit="W/m2")
    >>> sensor.sigma
    array([1.11803399, 1.41421356])
    """

    name: str
    measured: Floats
    standard_uncertainty: float | None = None
    relative_standard_uncertainty: float = 0.0
    unit: str = "degC"
    use: NDArray[np.bool_] | None = None
    weight: float = 1.0

    def __post_init__(self) -> None:
        measured = np.asarray(self.measured, dtype=np.float64)
        object.__setattr__(self, "measured", measured)
        if measured.ndim != 1:
            msg = f"sensor '{self.name}': expected one series, found an array of shape {measured.shape}"
            raise InputError(msg)
        if self.use is not None and np.shape(self.use) != measured.shape:
            msg = f"sensor '{self.name}': {measured.size} samples but a mask of shape {np.shape(self.use)}"
            raise InputError(msg)
        compared = measured[self.mask]
        if compared.size == 0:
            msg = f"sensor '{self.name}' has no value in the period (missing or masked): leave it out"
            raise InputError(msg)
        if compared.size > 1 and np.ptp(compared) == 0.0:
            msg = (
                f"sensor '{self.name}' shows {compared[0]:g} {self.unit} in all {compared.size} samples and "
                f"does not measure: mask it or leave it out"
            )
            raise InputError(msg)
        uncertainty = SensorUncertainty.stated(
            self.unit,
            standard=self.standard_uncertainty,
            relative_standard=self.relative_standard_uncertainty or None,
            where=f"sensor '{self.name}'",
        )
        object.__setattr__(self, "standard_uncertainty", uncertainty.absolute)
        if not self.weight > 0.0:
            raise InputError(
                f"sensor '{self.name}': found weight {self.weight:g}, expected a positive number"
            )
        if np.any(self.sigma[self.mask] <= 0.0):
            raise InputError(
                f"sensor '{self.name}': its uncertainty is zero somewhere; give standard_uncertainty as well"
            )

    @property
    def mask(self) -> NDArray[np.bool_]:
        """Samples that are compared, shape (T,)."""
        finite = np.isfinite(self.measured)
        return finite if self.use is None else finite & np.asarray(self.use, dtype=np.bool_)

    @property
    def sigma(self) -> Floats:
        """Standard uncertainty of each measured value, shape (T,). [unit]"""
        relative = self.relative_standard_uncertainty * np.abs(self.measured)
        return np.asarray(np.hypot(self.standard_uncertainty or 0.0, relative))

    @property
    def span(self) -> float:
        """Largest minus smallest compared value. [unit]"""
        return float(np.ptp(self.measured[self.mask]))


@dataclass(frozen=True, eq=False)
class CalibrationProblem:
    """Parameters, measured series and the model that computes the series from the parameters.

    Attributes
    ----------
    parameters : tuple of FitParameter, length P
        Parameters to estimate.
    sensors : tuple of FitSensor, length S
        Measured series; all at the same T regular instants.
    model : callable
        See `Model`. The order of parameters and sensors is that of this problem.
    identity : str
        Identifies everything that the model depends on beside the parameters (building, climate, period,
        step), such as a hash: a record of evaluations is only continued by a problem of the same identity.
    step : float, optional
        Time between samples. [s]
    slopes : callable, optional
        Exact derivatives of the model, see `Slopes`; raises `SolverError` where there are none.

    Raises
    ------
    InputError
        No parameter or sensor, a name twice, series of different lengths, fewer samples than parameters.

    Examples
    --------
    >>> time = np.arange(24.0)
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 10.0, 30.0, nominal=18.0),),
    ...     (FitSensor("room", 20.0 + 0.1 * np.sin(time), 0.1),),
    ...     lambda x: np.tile(x[:, :, None], (1, 24, 1)),
    ... )
    >>> problem.residuals(np.array([[20.0]])).shape
    (1, 24, 1)
    """

    parameters: tuple[FitParameter, ...]
    sensors: tuple[FitSensor, ...]
    model: Model
    identity: str = ""
    step: float | None = None
    slopes: Slopes | None = None
    measured: Floats = field(init=False)
    mask: NDArray[np.bool_] = field(init=False)
    sigma: Floats = field(init=False)

    def __post_init__(self) -> None:
        for name in ("parameters", "sensors"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        _named_once("parameter", [p.path for p in self.parameters])
        _named_once("sensor", [s.name for s in self.sensors])
        lengths = {s.name: s.measured.size for s in self.sensors}
        if len(set(lengths.values())) > 1:
            text = ", ".join(f"'{name}' {n}" for name, n in lengths.items())
            msg = f"sensors must share their instants, found numbers of samples {text}"
            raise InputError(msg)
        object.__setattr__(self, "measured", np.column_stack([s.measured for s in self.sensors]))
        object.__setattr__(self, "mask", np.column_stack([s.mask for s in self.sensors]))
        object.__setattr__(self, "sigma", np.column_stack([s.sigma for s in self.sensors]))
        samples = int(self.mask.sum())
        if samples < len(self.parameters):
            msg = (
                f"{len(self.parameters)} parameters cannot be estimated from {samples} measured values: "
                f"estimate fewer, or compare a longer period"
            )
            raise InputError(msg)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the parameters."""
        return tuple(p.path for p in self.parameters)

    def values(self, z: Floats) -> Floats:
        """Convert positions between 0 and 1 to values, both (M, P). [unit of each parameter]"""
        return np.array([[p.value(float(v)) for p, v in zip(self.parameters, row, strict=True)] for row in z])

    def positions(self, x: Floats) -> Floats:
        """Convert values to positions between 0 and 1, both (P,). [-]"""
        return np.array([p.position(float(v)) for p, v in zip(self.parameters, x, strict=True)])

    def residuals(self, x: Floats) -> Floats:
        """Compute simulated minus measured series of a batch.

        Parameters
        ----------
        x : ndarray, shape (M, P)
            Parameter vectors. [unit of each parameter]

        Returns
        -------
        ndarray, shape (M, T, S)
            0 where nothing is compared; all NaN for a parameter vector that could not be simulated. [unit]

        Raises
        ------
        InputError
            When the model returns another shape.
        """
        simulated = np.asarray(self.model(x), dtype=np.float64)
        if simulated.shape != (x.shape[0], *self.measured.shape):
            msg = (
                f"the model returned an array of shape {simulated.shape} for {x.shape[0]} parameter "
                f"vectors, expected {(x.shape[0], *self.measured.shape)}: parameter vectors, times, sensors"
            )
            raise InputError(msg)
        residuals = np.where(self.mask, simulated - np.where(self.mask, self.measured, 0.0), 0.0)
        failed = ~np.isfinite(residuals).all(axis=(1, 2))
        residuals[failed] = np.nan
        return residuals

    def require_slopes(self) -> Slopes:
        """Return the derivatives of the model.

        Raises
        ------
        InputError
            When there are none.
        """
        if self.slopes is None:
            msg = (
                "slopes: found 'exact', but the model of this problem is a function without derivatives; "
                "give them as CalibrationProblem(slopes=...), or choose slopes 'differences'"
            )
            raise InputError(msg)
        return self.slopes

    def jacobian(self, x: Floats) -> Floats:
        """Compute exact derivatives of the residuals by the parameters.

        Parameters
        ----------
        x : ndarray, shape (P,)
            Parameter vector. [unit of each parameter]

        Returns
        -------
        ndarray, shape (T, S, P)
            0 where nothing is compared. [unit of the sensor / unit of the parameter]

        Raises
        ------
        InputError
            When the model has no derivatives, or returns another shape.
        SolverError
            When it has none at this parameter vector.
        """
        derivative = self.require_slopes()
        where = ", ".join(f"{p} = {v:g}" for p, v in zip(self.paths, x.tolist(), strict=True))
        try:
            slopes = np.asarray(derivative(x), dtype=np.float64)
        except SolverError as error:
            msg = f"the model has no derivative at {where}: {error}"
            raise SolverError(msg) from error
        if slopes.shape != (*self.measured.shape, x.size):
            msg = (
                f"the model returned slopes of shape {slopes.shape}, expected "
                f"{(*self.measured.shape, x.size)}: times, sensors, parameters"
            )
            raise InputError(msg)
        slopes = np.where(self.mask[:, :, None], slopes, 0.0)
        if not np.isfinite(slopes).all():
            msg = f"the model has no derivative at {where}: it is not a number"
            raise SolverError(msg)
        return slopes

    def rates(self, z: Floats) -> Floats:
        """Differentiate each value by its position, both (P,). [unit of each parameter]"""
        return np.array([p.rate(float(v)) for p, v in zip(self.parameters, z, strict=True)])

    def fingerprint(self) -> str:
        """Return a hash of everything that an evaluation depends on."""
        digest = hashlib.sha256()
        digest.update(repr((self.identity, self.paths, [s.name for s in self.sensors])).encode())
        for array in (
            np.where(self.mask, self.measured, 0.0),
            self.mask,
            np.where(self.mask, self.sigma, 0.0),
        ):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()


def _named_once(what: str, names: Sequence[str]) -> None:
    if not names:
        msg = f"a calibration needs at least one {what}"
        raise InputError(msg)
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        msg = f"{what} '{twice[0]}' is listed twice"
        raise InputError(msg)
