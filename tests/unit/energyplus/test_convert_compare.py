"""A run of EnergyPlus beside the converted model: numbers, bad folders, and the command."""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import date, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mascarin.cli import main
from mascarin.energyplus import convert
from mascarin.energyplus.comparison import compare
from mascarin.energyplus.comparison.compared import ALL
from mascarin.errors import InputError
from mascarin.simulation import simulate
from mascarin.weather import Climate

if TYPE_CHECKING:
    from playwright.sync_api import Page

SMALL = Path(__file__).resolve().parents[2] / "idf_small"
AIR = "Zone Mean Air Temperature [C]"
HEAT = "Zone Air System Sensible Heating Energy [J]"
EIO = "! <Zone Information>,Zone Name,Volume {{m3}}\n Zone Information, ROOM,{volume}\n Version, 25.2\n"
EIO += " Timesteps per Hour,  {steps}, 15\n"
EIO += "Shadowing/Sun Position Calculations Annual Simulations,PolygonClipping,Periodic,20,15000\n"


@pytest.fixture(scope="module")
def weather(data_dir: Path) -> Path:
    """The weather of the small models."""
    return data_dir / "weather" / "USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A room with ideal loads from 30 January to 2 February."""
    text = (SMALL / "base_ideal.idf").read_text(encoding="utf-8")
    period = "RunPeriod,year,1,1,,12,31,"
    assert period in text
    file = tmp_path_factory.mktemp("model") / "room.idf"
    file.write_text(text.replace(period, "RunPeriod,days,1,30,,2,2,"), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def ours(model: Path, weather: Path) -> dict[str, Any]:
    """Hourly means of the converted model: air [degC], heating [W]."""
    conversion = convert(model, weather=weather)
    run = simulate(
        conversion.building, Climate.from_epw(weather), start=conversion.start, end=conversion.end,
        step="15min", outputs=["room.air_temperature", "room.heating_load"],
    )  # fmt: skip
    air, heat = run.records[-96 * 4 :].reshape(96, 4, 2).mean(axis=1).T
    return {"air": air, "heat": heat}


def stamps(first: str = "2017-01-30", hours: int = 96) -> list[str]:
    """Times as EnergyPlus writes them: the ends of hours, 24:00 for midnight."""
    start = datetime.combine(date.fromisoformat(first), datetime.min.time())
    begins = [start + timedelta(hours=k) for k in range(hours)]
    return [f" {begin:%m/%d}  {begin.hour + 1:02d}:00:00" for begin in begins]


def csv(columns: dict[str, Any], times: list[str] | None = None) -> str:
    """``eplusout.csv`` with hourly columns."""
    rows = [",".join(["Date/Time", *columns])]
    for k, stamp in enumerate(times or stamps()):
        rows.append(",".join([stamp, *(f"{values[k]:.9g}" for values in columns.values())]))
    return "\n".join(rows) + "\n"


@pytest.fixture
def folder(tmp_path: Path, ours: dict[str, Any]) -> Path:
    """A run whose room is 0.5 K colder and takes a quarter more heat."""
    place = tmp_path / "run"
    place.mkdir()
    columns = {
        f"ROOM:{AIR}(Hourly)": ours["air"] - 0.5,
        f"ROOM:{HEAT}(Hourly)": ours["heat"] * 3600.0 * 1.25,
    }
    (place / "eplusout.csv").write_text(csv(columns), encoding="utf-8")
    (place / "eplusout.eio").write_text(EIO.format(volume=75, steps=4), encoding="utf-8")
    return place


def test_differences_are_those_that_were_put_in(model: Path, weather: Path, folder: Path) -> None:
    comparison = compare(convert(model, weather=weather), folder, weather)
    air, heating = comparison.rows
    assert (air.zone, air.quantity, heating.quantity) == ("room", "air", "heating")
    assert air.period.rms == pytest.approx(0.5, abs=1e-6)
    assert air.period.bias == pytest.approx(0.5, abs=1e-6)
    assert [span.month for span in air.months] == [1, 2]
    assert heating.period.percent == pytest.approx(-20.0, abs=1e-4)
    assert sum(span.theirs for span in heating.months) == pytest.approx(heating.period.theirs)
    assert heating.period.bias == pytest.approx(-250.0 * heating.period.ours / 96.0, rel=1e-6)
    assert any("sun near the disc" in cause for cause in comparison.causes)
    assert any("ShadowCalculation" in cause for cause in comparison.causes), "20 days in eplusout.eio"
    assert any("cooling" in note and "Output:Variable" in note for note in comparison.notes)


def test_time_steps_and_the_record_of_a_run_say_the_same(model: Path, weather: Path, folder: Path) -> None:
    conversion = convert(model, weather=weather)
    expected = [row.period for row in compare(conversion, folder, weather).rows]
    lines = (folder / "eplusout.csv").read_text(encoding="utf-8").splitlines()
    quarters = [lines[0].replace("(Hourly)", "(TimeStep)")]
    record = ["Program Version,EnergyPlus", f"7,1,ROOM,{AIR} !Hourly", f"8,1,ROOM,{HEAT} !Hourly"]
    record += ["End of Data Dictionary", "1,DAYS,41.98"]
    for line in lines[1:]:
        stamp, air, heat = line.split(",")
        hour = int(stamp[8:10])
        ends = [f"{hour - 1:02d}:15", f"{hour - 1:02d}:30", f"{hour - 1:02d}:45", f"{hour:02d}:00"]
        quarters += [f"{stamp[:8]}{end}:00,{air},{float(heat) / 4.0!r}" for end in ends]
        month, day = stamp.strip()[:5].split("/")
        record += [f"2,1,{int(month)},{int(day)},0,{hour},0.00,60.00,Monday", f"7,{air}", f"8,{heat}"]
    (folder / "eplusout.csv").write_text("\n".join(quarters), encoding="utf-8")
    for source in ("eplusout.csv", "eplusout.eso"):
        rows = compare(conversion, folder, weather).rows
        for row, span in zip(rows, expected, strict=True):
            assert (row.period.rms, row.period.theirs) == pytest.approx((span.rms, span.theirs)), source
        (folder / "eplusout.csv").unlink(missing_ok=True)
        (folder / "eplusout.eso").write_text("\n".join([*record, "End of Data"]), encoding="utf-8")


def test_a_full_table_is_not_taken_for_all_results(model: Path, weather: Path, folder: Path) -> None:
    file = folder / "eplusout.csv"
    lines = file.read_text(encoding="utf-8").splitlines()
    more = 255 - lines[0].count(",")
    heads = "".join(f",X{k}:Surface Inside Face Temperature [C](Hourly)" for k in range(more))
    file.write_text(
        "\n".join([lines[0] + heads, *(line + ",1" * more for line in lines[1:])]), encoding="utf-8"
    )
    conversion = convert(model, weather=weather)
    with pytest.raises(InputError, match=r"255 columns of results, as many as ReadVarsESO writes"):
        compare(conversion, folder, weather)
    # What has all results is read in its place.
    (folder / "eplusout.eso").write_text("no record", encoding="utf-8")
    with pytest.raises(InputError, match="found no hourly 'Zone Mean Air Temperature"):
        compare(conversion, folder, weather)


def test_design_days_before_the_run_period_are_passed_over(model: Path, weather: Path, folder: Path) -> None:
    file = folder / "eplusout.csv"
    head, *rows = file.read_text(encoding="utf-8").splitlines()
    cold = [f"{stamp},-9,1e9" for stamp in stamps("2017-01-21", 24)]
    file.write_text("\n".join([head, *cold, *rows]), encoding="utf-8")
    assert compare(convert(model, weather=weather), folder, weather).rows[0].period.rms == pytest.approx(0.5)


@pytest.mark.parametrize("quantity", ["Hourly", "Monthly"])
def test_a_run_without_hourly_air_names_the_line_that_adds_it(
    model: Path, weather: Path, folder: Path, quantity: str
) -> None:
    name = f"ROOM:{AIR}(Monthly)" if quantity == "Monthly" else "ROOM:Zone Air Humidity Ratio [](Hourly)"
    (folder / "eplusout.csv").write_text(csv({name: np.ones(96)}), encoding="utf-8")
    with pytest.raises(InputError, match="Output:Variable,\\*,Zone Mean Air Temperature,Hourly;"):
        compare(convert(model, weather=weather), folder, weather)


def _other_zones(folder: Path) -> None:
    file = folder / "eplusout.csv"
    file.write_text(file.read_text(encoding="utf-8").replace("ROOM:", "HALL:"), encoding="utf-8")
    (folder / "eplusout.eio").unlink()


def _more_zones(folder: Path) -> None:
    with (folder / "eplusout.eio").open("a", encoding="utf-8") as file:
        file.write(" Zone Information, ATTIC,30\n")


def _other_days(folder: Path) -> None:
    columns = {f"ROOM:{AIR}(Hourly)": np.ones(48)}
    (folder / "eplusout.csv").write_text(csv(columns, stamps("2017-07-01", 48)), encoding="utf-8")


def _other_steps(folder: Path) -> None:
    (folder / "eplusout.eio").write_text(EIO.format(volume=75, steps=6), encoding="utf-8")


def _failed(folder: Path) -> None:
    (folder / "eplusout.end").write_text("EnergyPlus Terminated--Fatal Error Detected.", encoding="utf-8")


def _empty(folder: Path) -> None:
    (folder / "eplusout.csv").unlink()


def _no_folder(folder: Path) -> None:
    for file in folder.iterdir():
        file.unlink()
    folder.rmdir()


def _no_table(folder: Path) -> None:
    (folder / "eplusout.csv").write_bytes(b"\x00\x01binary\n\n")


def _strange_times(folder: Path) -> None:
    columns = {f"ROOM:{AIR}(Hourly)": np.ones(2)}
    (folder / "eplusout.csv").write_text(csv(columns, ["noon", "one"]), encoding="utf-8")


def _other_weather(folder: Path) -> None:
    columns = {f"ROOM:{AIR}(Hourly)": np.ones(96)}
    columns["Environment:Site Outdoor Air Drybulb Temperature [C](Hourly)"] = np.full(96, 30.0)
    (folder / "eplusout.csv").write_text(csv(columns), encoding="utf-8")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_other_zones, "another model, with zones 'HALL'.*expected 'ROOM'.*Run EnergyPlus with it"),
        (_more_zones, "another model, with zones 'ATTIC'"),
        (_other_days, "07-01 to 07-02; expected 01-30 to 02-02.*Run EnergyPlus again"),
        (_other_steps, "6 time steps in an hour; expected 4.*Run EnergyPlus again"),
        (_failed, "Terminated--Fatal.*eplusout.err"),
        (_empty, "neither eplusout.csv nor eplusout.eso.*energyplus -r"),
        (_no_folder, "found no folder.*energyplus -r"),
        (_no_table, "hourly 'Zone Mean Air|expected the table"),
        (_strange_times, "found the time 'noon'.*ReadVarsESO"),
        (_other_weather, "outdoor air that differs.*--weather"),
    ],
)
def test_a_folder_that_cannot_be_compared_is_refused(
    model: Path, weather: Path, folder: Path, change: Callable[[Path], None], words: str
) -> None:
    change(folder)
    with pytest.raises(InputError, match=words):
        compare(convert(model, weather=weather), folder, weather)


def test_another_state_of_the_model_is_noted(model: Path, weather: Path, folder: Path) -> None:
    (folder / "eplusout.eio").write_text(EIO.format(volume=90, steps=4), encoding="utf-8")
    notes = compare(convert(model, weather=weather), folder, weather).notes
    assert "zone 'room' has 75 m3 here, 90 m3 in the run: is it this model?" in notes


def test_two_zones_have_a_row_together(tmp_path: Path, weather: Path) -> None:
    text = (SMALL / "interior_window.idf").read_text(encoding="utf-8")
    file = tmp_path / "two.idf"
    file.write_text(text.replace("RunPeriod,year,1,1,,12,31,", "RunPeriod,d,3,1,,3,2,"), encoding="utf-8")
    columns = {f"{zone}:{AIR}(Hourly)": np.full(48, 20.0) for zone in ("A", "B")}
    (tmp_path / "eplusout.csv").write_text(csv(columns, stamps("2017-03-01", 48)), encoding="utf-8")
    rows = compare(convert(file, weather=weather), tmp_path, weather).rows
    assert rows[0].zone == ALL
    parts = [row.period.rms for row in rows[1:]]
    assert rows[0].period.rms == pytest.approx(float(np.sqrt(np.mean(np.square(parts)))))
    assert parts == sorted(parts, reverse=True), "the largest difference first"


def test_the_command_prints_writes_and_refuses(
    model: Path, weather: Path, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["convert", str(model), "-o", str(tmp_path / "room.yaml"), "--compare", str(folder)]
    assert main(words) == 2
    assert "expected the weather file (EPW) of that run" in capsys.readouterr().err
    page = tmp_path / "page.html"
    assert main([*words, "--weather", str(weather), "--report", str(page)]) == 0
    out = capsys.readouterr().out
    assert "rms, K" in out
    assert "-20.0" in out
    assert "Known causes of differences:" in out
    assert "difference, %" in page.read_text(encoding="utf-8")
    assert main([*words, "--weather", str(weather), "--json"]) == 0
    held = json.loads(capsys.readouterr().out)["comparison"]
    assert held["rows"][1]["period"]["percent"] == pytest.approx(-20.0, abs=1e-3)
    assert [month["month"] for month in held["rows"][0]["months"]] == [1, 2]
    assert main([*words[:4], "--report", str(page)]) == 2
    assert "found no --compare" in capsys.readouterr().err


@pytest.mark.browser
def test_axe_finds_nothing_in_the_page(
    page: Page, model: Path, weather: Path, folder: Path, tmp_path: Path
) -> None:
    from axe_playwright_python.sync_playwright import Axe

    file = tmp_path / "page.html"
    words = ["convert", str(model), "-o", str(tmp_path / "room.yaml"), "--compare", str(folder)]
    assert main([*words, "--weather", str(weather), "--report", str(file)]) == 0
    page.goto(file.as_uri())
    for width, scheme in ((1280, "light"), (390, "dark")):
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        page.set_viewport_size({"width": width, "height": 800})
        assert [fault["id"] for fault in Axe().run(page).response["violations"]] == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
