"""What the diagnosis compares beside faults of data: other values of parameters, other forms of the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.study.diagnosis_model import PRIOR
from mascarin.validation.whitened_regression import Solution, WhitenedRegression

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OtherForm:
    """Another law of one part of the model.

    Attributes
    ----------
    part, kind : str
        Which part, and its new kind.
    series : ndarray, shape (n, S)
        Simulated with it. [unit of each sensor]
    """

    part: str
    kind: str
    series: Array


@dataclass(frozen=True, eq=False)
class Candidate:
    """A possible cause with its fit.

    Attributes
    ----------
    what : int or OtherForm
        Number of the parameter, or the form.
    problem : WhitenedRegression
        The residuals with it.
    active : list of int
        Columns that are fitted.
    fit : Solution
        Their coefficients.
    """

    what: int | OtherForm
    problem: WhitenedRegression
    active: list[int]
    fit: Solution

    @property
    def size(self) -> float:
        """Size of the change in standard deviations of its prior; large at the end of a range."""
        if isinstance(self.what, OtherForm):
            return 1.0
        return abs(float(self.fit.values[-1])) / PRIOR + (0.0 if self.fit.free[-1] else 10.0)


def name_of(paths: Sequence[str], one: int | OtherForm) -> str:
    """Name of a parameter or of a form, given the paths of the parameters."""
    return f"{one.part} ({one.kind})" if isinstance(one, OtherForm) else paths[one]
