"""Continuous and discrete parameters of an optimization, points and evaluations."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mascarin.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


@dataclass(frozen=True, slots=True)
class Continuous:
    """A parameter that takes any value between its bounds.

    Parameters
    ----------
    name : str
        Name shown in reports.
    initial : float
        Starting value [unit of the parameter].
    step : float
        First step of a direct search; ignored by algorithms that need none [unit of the parameter].
    lower, upper : float
        Bounds, infinite when there are none [unit of the parameter].

    Examples
    --------
    >>> Continuous("thickness", initial=0.1, step=0.01, lower=0.0, upper=0.3).bounded
    True
    """

    name: str
    initial: float
    step: float = 1.0
    lower: float = -math.inf
    upper: float = math.inf

    @property
    def bounded(self) -> bool:
        """Whether both bounds are finite."""
        return math.isfinite(self.lower) and math.isfinite(self.upper)


@dataclass(frozen=True, slots=True)
class Discrete:
    """A parameter that takes one of a list of values, known to the algorithm by index.

    Parameters
    ----------
    name : str
        Name shown in reports.
    initial : int
        Index of the starting value, counted from 0 [-].
    size : int
        Number of values [-].

    Examples
    --------
    >>> Discrete("glazing", initial=0, size=3).size
    3
    """

    name: str
    initial: int
    size: int


@dataclass(frozen=True, slots=True)
class Point:
    """One set of parameter values.

    Parameters
    ----------
    x : tuple of float
        Continuous values in the order of the space [units of the parameters].
    choices : tuple of int
        Indices of the discrete values, counted from 0 [-].
    step : int
        Step number, for penalty functions that become steeper during the search [-].

    Examples
    --------
    >>> Point((0.1, 2.0), choices=(1,)).x
    (0.1, 2.0)
    """

    x: tuple[float, ...]
    choices: tuple[int, ...] = ()
    step: int = 1


@dataclass(frozen=True, slots=True)
class Evaluation:
    """The result of evaluating one point.

    Parameters
    ----------
    point : Point
        What was evaluated.
    cost : float
        Value to be minimized; infinite for a failed evaluation [unit of the cost].
    outputs : tuple of float
        Further results, not used by the search [own units].
    number : int
        Count of evaluations when this result was used; 0 lets the optimizer count [-].
    failed : bool
        Whether the evaluation failed and the cost replaces it.

    Examples
    --------
    >>> Evaluation(Point((0.1,)), cost=3.5).cost
    3.5
    """

    point: Point
    cost: float
    outputs: tuple[float, ...] = ()
    number: int = 0
    failed: bool = False


@dataclass(frozen=True)
class Space:
    """The parameters of one optimization, continuous ones first.

    Parameters
    ----------
    continuous : tuple of Continuous
        Continuous parameters.
    discrete : tuple of Discrete
        Discrete parameters.

    Examples
    --------
    >>> Space((Continuous("x", 0.5, 0.1, 0.0, 1.0),), (Discrete("n", 0, 3),)).names
    ('x', 'n')
    """

    continuous: tuple[Continuous, ...]
    discrete: tuple[Discrete, ...] = ()
    initial: Point = field(init=False, compare=False)

    def __post_init__(self) -> None:
        """Check the parameters and keep the starting point."""
        for c in self.continuous:
            _check_continuous(c)
        for d in self.discrete:
            if not 0 <= d.initial < d.size:
                msg = f"{d.name}: initial index {d.initial} is outside 0..{d.size - 1}; choose one inside"
                raise InputError(msg)
        start = Point(tuple(c.initial for c in self.continuous), tuple(d.initial for d in self.discrete))
        object.__setattr__(self, "initial", start)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all parameters, continuous ones first."""
        return tuple(c.name for c in self.continuous) + tuple(d.name for d in self.discrete)

    def feasible(self, x: Iterable[float]) -> bool:
        """Whether continuous values lie within their bounds.

        Parameters
        ----------
        x : iterable of float
            Values in the order of the space. [units of the parameters]
        """
        return all(c.lower <= v <= c.upper for c, v in zip(self.continuous, x, strict=True))

    def require_start(self) -> None:
        """Refuse an initial value outside its bounds.

        Raises
        ------
        InputError
            Naming every such parameter.
        """
        bad = [
            f"{c.name}={c.initial!r} is outside {c.lower!r}..{c.upper!r}"
            for c in self.continuous
            if not c.lower <= c.initial <= c.upper
        ]
        if bad:
            raise InputError(
                "Initial point not feasible: " + "; ".join(bad) + ". Choose it within the bounds."
            )

    def require_continuous(self, algorithm: str) -> None:
        """Refuse discrete parameters.

        Parameters
        ----------
        algorithm : str
            Name of the algorithm that cannot vary them.

        Raises
        ------
        InputError
            Naming every discrete parameter.
        """
        if self.discrete:
            names = ", ".join(f"'{d.name}'" for d in self.discrete)
            msg = (
                f"Algorithm '{algorithm}' can only have continuous variables; discrete: {names}. "
                "Fix them at one value or choose an algorithm for discrete parameters."
            )
            raise InputError(msg)

    def require_bounds(self) -> None:
        """Refuse continuous parameters without two bounds that differ.

        Raises
        ------
        InputError
            Naming every such parameter.
        """
        bad = [f"'{c.name}'" for c in self.continuous if not (c.bounded and c.lower < c.upper)]
        if bad:
            msg = (
                f"Parameter {', '.join(bad)} does not have lower and upper bounds specified that differ; "
                "this search needs both."
            )
            raise InputError(msg)

    def values(self, point: Point) -> dict[str, float]:
        """Name and value of every parameter; discrete ones by index.

        Parameters
        ----------
        point : Point
            A point of this space.

        Returns
        -------
        dict of str to float
            Values by parameter name [units of the parameters].
        """
        return dict(zip(self.names, (*point.x, *map(float, point.choices)), strict=True))


def box(
    names: Sequence[str],
    initial: Sequence[float],
    lower: Sequence[float],
    upper: Sequence[float],
    step: Sequence[float] | None = None,
) -> Space:
    """Space of bounded continuous parameters.

    Parameters
    ----------
    names : sequence of str
        Parameter names.
    initial, lower, upper : sequence of float
        Starting values and bounds, one per name [units of the parameters].
    step : sequence of float, optional
        First steps; a tenth of the range when absent [units of the parameters].

    Returns
    -------
    Space
        The space.

    Raises
    ------
    InputError
        When bounds are reversed.

    Examples
    --------
    >>> box(["x", "y"], [0.5, 0.5], [0.0, 0.0], [1.0, 1.0]).names
    ('x', 'y')
    """
    steps = step if step is not None else [(b - a) / 10.0 for a, b in zip(lower, upper, strict=True)]
    rows = zip(names, initial, steps, lower, upper, strict=True)
    return Space(tuple(Continuous(n, float(i), float(s), float(a), float(b)) for n, i, s, a, b in rows))


def _check_continuous(c: Continuous) -> None:
    """Refuse reversed bounds and a step that is not finite."""
    if not c.lower <= c.upper:
        msg = f"{c.name}: lower bound {c.lower:g} is above upper bound {c.upper:g}; exchange them"
        raise InputError(msg)
    if not math.isfinite(c.step):
        msg = f"{c.name}: step {c.step!r} is not a finite number"
        raise InputError(msg)
