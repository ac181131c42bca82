from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from genopt_support import (
    HOOKE_JEEVES,
    SWARM,
    body,
    in_process,
    runner,
    two_wells,
    write_project,
)
from mascarin.errors import InputError, SolverError
from mascarin.genopt import Options, optimize
from mascarin.genopt.program import Result, RunFailed
from mascarin.genopt.run import check, interrupted, log_path
from mascarin.optimization import Point

WIDE = """
    Parameter { Name = x1; Min = -4; Ini = 2.5; Max = 4; Step = 0.5; }
    Parameter { Name = x2; Min = -4; Ini = 2.5; Max = 4; Step = 0.5; }
"""
MIXED = """
    Parameter { Name = x1; Min = -2; Ini = 1; Max = 2; Step = 0.25; }
    Parameter { Name = n; Ini = 1; Values = "9,3,1,5,0"; }
"""
SEVERAL = HOOKE_JEEVES.replace(
    "MeshSizeDivider", "MultiStart = Uniform; Seed = 3; NumberOfInitialPoint = 5; MeshSizeDivider"
)
GRID = "Main = Mesh; StopAtError = false;"
COARSE = """
    Parameter { Name = x1; Min = 0; Ini = 0; Max = 1; Step = 4; }
    Parameter { Name = x2; Min = 0; Ini = 0; Max = 1; Step = 2; }
"""


def bowl(p: Point) -> float:
    return sum((v - 0.3) ** 2 for v in p.x)


def listings(folder: Path) -> list[list[str]]:
    return [body(folder / f"OutputListing{which}.txt") for which in ("Main", "All")]


# ---------------------------------------------------------------------- parallel runs


@pytest.mark.parametrize("algorithm", [SEVERAL, SEVERAL.replace("HookeJeeves", "CoordinateSearch")])
def test_parallel_polling_and_starts_equal_the_serial_search(tmp_path: Path, algorithm: str) -> None:
    serial = optimize(write_project(tmp_path / "a", vary=WIDE, algorithm=algorithm), run=runner(two_wells))
    ini = write_project(tmp_path / "b", vary=WIDE, algorithm=algorithm)
    parallel = optimize(ini, Options(workers=8), run=runner(two_wells))
    assert listings(tmp_path / "a") == listings(tmp_path / "b")
    assert serial.simulations == parallel.simulations
    assert serial.values() == parallel.values()
    assert parallel.runs > serial.runs


def test_workers_shorten_a_sequential_search(tmp_path: Path) -> None:
    lock, busy, most = threading.Lock(), [0], [0]

    def slow(point: Point, _folder: Path) -> Result:
        with lock:
            busy[0] += 1
            most[0] = max(most[0], busy[0])
        time.sleep(0.01)
        with lock:
            busy[0] -= 1
        return Result((two_wells(point),), 0.01)

    for workers in (1, 8):
        most[0] = 0
        ini = write_project(tmp_path / str(workers), vary=WIDE, algorithm=SEVERAL)
        optimize(ini, Options(workers=workers), run=slow)
        assert most[0] == workers


def test_without_runs_in_advance_every_run_is_needed(tmp_path: Path) -> None:
    ini = write_project(tmp_path, vary=WIDE, algorithm=SEVERAL)
    outcome = optimize(ini, Options(workers=8, ahead=False), run=runner(two_wells))
    assert outcome.runs == outcome.simulations


def test_a_parallel_swarm_equals_the_serial_one(tmp_path: Path) -> None:
    texts = []
    for workers in (1, 3):
        folder = tmp_path / str(workers)
        ini = write_project(folder, algorithm=f"Main = PSOCC; {SWARM}")
        optimize(ini, Options(workers=workers), run=runner(bowl))
        texts.append(listings(folder))
    assert texts[0] == texts[1]


# ---------------------------------------------------------------------- resume


def test_a_killed_run_continues(tmp_path: Path) -> None:
    whole = write_project(tmp_path / "whole")
    program = (tmp_path / "whole" / "simulate.py").read_text()
    counting = program + "\nopen(sys.argv[0] + '.count', 'a').write('x')\n"
    (tmp_path / "whole" / "simulate.py").write_text(counting)
    cut = write_project(tmp_path / "cut", program=counting)
    optimize(whole)
    command = [sys.executable, "-m", "mascarin.cli", "optimize", str(cut), "--quiet"]
    process = subprocess.Popen(command, start_new_session=os.name == "posix")
    while not log_path(cut).exists() or log_path(cut).read_text().count("\n") < 12:
        time.sleep(0.01)
        assert process.poll() is None
    if sys.platform == "win32":
        process.kill()
    else:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    with log_path(cut).open("a") as file:
        file.write('{"number":13,"st')  # what a kill in the middle of a write leaves
    assert "--resume" in interrupted(cut)
    optimize(cut, Options(resume=True))
    assert listings(tmp_path / "whole") == listings(tmp_path / "cut")
    starts = [(tmp_path / which / "simulate.py.count").stat().st_size for which in ("whole", "cut")]
    # The run that was going on when the kill came is the only one that is repeated.
    assert starts[0] <= starts[1] <= starts[0] + 1
    assert interrupted(cut) == ""


def test_a_longer_search_uses_the_results_of_a_shorter_one(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    first = optimize(ini, run=runner(bowl))
    longer = (tmp_path / "command.txt").read_text().replace("Reduction = 4", "Reduction = 6")
    (tmp_path / "command.txt").write_text(longer)
    second = optimize(ini, Options(resume=True), run=runner(bowl))
    assert second.simulations > first.simulations
    assert second.runs == second.simulations - first.simulations


def test_the_log_of_another_project_is_an_error(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    optimize(ini, run=runner(bowl))
    (tmp_path / "template.txt").write_text("x1 = %x1%\nx2 = %x2%\nmore\n")
    with pytest.raises(InputError, match=r"changed since then: template 'template\.txt'"):
        optimize(ini, Options(resume=True), run=runner(bowl))


def test_a_run_whose_line_in_the_log_is_damaged_is_made_again(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    reference = optimize(ini, run=runner(bowl))
    first, line, *lines = log_path(ini).read_text().splitlines(keepends=True)
    cost = json.loads(line)["costs"][0]
    for damaged in (
        line.replace(f'"costs":[{cost!r}', '"costs":[-99.0'),
        line.replace(f'"costs":[{cost!r}', '"costs":[NaN'),
        "nonsense\n",
    ):
        assert damaged != line
        log_path(ini).write_text("".join([first, damaged, *lines]))
        with pytest.warns(UserWarning, match=r"damaged lines: 1 \(line 2: .*these simulations are run again"):
            again = optimize(ini, Options(resume=True), run=runner(bowl))
        assert again.runs == 1
        assert again.values() == reference.values()
    log_path(ini).write_text("".join([first.replace('"format":2', '"format":3'), line, *lines]))
    with pytest.raises(InputError, match="not the first line of a log of evaluations"):
        optimize(ini, Options(resume=True), run=runner(bowl))


def test_without_a_log_there_is_nothing_to_resume(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no log"):
        optimize(write_project(tmp_path), Options(resume=True), run=runner(bowl))


def test_a_new_run_keeps_the_log_of_the_one_before(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    optimize(ini, run=runner(bowl))
    before = log_path(ini).read_text()
    optimize(ini, run=runner(two_wells))
    assert (tmp_path / "opt.evaluations.previous.jsonl").read_text() == before
    assert log_path(ini).read_text() != before


# ---------------------------------------------------------------------- failures


def fails(p: Point) -> bool:
    return p.x[0] > 0.95 or p.x[1] < 0.2


def test_failures_have_the_given_cost_and_their_files_are_kept(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    outcome = optimize(ini, Options(penalty=1e3), run=runner(bowl, fails))
    assert outcome.lowest is not None
    assert outcome.lowest.evaluation.point.x == (0.3, 0.3)
    assert outcome.failures > 0
    failed = [r for r in outcome.records if r.costs is None]
    assert all(r.attempts == 2 for r in failed)
    kept = tmp_path / "failed-runs" / f"run-{failed[0].number}"
    assert (kept / "in.txt").read_text() == "inputs"
    rows = [line.split("\t") for line in listings(tmp_path)[1][1:] if line]
    assert {r[4] for r in rows if r[0] == str(failed[0].number)} >= {"1000.0"}
    log = (tmp_path / "GenOpt.log").read_text()
    assert f"Simulation {failed[0].number} failed; its files are in '{kept}'" in log


def test_a_project_whose_first_runs_all_fail_stops(tmp_path: Path) -> None:
    with pytest.raises(RunFailed, match="every run of the first batch failed"):
        optimize(write_project(tmp_path), Options(penalty=1.0), run=runner(bowl, lambda _: True))


def test_without_a_penalty_one_more_try_then_the_end(tmp_path: Path) -> None:
    calls: list[Point] = []

    def run(point: Point, folder: Path) -> Result:
        calls.append(point)
        if len(calls) > 3:
            raise RunFailed(f"{folder.name}: broken")
        return Result((bowl(point),), 0.0)

    with pytest.raises(RunFailed, match="broken"):
        optimize(write_project(tmp_path), run=run)
    assert len(calls) == 5
    assert calls[3] == calls[4]


def test_a_program_that_fails_at_every_first_try_gives_the_same_listings(tmp_path: Path) -> None:
    tries: dict[Point, int] = {}

    def moody(p: Point) -> bool:
        tries[p] = tries.get(p, 0) + 1
        return tries[p] == 1 and len(tries) > 1

    optimize(write_project(tmp_path / "a"), run=runner(bowl))
    outcome = optimize(write_project(tmp_path / "b"), run=runner(bowl, moody))
    assert listings(tmp_path / "a") == listings(tmp_path / "b")
    assert "Try to evaluate simulation a second time." in outcome.warnings[0]


def test_failures_in_a_grid_are_zeros_as_in_genopt_and_reported(tmp_path: Path) -> None:
    ini = write_project(tmp_path, vary=COARSE, algorithm=GRID)
    table = tmp_path / "all.csv"
    outcome = optimize(ini, Options(table=table), run=runner(bowl, lambda p: p.x == (0.5, 0.5)))
    row = next(line for line in listings(tmp_path)[0] if line.startswith("8\t"))
    assert row == "8\t8\t0\t0.0\t0.5\t0.5\tFunction evaluation successful."
    with table.open(newline="") as file:
        rows = {r["simulation"]: r for r in csv.DictReader(file)}
    assert rows["8"]["status"] == "failed"
    assert rows["8"]["cost"] == ""
    assert any("Simulation 8 failed" in w for w in outcome.warnings)


def test_a_failed_run_of_a_resumed_search_is_tried_again(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    with pytest.raises(RunFailed):
        optimize(ini, run=runner(bowl, lambda p: p.x[0] < 0.5))
    outcome = optimize(ini, Options(resume=True), run=runner(bowl))
    assert outcome.lowest is not None
    assert outcome.lowest.evaluation.cost == 0.0


def test_too_many_equal_costs_stop_the_simplex(tmp_path: Path) -> None:
    algorithm = """Main = NelderMeadONeill; Accuracy = 0.001; StepSizeFactor = 0.1; BlockRestartCheck = 5;
    ModifyStoppingCriterion = true;"""
    settings = "MaxIte = 50; MaxEqualResults = 2; WriteStepNumber = false;"
    with pytest.raises(SolverError, match="more than MaxEqualResults = 2 times"):
        optimize(write_project(tmp_path, algorithm=algorithm, settings=settings), run=runner(lambda _: 1.0))


def test_a_cost_that_never_changes_is_said(tmp_path: Path) -> None:
    outcome = optimize(write_project(tmp_path / "constant"), run=runner(lambda _: 4.5))
    assert len(outcome.warnings) == 1
    assert "the cost 'cost'" in outcome.warnings[0]
    assert "4.5 in all runs at" in outcome.warnings[0]
    assert "does not depend on the parameters" in (tmp_path / "constant" / "GenOpt.log").read_text()
    assert not optimize(write_project(tmp_path / "bowl"), run=runner(bowl)).warnings


def test_doubtful_numbers_are_said_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A delimiter that stands several times, and a comma that seems to be a decimal mark."""
    in_process(monkeypatch)
    program = """
    import re
    x = [float(n) for n in re.findall(r'= (\\S+)', open('in.txt').read())]
    open('log.txt', 'w').close()
    cost = str(sum(v * v for v in x) + 20.25).replace('.', ',')
    open('out.txt', 'w').write('cost= 1\\ncost= ' + cost + '\\n')
    """
    outcome = optimize(write_project(tmp_path, program=program))
    several, comma, *_ = outcome.warnings
    assert "the delimiter 'cost=' of 'cost'" in several
    assert "stands 2 times in out.txt; the last one is read" in several
    assert re.search(r"'cost' is read as (\d+) from '\1,\d+' in out.txt", comma)
    assert sum("stands 2 times" in text for text in outcome.warnings) == 1


# ---------------------------------------------------------------------- beyond GenOpt


def mixed(p: Point) -> float:
    return (p.x[0] - 0.5) ** 2 + [9, 3, 1, 5, 0][p.choices[0]]


@pytest.mark.parametrize(
    ("algorithm", "lenient"),
    [
        (HOOKE_JEEVES, True),
        (HOOKE_JEEVES.replace("GPSHooke", "MascarinHooke"), False),
    ],
)
def test_discrete_parameters_that_genopt_does_not_accept(
    tmp_path: Path, algorithm: str, lenient: bool
) -> None:
    ini = write_project(tmp_path, vary=MIXED, algorithm=algorithm, template="%x1% %n%\n")
    outcome = optimize(ini, Options(lenient=lenient), run=runner(mixed))
    assert outcome.lowest is not None
    assert outcome.lowest.evaluation.point.choices == (4,)
    assert outcome.lowest.evaluation.point.x[0] == pytest.approx(0.5, abs=1e-2)
    assert any("accepted beyond GenOpt" in n for n in outcome.notes)


def test_an_algorithm_that_does_not_exist_is_refused(tmp_path: Path) -> None:
    ini = write_project(tmp_path, algorithm="Main = MascarinDE; Seed = 1;")
    with pytest.raises(InputError, match="algorithm 'MascarinDE' is not known"):
        optimize(ini, run=runner(bowl))


def test_covariance_search(tmp_path: Path) -> None:
    ini = write_project(tmp_path, algorithm="Main = MascarinCMAES; Seed = 4; Sigma = 1e-1;")
    outcome = optimize(ini, run=runner(bowl))
    assert outcome.lowest is not None
    assert outcome.lowest.evaluation.cost < 1e-8


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_all_evaluations_as_a_table(tmp_path: Path, ending: str) -> None:
    import pandas as pd

    path = tmp_path / f"all.{ending}"
    outcome = optimize(write_project(tmp_path), Options(table=path), run=runner(bowl))
    table = pd.read_csv(path) if ending == "csv" else pd.read_parquet(path)
    assert list(table.columns[:6]) == ["simulation", "status", "step_number", "x1", "x2", "cost"]
    assert len(table) == outcome.simulations
    expected = (table["x1"] - 0.3) ** 2 + (table["x2"] - 0.3) ** 2
    assert (table["cost"] - expected).abs().max() < 1e-15


def test_a_table_that_cannot_be_written_is_an_error_before_the_runs(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    with pytest.raises(InputError, match=r"expected \.csv or \.parquet"):
        optimize(ini, Options(table=tmp_path / "all.xlsx"), run=runner(bowl))
    assert not log_path(ini).exists()


# ---------------------------------------------------------------------- files


def test_saved_files_are_numbered_and_old_ones_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_process(monkeypatch)
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "77out.txt").write_text("old")
    files = """
    Input { File1 = in.txt; } Log { File1 = log.txt; } Output { File1 = out.txt; SavePath1 = kept; }"""
    ini = write_project(tmp_path, vary=COARSE, algorithm=GRID, files=files)
    outcome = optimize(ini)
    assert outcome.simulations == 15
    assert sorted(p.name for p in (tmp_path / "kept").iterdir()) == sorted(
        f"{i}out.txt" for i in range(1, 16)
    )
    assert (tmp_path / "kept" / "1out.txt").read_text() == f"cost= {2 * 0.3**2!r}\n"
    assert not list(tmp_path.glob("tmp-genopt-run-*"))


def test_the_log_of_runs_is_one_record_a_line(tmp_path: Path) -> None:
    ini = write_project(tmp_path)
    outcome = optimize(ini, run=runner(bowl))
    head, *records, end = map(json.loads, log_path(ini).read_text().splitlines())
    assert head["format"] == 2
    assert len(records) == outcome.simulations
    assert records[0]["x"] == [0.9, 0.9]
    assert end["end"] == "required accuracy is reached"


def test_the_end_by_the_limit_is_logged_as_genopt_does(tmp_path: Path) -> None:
    outcome = optimize(
        write_project(tmp_path, settings="MaxIte = 10; WriteStepNumber = false;"), run=runner(bowl)
    )
    assert outcome.exhausted
    log = (tmp_path / "GenOpt.log").read_text()
    assert "Optimization terminated with error." in log
    assert "Maximum number of iteration exceeded." in log
    assert listings(tmp_path)[0][-2].endswith("Current lowest point.")


def test_a_project_can_be_checked_without_running(tmp_path: Path) -> None:
    project, lines = check(write_project(tmp_path, algorithm=f"Main = PSOCC; {SWARM}"))
    assert project.names == ["x1", "x2"]
    assert "simulations: 24" in lines
    assert not (tmp_path / "OutputListingMain.txt").exists()


def test_a_log_of_another_format_is_refused(tmp_path: Path) -> None:
    from mascarin._io.sealed import own_records
    from mascarin.genopt import records

    path = tmp_path / "opt.evaluations.jsonl"
    first = own_records.sealed("log of a search", {"format": records.FORMAT + 1, "project": {}})
    with pytest.raises(InputError, match="found format 3, expected 2; remove it or start without --resume"):
        records._compare(path, first.encode(), {})
    same = own_records.sealed("log of a search", {"format": records.FORMAT, "project": {}})
    records._compare(path, same.encode(), {})
