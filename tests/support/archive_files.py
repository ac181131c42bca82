"""Files of further loggers, stations and archives, written by hand after their formats: three of each."""

# ruff: noqa: E501 (rows as they stand in files)

from __future__ import annotations

import gzip
from typing import Any

import numpy as np
import xarray as xr

from logger_files import FAHRENHEIT, HUMID, TIMES, TRUE, File

HOURS = slice(None, None, 6)
STATION = "01001001"


def text(name: str, lines: list[str], column: str, *, damaged: bool = False, **options: Any) -> File:
    return File(name, ("\n".join(lines) + "\n").encode(), column, options, damaged)


def meteo_france() -> list[File]:
    """Hourly data of stations: codes of quality beside each number, UTC."""
    names = [
        "NUM_POSTE",
        "NOM_USUEL",
        "LAT",
        "LON",
        "ALTI",
        "AAAAMMJJHH",
        "RR1",
        "QRR1",
        "T",
        "QT",
        "GLO",
        "QGLO",
    ]

    def made(station: str) -> list[str]:
        return [
            ";".join([station, "PLAINE", "45.100000", "5.200000", "210", f"{t:%Y%m%d%H}", "0.0", "1",
                      f"{v:.2f}", "1", str(100 + 2 * k), "9"])
            for k, (t, v) in enumerate(zip(TIMES[HOURS], TRUE[HOURS], strict=True))
        ]  # fmt: skip

    good = [";".join(names), *made(STATION)]
    packed = gzip.compress(("\n".join(good) + "\n").encode())
    return [
        text("H_01_latest.csv", good, "T"),
        File("H_01_latest.csv.gz", packed, "T"),
        text("H_01_two.csv", [*good, *made("01002002")], "T", damaged=True),
    ]


def bsrn(minutes: int = 240) -> str:
    """A station-to-archive file: records 0001, 0004 and 0100; the temperature rises by 0.1 K in 6 min."""
    lines = ["*U0001", " 21  7 2023  1", "*U0003", "XXX", "*U0004", " 1  1  0", "  2  2", "a street", "1".ljust(20) + "1", "1".ljust(15) + "a@b",
             " 136.800 187.000  500 06610", " 1  1  0", "   0  1  90  2 180  3 270  2  -1 -1", "*U0100"]  # fmt: skip
    for k in range(minutes):
        day, minute = 1 + k // 1440, k % 1440
        lines.append(f" {day:2d} {minute:4d}   {k:4d} {1.0:5.1f} {k - 1:4d} {k + 1:4d}   "
                     f"{-999:4d} {-99.9:5.1f} {-999:4d} {-999:4d}")  # fmt: skip
        lines.append(f"           {90:4d} {1.0:5.1f} {89:4d} {91:4d}   {330:4d} {0.5:5.1f} {329:4d} {331:4d}    "
                     f"{15.0 + 0.1 * (k // 6):5.1f} {50.0:5.1f} {955:4d}")  # fmt: skip
    return "\n".join(lines) + "\n"


def netatmo() -> list[File]:
    """Epochs beside local stamps."""

    def made(mark: str) -> list[str]:
        return [
            mark.join(["Timestamp", '"Timezone : UTC"', "Temperature"]),
            *[
                mark.join([f"{t.timestamp():.0f}", f'"{t:%Y/%m/%d %H:%M:%S}"', f"{v:.2f}"])
                for t, v in zip(TIMES, TRUE, strict=True)
            ],
        ]

    good = made(";")
    return [
        text("netatmo.csv", good, "Temperature"),
        text("netatmo_comma.csv", made(","), "Temperature"),
        text(
            "netatmo_bad.csv",
            [*good[:50], good[50].replace("16", "61", 1), *good[51:]],
            "Temperature",
            damaged=True,
        ),
    ]


def dwd() -> list[File]:
    """German weather service: -999 where there is no value, rows that end with eor."""

    def made(missing: int | None, form: str = "%Y%m%d%H%M") -> list[str]:
        return [
            "STATIONS_ID;MESS_DATUM;QN;TT_10;RF_10;eor",
            *[
                f"       1234;{t.strftime(form)};    3;  {'-999' if k == missing else format(v, '.2f')};  {HUMID[k]};eor"
                for k, (t, v) in enumerate(zip(TIMES, TRUE, strict=True))
            ],
        ]

    good = made(None)
    options: dict[str, Any] = {"time": "MESS_DATUM", "columns": ["TT_10", "RF_10"]}
    return [
        text("produkt_zehn_min.txt", good, "TT_10", **options),
        text("produkt_gap.txt", made(17), "TT_10", missing=[-999], **options),
        text("produkt_cut.txt", [*good[:200], good[200][:22]], "TT_10", damaged=True, **options),
    ]


def lascar() -> list[File]:
    """EL-USB: rows counted, the serial number in the first row."""

    def made(form: str, unit: str, values: np.ndarray) -> list[str]:
        return [
            f"EL-USB-2,Time,{unit},Humidity(%rh),Serial Number",
            *[
                f"{k + 1},{t.strftime(form)},{v:.2f},{HUMID[k]}" + (",000012345" if k == 0 else ",")
                for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
            ],
        ]

    good = made("%d/%m/%Y %H:%M:%S", "Celsius(°C)", TRUE)
    return [
        text("elusb.txt", good, "Celsius(°C)"),
        text("elusb_us.txt", made("%m/%d/%Y %H:%M:%S", "Fahrenheit(°F)", FAHRENHEIT), "Fahrenheit(°F)"),
        text("elusb_bad.txt", [*good[:80], good[80].replace("/2023", "/20", 1), *good[81:]], "Celsius(°C)",
             damaged=True),
    ]  # fmt: skip


def tinytag() -> list[File]:
    """Tinytag Explorer: several lines above the names, a unit behind each number."""

    def made(unit: str, values: np.ndarray) -> list[str]:
        return [
            "Serial No,,123456,123456", "Description,,Room,Room", "Property,,Temperature,Humidity",
            "Minimum Reading,,9 °C,35 %RH", "", "Record Number,Time,Temperature,Humidity",
            *[
                f"{k + 1},{t:%d %b %Y %H:%M:%S},{v:.2f} {unit},{HUMID[k]} %RH"
                for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
            ],
        ]  # fmt: skip

    good = made("°C", TRUE)
    return [
        text("tinytag.csv", good, "Temperature"),
        text("tinytag_f.csv", made("°F", FAHRENHEIT), "Temperature"),
        text(
            "tinytag_bad.csv",
            [*good[:60], good[60].replace("°C", "°F", 1), *good[61:]],
            "Temperature",
            damaged=True,
        ),
    ]


def ecowitt() -> list[File]:
    """Ecowitt: names in two lines, the unit with a sign of its own."""

    def made(unit: str, values: np.ndarray) -> list[str]:
        return [
            f"Time,Outdoor Temperature({unit}),Outdoor Humidity(%)",
            *[
                f"{t:%Y/%m/%d %H:%M},{v:.2f},{HUMID[k]}"
                for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
            ],
        ]

    good = made("℃", TRUE)
    return [
        text("ecowitt.csv", good, "Outdoor Temperature(℃)"),
        text("ecowitt_us.csv", made("℉", FAHRENHEIT), "Outdoor Temperature(℉)"),
        text("ecowitt_bad.csv", [*good[:60], good[60].replace(".", "..", 1), *good[61:]], "Outdoor Temperature(℃)",
             damaged=True),
    ]  # fmt: skip


def govee() -> list[File]:
    """Govee and SensorPush: a sentence as the name of the time."""

    def made(name: str, form: str, values: np.ndarray) -> list[str]:
        return [
            f"Timestamp for sample frequency every 10 min min,{name},Relative_Humidity",
            *[
                f"{t.strftime(form)},{v:.2f},{HUMID[k]}"
                for k, (t, v) in enumerate(zip(TIMES, values, strict=True))
            ],
        ]

    good = made("Temperature_Celsius", "%Y-%m-%d %H:%M:%S", TRUE)
    return [
        text("govee.csv", good, "Temperature_Celsius"),
        text("govee_us.csv", made("Temperature_Fahrenheit", "%Y-%m-%d %H:%M:%S", FAHRENHEIT), "Temperature_Fahrenheit"),
        text("govee_bad.csv", [*good[:10], good[10].replace(":", ".", 1), *good[11:]], "Temperature_Celsius",
             damaged=True),
    ]  # fmt: skip


def era5() -> list[File]:
    """Reanalysis as NetCDF: Kelvin, a place that has one latitude and longitude, a time of another name."""

    def made(time: str, **also: Any) -> bytes:
        values = (TRUE[HOURS] + 273.15)[:, None, None]
        data = xr.Dataset(
            {"t2m": ((time, "latitude", "longitude"), values, {"units": "K"})},
            {time: TIMES[HOURS], "latitude": [45.0], "longitude": [5.0], **also},
        )
        return bytes(data.to_netcdf(engine="scipy"))

    return [
        File("era5.nc", made("time"), "t2m"),
        File("era5_new.nc", made("valid_time", number=0), "t2m"),
        File("era5_cut.nc", made("time")[:700], "t2m", damaged=True),
    ]


def surfrad() -> list[File]:
    """A table without names of its own kind: SURFRAD-like rows with year, day, hour and minute."""
    head = "Year,Month,Day,Hour,Minute,Second,temp"

    def made(mark: str) -> list[str]:
        return [
            head.replace(",", mark),
            *[
                mark.join(
                    [t.strftime("%Y"), str(t.month), str(t.day), str(t.hour), str(t.minute), "0", f"{v:.2f}"]
                )
                for t, v in zip(TIMES, TRUE, strict=True)
            ],
        ]

    good = made(",")
    return [
        text("parts.csv", good, "temp"),
        text("parts.txt", made("\t"), "temp"),
        text("parts_bad.csv", [*good[:9], good[9].replace("2023", "0", 1), *good[10:]], "temp", damaged=True),
    ]


def knots() -> list[File]:
    """Rows in reverse, the newest first, as cloud services export them."""

    def made(form: str) -> list[str]:
        return [
            "time,T [degC]",
            *[f"{t.strftime(form)},{v:.2f}" for t, v in zip(TIMES, TRUE, strict=True)][::-1],
        ]

    good = ["time,T [degC]", *made("%Y-%m-%dT%H:%M:%SZ")[:0:-1]]
    return [
        text("zulu.csv", good, "T [degC]"),
        text("offset.csv", [line.replace("Z,", "+00:00,") for line in good], "T [degC]"),
        text("reverse.csv", made("%Y-%m-%d %H:%M"), "T [degC]", damaged=True),
    ]


ALL = {
    maker.__name__: maker
    for maker in (meteo_france, netatmo, dwd, lascar, tinytag, ecowitt, govee, era5, surfrad, knots)
}
