"""Chunks of members sent to workers; the chunks of a worker that dies are run again."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from multiprocessing.process import BaseProcess
from typing import Final

from mascarin import _engine
from mascarin._io.arguments import whole_number
from mascarin.ensemble.members import Members
from mascarin.ensemble.work import Chunk, EnsembleInputs, run_chunk
from mascarin.errors import MascarinError, SolverError

#: Duration of a chunk: long compared with the cost of sending it, short enough that little is lost when a
#: worker dies. [s]
CHUNK_SECONDS: Final = 5.0
#: Members of the first chunk of each worker, which shows how fast they are.
FIRST: Final = 16
#: Chunks waiting for each worker.
QUEUED: Final = 2
#: How often a chunk is sent to a worker before the ensemble fails.
ATTEMPTS: Final = 3

Gap = tuple[int, int]


def here(
    inputs: EnsembleInputs, members: Members, gaps: list[Gap], report: Callable[[int], object] | None
) -> Iterator[Chunk]:
    """Run chunks in this process, on all its threads."""
    size, done = FIRST, 0
    for first, last in gaps:
        position = first
        while position < last:
            until = min(position + size, last)
            began, before = time.monotonic(), done
            call = None if report is None else (lambda count, before=before: report(before + count))
            chunk = run_chunk(inputs, members.part(position, until), position, call)
            done += until - position
            if report is not None:
                report(done)
            yield chunk
            size = _sized(until - position, time.monotonic() - began)
            position = until


def elsewhere(
    inputs: EnsembleInputs,
    members: Members,
    gaps: list[Gap],
    workers: int | Executor,
    report: Callable[[int], object] | None,
) -> Iterator[Chunk]:
    """Run chunks on processes of this machine, or on the workers of an executor."""
    if isinstance(workers, Executor):
        yield from _Dispatcher(inputs, members, gaps, workers, _slots(workers), report).chunks()
        return
    dispatcher = _Dispatcher(inputs, members, gaps, _processes(workers), workers, report, renew=_processes)
    try:
        yield from dispatcher.chunks()
    finally:
        _end(dispatcher.executor)


class _Dispatcher:
    """Sends chunks to an executor; chunks that were lost are sent again."""

    def __init__(
        self,
        inputs: EnsembleInputs,
        members: Members,
        gaps: list[Gap],
        executor: Executor,
        slots: int,
        report: Callable[[int], object] | None,
        renew: Callable[[int], Executor] | None = None,
    ) -> None:
        self.inputs, self.members, self.report = inputs, members, report
        self.gaps = list(reversed(gaps))
        self.executor, self.slots, self.renew = executor, slots, renew
        self.size, self.done = FIRST, 0
        self.running: dict[Future[Chunk], tuple[Gap, float]] = {}
        self.attempts: dict[Gap, int] = {}

    def chunks(self) -> Iterator[Chunk]:
        """Yield results as they come."""
        while self.gaps or self.running:
            while self.gaps and len(self.running) < QUEUED * self.slots:
                self._submit(self._cut())
            ready, _ = wait(self.running, return_when=FIRST_COMPLETED)
            for future in ready:
                if future not in self.running:
                    continue  # sent again together with others of a broken pool
                gap, began = self.running.pop(future)
                chunk = self._result(future, gap)
                if chunk is None:
                    continue
                self.done += gap[1] - gap[0]
                # A chunk waits in the queue before it runs.
                self.size = _sized(gap[1] - gap[0], (time.monotonic() - began) / QUEUED)
                if self.report is not None:
                    self.report(self.done)
                yield chunk

    def _cut(self) -> Gap:
        """The next chunk: first member and the one after the last."""
        first, last = self.gaps.pop()
        # A chunk that was lost is sent again unchanged.
        if (first, last) in self.attempts or last - first <= self.size:
            return first, last
        self.gaps.append((first + self.size, last))
        return first, first + self.size

    def _submit(self, gap: Gap) -> None:
        part = self.members.part(*gap)
        try:
            future = self.executor.submit(run_chunk, self.inputs, part, gap[0])
        except BrokenExecutor as error:
            self._lost(gap, error)
            return
        self.running[future] = (gap, time.monotonic())

    def _result(self, future: Future[Chunk], gap: Gap) -> Chunk | None:
        try:
            return future.result()
        except (MascarinError, _engine.EngineDefect):
            # An input that cannot be run by any worker, or a defect, which another attempt does not mend.
            raise
        except Exception as error:  # executors differ in what they raise when a worker is gone
            self._lost(gap, error)
            return None

    def _lost(self, gap: Gap, error: Exception) -> None:
        """Send a chunk again; a pool of which a process died is replaced."""
        self.attempts[gap] = self.attempts.get(gap, 0) + 1
        if self.attempts[gap] >= ATTEMPTS:
            raise SolverError(
                f"members {gap[0]} to {gap[1] - 1}: their worker died {ATTEMPTS} times ({error!r}); finished "
                "chunks are kept. Run these members alone to see why, or give the workers more memory"
            ) from error
        self.gaps.append(gap)
        if isinstance(error, BrokenExecutor) and self.renew is not None:
            # All chunks that ran in the broken pool are lost with it.
            for other, (lost, _) in list(self.running.items()):
                if not (other.done() and other.exception() is None):
                    del self.running[other]
                    self.gaps.append(lost)
                    self.attempts.setdefault(lost, 0)
            _end(self.executor)
            self.executor = self.renew(self.slots)


def _sized(members: int, seconds: float) -> int:
    """Members of a chunk of about `CHUNK_SECONDS`: a multiple of eight, at most four times the last."""
    fitting = int(members * CHUNK_SECONDS / max(seconds, 1e-3))
    return max(min(fitting, 4 * members) // 8 * 8, 8)


def _processes(workers: int) -> ProcessPoolExecutor:
    # New processes: a copy of one whose threads are running may never continue.
    whole_number("workers", workers, 1)
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(workers, mp_context=context, initializer=_prepare)


def _prepare() -> None:
    """Prepare a worker: one thread, because the workers use all cores together, and no life of its own."""
    os.environ["RAYON_NUM_THREADS"] = "1"
    # Ctrl-C in a terminal reaches all processes of a command; the first one ends the workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent,), daemon=True).start()


def _follow(parent: BaseProcess) -> None:
    """End this worker as soon as its parent has ended, also when it was killed and could not say so."""
    parent.join()
    signal.raise_signal(signal.SIGTERM)


def _end(executor: Executor) -> None:
    """End a pool; workers that are still busy are stopped, so that nobody waits for them."""
    running = [
        worker for worker in (getattr(executor, "_processes", None) or {}).values() if worker.is_alive()
    ]
    executor.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()


def _slots(executor: Executor) -> int:
    """Number of workers of an executor, where it can be found out."""
    for name in ("_max_workers", "_client"):
        slots = getattr(executor, name, None)
        if isinstance(slots, int):
            return slots
        if slots is not None and hasattr(slots, "ncores"):
            return max(int(sum(slots.ncores().values())), 1)
    return os.cpu_count() or 1
