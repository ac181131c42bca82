from __future__ import annotations

from pathlib import Path

import pytest

from genopt_support import HOOKE_JEEVES, SWARM, TWO_CONTINUOUS, write_project
from mascarin.errors import InputError
from mascarin.genopt import load
from mascarin.genopt.algorithms.algorithm import build
from mascarin.genopt.listing import Listings


def refused(ini: Path) -> str:
    """Message for a project that cannot be used, with its algorithm."""
    with pytest.raises(InputError) as caught:
        built(ini)
    return str(caught.value)


def built(ini: Path, *, lenient: bool = False) -> list[str]:
    """Notes on a project that can be used."""
    project = load(ini, lenient=lenient)
    build(project, Listings(project), 1)
    return project.report.notes


def test_a_project_is_read(tmp_path: Path) -> None:
    project = load(write_project(tmp_path))
    assert project.names == ["x1", "x2"]
    assert project.continuous[0].lower == -1.0
    assert project.errors == ["Fatal"]
    assert project.settings.max_iterations == 500
    assert project.input[0].path == tmp_path / "in.txt"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"settings": "MaxIte = 0; WriteStepNumber = false;"},
            "command.txt:5: 'MaxIte' is 0; expected at least 1",
        ),
        (
            {"settings": "MaxIte = 9; WriteStepNumber = yes;"},
            "'WriteStepNumber' is 'yes'; expected true or false",
        ),
        ({"vary": "Parameter { Name = x1; Ini = 1; }"}, "missing specification of 'Step' of 'x1'"),
        ({"vary": TWO_CONTINUOUS + TWO_CONTINUOUS}, "the name 'x1' is used twice"),
        ({"vary": 'Parameter { Name = n; Ini = 4; Values = "a,b"; }'}, "there are 2 values"),
        ({"vary": "Parameter { Name = n; Ini = x; Step = 1; }"}, "'Ini' is 'x'; expected a number"),
        (
            {"vary": "Parameter { Name = n; Ini = 1; Step = 1; Type = REAL; }"},
            "Type is 'REAL'; expected CONTINUOUS or SET",
        ),
        (
            {"vary": 'Parameter { Name = n; Ini = 1; Values = "1,2"; Type = CONTINUOUS; }'},
            "'n' is continuous; 'Values' belongs to Type = SET",
        ),
        (
            {"vary": "Parameter { Name = n; Ini = 1; Step = 1; Min = 3; Max = 2; }"},
            "'n': Min 3.0 is above Max 2.0; exchange them",
        ),
        (
            {"vary": 'Parameter { Name = n; Ini = 1; Min = 2; Values = "1,2"; }'},
            "'n' has 'Values'; remove 'Min'",
        ),
        (
            {"vary": "Parameter { Name = n; Ini = 1; Min = 1; Max = 2; Type = SET; }"},
            "'n' of Type SET needs 'Values', or 'Min', 'Max' and 'Step'",
        ),
        (
            {"vary": "Parameter { Name = n; Ini = 1; Min = 0; Max = 9; Step = -3; Type = SET; }"},
            "'n': logarithmic spacing needs Min and Max above zero",
        ),
        ({"vary": "Parameter { Name = stepNumber; Ini = 1; Step = 1; }"}, "'stepNumber' is reserved"),
        (
            {"vary": "Parameters { Name = n; }"},
            "unknown or unexpected section 'Parameters'. Did you mean 'Parameter'",
        ),
        ({"vary": ""}, "no Parameter is given"),
        ({"io_format": "Single"}, "NumberFormat is 'Single'; expected Double or Float"),
        ({"objectives": "Name1 = a;"}, "'Name1' needs either 'Delimiter1' or 'Function1'"),
        ({"objectives": "Name2 = a; Delimiter2 = x;"}, "comes before number 1"),
        ({"objectives": 'Name1 = a; Function1 = "add(%b%, 1)";'}, "'%b%' in a function is not a parameter"),
        (
            {"algorithm": "Main = GPSHookJeeves;"},
            "'GPSHookJeeves' is not known. Did you mean 'GPSHookeJeeves'",
        ),
        ({"algorithm": HOOKE_JEEVES.replace("= 2", "= 1")}, "'MeshSizeDivider' is 1; expected at least 2"),
        (
            {"algorithm": f"Main = PSOCC; {SWARM.replace('lbest', 'vonNewmann')}"},
            "Did you mean 'vonNeumann'?",
        ),
        (
            {"files": "Input { File1 = ../in.txt; } Log { File1 = log.txt; } Output { File1 = out.txt; }"},
            "is outside the directory of the initialization file",
        ),
        (
            {"files": "Input { File1 = a.txt; File2 = b.txt; } Log { File1 = l; } Output { File1 = o; }"},
            "2 input files for 1 templates",
        ),
        (
            {"files": "Input { File1 = a; } Output { File1 = o; } Log { File1 = l; }"},
            "'Log' comes after 'Output'",
        ),
    ],
)
def test_errors_of_projects(tmp_path: Path, change: dict[str, str], message: str) -> None:
    said = refused(write_project(tmp_path, **change))
    assert message in said
    assert str(tmp_path) in said.splitlines()[0]


def test_what_genopt_cannot_run_is_an_error_or_a_note_when_lenient(tmp_path: Path) -> None:
    algorithm = """
    Main = NelderMeadONeill;
    StepSizeFactor = 0.1;
    Accuracy = 1e-3;
    BlockRestartCheck = 5;
    ModifyStoppingCriterion = true;
    """
    ini = write_project(tmp_path, algorithm=algorithm)
    said = refused(ini)
    assert "command.txt:9: 'Accuracy' comes after 'StepSizeFactor'" in said
    assert "command.txt:9: '1e-3' is read as a number with a unit" in said
    assert "write 0.001" in said
    notes = "\n".join(built(ini, lenient=True))
    assert notes.count("accepted beyond GenOpt") == 2


def test_a_fraction_for_a_whole_number_is_cut_and_noted(tmp_path: Path) -> None:
    ini = write_project(tmp_path, algorithm=HOOKE_JEEVES.replace("Divider = 2", "Divider = 4.7"))
    assert any("'MeshSizeDivider = 4.7' is cut to 4" in n for n in built(ini))


def test_references_between_entries(tmp_path: Path) -> None:
    ini = write_project(
        tmp_path,
        ini_extra="CallParameter { Prefix = a; Suffix = Simulation.CallParameter.Prefix; }",
    )
    assert load(ini).suffix == "a"
    bad = write_project(
        tmp_path,
        ini_extra="CallParameter { Prefix = Simulation.CallParameter.Suffix; "
        "Suffix = Simulation.CallParameter.Prefix; }",
    )
    assert "refers to itself in a circle" in refused(bad)


def test_discrete_values_are_spaced_and_kept(tmp_path: Path) -> None:
    vary = """
    Parameter { Name = n; Ini = 1; Type = SET; Min = 1; Max = 8; Step = 7; }
    Parameter { Name = l; Ini = 1; Type = set; Min = 0.1; Max = 10; Step = -4; }
    Parameter { Name = w; Ini = 2; Values = "a, b"; }
    """
    n, logarithmic, w = load(write_project(tmp_path, vary=vary)).discrete
    assert n.values == tuple(f"{k}.0" for k in range(1, 9))
    assert logarithmic.values == ("0.1", "0.31622776", "1.0", "3.1622777", "10.0")
    assert w.values == ("a", " b")


def test_the_swarm_and_its_starts_have_separate_seeds(tmp_path: Path) -> None:
    algorithm = f"""Main = GPSPSOCCHJ; {SWARM} MeshSizeDivider = 2; InitialMeshSizeExponent = 0;
    MultiStart = Uniform; Seed = 7; NumberOfInitialPoint = 2;
    MeshSizeExponentIncrement = 1; NumberOfStepReduction = 1;"""
    assert built(write_project(tmp_path, algorithm=algorithm)) == []


@pytest.mark.parametrize(
    ("entries", "values"),
    [
        ("Min = 1; Max = 4; Step = 3;", [1.0, 2.0, 3.0, 4.0]),
        ("Min = 1; Max = 100; Step = -2;", [1.0, 10.0, 100.0]),
        ("Min = 5; Max = 9; Step = 0;", [5.0]),
    ],
)
def test_values_of_a_discrete_parameter_are_spaced_evenly_or_by_equal_ratios(
    tmp_path: Path, entries: str, values: list[float]
) -> None:
    vary = f"Parameter {{ Name = x1; Ini = 1; {entries} Type = SET; }}"
    project = load(write_project(tmp_path, vary=vary + "Parameter { Name = x2; Ini = 1; Step = 1; }"))
    assert [float(text) for text in project.discrete[0].values] == pytest.approx(values, rel=1e-6)
