"""The peers of the benches say what they should; none of them is run against a clock here."""

from __future__ import annotations

import ast
import importlib.util
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions, solve
from mascarin.simulation.simulation import Simulation


@pytest.fixture
def bench(repository: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The benches as modules, which do not stay: bench/coverage.py has the name of another package."""
    folder = repository / "bench"
    monkeypatch.syspath_prepend(str(folder))
    yield
    for name, module in list(sys.modules.items()):
        if Path(getattr(module, "__file__", None) or "-").parent == folder:
            del sys.modules[name]


#: Attributes of the package and of numpy and pandas, which the benches use.
PACKAGES = ("mascarin", "mc", "np", "pd")


def _attributes(tree: ast.AST) -> Iterator[tuple[str, ...]]:
    """Names with dots that begin with a package: `mc.Climate.from_epw` as its parts."""
    for node in ast.walk(tree):
        parts: list[str] = []
        while isinstance(node, ast.Attribute):
            parts.insert(0, node.attr)
            node = node.value
        if parts and isinstance(node, ast.Name) and node.id in PACKAGES:
            yield (node.id, *parts)


@pytest.mark.usefixtures("bench")
def test_benches_use_names_that_exist(repository: Path) -> None:
    """Each script is imported, imports inside its functions as well, and names of packages are looked up."""
    missing = []
    for file in sorted((repository / "bench").glob("*.py")):
        module = importlib.import_module(file.stem)
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mascarin"):
                source = importlib.import_module(str(node.module))
                missing += [
                    f"{file.name}: {node.module}.{alias.name}"
                    for alias in node.names
                    if not (hasattr(source, alias.name) or _is_module(f"{node.module}.{alias.name}"))
                ]
        for first, *parts in _attributes(tree):
            value = getattr(module, first, None)
            for part in parts if value is not None else ():
                if not hasattr(value, part):
                    missing.append(f"{file.name}: {first}.{'.'.join(parts)}")
                    break
                value = getattr(value, part)
    assert not missing, missing


def _is_module(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False


@pytest.mark.usefixtures("bench")
def test_the_program_written_by_hand_agrees_with_the_engine() -> None:
    """The same cell from the same temperature: sheet and gap within what its radiation by quarters allows."""
    import cell  # type: ignore[import-not-found]
    import naive  # type: ignore[import-not-found]

    building, weather = cell.building(), cell.table()
    peer = naive.NaiveCell(building, weather.tz_localize("Etc/GMT-4"))
    states = peer.run(24.0, np.arange(0.0, 86401.0, 900.0))
    names = list(cell.OUTPUTS.values())
    ours = Simulation(
        building,
        cell.climate(weather),
        step=60.0,
        start=cell.START,
        end="2010-08-02",
        outputs=names,
        initial=24.0,
    ).run()
    records = ours.records[::15]
    apart = {
        name: float(np.sqrt(np.mean((peer.read(states, name) - records[:, k]) ** 2)))
        for k, name in enumerate(names)
    }
    assert np.ptp(records[:, names.index("roof.inside_temperature")]) > 15.0
    assert all(apart[name] < 0.01 for name in names[:3]), apart
    assert all(apart[name] < 0.1 for name in names[3:]), apart


@pytest.mark.usefixtures("bench")
def test_energyplus_gets_the_same_cell() -> None:
    import cell

    import energyplus  # type: ignore[import-not-found]

    building = cell.building()
    scheme = energyplus.Scheme(20, ("ceiling",))
    model: dict[str, Any] = energyplus.write_model(
        building, scheme, "2010-08-01", "2010-11-01", ["room.air_temperature"]
    )
    period = model["RunPeriod"]["period"]
    assert (period["end_month"], period["end_day_of_month"]) == (10, 31)
    assert (
        len(model["BuildingSurface:Detailed"]) == len(building.surfaces) + 1 - 2
    )  # twice the ceiling, no doors
    assert set(model["FenestrationSurface:Detailed"]) == {"door", "jalousie"}
    assert model["Construction"]["ceiling"] == {
        "outside_layer": "ceiling energain",
        "layer_2": "ceiling plasterboard",
    }
    assert model["Construction"]["ceiling reversed"]["outside_layer"] == "ceiling plasterboard"
    assert model["Material"]["ceiling energain"]["specific_heat"] < 2833
    view = model["ZoneProperty:UserViewFactors:BySurfaceName"]["air_gap view"]["view_factors"]
    seen = sum(row["view_factor"] for row in view if row["from_surface"] == "roof")
    assert seen == pytest.approx(1.0)
    points = model["MaterialProperty:PhaseChange"]["ceiling energain"]["values"]
    at = {row["temperature"]: row["enthalpy"] for row in points}
    # From 0 to 60 degC: 23.4 K of solid, 36.6 K of liquid, and the latent heat.
    assert at[60.0] - at[0.0] == pytest.approx(3134 * 23.4 + 2833 * 36.6 + 71000, rel=1e-4)
    finite = {row["surface_name"] for row in model["SurfaceProperty:HeatTransferAlgorithm"].values()}
    assert finite == {"ceiling", "ceiling seen from outside"}


@pytest.mark.usefixtures("bench")
def test_weather_for_energyplus(tmp_path: Path) -> None:
    """One record for each step, as the format has it: spot values of its end, radiation as its mean."""
    import cell

    import energyplus

    building, weather = cell.building(), cell.table()
    file = tmp_path / "x.epw"
    energyplus.write_weather(file, cell.climate(weather), building, "2010-08-01", "2010-08-03", 4)
    lines = file.read_text(encoding="ascii").splitlines()
    assert lines[7] == "DATA PERIODS,1,4,Data,Sunday,8/1,8/2"
    rows = [line.split(",") for line in lines[8:]]
    assert len(rows) == 192
    assert [row[:5] for row in (rows[0], rows[-1])] == [
        ["2010", "8", "1", "1", "15"],
        ["2010", "8", "2", "24", "60"],
    ]
    assert float(rows[0][6]) == pytest.approx(weather["outdoor_air"].iloc[1], abs=1e-3)
    noon = weather.index.get_loc("2010-08-01 12:00")
    assert float(rows[noon][13]) == pytest.approx(weather["global_horizontal"].iloc[noon], rel=1e-3)
    assert float(rows[noon][12]) == pytest.approx(weather["infrared"].iloc[noon], rel=0.01)


@pytest.mark.usefixtures("bench")
def test_the_page_beside_energyplus_holds_the_recorded_numbers(repository: Path) -> None:
    """Tables and numbers were written by one run, and the numbers agree with the text of the page."""
    import energyplus_pcm  # type: ignore[import-not-found]

    numbers = json.loads(energyplus_pcm.NUMBERS.read_text(encoding="utf-8"))
    page = energyplus_pcm.PAGE.read_text(encoding="utf-8")
    assert page == energyplus_pcm.filled(page, numbers)
    assert numbers["days"] == 92
    assert max(numbers["tabulated"]["fine"]["apart"][name] for name in energyplus_pcm.cell.OUTPUTS) < 0.1
    case = numbers["hysteresis"]
    assert (
        abs(case["balance"]["ours"])
        < 0.1 * case["capacity"]
        < case["capacity"]
        < abs(case["balance"]["fine"])
    )
    assert abs(case["balance"]["one curve"]) < case["capacity"]
    assert case["closure"] < 1e-10
    assert numbers["thin_sheet"]["severe"] == 0
    with pytest.raises(ValueError, match="no place for the table 'tabulated'"):
        energyplus_pcm.filled("", numbers)


@pytest.mark.usefixtures("bench")
def test_every_table_of_the_page_on_speed_can_be_written(repository: Path) -> None:
    import page  # type: ignore[import-not-found]

    text = (repository / "docs" / "speed.md").read_text(encoding="utf-8")
    makefile = (repository / "Makefile").read_text(encoding="utf-8")
    files = [repository / name for name in re.findall(r"bench/\w+\.py(?= .*--write docs/speed.md)", makefile)]
    names = [re.findall(r'publish\("([\w ]+)"', file.read_text(encoding="utf-8")) for file in files]
    assert len(files) == 9
    assert all(len(found) == 1 for found in names), names
    for (name,) in names:
        changed = page.filled(text, name, "| new |")
        assert f"<!-- table: {name} -->\n| new |\n<!-- end -->" in changed
        assert page.filled(changed, name, "| other |").count("| other |") == 1
    assert set(re.findall("<!-- table: (.*) -->", text)) == {name for (name,) in names}


@pytest.mark.usefixtures("bench")
def test_the_engine_alone_gets_the_input_of_a_run(tmp_path: Path) -> None:
    import engine_cases  # type: ignore[import-not-found]
    import engine_speed  # type: ignore[import-not-found]

    files = engine_cases.write(tmp_path, 2)
    assert [file.stem for file in files] == list(engine_speed.MODELS)
    of = engine_speed.simulation(engine_speed.MODELS["shipped"], 2)
    case = json.loads((tmp_path / "shipped.json").read_text(encoding="utf-8"))
    assert case["description"] == json.loads(of.compiled.description)
    np.testing.assert_array_equal(case["values"], of.values)
    np.testing.assert_array_equal(np.fromfile(tmp_path / "shipped.f64"), of.compiled.forcing.ravel())
    assert np.shape(case["members"]) == (8 * len(of.values),)


@pytest.mark.usefixtures("bench")
def test_arithmetic_is_counted_by_what_is_executed() -> None:
    """One operation a number: one, two, four or eight to a register; none for moves and comparisons."""
    import counting  # type: ignore[import-not-found]

    listing = """
0000000000001000 <march>:
    1000:\tmulsd  0x8(%rax),%xmm1
    1004:\tvaddpd %ymm1,%ymm2,%ymm3
    1008:\tvdivpd (%rdi),%zmm2,%zmm3
    100e:\tsqrtpd %xmm1,%xmm2
    1012:\tmovapd %xmm1,%xmm2
    1016:\tucomisd %xmm1,%xmm2
    101a:\tmulss  %xmm1,%xmm2
    101e:\tadd    $0x8,%rax
"""
    worth = counting.operations(listing)
    assert worth == {0x1000: 1, 0x1004: 4, 0x1008: 8, 0x100E: 2}
    profile = "\n".join([
        "positions: instr", "ob=/a/b/program", "fn=march", "0x1000 5", "0x1004 3",
        "calls=2 0x1012", "0x1004 700", "0x1004 1", "0x101e 10",
        "ob=/lib/libc.so.6", "fn=memcpy", "0x1000 900",
    ])  # fmt: skip
    counts = counting.executed(profile, "program")
    assert counts == {0x1000: 5, 0x1004: 4, 0x101E: 10}
    share = counting.Count(120.0, 30.0).less(counting.Count(20.0, 10.0), 5)
    assert (share.instructions, share.flops) == (20.0, 4.0)


@pytest.mark.usefixtures("bench")
def test_the_shipped_weather_as_a_year(tmp_path: Path) -> None:
    import cell
    import through_python  # type: ignore[import-not-found]

    from mascarin.weather import Climate

    file = tmp_path / "year.epw"
    through_python.year_of_weather(file)
    lines = file.read_text(encoding="ascii").splitlines()[8:]
    assert len(lines) == 8760
    august = next(k for k, line in enumerate(lines) if line.startswith("2010,8,1,1,"))
    weather = cell.table()
    assert float(lines[august].split(",")[6]) == pytest.approx(weather["outdoor_air"].iloc[4], abs=1e-3)
    assert len(Climate.from_epw(file).index) == 8760


@pytest.mark.usefixtures("bench")
def test_seven_parameters_of_the_cell_come_back_from_our_own_data() -> None:
    """Noise-free data: within a thousandth, from a start about a quarter of the range away."""
    import lgi_seven  # type: ignore[import-not-found]

    case = lgi_seven.seven()
    problem = case.measured()
    start = problem.positions(np.array([p.first for p in problem.parameters]))
    assert np.abs(start - problem.positions(case.truth)).mean() > 0.15
    fit = solve(problem, options=SearchOptions(starts=1))
    assert len(fit.x) == 7
    np.testing.assert_allclose(fit.x, case.truth, rtol=1e-3)


@pytest.mark.usefixtures("bench")
def test_sequences_of_the_cell_go_on_where_they_were_stopped(tmp_path: Path) -> None:
    import pattern_sequences  # type: ignore[import-not-found]

    time = np.linspace(0.0, 3.0, 30)
    problem = CalibrationProblem(
        (FitParameter("rate", 0.0, 4.0), FitParameter("size", 0.1, 5.0)),
        (FitSensor("s", 2.0 * np.exp(-0.8 * time) + 0.1 * np.sin(9.0 * time), 0.1),),
        lambda x: (x[:, 1:] * np.exp(-x[:, :1] * time))[:, :, None],
    )
    first = pattern_sequences.searched(problem, 3, tmp_path)
    more = pattern_sequences.searched(problem, 5, tmp_path)
    assert more.trace.replayed == first.trace.cost.size
    assert [m.cost for m in more.minima[:3]] == [m.cost for m in first.minima]
    assert len(more.minima) == 5


@pytest.mark.usefixtures("bench")
def test_counts_are_appended_once_a_commit_and_compared_with_those_before(tmp_path: Path) -> None:
    track = importlib.import_module("track")
    file = tmp_path / "tracked.csv"

    def row(commit: str, value: int, machine: str = "linux") -> Any:
        return track.Row(commit, "2026-11-28", machine, "cell", "run", "instructions", 3, value)

    assert track.read(file) == []
    track.append(file, [row("aaa", 1000)])
    track.append(file, [row("bbb", 1100)])
    track.append(
        file, [row("bbb", 1200), row("bbb", 900, "windows")]
    )  # counted again, and on another machine
    rows = track.read(file)
    assert [(r.commit, r.machine, r.value) for r in rows] == [
        ("aaa", "linux", 1000), ("bbb", "linux", 1200), ("bbb", "windows", 900),
    ]  # fmt: skip
    (change,) = track.changes(rows, [row("ccc", 1260), row("ccc", 5, "other")])
    assert change[1] == pytest.approx(1.05)
    assert track.changes(rows, [row("bbb", 1)]) == []  # the commit itself is none before
    assert "| 2026-11-28 | aaa | linux | 0.001 |" in track.table(rows)


@pytest.mark.usefixtures("bench")
def test_the_table_over_commits_can_be_read(repository: Path) -> None:
    track = importlib.import_module("track")
    file = repository / "bench" / "tracked.csv"
    assert file.read_text(encoding="utf-8").splitlines()[0] == "commit,date,machine,case,kind,unit,days,value"
    rows = track.read(file)
    assert len({(row.commit, row.machine, row.case, row.kind, row.unit) for row in rows}) == len(rows)
    assert all(row.value > 0 for row in rows)
