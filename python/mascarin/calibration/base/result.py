"""The result of a calibration: estimates, their uncertainty, and how they were found."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin._io import display
from mascarin._io.numbers import with_interval
from mascarin.calibration.base.cost import ONE_NUMBER, Cost, CostName
from mascarin.calibration.base.evaluations import Trace
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.uncertainty import METHOD, Uncertainty
from mascarin.calibration.sampling.posterior_sample import PosteriorSample
from mascarin.errors import InputError, did_you_mean
from mascarin.figures import calibration as figures

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from mascarin.building import Building

Floats = NDArray[np.float64]

PlotKind = Literal["estimates", "correlation", "convergence", "minima", "residuals"]
KINDS: Final[tuple[PlotKind, ...]] = ("estimates", "correlation", "convergence", "minima", "residuals")


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where one search ended.

    Attributes
    ----------
    sequence : int
        Number of the search, from 0.
    start, x : ndarray, shape (P,)
        Where it began and ended. [unit of each parameter]
    cost : float
        Cost at the end.
    evaluations : int
        Number of evaluations of the search. [-]
    reason : str
        Why it ended.

    Examples
    --------
    >>> Minimum(0, np.array([1.0]), np.array([2.0]), 0.5, 12, "converged").cost
    0.5
    """

    sequence: int
    start: Floats
    x: Floats
    cost: float
    evaluations: int
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class Calibration:
    """Estimates of parameters with their uncertainty, and how they were found.

    Attributes
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    method, cost_name : str
        Search method and cost.
    x : ndarray, shape (P,)
        Estimates. [unit of each parameter]
    low, high : ndarray, shape (P,)
        Confidence intervals, within the range searched; NaN where the cost allows none. [unit]
    correlation : ndarray, shape (P, P)
        Between the estimates. [-]
    confidence : float
        Of the intervals. [-]
    cost : float
        At the estimates.
    of_sensors : ndarray, shape (S,)
        Cost of each sensor at the estimates.
    residuals : ndarray, shape (T, S)
        Simulated minus measured at the estimates, NaN where nothing is compared. [unit of each sensor]
    uncertainty : Uncertainty
        Covariance, effective samples and more.
    on_bound : dict of str to str
        Reason for every estimate on a bound, by path.
    warnings : tuple of str
        What limits the use of the estimates, in sentences.
    minima : tuple of Minimum
        Where every search ended, in their order.
    reason : str
        Why the calibration ended.
    trace : Trace
        All evaluations.
    seed : int
        Of the random numbers.
    uncertainty_method : str
        How the intervals were computed.
    samples : ndarray, shape (n, P), optional
        Posterior sample of the method ``emcee``. [unit of each parameter]
    posterior : PosteriorSample, optional
        Chains with their convergence, where the posterior was sampled; ``to_netcdf`` writes them for ArviZ.
    nominal_building : Building, optional
        The building before the calibration; None for a problem on arrays.
    times : pandas.DatetimeIndex, optional
        Times of the residuals, shape (T,), in the time zone of the climate.

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, solve
    >>> hour = np.arange(48.0)
    >>> measured = 20.0 + 0.1 * np.random.default_rng(1).normal(size=48)
    >>> found = solve(
    ...     CalibrationProblem(
    ...         (FitParameter("level", 10.0, 30.0),),
    ...         (FitSensor("room", measured, 0.1),),
    ...         lambda x: np.tile(x[:, :, None], (1, 48, 1)),
    ...     )
    ... )
    >>> bool(found.low[0] < 20.0 < found.high[0])
    True
    >>> list(found.to_dataframe().columns[:4])
    ['nominal', 'estimate', 'standard_error', 'low']
    """

    problem: CalibrationProblem
    method: str
    cost_name: CostName
    x: Floats
    low: Floats
    high: Floats
    correlation: Floats
    confidence: float
    cost: float
    of_sensors: Floats
    residuals: Floats
    uncertainty: Uncertainty
    on_bound: dict[str, str]
    warnings: tuple[str, ...]
    minima: tuple[Minimum, ...]
    reason: str
    trace: Trace
    seed: int

    uncertainty_method: str = METHOD
    samples: Floats | None = None
    nominal_building: Building | None = None
    times: pd.DatetimeIndex | None = None
    posterior: PosteriorSample | None = None

    @property
    def values(self) -> dict[str, float]:
        """Estimates by path. [unit of each parameter]"""
        return dict(zip(self.problem.paths, self.x.tolist(), strict=True))

    @property
    def standard_error(self) -> Floats:
        """Standard deviation of each estimate, shape (P,); NaN where the cost allows none. [unit]"""
        if self.cost_name in ONE_NUMBER:
            return np.full(self.x.size, np.nan)
        return self.uncertainty.sd * self.problem.rates(self.problem.positions(self.x))

    @property
    def building(self) -> Building:
        """The calibrated building: the nominal one with the estimates; it can be saved and simulated.

        Raises
        ------
        InputError
            The problem was one on arrays, without a building.
        """
        if self.nominal_building is None:
            raise InputError("building: this calibration was made by solve() on arrays and has no building")
        # The package imports pydantic, which an evaluation for GenOpt does without.
        from mascarin.building.parameters.set_point_pairs import tied_set_points

        tied = tied_set_points(self.nominal_building)
        following = {tied[path]: value for path, value in self.values.items() if path in tied}
        return self.nominal_building.with_values({**following, **self.values})

    def to_dict(self) -> dict[str, dict[str, float | str | None]]:
        """Return the parameters as ``{path: {nominal, fitted, low, high, unit}}``, ready for JSON."""
        return {
            p.path: {
                "nominal": p.nominal,
                "fitted": float(self.x[i]),
                "low": _number(self.low[i]),
                "high": _number(self.high[i]),
                "unit": p.unit,
            }
            for i, p in enumerate(self.problem.parameters)
        }

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with one row for each parameter.

        Returns
        -------
        pandas.DataFrame
            Index: paths. Columns: ``nominal``, ``estimate``, ``standard_error``, ``low`` and ``high`` (95 %
            interval) [unit], ``unit``, ``correlation`` with the estimate that it is correlated with most [-],
            the path of that parameter (``correlated_with``), and a ``remark`` for an estimate on a bound.
        """
        import pandas as pd

        parameters = self.problem.parameters
        off_diagonal = np.abs(self.correlation) - 2.0 * np.eye(self.x.size)
        most = off_diagonal.argmax(axis=1)
        alone = self.x.size == 1
        return pd.DataFrame(
            {
                "nominal": [math.nan if p.nominal is None else p.nominal for p in parameters],
                "estimate": self.x,
                "standard_error": self.standard_error,
                "low": self.low,
                "high": self.high,
                "unit": [p.unit for p in parameters],
                "correlation": [math.nan if alone else self.correlation[i, k] for i, k in enumerate(most)],
                "correlated_with": ["" if alone else self.problem.paths[k] for k in most],
                "remark": [self.on_bound.get(p.path, "") for p in parameters],
            },
            index=pd.Index(self.problem.paths, name="parameter"),
        )

    def correlations(self) -> pd.DataFrame:
        """Return the matrix of correlations between the estimates, with paths as labels. [-]"""
        import pandas as pd

        paths = list(self.problem.paths)
        return pd.DataFrame(self.correlation, index=paths, columns=paths)

    def evaluations(self) -> pd.DataFrame:
        """Return every evaluation in its order: the parameters, the cost of each sensor and the total."""
        import pandas as pd

        columns = {path: self.trace.x[:, i] for i, path in enumerate(self.problem.paths)}
        sensors = {f"cost {s.name}": self.trace.of_sensors[:, k] for k, s in enumerate(self.problem.sensors)}
        return pd.DataFrame({**columns, **sensors, "cost": self.trace.cost})

    def distinct_minima(self, *, within: float = 1e-3, apart: float = 0.02) -> list[list[Minimum]]:
        """Group the minima by where they are, the lowest group first.

        Parameters
        ----------
        within : float
            Largest relative difference of the costs of two minima in one group; see `Cost.tolerance`. [-]
        apart : float
            Largest difference of any parameter within a group, as a part of its range. [-]

        Returns
        -------
        list of list of Minimum
            Each group begins with its lowest member.
        """
        groups: list[list[Minimum]] = []
        tolerance = Cost(self.problem, self.cost_name).tolerance(self.cost, within)
        for minimum in sorted(self.minima, key=lambda m: m.cost):
            z = self.problem.positions(minimum.x)
            for group in groups:
                away = np.abs(self.problem.positions(group[0].x) - z).max()
                if away <= apart and minimum.cost - group[0].cost <= tolerance:
                    group.append(minimum)
                    break
            else:
                groups.append([minimum])
        return groups

    def histogram(self, bins: int = 20) -> tuple[NDArray[np.int64], Floats]:
        """Count how many searches ended at which cost.

        Parameters
        ----------
        bins : int
            Number of bins from the lowest to the highest cost. [-]

        Returns
        -------
        tuple of ndarray
            Counts (bins,) and edges (bins + 1,).
        """
        costs = np.array([m.cost for m in self.minima if math.isfinite(m.cost)])
        # Equal costs differ by rounding, which cannot be divided into bins.
        low, high = float(np.min(costs)), float(np.max(costs))
        least = 1e-9 * max(abs(low), abs(high)) or 1e-9
        counts, edges = np.histogram(costs, bins=bins, range=(low, max(high, low + least)))
        return counts.astype(np.int64), edges.astype(np.float64)

    def plot(self, kind: PlotKind = "estimates", *, ax: Axes | None = None) -> Axes:
        """Draw the calibration.

        Parameters
        ----------
        kind : str
            ``estimates`` with their intervals; ``correlation`` between them; ``convergence``: the cost of
            every evaluation; ``minima``: how many searches ended at which cost; ``residuals`` over time.
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure when absent.

        Returns
        -------
        matplotlib.axes.Axes
            With the drawing; ``axes.figure.savefig(...)`` saves it.

        Raises
        ------
        InputError
            Unknown kind.
        """
        if kind not in KINDS:
            raise InputError(
                f"kind: found '{kind}', expected one of {', '.join(KINDS)}. "
                f"{did_you_mean(kind, KINDS, known=False)}".rstrip()
            )
        axes = _new_axes() if ax is None else ax
        problem, names = self.problem, self.problem.paths
        match kind:
            case "estimates":
                columns = (self.x, self.low, self.high, self._nominal())
                figures.estimates(axes, names, *(self._positions(column) for column in columns))
            case "correlation":
                figures.correlation(axes, names, self.correlation)
            case "convergence":
                figures.convergence(axes, self.trace.cost, self.cost)
                axes.set_title(f"{self.method}: {self.reason}", fontsize=9, loc="left")
            case "minima":
                groups = self.distinct_minima()
                figures.minima(axes, *self.histogram(30))
                count = f"{len(self.minima)} searches, {len(groups)} distinct minima"
                axes.set_title(f"{count}, {len(groups[0])} in the lowest", fontsize=9, loc="left")
            case "residuals":
                times = np.arange(len(self.residuals), dtype=np.float64) if self.times is None else self.times
                sensors = [s.name for s in problem.sensors], [s.unit for s in problem.sensors]
                figures.residuals(axes, times, self.residuals, *sensors)
        return axes

    def __repr__(self) -> str:
        return display.text(self._title(), self._rows())

    def _repr_html_(self) -> str:
        tables = {"Estimates": self.to_dataframe(), "Correlations": self.correlations()}
        return display.page(self._title(), self._rows(), tables=tables)

    def _title(self) -> str:
        count = self.x.size
        return f"Calibration of {count} parameter{'s' * (count != 1)} by {self.method}"

    def _rows(self) -> list[tuple[str, str]]:
        sensors = ", ".join(s.name for s in self.problem.sensors)
        rows = [
            ("sensors", sensors),
            ("cost", f"{self.cost_name} = {self.cost:.6g}"),
            ("searches", f"{len(self.minima)}; {self.reason}"),
            ("warnings", f"{len(self.warnings)}, see .warnings" if self.warnings else "none"),
        ]
        if self.on_bound:
            rows.append(("on a bound", f"{', '.join(self.on_bound)}; see .on_bound"))
        for i, p in enumerate(self.problem.parameters):
            value, low, high = with_interval(*(float(each[i]) for each in (self.x, self.low, self.high)))
            interval = f" [{low}, {high}]" if low else ""
            rows.append((p.path, f"{value}{interval} {p.unit}".rstrip(" -")))
        return rows

    def _nominal(self) -> Floats:
        return np.array([math.nan if p.nominal is None else p.nominal for p in self.problem.parameters])

    def _positions(self, values: Floats) -> Floats:
        """Positions in the ranges; NaN stays."""
        pairs = zip(self.problem.parameters, values.tolist(), strict=True)
        return np.array(
            [p.position(v) if v > 0.0 or (p.scale == "linear" and v <= 0.0) else math.nan for p, v in pairs]
        )


def _new_axes() -> Axes:
    # A figure of pyplot, so that a notebook shows it.
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(7.0, 3.2), layout="constrained")[1]


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
