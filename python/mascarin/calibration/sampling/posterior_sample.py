"""A posterior sample in chains: how well it is known, and its file, which ArviZ reads."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mascarin import __version__
from mascarin._io import atomic
from mascarin.calibration.sampling.convergence import (
    LARGEST_R_HAT,
    LEAST_SIZE,
    bulk_size,
    r_hat,
    tail_size,
)

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]

LEAST_ACCEPTED: Final = 0.2
"""Part of the accepted moves below which the polynomial is said to be far from the model. [-]"""


@dataclass(frozen=True, eq=False)
class PosteriorSample:
    """Chains of parameters and errors of sensors.

    Attributes
    ----------
    names, units : tuple of str, length q
        Parameters, then errors of sensors in stated standard uncertainties.
    draws : ndarray, shape (C, N, q)
        The chains. [unit of each]
    log_density : ndarray, shape (C, N)
        Logarithm of the posterior density, up to a constant. [-]
    accepted : float
        Part of the proposals from the polynomial that the model itself accepts. [-]
    diverged : int
        Number of paths that lost their energy.

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=(4, 500, 1))
    >>> sample = PosteriorSample(("level",), ("m",), draws, np.zeros((4, 500)), 1.0, 0)
    >>> sample.warnings
    []
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    draws: Floats
    log_density: Floats
    accepted: float
    diverged: int

    @cached_property
    def convergence(self) -> Floats:
        """R-hat, effective size of the bulk and of the tails of each quantity, shape (q, 3). [-]"""
        measures = (r_hat, bulk_size, tail_size)
        count = len(self.names)
        return np.array([[measure(self.draws[:, :, k]) for measure in measures] for k in range(count)])

    @property
    def warnings(self) -> list[str]:
        """What the chains do not tell, in sentences."""
        reduction, bulk, tail = self.convergence.T
        texts = []
        for k, name in enumerate(self.names):
            size = min(bulk[k], tail[k])
            if reduction[k] > LARGEST_R_HAT or size < LEAST_SIZE:
                texts.append(
                    f"{name}: the posterior sample has not converged (R-hat {reduction[k]:.3f}, effective "
                    f"size {size:.0f}; expected at most {LARGEST_R_HAT:g} and at least {LEAST_SIZE:.0f}): "
                    "its interval is not reliable; sample longer (draws)"
                )
        if self.accepted < LEAST_ACCEPTED:
            texts.append(
                f"the model accepts {100.0 * self.accepted:.0f} % of the moves that the polynomial through "
                f"its runs proposes, expected at least {100.0 * LEAST_ACCEPTED:.0f} %: it has kinks or jumps "
                "where the posterior is, and chains stay long in one place; sample longer (draws)"
            )
        if self.diverged:
            texts.append(
                f"{self.diverged} paths of the sampler diverged: the density has a place that is too narrow "
                "for its step; intervals may miss it"
            )
        return texts

    def summary(self) -> pd.DataFrame:
        """Return mean, standard deviation, interval of 95 % and convergence of each quantity."""
        import pandas as pd

        flat = self.draws.reshape(-1, len(self.names))
        low, high = np.quantile(flat, [0.025, 0.975], axis=0)
        reduction, bulk, tail = self.convergence.T
        return pd.DataFrame(
            {
                "mean": flat.mean(axis=0), "sd": flat.std(axis=0, ddof=1), "low": low, "high": high,
                "unit": self.units, "r_hat": reduction, "ess_bulk": bulk, "ess_tail": tail,
            },
            index=pd.Index(self.names, name="quantity"),
        )  # fmt: skip

    def to_netcdf(self, path: str | Path) -> Path:
        """Write the chains in the layout of InferenceData: ``arviz.from_netcdf`` reads them.

        Parameters
        ----------
        path : str or Path
            File to write (.nc).

        Returns
        -------
        Path
            The file.
        """
        import xarray as xr

        chains, draws, _ = self.draws.shape
        axes = {"chain": np.arange(chains), "draw": np.arange(draws)}
        posterior = xr.Dataset(
            {
                name.replace("/", " "): (("chain", "draw"), self.draws[:, :, k], {"unit": self.units[k]})
                for k, name in enumerate(self.names)
            },
            coords=axes,
            attrs={"inference_library": "mascarin", "inference_library_version": __version__},
        )
        stats = xr.Dataset({"lp": (("chain", "draw"), self.log_density)}, coords=axes)
        file = Path(path)
        with atomic.drafted(file) as draft:
            posterior.to_netcdf(draft, group="posterior", engine="h5netcdf", mode="w")
            stats.to_netcdf(draft, group="sample_stats", engine="h5netcdf", mode="a")
        return file
