"""The ask and tell interface that every optimiser here has."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import replace

from mascarin.optimization.space import Evaluation, Point, Space

Steps = Generator[list[Point], list[Evaluation], str]
"""What an algorithm is inside: it yields points, receives their evaluations and returns why it ended."""

Known = Callable[[Point], float | None]
"""Cost of a point if it has been evaluated already, else None."""


class Observer:
    """Listens to an optimiser; this one ignores everything.

    A *sub* report tells of one trial, a *main* report closes an iteration. Reports come in the order of the
    algorithm, whatever order the evaluations ran in.
    """

    def sub(self, evaluation: Evaluation, comment: str) -> None:
        """One trial of an iteration."""

    def main(self, evaluation: Evaluation, comment: str) -> None:
        """The result that closes an iteration."""

    def minimum(self, comment: str) -> None:
        """The lowest point so far ends the search."""

    def restart(self) -> None:
        """The iteration counters begin again because the step number rose."""

    def note(self, text: str) -> None:
        """A remark on the course of the search."""

    def summary(self, lines: Sequence[str]) -> None:
        """A closing overview, as lines of text."""


class Optimiser(ABC):
    """Proposes points and learns from their costs.

    Call `ask` for points that may be evaluated at the same time, evaluate them, hand the results to `tell` in
    the order asked, and repeat until `done`. Nothing depends on time or on the order in which evaluations
    finish. To continue an interrupted search, build the same optimiser again and hand the recorded
    evaluations to `replay`.

    Parameters
    ----------
    space : Space
        What may vary.
    observer : Observer, optional
        Listens to the course of the search.
    remember : bool
        Whether points that repeat are answered from memory instead of being asked again.

    Attributes
    ----------
    step_number : int
        Current step number of penalty functions [-].
    phase : int
        Which of several searches in a row is running, counted from 0 [-].
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

    def guesses(self, limit: int, known: Known) -> list[Point]:
        """Points that are likely to be asked next, for workers that would be idle.

        Evaluating them never changes the course of the search, only how long it takes.

        Parameters
        ----------
        limit : int
            Largest number of points wanted [-].
        known : callable
            Cost of a point that has been evaluated, None for another.

        Returns
        -------
        list of Point
            At most `limit` points that are neither known nor pending.
        """
        return []

    @property
    def expected(self) -> int | None:
        """Number of evaluations the whole search takes, None when it cannot be told before [-]."""
        return None

    @property
    def remaining(self) -> int | None:
        """Estimate of the number of evaluations still to come, None when there is none [-]."""
        return None if self.expected is None else max(self.expected - self._count, 0)

    @property
    def done(self) -> bool:
        """Whether the search has ended."""
        self._start()
        return bool(self._reason)

    @property
    def reason(self) -> str:
        """Why the search ended, empty while it goes on."""
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
            msg = "no evaluation has been told yet"
            raise LookupError(msg)
        return self._best

    def ask(self, ahead: int = 0) -> list[Point]:
        """Points to evaluate now, in any order or at the same time; empty when the search has ended.

        Parameters
        ----------
        ahead : int
            How many further points to add as guesses of what comes next, so that a batch evaluator is
            better used; needs `remember` [-].

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
            wanted = set(self._asked)
            for p in self.guesses(ahead, self._known):
                if p not in wanted:
                    wanted.add(p)
                    self._asked.append(p)
        return list(self._asked)

    def tell(self, results: Sequence[Evaluation]) -> None:
        """Take the evaluations of the last `ask`, in the order asked.

        Parameters
        ----------
        results : sequence of Evaluation
            One per point; a cost that is not a number counts as infinite.

        Raises
        ------
        ValueError
            When the results do not belong to the points asked.
        """
        if [(r.point.x, r.point.choices) for r in results] != [(p.x, p.choices) for p in self._asked]:
            msg = f"expected the evaluations of the {len(self._asked)} points asked, in that order"
            raise ValueError(msg)
        clean = [replace(r, cost=math.inf) if math.isnan(r.cost) else r for r in results]
        self._asked = []
        if self._remember:
            self._memory.update((r.point, r) for r in clean)
            self._drain()
        else:
            self._advance(clean)

    def replay(self, evaluations: Iterable[Evaluation]) -> None:
        """Learn from evaluations recorded before, so that only new points are asked.

        Parameters
        ----------
        evaluations : iterable of Evaluation
            The record, in any order.
        """
        self._memory.update((e.point, replace(e, number=0)) for e in evaluations)
        self._start()
        self._drain()

    def _known(self, point: Point) -> float | None:
        """Cost of a remembered point."""
        found = self._memory.get(point)
        return None if found is None else found.cost

    def _start(self) -> None:
        """Run the algorithm up to its first batch."""
        if self._steps is None:
            self._steps = self._search()
            self._move(self._steps, None)

    def _drain(self) -> None:
        """Go on as long as the memory answers."""
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
        """Hand one whole batch to the algorithm."""
        for e in batch:
            self._count = max(self._count, e.number)
            if self._best is None or e.cost < self._best.cost:
                self._best = e
        if self._steps is not None:
            self._move(self._steps, batch)

    def _move(self, steps: Steps, batch: list[Evaluation] | None) -> None:
        """Resume the generator and keep what it wants next."""
        try:
            # A fresh generator must be started by next().
            self._pending = next(steps) if batch is None else steps.send(batch)
        except StopIteration as end:
            self._pending = []
            self._reason = str(end.value) or "finished"


def minimise(
    optimiser: Optimiser, evaluate: Callable[[list[Point]], Sequence[float]], *, ahead: int = 0
) -> Evaluation:
    """Drive an optimiser to its end.

    Parameters
    ----------
    optimiser : Optimiser
        The search.
    evaluate : callable
        Costs of a batch of points, in their order [unit of the cost].
    ahead : int
        Number of guesses added to every batch [-].

    Returns
    -------
    Evaluation
        The lowest point.
    """
    while points := optimiser.ask(ahead):
        costs = evaluate(points)
        optimiser.tell([Evaluation(p, float(c)) for p, c in zip(points, costs, strict=True)])
    return optimiser.best
