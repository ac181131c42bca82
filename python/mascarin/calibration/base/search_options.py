"""Search methods by name, and the options of a search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from mascarin.errors import InputError

MethodName = Literal["least-squares", "hooke-jeeves", "particle-swarm", "hybrid", "cma-es", "emcee"]

METHODS: Final[tuple[MethodName, ...]] = (
    "least-squares", "hooke-jeeves", "particle-swarm", "hybrid", "cma-es", "emcee",
)  # fmt: skip

WITH_SQUARES: Final = ("least-squares", "emcee")
"""Methods that minimize a sum of squares, and therefore support the cost ``nll`` only."""

MAX_REDUCTIONS: Final = 24
"""Largest number of halvings with which the points of a pattern search are exact binary numbers."""

PosteriorName = Literal["linearized", "sampled"]
POSTERIORS: Final[tuple[PosteriorName, ...]] = ("linearized", "sampled")

SlopesName = Literal["differences", "exact"]
SLOPES: Final[tuple[SlopesName, ...]] = ("differences", "exact")

_MIN_AGREEING: Final = {"hooke-jeeves": 10}
_MIN_AGREEING_OTHERS: Final = 2


@dataclass(frozen=True, slots=True)
class SearchOptions:
    """Options of a search: number of starts, resolution, and when it ends.

    A *sequence* is one search of a method other than least squares: pattern search, swarm, hybrid, evolution
    strategy, or an optimizer of your own.

    Attributes
    ----------
    starts : int
        Least squares: number of starts, the given one and others from a Latin hypercube over the ranges. [-]
    slopes : str
        Derivatives for least squares and uncertainty: ``differences`` of runs in one batch, or ``exact``,
        from the engine.
    difference : float
        Step of the differences. [ranges]
    tolerance : float
        Least squares: relative change of cost or position at which a search ends. [-]
    agree : int, optional
        Number of sequences that must reach the same minimum; 10 for Hooke-Jeeves as in the reference study, 2
        for methods that search the whole range in each sequence. [-]
    within : float
        Costs within this part of the lowest are the same minimum, see `Cost.tolerance`. [-]
    sequences : int
        Largest number of sequences. [-]
    evaluations : int, optional
        Number of evaluations at which every sequence is stopped. [-]
    step : float
        Pattern search: first step; evolution strategy: first standard deviation. [ranges]
    reductions : int
        Pattern search: number of halvings of the step before a sequence ends. [-]
    together : int
        Number of sequences that run side by side; unless `evaluations` ends the search, it changes only the
        computing time. [-]
    particles, generations : int
        Swarm: number of particles and of generations. [-]
    walkers : int, optional
        emcee: number of walkers, an even number; twice the parameters, at least 32, when absent. [-]
    moves : int
        emcee: number of moves of each walker; the first fifth is discarded. [-]
    posterior : str
        Parameters with errors of sensors and model: ``linearized``, their distribution about the estimates in
        closed form, or ``sampled`` with the model itself.
    chains, draws, warmup : int
        Sampled posterior: number of chains, draws of each, and draws before them. [-]

    Raises
    ------
    InputError
        A value that cannot be used.

    Examples
    --------
    >>> SearchOptions(starts=2, slopes="exact").agreeing("hooke-jeeves")
    10
    """

    starts: int = 5
    slopes: SlopesName = "differences"
    difference: float = 1e-4
    tolerance: float = 1e-8
    agree: int | None = None
    within: float = 1e-3
    sequences: int = 200
    evaluations: int | None = None
    step: float = 0.1
    reductions: int = 10
    together: int = 16
    particles: int = 16
    generations: int = 30
    walkers: int | None = None
    moves: int = 500
    posterior: PosteriorName = "linearized"
    chains: int = 16
    draws: int = 500
    warmup: int = 200

    def __post_init__(self) -> None:
        least = {"starts": 1, "sequences": 1, "reductions": 1, "together": 1, "agree": 1}
        least |= {"evaluations": 1, "particles": 4, "generations": 2, "walkers": 4, "moves": 50}
        least |= {"chains": 2, "draws": 50, "warmup": 50}
        for name, smallest in least.items():
            option = getattr(self, name)
            if option is not None and option < smallest:
                msg = f"{name}: found {option}, expected at least {smallest}"
                raise InputError(msg)
        if self.slopes not in SLOPES:
            msg = f"slopes: found '{self.slopes}', expected {' or '.join(SLOPES)}"
            raise InputError(msg)
        if self.posterior not in POSTERIORS:
            msg = f"posterior: found '{self.posterior}', expected {' or '.join(POSTERIORS)}"
            raise InputError(msg)
        if self.reductions > MAX_REDUCTIONS:
            msg = f"reductions: found {self.reductions}, expected at most {MAX_REDUCTIONS}"
            raise InputError(msg)
        if self.walkers is not None and self.walkers % 2:
            msg = f"walkers: found {self.walkers}, expected an even number: they move in two halves"
            raise InputError(msg)
        for name in ("difference", "step"):
            if not 0.0 < getattr(self, name) <= 0.5:
                msg = f"{name}: found {getattr(self, name):g}, expected a part of the range, 0 to 0.5"
                raise InputError(msg)

    def agreeing(self, method: str) -> int:
        """Return the number of sequences of a method that must reach the same minimum. [-]"""
        return self.agree if self.agree is not None else _MIN_AGREEING.get(method, _MIN_AGREEING_OTHERS)
