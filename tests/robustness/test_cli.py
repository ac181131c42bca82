from __future__ import annotations

import importlib
import inspect
import io
import re
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from mascarin import __version__, _engine, cli
from mascarin.errors import CriterionFailed, InputError, MascarinError, SolverError

COMMANDS = [command for group in cli.GROUPS.values() for command in group]


def raising(monkeypatch: pytest.MonkeyPatch, error: BaseException) -> None:
    """Put an app in place whose every call raises `error`."""

    def app(_words: list[str]) -> None:
        raise error

    monkeypatch.setattr(cli, "build_app", lambda _chosen: app)


def test_help_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--help"]) == 0
    out, err = capsys.readouterr()
    for command in COMMANDS:
        assert f" {command.name} " in out
    assert "Exit codes" in out
    assert err == ""


def test_without_a_command_the_help_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([]) == 0
    assert "Usage: mascarin" in capsys.readouterr().out


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: c.name)
def test_every_command_has_help(command: cli.Command, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([command.name, "--help"]) == 0
    out = capsys.readouterr().out
    assert f"mascarin {command.name}" in out
    assert " ".join(command.help.split()[:3]) in " ".join(out.split())
    # Every option says what it is, and none means nothing, as the opposite of a pair of numbers.
    silent = r"^│ +\*? *--[\w-]+(?: -\w)? (?:STR|PATH|INT|FLOAT|CHOICE)(?:\.\.\.)? *│$"
    assert re.findall(silent, out, re.MULTILINE) == []
    assert "--empty-" not in out


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: c.name)
def test_the_list_of_commands_agrees_with_their_docstrings(command: cli.Command) -> None:
    module, name = command.function.split(":")
    function = getattr(importlib.import_module(module), name)
    assert (inspect.getdoc(function) or "").splitlines()[0] == command.help


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out == f"{__version__}\n"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["chek"], "check"),
        (["check"], "mascarin check --help"),
        (["check", "--no-such-option", "x"], "--no-such-option"),
    ],
)
def test_a_wrong_call_is_bad_input(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert said in err


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (CriterionFailed("rmse 0.4 K"), 1),
        (InputError("building.yaml:3: zones.room.volume"), 2),
        (SolverError("roof, step 12"), 3),
    ],
)
def test_messages_of_known_errors_are_printed_unchanged(
    error: Exception, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    raising(monkeypatch, error)
    assert cli.main(["x"]) == code
    assert capsys.readouterr() == ("", f"error: {error}\n")


def test_a_file_that_cannot_be_read_is_bad_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    raising(monkeypatch, FileNotFoundError(2, "No such file or directory", "site.epw"))
    assert cli.main(["x"]) == 2
    assert "'site.epw': No such file" in capsys.readouterr().err


def test_an_interruption(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    raising(monkeypatch, KeyboardInterrupt())
    assert cli.main(["x"]) == 130
    assert capsys.readouterr().err == "interrupted\n"


@pytest.mark.parametrize(("handler", "code"), [("_interrupt", 130), ("_terminate", 143)])
def test_an_error_after_a_signal_is_the_stop(
    handler: str, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A compiled module that a signal interrupts while it is imported fails with an error of its own."""
    monkeypatch.setattr(cli, "_asked_to_stop", [])
    with pytest.raises(KeyboardInterrupt):
        getattr(cli, handler)(0, None)
    raising(monkeypatch, ImportError("numpy._core.multiarray failed to import"))
    assert cli.main(["x"]) == code
    assert capsys.readouterr().err in ("interrupted\n", "terminated\n")


@pytest.mark.parametrize(("words", "traced"), [(["x"], False), (["x", "--debug"], True)])
def test_a_defect_is_never_an_answer(
    words: list[str],
    traced: bool,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.delenv("MASCARIN_DEBUG", raising=False)
    raising(monkeypatch, ZeroDivisionError("division by zero"))
    assert cli.main(words) == cli.EXIT_DEFECT
    err = capsys.readouterr().err
    assert "ZeroDivisionError: division by zero" in err
    assert "report" in err
    assert ("Traceback" in err) is traced


def test_a_panic_of_the_engine_is_a_defect(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(_engine.EngineDefect, match="internal fault: index 7 of 3") as found:
        _engine._panic("index 7 of 3")
    # Not among the errors that are shown as they stand: a defect is never an answer.
    assert not isinstance(found.value, MascarinError)
    raising(monkeypatch, found.value)
    assert cli.main(["x"]) == cli.EXIT_DEFECT == 70
    assert "index 7 of 3" in capsys.readouterr().err


def test_debug_by_environment(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("MASCARIN_DEBUG", "1")
    raising(monkeypatch, ZeroDivisionError())
    assert cli.main(["x"]) == cli.EXIT_DEFECT
    assert "Traceback" in capsys.readouterr().err


def test_debug_after_two_dashes_is_an_argument() -> None:
    words = ["check", "--", "--debug"]
    assert cli._take_debug(words) is False
    assert words == ["check", "--", "--debug"]


def test_the_code_a_command_returns_is_the_exit_code(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli, "build_app", lambda _chosen: lambda _words: 1)
    assert cli.main([]) == 1


def test_warnings_are_printed_on_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def app(_words: list[str]) -> None:
        warnings.simplefilter("always")
        warnings.warn("the step is long", UserWarning, stacklevel=1)

    monkeypatch.delenv("MASCARIN_DEBUG", raising=False)
    monkeypatch.setattr(cli, "build_app", lambda _chosen: app)
    assert cli.main([]) == 0
    assert capsys.readouterr() == ("", "warning: the step is long\n")


@pytest.mark.parametrize("code", [0, 1])
def test_a_reader_that_stops_reading_changes_nothing(code: int) -> None:
    script = (
        "import sys; from mascarin import cli\n"
        "def command(words):\n"
        "    print('x' * 200_000)\n"
        "    print('more', flush=True)\n"
        f"    return {code}\n"
        "cli.build_app = lambda chosen: command\n"
        "sys.exit(cli.main([]))"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.read(10)
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait() == code


def test_output_without_a_file_behind_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Under a notebook standard output has no file number; a closed reader must not become a defect."""

    class Gone(io.StringIO):
        def write(self, text: str) -> int:
            raise BrokenPipeError

    monkeypatch.setattr(sys, "stdout", Gone())
    monkeypatch.setattr(cli, "build_app", lambda chosen: lambda words: sys.stdout.write("x") and 0)
    assert cli.main([]) == 0


def test_a_command_in_the_background_can_be_interrupted() -> None:
    code = (
        "import signal, sys; from mascarin import cli\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)  # as a shell does for background jobs\n"
        "sys.argv = ['mascarin', '--version']; cli.main()\n"
        "try:\n    signal.raise_signal(signal.SIGINT)\n"
        "except KeyboardInterrupt:\n    pass\nelse:\n    sys.exit(1)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


@pytest.mark.parametrize(
    ("words", "actual", "remedy"),
    [
        ("check lgi/study.yaml", "a study", "mascarin study"),
        ("run lgi/study.yaml --weather shipped:tampa", "a study", "mascarin study"),
        ("parameters reunion_house/design.yaml", "a design study", "mascarin design"),
        ("study lgi/building.yaml -o OUT", "a building", "mascarin run"),
        ("validate reunion_house/design.yaml", "a design study", "mascarin design"),
        ("design lgi/study.yaml -o OUT", "a study", "mascarin study"),
        ("design lgi/building.yaml -o OUT", "a building", "mascarin run"),
    ],
)
def test_a_file_of_another_kind_is_recognised(
    words: str, actual: str, remedy: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from mascarin.examples import FOLDER

    command, file, *rest = words.replace("OUT", str(tmp_path / "out")).split()
    assert cli.main([command, str(FOLDER / file), *rest]) == 2
    said = capsys.readouterr().err
    assert f"found: {actual}\n" in said
    assert remedy in said
    assert len(said.splitlines()) < 6
