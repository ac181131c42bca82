"""A study as a GenOpt project: the files, one evaluation, and the same search outside and inside."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from genopt_support import body
from mascarin import cli
from mascarin.calibration import Cost, Evaluator, SearchOptions, solve
from mascarin.calibration.base.problem import FitParameter
from mascarin.errors import InputError, SolverError
from mascarin.genopt import Options as RunOptions
from mascarin.genopt import optimize
from mascarin.genopt.export.algorithms import ALGORITHMS, Plan
from mascarin.genopt.export.algorithms import chosen as chosen_algorithm
from mascarin.genopt.export.case import Case, inputs_of, open_case
from mascarin.genopt.export.compiling import compile_study, compiled
from mascarin.genopt.export.evaluation import evaluate_files
from mascarin.genopt.export.internal_search import search
from mascarin.genopt.export.writing import FILES, Options, _command, variable, write_project
from mascarin.genopt.files.numbers import single
from mascarin.genopt.program import Program
from mascarin.genopt.run import check
from mascarin.optimization import Evaluation, HookeJeeves, Observer, box, uniform_starts
from mascarin.study import Study
from study_support import BUILDING, TRUTH, logger_table

STUDY = """\
name: Test wall
building: building.yaml
climate:
  measured:
    table: logger.csv
    timezone: UTC+1
    columns: {air_temperature: air}
    absent: [wind_speed, wind_direction, dew_point, global_horizontal, diffuse_horizontal, direct_normal]
measurements:
  table: logger.csv
  timezone: UTC+1
sensors:
  joint: {column: joint, output: wall.interface_1_temperature, offset: 0, uncertainty: 0.2}
  core: {column: core, output: core.temperature, offset: 0, uncertainty: 0.3}
step: 30min
periods:
  warm_up: ["2023-03-01 00:00", "2023-03-02 00:00"]
  identification: ["2023-03-02 00:00", "2023-03-04 00:00"]
  corroboration: ["2023-03-06 00:00", "2023-03-08 00:00"]
identification:
  method: hooke-jeeves
  cost: sd
  starts: 3
  seed: 5
  lead: 1d
  parameters:
    materials.insulation.conductivity: {low: 0.02, high: 0.06}
    surfaces.wall.outside.absorptance: {low: 0.2, high: 0.8}
"""
INSULATION, ABSORPTANCE = "materials.insulation.conductivity", "surfaces.wall.outside.absorptance"
PROGRAM = shutil.which("mascarin", path=str(Path(sys.executable).parent)) or "mascarin"
SHORT = Options(reductions=3, program=PROGRAM)


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a blank in its name that holds a study."""
    folder = tmp_path_factory.mktemp("coupling") / "test wall"
    folder.mkdir()
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return folder


@pytest.fixture
def copy(bench: Path, tmp_path: Path) -> Path:
    """The same, to be changed."""
    return shutil.copytree(bench, tmp_path / "changed wall")


@pytest.fixture(scope="module")
def study(bench: Path) -> Study:
    return Study(bench / "study.yaml")


@pytest.fixture(scope="module")
def case(study: Study) -> Case:
    return compile_study(study)


def edit(path: Path, before: str, after: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count(before) == 1
    path.write_text(text.replace(before, after), encoding="utf-8")


# --- the compiled case ----------------------------------------------------------------------------------


def test_the_cost_of_a_case_equals_that_of_the_study_exactly(
    study: Study, case: Case, tmp_path: Path
) -> None:
    problem = study.context.problem()
    assert replace(problem, identity="").fingerprint() == case.problem.fingerprint()
    case.save(tmp_path / "case.npz")
    read = open_case(tmp_path / "case.npz", str(study.context.inputs.source_file.resolve()))
    assert read is not None
    for x in np.array([[0.033, 0.62], [0.0512345678, 0.2], [0.02, 0.8]]):
        residuals = problem.residuals(x[None])
        cost = Cost(problem, "sd")
        of_sensors = cost.of_sensors(residuals)[0]
        for one in (case, read):
            found = one.evaluate({INSULATION: x[0], ABSORPTANCE: x[1]})
            assert found.parts == {"joint": of_sensors[0], "core": of_sensors[1]}
            assert found.total == cost.total(x[None], of_sensors[None])[0] == sum(of_sensors)
            assert found.defaults == ()


def test_parameters_that_are_not_given_keep_the_value_of_the_study(case: Case) -> None:
    found = case.evaluate({INSULATION: 0.03})
    assert found.defaults == (ABSORPTANCE,)
    assert found.total == case.evaluate({INSULATION: 0.03, ABSORPTANCE: 0.5}).total


def test_the_true_parameters_have_a_lower_cost(case: Case) -> None:
    true = {path: TRUTH[path] for path in (INSULATION, ABSORPTANCE)}
    assert case.evaluate(true).total < 0.5 * case.evaluate({}).total


def test_priors_have_a_separate_cost(copy: Path) -> None:
    edit(copy / "study.yaml", "cost: sd", "cost: nll")
    edit(copy / "study.yaml", "{low: 0.2, high: 0.8}", "{low: 0.2, high: 0.8, prior: 0.1}")
    case = compile_study(Study(copy / "study.yaml"))
    assert case.names == ["cost", "cost_joint", "cost_core", "cost_priors"]
    found = case.evaluate({ABSORPTANCE: 0.7})
    assert found.parts["priors"] == pytest.approx(2.0)  # two standard deviations, squared and halved
    assert found.total == pytest.approx(sum(found.parts.values()))


@pytest.mark.parametrize("changed", ["study.yaml", "building.yaml", "logger.csv"])
def test_a_kept_case_is_not_used_when_a_file_changes(copy: Path, changed: str) -> None:
    kept = copy / "compiled.npz"
    compiled(copy / "study.yaml", kept)
    name = str((copy / "study.yaml").resolve())
    assert open_case(kept, name) is not None
    with (copy / changed).open("a", encoding="utf-8") as file:
        file.write("\n")
    assert open_case(kept, name) is None
    assert open_case(kept, str(copy / "other.yaml")) is None


@pytest.mark.parametrize("content", [b"", b"no archive", "half"])
def test_a_broken_case_is_made_again(copy: Path, case: Case, content: bytes | str) -> None:
    kept, study = copy / "compiled.npz", copy / "study.yaml"
    compiled(study, kept)
    whole = kept.read_bytes()
    kept.write_bytes(whole[: len(whole) // 2] if isinstance(content, str) else content)
    assert open_case(kept, str(study.resolve())) is None
    assert compiled(study, kept).evaluate({}) == case.evaluate({})
    assert open_case(kept, str(study.resolve())) is not None
    assert not list(copy.glob("*.part"))


def test_a_case_belongs_to_one_state_of_the_program(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    before = inputs_of("study", [str(study.context.inputs.source_file)])
    monkeypatch.setattr("mascarin.genopt.export.case._PACKAGE", study.context.inputs.source_file.parent)
    assert inputs_of("study", [str(study.context.inputs.source_file)])["program"] != before["program"]


def test_an_evaluation_imports_nothing_that_reads_studies(bench: Path, tmp_path: Path) -> None:
    write_project(str(bench / "study.yaml"), tmp_path, SHORT)
    run = tmp_path / "run"
    run.mkdir()
    (run / "parameters.txt").write_text(f"project = ..\n{INSULATION} = 0.03\n", encoding="utf-8")
    script = (
        "import sys; from mascarin import cli; code = cli.main(['cost']);"
        "print(code, [m for m in ('pandas', 'pydantic', 'scipy', 'xarray', 'ruamel') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=run, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "0 []"


# --- the project ----------------------------------------------------------------------------------------


def test_an_exported_project_is_read_without_notes(bench: Path, tmp_path: Path) -> None:
    ini = write_project(str(bench / "study.yaml"), tmp_path / "project", SHORT)
    assert {path.name for path in ini.parent.iterdir()} == set(FILES)
    project, _ = check(ini)
    assert project.report.notes == []
    assert [(p.name, p.lower, p.initial, p.upper, p.step) for p in project.continuous] == [
        (INSULATION, 0.02, 0.04, 0.06, 0.004),
        (ABSORPTANCE, 0.2, 0.5, 0.8, 0.06),
    ]
    assert [o.name for o in project.objectives] == ["cost", "cost_joint", "cost_core"]
    section = [(e.key, e.value) for e in project.algorithm.entries]
    assert section[:4] == [
        ("Main", "GPSHookeJeeves"),
        ("MultiStart", "Uniform"),
        ("Seed", "5"),
        ("NumberOfInitialPoint", "3"),
    ]


def test_a_project_has_no_absolute_paths(
    bench: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(Path(PROGRAM).parent))
    ini = write_project(str(bench / "study.yaml"), bench.parent / "a project", Options())
    for name in FILES[:-1]:
        text = (ini.parent / name).read_text(encoding="utf-8")
        assert str(tmp_path.parent) not in text
        assert "'" not in "".join(line for line in text.splitlines() if line.startswith("//"))
    assert '"../test wall/study.yaml"' in (ini.parent / "coupling.json").read_text(encoding="utf-8")
    assert 'Command = "mascarin cost";' in (ini.parent / "mascarin.cfg").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ALGORITHMS)
def test_every_algorithm_is_accepted(name: str, case: Case, bench: Path, tmp_path: Path) -> None:
    ini = write_project(str(bench / "study.yaml"), tmp_path, SHORT)
    for parameters in (case.parameters[:1], case.parameters):
        algorithm = ALGORITHMS[name]
        if (algorithm.single and len(parameters) > 1) or (
            algorithm.several_parameters and len(parameters) < 2
        ):
            with pytest.raises(InputError, match=f"--algorithm {name}: .*parameter"):
                chosen_algorithm(name, len(parameters))
            continue
        variables = [variable(p, bench, intervals=algorithm.intervals) for p in parameters]
        assert chosen_algorithm(algorithm.main, len(parameters)) is algorithm
        (tmp_path / "command.txt").write_text(
            _command(variables, algorithm, Plan(2, 1, 3, 100)), encoding="utf-8"
        )
        (tmp_path / "template.txt").write_text("".join(f"%{v.name}%\n" for v in variables), encoding="utf-8")
        project, lines = check(ini)
        assert project.report.notes == []
        assert lines[0].startswith(f"{algorithm.main}: {INSULATION}")


def test_bounds_are_rounded_inwards_to_digits_of_single_precision() -> None:
    found = variable(FitParameter("a.b", 1.0 / 3.0, 2.0e-5 + 1.0, nominal=0.123456789), Path("study.yaml"))
    assert (str(found.lower), str(found.upper)) == ("0.333334", "1.00002")
    narrow = variable(FitParameter("a.b", 0.12345678, 8765.4321, nominal=1.0 / 3.0), Path("study.yaml"))
    assert (str(narrow.lower), str(narrow.initial), str(narrow.upper)) == ("0.123457", "0.333333", "8765.43")
    for value in (narrow.lower, narrow.initial, narrow.upper):
        assert single(float(value)) == float(value)


# --- the search, outside and inside ---------------------------------------------------------------------


class Rows(Observer):
    """The listing of all iterations as the search reports it, with GenOpt's counters."""

    def __init__(self) -> None:
        self.rows: list[tuple[object, ...]] = []
        self._main = self._sub = 1

    def sub(self, evaluation: Evaluation, comment: str) -> None:
        e = evaluation
        self.rows.append((e.number, self._main, self._sub, e.cost, *e.outputs, *e.point.x, comment))
        self._sub += 1

    def main(self, evaluation: Evaluation, comment: str) -> None:
        self._main += 1
        self._sub = 1


def listed(folder: Path) -> list[tuple[object, ...]]:
    """Rows of the listing on disk; the last one repeats the minimum."""
    found: list[tuple[object, ...]] = []
    for line in body(folder / "OutputListingAll.txt")[1:]:
        if line:
            number, main, sub, _, *values, comment = line.split("\t")
            found.append((int(number), int(main), int(sub), *map(float, values), comment))
    assert found[-1][-1] == "Minimum point."
    return found[:-1]


def in_process(study: Study, reductions: int, starts: int, seed: int) -> tuple[Rows, Evaluator]:
    """The pattern search on the problem of the study, called directly without a project."""
    lower, upper = [0.02, 0.2], [0.06, 0.8]
    space = box([INSULATION, ABSORPTANCE], [0.04, 0.5], lower, upper, [0.004, 0.06])

    def rounded(value: float, _: int) -> float:
        return single(value)

    rows = Rows()
    optimizer = HookeJeeves(
        space,
        reductions=reductions,
        starts=uniform_starts(space, starts, seed, rounding=rounded),
        rounding=rounded,
        observer=rows,
    )
    evaluator = Evaluator(Cost(study.context.problem(), study.context.inputs.calibration_plan.cost))
    while points := optimizer.ask():
        told = []
        for point in points:
            x = np.array([point.x])
            total = float(evaluator.costs(x)[0])
            told.append(Evaluation(point, total, tuple(evaluator.trace().of_sensors[-1])))
        optimizer.tell(told)
    return rows, evaluator


@pytest.fixture
def without_processes(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Runs of the program take place here, through the same files; the folders they ran in."""
    folders: list[Path] = []

    def start(program: Program, folder: Path) -> None:
        assert program.command(folder)[1:] == ["cost"]
        folders.append(folder)
        evaluate_files(folder / "parameters.txt", folder / "result.txt", folder / "log.txt")

    monkeypatch.setattr(Program, "_start", start)
    return folders


def test_the_project_is_searched_like_the_study_evaluation_by_evaluation(
    study: Study, bench: Path, tmp_path: Path, without_processes: list[Path]
) -> None:
    ini = write_project(str(bench / "study.yaml"), tmp_path / "a project", SHORT)
    outcome = optimize(ini, RunOptions(workers=1))
    rows, evaluator = in_process(study, reductions=3, starts=3, seed=5)
    trace = evaluator.trace()
    assert len(without_processes) == outcome.simulations == len(trace.x) > 30
    # Every simulation, in order: the same point, the same costs, to the last bit.
    assert [r.costs for r in outcome.records] == [
        (total, *parts) for total, parts in zip(trace.cost, trace.of_sensors, strict=True)
    ]
    assert [r.key[1] for r in outcome.records] == [tuple(x) for x in trace.x]
    # Every row of the listing, those of repeated points too: counters, costs, point and comment.
    assert listed(ini.parent) == rows.rows
    assert outcome.lowest is not None
    assert outcome.lowest.evaluation.cost == trace.cost.min()
    # And the convenient way inside one process.
    inside = search(ini)
    assert [(r.key, r.costs) for r in inside.records] == [(r.key, r.costs) for r in outcome.records]
    assert listed(ini.parent) == rows.rows


def test_the_project_is_searched_like_a_calibration(
    copy: Path, tmp_path: Path, without_processes: list[Path]
) -> None:
    # Ranges from 0 to 1 and steps of a power of two are the same numbers for GenOpt, which searches in the
    # units of the parameters with seven digits, and for a calibration, which searches in shares of the range.
    coefficient = "surfaces.wall.inside.convection.coefficient"
    edit(
        copy / "study.yaml",
        "building: building.yaml",
        f"building: building.yaml\nset: {{{coefficient}: 0.25}}",
    )
    edit(copy / "study.yaml", "{low: 0.2, high: 0.8}", "{low: 0, high: 1}")
    edit(
        copy / "study.yaml", f"{INSULATION}: {{low: 0.02, high: 0.06}}", f"{coefficient}: {{low: 0, high: 1}}"
    )
    ini = write_project(str(copy / "study.yaml"), tmp_path / "project", replace(SHORT, starts=1))
    command = ini.parent / "command.txt"
    command.write_text(
        command.read_text(encoding="utf-8").replace("Step = 0.1;", "Step = 0.125;"), encoding="utf-8"
    )
    outcome = optimize(ini, RunOptions(workers=1))
    rules = SearchOptions(sequences=1, agree=1, step=0.125, reductions=3)
    fit = solve(Study(copy / "study.yaml").context.problem(), method="hooke-jeeves", cost="sd", options=rules)
    assert len(fit.trace.x) == len(without_processes) > 20
    assert [r.key[1] for r in outcome.records] == [tuple(x) for x in fit.trace.x]
    assert [r.costs[0] for r in outcome.records if r.costs] == list(fit.trace.cost)
    assert outcome.values()[ABSORPTANCE] == fit.values[ABSORPTANCE]


def test_the_program_itself_gives_the_same_numbers(bench: Path, tmp_path: Path) -> None:
    options = replace(SHORT, evaluations=6, starts=1)
    ini = write_project(str(bench / "study.yaml"), tmp_path / "a project", options)
    outcome = optimize(ini, RunOptions(workers=1))
    assert outcome.runs >= 6
    inside = search(ini)
    assert [(r.key, r.costs) for r in outcome.records] == [(r.key, r.costs) for r in inside.records]


# --- one evaluation -------------------------------------------------------------------------------------


@pytest.fixture
def run_folder(bench: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder below a project, as GenOpt makes one for each run; the current one."""
    write_project(str(bench / "study.yaml"), tmp_path / "project", SHORT)
    folder = tmp_path / "project" / "tmp-genopt-run-1"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def ask(folder: Path, text: str) -> None:
    (folder / "parameters.txt").write_text(text, encoding="utf-8")


def test_cost_reads_and_writes_files(
    run_folder: Path, case: Case, bench: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ask(run_folder, f"project = ..\n{INSULATION} = 3.3E-2  # W/(m K)\n\n{ABSORPTANCE} = 0.62\n")
    assert cli.main(["cost"]) == 0
    wanted = case.evaluate({INSULATION: 0.033, ABSORPTANCE: 0.62})
    lines = (run_folder / "result.txt").read_text(encoding="utf-8").splitlines()
    assert lines == [
        f"cost= {wanted.total!r}",
        f"cost_joint= {wanted.parts['joint']!r}",
        f"cost_core= {wanted.parts['core']!r}",
    ]
    assert capsys.readouterr().out.splitlines() == lines
    assert "ERROR" not in (run_folder / "log.txt").read_text(encoding="utf-8")
    # By hand, without a project.
    ask(run_folder, f"{INSULATION} = 0.033\n{ABSORPTANCE} = 0.62\n")
    words = ["cost", "parameters.txt", "--study", str(bench / "study.yaml"), "-o", "b.txt", "--log", "c.txt"]
    assert cli.main(words) == 0
    assert (run_folder / "b.txt").read_text(encoding="utf-8").splitlines() == lines


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("project = ..\n", "parameters.txt: found no parameter"),
        (f"{INSULATION} = 0.03\n", "parameters.txt: found no study; add a line 'project = FOLDER'"),
        (f"project = ../..\n{INSULATION} = 0.03\n", "coupling.json: cannot be read"),
        (f"project = ..\n{INSULATION} 0.03\n", "parameters.txt:2: found '.*', expected 'path = value'"),
        (f"project = ..\n{INSULATION} = much\n", "parameters.txt:2: .*found 'much', expected a number"),
        (f"project = ..\n{INSULATION} = NaN\n", "parameters.txt:2: .*found 'NaN', expected a number"),
        (f"project = ..\n{INSULATION} = %x%\n", "parameters.txt:2: .*should have replaced"),
        (f"{INSULATION} = 1\n{INSULATION} = 1\n", "parameters.txt:2: '.*' occurs a second time"),
        ("project = ..\nmaterials.insulation.conductivty = 1\n", "Did you mean 'materials.insulation.cond"),
        (f"project = ..\n{INSULATION} = -1\n", "parameters.txt: .*found -1, expected .* narrow Min and Max"),
    ],
)
def test_errors_of_an_evaluation_are_in_its_log(
    run_folder: Path, text: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (run_folder / "result.txt").write_text("cost= 1\n", encoding="utf-8")
    ask(run_folder, text)
    assert cli.main(["cost"]) == 2
    log = (run_folder / "log.txt").read_text(encoding="utf-8")
    error = capsys.readouterr().err.removeprefix("error: ").strip()
    assert f"MASCARIN ERROR: {error}" in log
    with pytest.raises(AssertionError, match=said):
        raise AssertionError(" ".join(error.split()))
    assert not (run_folder / "result.txt").exists()


def test_a_building_that_cannot_be_simulated(run_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(case: Case, x: np.ndarray) -> np.ndarray:
        case._reasons[:] = ["step 3 did not converge"]
        return np.full((len(x), len(case.instants), 2), np.nan)

    monkeypatch.setattr(Case, "_model", failing)
    ask(run_folder, f"project = ..\n{INSULATION} = 0.03\n")
    assert cli.main(["cost"]) == SolverError.exit_code
    log = (run_folder / "log.txt").read_text(encoding="utf-8")
    assert f"MASCARIN ERROR: step 3 did not converge Parameters: {INSULATION}=0.03" in log


def test_an_unexpected_error_is_in_the_log(run_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("broken on purpose")

    monkeypatch.setattr(Case, "evaluate", broken)
    ask(run_folder, f"project = ..\n{INSULATION} = 0.03\n")
    assert cli.main(["cost"]) == cli.EXIT_DEFECT
    log = (run_folder / "log.txt").read_text(encoding="utf-8")
    assert "MASCARIN ERROR: RuntimeError: broken on purpose" in log


def test_cost_does_not_write_over_what_it_reads(run_folder: Path) -> None:
    ask(run_folder, f"project = ..\n{INSULATION} = 0.03\n")
    assert cli.main(["cost", "-o", "parameters.txt"]) == 2
    assert "0.03" in (run_folder / "parameters.txt").read_text(encoding="utf-8")


# --- what cannot be used --------------------------------------------------------------------------------


def test_a_folder_that_is_not_empty_is_an_error(
    bench: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    words = ["genopt", str(bench / "study.yaml"), "-o", str(tmp_path), "--program", PROGRAM]
    assert cli.main(words) == 2
    error = capsys.readouterr().err
    assert "the folder is not empty (it has mine.txt)" in error
    assert "--force" in error
    assert cli.main([*words, "--force"]) == 0
    assert (tmp_path / "mine.txt").read_text(encoding="utf-8") == "mine"
    assert capsys.readouterr().out.strip() == str(tmp_path / "opt.ini")
    assert cli.main([*words[:3], str(tmp_path / "mine.txt")]) == 2
    assert "is a file; expected a folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--algorithm", "hook-jeeves"], "Did you mean 'hooke-jeeves' or 'GPSHookeJeeves'?"),
        (["--algorithm", "Fibonacci"], "searches along one parameter"),
        (["--starts", "0"], "--starts: found 0, expected 1 or more"),
        (["--seed", "99999999999"], "expected a whole number of 32 bits"),
        (["--program", "/my programs/mascarin"], "with blanks, quotes or backslashes"),
    ],
)
def test_errors_of_export_options(
    bench: Path, tmp_path: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "project"
    assert cli.main(["genopt", str(bench / "study.yaml"), "-o", str(out), *words]) == 2
    assert said in capsys.readouterr().err
    assert not out.exists()


def test_a_program_that_is_not_on_the_path(
    bench: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mascarin.genopt.export.writing.shutil.which", lambda *_, **__: None)
    with pytest.raises(InputError, match=r"'mascarin' is not on the path.*give its full path with --program"):
        write_project(str(bench / "study.yaml"), tmp_path / "project")


def test_a_study_without_identification(
    copy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (copy / "study.yaml").read_text(encoding="utf-8")
    (copy / "study.yaml").write_text(text[: text.index("identification:\n")], encoding="utf-8")
    assert cli.main(["genopt", str(copy / "study.yaml"), "-o", str(tmp_path / "project")]) == 2
    error = capsys.readouterr().err
    assert "study.yaml" in error
    assert "identification" in error


def test_names_that_genopt_cannot_take(copy: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"study.yaml: identification.parameters.*dämmung.*Rename"):
        variable(FitParameter("materials.dämmung.conductivity", 0.02, 0.06), Path("study.yaml"))
    with pytest.raises(InputError, match=r"range 20.0 .. 20.0001, too narrow.*widen"):
        variable(FitParameter("a.b", 20.0, 20.0001), Path("study.yaml"))
    edit(copy / "study.yaml", "  joint: {", "  größe: {")
    with pytest.raises(InputError, match=r"sensors.größe: found a name that GenOpt cannot take.*Rename"):
        write_project(str(copy / "study.yaml"), tmp_path / "project", SHORT)


def test_a_project_without_its_study(copy: Path, tmp_path: Path) -> None:
    ini = write_project(str(copy / "study.yaml"), tmp_path / "project", SHORT)
    (copy / "study.yaml").unlink()
    with pytest.raises(InputError, match=r"coupling.json: study: found '.*study.yaml', but there is no such"):
        search(ini)
    (ini.parent / "coupling.json").write_text("{}", encoding="utf-8")
    with pytest.raises(InputError, match="was not written by 'mascarin genopt'"):
        search(ini)


def test_a_project_with_other_costs_needs_the_program(bench: Path, tmp_path: Path) -> None:
    ini = write_project(str(bench / "study.yaml"), tmp_path / "project", SHORT)
    edit(ini, 'Name1 = "cost"', 'Name1 = "mine"')
    with pytest.raises(InputError, match=r"has costs \(mine.*run it with 'mascarin optimize'"):
        search(ini)
