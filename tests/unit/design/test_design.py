"""Design studies: measures and ranking against closed forms, a small study, and bad input."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import mascarin as mc
from design_support import written
from mascarin import cli
from mascarin.design import DesignResults, read_design, run_design
from mascarin.design.evaluation.reductions import Beyond, CycleDays, DaysInBin, Melted, PeakLoad
from mascarin.design.variants.description import Search
from mascarin.design.variants.ranking import pareto, ranked
from mascarin.design.variants.search import searched
from mascarin.errors import InputError
from mascarin.examples import DESIGNS


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return written(tmp_path)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[DesignResults, Path]:
    folder = tmp_path_factory.mktemp("design")
    return run_design(read_design(written(folder)), folder / "out"), folder


def series(values: list[list[float]], hours: float = 6.0) -> xr.Dataset:
    """Records of an output ``x``; local time is four hours after UTC."""
    times = pd.date_range("2024-01-01T00:00", periods=len(values[0]), freq=f"{hours}h")
    coords = {"time": times - pd.Timedelta("4h"), "local_time": ("time", times)}
    return xr.Dataset({"x": (("member", "time"), np.array(values))}, coords=coords)


def test_measures_of_a_known_series() -> None:
    """1.0 melts on the first day and 0.3 on the second; on one of them half or more changes."""
    run = series([[0.0, 0.6, 1.0, 0.6, 0.0, 0.3, 0.3, 0.1, 0.0]])
    assert Melted("x")(run) == pytest.approx([0.65], abs=1e-12)
    assert CycleDays("x", 0.5)(run).tolist() == [1.0]
    assert [float(DaysInBin("x", k)(run)[0]) for k in (2, 3, 9)] == [0.0, 1.0, 1.0]
    # Six hours of 31 and 29 degC above 28; from 18:00 to 06:00 only the 29 degC of the last step counts.
    warm = series([[40.0, 20.0, 31.0, 20.0, 29.0]])
    assert Beyond(("x",), 28.0)(warm).tolist() == [24.0]
    assert Beyond(("x",), 28.0, hours=(18.0, 6.0))(warm).tolist() == [6.0]
    assert Beyond(("x",), 28.0, weighted=False)(warm).tolist() == [12.0]
    # Means over an hour of steps of a quarter of an hour: the state at the start is no mean.
    assert PeakLoad(("x",))(series([[900.0, 0.0, 100.0, 300.0, 200.0, 100.0]], 0.25)).tolist() == [175.0]


def test_ranking_in_pairs() -> None:
    """What all samples share does not hide a difference; one that changes sign is a tie."""
    common = np.array([0.0, 50.0, 100.0, 20.0])
    values = np.array(
        [100.0 + common, 101.0 + common + [0.0, 0.1, 0.0, -0.1], 100.2 + common + [3.0, -3.0, 3.0, -3.0]]
    )
    found = ranked(values, least=True)
    assert found.order.tolist() == [0, 2, 1]
    assert found.tied.tolist() == [True, False, True]
    assert found.tied_before.tolist() == [False, True, True]  # the last two are within each other's noise
    # t with 3 degrees of freedom at 1 - 0.05/4, two comparisons: 4.1765.
    half = 4.176535 * np.std([1.0, 1.1, 1.0, 0.9], ddof=1) / 2.0
    assert found.high[1] == pytest.approx(1.0 + half, rel=1e-5)
    assert ranked(values, least=True, negligible=0.02).tied.all()
    assert ranked(-values, least=False).order.tolist() == [0, 2, 1]
    assert pareto(np.array([[1.0, 5.0], [2.0, 2.0], [2.0, 6.0], [np.nan, 0.0]])).tolist() == [
        True,
        True,
        False,
        False,
    ]


def test_a_small_study(results: tuple[DesignResults, Path]) -> None:
    found, folder = results
    table = found.to_dataframe()
    assert len(table) == 8
    assert table["failure"].isna().all()
    assert float(table["closure"].max()) < 1e-10
    # Mass: 880 kg/m3 of both products, 10 m2; cost: 3 or 2 a kilogram, and 100 outside.
    assert table["mass"].tolist() == pytest.approx([44.0, 176.0] * 4)
    row = table[
        (table["product"] == "RT25HC") & (table["place"] == "outside") & (table["thickness"] == "0.02")
    ]
    assert float(row["cost"].iloc[0]) == pytest.approx(176.0 * 3.0 + 100.0)
    bins = [name for name in table if str(name).startswith("bin ")]
    assert (table[bins].sum(axis=1) == 2.0).all()  # two days
    written_files = {file.name for file in (folder / "out").iterdir()}
    assert {
        "designs.csv",
        "designs.parquet",
        "ranking.csv",
        "samples.csv",
        "design.json",
        "report.html",
    } <= written_files
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    for title in (
        "Ranking",
        "Maps of the variables",
        "How often the material really cycles",
        "Why the best design works",
    ):
        assert title in page
    assert "http" not in page.replace("http-equiv", "").replace("http://www.w3.org", "")


def test_a_member_is_the_run_of_its_building(results: tuple[DesignResults, Path]) -> None:
    """Objectives of a design are those of a single run of the building with these parts and numbers."""
    from mascarin.simulation import Simulation

    found = results[0]
    inputs = found.inputs
    k = next(
        k
        for k in range(8)
        if {"product RT28HC", "place outside", "thickness 0.02"} <= set(found.label(k).split(", "))
    )
    options = inputs.choices.options(found.designs[k])
    site = inputs.sites[0]
    building = site.building.replace({path: part for o in options for path, part in o.parts.items()})
    simulation = Simulation(
        building,
        site.climate,
        outputs=["room.operative_temperature"],
        start=site.start,
        end=site.end,
        step="1h",
        ranges=inputs.choices.ranges(),
    )
    run = simulation.run({path: value for o in options for path, value in o.numbers.items()})
    warm = np.maximum(np.asarray(run["room.operative_temperature"])[1:] - 27.0, 0.0).sum()
    assert found.values("hot")[k] == pytest.approx(warm, rel=1e-12)


def test_killed_and_continued_gives_the_same_bytes(results: tuple[DesignResults, Path], study: Path) -> None:
    """A chunk that is missing, and a store that was never begun: the same files at the end."""
    folder = results[1]
    out = study.parent / "out"
    shutil.copytree(folder / "out", out)
    for name in ("designs.csv", "report.html", "design.json"):
        (out / name).unlink()
    stores = sorted((out / "runs").iterdir())
    shutil.rmtree(stores[0])
    manifest = json.loads((stores[1] / "manifest.json").read_text(encoding="utf-8"))
    (stores[1] / "manifest.json").write_text(json.dumps({**manifest, "complete": False}), encoding="utf-8")
    (stores[1] / "members.parquet").unlink()
    (stores[1] / "pieces").mkdir()
    run_design(read_design(study), out)
    for file in sorted((folder / "out").glob("*.*")):
        if file.is_file():
            assert (out / file.name).read_bytes() == file.read_bytes(), file.name


def test_searches_find_the_best_of_the_grid() -> None:
    """Known costs: a bowl over a range and the best of five options."""
    from mascarin.design.variants.variables import Choice, Choices, Option

    choices = Choices(
        (
            Choice("kind", "", tuple(Option(str(k)) for k in range(5))),
            Choice("x", "m", (Option("0"), Option("1")), ("x",), (0.0, 1.0)),
        ),
        free=True,
    )

    def costs(designs: Any) -> Any:
        return np.array([[(one[1] - 0.3) ** 2 + 0.1 * abs(one[0] - 3.0), -one[1]] for one in designs])

    seen = searched(choices, Search(method="swarm", evaluations=480, seed=1), costs)
    best = min(seen, key=lambda one: float(costs([one])[0, 0]))
    assert best[0] == 3.0
    assert best[1] == pytest.approx(0.3, abs=0.02)
    plan = Search(method="nsga2", evaluations=200, population=20, seed=1, objectives=("a", "b"))
    both = searched(choices, plan, costs)
    assert both == searched(choices, plan, costs)
    front = [one for one, good in zip(both, pareto(costs(both)), strict=True) if good]
    exact = [(3.0, float(x)) for x in np.linspace(0.3, 1.0, 400)]
    assert dominated(costs(front)) > 0.9 * dominated(costs(exact))


def dominated(points: Any) -> float:
    """Area between a front of two costs and the point (1, 0)."""
    area, second = 0.0, 0.0
    for one, other in sorted(points.tolist()):
        area += max(1.0 - one, 0.0) * max(second - other, 0.0)
        second = min(second, other)
    return area


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"objectives": {"hot": {"kind": "degree_hour", "zones": ["room"], "above": 27}}}, "degree_hours"),
        (
            {"objectives": {"hot": {"kind": "degree_hours", "zones": ["rom"], "above": 27}}},
            "expected one of room",
        ),
        (
            {"objectives": {"c": {"kind": "cooling_energy", "zones": ["room"]}}},
            "found no cooling in zone 'room'",
        ),
        (
            {"objectives": {"l": {"kind": "latent_use", "layer": "ceiling.board"}}},
            "expected a phase-change material",
        ),
        (
            {"objectives": {"h": {"kind": "hours", "zones": ["room"], "above": 27, "air_speed": 0.7}}},
            "0, 0.6, 0.9 or 1.2",
        ),
        (
            {
                "objectives": {
                    "p": {
                        "kind": "comfort",
                        "zones": ["room"],
                        "comfort": {"index": "pmv", "humidity": 60, "metabolic_rate": 5},
                    }
                }
            },
            "room of 26 degC (relative air speed above 1 m/s; metabolic rate above 4 met; PMV above 2); ",
        ),
        (
            {
                "objectives": {
                    "p": {
                        "kind": "comfort",
                        "zones": ["room"],
                        "comfort": {"index": "set", "band": [22, 26], "humidity": "simulated"},
                    }
                }
            },
            "expected the section 'humidity:' in the building",
        ),
        (
            {"variables": {"t": {"path": "constructions.ceiling.layers.wax.thickness", "values": [0.01]}}},
            "has the layers board, pcm",
        ),
        (
            {"variables": {"t": {"path": "constructions.ceiling.layers.pcm.thickness", "values": [20.0]}}},
            "10 mm is 0.01",
        ),
        ({"variables": {"p": {"material": "pcm", "products": ["RT-none"]}}}, "RT-none"),
        (
            {
                "variables": {
                    "p": {"variants": {"bare": {"materials.pcm": {"kind": "pcm", "latent_heat": 1e5}}}}
                }
            },
            "density",
        ),
        (
            {"uncertainty": {"parameters": ["materials.pcm.conductivity.solid"], "samples": 4}},
            "one of the variables",
        ),
        ({"rank_by": "warm"}, "one of the objectives"),
        (
            {"climates": {"tampa": {"epw": "shipped:tampa", "start": "12-01", "end": "2002-02-01"}}},
            "inside of the weather file",
        ),
        ({"search": {"method": "cma"}}, "Take method: swarm"),
    ],
)
def test_what_cannot_be_used_is_said_before_the_run(
    tmp_path: Path, changes: dict[str, Any], said: str
) -> None:
    study = written(tmp_path, **changes)
    with pytest.raises(InputError) as error:
        read_design(study)
    assert said in str(error.value)
    assert "design.yaml:" in str(error.value)


def test_a_climate_without_wind_is_refused(tmp_path: Path) -> None:
    from mascarin.weather.reading.shipped import content, found

    rows = content(found("shipped:tampa")).decode("latin-1").splitlines()
    calm = [*rows[:8], *(",".join([*r.split(",")[:21], "0.0", *r.split(",")[22:]]) for r in rows[8:])]
    (tmp_path / "calm.epw").write_text("\n".join(calm) + "\n", encoding="latin-1")
    study = written(tmp_path, climates={"calm": {"epw": "calm.epw", "start": "07-01", "end": "07-02"}})
    with pytest.raises(InputError, match=r"no wind in the weather file.*openings\.window"):
        read_design(study)


def test_the_command_says_what_it_would_run(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert cli.main(["design", "reunion-house", "--check", "--json"]) == 0
    plan = json.loads(capsys.readouterr().out)
    assert plan["designs"] == 60
    assert plan["runs"] == (60 + 6 * 16) * 3 * 2  # climates, free and cooled
    assert cli.main(["design", "nowhere", "-o", str(tmp_path / "out")]) == 2
    assert "reunion-house" in capsys.readouterr().err
    assert DESIGNS["reunion-house"].is_file()


def test_comfort_of_the_simulated_humidity(tmp_path: Path) -> None:
    """Degree-hours outside of Givoni's zone are those of single runs, with the humidity of each room."""
    settings = {"index": "givoni", "humidity": "simulated"}
    objective = {"kind": "comfort", "zones": ["room"], "comfort": settings}
    variables = {"roof": {"path": "surfaces.ceiling.outside.absorptance", "values": [0.3, 0.7]}}
    file = written(
        tmp_path, objectives={"moist": objective}, variables=variables, uncertainty=None,
        climates={"tampa": {"epw": "shipped:tampa", "start": "07-01", "end": "07-02"}},
    )  # fmt: skip
    humid = {"zones": {"room": {"gains": {"people": {"power": 200}}}}, "materials": {"board": "gypsum"}}
    with (tmp_path / "building.yaml").open("a", encoding="utf-8") as building:
        building.write(f"humidity: {json.dumps(humid)}\n")
    found = run_design(read_design(file), tmp_path / "out")
    site = found.inputs.sites[0]
    kinds = ("air_temperature", "mean_radiant_temperature", "relative_humidity")
    for design, value in zip(found.designs, found.values("moist"), strict=True):
        absorptance = variables["roof"]["values"][int(design[0])]
        run = mc.simulate(
            site.building.replace({"surfaces.ceiling.outside.absorptance": absorptance}), site.climate,
            start=site.start, end=site.end, step="1h", outputs=[f"room.{kind}" for kind in kinds],
        )  # fmt: skip
        alone = run.comfort("room", site.climate, index="givoni").degree_hours
        dry = run.comfort("room", site.climate, index="givoni", humidity=50).degree_hours
        assert value == pytest.approx(alone, rel=1e-12)
        assert abs(alone - dry) > 1.0


def test_cooling_counts_the_latent_heat_of_drying(tmp_path: Path) -> None:
    """A room held at 10 g/kg under a steady outdoor vapour: ``G + L rho V n (w_o - w)``, a hand number.

    The coil of a second objective takes ``1/9`` of its sensible heat as latent heat. A design without
    drying has sensible heat alone, and the same heat: it does not depend on vapour.
    """
    from mascarin.weather.reading.shipped import content, found

    def steady(row: str) -> str:
        fields = row.split(",")
        return ",".join([*fields[:7], "20.0", fields[8], "101325", *fields[10:]])

    rows = content(found("shipped:tampa")).decode("latin-1").splitlines()
    (tmp_path / "steady.epw").write_text(
        "\n".join([*rows[:8], *map(steady, rows[8:])]) + "\n", encoding="latin-1"
    )
    cooled = {"zones": ["room"], "setpoint": 25}
    point = {"set": {"humidity.zones.room.drying": {"humidity_ratio": 0.010}}}
    coil = {"set": {"humidity.zones.room.drying": {"sensible_heat_ratio": 0.9}}}
    file = written(
        tmp_path,
        climates={"steady": {"epw": "steady.epw", "start": "07-01", "end": "07-03"}},
        variables={"roof": {"path": "surfaces.ceiling.outside.absorptance", "values": [0.3, 0.7]}},
        objectives={
            "energy": {"kind": "cooling_energy", **cooled, **point},
            "peak": {"kind": "peak_cooling", **cooled, **point},
            "by coil": {"kind": "cooling_energy", **cooled, **coil},
            "sensible alone": {"kind": "cooling_energy", **cooled},
            "sensible peak": {"kind": "peak_cooling", **cooled},
        },
        uncertainty=None,
        reference={},
    )
    humid = {"zones": {"room": {"gains": {"people": {"power": 200}}}}}
    described = (tmp_path / "building.yaml").read_text(encoding="utf-8")
    described = described.replace("timezone: UTC-5", "timezone: UTC-5, air_density: 1.2")
    plain = [line for line in described.splitlines() if not line.startswith("openings:")]
    (tmp_path / "building.yaml").write_text(
        "\n".join([*plain, f"humidity: {json.dumps(humid)}"]), encoding="utf-8"
    )
    results = run_design(read_design(file), tmp_path / "out")
    table = results.to_dataframe()
    # 2338.8 Pa at 20 degC (Hyland & Wexler); 30 m3 and one air change an hour; 48 h.
    outdoor = 0.621945 * 2338.8 / (101325.0 - 2338.8)
    load = 200.0 + 2.5e6 * 1.2 * 30.0 / 3600.0 * (outdoor - 0.010)
    assert table["energy, latent"].tolist() == pytest.approx([0.048 * load] * 2, rel=2e-5)
    assert table["energy"].tolist() == pytest.approx(
        (table["sensible alone"] + 0.048 * load).tolist(), rel=1e-4
    )
    assert table["peak"].tolist() == pytest.approx((table["sensible peak"] + load).tolist(), rel=1e-4)
    assert table["by coil"].tolist() == pytest.approx((table["sensible alone"] / 0.9).tolist(), rel=1e-9)
    assert "sensible alone, latent" not in table
    assert results.reference["steady"]["energy, latent"] == pytest.approx(0.048 * load, rel=2e-5)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count("energy, latent, kWh") == 2  # by climate, and of all designs
    assert "sensible, and latent where a zone is dried" in page


def test_drying_in_a_part_of_the_designs_is_refused(tmp_path: Path) -> None:
    """Its latent heat would count in these designs only."""
    dried = {"humidity.zones.room.drying": {"relative_humidity": 0.6}}
    study = written(
        tmp_path, variables={"plant": {"variants": {"none": {}, "dried": dried}}},
        objectives={"energy": {"kind": "cooling_energy", "zones": ["room"], "setpoint": 25}},
    )  # fmt: skip
    with (tmp_path / "building.yaml").open("a", encoding="utf-8") as building:
        building.write("humidity: {}\n")
    with pytest.raises(InputError, match=r"with and without room\.latent_cooling_load.*in all of them"):
        read_design(study)


def test_what_an_objective_sets_holds_for_every_design(tmp_path: Path) -> None:
    """Closed windows of the cooled building, also where a variable chooses the windows."""
    closed = {"openings.*.area": 0.001, "schedules.windows": {"kind": "fraction", "value": 0.0}}
    cooled = {"kind": "cooling_energy", "zones": ["room"], "setpoint": 25}
    variables = {
        "area": {"path": "openings.window.area", "values": [0.2, 0.8]},
        "windows": {
            "variants": {"ajar": {}, "open": {"schedules.windows": {"kind": "fraction", "value": 1.0}}}
        },
    }
    described = (written(tmp_path).parent / "building.yaml").read_text(encoding="utf-8")
    opened = described.replace("wind_coefficient: 0.2}", "wind_coefficient: 0.2, schedule: windows}")
    file = written(
        tmp_path,
        climates={"tampa": {"epw": "shipped:tampa", "start": "07-01", "end": "07-02"}},
        variables=variables,
        objectives={"closed": {**cooled, "set": closed}, "as chosen": cooled},
        uncertainty=None,
    )
    (tmp_path / "building.yaml").write_text(
        opened + "schedules: {windows: {kind: fraction, value: 0.5}}\n", encoding="utf-8"
    )
    found = run_design(read_design(file), tmp_path / "out")
    site = found.inputs.sites[0]
    run = mc.simulate(
        site.building.replace({**closed, "zones.room.cooling": {"setpoint": 25}}), site.climate,
        start=site.start, end=site.end, step="1h", outputs=["room.cooling_load"],
    )  # fmt: skip
    alone = float(np.asarray(run["room.cooling_load"])[1:].sum()) / 1000.0
    assert found.values("closed").tolist() == pytest.approx([alone] * 4, rel=1e-12)
    assert len(set(found.values("as chosen").tolist())) == 4
    overlap = {"closed": {**cooled, "set": {"openings.window": {"zone": "room", "area": 0.1, "height": 0.4}}}}
    written(tmp_path, variables=variables, objectives=overlap)
    with pytest.raises(InputError, match=r"a change of openings\.window, and variable 'area' chooses"):
        read_design(file)
