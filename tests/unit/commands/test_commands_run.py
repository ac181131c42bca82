from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import xarray as xr

from mascarin import __version__, cli
from mascarin.progress import Report
from mascarin.simulation.preparation.engine_run import CompiledRun

BOX = """\
name: Box
site: {latitude: 39.83, longitude: -104.65, altitude: 1650, timezone: America/Denver}
materials: {concrete: {conductivity: 1.75, density: 2400, specific_heat: 880}}
constructions: {wall: {layers: [{material: concrete, thickness: 0.2}]}}
zones: {room: {volume: 27}}
surfaces:
  facade: {construction: wall, area: 9, tilt: 90, azimuth: 180,
           outside: {outdoors: true, convection: 20, emissivity: 0.9, absorptance: 0.6},
           inside: {zone: room, convection: 3, emissivity: 0.9}}
"""
PERIOD = ["--start", "2001-01-02", "--end", "2001-01-03"]


@pytest.fixture
def call(data_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Words that run the box for a day in Denver, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    Path("box.yaml").write_text(BOX, encoding="utf-8")
    return ["run", "box.yaml", "--weather", str(data_dir / "bestest" / "725650TYCST.epw"), *PERIOD]


def test_summary(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(call) == 0
    out, err = capsys.readouterr()
    assert "warning: zones.room: 9.00 m2 of surfaces cannot enclose 27 m3" in err
    assert "assumed values: 'mascarin check' lists them" in err
    name, unit, low, mean, high = out.splitlines()[1].split()
    assert (name, unit) == ("room.air_temperature", "degC")
    assert -15.0 < float(low) < float(mean) < float(high) < 25.0
    assert "start: first 24 h repeated" in out
    assert float(out.split("energy-balance residual")[1]) < 1e-10


def test_a_given_start_saves_the_repetitions_of_a_heavy_building(
    call: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    box = Path("box.yaml").read_text("utf-8")
    thick = re.sub(r"thickness: [0-9.]+", "thickness: 2", box)
    assert thick != box
    Path("box.yaml").write_text(thick, encoding="utf-8")
    assert cli.main(call) == 0
    found = re.search(
        r"repeated (\d+) times .*: (\d+) % of all steps of the run. A stated start",
        capsys.readouterr().out,
    )
    assert found
    times, share = map(int, found.groups())
    assert share == round(100 * times / (times + 1))  # the run is as long as the first period
    assert cli.main([*call, "--initial", "3"]) == 0
    assert "start: 3 degC everywhere" in capsys.readouterr().out
    for impossible in ("nan", "500"):
        assert cli.main([*call, "--initial", impossible]) == 2
        assert "between -100 and 200 degC: such as --initial 20" in capsys.readouterr().err


def test_a_long_run_shows_its_steps_and_the_time_left(
    call: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    # As if every run were long and every line due; the engine reports at a quarter and at half of the steps.
    monkeypatch.setattr("mascarin.progress.SILENT_FOR", 0.0)
    monkeypatch.setattr("mascarin.progress._LINE_EVERY", 0.0)
    whole = CompiledRun.run_into

    def reporting(compiled: CompiledRun, *given: Any, keeps_rows: bool, progress: Report) -> dict[str, Any]:
        steps = len(compiled.forcing)
        progress(0, steps)
        progress(steps // 4, steps)
        progress(steps // 2, steps)
        return whole(compiled, *given, keeps_rows=keeps_rows)

    monkeypatch.setattr(CompiledRun, "run_into", reporting)
    assert cli.main(call) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if line.startswith("run  ")]
    shares = [int(line.split()[1]) for line in lines if "%" in line]
    assert shares == [25, 50, 100]
    assert lines[-2].endswith(" left")


def test_json(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([*call, "--json", "--output", "facade.*_flux", "--output", "room.air_temperature"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["mascarin_version"] == __version__
    assert list(result["outputs"]) == [
        "facade.outside_flux",
        "facade.inside_flux",
        "facade.concrete_flux",
        "room.air_temperature",
    ]
    assert result["energy"]["closure"] < 1e-10


def test_netcdf_holds_what_the_summary_says(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([*call, "-o", "box.nc", "--json"]) == 0
    out, err = capsys.readouterr()
    assert err.endswith("\nwrote box.nc\n")
    with xr.open_dataset("box.nc", engine="h5netcdf") as written:
        series = written["room.air_temperature"]
        assert series.attrs["units"] == "degC"
        assert len(series) == 24 * 4 + 1
        assert float(series.max()) == json.loads(out)["outputs"]["room.air_temperature"]["max"]


def test_csv_is_in_local_time(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([*call, "-o", "box.csv", "--step", "1h"]) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert err.endswith("\nwrote box.csv\n")
    table = pd.read_csv("box.csv")
    assert table["time"].iloc[[0, -1]].tolist() == ["2001-01-02 00:00:00-07:00", "2001-01-03 00:00:00-07:00"]
    assert len(table) == 25


def test_another_value_acts(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    means = []
    for absorptance in ("0.2", "0.9"):
        words = ["--set", f"surfaces.facade.outside.absorptance={absorptance}", "--json"]
        assert cli.main([*call, *words]) == 0
        result = json.loads(capsys.readouterr().out)
        assert result["changed"] == {} or set(result["changed"]) == {"surfaces.facade.outside.absorptance"}
        means.append(result["outputs"]["facade.outside_temperature"]["mean"])
    assert means[1] > means[0] + 1.0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "box.xls"], "expected a file ending in .nc, .csv or .parquet"),
        (["-o", "nowhere/box.nc"], "make 'nowhere' first"),
        (["--output", "rom.*"], "Did you mean 'room.*'?"),
        (["--output", "facade.*_flx"], "Did you mean 'facade.inside_flux'"),
        (["--output", "room.air_temprature"], "'room.air_temperature'"),
        (["--step", "soon"], "--step: found 'soon'"),
        (["--start", "2001-13-02"], "2001-13-02"),
        (["--scheme", "euler"], "backward-euler"),
        (["--weather", "box.yaml"], "expected .epw"),
    ],
)
def test_bad_input_leaves_nothing(
    words: list[str], said: str, call: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    for option in ("--weather", "--start"):
        if option in words:
            at = call.index(option)
            del call[at : at + 2]
    assert cli.main([*call, *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert said in err
    assert [path.name for path in Path().iterdir()] == ["box.yaml"]


def test_a_failure_while_writing_leaves_the_older_file(
    call: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(_self: object, _rows: object) -> None:
        raise OSError(28, "No space left on device", "box.nc")

    Path("box.nc").write_text("older", encoding="utf-8")
    monkeypatch.setattr("mascarin.simulation.records.netcdf.NetcdfDraft.take", fail)
    assert cli.main([*call, "-o", "box.nc"]) == 2
    assert "No space left" in capsys.readouterr().err
    assert Path("box.nc").read_text(encoding="utf-8") == "older"
    assert sorted(path.name for path in Path().iterdir()) == ["box.nc", "box.yaml"]


WAX = (
    "{kind: pcm, density: 855, conductivity: 0.2, specific_heat: 2000, latent_heat: 71000, "
    "melting_temperature: TM, law: {kind: tanh, width: 4}, "
    "hysteresis: {model: curve_switch, freezing_temperature: TF}}"
)


def melting_box(melts: float, freezes: float) -> None:
    """Put a sheet of wax on the inside of the box's wall."""
    wax = WAX.replace("TM", str(melts)).replace("TF", str(freezes))
    text = BOX.replace("880}}", f"880}}, wax: {wax}}}")
    text = text.replace("thickness: 0.2}", "thickness: 0.2}, {material: wax, thickness: 0.005}")
    Path("box.yaml").write_text(text, encoding="utf-8")


def test_a_layer_that_never_melts_is_warned_of(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    melting_box(60.0, 58.0)
    assert cli.main([*call, "--json"]) == 0
    out, err = capsys.readouterr()
    line, *of_building = json.loads(out)["warnings"]
    assert of_building
    assert all("cannot enclose" in other for other in of_building)
    assert line.startswith("surfaces.facade, layer wax: stayed solid")
    assert f"warning: {line}" in err


def test_a_run_prints_how_often_a_state_switched_within_a_step(
    call: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    # About the temperature that the box has.
    melting_box(-2.0, -4.0)
    assert cli.main([*call, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert all("cannot enclose" in line for line in result["warnings"])
    assert result["reversals"] > 0
    assert cli.main(call) == 0
    said = f"{result['reversals']} changes between melting and freezing within one time step"
    assert said in capsys.readouterr().out
