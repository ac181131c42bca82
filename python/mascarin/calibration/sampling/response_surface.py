"""Polynomials through runs of a model: its series and their derivatives for next to nothing.

References
----------
Box G.E.P., Wilson K.B. (1951), On the experimental attainment of optimum conditions, J. R. Stat. Soc. B 13,
1. https://doi.org/10.1111/j.2517-6161.1951.tb00067.x
Allen D.M. (1974), The relationship between variable selection and data augmentation and a method for
prediction, Technometrics 16, 125 (errors of points left out). https://doi.org/10.1080/00401706.1974.10489157
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Degrees that are compared.
_DEGREES: Final = (1, 2, 3)
#: Runs for each term of a polynomial at least.
_RUNS_PER_TERM: Final = 3
#: Part of the largest sum of squares of the terms below which a combination of them is left out. [-]
_RIDGE: Final = 1e-12
#: Mean square of a series that may be left out, summed over its values. [-]
_LEFT_OUT: Final = 1e-4


@dataclass(frozen=True, eq=False)
class ResponseSurface:
    """A polynomial of P variables whose values are series of length n, as combinations of r directions.

    Attributes
    ----------
    center, spread : ndarray, shape (P,)
        Origin and unit of the variables.
    factors : ndarray of int, shape (m, 3)
        Of each term: numbers of variables from 1, or 0 for the factor 1.
    weights : ndarray, shape (m, (1 + P) * r)
        Of the terms in each direction, then in its derivatives by the variables.
    directions : ndarray, shape (r, n)
        Series, orthogonal, of length 1.
    error : float
        Root mean square of what points left out of the fit differ from it, summed over a series. [-]
    """

    center: Floats
    spread: Floats
    factors: Indices
    weights: Floats
    directions: Floats
    error: float

    @property
    def flatness(self) -> float:
        """Power of a density with this polynomial that is as wide as one with its error as noise. [-]

        A sampler must not be kept from places whose density the polynomial has too low.
        """
        return 1.0 / (1.0 + self.error**2 / max(len(self.directions), 1))

    def at(self, point: Floats) -> tuple[Floats, Floats]:
        """Evaluate the share of each direction (r,) at a point (P,), and its derivative (P, r)."""
        away = np.concatenate([[1.0], (point - self.center) / self.spread])
        first, second, third = away[self.factors.T]
        shares = ((first * second * third) @ self.weights).reshape(away.size, -1)
        return shares[0], shares[1:]


def response_surface(points: Floats, series: Floats) -> ResponseSurface:
    """Fit a polynomial, of the degree that predicts points best that are left out of the fit.

    Parameters
    ----------
    points : ndarray, shape (N, P)
        Variables of each run.
    series : ndarray, shape (N, n)
        Result of each, in units in which an error of 1 is large. [-]

    Returns
    -------
    ResponseSurface

    Examples
    --------
    >>> x = np.random.default_rng(1).uniform(size=(100, 2))
    >>> surface = response_surface(x, np.outer(x[:, 0] * x[:, 1] ** 2, [3.0, 4.0]))
    >>> shares, derivative = surface.at(np.array([0.5, 0.6]))
    >>> (shares @ surface.directions).round(6), (derivative @ surface.directions).round(6)
    (array([0.54, 0.72]), array([[1.08, 1.44],
           [1.8 , 2.4 ]]))
    """
    center, spread = points.mean(axis=0), points.std(axis=0)
    spread = np.where(spread > 0.0, spread, 1.0)
    away = np.concatenate([np.ones((len(points), 1)), (points - center) / spread], axis=1)
    fits: list[tuple[float, Indices, Floats, Floats]] = []
    for degree in _DEGREES:
        factors = _factors(points.shape[1], degree)
        if fits and len(factors) * _RUNS_PER_TERM > len(points):
            break
        terms = np.prod(away[:, factors], axis=2)
        weights, error = _least_squares(terms, series)
        fits.append((error, factors, weights, terms))
    error, factors, weights, terms = min(fits, key=lambda fit: fit[0])
    _, size, directions = np.linalg.svd(
        np.linalg.qr(terms, mode="r") @ weights / np.sqrt(len(points)), full_matrices=False
    )
    beyond = np.cumsum((size**2)[::-1])[::-1]
    directions = directions[beyond > _LEFT_OUT]
    weights = weights @ directions.T
    slopes = [_derivative(factors, k + 1) @ weights / unit for k, unit in enumerate(spread)]
    return ResponseSurface(center, spread, factors, np.hstack([weights, *slopes]), directions, error)


def _factors(variables: int, degree: int) -> Indices:
    """Factors of all terms up to a degree, shape (m, 3)."""
    chosen = list(itertools.combinations_with_replacement(range(variables + 1), degree))
    factors = np.zeros((len(chosen), 3), dtype=np.int64)
    factors[:, :degree] = chosen
    return factors


def _derivative(factors: Indices, variable: int) -> Floats:
    """Derivative of each term (columns) by a variable, as shares of the terms (rows), shape (m, m)."""
    number = {tuple(row): k for k, row in enumerate(np.sort(factors, axis=1).tolist())}
    derivative = np.zeros((len(factors), len(factors)))
    for column, row in enumerate(factors.tolist()):
        if count := row.count(variable):
            row.remove(variable)
            derivative[number[tuple(sorted([0, *row]))], column] = count
    return derivative


def _least_squares(terms: Floats, series: Floats) -> tuple[Floats, float]:
    """Weights (m, n) of terms (N, m), and the root mean square error of points left out."""
    value, vector = np.linalg.eigh(terms.T @ terms)
    damped = np.maximum(value, 0.0) + _RIDGE * value[-1]
    turned = terms @ vector
    weights = vector @ ((turned.T @ series) / damped[:, None])
    leverage = np.einsum("nm,nm,m->n", turned, turned, 1.0 / damped)
    left_out = (series - terms @ weights) / np.maximum(1.0 - leverage, 1e-3)[:, None]
    return weights, float(np.sqrt(np.mean(np.sum(left_out**2, axis=1))))
