"""A clock that is half an hour off: refused, and mended by the key of the refusal, at every entrance."""

# ruff: noqa: E501 (commands and tables are rows)

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import design_support
import mascarin as mc
from mascarin.cli import main
from mascarin.design.variants.inputs import read_design
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.weather.epw_writing import write_epw
from skies import sky

OUTPUT = "room.air_temperature"
PLACE = {"site.latitude": 45.0, "site.longitude": 5.0, "site.altitude": 200.0, "site.timezone": "UTC"}
CHANNELS = ("air_temperature", "dew_point", "wind_speed", "wind_direction", "global_horizontal")


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A table whose clock is 30 min late, the right one, a box, and a study of each kind of weather."""
    record = sky(np.random.default_rng(8), 45.0, 5.0, "clear", late=1800.0, days=8)
    stamps = pd.to_datetime(record.grid.start + 1800.0 * np.arange(record.grid.count), unit="s")
    frame = pd.DataFrame(
        {
            "air_temperature": 12.0 + np.sin(np.asarray(stamps.hour) / 4.0), "dew_point": 3.0, "wind_speed": 2.0,
            "wind_direction": 0.0, "global_horizontal": record.columns["global_horizontal"].round(1), "room": 20.0,
        },
        index=pd.Index(stamps.strftime("%Y-%m-%d %H:%M"), name="time"),
    )  # fmt: skip
    frame["room"] += np.arange(len(frame)) % 7 * 0.1
    frame.to_csv(tmp_path / "late.csv")
    right = stamps - pd.Timedelta("30min")
    frame.set_axis(pd.Index(right.strftime("%Y-%m-%d %H:%M"), name="time")).to_csv(tmp_path / "right.csv")
    box().replace(PLACE).to_yaml(tmp_path / "box.yaml")
    golden = mc.Climate.shipped("golden")
    write_epw(golden, tmp_path / "right.epw")
    site = golden.site
    assert site is not None
    there = {
        "site.latitude": site.latitude, "site.longitude": site.longitude, "site.altitude": site.altitude,
        "site.timezone": "UTC-7",
    }  # fmt: skip
    box().replace(there).to_yaml(tmp_path / "golden.yaml")
    return tmp_path


def columns() -> list[str]:
    return [piece for name in CHANNELS for piece in ("--column", f"{name}={name}")]


def remedy(text: str, key: str) -> str:
    """The shift that a refusal names, such as -30min."""
    said = re.search(rf"{key}=?:? ?'?(-?\d+min)", text)
    assert said is not None, text
    return said[1]


def test_runs_with_a_table(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["run", str(folder / "box.yaml"), *columns(), "--timezone", "UTC", "--step", "30min", "--output", OUTPUT,
            "--start", "2024-03-03", "--end", "2024-03-06"]  # fmt: skip
    assert main([*call, "--weather", str(folder / "late.csv"), "--out", str(folder / "no.csv")]) == 2
    shift = remedy(capsys.readouterr().err, "--shift")
    assert shift == "-30min"
    late = [
        *call,
        "--weather",
        str(folder / "late.csv"),
        f"--shift={shift}",
        "--out",
        str(folder / "late-run.csv"),
    ]
    assert main(late) == 0
    assert main([*call, "--weather", str(folder / "right.csv"), "--out", str(folder / "right-run.csv")]) == 0
    runs = [pd.read_csv(folder / name, comment="#") for name in ("late-run.csv", "right-run.csv")]
    assert np.allclose(runs[0].iloc[:, -1].to_numpy(dtype=float), runs[1].iloc[:, -1].to_numpy(dtype=float))


def test_runs_and_weather_with_a_weather_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, call = str(folder / "right.epw"), ["--start", "2001-06-01", "--end", "2001-06-03", "--step", "1h"]
    run = ["run", str(folder / "golden.yaml"), "--weather", file, *call, "--out", str(folder / "run.csv")]
    assert main([*run, "--shift=45min"]) == 2
    assert remedy(capsys.readouterr().err, "--shift") == "-45min"
    assert main([*run, "--shift=0min"]) == 0
    assert main(["weather", file, "--shift=45min"]) == 2
    assert "--shift=-45min" in capsys.readouterr().err
    assert main(["weather", file, "--shift=45min", "--no-check-sun"]) == 0
    assert main([*run[:2], "--weather", file, *call, "--shift=45min", "--no-check-sun",
                 "--out", str(folder / "run.csv")]) == 0  # fmt: skip


def test_a_file_of_weather_and_measurements(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Beside such a file the option is refused, and the key in it works."""
    named = "{" + ", ".join(f"{name}: {name}" for name in CHANNELS) + "}"
    text = f"climate:\n  measured:\n    table: late.csv\n    timezone: UTC\n    columns: {named}\n"
    (folder / "weather.yaml").write_text(text)
    call = ["run", str(folder / "box.yaml"), "--weather", str(folder / "weather.yaml"), "--step", "30min",
            "--start", "2024-03-03", "--end", "2024-03-05", "--out", str(folder / "run.csv")]  # fmt: skip
    assert main(call) == 2
    assert remedy(capsys.readouterr().err, "shift") == "-30min"
    assert main([*call, "--shift=-30min"]) == 2
    assert "expected shift: -30min in that file" in capsys.readouterr().err
    (folder / "weather.yaml").write_text(text + "    shift: -30min\n")
    assert main(call) == 0


def study(folder: Path, climate: str, building: str, days: tuple[str, str]) -> Path:
    path = folder / "study.yaml"
    path.write_text(
        f"name: clock\nbuilding: {building}\nclimate: {climate}\n"
        "measurements: {table: right.csv, timezone: UTC}\n"
        f"sensors: {{room: {{column: room, output: {OUTPUT}}}}}\nstep: 30min\n"
        f"periods: {{identification: [{days[0]}, {days[1]}]}}\n"
    )
    return path


def test_studies(folder: Path) -> None:
    named = "{" + ", ".join(f"{name}: {name}" for name in CHANNELS) + "}"

    def measured(shift: str) -> str:
        return f"{{measured: {{table: late.csv, timezone: UTC, columns: {named}{shift}}}}}"

    days = ("2024-03-03", "2024-03-05")
    with pytest.raises(InputError, match="does not follow the sun") as refused:
        _ = mc.Study(study(folder, measured(""), "box.yaml", days)).context.models.nominal
    shift = remedy(str(refused.value), "shift")
    opened = mc.Study(study(folder, measured(f", shift: {shift}"), "box.yaml", days))
    assert (
        opened.context.models.nominal.climate.grid.start
        == mc.Study(study(folder, measured("").replace("late", "right"), "box.yaml", days)).climate.grid.start
    )
    with pytest.raises(InputError, match="does not follow the sun"):
        _ = mc.Study(
            study(folder, "{epw: right.epw, shift: 45min}", "golden.yaml", days)
        ).context.models.nominal
    assert (
        mc.Study(study(folder, "{epw: right.epw, shift: 0min}", "golden.yaml", days)).context.models.nominal
        is not None
    )
    with pytest.raises(InputError, match=r"Write shift: -30min under measured"):
        mc.Study(study(folder, measured("")[:-1] + ", shift: -30min}", "box.yaml", days))


def completed(path: Path) -> list[mc.Climate]:
    """Weather of a design file, as its runs take it."""
    return [site.climate.completed() for site in read_design(path).sites]


def test_designs(tmp_path: Path) -> None:
    tampa = {"epw": "shipped:tampa", "start": "07-01", "end": "07-03"}
    path = design_support.written(tmp_path, climates={"tampa": {**tampa, "shift": "45min"}})
    with pytest.raises(InputError, match="does not follow the sun") as refused:
        completed(path)
    assert remedy(str(refused.value), "shift") == "-45min"
    for right in ({"shift": "0min"}, {"shift": "45min", "check_sun": False}):
        [climate] = completed(design_support.written(tmp_path, climates={"tampa": {**tampa, **right}}))
        assert climate.site is not None
