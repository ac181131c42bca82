"""Files of loggers as people have them: units, clocks and numbers by what the file says of itself."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import Climate, Measurements, cli
from mascarin.errors import InputError

FILES = Path(__file__).parents[2] / "data" / "loggers"
HOURS = [f"2023-03-{1 + k // 24:02d} {k % 24:02d}:00" for k in range(72)]


def read(name: str, **options: Any) -> Measurements:
    return Measurements.from_table(FILES / name, **{"timezone": "UTC+1", **options})


def weather(source: str | Path, **columns: Any) -> Climate:
    humid = "dew_point" if "relative_humidity" not in columns else ""
    absent = [
        name
        for name in (humid, "wind_speed", "wind_direction", "radiation")
        if name and name not in columns and not (name == "radiation" and "global_horizontal" in columns)
    ]
    path = FILES / source if isinstance(source, str) else source
    return Climate.from_table(path, timezone="UTC+1", columns=columns, absent=absent, check_sun=False)


def written(folder: Path, head: str, *values: list[Any], separator: str = ",") -> Path:
    path = folder / "log.csv"
    rows = [
        separator.join([stamp, *map(str, row)])
        for stamp, row in zip(HOURS, zip(*values, strict=True), strict=True)
    ]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


# ---------------------------------------------------------------------- units (L01, L02, L08)


def test_the_row_of_units_is_used_and_said() -> None:
    columns = {
        "air_temperature": "AirT", "relative_humidity": "RH", "wind_speed": "Wind",
        "global_horizontal": "Slr",
    }  # fmt: skip
    metric, imperial = weather("units_row_C.csv", **columns), weather("units_row_F.csv", **columns)
    for name, tolerance in (("air_temperature", 8e-4), ("wind_speed", 8e-4), ("global_horizontal", 0.51)):
        assert np.max(np.abs(imperial.data[name] - metric.data[name])) < tolerance, name
    assert imperial.data["air_temperature"].min() == pytest.approx(1.0, abs=1e-9)
    lines = [origin.line for origin in imperial.record.origins.values()]
    assert lines[0] == (
        "air_temperature: column 'AirT', degF (the row of units (line 2)) converted to degC; 1 .. 11 degC, "
        "0 missing."
    )
    assert all(any(line in note for note in imperial.provenance) for line in lines)


@pytest.mark.parametrize("name", ["hobo_F.csv", "brackets_F.csv", "units_row_F.csv"])
def test_units_in_names_and_rows_give_the_same_series(name: str) -> None:
    found = read(name, timezone="UTC-5" if name.startswith("hobo") else "UTC+1").data
    true = read("units_row_C.csv").data
    temperature, wind = found.columns[0], found.columns[2]
    assert np.allclose(found[temperature].to_numpy(), true["AirT"].to_numpy(), atol=8e-4)
    assert np.allclose(found[wind].to_numpy(), true["Wind"].to_numpy(), atol=1.5e-3)


def test_a_unit_of_the_user_against_that_of_the_file_is_refused_with_both() -> None:
    with pytest.raises(InputError, match=r"unit 'degC'.*units \(line 2\) says 'Deg F'.*overrule: true"):
        weather("units_row_F.csv", air_temperature={"column": "AirT", "unit": "degC"})
    forced = {"column": "AirT", "unit": "degC", "overrule": True}
    with pytest.raises(InputError, match="overrule"):
        weather("units_row_F.csv", air_temperature={**forced, "overrule": "yes"})
    assert weather("units_row_F.csv", air_temperature=forced).data["air_temperature"].min() == 33.8
    same = weather("units_row_F.csv", air_temperature={"column": "AirT", "unit": "°F"})
    assert same.data["air_temperature"].min() == pytest.approx(1.0, abs=1e-9)


def test_a_factor_of_the_user_is_the_conversion_or_is_refused() -> None:
    by_hand = weather("units_row_F.csv", air_temperature="AirT",
                      global_horizontal={"column": "Slr", "scale": 1000.0})  # fmt: skip
    by_unit = weather("units_row_F.csv", air_temperature="AirT", global_horizontal="Slr")
    assert np.allclose(by_hand.data["global_horizontal"], by_unit.data["global_horizontal"])
    gain = {"column": "Slr", "scale": 1.02}
    with pytest.raises(InputError, match=r"scale 1.02.*says 'kW/m2'.*Write unit: kW/m2"):
        weather("units_row_F.csv", air_temperature="AirT", global_horizontal=gain)
    stated = weather("units_row_F.csv", air_temperature="AirT", global_horizontal={**gain, "unit": "kW/m2"})
    ratio = stated.data["global_horizontal"].max() / by_unit.data["global_horizontal"].max()
    assert ratio == pytest.approx(1.02, rel=1e-12)


def test_a_column_of_another_quantity_is_refused() -> None:
    with pytest.raises(InputError, match=r"says '%' for the column 'RH', expected one of degC, K, degF"):
        weather("units_row_F.csv", air_temperature="RH")


def test_a_unit_in_the_name_and_one_of_the_user_are_the_same_wind() -> None:
    named = weather("wind_br1.csv", air_temperature="T", wind_speed="wind [km/h]")
    stated = weather("wind_br2.csv", air_temperature="T", wind_speed={"column": "wind", "unit": "km/h"})
    assert named.data["wind_speed"].iloc[0] == stated.data["wind_speed"].iloc[0] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("channel", "values", "unit"),
    [
        ("wind_speed", [36.0, 40.0], "km/h"), ("air_temperature", [60.0, 70.0], "degF"),
        ("air_temperature", [290.0, 291.0], "K"), ("global_horizontal", [0.1, 0.6], "kW/m2"),
        ("relative_humidity", [0.4, 0.9], "1"), ("pressure", [1013.0, 1020.0], "hPa"),
        ("pressure", [99.0, 101.0], "kPa"),
    ],
)  # fmt: skip
def test_values_that_are_not_plausible_name_the_likely_unit(
    tmp_path: Path, channel: str, values: list[float], unit: str
) -> None:
    file = written(tmp_path, "time,air,x", [10.0] * 72, values * 36)
    given = {} if channel == "air_temperature" else {"air_temperature": "air"}
    with pytest.raises(InputError, match=rf"log.csv:3: {channel}: found a .*unit: '{unit}'"):
        weather(file, **given, **{channel: "x"})
    weather(file, **given, **{channel: {"column": "x", "unit": unit}})


def test_two_units_of_one_column_are_refused(tmp_path: Path) -> None:
    file = written(tmp_path, "time,T [°C],RH\nTS,Deg F,%", [10.0] * 72, [50] * 72)
    with pytest.raises(InputError, match=r"log.csv:2: the row of units has 'Deg F'.*name says '°C'"):
        weather(file, air_temperature="T [°C]")
    stated = {"column": "T [°C]", "unit": "degC", "overrule": True}
    assert weather(file, air_temperature=stated).data["air_temperature"].iloc[0] == 10.0


def test_the_zone_in_the_name_of_the_time_is_used() -> None:
    new_york = read("hobo_us_cut.csv", timezone="America/New_York")
    assert new_york.index[0].isoformat() == "2023-07-03T01:00:00-04:00"
    assert any("states UTC-5: its stamps were turned" in note for note in new_york.provenance)
    alone = read("hobo_us_cut.csv", timezone=None)
    assert alone.index[0].isoformat() == "2023-07-03T00:00:00-05:00"
    with pytest.raises(InputError, match=r"timezone Europe/Paris.*GMT-05:00.*Write timezone: UTC-5"):
        read("hobo_us_cut.csv", timezone="Europe/Paris")


# ---------------------------------------------------------------------- numbers (L04, L18)


@pytest.mark.parametrize("options", [{}, {"missing": ["---"]}])
def test_decimal_commas_beside_words_for_no_value(options: dict[str, Any]) -> None:
    found = read("testo_de.csv", **options).data
    room = found["T_raum [°C]"]
    assert room.isna().sum() == 2
    assert room.min() == 20.5
    assert room.max() == 23.5


@pytest.mark.parametrize("name", ["excel_ch_thousands.csv", "excel_fr_thousands.csv"])
def test_thousands_with_apostrophes_and_narrow_blanks(name: str) -> None:
    power = read(name).data["power_W"]
    assert power.iloc[0] == 1500.0
    assert power.min() == 800.0
    assert power.max() == 2200.0


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        (["998", "1.500", "1.523"], [998.0, 1500.0, 1523.0]),
        (["998", "1,500", "1,523"], [998.0, 1500.0, 1523.0]),
        (["20.125", "20.250", "20.375"], [20.125, 20.25, 20.375]),
        (["20,125", "20,250", "20,375"], [20.125, 20.25, 20.375]),
        (["0,125", "1,250", "2"], [0.125, 1.25, 2.0]),
        (["45.231", "99.876", "100"], [45.231, 99.876, 100.0]),
        (["45,231", "99,876", "100"], [45.231, 99.876, 100.0]),
        (["1.234,5", "998,0", "12"], [1234.5, 998.0, 12.0]),
        (["1,234.5", "998.0", "12"], [1234.5, 998.0, 12.0]),
        (["1.234.567", "998", "1.000"], [1234567.0, 998.0, 1000.0]),
        (["1e-3", "+5", "-2.5"], [0.001, 5.0, -2.5]),
        (["1.5", "NaN", "---"], [1.5, np.nan, np.nan]),
        (["12,5", "Err", "#N/A"], [12.5, np.nan, np.nan]),
    ],
)
def test_marks_of_a_column(tmp_path: Path, entries: list[str], expected: list[float]) -> None:
    file = written(tmp_path, "time;P", list(entries * 24), separator=";")
    found = Measurements.from_table(file, timezone="UTC").data["P"].to_numpy()
    assert np.array_equal(found[:3], expected, equal_nan=True)


def test_an_open_mark_is_refused_with_two_examples(tmp_path: Path) -> None:
    file = written(tmp_path, "time;P", ["1.500", "1499", "1523"] * 24, separator=";")
    with pytest.raises(InputError, match=r"'1.500' in line 2 beside '1499' in line 3.*State decimal"):
        Measurements.from_table(file, timezone="UTC")
    comma = Measurements.from_table(file, timezone="UTC", decimal=",").data["P"]
    assert comma.tolist()[:3] == [1500.0, 1499.0, 1523.0]
    point = Measurements.from_table(file, timezone="UTC", decimal=".").data["P"]
    assert point.tolist()[:3] == [1.5, 1499.0, 1523.0]


@pytest.mark.parametrize("entry", ["<0.5", "12*", "22.0 C"])
def test_entries_that_are_no_numbers_are_named(tmp_path: Path, entry: str) -> None:
    file = written(tmp_path, "time,T", [entry, *range(71)])
    with pytest.raises(InputError, match=r"column 'T', line 2: found .*name it in missing") as caught:
        Measurements.from_table(file, timezone="UTC")
    assert repr(entry) in str(caught.value)
    found = Measurements.from_table(file, timezone="UTC", missing=[entry]).data["T"]
    assert found.isna().sum() == 1


# ---------------------------------------------------------------------- layout (L06, L07, L09, L14)


def test_hoboware_as_it_is_exported() -> None:
    found = read("hobo_us.csv", timezone="America/New_York")
    name = next(name for name in found.data.columns if name.startswith("Temp"))
    assert len(found.data) == 864
    assert found.grid.interval == 600.0
    assert found.data[name].iloc[:3].tolist() == [13.757, 13.576, 13.404]
    assert any(
        "3 rows without any number were left out, the first in line 867" in n for n in found.provenance
    )


def test_a_head_that_a_restart_repeats_is_left_out(tmp_path: Path) -> None:
    head = (
        '"TOA5","CR1000","CR1000","1234","CR1000.Std.31","CPU:prog.CR1","5555","Table1"\n'
        '"TIMESTAMP","RECORD","AirT_Avg","Slr_Avg"\n"TS","RN","Deg F","kW/m^2"\n"","","Avg","Avg"\n'
    )
    rows = [f'"{stamp}:00",{k},50.0,0.{k:03d}\n' for k, stamp in enumerate(HOURS)]
    file = tmp_path / "toa5.dat"
    file.write_text(head + "".join(rows[:30]) + head.replace("1234", "1235") + "".join(rows[30:]))
    found = Measurements.from_table(file, timezone="UTC", columns=["AirT_Avg", "Slr_Avg"])
    assert len(found.data) == 72
    assert found.data["AirT_Avg"].tolist() == pytest.approx([10.0] * 72)
    assert found.data["Slr_Avg"].iloc[40] == pytest.approx(40.0)
    assert found.record.line("Slr_Avg", 40) == 4 + 41 + 4
    assert any("the head is repeated in line 35; 4 such lines" in note for note in found.provenance)


@pytest.mark.parametrize("options", [{}, {"skip_lines": 0}])
def test_a_row_of_labels_below_names_and_units(options: dict[str, Any]) -> None:
    found = read("three.csv", **options)
    assert list(found.data.columns) == ["T_a", "T_b"]
    assert found.data["T_b"].iloc[0] == 6.17


def test_columns_of_words_are_left_out_and_said() -> None:
    found = read("ibutton.csv", time_format="%d/%m/%y %I:%M:%S %p")
    assert list(found.data.columns) == ["Value"]
    assert found.data["Value"].max() == 23.5
    assert any("left out, without a number: Unit" in note for note in found.provenance)


def test_points_of_the_compass_are_directions() -> None:
    found = weather("davis.csv", air_temperature="Temp", wind_direction="Wind Direction",
                    wind_speed={"column": "Wind Speed", "unit": "km/h"})  # fmt: skip
    assert found.data["wind_direction"].iloc[:4].tolist() == [0.0, 22.5, 45.0, 67.5]
    assert found.data["wind_direction"].isna().sum() == 2
    assert found.data["wind_speed"].iloc[0] == pytest.approx(10.0 / 3.6)


# ---------------------------------------------------------------------- clocks (L10 to L17)


@pytest.mark.parametrize("name", ["%s", "%Q", "%"])
def test_a_directive_that_is_not_known_is_no_defect(name: str) -> None:
    with pytest.raises(InputError, match=r"epoch.csv:2: time_format: .*Leave it out"):
        read("epoch.csv", time_format=name)


def test_numbers_as_times() -> None:
    seconds = read("epoch.csv", timezone="UTC")
    assert seconds.index[0].isoformat() == "2023-03-01T00:00:00+00:00"
    assert any("seconds since 1970" in note for note in seconds.provenance)
    serial = read("excel_serial.csv", timezone="Europe/Berlin")
    assert serial.index[0].isoformat() == "2023-07-03T00:00:00+02:00"
    assert len(serial.data) == 864
    assert serial.data["T"].iloc[:3].tolist() == [13.757, 13.576, 13.404]


def test_milliseconds_and_digits(tmp_path: Path) -> None:
    def stamps(values: list[int]) -> str:
        path = tmp_path / "n.csv"
        path.write_text("t,T\n" + "".join(f"{value},{k}\n" for k, value in enumerate(values)))
        return Measurements.from_table(path, timezone="UTC").index[1].isoformat()

    assert stamps([1677628800000, 1677632400000, 1677636000000]) == "2023-03-01T01:00:00+00:00"
    assert stamps([2023030100, 2023030101, 2023030102]) == "2023-03-01T01:00:00+00:00"
    assert stamps([202303010000, 202303010015, 202303010030]) == "2023-03-01T00:15:00+00:00"
    assert stamps([20230301, 20230302, 20230303]) == "2023-03-02T00:00:00+00:00"


def test_a_clock_with_jitter() -> None:
    found = read("jitter.csv")
    assert found.grid.interval == 600.0
    assert len(found.data) == 864
    assert not found.data["T"].isna().any()
    assert found.index[1].isoformat() == "2023-07-03T00:10:00+01:00"
    assert any("moved to the grid of 10 min, by 1 s at most" in note for note in found.provenance)
    with pytest.raises(InputError, match=r"jitter.csv:3: .*state a larger tolerance"):
        read("jitter.csv", tolerance="0.5s")
    assert len(read("jitter.csv", tolerance="2s").data) == 864


def test_day_of_the_year_and_2400() -> None:
    for options in ({}, {"time": ["year", "day", "hhmm"], "time_format": "%Y %j %H%M"}):
        found = read("cr10x_names.csv", **options)
        assert len(found.data) == 864
        assert found.grid.interval == 600.0
        assert found.index[0].isoformat() == "2023-07-03T00:00:00+01:00"
        assert found.data["T"].iloc[:3].tolist() == [13.757, 13.576, 13.404]


def test_day_and_month_follow_from_all_stamps() -> None:
    found = read("dayfirst.csv")
    assert found.index[-1].isoformat() == "2023-07-12T23:00:00+01:00"
    assert len(found.data) == 288
    with pytest.raises(
        InputError, match=r"dayfirst.csv:26: .*exchanged all steps are 3600 s.*'%d/%m/%Y %H:%M'"
    ):
        read("dayfirst.csv", time_format="%m/%d/%Y %H:%M")
    assert len(read("dayfirst.csv", time_format="%d/%m/%Y %H:%M").data) == 288


def test_one_day_with_two_readings_is_refused_with_both() -> None:
    with pytest.raises(InputError, match=r"2023-07-03 00:00 .*or 2023-03-07 00:00.*both give regular times"):
        read("dayfirst_oneday.csv")
    assert read("dayfirst_oneday.csv", time_format="%d/%m/%Y %H:%M").index[0].month == 7
    assert read("dayfirst_oneday.csv", time_format="%m/%d/%Y %H:%M").index[0].month == 3


def test_dates_of_two_forms_are_refused_by_line() -> None:
    with pytest.raises(InputError, match=r"excel_mixed_dates.csv:50: time '13/07/2023 00:00'"):
        read("excel_mixed_dates.csv")


# ---------------------------------------------------------------------- further devices and locales

STAMPS = pd.date_range("2023-10-20", periods=432, freq="10min")
AIR = 15.0 + 5.0 * np.sin(np.arange(432) / 144.0 * 2.0 * np.pi)


def comma(value: float, digits: int = 2) -> str:
    return f"{value:.{digits}f}".replace(".", ",")


def rows(form: Callable[[int, pd.Timestamp, float], str]) -> str:
    return "".join(form(k, stamp, air) + "\n" for k, (stamp, air) in enumerate(zip(STAMPS, AIR, strict=True)))


def us(stamp: pd.Timestamp) -> str:
    return f"{stamp.month}/{stamp.day}/{stamp.year}"


def half(stamp: pd.Timestamp) -> str:
    return f"{stamp.month}/{stamp.day}/{stamp:%y}\t{stamp.strftime('%I:%M').lstrip('0')}{stamp:%p}"[
        :-1
    ].lower()


VARIANTS: dict[str, tuple[str, str, float, float]] = {
    "WeatherLink": (
        "\t\tTemp\tHi\tOut\n Date\tTime\tOut\tTemp\tHum\n"
        + rows(lambda k, s, t: f"{s:%d/%m/%y}\t{s:%H:%M}\t{t:.2f}\t{t + 0.1:.1f}\t60"),
        "Temp Out", 15.0, 15.22,
    ),
    "WeatherLink, 12 hours": (
        "\t\tTemp\tHi\n Date\tTime\tOut\tTemp\n"
        + rows(lambda k, s, t: f"{half(s)}\t{t:.2f}\t{t + 0.1:.1f}"),
        "Temp Out", 15.0, 15.22,
    ),
    "HOBOware, French": (
        '"Titre de tracé : grenier"\n"#";"Date Heure, GMT+01:00";"Temp., °C (LGR S/N: 1, SEN S/N: 1)"\n'
        + rows(lambda k, s, t: f"{k + 1};{s:%d/%m/%Y %H:%M:%S};{comma(t, 3)}"),
        "Temp., °C (LGR S/N: 1, SEN S/N: 1)", 15.0, 15.218,
    ),
    "HOBOlink": (
        'Line#,Date,"Temp, °F (S-THB 1:1)","RH, % (S-THB 1:1)"\n'
        + rows(lambda k, s, t: f"{k + 1},{s:%m/%d/%y %H:%M:%S},{t * 1.8 + 32:.3f},60"),
        "Temp, °F (S-THB 1:1)", 15.0, 15.218,
    ),
    "Excel, USA, thousands": (
        "Time,Power (W),T (F)\n"
        + rows(lambda k, s, t: f'{us(s)} {s.hour}:{s:%M},"{1500 + k:,}",{t * 1.8 + 32:.1f}'),
        "Power (W)", 1500.0, 1501.0,
    ),
    "Excel, Germany, thousands": (
        "Zeit;Leistung [W];T [°C]\n"
        + rows(lambda k, s, t: f"{s:%d.%m.%Y %H:%M};{1500 + k:,}".replace(",", ".") + f";{comma(t)}"),
        "Leistung [W]", 1500.0, 1501.0,
    ),
    "Excel, thousands from 1000 on": (
        "Zeit;Leistung [W]\n" + rows(lambda k, s, t: f"{s:%d.%m.%Y %H:%M};{900 + k:,}".replace(",", ".")),
        "Leistung [W]", 900.0, 901.0,
    ),
    "TOA5": (
        '"TOA5","CR1000","CR1000","1234","CR1000.Std.31","CPU:p.CR1","5555","T1"\n'
        '"TIMESTAMP","RECORD","Air_Avg","WS"\n"TS","RN","Deg F","meters/second"\n"","","Avg","Smp"\n'
        + rows(lambda k, s, t: f'"{s:%Y-%m-%d %H:%M:%S}",{k},{t * 1.8 + 32:.3f},"NAN"'),
        "Air_Avg", 15.0, 15.218,
    ),
    "Testo, date and time apart": (
        '"Datum";"Zeit";"Kanal 1 [°C]"\n'
        + rows(lambda k, s, t: f"{s:%d.%m.%Y};{s:%H:%M:%S};{comma(t) if k % 50 != 7 else '----'}"),
        "Kanal 1 [°C]", 15.0, 15.22,
    ),
    "Hukseflux": (
        "Sensor: SR30-M2-D1\nSerial: 5556\n\nTimestamp (UTC+01:00),Irradiance (kW/m²)\n"
        + rows(lambda k, s, t: f"{s:%Y-%m-%dT%H:%M:%S},{t / 1000:.5f}"),
        "Irradiance (kW/m²)", 15.0, 15.22,
    ),
    "names of months": (
        "time;T\n" + rows(lambda k, s, t: f"{s:%d-%b-%Y %H:%M};{t:.2f}"), "T", 15.0, 15.22,
    ),
    "milliseconds": (
        "ts;T\n" + rows(lambda k, s, t: f"{(s.timestamp() - 3600.0) * 1000:.0f};{comma(t)}"),
        "T", 15.0, 15.22,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", VARIANTS)
def test_devices_and_locales(tmp_path: Path, name: str) -> None:
    text, column, first, second = VARIANTS[name]
    (tmp_path / "log.csv").write_text(text, encoding="utf-8")
    found = Measurements.from_table(tmp_path / "log.csv", timezone="UTC+1")
    assert (found.index[0].isoformat(), found.grid.interval) == ("2023-10-20T00:00:00+01:00", 600.0)
    assert len(found.data) == 432
    assert found.series(column).iloc[:2].tolist() == pytest.approx([first, second], abs=0.006)


# ---------------------------------------------------------------------- spreadsheets


def test_a_spreadsheet_is_read_as_its_table(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.title = "notes"
    sheet = book.create_sheet("log")
    sheet.append(["Logger 12", None, None, None])
    sheet.append(["Time", "T [°F]", "P [W]", "text"])
    for stamp, air in zip(STAMPS, AIR, strict=True):
        whole = 998 if stamp.minute else 1.523
        sheet.append([stamp.to_pydatetime(), air * 1.8 + 32.0, whole, f"{air:.1f}".replace(".", ",")])
    book.save(tmp_path / "log.xlsx")
    found = Measurements.from_table(tmp_path / "log.xlsx", timezone="UTC+1", columns=["T [°F]", "P [W]"])
    assert (len(found.data), found.grid.interval) == (432, 600.0)
    assert found.data["T [°F]"].to_numpy() == pytest.approx(AIR, abs=1e-9)
    assert found.data["P [W]"].iloc[:2].tolist() == [1.523, 998.0]
    with pytest.raises(InputError, match=r"column 'text', line 3: found '15,0', expected a number"):
        Measurements.from_table(tmp_path / "log.xlsx", timezone="UTC+1", columns=["text"])
    (tmp_path / "bad.xlsx").write_bytes(b"PK\x03\x04 no book")
    with pytest.raises(
        InputError, match=r"bad.xlsx: cannot be read as a spreadsheet .*save the sheet as CSV"
    ):
        Measurements.from_table(tmp_path / "bad.xlsx", timezone="UTC+1")
    openpyxl.Workbook().save(tmp_path / "empty.xlsx")
    with pytest.raises(InputError, match="no cell with content"):
        Measurements.from_table(tmp_path / "empty.xlsx", timezone="UTC+1")


def test_a_spreadsheet_without_the_package_names_both_ways(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    (tmp_path / "log.xlsx").write_bytes(b"PK")
    with pytest.raises(
        InputError, match=r"needs openpyxl: install mascarin\[xlsx\], or save the sheet as CSV"
    ):
        Measurements.from_table(tmp_path / "log.xlsx", timezone="UTC+1")


# ---------------------------------------------------------------------- the command line


def test_a_run_uses_the_units_of_the_file_and_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    heat = []
    for name in ("units_row_C.csv", "units_row_F.csv"):
        columns = ("air_temperature=AirT", "relative_humidity=RH", "wind_speed=Wind", "wind_direction=none")
        words = [word for text in (*columns, "global_horizontal=Slr") for word in ("--column", text)]
        code = cli.main(["run", str(FILES / "box_units.yaml"), "--weather", str(FILES / name), *words])
        printed = capsys.readouterr()
        assert code == 0, printed.err
        heat.append(
            float(next(row for row in printed.out.splitlines() if row.startswith("heating")).split()[1])
        )
        assert f"{name}: wind_speed: column 'Wind', " in printed.err
    assert heat == pytest.approx([87.8, 87.8], abs=0.1)


def test_the_unit_of_the_command_line_holds_only_where_it_is_forced(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def run(column: str) -> tuple[int, str]:
        columns = ("wind_speed=none", "wind_direction=none", "dew_point=none", "radiation=none", column)
        words = [word for text in columns for word in ("--column", text)]
        file = str(FILES / "units_row_F.csv")
        code = cli.main(
            ["run", str(FILES / "box_units.yaml"), "--weather", file, *words, "--end", "2023-03-03"]
        )
        return code, capsys.readouterr().err

    assert run("air_temperature=AirT [degF]")[0] == 0
    code, said = run("air_temperature=AirT [degC]")
    assert code == 2
    assert "row of units (line 2) says 'Deg F'" in said
    assert run("air_temperature=AirT [degC!]")[0] == 0


def test_a_measured_power_in_another_unit_than_the_building_takes_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path, "time,air,P [kW]", [10.0] * 72, [0.5] * 72)
    climate = weather(file, air_temperature="air")
    text = (FILES / "room.yaml").read_text(encoding="utf-8")
    measured = Measurements.from_table(file, timezone="UTC+1", columns=["P [kW]"])

    def room(gain: str) -> mc.Building:
        (tmp_path / "room.yaml").write_text(text.replace("{column: Leistung_W}", gain), encoding="utf-8")
        return mc.load(tmp_path / "room.yaml")

    watts = room("{column: 'P [kW]'}")
    options: dict[str, Any] = {"measurements": measured, "step": "1h", "end": "2023-03-02", "initial": 15.0}
    with pytest.raises(
        InputError, match=r"the file states the unit kW, but .* takes .* in W; .*Write unit: kW"
    ):
        mc.simulate(watts, climate, **options)
    kilowatts = room("{column: 'P [kW]', unit: kW}")
    assert mc.simulate(kilowatts, climate, **options).energy is not None
