from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from genopt_support import TWO_CONTINUOUS, write_project
from mascarin.errors import InputError
from mascarin.genopt import load
from mascarin.genopt.extraction import word_after
from mascarin.genopt.program import Program, RunFailed
from mascarin.optimization import Point

POINT = Point((0.25, -0.5))
LINES = ["5, 1.2345, 11", "6, 12.345, 22"]


@pytest.mark.parametrize(
    ("delimiter", "column", "word"),
    [("5,", 0, "22"), ("5,", 1, "1.2345"), ("", 0, "6"), ("7,", 0, None), ("6,", 1, "12.345")],
)
def test_places_of_the_number(delimiter: str, column: int, word: str | None) -> None:
    assert word_after(LINES, delimiter, column, ":;,") == word


def test_a_delimiter_at_the_end_of_its_line_is_cut_first() -> None:
    assert word_after(["cost= 3.5; cost="], "cost=", 0, ":;,") == "3.5"


def run(ini: Path, point: Point = POINT, *, time_limit: float | None = None) -> tuple[float, ...]:
    program = Program(load(ini), time_limit=time_limit)
    return program.run(point, ini.parent / "tmp-genopt-run-1").costs


def failure(ini: Path, **options: float) -> str:
    with pytest.raises(RunFailed) as caught:
        run(ini, **options)  # type: ignore[arg-type]
    return str(caught.value)


def test_a_run_writes_inputs_and_reads_costs(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    assert run(ini)[0] == pytest.approx(0.05**2 + 0.8**2)
    assert (tmp_path / "tmp-genopt-run-1" / "in.txt").read_text() == "x1 = 0.25\nx2 = -0.5\n"


def test_paths_with_blanks_work(tmp_path: Path) -> None:
    ini = write_project(
        tmp_path / "a project (1)",
        files="""
    Input { File1 = "my input.txt"; Path1 = "sub dir"; }
    Log { File1 = log.txt; } Output { File1 = out.txt; }""",
        command='\\"' + sys.executable + '\\" -I -S ./simulate.py '
        "%Simulation.Files.Input.Path1%/%Simulation.Files.Input.File1%",
    )
    assert run(ini)[0] == pytest.approx(0.05**2 + 0.8**2)


@pytest.mark.skipif(os.name != "posix", reason="GenOpt keeps quotes on Windows")
def test_an_argument_with_blanks_gives_a_note(tmp_path: Path) -> None:
    project = load(write_project(tmp_path, command='echo \\"a b\\" c'))
    words = Program(project).command(tmp_path / "tmp-genopt-run-1")
    assert words == ["echo", "a b", "c"]
    assert "accepted beyond GenOpt: 'a b' stays one argument" in project.report.notes[0]


def test_the_extension_can_be_left_out(tmp_path: Path) -> None:
    ini = write_project(tmp_path, extension="false")
    words = Program(load(ini)).command(tmp_path / "tmp-genopt-run-1")
    assert words[-1] == "in"


def test_functions_and_discrete_values(tmp_path: Path) -> None:
    vary = (
        TWO_CONTINUOUS
        + """
    Parameter { Name = mat; Ini = 1; Values = "2,7"; }
    Function { Name = half; Function = "multiply(%x1%, 0.5)"; }"""
    )
    ini = write_project(
        tmp_path,
        vary=vary,
        template="x1 = %half%\nx2 = %x2%\nm = %mat%\n",
        objectives='Name1 = total; Function1 = "add(%read%, %half%)"; Name2 = read; Delimiter2 = "cost=";',
    )
    costs = run(ini, Point((0.5, 0.3), (1,)))
    assert costs == pytest.approx((0.05**2 + 6.7**2 + 0.25, 0.05**2 + 6.7**2))


@pytest.mark.parametrize(
    ("program", "message"),
    [
        (
            "import sys; sys.stderr.write('no licence'); sys.exit(7)",
            "exit value of the simulation program: 7",
        ),
        ("open('log.txt', 'w')", "output file"),
        ("open('out.txt', 'w').write('cost= 1')", "log file"),
        (
            "open('log.txt', 'w').write('ok\\nFatal: bad'); open('out.txt', 'w').write('cost= 1')",
            "found on line 2",
        ),
        ("open('log.txt', 'w'); open('out.txt', 'w').write('cost= NaN')", "'cost' is NaN"),
        ("open('log.txt', 'w'); open('out.txt', 'w').write('cost= 1.2D+03')", "a Fortran number"),
        ("open('log.txt', 'w'); open('out.txt', 'w').write('cost= abc')", "which is not a number"),
        ("open('log.txt', 'w'); open('out.txt', 'w').write('kost= 1')", "delimiter is 'cost='"),
    ],
)
def test_failures_have_run_and_files(tmp_path: Path, program: str, message: str) -> None:
    said = failure(write_project(tmp_path, program=program))
    assert message in said
    assert said.startswith("run 1: ")
    folder = tmp_path / "tmp-genopt-run-1"
    assert str(folder) in said
    assert (folder / "in.txt").exists()
    assert message in (folder / "failure.txt").read_text()


def test_the_error_stream_of_the_program_is_shown(tmp_path: Path) -> None:
    said = failure(write_project(tmp_path, program="import sys; sys.stderr.write('no licence'); sys.exit(7)"))
    assert "error stream of the program: no licence" in said


def test_a_program_beyond_the_time_limit_is_stopped_with_its_children(tmp_path: Path) -> None:
    late = [str(tmp_path / name) for name in ("child.txt", "parent.txt")]
    program = f"""
    import subprocess, sys, time
    child = "import sys, time; time.sleep(2); open(sys.argv[1], 'w')"
    subprocess.Popen([sys.executable, "-c", child, {late[0]!r}])
    time.sleep(2)
    open({late[1]!r}, "w")
    """
    said = failure(write_project(tmp_path, program=program), time_limit=0.7)
    assert "did not end within 0.7 s" in said
    time.sleep(2.5)
    assert not Path(late[1]).exists()
    if os.name == "posix":
        assert not Path(late[0]).exists()


def test_a_missing_program_is_an_error_before_any_run(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"sim\.cfg:3: the program 'no-such-program' is not found"):
        Program(load(write_project(tmp_path, command="no-such-program %Simulation.Files.Input.File1%")))


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("echo %Simulation.Files.Inputs.File1%", "Did you mean 'Simulation.Files.Input.File1'"),
        ("echo .5", "write 0.5"),
        ("a" * 300, "is not found"),
    ],
)
def test_errors_of_the_command(tmp_path: Path, command: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        Program(load(write_project(tmp_path, command=command)))
    assert "sim.cfg:3: " in str(caught.value)
    assert message in str(caught.value)


def test_a_file_of_the_run_in_the_start_directory_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ini = write_project(tmp_path, command="echo in.txt")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "in.txt").write_text("old")
    monkeypatch.chdir(elsewhere)
    with pytest.raises(InputError, match="GenOpt started in this directory would give it to every run"):
        Program(load(ini))
    project = load(ini, lenient=True)
    words = Program(project).command(tmp_path / "tmp-genopt-run-1")
    assert words == ["echo", "in.txt"]
    assert any("accepted beyond GenOpt" in n for n in project.report.notes)


def test_a_parameter_without_place_in_a_template_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"command\.txt:3: '%x2%' must occur"):
        Program(load(write_project(tmp_path, template="x1 = %x1%\n")))


def test_nothing_goes_through_a_shell(tmp_path: Path) -> None:
    ini = write_project(tmp_path / "a;touch hacked")
    run(ini)
    assert not list(tmp_path.rglob("hacked"))
