"""Stretches of members handed to workers; what a dying worker had in hand is run again."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from typing import Final

from mascarin.ensemble.members import Members
from mascarin.ensemble.work import Piece, Recipe, run_stretch
from mascarin.errors import MascarinError, SolverError

#: What a stretch should take: long beside the cost of handing it over, short beside what a kill may lose. [s]
STRETCH: Final = 5.0
#: Members of the first stretch of each worker, which shows how fast they are.
FIRST: Final = 16
#: Stretches waiting for each worker.
QUEUED: Final = 2
#: How often a stretch is given to a worker before it counts as one that kills workers.
ATTEMPTS: Final = 3

Gap = tuple[int, int]


def here(
    recipe: Recipe, members: Members, gaps: list[Gap], report: Callable[[int], object] | None
) -> Iterator[Piece]:
    """Run stretches in this process, on all its threads."""
    size, done = FIRST, 0
    for first, last in gaps:
        at = first
        while at < last:
            until = min(at + size, last)
            began, before = time.monotonic(), done
            tell = None if report is None else (lambda count, before=before: report(before + count))
            piece = run_stretch(recipe, members.part(at, until), at, tell)
            done += until - at
            if report is not None:
                report(done)
            yield piece
            size = _sized(until - at, time.monotonic() - began)
            at = until


def elsewhere(
    recipe: Recipe,
    members: Members,
    gaps: list[Gap],
    workers: int | Executor,
    report: Callable[[int], object] | None,
) -> Iterator[Piece]:
    """Run stretches on processes of this machine, or on whatever an executor stands for."""
    if isinstance(workers, Executor):
        yield from _Dispatcher(recipe, members, gaps, workers, _slots(workers), report).pieces()
        return
    dispatcher = _Dispatcher(recipe, members, gaps, _processes(workers), workers, report, renew=_processes)
    try:
        yield from dispatcher.pieces()
    finally:
        dispatcher.executor.shutdown(wait=False, cancel_futures=True)


class _Dispatcher:
    """Keeps an executor busy with stretches, and gives lost ones out again."""

    def __init__(
        self,
        recipe: Recipe,
        members: Members,
        gaps: list[Gap],
        executor: Executor,
        slots: int,
        report: Callable[[int], object] | None,
        renew: Callable[[int], Executor] | None = None,
    ) -> None:
        self.recipe, self.members, self.report = recipe, members, report
        self.gaps = list(reversed(gaps))
        self.executor, self.slots, self.renew = executor, slots, renew
        self.size, self.done = FIRST, 0
        self.running: dict[Future[Piece], tuple[Gap, float]] = {}
        self.attempts: dict[Gap, int] = {}

    def pieces(self) -> Iterator[Piece]:
        """Yield results as they come."""
        while self.gaps or self.running:
            while self.gaps and len(self.running) < QUEUED * self.slots:
                self._submit(self._cut())
            ready, _ = wait(self.running, return_when=FIRST_COMPLETED)
            for future in ready:
                if future not in self.running:
                    continue  # given out again together with others of a broken pool
                gap, began = self.running.pop(future)
                piece = self._result(future, gap)
                if piece is None:
                    continue
                self.done += gap[1] - gap[0]
                # A stretch waits in the queue before it runs.
                self.size = _sized(gap[1] - gap[0], (time.monotonic() - began) / QUEUED)
                if self.report is not None:
                    self.report(self.done)
                yield piece

    def _cut(self) -> Gap:
        """The next stretch."""
        first, last = self.gaps.pop()
        # A stretch that was lost is given out again as it was.
        if (first, last) in self.attempts or last - first <= self.size:
            return first, last
        self.gaps.append((first + self.size, last))
        return first, first + self.size

    def _submit(self, gap: Gap) -> None:
        part = self.members.part(*gap)
        try:
            future = self.executor.submit(run_stretch, self.recipe, part, gap[0])
        except BrokenExecutor as error:
            self._lost(gap, error)
            return
        self.running[future] = (gap, time.monotonic())

    def _result(self, future: Future[Piece], gap: Gap) -> Piece | None:
        try:
            return future.result()
        except MascarinError:
            # What was given cannot be run, here or anywhere.
            raise
        except Exception as error:  # whatever the executor says when a worker is gone
            self._lost(gap, error)
            return None

    def _lost(self, gap: Gap, error: Exception) -> None:
        """Give a stretch out again; a pool of which a process died is replaced."""
        self.attempts[gap] = self.attempts.get(gap, 0) + 1
        if self.attempts[gap] >= ATTEMPTS:
            raise SolverError(
                f"members {gap[0]} to {gap[1] - 1}: their worker died {ATTEMPTS} times ({error!r}); what is "
                "finished is kept. Run these members alone to see why, or give the workers more memory"
            ) from error
        self.gaps.append(gap)
        if isinstance(error, BrokenExecutor) and self.renew is not None:
            # All that was under way in the broken pool is lost with it.
            for other, (lost, _) in list(self.running.items()):
                if not (other.done() and other.exception() is None):
                    del self.running[other]
                    self.gaps.append(lost)
                    self.attempts.setdefault(lost, 0)
            self.executor.shutdown(wait=False, cancel_futures=True)
            self.executor = self.renew(self.slots)


def _sized(members: int, seconds: float) -> int:
    """Members of a stretch that takes about `STRETCH`, whole packs of eight; at most four times the last."""
    fitting = int(members * STRETCH / max(seconds, 1e-3))
    return max(min(fitting, 4 * members) // 8 * 8, 8)


def _processes(workers: int) -> ProcessPoolExecutor:
    # Fresh processes: a copy of one whose threads are running may stand still for ever.
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(workers, mp_context=context, initializer=_one_thread)


def _one_thread() -> None:
    """One worker, one thread: the workers share the cores."""
    os.environ["RAYON_NUM_THREADS"] = "1"


def _slots(executor: Executor) -> int:
    """Workers behind an executor, as far as it says."""
    for name in ("_max_workers", "_client"):
        found = getattr(executor, name, None)
        if isinstance(found, int):
            return found
        if found is not None and hasattr(found, "ncores"):
            return max(int(sum(found.ncores().values())), 1)
    return os.cpu_count() or 1
