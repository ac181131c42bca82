"""Result of the spectral method."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mascarin.errors import InputError
from mascarin.figures import colors
from mascarin.figures import sensitivity as figures
from mascarin.sensitivity.base.factors import Floats
from mascarin.sensitivity.base.result import Sensitivity, local_hours
from mascarin.sensitivity.spectral.designs import Design
from mascarin.sensitivity.spectral.spectrum import Peak, Spectrum

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SpectralSensitivity(Sensitivity):
    """Result of the spectral method: first-order indices, also over time, and the spectra behind them.

    Attributes
    ----------
    design : Design
        The runs.
    raw_index : ndarray, shape (G, S)
        Power on the M lines of a parameter divided by the variance, mean of the replicates; contains
        everything else that falls on these lines. [-]
    threshold : float
        Value that `raw_index` of any parameter exceeds with probability 5 % in a spectrum of pure noise.
        [-]
    effect_rms : ndarray, shape (G, S)
        Root mean square of the effect over time; it shows parameters whose effect changes sign during the
        day.
        [unit of the output]
    index_t, low_t, high_t, effect_t : ndarray, shape (G, T, S)
        As the attributes without suffix, at each time; indices are NaN where the output does not vary.
    mean_t, variance_t : ndarray, shape (T, S)
        Mean and variance of each output over the runs. [unit of the output, and its square]
    spectra : ndarray, shape (R, K, S)
        Power on the lines 1 ... K, K = (N - 1) // 2, divided by the variance, both summed over time. [-]

    Examples
    --------
    >>> from mascarin.sensitivity.spectral import analyze, design
    >>> plan = design(2, seed=1)
    >>> x = plan.all_samples()
    >>> result = analyze(plan, x[:, 0] * x[:, 1], names=["y"])
    >>> "x1 + x2" in [peak.label for peak in result.peaks("y")]
    True
    """

    design: Design
    raw_index: Floats
    threshold: float
    effect_rms: Floats
    index_t: Floats
    low_t: Floats
    high_t: Floats
    effect_t: Floats
    mean_t: Floats
    variance_t: Floats
    spectra: Floats

    def spectrum(self, output: str, replicate: int = 0) -> Spectrum:
        """Return the spectrum of one replicate with its threshold and named peaks.

        A peak gets a name only if the same fundamental, harmonic or interaction is above the threshold in at
        least three quarters of the replicates, on the line that it has there.

        Parameters
        ----------
        output : str
            Which output.
        replicate : int
            Which replicate, from 0.

        Returns
        -------
        Spectrum
            Power by line, threshold and peaks.

        Raises
        ------
        InputError
            There is no such output or replicate.
        """
        s = self.output_index(output)
        if not 0 <= replicate < self.design.replicates:
            msg = f"replicate {replicate}: there are replicates 0 to {self.design.replicates - 1}"
            raise InputError(msg)
        return Spectrum.of(
            self.spectra[:, :, s],
            self.design.frequencies,
            self.design.runs,
            self.design.groups,
            output=output,
            replicate=replicate,
        )

    def peaks(self, output: str, replicate: int = 0) -> list[Peak]:
        """Return the lines of one replicate above the threshold, by rising frequency.

        Parameters
        ----------
        output : str
            Which output.
        replicate : int
            Which replicate, from 0.

        Returns
        -------
        list of Peak
            With their names, where the other replicates confirm them.
        """
        return list(self.spectrum(output, replicate).peaks)

    def indices_by_hour(self, output: str, hour: ArrayLike | None = None) -> tuple[Floats, Floats, Floats]:
        """Average first-order indices and variance over the days, for each hour of the day.

        Parameters
        ----------
        output : str
            Which output.
        hour : array_like, shape (T,), optional
            Hour of the day of each time, fractions included. Without it nothing is averaged and the times
            are numbered. [h]

        Returns
        -------
        x : ndarray, shape (H,)
            Hours of the day, or numbers of times. [h]
        index : ndarray, shape (G, H)
            First-order indices; the days are weighted with their variance. [-]
        variance : ndarray, shape (H,)
            Mean variance. [square of the unit of the output]

        Raises
        ------
        InputError
            Another number of hours than times, or one hour only.
        """
        s = self.output_index(output)
        power = np.nan_to_num(self.index_t[:, :, s]) * self.variance_t[:, s]
        x, power, variance = _by_hour(power, self.variance_t[:, s], hour)
        with np.errstate(invalid="ignore", divide="ignore"):
            return x, np.clip(power / variance, 0.0, 1.0), variance

    def looks(self, most: int) -> dict[str, colors.Look]:
        """How parameters are drawn in the figures of all outputs.

        Parameters
        ----------
        most : int
            Parameters that are named for each output. [-]

        Returns
        -------
        dict of str to Look
            By parameter.
        """
        shares = {
            output: dict(zip(self.names, self.index[:, s].tolist(), strict=True))
            for s, output in enumerate(self.outputs)
        }
        return colors.parameters(shares, most)

    @property
    def _kinds(self) -> tuple[str, ...]:
        return (*super()._kinds, "day", "spectrum")

    def _draw(self, kind: str, s: int, ax: Axes, top: int, replicate: int) -> None:
        output = self.outputs[s]
        if kind == "spectrum":
            title = f"{output}, replicate {replicate + 1} of {self.design.replicates}"
            spectrum = self.spectrum(output, replicate)
            ax.legend(
                *figures.spectrum(ax, spectrum.power, spectrum.threshold, lines(spectrum), title=title),
                fontsize=7,
            )
        elif kind == "day":
            hours = local_hours(self.times)
            x, index, _ = self.indices_by_hour(output, hours)
            order = self.strongest(output, top)
            named = [(self.names[i], self.looks(top)[self.names[i]]) for i in order]
            legend = figures.indices_over_time(
                ax, x, index[order], named, remainder="others and interactions"
            )
            figures.time_axis(ax, hours=hours is not None)
            ax.set_title(output, loc="left", fontsize=10)
            ax.legend(*legend, fontsize=7)
        else:
            super()._draw(kind, s, ax, top, replicate)

    def _arrays(self) -> Mapping[str, Floats]:
        return {**super()._arrays(), "effect_rms": self.effect_rms, "raw_index": self.raw_index}

    def _arrays_over_time(self) -> Mapping[str, Floats]:
        return {
            "S1_over_time": self.index_t,
            "S1_over_time_low": self.low_t,
            "S1_over_time_high": self.high_t,
            "effect_over_time": self.effect_t,
        }

    def _study_extras(self) -> dict[str, Floats]:
        return {"effect_rms": self.effect_rms, "raw_share": self.raw_index}


def lines(spectrum: Spectrum) -> list[figures.SpectrumLine]:
    """Return the peaks of a spectrum in the form in which they are drawn."""
    return [figures.SpectrumLine(peak.line, peak.power, peak.kind, peak.label) for peak in spectrum.peaks]


def _by_hour(power: Floats, variance: Floats, hour: ArrayLike | None) -> tuple[Floats, Floats, Floats]:
    """Power (G, T) and variance (T,) over the times, or averaged at each hour of the day."""
    if hour is None:
        return np.arange(variance.size, dtype=np.float64), power, variance
    hours = np.asarray(hour, dtype=np.float64)
    if hours.shape != variance.shape:
        msg = f"hour: found {hours.size} values for {variance.size} times, expected one for each time"
        raise InputError(msg)
    # To the second, so that hours computed in different ways are equal.
    x, where, count = np.unique(
        np.round(np.mod(hours, 24.0) * 3600.0), return_inverse=True, return_counts=True
    )
    if x.size < 2:
        msg = "hour: found the same hour of the day for every time; leave it out to plot over time"
        raise InputError(msg)
    summed = np.stack([np.bincount(where, weights=row, minlength=x.size) for row in power]) / count
    mean = np.bincount(where, weights=variance, minlength=x.size) / count
    return x / 3600.0, summed, mean
