"""Files as newcomers have them, by devices, services and locales that others of the tests lack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

Array = npt.NDArray[np.float64]
TIMES = pd.date_range("2023-07-13 00:00", periods=288, freq="10min")
HOURS = TIMES[::6]
_K = np.arange(288)
WARM = np.round(18.0 + 9.0 * np.sin(2.0 * np.pi * _K / 144.0), 2)
FAHRENHEIT = np.round(WARM * 1.8 + 32.0, 1)
HUMID = np.round(55.0 - 20.0 * np.sin(2.0 * np.pi * _K / 144.0), 1)
SUN = np.round(np.maximum(0.0, 800.0 * np.sin(2.0 * np.pi * (_K % 144 - 36) / 144.0)), 1)
WIND = np.round(3.0 + 2.0 * np.cos(2.0 * np.pi * _K / 50.0), 2)
PRESSURE = np.round(1013.2 + 3.0 * np.sin(_K / 30.0), 1)
HOURLY = np.round(WARM[::6], 1)


@dataclass(frozen=True)
class Strange:
    """A file, the columns that are read with their values and tolerances, and what a user states.

    `refused` are words of the refusal of a damaged file, or of one that contradicts itself; `remedy` is what
    it says, on the content or in the options.
    """

    content: bytes
    columns: dict[str, tuple[Array, float]]
    times: pd.DatetimeIndex = field(default_factory=lambda: TIMES)
    zone: str = "UTC"
    options: dict[str, Any] = field(default_factory=dict)
    refused: str = ""
    remedy: Callable[[bytes, dict[str, Any]], tuple[bytes, dict[str, Any]]] | None = None


FILES: dict[str, Strange] = {}


def _add(
    name: str,
    lines: Sequence[str],
    columns: dict[str, tuple[Array, float]],
    encoding: str = "utf-8",
    **given: Any,
) -> None:
    FILES[name] = Strange(("\n".join(lines) + "\n").encode(encoding), columns, **given)


def _rows(form: str, *columns: Array, mark: str = ",", comma: bool = False, times: Any = TIMES) -> list[str]:
    texts = [[f"{value:g}".replace(".", ",") if comma else f"{value:g}" for value in c] for c in columns]
    return [
        mark.join([t.strftime(form), *row]) for t, row in zip(times, zip(*texts, strict=True), strict=True)
    ]


def _without(line: int) -> Callable[[bytes, dict[str, Any]], tuple[bytes, dict[str, Any]]]:
    """The remedy is to remove a line, counted from 1; -1 is the last one."""

    def done(content: bytes, options: dict[str, Any]) -> tuple[bytes, dict[str, Any]]:
        lines = content.splitlines()
        lines.pop(line - 1 if line > 0 else line)
        return b"\n".join(lines) + b"\n", options

    return done


def _until(line: int) -> Callable[[bytes, dict[str, Any]], tuple[bytes, dict[str, Any]]]:
    """The remedy is to write the first table as a file of its own."""
    return lambda content, options: (b"\n".join(content.splitlines()[: line - 1]) + b"\n", options)


def _stating(**more: Any) -> Callable[[bytes, dict[str, Any]], tuple[bytes, dict[str, Any]]]:
    return lambda content, options: (content, {**options, **more})


# ---------------------------------------------------------------------- loggers

_TOA5 = '"TOA5","Roof","CR6","991","CR6.Std.11","CPU:x.CR6","1","Ten"'


def _toa5(names: str, units: str) -> list[str]:
    kinds = ",".join(['"Avg"'] * (names.count(",") - 1))
    return [_TOA5, names, units, f'"","",{kinds}']


_add(
    "toa5_units.dat",
    [
        *_toa5('"TIMESTAMP","RECORD","AirTF","Sun","BP","Wind"', '"TS","RN","degF","kW/m^2","mmHg","knots"'),
        *(
            f'"{t:%Y-%m-%d %H:%M:%S}",{k},{FAHRENHEIT[k]},{SUN[k] / 1000:.4f},{PRESSURE[k] / 1.333224:.2f},'
            f"{WIND[k] / 0.514444:.2f}"
            for k, t in enumerate(TIMES)
        ),
    ],
    {
        "AirTF": (WARM, 0.06),
        "Sun": (SUN, 0.1),
        "BP": (100.0 * PRESSURE, 2.0),
        "Wind": (WIND, 0.01),
    },
)
_DEGREES = _toa5('"TIMESTAMP","RECORD","AirT","RH"', '"TS","RN","Deg C","%"')
_SWAPPED = _toa5('"TIMESTAMP","RECORD","RH","AirT"', '"TS","RN","%","Deg C"')
_ONE = [f'"{t:%Y-%m-%d %H:%M:%S}",{k},{WARM[k]},{HUMID[k]}' for k, t in enumerate(TIMES)]
_TWO = [f'"{t:%Y-%m-%d %H:%M:%S}",{k},{HUMID[k]},{WARM[k]}' for k, t in enumerate(TIMES)]
_add(
    "toa5_exchanged.dat",
    [*_DEGREES, *_ONE[:140], *_SWAPPED, *_TWO[140:]],
    {"AirT": (WARM, 0.01), "RH": (HUMID, 0.1)},
    refused="a second table begins",
    remedy=_until(145),
)
_add(
    "toaci1.dat",
    ['"TOACI1","CR10X","Hourly"', '"TMSTAMP","RECNBR","AirT","RH"', *_ONE],
    {"AirT": (WARM, 0.01)},
)
_add(
    "hoboconnect.csv",
    [
        '"#","Date-Time (CET)","Ch: 1 - Temperature   (°F)"',
        *(f"{k + 1},{t:%m/%d/%Y %H:%M:%S},{FAHRENHEIT[k]}" for k, t in enumerate(TIMES)),
    ],
    {"Ch: 1 - Temperature   (°F)": (WARM, 0.06)},
    encoding="utf-8-sig",
)
_add(
    "hobo_de.csv",
    [
        "Plot Title: Büro",
        "#;Date;Time, GMT+02:00;Temp, °C(LGR S/N: 1);Host Connected",
        *(
            f"{k + 1};{t + pd.Timedelta('2h'):%d/%m/%Y;%H:%M:%S};{str(WARM[k]).replace('.', ',')};"
            for k, t in enumerate(TIMES)
        ),
    ],
    {"Temp, °C(LGR S/N: 1)": (WARM, 0.01)},
    encoding="cp1252",
    zone="Europe/Berlin",
)
_add(
    "testo_summary.csv",
    [
        "Testo 174H;;;", "Start;13.07.2023 00:00:00;;", "Min;9,0;35,0;", "Max;27,0;75,0;",
        "id;Datum/Uhrzeit;Temperatur[°C];Feuchte[%rF]",
        *(f"{k + 1};{row}"
          for k, row in enumerate(_rows("%d.%m.%Y %H:%M:%S", WARM, HUMID, mark=";", comma=True))),
    ],
    {"Temperatur[°C]": (WARM, 0.01)},
    encoding="cp1252",
)  # fmt: skip
_add(
    "testo_mean.csv",
    [
        "Date,Time,Temp [°F],Hum [%RH]",
        *_rows("%Y/%m/%d,%I:%M:%S %p", FAHRENHEIT, HUMID),
        "Average,,70.1,50.0",
    ],
    {"Temp [°F]": (WARM, 0.06)},
    refused="time 'Average' cannot be read",
    remedy=_without(-1),
)
_add(
    "ibutton_f.csv",
    ["1-Wire/iButton Part Number: DS1921G", "", "Date/Time,Unit,Value",
     *(f"{t:%m/%d/%y %I:%M:%S %p},F,{FAHRENHEIT[k]}" for k, t in enumerate(TIMES))],
    {"Value": (WARM, 0.06)},
)  # fmt: skip
_add(
    "ibutton_two_units.csv",
    ["Date/Time,Unit,Value",
     *(f"{t:%d/%m/%y %H:%M:%S},{'C' if k < 144 else 'F'},{WARM[k] if k < 144 else FAHRENHEIT[k]}"
       for k, t in enumerate(TIMES))],
    {"Value": (WARM, 0.01)},
    options={"time_format": "%d/%m/%y %H:%M:%S"},
    refused="has the units 'C' and 'F' for the rows of 'Value'",
    remedy=_until(146),
)  # fmt: skip
_add(
    "davis_12h.txt",
    ["\t\tTemp\tOut\tWind", "Date\tTime\tOut\tHum\tDir",
     *(f"{t:%m/%d/%y}\t{t.strftime('%I:%M %p').lstrip('0')[:-1].lower()}\t{WARM[k]}\t{HUMID[k]:.0f}\tNNW"
       for k, t in enumerate(TIMES))],
    {"Temp Out": (WARM, 0.01)},
)  # fmt: skip
_add(
    "ecowitt.csv",
    ["time,tempf,windspeedmph", *_rows("%Y-%m-%d %H:%M", FAHRENHEIT, WIND / 0.44704)],
    {"tempf": (WARM, 0.06), "windspeedmph": (WIND, 0.01)},
)

# ---------------------------------------------------------------------- clocks

_SECONDS = ((TIMES - pd.Timestamp("1970-01-01")) / pd.Timedelta("1s")).to_numpy()
_DAYS = ((TIMES - pd.Timestamp("1899-12-30")) / pd.Timedelta("1D")).to_numpy()
_add(
    "milliseconds.csv",
    ["timestamp;temp_C",
     *(f"{1000 * s:.0f};{v}".replace(".", ",") for s, v in zip(_SECONDS, WARM, strict=True))],
    {"temp_C": (WARM, 0.01)},
)  # fmt: skip
_add(
    "serial_comma.csv",
    ["Zeit;T °C", *(f"{d:.6f};{v}".replace(".", ",") for d, v in zip(_DAYS, WARM, strict=True))],
    {"T °C": (WARM, 0.01)},
)
_add(
    "half_a_clock.csv",
    ["date,time,T [degC]", *_rows("%Y-%m-%d,%I:%M", WARM)],
    {"T [degC]": (WARM, 0.01)},
    refused="the clock has 12 hours and no AM or PM",
    remedy=lambda content, options: (
        "\n".join(["date,time,T [degC]", *_rows("%Y-%m-%d,%H:%M", WARM)]).encode(),
        options,
    ),
)
_add(
    "spanish.csv",
    ["Fecha;Hora;Temperatura (°C)",
     *(f"{t:%d/%m/%Y};{t:%I:%M:%S} {'a. m.' if t.hour < 12 else 'p. m.'};{str(WARM[k]).replace('.', ',')}"
       for k, t in enumerate(TIMES))],
    {"Temperatura (°C)": (WARM, 0.01)},
    encoding="cp1252",
)  # fmt: skip
_add(
    "german_month.csv",
    ["Zeit;T (°C)",
     *(f"{t.day}. Juli 2023 {t:%H:%M};{str(WARM[k]).replace('.', ',')}" for k, t in enumerate(TIMES))],
    {"T (°C)": (WARM, 0.01)},
)  # fmt: skip
_add(
    "japanese.csv",
    ["日時,気温(℃)",
     *(f"{t.year}年{t.month}月{t.day}日 {t.hour}:{t.minute:02d},{WARM[k]}" for k, t in enumerate(TIMES))],
    {"気温(℃)": (WARM, 0.01)},
    encoding="shift_jis",
)  # fmt: skip
_add(
    "chinese.csv",
    ["时间,温度(℃)",
     *(f"{t.year}/{t.month}/{t.day} {t.hour}:{t.minute:02d},{WARM[k]}" for k, t in enumerate(TIMES))],
    {"温度(℃)": (WARM, 0.01)},
    encoding="gb18030",
)  # fmt: skip
_add(
    "russian.csv",
    ["Дата;Время;Т, °C", *_rows("%d.%m.%Y;%H:%M:%S", WARM, mark=";", comma=True)],
    {"Т, °C": (WARM, 0.01)},
    encoding="cp1251",
)
_add(
    "latest_first.csv",
    ["time,T (°C)", *reversed(_rows("%Y-%m-%d %H:%M", WARM))],
    {"T (°C)": (WARM, 0.01)},
)
_LATE = HOURS - pd.Timedelta("1h")
_add(
    "hours_to_24.csv",
    ["date,hour,T (°C)", *(f"{t:%Y-%m-%d},{t.hour + 1},{v:g}" for t, v in zip(_LATE, HOURLY, strict=True))],
    {"T (°C)": (HOURLY, 0.01)},
    times=HOURS,
)
_add(
    "dst_doubled.csv",
    ["time;T [°C]",
     *(f"{t.tz_localize('UTC').tz_convert('Europe/Berlin'):%d.%m.%Y %H:%M};{str(WARM[k]).replace('.', ',')}"
       for k, t in enumerate(pd.date_range('2023-10-28 12:00', periods=288, freq='10min')))],
    {"T [°C]": (WARM, 0.01)},
    times=pd.date_range("2023-10-28 12:00", periods=288, freq="10min"),
    zone="Europe/Berlin",
)  # fmt: skip

# ---------------------------------------------------------------------- units and marks

_add(
    "units_in_words.csv",
    ["# Units: T in Fahrenheit, G in kW/m2", "time,T,G", *_rows("%Y-%m-%d %H:%M", FAHRENHEIT, SUN / 1000.0)],
    {"T": (WARM, 0.06), "G": (SUN, 0.1)},
)
_add(
    "letter_of_a_unit.csv",
    ["time,T_F", *_rows("%Y-%m-%d %H:%M", FAHRENHEIT)],
    {"T_F": (WARM, 0.06)},
    refused="a name that may say degF",
    remedy=_stating(columns={"T_F": {"column": "T_F", "unit": "degF"}}),
)
_add(
    "two_units.csv",
    ["time,T [degC]", "-,degF", *_rows("%Y-%m-%d %H:%M", FAHRENHEIT)],
    {"T [degC]": (WARM, 0.06)},
    refused="whose name says 'degC'",
    remedy=_stating(columns={"T [degC]": {"column": "T [degC]", "unit": "degF", "overrule": True}}),
)
_add(
    "feet.csv",
    ["time,v (ft/min)", *_rows("%Y-%m-%d %H:%M", np.round(WIND / 0.00508, 1))],
    {"v (ft/min)": (WIND, 0.01)},
)
_add(
    "codes.csv",
    ["time,T (°C)", *_rows("%Y-%m-%d %H:%M", np.where(_K % 90 == 7, -999.0, WARM))],
    {"T (°C)": (np.where(_K % 90 == 7, np.nan, WARM), 0.01)},
)
_add(
    "fortran.csv",
    ["time,T (K)",
     *(f"{t:%Y-%m-%d %H:%M},{(WARM[k] + 273.15) / 1000:.5f}D+03" for k, t in enumerate(TIMES))],
    {"T (K)": (WARM, 0.011)},
)  # fmt: skip
_add(
    "swiss.csv",
    ["Zeit;P [Pa];T [°C]",
     *(f"{t:%d.%m.%y %H:%M};{100 * PRESSURE[k]:,.0f};{WARM[k]}".replace(",", "’")
       for k, t in enumerate(TIMES))],
    {"P [Pa]": (100.0 * PRESSURE, 0.6), "T [°C]": (WARM, 0.01)},
)  # fmt: skip
_add(
    "american.csv",
    ["Date,Pressure (hPa),T (°F)",
     *(f'{t.month}/{t.day}/{t.year} {t.hour}:{t.minute:02d},"{PRESSURE[k]:,.1f}",{FAHRENHEIT[k]}'
       for k, t in enumerate(TIMES))],
    {"Pressure (hPa)": (100.0 * PRESSURE, 0.1), "T (°F)": (WARM, 0.06)},
)  # fmt: skip
_add(
    "two_marks.csv",
    ["time;T [°C]", *_rows("%Y-%m-%d %H:%M", WARM[:100], mark=";", comma=True, times=TIMES[:100]),
     *_rows("%Y-%m-%d %H:%M", WARM[100:], mark=";", times=TIMES[100:])],
    {"T [°C]": (WARM, 0.01)},
    refused="whose marks contradict each other",
    remedy=lambda content, options: (content.replace(b",", b"."), options),
)  # fmt: skip

# ---------------------------------------------------------------------- services

_add(
    "open_meteo.csv",
    ["latitude,longitude,elevation,utc_offset_seconds,timezone", "52.5,13.4,38.0,7200,Europe/Berlin", "",
     "time,temperature_2m (°F)",
     *_rows("%Y-%m-%dT%H:%M", FAHRENHEIT[::6], times=HOURS + pd.Timedelta("2h"))],
    {"temperature_2m (°F)": (WARM[::6], 0.06)},
    times=HOURS,
    zone="Europe/Berlin",
)  # fmt: skip
_add(
    "nsrdb_standard_time.csv",
    ["Source,Location ID,Latitude,Longitude,Time Zone,Elevation,Local Time Zone",
     "NSRDB,1,39.7,-105.2,-7,1800,-7", "Year,Month,Day,Hour,Minute,Temperature",
     *_rows("%Y,%m,%d,%H,%M", WARM, times=TIMES - pd.Timedelta("7h"))],
    {"Temperature": (WARM, 0.01)},
    zone="America/Denver",
)  # fmt: skip
_add(
    "german_service.txt",
    ["STATIONS_ID;MESS_DATUM;QN_9;TT_TU;eor",
     *(f"        433;{t:%Y%m%d%H};    3;{-999 if k == 5 else HOURLY[k]:6.1f};eor"
       for k, t in enumerate(HOURS))],
    {"TT_TU": (np.where(np.arange(48) == 5, np.nan, HOURLY), 0.01)},
    times=HOURS,
)  # fmt: skip
_add(
    "dutch_service.txt",
    ["# FH = wind (in 0.1 m/s)", "# T = Temperature (in 0.1 degrees Celsius)", "",
     "# STN,YYYYMMDD,   HH,   FH,    T",
     "",
     *(f"  260,{t:%Y%m%d},{t.hour + 1:5d},{10 * WIND[6 * k]:5.0f},{10 * HOURLY[k]:5.0f}"
       for k, t in enumerate(_LATE))],
    {"T": (HOURLY, 0.01), "FH": (WIND[::6], 0.06)},
    times=HOURS,
)  # fmt: skip
_add(
    "american_service.csv",
    ['"STATION","DATE","TMP"',
     *(f'"72405013743","{t:%Y-%m-%dT%H:%M:%S}","{10 * HOURLY[k]:+05.0f},1"' for k, t in enumerate(HOURS))],
    {"TMP": (HOURLY, 0.01)},
    times=HOURS,
    refused="a number and a code of quality",
    remedy=lambda content, options: (
        "\n".join(["DATE,TMP", *_rows("%Y-%m-%dT%H:%M", HOURLY, times=HOURS)]).encode(), options),
)  # fmt: skip
_add(
    "home.csv",
    ["entity_id,state,last_changed",
     *(f"sensor.t,{'unavailable' if k == 9 else WARM[k]},{t:%Y-%m-%dT%H:%M:%S.000Z}"
       for k, t in enumerate(TIMES))],
    {"state": (np.where(_K == 9, np.nan, WARM), 0.01)},
    refused="found 'unavailable', expected a number",
    remedy=_stating(missing=["unavailable"]),
)  # fmt: skip
_add(
    "two_sensors.csv",
    ["time,sensor,T (°C)",
     *(f"{t:%Y-%m-%d %H:%M},{sensor},{WARM[k] + add:.2f}" for k, t in enumerate(TIMES)
       for sensor, add in (("A", 0.0), ("B", 5.0)))],
    {"T (°C)": (WARM, 0.01)},
    refused="column 'sensor' names several series",
    remedy=lambda content, options: (
        b"\n".join(line for line in content.splitlines() if b",B," not in line) + b"\n", options),
)  # fmt: skip
_add(
    "day_with_a_fraction.csv",
    [
        "year,doy,T_C",
        *(
            f"2023,{t.day_of_year + (t - t.normalize()) / pd.Timedelta('1D'):.5f},{WARM[k]}"
            for k, t in enumerate(TIMES)
        ),
    ],
    {"T_C": (WARM, 0.01)},
)

# ---------------------------------------------------------------------- slips

_add(
    "kelvins_called_celsius.csv",
    ["time,T (°C)", *_rows("%Y-%m-%d %H:%M", WARM + 273.15)],
    {"T (°C)": (WARM, 0.01)},
    refused="They look like K",
    remedy=_stating(columns={"T (°C)": {"column": "T (°C)", "unit": "K", "overrule": True}}),
)
_add(
    "clock_not_set.csv",
    ["time,T (°C)", "1970-01-01 00:00,20", "1970-01-01 00:10,20", *_rows("%Y-%m-%d %H:%M", WARM)],
    {"T (°C)": (WARM, 0.01)},
    refused="comes 54 years after 1970-01-01 00:10:00, expected one record",
    remedy=lambda content, options: (
        content.replace(b"1970-01-01 00:00,20\n1970-01-01 00:10,20\n", b""),
        options,
    ),
)
_add(
    "blanks.txt",
    ["date time T_degC", *_rows("%Y-%m-%d %H:%M", WARM, mark=" ")],
    {"T_degC": (WARM, 0.01)},
)
_add(
    "nanoseconds.csv",
    ["ts,T (K)", *(f"{1e9 * s:.0f},{v + 273.15:.2f}" for s, v in zip(_SECONDS, WARM, strict=True))],
    {"T (K)": (WARM, 0.01)},
)
