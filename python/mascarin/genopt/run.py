"""Runs a whole GenOpt project."""

from __future__ import annotations

import contextlib
import datetime as dt
import os
import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from mascarin import __version__
from mascarin._io import atomic, identity
from mascarin._io.locks import FolderLock, writing
from mascarin.errors import InputError, MascarinError
from mascarin.genopt import records
from mascarin.genopt.algorithms.algorithm import Built, build, chosen
from mascarin.genopt.evaluator import Evaluator, Policy, Runner
from mascarin.genopt.files.loading import load
from mascarin.genopt.files.numbers import double_text
from mascarin.genopt.files.project import Project
from mascarin.genopt.listing import Listings, Row
from mascarin.genopt.program import RUN_PREFIX, SEPARATORS, Program
from mascarin.genopt.records import Log, Record, Replay, check_table, fingerprint, write_table
from mascarin.optimization import EXHAUSTED
from mascarin.progress import Progress

LOG_NAME = "GenOpt.log"
#: Held in the folder of a project while it is optimized.
LOCK = ".mascarin.lock"


@dataclass(frozen=True)
class Options:
    """How a project is run; the defaults are those of GenOpt.

    Parameters
    ----------
    workers : int, optional
        Number of runs at a time; UnitsOfExecution of the command file when absent [-].
    ahead : bool
        Whether workers without a task run points that a sequential algorithm will probably need.
    penalty : float, optional
        Cost of a failed run; failures end the optimization when absent [unit of the cost].
    time_limit : float, optional
        Longest time of one run [s].
    resume : bool
        Whether to continue from the log of an earlier run.
    lenient : bool
        Whether to accept and report what GenOpt cannot run.
    table : Path, optional
        File that gets all evaluations, ``.csv`` or ``.parquet``.
    progress : bool
        Whether to show progress on standard error.

    Examples
    --------
    >>> Options(workers=4, penalty=1e6).workers
    4
    """

    workers: int | None = None
    ahead: bool = True
    penalty: float | None = None
    time_limit: float | None = None
    resume: bool = False
    lenient: bool = False
    table: Path | None = None
    progress: bool = False


@dataclass
class Outcome:
    """The end of an optimization.

    Parameters
    ----------
    project : Project
        The project.
    algorithm : str
        Name of the algorithm.
    reason : str
        Why it ended.
    exhausted : bool
        Whether it ended because of MaxIte.
    lowest : Row or None
        The lowest point as in the listings, None for algorithms that do not search for one.
    simulations : int
        Last simulation number [-].
    runs : int
        How often the program was started [-].
    records : list of Record
        All evaluations.
    notes : list of str
        Remarks and everything accepted beyond GenOpt.
    failures : int
        Number of evaluations that failed [-].
    """

    project: Project
    algorithm: str
    reason: str = ""
    exhausted: bool = False
    lowest: Row | None = None
    simulations: int = 0
    runs: int = 0
    records: list[Record] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def failures(self) -> int:
        """Number of evaluations that failed [-]."""
        return sum(r.costs is None for r in self.records)

    def values(self) -> dict[str, float | str]:
        """Return costs and parameters of the lowest point by name; empty when there is none."""
        if self.lowest is None:
            return {}
        e, project = self.lowest.evaluation, self.project
        out: dict[str, float | str] = {}
        out.update(zip([o.name for o in project.objectives], (e.cost, *e.outputs), strict=True))
        out.update(zip([p.name for p in project.continuous], e.point.x, strict=True))
        out.update((p.name, p.values[k]) for p, k in zip(project.discrete, e.point.choices, strict=True))
        return out


def optimize(path: str | Path, options: Options | None = None, *, run: Runner | None = None) -> Outcome:
    r"""Run a GenOpt project.

    Parameters
    ----------
    path : str or Path
        The initialization file.
    options : Options, optional
        How to run it.
    run : callable, optional
        Replaces the simulation program: takes a point and a directory, returns a result.

    Returns
    -------
    Outcome
        The end of the optimization; the listings are in the folder of the command file.

    Raises
    ------
    InputError
        The project has errors; nothing has been run.
    RunFailed
        A run of the simulation program failed, and failures end the optimization.
    SolverError
        The algorithm cannot continue.

    Examples
    --------
    A project with two parameters, and a Python function instead of its simulation program.

    >>> import tempfile
    >>> from pathlib import Path
    >>> from mascarin.genopt.program import Result
    >>> texts = {
    ...     "opt.ini": '''Simulation { Files { Template { File1 = template.txt; } Input { File1 = in.txt; }
    ...         Log { File1 = run.log; } Output { File1 = out.txt; } Configuration { File1 = program.cfg; } }
    ...       ObjectiveFunctionLocation { Name1 = cost; Delimiter1 = "cost ="; } }
    ...       Optimization { Files { Command { File1 = command.txt; } } }''',
    ...     "program.cfg": '''SimulationError { ErrorMessage = "error"; } IO { NumberFormat = Double; }
    ...       SimulationStart { Command = "program"; WriteInputFileExtension = true; }''',
    ...     "template.txt": "x = %x%\ny = %y%\n",
    ...     "command.txt": '''Vary { Parameter { Name = x; Min = -1; Ini = 0.9; Max = 1; Step = 0.1; }
    ...         Parameter { Name = y; Min = -1; Ini = 0.9; Max = 1; Step = 0.1; } }
    ...       OptimizationSettings { MaxIte = 500; WriteStepNumber = false; UnitsOfExecution = 1; }
    ...       Algorithm { Main = GPSHookeJeeves; MeshSizeDivider = 2; InitialMeshSizeExponent = 0;
    ...         MeshSizeExponentIncrement = 1; NumberOfStepReduction = 4; }''',
    ... }
    >>> folder = Path(tempfile.mkdtemp())
    >>> for name, text in texts.items():
    ...     size = (folder / name).write_text(text)
    >>> def bowl(point, _):
    ...     x, y = point.x
    ...     return Result(((x - 0.3) ** 2 + 2 * (y + 0.4) ** 2,), 0.0)
    >>> outcome = optimize(folder / "opt.ini", Options(workers=1), run=bowl)
    >>> outcome.reason, outcome.values()["x"], outcome.values()["y"]
    ('required accuracy is reached', 0.3, -0.4)
    """
    o = options or Options()
    started = dt.datetime.now().astimezone()
    if o.table is not None:
        check_table(o.table)
    try:
        project = load(path, lenient=o.lenient)
    except InputError as error:
        blank = Project(Path(path).absolute())
        if blank.ini.is_file():
            _write_log(blank, Outcome(blank, ""), started, str(error))
        raise
    with FolderLock(project.folder, project.folder / LOCK, remove=True), writing(o.table):
        return _optimized(project, o, run, started)


def _optimized(project: Project, o: Options, run: Runner | None, started: dt.datetime) -> Outcome:
    """Optimize in a folder that this process holds."""
    listings = Listings(project)
    built: Built | None = None
    outcome = Outcome(project, "")
    try:
        # As with GenOpt, the listings exist even when the project has errors.
        outcome.algorithm = chosen(project)
        listings.open(outcome.algorithm, started)
        workers = o.workers or project.settings.units or os.cpu_count() or 1
        built = build(project, listings, workers)
        if built.counts_equal:
            listings.max_equal = project.settings.max_equal
        program = (
            None if run is not None else Program(project, time_limit=o.time_limit, separators=_separators())
        )
        try:
            _work(project, built, listings, o, outcome, run or _runner(program), workers, _stopper(program))
        finally:
            doubts = [] if program is None else program.doubts
            outcome.warnings = [*outcome.warnings, *doubts, *_constant_costs(outcome)]
    except MascarinError as error:
        _write_log(project, outcome, started, str(error))
        raise
    finally:
        listings.close()
    ended = "Maximum number of iteration exceeded." if outcome.exhausted else ""
    _write_log(project, outcome, started, ended)
    return outcome


def _constant_costs(outcome: Outcome) -> list[str]:
    """A warning where all runs gave one cost: then the search found nothing."""
    done = [record for record in outcome.records if record.costs is not None]
    points = {record.key[1:] for record in done}
    costs = {record.costs[0] for record in done if record.costs is not None}
    if len(points) < 2 or len(costs) != 1:
        return []
    objective = outcome.project.objectives[0]
    return [
        f"the cost '{objective.name}' ({objective.location}) is {double_text(costs.pop())} in all runs at "
        f"{len(points)} different points: it does not depend on the parameters. Check that the template has "
        "their names between percent signs, that the program reads the input file, and the delimiter"
    ]


def _runner(program: Program | None) -> Runner:
    """The real program."""
    if program is None:
        msg = "no program to run"
        raise InputError(msg)
    return program.run


def _stopper(program: Program | None) -> Callable[[], None]:
    """What ends runs that have not ended."""
    return program.stop if program is not None else lambda: None


def _work(
    project: Project,
    built: Built,
    listings: Listings,
    o: Options,
    outcome: Outcome,
    run: Runner,
    workers: int,
    stop: Callable[[], None],
) -> None:
    """Run the search to its end."""
    log = Log(log_path(project.ini))
    digests = fingerprint(project)
    earlier = log.resume(digests) if o.resume else []
    if not o.resume:
        log.begin(digests)
    _clean(project, saved=not o.resume)
    watch = _Watch(project, built) if o.progress else None
    policy = Policy(workers, o.ahead and workers > 1, o.penalty)
    evaluator = Evaluator(project, built, run, policy, log=log, replay=Replay(earlier), watch=watch)
    try:
        while points := built.optimizer.ask():
            built.optimizer.tell(evaluator.evaluate(points))
        log.end(built.optimizer.reason)
    finally:
        evaluator.close(stop)
        log.close()
        if watch is not None:
            watch.close()
        outcome.simulations, outcome.runs = evaluator.count, evaluator.runs
        outcome.records = evaluator.records
        outcome.notes = [*project.report.notes, *listings.notes]
        outcome.warnings = evaluator.notes
        if o.table is not None:
            write_table(o.table, project, outcome.records)
    outcome.reason = built.optimizer.reason
    outcome.exhausted = outcome.reason == EXHAUSTED
    outcome.lowest = listings.lowest


def log_path(ini: Path) -> Path:
    """Return the path of the log of evaluations of a project.

    Parameters
    ----------
    ini : Path
        The initialization file.

    Returns
    -------
    Path
        The log, in the same folder.
    """
    return ini.absolute().with_suffix(".evaluations.jsonl")


def interrupted(ini: Path) -> str:
    """Return what to do about an earlier run that did not end.

    Parameters
    ----------
    ini : Path
        The initialization file.

    Returns
    -------
    str
        A sentence, empty when there is no such run.
    """
    count = records.interrupted(log_path(ini))
    if not count:
        return ""
    return (
        f"note: an earlier run stopped after {count} evaluations before its end. Starting again; "
        f"stop and add --resume to continue it (its log is kept as "
        f"'{log_path(ini).with_suffix('.previous.jsonl').name}')"
    )


def check(path: str | Path, options: Options | None = None) -> tuple[Project, list[str]]:
    """Read and check a project; run and write nothing.

    Parameters
    ----------
    path : str or Path
        The initialization file.
    options : Options, optional
        As for `optimize`.

    Returns
    -------
    tuple of Project and list of str
        The project, and a description of its run in a few lines.

    Raises
    ------
    InputError
        The project has errors.
    """
    o = options or Options()
    project = load(path, lenient=o.lenient)
    workers = o.workers or project.settings.units or os.cpu_count() or 1
    built = build(project, Listings(project), workers)
    program = Program(project, time_limit=o.time_limit)
    expected = built.optimizer.expected
    return project, [
        f"{built.name}: {', '.join(project.names)}",
        f"cost: {project.objectives[0].name}",
        f"simulations: {expected}" if expected else "simulations: until it converges",
        f"workers: {workers}",
        f"first command: {' '.join(program.command(project.folder / (RUN_PREFIX + '1')))}",
    ]


class _Watch:
    """Shows the progress of an optimization."""

    def __init__(self, project: Project, built: Built) -> None:
        self._optimizer = built.optimizer
        self._most = project.settings.max_iterations
        self._progress = Progress("simulations")
        self._done = 0
        self._best: float | None = None
        self._name = project.objectives[0].name

    def __call__(self, record: Record) -> None:
        """One more evaluation."""
        self._done += 1
        if record.costs is not None and (self._best is None or record.costs[0] < self._best):
            self._best = record.costs[0]
        remaining = self._optimizer.remaining
        exact = self._optimizer.expected is not None
        total = self._done + remaining if remaining is not None else max(self._most, self._done)
        about = "" if exact else "about " if remaining is not None else "at most "
        best = "" if self._best is None else f", lowest {self._name} {self._best:.6g}"
        self._progress.update(self._done, total, f"{self._done} of {about}{total}{best}")

    def close(self) -> None:
        """Remove the line."""
        self._progress.close()


def _clean(project: Project, *, saved: bool) -> None:
    """Remove the files of an earlier run."""
    for folder in project.folder.glob(f"{RUN_PREFIX}*"):
        if folder.is_dir():
            identity.require_no_inputs_in(folder)
            shutil.rmtree(folder, ignore_errors=True)
    for entry in (*project.input, *project.log, *project.output):
        if entry.save is None:
            continue
        entry.save.mkdir(parents=True, exist_ok=True)
        if saved:
            for old in entry.save.iterdir():
                if re.fullmatch(rf"\d+{re.escape(entry.name)}", old.name):
                    identity.require_no_input(old)
                    old.unlink()


def _separators() -> str:
    """Characters that end a number, from GenOpt's preferences file."""
    path = Path.home() / ".genopt3.1.1" / "properties.txt"
    with contextlib.suppress(OSError):
        for line in path.read_text(encoding="latin-1").splitlines():
            key, _, value = line.partition("=")
            if key.strip() == "simulation.result.separator":
                return re.sub(r"\\(.)", r"\1", value.strip())
    return SEPARATORS


def _write_log(project: Project, outcome: Outcome, started: dt.datetime, error: str) -> None:
    """Write the log of the whole run."""
    finished = dt.datetime.now().astimezone()
    lines = [
        f"Mascarin {__version__}, log in the format of GenOpt 3.1.1",
        "",
        f"Configuration file : {project.configuration}",
        f"Command file       : {project.command_file}",
        f"Start time         : {started:%a %b %d %H:%M:%S %Z %Y}",
        f"Finish time        : {finished:%a %b %d %H:%M:%S %Z %Y}",
        f"Execution time     : {(finished - started).total_seconds():.1f} s",
        "_" * 63,
        "",
    ]
    if error:
        lines += ["Optimization terminated with error.", "Error message:", error]
    else:
        lines.append("Optimization completed successfully.")
    for title, texts in (("Warning messages:", outcome.warnings), ("Info messages:", outcome.notes)):
        if texts:
            lines += ["", title, *(f"{i}: {t}" for i, t in enumerate(texts, start=1))]
    # A log that cannot be written must not hide the error that it would contain.
    with contextlib.suppress(OSError, InputError):
        text = "\n".join(lines) + "\n"
        atomic.write(project.folder / LOG_NAME, text.encode("utf-8", "surrogateescape"))


def summary(outcome: Outcome) -> list[str]:
    """Describe the end of an optimization in a few lines.

    Parameters
    ----------
    outcome : Outcome
        The end.

    Returns
    -------
    list of str
        Lines of text.
    """
    lines = [f"{outcome.algorithm}: {outcome.reason}; {outcome.simulations} simulations"]
    if outcome.failures:
        lines[0] += f", {outcome.failures} of them failed"
    for name, value in outcome.values().items():
        lines.append(f"{name} = {double_text(value) if isinstance(value, float) else value}")
    return lines
