from __future__ import annotations

from pathlib import Path

import pytest

from genopt_support import HOOKE_JEEVES, in_process, write_project
from mascarin import cli


@pytest.fixture(autouse=True)
def _in_process(monkeypatch: pytest.MonkeyPatch) -> None:
    in_process(monkeypatch)


def test_the_minimum_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["optimize", str(write_project(tmp_path)), "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines()[0].startswith("GPSHookeJeeves: required accuracy is reached; ")
    assert "x1 = 0.3" in out
    assert err == ""


def test_errors_end_with_one_as_in_genopt(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ini = write_project(tmp_path, algorithm=HOOKE_JEEVES.replace("MeshSizeDivider", "MeshSizeDivisor"))
    assert cli.main(["optimize", str(ini)]) == 1
    err = capsys.readouterr().err
    assert "command.txt:8: unknown or unexpected keyword 'MeshSizeDivisor'" in err
    assert "Optimization terminated with error." in (tmp_path / "GenOpt.log").read_text()


def test_the_limit_on_evaluations_ends_with_exit_code_zero(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ini = write_project(tmp_path, settings="MaxIte = 8; WriteStepNumber = false; UnitsOfExecution = 1;")
    assert cli.main(["optimize", str(ini)]) == 0
    assert "Maximum number of iteration exceeded." in capsys.readouterr().err


def test_check_runs_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["optimize", str(write_project(tmp_path)), "--check"]) == 0
    assert "GPSHookeJeeves: x1, x2" in capsys.readouterr().out
    assert not (tmp_path / "GenOpt.log").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--on-failure", "ignore"], "expected 'stop' or a finite number"),
        (["--on-failure", "nan"], "expected 'stop' or a finite number"),
        (["--workers", "0"], "--workers is 0; expected more than 0"),
        (["--time-limit", "-1"], "--time-limit is -1.0; expected more than 0"),
        (["--resume"], "there is no log"),
    ],
)
def test_options_that_make_no_sense(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    assert cli.main(["optimize", str(write_project(tmp_path)), *words]) == 1
    assert message in capsys.readouterr().err


def test_a_missing_project_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["optimize", str(tmp_path / "none.ini")]) == 1
    assert "none.ini" in capsys.readouterr().err


def test_leniencies_are_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ini = write_project(tmp_path)
    (tmp_path / "command.txt").write_text("/* no blank*/" + (tmp_path / "command.txt").read_text())
    assert cli.main(["optimize", str(ini)]) == 1
    assert cli.main(["optimize", str(ini), "--lenient"]) == 0
    assert "command.txt:1: accepted beyond GenOpt: no blank before '*/'" in capsys.readouterr().err


def test_an_interrupted_run_is_mentioned(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ini = write_project(tmp_path)
    assert cli.main(["optimize", str(ini)]) == 0
    log = tmp_path / "opt.evaluations.jsonl"
    log.write_text("\n".join(log.read_text().splitlines()[:11]) + "\n")
    capsys.readouterr()
    assert cli.main(["optimize", str(ini)]) == 0
    assert "an earlier run stopped after 10 evaluations" in capsys.readouterr().err
