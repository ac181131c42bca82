"""Evaluates points as GenOpt does: numbers, cache, second tries; several at a time and in advance."""

from __future__ import annotations

import bisect
import math
import shutil
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from pathlib import Path

from mascarin._io import identity
from mascarin.genopt.algorithms.algorithm import Built
from mascarin.genopt.files.project import Project
from mascarin.genopt.program import RUN_PREFIX, Result, RunFailed
from mascarin.genopt.records import Key, Log, Record, Replay
from mascarin.optimization import Evaluation, Point

_RELATIVE_TOLERANCE = 1e-12
FAILURES = "failed-runs"

_CachedPoint = tuple[tuple[float, ...], Record]
Runner = Callable[[Point, Path], Result]


class Cache:
    """Costs of evaluated points; coordinates are equal within a relative 1e-12."""

    def __init__(self) -> None:
        self._groups: dict[
            tuple[object, ...], tuple[list[float], list[tuple[tuple[float, ...], Record]]]
        ] = {}

    def find(self, group: tuple[object, ...], x: tuple[float, ...]) -> Record | None:
        """Return the record of a point, None when it has not been evaluated.

        Parameters
        ----------
        group : tuple
            What must be identical: step number, discrete values, phase.
        x : tuple of float
            Continuous values [units of the parameters].

        Returns
        -------
        Record or None
            The record.
        """
        if group not in self._groups:
            return None
        firsts, entries = self._groups[group]
        first = x[0] if x else 0.0
        slack = _RELATIVE_TOLERANCE * abs(first)
        index = bisect.bisect_left(firsts, first - slack)
        while index < len(firsts) and firsts[index] <= first + slack:
            if _same(entries[index][0], x):
                return entries[index][1]
            index += 1
        return None

    def add(self, group: tuple[object, ...], x: tuple[float, ...], record: Record) -> None:
        """Remember a point."""
        firsts, entries = self._groups.setdefault(group, ([], []))
        first = x[0] if x else 0.0
        index = bisect.bisect_left(firsts, first)
        firsts.insert(index, first)
        entries.insert(index, (x, record))


@dataclass
class Policy:
    """How evaluations are run.

    Parameters
    ----------
    workers : int
        Number of runs at a time [-].
    ahead : bool
        Whether workers without a task run points that will probably be needed.
    penalty : float or None
        Cost of a failed run; None stops the optimization.
    """

    workers: int = 1
    ahead: bool = False
    penalty: float | None = None


class Evaluator:
    """Turns points into evaluations.

    Parameters
    ----------
    project : Project
        The project.
    built : Built
        The search; it predicts points that will be needed.
    run : callable
        Runs one point in a directory.
    policy : Policy
        How to run.
    log : Log, optional
        Takes every run.
    replay : Replay, optional
        Results of an earlier run.
    watch : callable, optional
        Called after every evaluation with its record.
    """

    def __init__(
        self,
        project: Project,
        built: Built,
        run: Runner,
        policy: Policy,
        *,
        log: Log | None = None,
        replay: Replay | None = None,
        watch: Callable[[Record], None] | None = None,
    ) -> None:
        self._project, self._built, self._run, self._policy = project, built, run, policy
        self._log, self._replay, self._watch = log, replay or Replay(), watch
        self._cache = Cache()
        self.records: list[Record] = []
        self.notes: list[str] = []
        self.count = 0
        self.runs = 0
        self._pool = ThreadPoolExecutor(policy.workers) if policy.workers > 1 else None
        self._running: dict[Key, Future[Record]] = {}
        self._ahead: dict[Key, Record] = {}
        self._folders: dict[Key, Path] = {}
        self._ahead_count = 0
        self._lock = threading.Lock()
        self._any_success = False

    # ------------------------------------------------------------------ batches

    def evaluate(self, points: Sequence[Point]) -> list[Evaluation]:
        """Evaluate one batch.

        Parameters
        ----------
        points : sequence of Point
            What the search needs.

        Returns
        -------
        list of Evaluation
            In the same order.

        Raises
        ------
        RunFailed
            When a run fails and failures end the optimization.
        """
        first_batch = self.count == 0
        step = self._built.optimizer.step_number
        positions: dict[tuple[object, ...], int] = {}
        numbers: list[int] = []
        repeats: list[int | None] = []
        needed: list[Record | None] = []
        for i, p in enumerate(points):
            # Within a batch, points with different step numbers are different points.
            identity = (p.step, p.x, p.choices)
            first = positions.setdefault(identity, i)
            repeats.append(None if first == i else first)
            if first != i:
                numbers.append(numbers[first])
                needed.append(None)
                continue
            record = self._cache.find(self._group(p, step), p.x)
            if record is None:
                self.count += 1
            needed.append(record)
            numbers.append(self.count)
        new = [
            (i, replace(p, step=step), numbers[i])
            for i, p in enumerate(points)
            if repeats[i] is None and needed[i] is None
        ]
        for (i, p, _), record in zip(new, self._obtain(new, first_batch=first_batch), strict=True):
            needed[i] = record
            self._cache.add(self._group(points[i], step), p.x, record)
        fresh = {i for i, _, _ in new}
        out: list[Evaluation] = []
        for i, p in enumerate(points):
            repeated = repeats[i]
            record = needed[i if repeated is None else repeated]
            if record is not None:
                # Only a point that is run gets the current step number; others keep theirs.
                mine = step if i in fresh else p.step
                out.append(self._evaluation(p, record, numbers[i], mine))
        return out

    def _group(self, p: Point, step: int) -> tuple[object, ...]:
        """What must be identical for two points to have the same result."""
        phase = self._built.optimizer.phase if self._project.discrete else 0
        return (step if self._project.settings.write_step else 1, p.choices, phase)

    def _evaluation(self, p: Point, record: Record, number: int, step: int) -> Evaluation:
        """Evaluation of a point from its record."""
        if record.costs is not None:
            cost, *outputs = record.costs
            return Evaluation(replace(p, step=step), cost, tuple(outputs), number)
        outputs = [math.nan] * (len(self._project.objectives) - 1)
        if self._policy.penalty is not None:
            return Evaluation(
                replace(p, step=step), self._policy.penalty, tuple(outputs), number, failed=True
            )
        # GenOpt records a failure that does not stop it with zeros, and with the step number of the point.
        return Evaluation(p, 0.0, tuple(0.0 for _ in outputs), number, failed=True)

    # ------------------------------------------------------------------ runs

    def _obtain(self, new: Sequence[tuple[int, Point, int]], *, first_batch: bool) -> list[Record]:
        """Records of new points, from the log of an earlier run or by running them."""
        waiting: dict[int, Future[Record]] = {}
        records: dict[int, Record] = {}
        for i, p, number in new:
            key = self._key(p)
            earlier = self._replayed(key) or self._ahead.pop(key, None)
            if earlier is not None:
                records[i] = earlier
            elif self._pool is None:
                records[i] = self._attempt(p, self._folder(number))
                if records[i].costs is None and first_batch and self._stops():
                    raise RunFailed(records[i].reason)
            else:
                running = self._running.pop(key, None)
                waiting[i] = running or self._pool.submit(self._attempt, p, self._folder(number))
        self._wait(waiting)
        records.update((i, future.result()) for i, future in waiting.items())
        out = []
        for i, p, number in new:
            record = records[i]
            self._move_folder(self._key(p), number)
            if record.costs is None and not record.replayed:
                record = self._second_try(record, p, number, first_batch=first_batch)
            record.number = number
            self._finish(record, p, number)
            out.append(record)
        self._check_any(out)
        return out

    def _attempt(self, p: Point, folder: Path) -> Record:
        """Run one point; a failure becomes part of the record."""
        key = self._key(p)
        try:
            result = self._run(p, folder)
        except RunFailed as error:
            record = Record(key, None, reason=str(error))
        else:
            record = Record(key, result.costs, result.seconds)
        with self._lock:
            self.runs += 1
        return record

    def _second_try(self, record: Record, p: Point, number: int, *, first_batch: bool) -> Record:
        """What follows a failure: the end, or one more try."""
        if first_batch and self._stops():
            raise RunFailed(record.reason)
        cause = record.reason.splitlines()[0]
        self.notes.append(f"Caught '{cause}'. Try to evaluate simulation a second time.")
        again = self._attempt(p, self._folder(number))
        again.attempts = record.attempts + 1
        if again.costs is None and self._stops():
            again.number = number
            self._write(again)
            raise RunFailed(again.reason)
        return again

    def _stops(self) -> bool:
        """Whether a failure ends the optimization."""
        return self._policy.penalty is None and self._built.stop_at_error

    def _finish(self, record: Record, p: Point, number: int) -> None:
        """Log a run and move its files."""
        if not record.replayed:
            self._write(record)
            folder = self._folder(number)
            if record.costs is None:
                self._archive(record, folder, number)
            else:
                self._save(folder, number)
        self._any_success = self._any_success or record.costs is not None
        self.records.append(record)
        if self._watch is not None:
            self._watch(record)

    def _write(self, record: Record) -> None:
        """Log a run, once."""
        if self._log is not None and not record.logged:
            self._log.add(record)
            record.logged = True

    def _archive(self, record: Record, folder: Path, number: int) -> None:
        """Keep the files of a failed run after which the optimization continues."""
        keep = self._project.folder / FAILURES / f"run-{number}"
        if folder.exists():
            if keep.exists():
                shutil.rmtree(keep)
            keep.parent.mkdir(exist_ok=True)
            shutil.move(folder, keep)
            record.reason = record.reason.replace(str(folder), str(keep))
        self.notes.append(f"Simulation {number} failed; its files are in '{keep}'. {record.reason}")

    def _save(self, folder: Path, number: int) -> None:
        """Move files to their SavePath and delete the directory of a run."""
        project = self._project
        for entry in (*project.input, *project.log, *project.output):
            source = folder / entry.path.relative_to(project.folder)
            if entry.save is not None and source.exists():
                identity.require_no_input(entry.save / f"{number}{entry.name}")
                source.replace(entry.save / f"{number}{entry.name}")
        shutil.rmtree(folder, ignore_errors=True)

    def _check_any(self, records: Sequence[Record]) -> None:
        """Stop when every run of the first batch fails."""
        if records and not self._any_success and self._policy.penalty is not None:
            reason = records[0].reason
            raise RunFailed(f"every run of the first batch failed; correct the project\n{reason}")

    def _replayed(self, key: Key) -> Record | None:
        """Record of an earlier run; a failure counts only where failures do not end the optimization."""
        while (record := self._replay.take(key)) is not None:
            if record.costs is not None or not self._stops():
                return record
        return None

    # ------------------------------------------------------------------ runs in advance

    def _wait(self, waiting: dict[int, Future[Record]]) -> None:
        """Wait for the runs that are needed; other workers run points in advance."""
        open_ = set(waiting.values())
        while open_:
            self._collect()
            self._look_ahead(len({f for f in open_ if not f.done()} | set(self._running.values())))
            done, _ = wait([*open_, *self._running.values()], return_when=FIRST_COMPLETED)
            open_ -= done

    def _collect(self) -> None:
        """Take the results of runs in advance that have ended."""
        for key in [k for k, f in self._running.items() if f.done() and not f.cancelled()]:
            record = self._running.pop(key).result()
            self._ahead[key] = record
            if record.costs is not None:
                self._write(record)

    def _look_ahead(self, busy: int) -> None:
        """Give workers without a task points that will probably be needed."""
        free = self._policy.workers - busy
        if not self._policy.ahead or self._pool is None or free <= 0:
            return
        optimizer = self._built.optimizer
        for p in optimizer.guesses(free + len(self._running), self._earlier_cost):
            key = self._key(p)
            if free > 0 and key not in self._running and key not in self._ahead:
                free -= 1
                self._ahead_count += 1
                folder = self._project.folder / f"{RUN_PREFIX}ahead-{self._ahead_count}"
                self._folders[key] = folder
                self._running[key] = self._pool.submit(self._attempt, p, folder)

    def _earlier_cost(self, p: Point) -> float | None:
        """Cost of a point from any source."""
        record = self._cache.find(self._group(p, p.step), p.x) or self._ahead.get(self._key(p))
        if record is None:
            return self._replay.cost(self._key(p))
        if record.costs is None:
            return self._policy.penalty
        return record.costs[0]

    def _move_folder(self, key: Key, number: int) -> None:
        """Rename the directory of a run in advance to the number that the run now has."""
        folder = self._folders.pop(key, None)
        if folder is not None and folder.exists():
            target = self._folder(number)
            if target.exists():
                shutil.rmtree(target)
            folder.rename(target)

    def close(self, stop: Callable[[], None]) -> None:
        """End runs that have not ended and remove their files.

        Parameters
        ----------
        stop : callable
            Ends the programs.
        """
        self._collect()
        if self._pool is not None:
            stop()
            self._pool.shutdown(wait=True, cancel_futures=True)
        unused = [r for r in self._ahead.values() if r.costs is not None]
        self.records += unused
        for folder in self._folders.values():
            shutil.rmtree(folder, ignore_errors=True)

    # ------------------------------------------------------------------ names

    def _key(self, p: Point) -> Key:
        """What a run depends on."""
        return (p.step if self._project.settings.write_step else 1, p.x, p.choices)

    def _folder(self, number: int) -> Path:
        """Directory of a run."""
        return self._project.folder / f"{RUN_PREFIX}{number}"


def _same(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    """Whether all coordinates are equal within rounding."""
    return all(abs(u - v) <= _RELATIVE_TOLERANCE * max(abs(u), abs(v)) for u, v in zip(a, b, strict=True))
