"""Studies of several data sets: experiments that are identified together, and others that are validated."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml

from experiments_support import AIR, CONDUCTIVITY, STUDY, TALL, TRUTH, cells, experiment, written
from mascarin.calibration import Cost
from mascarin.cli import main
from mascarin.errors import InputError
from mascarin.genopt.export.compiling import compile_study
from mascarin.study import Study
from mascarin.study.file.schema import study_schema
from mascarin.study.results.results import StudyResults

BOTH = {"wide": experiment("wide"), "tall": experiment("tall")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Both cells with their tables."""
    place = tmp_path_factory.mktemp("cells")
    cells(place)
    return place


def results_of(folder: Path, experiments: dict[str, Any], out: Path, **changes: Any) -> StudyResults:
    return Study.from_yaml(written(folder, experiments, **changes)).run(out, figures=False, page="none")


@pytest.fixture(scope="module")
def joint(folder: Path) -> StudyResults:
    """Both cells identified together."""
    return results_of(folder, BOTH, folder / "joint")


@pytest.fixture(scope="module")
def alone(folder: Path) -> dict[str, StudyResults]:
    """Each cell by itself."""
    return {name: results_of(folder, {name: entry}, folder / name) for name, entry in BOTH.items()}


def test_two_cells_tell_what_no_single_one_tells(joint: StudyResults, alone: dict[str, StudyResults]) -> None:
    fit = joint.calibration
    assert fit.problem.paths == (CONDUCTIVITY, AIR)
    for k, path in enumerate(fit.problem.paths):
        assert fit.low[k] < TRUTH[path] < fit.high[k]
        for single in alone.values():
            own = single.calibration
            assert fit.high[k] - fit.low[k] < 0.7 * (own.high[k] - own.low[k])
    for single in alone.values():
        # Heat through the walls and with the air: what one of them loses more, the other one loses less.
        assert single.calibration.correlation[0, 1] < -0.7
    assert abs(fit.correlation[0, 1]) < 0.5
    assert joint.contradictions == []


def test_the_log_likelihood_is_the_sum_of_those_of_the_experiments(folder: Path) -> None:
    both = Study.from_yaml(written(folder, BOTH)).context
    problem, x = both.problem(), np.array([[0.035, 0.7], [0.03, 0.9]])
    own = [Study.from_yaml(written(folder, {name: entry})).context.problem() for name, entry in BOTH.items()]
    together = Cost(problem, "nll").of_sensors(problem.residuals(x))
    each = [Cost(alone, "nll").of_sensors(alone.residuals(x))[:, 0] for alone in own]
    # Sums over more samples have another order.
    np.testing.assert_allclose(together, np.column_stack(each), rtol=1e-13)
    assert [sensor.name for sensor in problem.sensors] == ["wide room", "tall room"]


def test_exact_slopes_are_those_of_each_experiment(folder: Path) -> None:
    problem = Study.from_yaml(written(folder, BOTH)).context.problem()
    x, step = np.array([0.035, 0.7]), np.array([1e-5, 1e-3])
    exact = problem.jacobian(x)
    moved = problem.residuals(np.array([x + np.eye(2)[k] * step for k in range(2)]))
    back = problem.residuals(np.array([x - np.eye(2)[k] * step for k in range(2)]))
    difference = np.moveaxis((moved - back) / (2.0 * step[:, None, None]), 0, -1)
    assert np.abs(exact - difference).max() < 2e-4 * np.abs(exact).max()


def test_one_experiment_gives_the_numbers_of_an_ordinary_study(
    folder: Path, alone: dict[str, StudyResults]
) -> None:
    plain = yaml.safe_load(STUDY)
    plain["building"] = "wide.yaml"
    plain["climate"]["measured"]["table"] = plain["measurements"]["table"] = "wide.csv"
    (folder / "ordinary.yaml").write_text(yaml.safe_dump(plain), encoding="utf-8")
    ordinary = Study.from_yaml(folder / "ordinary.yaml").run(folder / "ordinary", figures=False, page="none")
    for name in ("x", "low", "high", "residuals"):
        np.testing.assert_array_equal(
            getattr(ordinary.calibration, name), getattr(alone["wide"].calibration, name)
        )
    before, after = (
        json.loads((folder / out / "study.json").read_text(encoding="utf-8")) for out in ("ordinary", "wide")
    )
    for key in ("sensors", "parameters", "correlation", "band", "diagnosis", "days", "errors"):
        assert before.get(key) == after.get(key), key
    assert list(after["transfer"]) == ["wide"]


def test_results_are_shown_by_experiment(folder: Path, joint: StudyResults) -> None:
    assert list(joint.transfer) == ["wide", "tall"]
    for entry in joint.transfer.values():
        assert entry.role == "identification"
        assert entry.sound
        for scores in entry.sensors["room"].values():
            before, after = scores.described.rmse, scores.calibrated.rmse
            assert after is not None
            assert before is not None
            assert after < 0.1 * before
            assert scores.held is not None
            assert scores.held > 0.85
    costs = [entry.cost for entry in joint.transfer.values()]
    assert sum(cost for cost in costs if cost is not None) == pytest.approx(joint.calibration.cost)
    report = (folder / "joint" / "report.html").read_text(encoding="utf-8")
    assert "Experiments" in report
    assert "Tall cell" in report


def test_without_errors_of_sensors_the_posterior_is_joint_too(folder: Path, tmp_path: Path) -> None:
    scatter = {"room": {"column": "room", "output": "room.air_temperature", "offset": 0, "uncertainty": 0.1}}
    results = results_of(folder, BOTH, tmp_path / "out", sensors=scatter)
    fit = results.calibration
    assert results.combination is None
    assert np.all((fit.low < list(TRUTH.values())) & (list(TRUTH.values()) < fit.high))
    assert np.all(fit.high - fit.low < 0.1 * np.array(list(TRUTH.values())))
    assert list(results.transfer) == ["wide", "tall"]
    assert all((scores.held or 0.0) > 0.85 for scores in results.transfer["tall"].sensors["room"].values())


def test_a_study_continues_from_what_its_steps_have_computed(
    folder: Path, joint: StudyResults, tmp_path: Path
) -> None:
    path = written(folder, BOTH)
    for _ in range(2):
        main(["calibrate", str(path), "-o", str(tmp_path / "out")])
        results = Study.from_yaml(path).run(tmp_path / "out", figures=False, page="none")
        np.testing.assert_array_equal(results.calibration.x, joint.calibration.x)
        assert results.transfer == joint.transfer


def test_an_experiment_of_the_role_validation_is_predicted(
    folder: Path, alone: dict[str, StudyResults]
) -> None:
    held = {"wide": BOTH["wide"], "tall": experiment("tall", role="validation")}
    results = results_of(folder, held, folder / "held")
    np.testing.assert_array_equal(results.calibration.x, alone["wide"].calibration.x)
    entry = results.transfer["tall"]
    assert entry.role == "validation"
    scores = entry.sensors["room"]["identification"]
    assert (scores.calibrated.rmse or 9.0) < 0.3 * (scores.described.rmse or 0.0)
    assert (scores.held or 0.0) > 0.9


def test_a_parameter_may_have_a_value_in_every_experiment(tmp_path: Path) -> None:
    truth = {"wide": TRUTH, "tall": {**TRUTH, AIR: 0.4}}
    cells(tmp_path, truth)
    parameters = {CONDUCTIVITY: {"prior": 0.002}, AIR: {"per_experiment": True}}
    described = {"set": {CONDUCTIVITY: 0.0335}}
    results = results_of(
        tmp_path,
        {name: {**entry, **described} for name, entry in BOTH.items()},
        tmp_path / "out",
        identification={"starts": 1, "lead": "1d", "parameters": parameters},
    )
    fit = results.calibration
    assert fit.problem.paths == (CONDUCTIVITY, AIR)
    assert fit.low[1] < 0.8 < fit.high[1]
    (words,) = [word for word in results.transfer["tall"].words if word.startswith(AIR)]
    estimate = float(words.split(" is ")[1].split(" ")[0])
    low, high = (float(end) for end in words.split("[")[1].split("]")[0].split(", "))
    assert low < 0.4 < high
    assert abs(estimate - 0.4) < 0.15


def test_parameters_of_one_building_alone_are_identified(folder: Path, tmp_path: Path) -> None:
    """A cell with boards of another name: its own parameter beside the shared ones."""
    cells(tmp_path)
    other = {**TALL, "zones": {"room": {"volume": 160, "gains": {"heater": {"radiative": 0.0}}}}}
    other["materials"] = {"lining": {"conductivity": {"value": 0.25, "range": [0.1, 0.5]}, "density": 900,
                                     "specific_heat": 1000}}  # fmt: skip
    other["constructions"] = {"shell": {"layers": [{"material": "insulation", "thickness": 0.08},
                                                   {"material": "lining", "thickness": 0.02}]}}  # fmt: skip
    (tmp_path / "tall.yaml").write_text(yaml.safe_dump(other), encoding="utf-8")
    lining = "materials.lining.conductivity"
    identification = {"parameters": {CONDUCTIVITY: None, lining: {"prior": 0.05}}}
    context = Study.from_yaml(written(tmp_path, BOTH, identification=identification)).context
    assert context.problem().paths == (CONDUCTIVITY, lining)
    assert list(context.inputs.calibration_plan.parameters) == [CONDUCTIVITY]


ITSELF = ["sum", "room.air_temperature"]
REFUSED: tuple[tuple[dict[str, Any], dict[str, Any], str], ...] = (
    ({"wide": experiment("wide", role="validation")}, {}, r"experiments: found role: validation in all"),
    ({}, {}, "experiments: found no experiment, expected at least one of role identification"),
    ({"wide": {"building": "wide.yaml"}}, {}, r"experiments\.wide\.role\s+found: nothing"),
    ({"wide": experiment("wide", roles="x")}, {}, r"experiments\.wide\.roles\s+found: the key 'roles'"),
    (
        {"wide": BOTH["wide"], "again": BOTH["wide"]}, {},
        r"experiments\.again: found 2023-03-02 .* of the table that 'wide' compares .*\(column room\)",
    ),
    (
        {"wide": BOTH["wide"], "again": experiment("wide", role="validation")}, {},
        r"experiments\.again: found 2023-03-02 .* of the table that 'wide' compares",
    ),
    (BOTH, {"transfer": {"x": {"study": "x.yaml"}}}, "transfer: found transfer beside experiments"),
    (BOTH, {"building": "wide.yaml"}, r"building: found wide\.yaml, which no experiment uses"),
    (
        BOTH, {"measurements": {"table": "old.csv", "timezone": "UTC+1"}},
        r"measurements\.table: found old\.csv, which no experiment uses",
    ),
    (
        BOTH, {"identification": {"parameters": {"materials.insulatoin.conductivity": None}}},
        r"no building of the experiments that are identified \('wide', 'tall'\) has it.*Did you mean",
    ),
    (
        {**BOTH, "tall": experiment("tall", set={CONDUCTIVITY: 0.05})}, {},
        r"conductivity: found the value 0\.04 in 'wide' and 0\.05 in 'tall', expected the same",
    ),
    (
        BOTH, {"identification": {"posterior": "sampled", "parameters": {AIR: None}}},
        r"identification\.posterior: found sampled with several experiments",
    ),
    (
        BOTH, {"variants": {"loose": {"changes": {AIR: 0.9}}}},
        "variants: found variants beside 2 experiments that are identified",
    ),
    (
        {**BOTH, "tall": experiment("tall", sensors={"room": {"column": "rom"}})}, {},
        r"experiments\.tall: sensors\.room\.column: .*no column 'rom'",
    ),
    (
        {**BOTH, "tall": experiment("tall", sensors={"sum": {"column": "room", "sum": ITSELF}})}, {},
        r"experiments\.tall: sensors\.sum\.sum: found 'sum', the sensor itself",
    ),
)  # fmt: skip


@pytest.mark.parametrize(("experiments", "changes", "text"), REFUSED)
def test_what_contradicts_itself_is_refused(
    folder: Path, experiments: dict[str, Any], changes: dict[str, Any], text: str
) -> None:
    with pytest.raises(InputError, match=f"(?s)study.yaml.*{text}"):
        Study.from_yaml(written(folder, experiments, **changes))


def test_a_name_twice_is_refused(folder: Path) -> None:
    path = written(folder, BOTH)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("\n  tall:\n", "\n  wide:\n"), encoding="utf-8")
    with pytest.raises(InputError, match=r"experiments\.wide\s+found: the key 'wide' again"):
        Study.from_yaml(path)


def test_other_columns_of_one_table_are_other_data(folder: Path) -> None:
    """One table may have the columns of both houses."""
    import pandas as pd

    wide, tall = (pd.read_csv(folder / f"{name}.csv", index_col=0) for name in ("wide", "tall"))
    wide.join(tall.add_prefix("tall_")).to_csv(folder / "both.csv")
    table = {"climate": {"measured": {"table": "both.csv"}}, "measurements": {"table": "both.csv"}}
    own = {"table": "both.csv", "columns": {"*": "tall_*"}}
    experiments = {
        "wide": {**BOTH["wide"], **table},
        "tall": {**BOTH["tall"], **table, "measurements": own},
    }
    inputs = Study.from_yaml(written(folder, experiments)).context.inputs
    assert inputs.hashes["measurements"] != ""
    assert inputs.together["tall"].measured_columns == {"tall_room"}


def test_the_schema_knows_what_experiments_may_leave_out(folder: Path) -> None:
    schema = jsonschema.Draft202012Validator(study_schema())
    plain = yaml.safe_load(written(folder, BOTH).read_text(encoding="utf-8"))
    assert list(schema.iter_errors(plain)) == []
    del plain["experiments"]
    assert list(schema.iter_errors(plain)) != []


def test_a_study_that_extends_one_may_have_a_single_data_set(folder: Path) -> None:
    written(folder, BOTH)
    own = {key: value for key, value in experiment("tall").items() if key != "role"}
    path = folder / "single.yaml"
    path.write_text(yaml.safe_dump({"extends": "study.yaml", "experiments": None, **own}), encoding="utf-8")
    study = Study.from_yaml(path)
    assert study.building.name == "Tall cell"
    assert study.context.inputs.others == {}


def test_entrances_that_know_one_data_set_say_so(folder: Path, tmp_path: Path) -> None:
    study = Study.from_yaml(written(folder, BOTH))
    assert "experiments     wide, tall" in repr(study)
    with pytest.raises(InputError, match=r"experiments: found several data sets.*GenOpt"):
        compile_study(study)
    with pytest.raises(InputError, match="experiments: found several data sets"):
        study.to_yaml()
    with pytest.raises(InputError, match="experiments: found several data sets"):
        study.with_measurements(study.measurements)
    with pytest.raises(InputError, match="found experiments in a study of objects"):
        Study(
            building=study.building,
            climate=study.climate,
            measurements=study.measurements,
            sensors={"room": {"column": "room", "output": "room.air_temperature"}},
            periods={"identification": ("2023-03-02", "2023-03-06")},
            experiments={"tall": study},
        )


def test_validate_and_calibrate_show_all_experiments(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(folder, {**BOTH, "tall": experiment("tall", role="validation")})
    assert main(["validate", str(path), "-o", str(tmp_path / "validated")]) == 0
    printed = capsys.readouterr().out
    assert "experiment" in printed
    assert "tall" in printed
    content = json.loads((tmp_path / "validated" / "validation.json").read_text(encoding="utf-8"))
    assert {name: entry["role"] for name, entry in content["transfer"].items()} == {
        "wide": "identification",
        "tall": "validation",
    }
    assert main(["calibrate", str(written(folder, BOTH)), "-o", str(tmp_path / "calibrated")]) == 0
    content = json.loads((tmp_path / "calibrated" / "calibration.json").read_text(encoding="utf-8"))
    assert list(content["transfer"]) == ["wide", "tall"]
    assert content["parameters"][AIR]["fitted"] == pytest.approx(0.8, abs=0.1)
