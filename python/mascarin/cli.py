"""The command line: which commands there are, and what their exit codes mean.

A command is a plain function in `mascarin.commands`; one line of `COMMANDS` registers it. Its
module is imported only when the command is called, so that ``mascarin --help`` stays quick.
Data go to standard output, everything else to standard error.
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Any, Final, NamedTuple, TextIO, cast

from cyclopts import App, CycloptsError, Group

from mascarin import __version__
from mascarin.errors import InputError, MascarinError, SolverError

EXIT_OK: Final = 0
EXIT_CRITERION: Final = 1
EXIT_INPUT: Final = InputError.exit_code
EXIT_SOLVER: Final = SolverError.exit_code
EXIT_DEFECT: Final = 70  # a defect of Mascarin itself, so that it is never read as an answer
EXIT_INTERRUPTED: Final = 130


class Command(NamedTuple):
    """One command: its name, the function behind it as ``module:function``, one line of help."""

    name: str
    function: str
    help: str


GROUPS: Final[dict[str, tuple[Command, ...]]] = {
    "Describe": (
        Command(
            "init",
            "mascarin.commands.new_study:init",
            "Start a study of your own from one that comes with Mascarin.",
        ),
        Command(
            "schema", "mascarin.commands.building:schema", "Print the JSON Schema of a building description."
        ),
        Command(
            "check", "mascarin.commands.building:check", "Check a building description and say what it holds."
        ),
        Command("parameters", "mascarin.commands.building:parameters", "List every parameter of a building."),
        Command(
            "materials",
            "mascarin.commands.materials:materials",
            "Search the library of phase-change products.",
        ),
        Command(
            "dsc",
            "mascarin.commands.materials:dsc",
            "Make a phase-change material from a calorimeter's file.",
        ),
        Command("cite", "mascarin.commands.building:cite", "List the sources that a building rests on."),
    ),
    "Run": (
        Command("run", "mascarin.commands.run:run", "Run a building in a climate."),
        Command("sweep", "mascarin.commands.sweep:sweep", "Run many members of a building into a folder."),
    ),
    "Prove": (
        Command(
            "study", "mascarin.commands.study:study", "Compare, identify and corroborate on measurements."
        ),
        Command(
            "sensitivity",
            "mascarin.commands.study:sensitivity",
            "Find which parameters of a study matter.",
        ),
        Command("calibrate", "mascarin.commands.study:calibrate", "Identify the parameters of a study."),
        Command(
            "validate",
            "mascarin.commands.study:validate",
            "Hold a building as described against measurements.",
        ),
        Command("verify", "mascarin.commands.verify:verify", "Hold the simulation against closed answers."),
        Command(
            "bestest",
            "mascarin.commands.bestest:bestest",
            "Hold the cases of ASHRAE Standard 140 against six programs.",
        ),
    ),
    "Optimise": (
        Command(
            "optimize",
            "mascarin.commands.genopt:optimize",
            "Run a GenOpt project with any simulation program.",
        ),
        Command(
            "genopt",
            "mascarin.commands.genopt_export:genopt",
            "Write a study's identification as a GenOpt project.",
        ),
        Command(
            "cost",
            "mascarin.commands.genopt_export:cost",
            "Evaluate the cost of a study's identification once.",
        ),
    ),
}
"""Every command, by the group it is listed under."""

_EPILOGUE: Final = (
    "Exit codes: 0 done, 1 a criterion is not met, 2 something given cannot be used, "
    "3 the solver failed, 130 interrupted. "
    "With --debug (or MASCARIN_DEBUG=1) an error shows where it came from."
)


def build_app(chosen: str | None = None) -> App:
    """The command line as cyclopts sees it.

    Parameters
    ----------
    chosen : str, optional
        The command that is called. Its help is its docstring, which is read with its module; the others
        have the one line that stands here.
    """
    app = App(
        name="mascarin",
        help="Simulate buildings with phase-change materials, and prove the model on measurements.",
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
        # What is imported stays: looking through it again and again finds nothing to free.
        gc.set_threshold(100_000)
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = _take_debug(words)
    out, err = (cast("TextIO", _Output(stream)) for stream in (sys.stdout, sys.stderr))
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
        if not debug:
            warnings.showwarning = _show_warning
        try:
            code = build_app(words[0] if words else None)(words)
            sys.stdout.flush()
        except KeyboardInterrupt:
            _say("interrupted")
            return EXIT_INTERRUPTED
        except Exception as error:
            if debug:
                traceback.print_exc()
            return _report(error)
    return code if isinstance(code, int) else EXIT_OK


def _take_debug(words: list[str]) -> bool:
    """Take ``--debug`` out of `words`: every command understands it."""
    own = words[: words.index("--")] if "--" in words else words
    if "--debug" in own:
        words.remove("--debug")
        return True
    return os.environ.get("MASCARIN_DEBUG", "") not in ("", "0")


def _report(error: Exception) -> int:
    """Say what went wrong; the exit code that goes with it."""
    if isinstance(error, CycloptsError):
        command = " ".join(("mascarin", *(error.command_chain or ())))
        _say(f"error: {_usage_text(error)}\nSee: {command} --help")
        return EXIT_INPUT
    if isinstance(error, MascarinError):
        _say(f"error: {error}")
        return error.exit_code
    if isinstance(error, OSError) and error.filename is not None:
        _say(f"error: cannot use '{error.filename}': {error.strerror}")
        return EXIT_INPUT
    _say(
        f"error: a defect in Mascarin {__version__}: {type(error).__name__}: {error}\n"
        "Please report it: the command, its input files, and what it prints with --debug."
    )
    return EXIT_DEFECT


def _usage_text(error: CycloptsError) -> str:
    return " ".join(str(error).split())


class _Output:
    """A stream whose reader may leave (``| head``): the work goes on, and its exit code is the same.

    Parameters
    ----------
    stream : TextIO
        Where it goes.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        """Everything else is the stream's."""
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write, or drop what nobody reads."""
        try:
            return self._stream.write(text)
        except BrokenPipeError:
            self._leave()
            return len(text)

    def flush(self) -> None:
        """Pass on what was written, or drop what nobody reads."""
        try:
            self._stream.flush()
        except BrokenPipeError:
            self._leave()

    def _leave(self) -> None:
        # Python flushes the stream once more when it ends: give it somewhere to go. Where it is no real
        # file there is nothing to flush.
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
