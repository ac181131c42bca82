"""Files of loggers, spreadsheets and data services, written by hand after the formats: three of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

#: Temperatures of two days in steps of ten minutes. [degC]
TIMES = pd.date_range("2023-07-13 00:00", periods=288, freq="10min")
TRUE = np.round(18.0 + 9.0 * np.sin(2.0 * np.pi * np.arange(288) / 144.0), 2)
HUMID = np.round(55.0 - 20.0 * np.sin(2.0 * np.pi * np.arange(288) / 144.0), 1)
FAHRENHEIT = np.round(TRUE * 1.8 + 32.0, 2)


@dataclass(frozen=True)
class File:
    """A file: its name, content, the column of the temperature, and options that a user has to state."""

    name: str
    content: bytes
    column: str
    options: dict[str, Any] = field(default_factory=dict)
    damaged: bool = False


def _rows(
    form: str, values: np.ndarray, separator: str, comma: bool, extra: Callable[[int], list[str]]
) -> list[str]:
    texts = [f"{value:.2f}".replace(".", ",") if comma else f"{value:.2f}" for value in values]
    return [
        separator.join([t.strftime(form), text, *extra(k)])
        for k, (t, text) in enumerate(zip(TIMES, texts, strict=True))
    ]


def _file(
    name: str,
    lines: list[str],
    column: str,
    *,
    encoding: str = "utf-8",
    damaged: bool = False,
    **options: Any,
) -> File:
    content = "\n".join(lines) + "\n"
    if encoding.endswith("crlf"):
        content, encoding = content.replace("\n", "\r\n"), encoding.removesuffix("-crlf")
    return File(name, content.encode(encoding), column, options, damaged)


def _damage(lines: list[str], row: int, text: str) -> list[str]:
    return [*lines[:row], text, *lines[row + 1 :]]


def toa5() -> list[File]:
    """Campbell TOA5."""

    def made(station: str, unit: str, values: np.ndarray) -> list[str]:
        head = [
            f'"TOA5","{station}","CR1000X","12345","CR1000X.Std.07.02","CPU:prog.CR1X","54321","Table1"',
            '"TIMESTAMP","RECORD","AirT_C_Avg","RH"',
            f'"TS","RN","{unit}","%"',
            '"","","Avg","Smp"',
        ]
        return head + [
            f'"{t:%Y-%m-%d %H:%M:%S}",{k},{v:.2f},{HUMID[k]}'
            for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
        ]

    good = made("A", "Deg C", TRUE)
    return [
        _file("toa5_c.dat", good, "AirT_C_Avg", encoding="utf-8-crlf"),
        _file(
            "toa5_f.dat",
            [line.replace("AirT_C_Avg", "AirT") for line in made("B", "Deg F", FAHRENHEIT)],
            "AirT",
        ),
        _file("toa5_cut.dat", _damage(good, 100, good[100][:12]), "AirT_C_Avg", damaged=True),
    ]


def cr10x() -> list[File]:
    """Campbell array data with names: year, day and hhmm, midnight as 2400."""

    def made(separator: str) -> list[str]:
        rows = []
        for t, v in zip(TIMES, TRUE, strict=True):
            late = t.hour == 0 and t.minute == 0
            day = (t - pd.Timedelta("1D")).day_of_year if late else t.day_of_year
            rows.append(
                separator.join(
                    ["2023", str(day), "2400" if late else str(100 * t.hour + t.minute), f"{v:.2f}"]
                )
            )
        return [separator.join(["Year", "Day", "HHMM", "AirT"]), *rows]

    good = made(",")
    return [
        _file("cr10x.dat", good, "AirT"),
        _file("cr10x_tab.dat", made("\t"), "AirT"),
        _file("cr10x_bad.dat", _damage(good, 50, "2023,194,9999,20.0"), "AirT", damaged=True),
    ]


def hoboware() -> list[File]:
    """HOBOware CSV with rows of events."""

    def made(zone: str, unit: str, values: np.ndarray, form: str, comma: bool) -> list[str]:
        mark = ";" if comma else ","
        head = [
            '"Plot Title: A"',
            mark.join(
                [
                    '"#"',
                    f'"Date Time, {zone}"',
                    f'"Temp, {unit} (LGR S/N: 1, SEN S/N: 1)"',
                    '"Stopped (LGR S/N: 1)"',
                ]
            ),
        ]
        rows = [
            f"{1 + k}{mark}{line}{mark}"
            for k, line in enumerate(_rows(form, values, mark, comma, lambda k: []))
        ]
        return [
            *head,
            *rows,
            f"{len(rows) + 1}{mark}{(TIMES[-1] + pd.Timedelta('253s')).strftime(form)}{mark}{mark}Logged",
        ]

    good = made("GMT+00:00", "°C", TRUE, "%m/%d/%y %I:%M:%S %p", False)
    return [
        _file(
            "hobo_us.csv",
            made("GMT+00:00", "°F", FAHRENHEIT, "%m/%d/%y %I:%M:%S %p", False),
            "Temp, °F (LGR S/N: 1, SEN S/N: 1)",
            encoding="utf-8-sig",
        ),
        _file(
            "hobo_de.csv",
            made("GMT+00:00", "°C", TRUE, "%d.%m.%y %H:%M:%S", True),
            "Temp, °C (LGR S/N: 1, SEN S/N: 1)",
        ),
        _file(
            "hobo_bad.csv",
            _damage(good, 30, good[30].replace(".", "?", 1)),
            "Temp, °C (LGR S/N: 1, SEN S/N: 1)",
            damaged=True,
        ),
    ]


def testo() -> list[File]:
    """Testo: date and time in two columns."""
    good = ["Datum;Zeit;T [°C]", *_rows("%d.%m.%Y;%H:%M:%S", TRUE, ";", True, lambda k: [])]
    return [
        _file("testo_de.csv", good, "T [°C]", encoding="utf-16"),
        _file(
            "testo_en.csv",
            ["Date,Time,T [°F]", *_rows("%d/%m/%Y,%H:%M:%S", FAHRENHEIT, ",", False, lambda k: [])],
            "T [°F]",
            encoding="cp1252",
        ),
        _file("testo_bad.csv", _damage(good, 77, "13.07.2023;12:40:00;Fehler 5"), "T [°C]", damaged=True),
    ]


def ibutton() -> list[File]:
    """Thermochron iButton: a long head, a column with the letter of the unit."""
    head = [
        "1-Wire/iButton Part Number: DS1922L",
        "1-Wire/iButton Registration Number: 1",
        "Is Mission Active?  true",
        "Sample Rate:  Every 600 second(s)",
        "Results:",
    ]

    def made(form: str, unit: str, values: np.ndarray) -> list[str]:
        return [
            *head,
            "Date/Time,Unit,Value",
            *[f"{t.strftime(form)},{unit},{v:.2f}" for t, v in zip(TIMES, values, strict=True)],
        ]

    good = made("%d/%m/%y %I:%M:%S %p", "C", TRUE)
    return [
        _file("ibutton.csv", good, "Value"),
        _file("ibutton_us.csv", made("%m/%d/%y %I:%M:%S %p", "C", TRUE), "Value"),
        _file("ibutton_bad.csv", _damage(good, 40, "13/07/23 05:50:00 AM,C"), "Value", damaged=True),
    ]


def weatherlink() -> list[File]:
    """Davis WeatherLink: names in two lines."""

    def made(form: str, values: np.ndarray, gap: int | None = None) -> list[str]:
        rows = [
            f"{t.strftime(form)}\t{'---' if k == gap else format(v, '.2f')}\t{HUMID[k]}"
            for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
        ]
        return ["\t\tTemp\tOut", "Date\tTime\tOut\tHum", *rows]

    good = made("%d.%m.%y\t%H:%M", TRUE)
    return [
        _file("davis.txt", good, "Temp Out"),
        _file("davis_12h.txt", made("%m/%d/%y\t%I:%M %p", TRUE, gap=12), "Temp Out"),
        _file("davis_bad.txt", _damage(good, 20, good[20] + "\t17\t3"), "Temp Out", damaged=True),
    ]


def spreadsheet() -> list[File]:
    """CSV of spreadsheets."""
    good = ["Zeit;T °C", *_rows("%d.%m.%Y %H:%M", TRUE, ";", True, lambda k: [])]
    return [
        _file("excel_de.csv", good, "T °C", encoding="cp1252"),
        _file(
            "excel_us.csv",
            ["Time,T degF", *_rows("%m/%d/%Y %H:%M", FAHRENHEIT, ",", False, lambda k: [])],
            "T degF",
        ),
        _file("excel_bad.csv", _damage(good, 60, "13.07.2023 09:50;#WERT!"), "T °C", damaged=True),
    ]


def numbers_of_time() -> list[File]:
    """Seconds and milliseconds since 1970, days of a spreadsheet."""
    seconds = (TIMES - pd.Timestamp("1970-01-01")) / pd.Timedelta("1s")
    days = (TIMES - pd.Timestamp("1899-12-30")) / pd.Timedelta("1D")
    return [
        _file(
            "epoch.csv",
            ["ts,T_degC", *[f"{s:.0f},{v:.2f}" for s, v in zip(seconds, TRUE, strict=True)]],
            "T_degC",
        ),
        _file(
            "serial.csv",
            ["time,T_degC", *[f"{d:.9f},{v:.2f}" for d, v in zip(days, TRUE, strict=True)]],
            "T_degC",
        ),
        _file(
            "epoch_bad.csv",
            [
                "ts,T_degC",
                *[
                    f"{1000 * s if k == 9 else s:.0f},{v:.2f}"
                    for k, (s, v) in enumerate(zip(seconds, TRUE, strict=True))
                ],
            ],
            "T_degC",
            damaged=True,
        ),
    ]


def hukseflux() -> list[File]:
    """Single-logger CSV with units in brackets (heat flux and temperature)."""

    def made(mark: str, form: str, comma: bool) -> list[str]:
        def flux(k: int) -> list[str]:
            return [f"{3.5 + 0.01 * k:.2f}".replace(".", ",") if comma else f"{3.5 + 0.01 * k:.2f}"]

        return [
            "# logger 1",
            mark.join(["Date", "T1 (°C)", "Flux1 (W/m²)"]),
            *_rows(form, TRUE, mark, comma, flux),
        ]

    good = made(",", "%Y-%m-%dT%H:%M:%S", False)
    return [
        _file("flux.csv", good, "T1 (°C)"),
        _file("flux_fr.csv", made(";", "%d/%m/%Y %H:%M", True), "T1 (°C)", encoding="latin-1"),
        _file("flux_bad.csv", [*good[:90], *good[91:120], good[119], *good[120:]], "T1 (°C)", damaged=True),
    ]


def services() -> list[File]:
    """Data services: NSRDB, PVGIS, Meteo-France."""
    nsrdb = [
        "Source,Location ID,Latitude,Longitude,Time Zone",
        "NSRDB,1,45.0,5.0,0",
        "Year,Month,Day,Hour,Minute,Temperature",
        *[
            f"{t.year},{t.month},{t.day},{t.hour},{t.minute},{v:.2f}"
            for t, v in zip(TIMES, TRUE, strict=True)
        ],
    ]
    hours = slice(None, None, 6)
    pvgis = [
        "Latitude (decimal degrees):\t45.000",
        "Longitude (decimal degrees):\t5.000",
        "",
        "time,T2m",
        *[f"{t:%Y%m%d:%H%M},{v:.2f}" for t, v in zip(TIMES[hours], TRUE[hours], strict=True)],
        "",
        "T2m: 2-m air temperature (degree Celsius)",
        "PVGIS (c) European Communities, 2001-2022",
    ]
    french = [
        "POSTE;DATE;T",
        *[
            f"97418110;{t:%Y%m%d%H};{str(v).replace('.', ',')}"
            for t, v in zip(TIMES[hours], TRUE[hours], strict=True)
        ],
    ]
    return [
        _file("nsrdb.csv", nsrdb, "Temperature"),
        _file("pvgis.csv", pvgis, "T2m"),
        _file(
            "meteo_bad.csv",
            _damage(french, 20, french[20].replace("2023", "2O23", 1)),
            "T",
            damaged=True,
            time="DATE",
        ),
    ]


ALL = {
    maker.__name__: maker
    for maker in (
        toa5,
        cr10x,
        hoboware,
        testo,
        ibutton,
        weatherlink,
        spreadsheet,
        numbers_of_time,
        hukseflux,
        services,
    )
}


def write(file: File, folder: Path) -> Path:
    path = folder / file.name
    path.write_bytes(file.content)
    return path
