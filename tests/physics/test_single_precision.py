"""Ensembles in single precision: the measured difference, the same bits anywhere, and what is refused."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from mascarin import cli, sensitivity_analysis
from mascarin._engine import Plan
from mascarin.building import Building
from mascarin.ensemble import Statistic, Store, latin_hypercube, sweep, sweep_into
from mascarin.ensemble import run as ensemble_run
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.simulation.simulation import Simulation
from mascarin.simulation.single_precision import differences, members_to_check, run_in_double
from mascarin.weather import Climate
from test_commands_run import BOX, PERIOD

AIR = "room.air_temperature"
ABSORPTANCE = "surfaces.facade.outside.absorptance"
HOTTEST = {"hottest": Statistic.read(f"max:{AIR}")}
OPTIONS: dict[str, Any] = {"outputs": [AIR], "step": "30min"}
#: Without registers for lanes the engine takes double precision.
LANES = os.environ.get("MASCARIN_LANES") != "array"


@pytest.fixture(scope="module")
def building() -> Building:
    return box()


@pytest.fixture(scope="module")
def climate() -> Climate:
    return box_climate()


def _samples(building: Building, count: int) -> dict[str, Any]:
    return {str(path): column for path, column in latin_hypercube(building, count, seed=3).items()}


def test_single_precision_is_near_and_says_how_near(
    building: Building, climate: Climate, tmp_path: Path
) -> None:
    samples = _samples(building, 20)
    double = sweep(building, climate, samples, **OPTIONS)
    single = sweep(building, climate, samples, precision="single", **OPTIONS)
    apart = np.abs(single[AIR].to_numpy() - double[AIR].to_numpy())
    assert apart.max() < 0.01
    assert "single_precision" not in double.attrs
    line, *in_double = single.attrs["single_precision"]
    assert in_double == ([] if LANES else ["20 of 20 members were run in double precision"])
    said = re.fullmatch(rf"{AIR} differs by (\S+) K \(rms\), (\S+) K at most, in 8 members", line)
    assert said is not None, line
    checked = apart[members_to_check(20)]
    assert float(said[1]) == pytest.approx(np.sqrt(np.mean(checked**2)), rel=0.05)
    assert float(said[2]) == pytest.approx(checked.max(), rel=0.05)
    assert all("cannot enclose" in line for line in single.attrs["warnings"])  # of the building alone
    if LANES:
        assert checked.max() > 0.0
        assert (single["closure"] > 1e-9).all()
    assert (single["closure"] < 1e-4).all()
    assert (double["closure"] < 1e-10).all()
    single.to_netcdf(tmp_path / "single.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "single.nc", engine="h5netcdf") as again:
        assert again.attrs["single_precision"] == (line if LANES else [line, *in_double])


def test_a_member_has_the_same_bits_at_any_place(building: Building, climate: Climate) -> None:
    samples = _samples(building, 19)
    whole = sweep(building, climate, samples, precision="single", **OPTIONS)
    for rows in ([18], [4, 7, 2], list(range(16, 19))):
        part = {path: np.asarray(column)[rows] for path, column in samples.items()}
        # The mesh is that of all samples.
        found = Simulation(building, climate, ranges=_ranges(samples), **OPTIONS)
        vectors = found.varied(list(part), np.column_stack(list(part.values())))
        records, closure, failures = found.ensemble(vectors, precision="single")
        assert not failures
        np.testing.assert_array_equal(records[:, :, 0], whole[AIR].to_numpy()[rows])
        np.testing.assert_array_equal(closure, whole["closure"].to_numpy()[rows])


def _ranges(samples: dict[str, Any]) -> dict[str, tuple[float, float]]:
    return {path: (float(np.min(column)), float(np.max(column))) for path, column in samples.items()}


def test_a_store_keeps_the_difference(building: Building, climate: Climate, tmp_path: Path) -> None:
    samples = _samples(building, 12)
    given: dict[str, Any] = {"objectives": HOTTEST, **OPTIONS}
    store = sweep_into(tmp_path / "single", building, climate, samples, precision="single", **given)
    line, *in_double = store.single_precision()
    assert re.fullmatch(r"hottest differs by \S+ \(rms\), \S+ at most, in 8 members", line)
    again = Store(tmp_path / "single")
    assert again.precision == "single"
    assert again.single_precision() == [line, *in_double]
    assert line in repr(again)
    assert all("cannot enclose" in line for line in again.warnings())
    assert again.to_xarray().attrs["single_precision"] == [line, *in_double]
    whole = sweep(building, climate, samples, precision="single", **given)
    np.testing.assert_array_equal(again.to_dataframe()["hottest"], whole["hottest"])
    # The same folder in double precision would be another ensemble.
    with pytest.raises(InputError, match="differs in identity, precision"):
        sweep_into(tmp_path / "single", building, climate, samples, **given)
    other = sweep_into(tmp_path / "double", building, climate, samples, **given)
    assert other.precision == "double"
    assert other.single_precision() == []


def test_an_interrupted_store_is_the_same(
    building: Building, climate: Climate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    samples = _samples(building, 40)
    given: dict[str, Any] = {"objectives": HOTTEST, "precision": "single", **OPTIONS}
    sweep_into(tmp_path / "whole", building, climate, samples, **given)

    def interrupted(*_: Any) -> Any:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        # All members are done; the comparison with double precision is not.
        patch.setattr(ensemble_run, "_differences", interrupted)
        with pytest.raises(KeyboardInterrupt):
            sweep_into(tmp_path / "parts", building, climate, samples, **given)
    assert not Store(tmp_path / "parts").complete
    sweep_into(tmp_path / "parts", building, climate, samples, **given)
    for name in ("members.parquet", "manifest.json"):
        assert (tmp_path / "parts" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_structures_are_compared_too(building: Building, climate: Climate) -> None:
    samples: dict[str, Any] = {"surfaces.facade.outside.convection": ["tarp", "mowitt", 20.0, "tarp"]}
    found = sweep(building, climate, samples, precision="single", **OPTIONS)
    assert found.attrs["failures"] == []
    assert "in 4 members" in found.attrs["single_precision"][0]


def test_sensitivity_in_single_precision(building: Building, climate: Climate) -> None:
    vary = {ABSORPTANCE: (0.3, 0.9), "materials.concrete.conductivity": (1.0, 2.0)}
    single, double = (
        sensitivity_analysis(
            building,
            climate,
            vary=vary,
            outputs=[AIR],
            step="1h",
            precision=precision,
            samples=65,
            replicates=3,
        )
        for precision in ("single", "double")
    )
    np.testing.assert_allclose(single.index, double.index, atol=1e-3)
    [line] = [line for line in single.warnings if "single precision" in line]
    assert re.match(rf"single precision: {AIR} differs by \S+ K", line)
    assert not any("single precision" in line for line in double.warnings)


def test_the_command_prints_the_difference(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "box.yaml"
    file.write_text(BOX, encoding="utf-8")
    weather = str(data_dir / "bestest" / "725650TYCST.epw")
    call = [
        "sweep", str(file), "--weather", weather, *PERIOD, "--draw", "6", "--objective", f"max:{AIR}",
        "--precision", "single", "--scheme", "linearly-implicit",
    ]  # fmt: skip
    assert cli.main([*call, "-o", str(tmp_path / "swept")]) == 0
    printed = capsys.readouterr().out
    assert re.search(rf"single precision: max:{AIR} differs by \S+ \(rms\)", printed)
    assert cli.main([*call, "-o", str(tmp_path / "json"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["precision"] == "single"
    assert found["single_precision"][f"max:{AIR}"]["members"] == 6
    assert found["single_precision"][f"max:{AIR}"]["largest"] < 0.01


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"precision": "half"}, "precision: found 'half', expected one of double, single"),
        ({"precision": "singel"}, "Did you mean 'single'"),
        ({"precision": "single", "scheme": "apparent-capacity"}, "expected another scheme"),
    ],
)
def test_refusals(building: Building, climate: Climate, options: dict[str, Any], says: str) -> None:
    samples = {ABSORPTANCE: [0.4, 0.6]}
    with pytest.raises(InputError, match=says):
        sweep(building, climate, samples, **options, **OPTIONS)
    with pytest.raises(InputError, match=says):
        sensitivity_analysis(building, climate, vary=[ABSORPTANCE], **options, **OPTIONS)


def test_members_that_failed_are_left_out() -> None:
    single = np.array([[[1.0, 5.0]], [[np.nan, 5.5]], [[3.5, 6.0]]])
    double = np.array([[[1.5, 5.0]], [[2.0, 5.0]], [[3.5, 6.0]]])
    first, second = differences(["a", "b"], ["degC", "-"], single, double)
    assert (first.members, first.largest, first.unit, second.unit) == (2, 0.5, "K", "")
    assert first.rms == pytest.approx(0.5 / np.sqrt(2.0))
    assert (second.members, second.largest) == (3, 0.5)
    assert differences(["a"], ["K"], np.full((2, 1), np.nan), np.ones((2, 1))) == []


def test_the_engine_takes_the_precision(building: Building, climate: Climate) -> None:
    run = Simulation(building, climate, **OPTIONS)
    plan = run.compiled.plan
    assert isinstance(plan, Plan)
    vectors = np.tile(run.values, (3, 1))
    options = run.compiled.options(None, 0, 1)
    single, double = (
        plan.ensemble(vectors, run.compiled.forcing, options, None, precision)[0]
        for precision in (True, False)
    )
    assert np.abs(single - double).max() < 0.01
    assert (single != double).any() == LANES


def test_members_in_double_precision_are_counted(
    building: Building, climate: Climate, tmp_path: Path
) -> None:
    assert run_in_double(np.array([2e-6, np.nan])) == []
    samples = _samples(building, 4)
    store = sweep_into(
        tmp_path / "swept", building, climate, samples, precision="single", objectives=HOTTEST, **OPTIONS
    )
    table = store._frame()
    table.loc[2, "closure"] = 1e-14
    table.reset_index().to_parquet(tmp_path / "swept" / "members.parquet")
    assert store.single_precision()[1:] == [f"{1 if LANES else 4} of 4 members were run in double precision"]
