"""The result of a sensitivity analysis, of any method."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin._io import display
from mascarin.errors import InputError, did_you_mean
from mascarin.figures import sensitivity as figures

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mascarin.simulation.checks.warning_kinds import RunWarning

Floats = NDArray[np.float64]

FIRST_ORDER: Final = "first-order index S1"
"""What `Sensitivity.index` is, for all methods but Morris'."""

_MAX_OUTPUTS: Final = 3
_MAX_ROWS: Final = 10


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sensitivity:
    """Sensitivity indices of each output with respect to each parameter, with confidence intervals.

    Made by `mascarin.sensitivity_analysis`, or by `mascarin.sensitivity.run` for any model.

    Parameters
    ----------
    method : str
        Name of the method.
    names : tuple of str, length G
        Parameter paths, or names of groups.
    outputs : tuple of str, length S
        Output names.
    units : tuple of str, length S
        Unit of each output.
    index : ndarray, shape (G, S)
        The index by which parameters are ranked: the first-order index S1 (Morris: see `measure`). For a
        time series, the sum over time of the part of the variance, divided by the sum of the variance. [-]
    low, high : ndarray, shape (G, S)
        Ends of the confidence interval of `index`. [-]
    effect : ndarray, shape (G, S)
        Change of the output, averaged over time, when the parameter goes from the low to the high end of
        its range; NaN where a method or a group has no sign. [unit of the output]
    significant : ndarray of bool, shape (G, S)
        Whether the index is above zero, in a test of all parameters together (Bonferroni).
    confidence : float
        Of the intervals. [-]
    runs : int
        Number of simulations used. [-]
    seed : int
        Seed of the random numbers.
    warnings : tuple of RunWarning
        Remarks, such as an output that no parameter changes.
    measure : str
        What `index` is, in words.
    total, total_low, total_high : ndarray, shape (G, S), optional
        Total index ST with its interval: the part of the variance that would vanish if the parameter were
        known, interactions included. None for methods that do not give it. [-]
    times : pandas.DatetimeIndex, optional
        Times that were analyzed, in local time of the climate; None for models without times.

    References
    ----------
    Sobol' I.M. (2001), Math. Comput. Simul. 55, 271. https://doi.org/10.1016/S0378-4754(00)00270-6
    Saltelli A. et al. (2010), Comput. Phys. Commun. 181, 259. https://doi.org/10.1016/j.cpc.2009.09.018

    Examples
    --------
    >>> from mascarin.sensitivity import Factor, plan, run
    >>> factors = [Factor("a", 0.0, 1.0), Factor("b", 0.0, 1.0)]
    >>> found = run(plan(factors), lambda x: x @ [[3.0], [1.0]], outputs=["y"], units=["K"])
    >>> found.to_dataframe()[["output", "parameter", "S1"]].round(2)
      output parameter   S1
    0      y         a  0.9
    1      y         b  0.1
    """

    method: str
    names: tuple[str, ...]
    outputs: tuple[str, ...]
    units: tuple[str, ...]
    index: Floats
    low: Floats
    high: Floats
    effect: Floats
    significant: NDArray[np.bool_]
    confidence: float
    runs: int
    seed: int
    warnings: tuple[RunWarning, ...] = field(default=())
    measure: str = FIRST_ORDER
    total: Floats | None = None
    total_low: Floats | None = None
    total_high: Floats | None = None
    times: pd.DatetimeIndex | None = None

    @property
    def first_order(self) -> Floats | None:
        """First-order index S1, shape (G, S): the same as `index`; None for Morris' method. [-]"""
        return self.index

    @property
    def interactions(self) -> Floats:
        """Part of the variance that no parameter explains alone, 1 minus the sum of S1, shape (S,). [-]"""
        unexplained: Floats = 1.0 - self.index.sum(axis=0)
        return unexplained

    def output_index(self, output: str) -> int:
        """Return the position of an output.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        int
            Position in `outputs`.

        Raises
        ------
        InputError
            There is no such output.
        """
        if output not in self.outputs:
            msg = f"output: found '{output}', which was not analyzed. {did_you_mean(output, self.outputs)}"
            raise InputError(msg)
        return self.outputs.index(output)

    def strongest(self, output: str, limit: int | None = None) -> NDArray[np.int64]:
        """Return the positions of the parameters by falling index.

        Parameters
        ----------
        output : str
            Which output.
        limit : int, optional
            Largest number of parameters. [-]

        Returns
        -------
        ndarray of int
            Positions in `names`.
        """
        order = np.argsort(-self.index[:, self.output_index(output)], kind="stable")
        return order[:limit]

    def ranking(self, output: str, limit: int | None = None) -> list[str]:
        """Return the names of the parameters by falling index.

        Parameters
        ----------
        output : str
            Which output.
        limit : int, optional
            Largest number of names. [-]

        Returns
        -------
        list of str
            Parameter paths or names of groups.
        """
        return [self.names[k] for k in self.strongest(output, limit)]

    def influential(self, minimum: float = 0.01) -> list[str]:
        """Return the parameters that matter for at least one output: significant and not negligible.

        Parameters
        ----------
        minimum : float
            Smallest index that counts. [-]

        Returns
        -------
        list of str
            Names by falling largest index.
        """
        largest = np.where(self.significant, self.index, -1.0).max(axis=1, initial=-1.0)
        return [self.names[k] for k in np.argsort(-largest, kind="stable") if largest[k] >= minimum]

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with one row per output and parameter, in the columns of SALib.

        Returns
        -------
        pandas.DataFrame
            Columns ``output``, ``parameter``, then ``S1``, ``S1_conf`` and, for Sobol', ``ST``, ``ST_conf``;
            for Morris ``mu``, ``mu_star``, ``sigma``, ``mu_star_conf``. ``_conf`` is half the width of the
            confidence interval, whose ends are in ``_low`` and ``_high``; it need not be symmetric. Then
            ``effect``, ``unit`` and ``significant``. Rows by falling index within each output.
        """
        import pandas as pd

        arrays = self._arrays()
        rows = [
            (output, self.names[i], *(float(array[i, s]) for array in arrays.values()))
            for s, output in enumerate(self.outputs)
            for i in self.strongest(output)
        ]
        frame = pd.DataFrame(rows, columns=["output", "parameter", *arrays])
        frame["unit"] = [unit for unit in self.units for _ in self.names]
        frame["significant"] = [
            bool(self.significant[i, s])
            for s, output in enumerate(self.outputs)
            for i in self.strongest(output)
        ]
        return frame

    def to_xarray(self) -> xr.Dataset:
        """Return the indices as arrays over ``output`` and ``parameter``, and over ``time`` where known.

        Returns
        -------
        xarray.Dataset
            Variables named like the columns of `to_dataframe`; the spectral method adds ``S1_over_time`` and
            others. Coordinate ``time`` is UTC, ``local_time`` the local clock, both without zone; `sel` takes
            times with an offset, as that of a run.
        """
        import xarray as xr

        from mascarin.simulation.records.labels import time_coordinates
        from mascarin.simulation.records.series import RunDataset

        dims = ("parameter", "output")
        data: dict[str, Any] = {name: (dims, array) for name, array in self._arrays().items()}
        data["significant"] = (dims, self.significant)
        over_time = ("parameter", "time", "output")
        data |= {name: (over_time, array) for name, array in self._arrays_over_time().items()}
        coordinates: dict[str, Any] = {
            "parameter": list(self.names),
            "output": list(self.outputs),
            "unit": ("output", list(self.units)),
        }
        attributes: dict[str, Any] = {
            "method": self.method,
            "measure": self.measure,
            "confidence": self.confidence,
            "runs": self.runs,
            "seed": self.seed,
        }
        if self.times is not None and self._arrays_over_time():
            attributes["timezone"] = str(self.times.tz)
            if self.times.tz is not None:
                return RunDataset(data, coordinates | time_coordinates(self.times), attributes)
            coordinates |= {"time": self.times, "local_time": ("time", self.times)}
        return xr.Dataset(data, coordinates, attributes)

    def to_dict(self) -> dict[str, dict[str, dict[str, float | None]]]:
        """Return the analysis as ``{output: {parameter: {share, low, high, effect}}}``, ready for JSON.

        These are the keys of ``study.json``: ``share`` is `index`; ``total``, ``total_low`` and
        ``total_high`` are added where the method gives them.

        Returns
        -------
        dict
            Numbers, None where not finite.
        """
        arrays = self._study_arrays()
        return {
            output: {
                name: {key: _number(array[i, s]) for key, array in arrays.items()}
                for i, name in enumerate(self.names)
            }
            for s, output in enumerate(self.outputs)
        }

    def table(self) -> pd.DataFrame:
        """Return the table of a study's ``sensitivity.csv``: as `to_dataframe`, with the keys of `to_dict`.

        Returns
        -------
        pandas.DataFrame
            Rows by falling index within each output.
        """
        import pandas as pd

        arrays = self._study_arrays()
        main = {key: arrays.pop(key) for key in ("share", "low", "high", "effect")}
        more = {**arrays, **self._study_extras()}
        rows = [
            (
                output,
                self.names[i],
                *(float(array[i, s]) for array in main.values()),
                self.units[s],
                bool(self.significant[i, s]),
                *(float(array[i, s]) for array in more.values()),
            )
            for s, output in enumerate(self.outputs)
            for i in self.strongest(output)
        ]
        return pd.DataFrame(rows, columns=["output", "parameter", *main, "unit", "significant", *more])

    def plot(
        self,
        kind: str = "indices",
        *,
        output: str | None = None,
        ax: Axes | None = None,
        top: int = 15,
        replicate: int = 0,
    ) -> Axes:
        """Draw one output.

        Parameters
        ----------
        kind : str
            ``indices``: indices with their intervals. ``effects``: signed effects as bars (tornado). Of the
            spectral method also ``day``: first-order indices over the hours of the day, and ``spectrum``.
        output : str, optional
            Which output; default the first.
        ax : matplotlib.axes.Axes, optional
            Where to draw; default new axes.
        top : int
            Number of parameters, those with the largest indices. [-]
        replicate : int
            Replicate of the spectrum. [-]

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        InputError
            Unknown kind or output.
        """
        if kind not in self._kinds:
            msg = (
                f"kind: found '{kind}', expected one of {', '.join(self._kinds)} for the method {self.method}"
            )
            raise InputError(msg)
        s = 0 if output is None else self.output_index(output)
        if ax is None:
            import matplotlib.pyplot as plt

            _, ax = plt.subplots(layout="constrained")
        self._draw(kind, s, ax, top, replicate)
        return ax

    def __repr__(self) -> str:
        return display.text(self._title, self._rows())

    def _repr_html_(self) -> str:
        from matplotlib.figure import Figure

        by_output: dict[str, Figure] = {}
        for output in self.outputs[:_MAX_OUTPUTS]:
            figure = Figure(figsize=(8.0, 3.5), layout="constrained")
            self.plot("indices", output=output, ax=figure.subplots(), top=_MAX_ROWS)
            by_output[output] = figure
        return display.page(
            self._title, self._rows(), tables={"Indices": self.to_dataframe()}, figures=by_output
        )

    @property
    def _title(self) -> str:
        parameters = _count(len(self.names), "parameter")
        return f"Sensitivity by the method '{self.method}': {parameters}, {self.runs} runs"

    def _rows(self) -> list[tuple[str, str]]:
        """Names and values of the short description: the largest indices of the first outputs."""
        shown = self.outputs[:_MAX_OUTPUTS]
        each = max(1, _MAX_ROWS // len(shown))
        rows = []
        for output in shown:
            s = self.output_index(output)
            rows += [
                (output if k == 0 else "", f"{self._described(int(i), s)}  {self.names[i]}")
                for k, i in enumerate(self.strongest(output, each))
            ]
        if len(shown) < len(self.outputs):
            rows.append(("others", ", ".join(self.outputs[len(shown) :])))
        return [*rows, *(("warning", text) for text in self.warnings)]

    def _described(self, i: int, s: int) -> str:
        """The index of parameter i and output s with its interval."""
        return f"S1 {self.index[i, s]:.3f} ({self.low[i, s]:.3f}-{self.high[i, s]:.3f})"

    @property
    def _label(self) -> str:
        return "S1"

    @property
    def _kinds(self) -> tuple[str, ...]:
        return ("indices", "effects")

    def _draw(self, kind: str, s: int, ax: Axes, top: int, replicate: int) -> None:
        """Draw one kind of figure of output number s; `replicate` is for spectra."""
        order = self.strongest(self.outputs[s], top)
        names = [self.names[i] for i in order]
        if kind == "effects":
            rms = getattr(self, "effect_rms", None)
            line = None if rms is None else rms[order, s]
            figures.effects(ax, names, self.effect[order, s], self.units[s], rms=line)
        else:
            total = None
            if self.total is not None and self.total_low is not None and self.total_high is not None:
                total = (self.total[order, s], self.total_low[order, s], self.total_high[order, s])
            figures.indices(
                ax, names, self.index[order, s], self.low[order, s], self.high[order, s],
                significant=self.significant[order, s], title=self.axis_title, total=total,
            )  # fmt: skip
        ax.set_title(self.outputs[s], loc="left", fontsize=10)

    @property
    def axis_title(self) -> str:
        """Title of an axis of indices in percent."""
        both = "" if self.total is None else " and ST (red)"
        return f"{self._label}{both}, {100.0 * self.confidence:g} % interval [%]"

    def _indices(self) -> Mapping[str, Floats]:
        """The columns that SALib has too."""
        columns = {"S1": self.index, "S1_conf": 0.5 * (self.high - self.low)}
        if self.total is not None and self.total_low is not None and self.total_high is not None:
            columns |= {"ST": self.total, "ST_conf": 0.5 * (self.total_high - self.total_low)}
        return columns

    def _arrays(self) -> Mapping[str, Floats]:
        """All columns of numbers, each of shape (G, S)."""
        columns = {**self._indices(), "S1_low": self.low, "S1_high": self.high}
        if self.total_low is not None and self.total_high is not None:
            columns |= {"ST_low": self.total_low, "ST_high": self.total_high}
        return {**columns, "effect": self.effect}

    def _arrays_over_time(self) -> Mapping[str, Floats]:
        """Arrays of shape (G, T, S), where the method gives them."""
        return {}

    def _study_arrays(self) -> dict[str, Floats]:
        """Arrays by the keys of ``study.json``."""
        arrays = {"share": self.index, "low": self.low, "high": self.high, "effect": self.effect}
        if self.total is not None and self.total_low is not None and self.total_high is not None:
            arrays |= {"total": self.total, "total_low": self.total_low, "total_high": self.total_high}
        return arrays

    def _study_extras(self) -> dict[str, Floats]:
        """Further columns of the study's table."""
        return {}


def local_hours(times: pd.DatetimeIndex | None) -> Floats | None:
    """Return the hour of the day of each time by the local clock, shape (T,), or None. [h]

    Parameters
    ----------
    times : pandas.DatetimeIndex, optional
        Times in the zone of the climate.

    Returns
    -------
    ndarray or None
        Hours with fractions; None without times, or where all are at the same hour.
    """
    if times is None:
        return None
    hours = np.asarray(times.hour + times.minute / 60.0 + times.second / 3600.0, dtype=np.float64)
    return None if np.ptp(hours) == 0.0 else hours


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
