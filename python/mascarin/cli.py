"""The command line: which commands there are, and what their exit codes mean.

A command is a plain function in `mascarin.commands`; one line of `COMMANDS` registers it. Its
module is imported only when the command is called, so that ``mascarin --help`` starts quickly.
Data go to standard output, everything else to standard error.
"""

from __future__ import annotations

import contextlib
import errno
import gc
import io
import os
import signal
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Any, Final, NamedTuple, NoReturn, TextIO, cast

from cyclopts import App, CycloptsError, Group

from mascarin import __version__
from mascarin._io import identity, memory
from mascarin._io.terminal import printable
from mascarin.errors import InputError, MascarinError, SolverError

EXIT_OK: Final = 0
EXIT_CRITERION: Final = 1
EXIT_INPUT: Final = InputError.exit_code
EXIT_SOLVER: Final = SolverError.exit_code
EXIT_DEFECT: Final = 70  # an internal error of Mascarin: a code that no result has
EXIT_INTERRUPTED: Final = 130
EXIT_TERMINATED: Final = 143  # as of every program that SIGTERM ends


class Terminated(KeyboardInterrupt):
    """The process was asked to end (SIGTERM): it stops as after Ctrl-C, with its workers and programs."""


class Command(NamedTuple):
    """One command: its name, the function behind it as ``module:function``, one line of help."""

    name: str
    function: str
    help: str


GROUPS: Final[dict[str, tuple[Command, ...]]] = {
    "Describe": (
        Command(
            "init",
            "mascarin.commands.studies.new_study:init",
            "Copy an example into a new folder: a study, or designs of a house.",
        ),
        Command(
            "schema",
            "mascarin.commands.studies.schema:schema",
            "Print the JSON Schema of a building, a study or a design.",
        ),
        Command(
            "check", "mascarin.commands.building:check", "Check a building description and print a summary."
        ),
        Command(
            "convert",
            "mascarin.commands.convert:convert",
            "Convert a model of EnergyPlus to a building.",
        ),
        Command("new", "mascarin.commands.new:new", "Describe a room, house, cell or wall from a few words."),
        Command("view", "mascarin.commands.view:view", "Show a building in three dimensions."),
        Command("parameters", "mascarin.commands.building:parameters", "List every parameter of a building."),
        Command("outputs", "mascarin.commands.building:outputs", "List every output of a building."),
        Command(
            "materials",
            "mascarin.commands.materials:materials",
            "Search the library of phase-change products.",
        ),
        Command(
            "dsc",
            "mascarin.commands.materials:dsc",
            "Make a phase-change material from a DSC measurement.",
        ),
        Command("weather", "mascarin.commands.weather:weather", "Show and check a weather file."),
        Command("cite", "mascarin.commands.building:cite", "List the sources of numbers and methods."),
    ),
    "Run": (
        Command("run", "mascarin.commands.run:run", "Simulate a building with a weather file."),
        Command(
            "explore", "mascarin.commands.explore:explore", "Move sliders and see the curves of a building."
        ),
        Command("page", "mascarin.commands.page:page", "Write a page in which the model runs."),
        Command("fmu", "mascarin.commands.fmu:fmu", "Write a building as a unit for co-simulation (FMU)."),
        Command("sweep", "mascarin.commands.sweep:sweep", "Simulate a building with many parameter values."),
        Command(
            "design",
            "mascarin.commands.studies.design:design",
            "Compare designs: which product, how much, where.",
        ),
    ),
    "Compare with measurements": (
        Command(
            "study",
            "mascarin.commands.studies.study:study",
            "Run a whole study: compare, calibrate, validate.",
        ),
        Command(
            "sensitivity",
            "mascarin.commands.studies.study:sensitivity",
            "Run the sensitivity analysis of a study.",
        ),
        Command(
            "calibrate", "mascarin.commands.studies.study:calibrate", "Calibrate the parameters of a study."
        ),
        Command(
            "validate",
            "mascarin.commands.studies.study:validate",
            "Compare the uncalibrated model with measurements.",
        ),
    ),
    "Verify": (
        Command("verify", "mascarin.commands.verify:verify", "Verify against analytical solutions."),
        Command(
            "bestest",
            "mascarin.commands.bestest:bestest",
            "Compare the cases of ASHRAE Standard 140 with six programs.",
        ),
        Command("suites", "mascarin.commands.suites:suites", "Run public test suites beside other programs."),
    ),
    "Optimize": (
        Command(
            "optimize",
            "mascarin.commands.studies.genopt:optimize",
            "Run a GenOpt project with any simulation program.",
        ),
        Command(
            "genopt",
            "mascarin.commands.studies.genopt_export:genopt",
            "Write the calibration of a study as a GenOpt project.",
        ),
        Command(
            "cost",
            "mascarin.commands.studies.genopt_export:cost",
            "Evaluate the calibration cost of a study once.",
        ),
    ),
}
"""Every command, by the group it is listed under."""

_EPILOGUE: Final = (
    "Exit codes: 0 done, 1 a criterion is not met, 2 an input cannot be used, "
    "3 the solver failed, 130 interrupted. "
    "With --debug (or MASCARIN_DEBUG=1) an error shows its traceback."
)


def build_app(chosen: str | None = None) -> App:
    """The command line as cyclopts sees it.

    Parameters
    ----------
    chosen : str, optional
        The command that is called. Its help is its docstring, which is read with its module; the other
        commands have one line from `GROUPS`.
    """
    app = App(
        name="mascarin",
        help="Simulate buildings with phase-change materials and validate the model against measurements.",
        help_epilogue=_EPILOGUE,
        help_format="markdown",
        version=__version__,
        print_error=False,
        exit_on_error=False,
        suppress_keyboard_interrupt=False,
        result_action="return_value",
    )
    app["--help"].group = app["--version"].group = Group("Options", sort_key=len(GROUPS))
    for order, (title, commands) in enumerate(GROUPS.items()):
        group = Group(title, sort_key=order)
        for command in commands:
            line = None if command.name == chosen else command.help
            app.command(command.function, name=command.name, help=line, group=group)
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after ``mascarin``; those of this process if not given.

    Returns
    -------
    int
        Exit code.
    """
    if arguments is None:
        # Imported modules stay in memory: collecting garbage among them often would free nothing.
        gc.set_threshold(100_000)
        _fill_closed()
        # A shell starts background jobs with the signal ignored; a command must still be possible to stop.
        signal.signal(signal.SIGINT, _interrupt)
        signal.signal(signal.SIGTERM, _terminate)
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = _take_debug(words)
    out, err = (
        cast("TextIO", _Output(sys.stdout, "standard output")),
        cast("TextIO", _Output(sys.stderr, None)),
    )
    try:
        return _run(words, debug, out, err)
    finally:
        if arguments is None:
            # The process is about to end: looking for garbage among all modules would take half a second.
            gc.freeze()


def _fill_closed() -> None:
    """Give closed standard streams the null device: a file opened later would get their numbers, and text."""
    for number in (0, 1, 2):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free


def _run(words: list[str], debug: bool, out: TextIO, err: TextIO) -> int:
    """Run a command; its exit code."""
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
        if not debug:
            warnings.showwarning = _show_warning
        try:
            with identity.of_command(words):
                code = build_app(words[0] if words else None)(words)
            sys.stdout.flush()
        except Terminated:
            _say("terminated")
            return EXIT_TERMINATED
        except KeyboardInterrupt:
            _say("interrupted")
            return EXIT_INTERRUPTED
        except (SystemExit, GeneratorExit):
            raise
        except BaseException as error:  # a panic of compiled code is no Exception
            # A compiled module that is interrupted while it is imported fails with an error of its own.
            if _asked_to_stop:
                _say("terminated" if _asked_to_stop[0] == EXIT_TERMINATED else "interrupted")
                return _asked_to_stop[0]
            if debug:
                traceback.print_exc()
            return _report(error)
    return code if isinstance(code, int) else EXIT_OK


#: Exit code of the first signal that asked this process to stop.
_asked_to_stop: Final[list[int]] = []


def _interrupt(number: int, frame: object) -> NoReturn:
    _asked_to_stop.append(EXIT_INTERRUPTED)
    raise KeyboardInterrupt


def _terminate(number: int, frame: object) -> NoReturn:
    _asked_to_stop.append(EXIT_TERMINATED)
    raise Terminated


def _take_debug(words: list[str]) -> bool:
    """Take ``--debug`` out of `words`; every command accepts it."""
    options = words[: words.index("--")] if "--" in words else words
    if "--debug" in options:
        words.remove("--debug")
        return True
    return os.environ.get("MASCARIN_DEBUG", "") not in ("", "0")


def _report(error: BaseException) -> int:
    """Print the error; return its exit code."""
    if isinstance(error, CycloptsError):
        command = " ".join(("mascarin", *(error.command_chain or ())))
        _say(f"error: {_usage_text(error)}\nSee: {command} --help")
        return EXIT_INPUT
    if isinstance(error, MascarinError):
        _say(f"error: {error}")
        return error.exit_code
    if isinstance(error, OSError):
        file = "a file" if error.filename is None else f"'{error.filename}'"
        _say(f"error: cannot use {file}: {error.strerror or error}{_ADVICE.get(error.errno or 0, '')}")
        return EXIT_INPUT
    if isinstance(error, ValueError) and str(error).startswith("embedded null"):
        _say("error: found a name of a file with a zero in it, which no system has; correct the name")
        return EXIT_INPUT
    if isinstance(error, MemoryError):
        free = memory.available()
        _say(
            f"error: there is not enough memory{'' if free is None else f'; {memory.amount(free)} are free'} "
            f"({str(error) or 'the size is not known'}). Take a longer step, a shorter period, "
            "fewer members or fewer outputs"
        )
        return EXIT_INPUT
    _say(
        f"error: a defect in Mascarin {__version__}: {type(error).__name__}: {error}\n"
        "Please report it: the command, its input files, and what it prints with --debug."
    )
    return EXIT_DEFECT


_ADVICE: Final = {
    errno.ENOSPC: ". Make room on the disk and run the command again; files that were there are unchanged",
    errno.EDQUOT: ". Make room in your quota and run the command again; files that were there are unchanged",
    errno.EMFILE: ". Allow more open files (ulimit -n), or use fewer workers",
}


def _usage_text(error: CycloptsError) -> str:
    return " ".join(str(error).split())


class _Output:
    """A stream on which control characters are shown, and which ignores a closed pipe (``| head``).

    The command goes on with the same exit code.

    Parameters
    ----------
    stream : TextIO or None
        Where the output goes; None: the process was started with the stream closed.
    needed : str or None
        Its name, where results go to it, so that it is an error when they cannot be written. Messages that
        nobody can read do not stop a command.
    """

    def __init__(self, stream: TextIO | None, needed: str | None) -> None:
        self._closed = stream is None
        self._stream: TextIO = stream if stream is not None else io.StringIO()
        self._needed = needed

    def __getattr__(self, name: str) -> Any:
        """Other attributes are those of the stream."""
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write text as a terminal can show it, or drop it when the pipe is closed."""
        self.unfiltered(printable(text))
        return len(text)

    def unfiltered(self, text: str) -> int:
        """Write text with the control characters of Mascarin itself."""
        if self._closed:
            self._refuse_lost(text)
            return len(text)
        try:
            return self._stream.write(text)
        except (
            UnicodeEncodeError
        ) as error:  # a letter that the terminal does not have, such as in a file name
            return self._stream.write(text.encode(error.encoding, "backslashreplace").decode(error.encoding))
        except BrokenPipeError:
            self._discard()
            return len(text)
        except OSError as error:
            self._discard()  # Python would try, and fail, again when it exits
            self._lost(error)
            return len(text)

    def flush(self) -> None:
        """Flush, or drop the text when the pipe is closed."""
        try:
            self._stream.flush()
        except BrokenPipeError:
            self._discard()
        except OSError as error:
            self._discard()
            self._lost(error)

    def _lost(self, error: OSError) -> None:
        """Results that cannot be written are an error."""
        if self._needed is not None:
            raise OSError(error.errno, error.strerror, self._needed) from None

    def _refuse_lost(self, text: str) -> None:
        if self._needed is not None and text.strip():
            raise InputError(
                f"{self._needed} is closed, and the result goes to it: expected a terminal, a pipe or a "
                "file. Send it to a file (> result.txt), or to /dev/null if it is not needed"
            )

    def _discard(self) -> None:
        # Python flushes the stream again when it exits, so its file descriptor is directed to the null
        # device. A stream without a file descriptor needs no such thing.
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    _say(f"warning: {message}")


def _say(text: str) -> None:
    print(text, file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
