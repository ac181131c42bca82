"""Recorded runs of GenOpt 3.1.1, row by row."""

from __future__ import annotations

import csv
import re
import shutil
from pathlib import Path

import pytest
from conftest import DATA, unavailable

from genopt_support import body, in_process
from mascarin.errors import MascarinError
from mascarin.genopt import optimize

REAL = ["quad2_hj", "err_hj_logerror", "disc_parametric"]
CASES = """
    disc_gpspsocchj disc_mesh disc_parametric disc_psocc disc_psoccmesh disc_psoiw err_delimiter_missing
    err_exitcode err_first_simulation err_hj_discrete err_hj_logerror err_ini_infeasible err_ms_unbounded
    err_unknown_keyword err_unused_variable failpart_mesh_nostop penalty2_hj_step plateau2_cs
    plateau2_gpspsocchj plateau2_hj plateau2_hj_ms1 plateau2_hj_ms2 plateau2_hj_ms3 plateau2_nm
    plateau2_psocc plateau2_psoccmesh plateau2_psoiw quad1_fibonacci_red quad1_goldensection_abs
    quad1_goldensection_red
    quad2_cs quad2_cs_ms1 quad2_dag quad2_gpspsocchj quad2_hj quad2_hj_div3 quad2_hj_exp2_ms5
    quad2_hj_float quad2_hj_maxite quad2_hj_ms1 quad2_hj_ms1_maxite quad2_hj_ms2 quad2_hj_ms7
    quad2_hj_unbounded quad2_hj_zeta_phi quad2_hj_zeta_phi_alpha quad2_mesh
    quad2_mesh_par2 quad2_nm quad2_nm_nomod
    quad2_parametric quad2_psocc quad2_psoccmesh quad2_psoiw rosen2_cs rosen2_gpspsocchj rosen2_hj
    rosen2_hj_ms1 rosen2_hj_ms2 rosen2_nm rosen2_psocc rosen2_psoccmesh rosen2_psoiw twocost_hj_functions
""".split()  # noqa: SIM905

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:E-?\d+)?")


@pytest.fixture(scope="session")
def genopt_traces(data_dir: Path) -> Path:
    """Folder of the recordings, beside the data folder."""
    folder = data_dir.parent / "genopt" / "traces"
    if not folder.is_dir():
        unavailable(f"no recordings of GenOpt at {folder}", DATA)
    return folder


def alike(got: str, wanted: str) -> bool:
    """Texts equal but for the last digits of numbers with a fraction."""
    if got == wanted:
        return True
    if _NUMBER.sub("#", got) != _NUMBER.sub("#", wanted):
        return False
    pairs = zip(_NUMBER.findall(got), _NUMBER.findall(wanted), strict=True)
    return all(
        a == b or ("." in b and abs(float(a) - float(b)) <= 1e-9 * max(abs(float(a)), abs(float(b))))
        for a, b in pairs
    )


def replay(traces: Path, name: str, folder: Path) -> None:
    """Run one case and compare its listings with the recording."""
    with (traces / "INDEX.tsv").open(encoding="utf-8", newline="") as file:
        exits = {row["case"]: int(row["exit"]) for row in csv.DictReader(file, delimiter="\t")}
    project = folder / name
    shutil.copytree(traces / name, project)
    code, said = 0, ""
    try:
        optimize(project / "opt.ini")
    except MascarinError as error:
        code, said = 1, str(error)
    # The two cases that the index does not list ended normally.
    assert code == exits.get(name, 0), said
    for which in ("Main", "All"):
        got = body(project / f"OutputListing{which}.txt")
        wanted = body(project / f"OutputListing{which}.tsv")
        for number, (a, b) in enumerate(zip(got, wanted, strict=False)):
            assert alike(a, b), f"{which}, row {number}:\n{a}\n{b}"
        assert len(got) == len(wanted)


@pytest.mark.parametrize("name", CASES)
def test_listings_equal_the_recording(
    name: str, genopt_traces: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_process(monkeypatch)
    replay(genopt_traces, name, tmp_path)


@pytest.mark.parametrize("name", REAL)
def test_listings_of_real_runs_equal_the_recording(name: str, genopt_traces: Path, tmp_path: Path) -> None:
    replay(genopt_traces, name, tmp_path)


def test_every_recording_is_replayed(genopt_traces: Path) -> None:
    found = sorted(path.name for path in genopt_traces.iterdir() if path.is_dir())
    assert found == sorted(CASES)


def test_changed_counters_and_comments_are_found() -> None:
    assert alike("1\t2.0000000000001\tx", "1\t2.0\tx")
    assert not alike("1\t2.00001\tx", "1\t2.0\tx")
    assert not alike("2\t2.0\tx", "1\t2.0\tx")
    assert not alike("1\t2.0\ty", "1\t2.0\tx")
