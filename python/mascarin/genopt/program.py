"""Runs the simulation program once: input files, command line, checks and results."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mascarin._io.regular import require_regular
from mascarin.errors import InputError, MascarinError
from mascarin.genopt.command_line import place_word, split_command, variables
from mascarin.genopt.extraction import count_of, decimal_comma, lines_of, word_after
from mascarin.genopt.files import functions
from mascarin.genopt.files.numbers import double_text, parse_double
from mascarin.genopt.files.project import FileEntry, Objective, Project
from mascarin.optimization import Point

RUN_PREFIX = "tmp-genopt-run-"
SEPARATORS = ":;,"
_FORTRAN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)[dD][+-]?\d+\Z")
_ENCODING = {"encoding": "utf-8", "errors": "surrogateescape"}


class RunFailed(MascarinError):
    """One run of the simulation program failed; its files are kept."""

    exit_code = 1


@dataclass(frozen=True)
class Result:
    """What one run gave.

    Parameters
    ----------
    costs : tuple of float
        Values of all objectives, the cost first [own units].
    seconds : float
        Wall time of the run [s].
    """

    costs: tuple[float, ...]
    seconds: float


class Program:
    """The simulation program of a project.

    Parameters
    ----------
    project : Project
        The project.
    time_limit : float, optional
        Longest time for one run [s].
    separators : str
        Characters that end a number in an output file.
    """

    def __init__(
        self, project: Project, *, time_limit: float | None = None, separators: str = SEPARATORS
    ) -> None:
        self._project = project
        self._limit = time_limit
        self._separators = separators
        self._doubts: dict[tuple[str, str], str] = {}
        self._templates = [_read_template(entry) for entry in project.template]
        self._check_names()
        self._words = split_command(project)
        files = (*project.input, *project.log, *project.output)
        self._own_names = {Path(e.name).name for e in files}
        self._output_index: dict[str, int] = {}
        self._running: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._closed = False
        self._check_program()

    # ------------------------------------------------------------------ checks before the first run

    def _check_names(self) -> None:
        """Every parameter and function must occur somewhere."""
        project = self._project
        outputs = [o.function for o in project.objectives if o.function is not None]
        names = [*project.names, *(["stepNumber"] if project.settings.write_step else [])]
        locations = {p.name: p.location for p in project.continuous}
        locations.update((p.name, p.location) for p in project.discrete)
        for name in names:
            mark = f"%{name}%"
            if not any(mark in t for t in (*self._templates, *project.functions.values(), *outputs)):
                location = locations.get(name, str(project.command_file))
                listed = ", ".join(f"'{e.path}'" for e in project.template)
                project.report.error(
                    location,
                    f"'{mark}' must occur in at least one simulation input template file, or in at least one "
                    f"function object; searched {listed}. Write it where the value belongs",
                )
        for name in project.functions:
            mark = f"%{name}%"
            if not any(mark in t for t in (*self._templates, *outputs)) and not self._used_inside(name):
                project.report.error(
                    project.function_locations[name], f"function '{mark}' is not used; use or remove it"
                )
        project.report.raise_if_any()

    def _used_inside(self, name: str) -> bool:
        """Whether another input function was written with this one."""
        # References have been replaced by text, so that the text of the function is searched for.
        text = self._project.functions[name]
        return any(text in other for key, other in self._project.functions.items() if key != name)

    def _check_program(self) -> None:
        """Check that the program exists, and that file names are not ambiguous."""
        project = self._project
        words = self.command(Path(project.folder) / f"{RUN_PREFIX}1")
        if not words:
            project.report.error(project.command_location, "the command is empty; name a program")
        elif shutil.which(words[0]) is None:
            project.report.error(
                project.command_location,
                f"the program '{words[0]}' is not found or cannot be executed; give its full path",
            )
        for word in words:
            if re.search(r"\s", word) and os.name == "posix":
                project.report.notes.append(
                    f"{project.command_location}: accepted beyond GenOpt: '{word}' stays one argument, "
                    "GenOpt would split it at its blanks"
                )
        for entry in (*project.input, *project.log, *project.output):
            stale = Path.cwd() / entry.name
            if entry.name in words and stale.exists():
                project.report.beyond(
                    project.command_location,
                    f"'{stale}' has the name of a file of the run, so GenOpt started in this directory would "
                    "give it to every run instead of the file of the run",
                    "remove it or start from another directory",
                )
        project.report.raise_if_any()

    # ------------------------------------------------------------------ one run

    def texts(self, point: Point) -> list[str]:
        """Write the values of all parameters as text.

        Parameters
        ----------
        point : Point
            The point.

        Returns
        -------
        list of str
            Continuous ones first.
        """
        project = self._project
        return [project.number_text(v) for v in point.x] + [
            p.values[k] for p, k in zip(project.discrete, point.choices, strict=True)
        ]

    def _values(self, point: Point) -> dict[str, str]:
        """Text of every name, in the order of replacement."""
        values = dict(zip(self._project.names, self.texts(point), strict=True))
        if self._project.settings.write_step:
            values["stepNumber"] = str(point.step)
        for name, text in self._project.functions.items():
            # All variables are known here, because parameters come first in `values`.
            values[name] = double_text(functions.evaluate(functions.substitute(text, values)))
        return values

    def run(self, point: Point, folder: Path) -> Result:
        """Evaluate one point in its own directory.

        Parameters
        ----------
        point : Point
            The point.
        folder : Path
            The directory; removed first if it exists.

        Returns
        -------
        Result
            Costs and time.

        Raises
        ------
        RunFailed
            The program failed or its results cannot be used; the directory is kept.
        """
        began = time.perf_counter()
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        try:
            values = self._values(point)
            self._write_inputs(values, folder)
            self._start(folder)
            costs = self._read(values, folder)
        except RunFailed as error:
            note = f"{error}\n"
            with contextlib.suppress(OSError):
                (folder / "failure.txt").write_text(note, **_ENCODING)
            raise
        return Result(costs, time.perf_counter() - began)

    def _inside(self, entry: FileEntry, folder: Path) -> Path:
        """Path of a file of a run."""
        return folder / entry.path.relative_to(self._project.folder)

    def _write_inputs(self, values: dict[str, str], folder: Path) -> None:
        """Input files from their templates."""
        for entry, template in zip(self._project.input, self._templates, strict=True):
            target = self._inside(entry, folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(functions.substitute(template, values), newline=os.linesep, **_ENCODING)
        for entry in (*self._project.log, *self._project.output):
            self._inside(entry, folder).parent.mkdir(parents=True, exist_ok=True)

    def _start(self, folder: Path) -> None:
        """Run the command to its end."""
        words = self.command(folder)
        with tempfile.TemporaryFile() as stderr:
            try:
                process = subprocess.Popen(  # noqa: S603 - a list of words, no shell
                    words,
                    cwd=folder,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=stderr,
                    start_new_session=os.name == "posix",
                )
            except OSError as error:
                raise self._failed(folder, f"cannot start '{words[0]}': {error.strerror}") from error
            with self._lock:
                self._running.add(process)
            try:
                if self._closed:
                    _end(process)
                code = process.wait(self._limit)
            except subprocess.TimeoutExpired:
                _end(process)
                msg = f"the program did not end within {self._limit:g} s and was stopped"
                raise self._failed(folder, msg) from None
            except BaseException:
                _end(process)
                raise
            finally:
                with self._lock:
                    self._running.discard(process)
            if code != 0:
                stderr.seek(0)
                said = stderr.read().decode(**_ENCODING).strip()
                text = f"exit value of the simulation program: {code}"
                raise self._failed(folder, f"{text}\nerror stream of the program: {said}" if said else text)

    def stop(self) -> None:
        """End all runs that have not ended."""
        self._closed = True
        with self._lock:
            for process in list(self._running):
                _end(process)

    def _failed(self, folder: Path, text: str) -> RunFailed:
        """Error with directory and command of the run."""
        number = folder.name.removeprefix(RUN_PREFIX)
        words = " ".join(self.command(folder))
        return RunFailed(f"run {number}: {text}\nworking directory: '{folder}'\ncommand: {words}")

    # ------------------------------------------------------------------ results

    def _read(self, values: dict[str, str], folder: Path) -> tuple[float, ...]:
        """Check the log files and read the costs."""
        for entry in self._project.log:
            path = self._inside(entry, folder)
            text = self._text(path, folder, "log")
            for number, line in enumerate(lines_of(text), start=1):
                if any(e in line for e in self._project.errors):
                    raise self._failed(
                        folder, f"{path}: following error was found on line {number}:\n   {line.strip()}"
                    )
        outputs = [
            lines_of(self._text(self._inside(entry, folder), folder, "output"))
            for entry in self._project.output
        ]
        numbers = {
            o.name: self._extract(o, o.delimiter, outputs, folder)
            for o in self._project.objectives
            if o.delimiter is not None
        }
        texts = {**values, **{name: double_text(v) for name, v in numbers.items()}}
        return tuple(self._cost(o, numbers, texts, folder) for o in self._project.objectives)

    def _text(self, path: Path, folder: Path, role: str) -> str:
        """A file the program should have written."""
        try:
            return path.read_text(**_ENCODING)
        except OSError as error:
            raise self._failed(
                folder,
                f"the program ended without error but {role} file '{path}' is missing ({error.strerror})",
            ) from error

    def _cost(self, o: Objective, numbers: dict[str, float], texts: dict[str, str], folder: Path) -> float:
        """Value of one objective."""
        if o.function is None:
            return numbers[o.name]
        text = functions.substitute(o.function, texts)
        value = functions.evaluate(text)
        if value != value or abs(value) == float("inf"):
            raise self._failed(folder, f"cost '{o.name}' is {double_text(value)}: {o.function} = {text}")
        return value

    def _extract(self, o: Objective, delimiter: str, outputs: Sequence[list[str]], folder: Path) -> float:
        """A number after its delimiter, from the first file that has it."""
        file_index = self._output_index.get(o.name)
        order = range(len(outputs)) if file_index is None else [file_index]
        for i in order:
            word = word_after(outputs[i], delimiter, o.column, self._separators)
            if word is not None:
                path = self._inside(self._project.output[i], folder)
                value = self._number(o, word, path, folder)
                self._doubt(o, delimiter, outputs[i], word, path.name)
                self._output_index[o.name] = i
                return value
        files = ", ".join(f"'{self._inside(self._project.output[i], folder)}'" for i in order)
        raise self._failed(
            folder,
            f"the value of '{o.name}' could not be found in {files}. Objective function delimiter is "
            f"'{delimiter}' ({o.location}); check it and the file",
        )

    @property
    def doubts(self) -> list[str]:
        """What may not be the number that was meant, once for each objective."""
        return list(self._doubts.values())

    def _doubt(self, o: Objective, delimiter: str, lines: Sequence[str], word: str, name: str) -> None:
        """Note a delimiter that stands several times, and a number that seems to be cut at its comma."""
        count = count_of(lines, delimiter, o.column) if delimiter else 1
        if count > 1 and (o.name, "count") not in self._doubts:
            self._doubts[o.name, "count"] = (
                f"the delimiter '{delimiter}' of '{o.name}' ({o.location}) stands {count} times in {name}; "
                f"the last one is read, here {word}. Choose a longer delimiter if another one is meant"
            )
        comma = decimal_comma(lines, delimiter, o.column)
        if comma is not None and word != comma and (o.name, "comma") not in self._doubts:
            self._doubts[o.name, "comma"] = (
                f"'{o.name}' is read as {word} from '{comma}' in {name}: a comma ends a number. If it is the "
                "decimal mark, let the program write a point"
            )

    def _number(self, o: Objective, word: str, path: Path, folder: Path) -> float:
        """A finite number, or the reason why not."""
        value = parse_double(word)
        if value is None and _FORTRAN.match(word):
            if self._project.report.lenient:
                value = float(re.sub("[dD]", "e", word))
            else:
                hint = "write it with E (or accept it with --lenient)"
                raise self._failed(folder, f"{path}: '{o.name}' is '{word}', a Fortran number; {hint}")
        if value is None:
            raise self._failed(folder, f"{path}: '{o.name}' is '{word}', which is not a number")
        if value != value or abs(value) == float("inf"):
            raise self._failed(folder, f"{path}: '{o.name}' is {word}")
        return value

    # ------------------------------------------------------------------ command line

    def command(self, folder: Path) -> list[str]:
        """Return the words of the command line of a run.

        Parameters
        ----------
        folder : Path
            Directory of the run.

        Returns
        -------
        list of str
            Program and arguments.
        """
        values, base = variables(self._project, folder), self._project.folder
        return [place_word(w, values, base, self._own_names) for w in self._words]


def _read_template(entry: FileEntry) -> str:
    """Text of a template with every line ended."""
    try:
        lines = lines_of(require_regular(entry.path).read_text(**_ENCODING))
    except OSError as error:
        msg = f"{entry.location}: cannot read template '{entry.path}': {error.strerror}"
        raise InputError(msg) from error
    return "".join(line + "\n" for line in lines)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a program and what it has started."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":
            subprocess.run(  # noqa: S603 - fixed program, a number as argument
                ["taskkill", "/T", "/F", "/PID", str(process.pid)],  # noqa: S607
                check=False,
                capture_output=True,
            )
        else:
            os.killpg(process.pid, signal.SIGKILL)
    with contextlib.suppress(OSError, subprocess.TimeoutExpired):
        process.kill()
        process.wait(10)
