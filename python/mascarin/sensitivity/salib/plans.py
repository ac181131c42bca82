"""RBD-FAST, Sobol' indices and Morris' method by SALib, with plans and intervals of this package.

SALib draws the samples on the unit cube and computes the indices of each replicate. This package adds the
ranges and distributions, the reduction of time series to a few numbers, and the intervals: several
independent replicates are made, and the intervals come from leaving out one at a time. SALib's own intervals
are not used: its maintainers advise against those of FAST (SALib issues 649 and 684), and a bootstrap of one
quasi-random sample treats the design as if it were random.

Time series. An index is the sum over time of a part of the variance, divided by the sum of the variance. This
sum does not change when the times are rotated into principal components, of which a few hold nearly all of
the variance; so each index is computed for these few only. The rest (1e-6 of the variance in the first
replicate) counts as not explained.

References
----------
Herman J., Usher W. (2017), SALib, J. Open Source Softw. 2(9), 97. https://doi.org/10.21105/joss.00097
Tarantola S., Gatelli D., Mara T.A. (2006), RBD-FAST. https://doi.org/10.1016/j.ress.2005.06.003
Tissot J.-Y., Prieur C. (2012), its bias. https://doi.org/10.1016/j.ress.2012.06.010
Saltelli A. et al. (2010), Sobol's indices. https://doi.org/10.1016/j.cpc.2009.09.018
Morris M.D. (1991), elementary effects. https://doi.org/10.1080/00401706.1991.10484804
Sobol' I.M., Kucherenko S. (2009), squared derivatives bound total indices.
https://doi.org/10.1016/j.matcom.2009.01.023
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.base.factors import Factor, Floats, check_factors, grouped
from mascarin.sensitivity.salib.library import salib

SalibName = Literal["rbd-fast", "sobol", "morris"]

SAMPLES: Final = {"rbd-fast": 512, "sobol": 64, "morris": 4}
"""Default size of a replicate: runs, base points, trajectories. [-]"""

LEVELS: Final = 4
"""Levels of a parameter in Morris' trajectories. [-]"""

_ORDER: Final = 4


@dataclass(frozen=True, eq=False)
class SalibPlan:
    """Runs of a method of SALib.

    Attributes
    ----------
    method : str
        ``rbd-fast``, ``sobol`` or ``morris``.
    factors : tuple of Factor, length P
        What varies.
    groups : tuple of str, length G
        Groups of factors that are analyzed together.
    group_of : ndarray of int, shape (P,)
        Group of each factor.
    replicates : int
        Number of independent samples. [-]
    size : int
        RBD-FAST: runs of a replicate; Sobol: its base points, G + 2 runs each; Morris: its trajectories,
        G + 1 runs each. [-]
    order : int
        RBD-FAST: harmonics that are attributed to a parameter. [-]
    seed : int
        Seed of the random numbers.
    """

    method: SalibName
    factors: tuple[Factor, ...]
    groups: tuple[str, ...]
    group_of: NDArray[np.int64]
    replicates: int
    size: int
    order: int
    seed: int

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the factors, the columns of the samples."""
        return tuple(factor.path for factor in self.factors)

    @property
    def runs(self) -> int:
        """Runs per replicate. [-]"""
        return (
            self.size
            * {"rbd-fast": 1, "sobol": len(self.groups) + 2, "morris": len(self.groups) + 1}[self.method]
        )

    def __len__(self) -> int:
        """Number of runs in all replicates. [-]"""
        return self.replicates * self.runs

    def samples(self, replicate: int) -> Floats:
        """Compute the parameter values of one replicate.

        Parameters
        ----------
        replicate : int
            Which replicate.

        Returns
        -------
        ndarray, shape (N, P)
            [unit of each parameter]

        Raises
        ------
        InputError
            A distribution given by the user has a value that is not finite.
        """
        u = self.unit_samples(replicate)
        values = np.column_stack([factor.quantile(u[:, i]) for i, factor in enumerate(self.factors)])
        bad = np.argwhere(~np.isfinite(values))
        if bad.size:
            row, i = bad[0]
            msg = (
                f"{self.factors[i].path}: found the value {values[row, i]} of its distribution at the "
                f"probability {u[row, i]:g}, expected finite values from 0 to 1"
            )
            raise InputError(msg)
        return values

    def unit_samples(self, replicate: int) -> Floats:
        """Compute the samples of one replicate as probabilities, shape (N, P). [-]"""
        # With a seed of 0, or none, SALib would use numpy's global state.
        rng = np.random.default_rng([self.seed, replicate])
        if self.method == "rbd-fast":
            samples = salib("sample.latin").sample(self.problem, self.size, seed=rng)
        elif self.method == "sobol":
            samples = salib("sample.sobol").sample(self.problem, self.size, calc_second_order=False, seed=rng)
        else:
            samples = salib("sample.morris").sample(self.problem, self.size, num_levels=LEVELS, seed=rng)
        return np.asarray(samples, dtype=np.float64)

    @property
    def problem(self) -> dict[str, Any]:
        """The factors in SALib's form; a new one at each call, because SALib changes it."""
        problem: dict[str, Any] = {
            "num_vars": len(self.factors),
            "names": list(self.paths),
            "bounds": [[0.0, 1.0]] * len(self.factors),
        }
        if len(self.groups) < len(self.factors):
            problem["groups"] = [self.groups[g] for g in self.group_of]
        return problem


def plan(
    factors: Sequence[Factor],
    method: SalibName,
    *,
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
) -> SalibPlan:
    """Plan the runs of a method of SALib.

    Parameters
    ----------
    factors : sequence of Factor
        What varies.
    method : str
        ``rbd-fast``, ``sobol`` or ``morris``.
    replicates : int
        Number of independent samples, at least 3. [-]
    samples : int, optional
        Size of a replicate, see `SalibPlan`; for Sobol a power of 2. [-]
    order : int, optional
        RBD-FAST: harmonics that are attributed to a parameter; default 4. [-]
    seed : int
        Seed of the random numbers.

    Returns
    -------
    SalibPlan
        The runs.

    Raises
    ------
    InputError
        SALib is not installed; numbers or groups that the method cannot use.
    """
    salib("sample")
    checked = check_factors(factors)
    names, group_of = grouped(checked)
    if replicates < 3:
        msg = f"replicates: found {replicates}, expected at least 3: intervals come from their spread"
        raise InputError(msg)
    harmonics = _ORDER if order is None else order
    size = samples if samples is not None else SAMPLES[method]
    if method == "rbd-fast":
        if len(names) < len(checked):
            msg = (
                "rbd-fast analyzes single parameters; leave out the groups, or choose spectral, sobol, morris"
            )
            raise InputError(msg)
        if harmonics < 1 or size <= 4 * harmonics**2:
            msg = (
                f"samples: found {size} runs for {harmonics} harmonics, expected more than 4 M^2 = "
                f"{4 * harmonics**2}"
            )
            raise InputError(msg)
    elif order is not None:
        msg = f"order: the method {method} has no harmonics; leave it out"
        raise InputError(msg)
    if method == "sobol" and (size < 2 or size & (size - 1)):
        msg = f"samples: found {size}, expected a power of 2, for which Sobol's sequence is balanced"
        raise InputError(msg)
    if method == "morris" and (size < 2 or len(names) < 2):
        msg = f"morris: found {size} trajectories of {len(names)} parameters, expected at least 2 of 2"
        raise InputError(msg)
    return SalibPlan(method, checked, names, group_of, replicates, size, harmonics, seed)
