"""Base of all optimizers: they propose points and receive their costs."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import replace

from mascarin.optimization.space import Evaluation, Point, Space

Steps = Generator[list[Point], list[Evaluation], str]
"""An algorithm as a generator: it yields points, receives their evaluations and returns why it ended."""

CONVERGED = "required accuracy is reached"
"""Reason of a search that ended by itself."""

EXHAUSTED = "maximum number of evaluations is reached"
"""Reason of a search that was ended by its limit."""

CostOf = Callable[[Point], float | None]
"""Cost of a point if it has been evaluated already, else None."""


class Observer:
    """What is called during a search; this one does nothing.

    A *sub* report is for one trial, a *main* report for the end of an iteration. Reports come in the order of
    the algorithm, not in the order in which the evaluations ran.

    Examples
    --------
    >>> class Printing(Observer):
    ...     def main(self, evaluation, comment):
    ...         print(f"{evaluation.cost:.2f} {comment}")
    >>> from mascarin.optimization import OneAtATime, box
    >>> search = OneAtATime(box(["x"], [0.0], [0.0], [1.0], step=[1]), observer=Printing())
    >>> best = minimize(search, lambda points: [p.x[0] + 1.0 for p in points])
    1.00 Initial point.
    2.00 Function evaluation successful.
    """

    def sub(self, evaluation: Evaluation, comment: str) -> None:
        """After one trial of an iteration.

        Parameters
        ----------
        evaluation : Evaluation
            What was evaluated, with its cost.
        comment : str
            What it was for.
        """

    def main(self, evaluation: Evaluation, comment: str) -> None:
        """After an iteration, with its result.

        Parameters
        ----------
        evaluation : Evaluation
            What was evaluated, with its cost.
        comment : str
            What it was for.
        """

    def minimum(self, comment: str) -> None:
        """After the search, which ends at the point of lowest cost so far.

        Parameters
        ----------
        comment : str
            Why it ended.
        """

    def restart(self) -> None:
        """Before iteration counters start again, because the step number was raised."""

    def note(self, text: str) -> None:
        """A remark during the search.

        Parameters
        ----------
        text : str
            The remark.
        """

    def summary(self, lines: Sequence[str]) -> None:
        """An overview after the search.

        Parameters
        ----------
        lines : sequence of str
            Lines of text.
        """


class Optimizer(ABC):
    """Base of the optimizers: proposes points and receives their costs.

    Call `ask` for points that may be evaluated at the same time, evaluate them, give the results to `tell` in
    the same order, and repeat until `done`. The result does not depend on time, nor on the order in which
    evaluations finish. To continue an interrupted search, make the same optimizer again and give the recorded
    evaluations to `replay`.

    An algorithm is a subclass with the method `_search`, a generator that yields lists of points, receives
    their evaluations and returns why it ended.

    Parameters
    ----------
    space : Space
        The parameters.
    observer : Observer, optional
        Called during the search.
    remember : bool
        Whether a point that repeats takes its known cost instead of being evaluated again.

    Attributes
    ----------
    step_number : int
        Current step number of penalty functions [-].
    phase : int
        Which of several searches in a row is running, counted from 0 [-].

    Examples
    --------
    >>> from mascarin.optimization import Evaluation, GoldenSection, box
    >>> search = GoldenSection(box(["x"], [0.5], [0.0], [1.0]), points=20)
    >>> while points := search.ask():
    ...     search.tell([Evaluation(p, (p.x[0] - 0.3) ** 2) for p in points])
    >>> abs(search.best.point.x[0] - 0.3) < 1e-3
    True
    """

    def __init__(self, space: Space, *, observer: Observer | None = None, remember: bool = True) -> None:
        self.space = space
        self.observer = observer or Observer()
        self.step_number = 1
        self.phase = 0
        self._remember = remember
        self._memory: dict[Point, Evaluation] = {}
        self._steps: Steps | None = None
        self._pending: list[Point] = []
        self._asked: list[Point] = []
        self._count = 0
        self._best: Evaluation | None = None
        self._reason = ""

    @abstractmethod
    def _search(self) -> Steps:
        """The algorithm itself, as a generator of batches."""

    def guesses(self, limit: int, cost_of: CostOf) -> list[Point]:
        """Points that the search will probably need next, for processors without other work.

        Evaluating them does not change the result of the search, only the time that it takes.

        Parameters
        ----------
        limit : int
            Largest number of points wanted [-].
        cost_of : callable
            Cost of a point that has been evaluated, None for another.

        Returns
        -------
        list of Point
            At most `limit` points that are neither known nor pending.
        """
        return []

    @property
    def expected(self) -> int | None:
        """Number of evaluations the whole search takes, None when it is not known [-]."""
        return None

    @property
    def remaining(self) -> int | None:
        """Estimate of the number of further evaluations, None when it is not known [-]."""
        return None if self.expected is None else max(self.expected - self._count, 0)

    @property
    def done(self) -> bool:
        """Whether the search has ended."""
        self._start()
        return bool(self._reason)

    @property
    def reason(self) -> str:
        """Why the search ended; empty before that."""
        return self._reason

    @property
    def count(self) -> int:
        """Number of evaluations used so far [-]."""
        return self._count

    @property
    def best(self) -> Evaluation:
        """The evaluation of lowest cost so far, the first of equals.

        Raises
        ------
        LookupError
            Before the first evaluation.
        """
        if self._best is None:
            msg = "no evaluation yet; call tell first"
            raise LookupError(msg)
        return self._best

    def ask(self, ahead: int = 0) -> list[Point]:
        """Points to evaluate now, in any order or at the same time; empty when the search has ended.

        Parameters
        ----------
        ahead : int
            Number of guesses of the next points to add, so that all processors are used; needs
            `remember` [-].

        Returns
        -------
        list of Point
            The batch.
        """
        self._start()
        if self._reason:
            return []
        if not self._remember:
            self._asked = list(self._pending)
            return list(self._asked)
        self._asked = [p for p in dict.fromkeys(self._pending) if p not in self._memory]
        if ahead > 0:
            points = set(self._asked)
            for p in self.guesses(ahead, self._known_cost):
                if p not in points:
                    points.add(p)
                    self._asked.append(p)
        return list(self._asked)

    def tell(self, results: Sequence[Evaluation]) -> None:
        """Take the evaluations of the points of the last `ask`, in their order.

        Parameters
        ----------
        results : sequence of Evaluation
            One per point; a cost that is NaN is taken as infinite.

        Raises
        ------
        ValueError
            When the results are not those of the points of the last `ask`.
        """
        if [(r.point.x, r.point.choices) for r in results] != [(p.x, p.choices) for p in self._asked]:
            msg = f"expected the evaluations of the {len(self._asked)} points of the last ask, in their order"
            raise ValueError(msg)
        clean = [replace(r, cost=math.inf) if math.isnan(r.cost) else r for r in results]
        self._asked = []
        if self._remember:
            self._memory.update((r.point, r) for r in clean)
            self._drain()
        else:
            self._advance(clean)

    def replay(self, evaluations: Iterable[Evaluation]) -> None:
        """Take evaluations that were recorded before, so that only new points are evaluated.

        Parameters
        ----------
        evaluations : iterable of Evaluation
            The record, in any order.
        """
        self._memory.update((e.point, replace(e, number=0)) for e in evaluations)
        self._start()
        self._drain()

    def _known_cost(self, point: Point) -> float | None:
        """Cost of a point that was evaluated before."""
        evaluation = self._memory.get(point)
        return None if evaluation is None else evaluation.cost

    def _start(self) -> None:
        """Run the algorithm up to its first batch."""
        if self._steps is None:
            self._steps = self._search()
            self._move(self._steps, None)

    def _drain(self) -> None:
        """Continue as long as all pending points have known costs."""
        while not self._reason and all(p in self._memory for p in self._pending):
            batch = []
            for p in self._pending:
                e = self._memory[p]
                if e.number == 0:
                    self._count += 1
                    e = replace(e, number=self._count)
                    self._memory[p] = e
                batch.append(replace(e, number=self._count) if e.number != self._count else e)
            self._advance(batch)

    def _advance(self, batch: list[Evaluation]) -> None:
        """Give the evaluations of one batch to the algorithm."""
        for e in batch:
            self._count = max(self._count, e.number)
            if self._best is None or e.cost < self._best.cost:
                self._best = e
        if self._steps is not None:
            self._move(self._steps, batch)

    def _move(self, steps: Steps, batch: list[Evaluation] | None) -> None:
        """Continue the generator and keep the points it yields next."""
        try:
            # A new generator is started by next().
            self._pending = next(steps) if batch is None else steps.send(batch)
        except StopIteration as end:
            self._pending = []
            self._reason = str(end.value) or "finished"


def minimize(
    optimizer: Optimizer, evaluate: Callable[[list[Point]], Sequence[float]], *, ahead: int = 0
) -> Evaluation:
    """Evaluate the points of an optimizer until it ends.

    Parameters
    ----------
    optimizer : Optimizer
        The search.
    evaluate : callable
        Costs of a batch of points, in their order [unit of the cost].
    ahead : int
        Number of guesses added to every batch [-].

    Returns
    -------
    Evaluation
        The point of lowest cost.

    Examples
    --------
    >>> from mascarin.optimization import HookeJeeves, box
    >>> space = box(["x", "y"], initial=[0.0, 0.0], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> best = minimize(HookeJeeves(space), lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost
    0.0
    """
    while points := optimizer.ask(ahead):
        costs = evaluate(points)
        optimizer.tell([Evaluation(p, float(c)) for p, c in zip(points, costs, strict=True)])
    return optimizer.best
