"""A judge of refusals of tables: each names file, line, column, entry, and its remedy works on that file."""

# ruff: noqa: E501 (a case is a row)

from __future__ import annotations

import ast
import re
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from archive_files import bsrn
from mascarin import Climate, Measurements
from mascarin.errors import InputError
from mascarin.tables import reading, stamps

Options = dict[str, Any]
Remedy = Callable[[list[str], Options], tuple[list[str], Options]]


def stated(**options: Any) -> Remedy:
    """The remedy is an option."""
    return lambda lines, given: (lines, {**given, **options})


def repaired(line: int, text: str | None) -> Remedy:
    """The remedy is another line, or none, in the place of one."""
    return lambda lines, given: (
        [*lines[: line - 1], *([] if text is None else [text]), *lines[line:]], given
    )  # fmt: skip


@dataclass(frozen=True)
class Case:
    """A file that is refused, what its refusal names, and the remedy, tried on this very file."""

    lines: list[str]
    remedy: Remedy
    line: int | None = None
    column: str | None = None
    entry: str | None = None
    says: str = ""
    options: Options = field(default_factory=dict)
    name: str = "logger.csv"
    cut: bool = False
    climate: bool = False


INFLUX = [
    ",result,table,_time,_value,_field,_measurement",
    *(f",,0,2024-01-01T00:{10 * k:02d}:00Z,{20.0 + k},air,lab" for k in (0, 2, 1)),
]


def rows(count: int = 6, form: str = "%Y-%m-%d %H:%M", value: str = "{:.2f}", mark: str = ",") -> list[str]:
    times = pd.date_range("2023-07-13 10:00", periods=count, freq="10min")
    return [mark.join([t.strftime(form), value.format(20.0 + 0.25 * k)]) for k, t in enumerate(times)]


GOOD = ["time,T", *rows()]
NEXT_DAYS = ["time,T", *(f"0{k}/07/2023 00:00,{20 + k}.5" for k in range(1, 8))]

CASES = {
    "word among numbers": Case(
        [*GOOD[:3], "2023-07-13 10:20,defect", *GOOD[4:]], stated(missing=["defect"]), 4, "T", "defect"),
    "infinite": Case([*GOOD[:3], "2023-07-13 10:20,inf", *GOOD[4:]], repaired(4, "2023-07-13 10:20,20.5"), 4, "T"),
    "two marks": Case(
        ["time;T", *rows(3, mark=";"), "2023-07-13 10:30;20,75", "2023-07-13 10:40;21,0"],
        lambda lines, given: ([line.replace(",", ".") for line in lines], given), 2, "T", "20.00",
        says="20,75"),
    "thousands or decimals": Case(
        ["time;P", *(f"{t};{v}" for t, v in zip([r.split(",")[0] for r in rows(5)],
                                              ["1.250", "1100", "1.300", "990", "1.400"], strict=True))],
        stated(decimal=","), 2, "P", "1.250", options={}),
    "impossible stamp": Case(
        [*GOOD[:3], "2023-13-13 10:20,20.5", *GOOD[4:]], repaired(4, GOOD[3]), 4, None, "2023-13-13 10:20"),
    "stamps of another form": Case(
        ["time,T", *rows(form="%Hh%M on %d of %m %Y")], stated(time_format="%Hh%M on %d of %m %Y"), 2, None,
        "10h00 on 13 of 07 2023"),
    "unknown format": Case(GOOD, lambda lines, given: (lines, {}), None, None, "%Q", options={"time_format": "%Q"}),
    "year 23": Case([*GOOD[:3], "0023-07-13 10:20,20.5", *GOOD[4:]], repaired(4, GOOD[3]), 4, None, "23"),
    "numbers that are no times": Case(
        ["n,stamp,T", *(f"{3 * k * k},{r}" for k, r in enumerate(rows()))], stated(time="stamp"), 2, None, "0"),
    "day or month": Case(
        ["time,T", *(f"03/04/2023 {k:02d}:00,{20 + k}.5" for k in range(6))],
        stated(time_format="%d/%m/%Y %H:%M"), 2, None, "03/04/2023 00:00"),
    "day and month exchanged": Case(
        NEXT_DAYS, stated(time_format="%d/%m/%Y %H:%M"), 3, None, "%m/%d/%Y %H:%M",
        options={"time_format": "%m/%d/%Y %H:%M"}),
    "another zone": Case(
        ['"Date Time, GMT-05:00",T', *rows()], stated(timezone="UTC-5"), None, "Date Time, GMT-05:00", "Europe/Paris",
        options={"timezone": "Europe/Paris"}),
    "more entries than names": Case([GOOD[0], *(line + ",7" for line in GOOD[1:])],
                                    lambda lines, given: (["time,T,n", *lines[1:]], given), 2),
    "a longer line": Case([*GOOD[:3], GOOD[3] + ",7", *GOOD[4:]], repaired(4, GOOD[3]), 4),
    "cut": Case([*GOOD, "2023-07-13"], repaired(8, None), 8, None, "2023-07-13", cut=True),
    "no names": Case(GOOD[1:], lambda lines, given: (["time,T", *lines], given), 1, None, GOOD[1]),
    "no separator": Case(
        ["time T", *(r.replace(",", "") for r in rows())],
        lambda lines, given: (["time,T", *rows()], given), 1, None, None),
    "unknown column": Case(GOOD, stated(columns=["T"]), None, "Temp", None, options={"columns": ["Temp"]}),
    "unknown time column": Case(GOOD, stated(time="time"), None, "stamp", None, options={"time": "stamp"}),
    "one row": Case(GOOD[:2], lambda lines, given: (GOOD, given), None, None, "1 rows"),
    "off the grid": Case(
        [*GOOD[:3], "2023-07-13 10:23,20.5", *GOOD[4:]], stated(tolerance="4min", step="10min"), 4, None,
        "2023-07-13 10:23"),
    "a row twice": Case([*GOOD[:4], *GOOD[3:]], repaired(5, None), 5, None, "2023-07-13 10:20"),
    "not in order": Case([*GOOD[:2], GOOD[3], GOOD[2], *GOOD[4:]], repaired(4, None), 4, None, "2023-07-13 10:10"),
    "units contradict": Case(
        ["time,T [degF]", ",degC", *rows()], stated(columns={"T": {"column": "T [degF]", "unit": "degF",
                                                                    "overrule": True}}), 2, "T [degF]", "degC",
        options={"columns": {"T": "T [degF]"}}),
    "another unit than the file": Case(
        ["time,T [degF]", *rows()], stated(columns={"T": "T [degF]"}), None, "T [degF]", "degC",
        options={"columns": {"T": {"column": "T [degF]", "unit": "degC"}}}),
    "a scale beside a unit": Case(
        ["time,T [degF]", *rows()], stated(columns={"T": "T [degF]"}), None, "T [degF]", "0.5",
        options={"columns": {"T": {"column": "T [degF]", "scale": 0.5}}}),
    "no zone": Case(GOOD, stated(timezone="UTC"), None, None, "None", options={"timezone": None}),
    "unknown zone": Case(GOOD, stated(timezone="Europe/Paris"), None, None, "Europe/Pari",
                         options={"timezone": "Europe/Pari"}),
    "no mean of it": Case(GOOD, stated(mean=["T"]), None, "G", None, options={"mean": ["G"]}),
    "stamps of the middle": Case(GOOD, stated(stamps="end"), None, None, "middle", options={"stamps": "middle"}),
    "two stations": Case(
        ["NUM_POSTE;NOM_USUEL;LAT;LON;ALTI;AAAAMMJJHH;T;QT",
         *(f"{s};A;45.0;5.0;9;20230713{h:02d};{20 + h}.5;1" for s in (1001, 1002) for h in range(5))],
        lambda lines, given: ([line for line in lines if not line.startswith("1002")], given), None, "NUM_POSTE",
        "1001"),
    "a cut archive": Case(bsrn(20).splitlines()[:41], lambda lines, given: (bsrn(20).splitlines(), given), 41,
                          name="station.dat"),
    "an archive without irradiance": Case(
        bsrn(20).replace("*U0100", "*U0300").splitlines(),
        lambda lines, given: (bsrn(20).splitlines(), given), None, None, "0300", name="station.dat"),
    "a series with two values": Case(
        [*INFLUX, INFLUX[-1].replace("21.0", "23.0")], repaired(5, None), 5, "air", "2024-01-01T00:10:00Z"),
    "series without times": Case(
        [INFLUX[0].replace("_time", "when"), *INFLUX[1:]], repaired(1, INFLUX[0]), 1, None, "when"),
}  # fmt: skip


def refused(case: Case, path: Path) -> tuple[str, set[tuple[str, str]]]:
    """The text of a refusal, and file and function that raise it."""
    path.write_text("\n".join(case.lines) + ("" if case.cut else "\n"))
    with pytest.raises(InputError) as caught:
        Measurements.from_table(path, **{"timezone": "UTC", **case.options})
    frame = traceback.extract_tb(caught.value.__traceback__)[-1]
    return str(caught.value), {(Path(frame.filename).name, frame.name)}


def judged(text: str, case: Case, path: Path) -> list[str]:
    """What a refusal lacks."""
    lacking = []
    where = text.split(": ")[0]
    if path.name not in where and not where.startswith(("step", "timezone")):
        lacking.append(f"the file {path.name}")
    if case.line is not None and f":{case.line}:" not in text and f"line {case.line}" not in text:
        lacking.append(f"line {case.line}")
    lacking += [word for word in (case.column, case.entry) if word is not None and word not in text]
    if "xpected" not in text and "ISO 8601" not in text and "required" not in text:
        lacking.append("what was expected")
    if case.says not in text:
        lacking.append(case.says)
    plain = re.sub("'[^']*'", "x", text)
    if "  " in plain or text.rstrip(". ").endswith((":", ",")):
        lacking.append("an end of its sentence")
    return lacking


@pytest.mark.parametrize("kind", CASES)
def test_a_refusal_names_what_it_is_about_and_its_remedy_works(kind: str, tmp_path: Path) -> None:
    case = CASES[kind]
    path = tmp_path / case.name
    text, _ = refused(case, path)
    assert judged(text, case, path) == [], text
    lines, options = case.remedy(case.lines, case.options)
    path.write_text("\n".join(lines) + "\n")
    read = Measurements.from_table(path, **{"timezone": "UTC", **options})
    values = read.data.to_numpy()
    assert np.isfinite(values).any()
    assert len(read.data) >= 2


#: Functions of `tables.reading` and `tables.stamps` whose refusals other tests try, with the name of the file of the test.
ELSEWHERE = {
    ("records.py", "_require_settled_letter"): "test_tables_strange.py",
    ("records.py", "_require_celsius"): "test_tables_strange.py",
    ("order.py", "_require_one_record"): "test_tables_strange.py",
    ("units_of_entries.py", "units_beside"): "test_tables_strange.py",
    ("archives.py", "unpacked"): "test_tables_archives.py",
    ("files.py", "content_of"): "test_weather_table.py",
    ("files.py", "_parquet"): "test_tables_formats.py",
    ("layout.py", "decoded"): "test_weather_layout.py",
    ("own_readers.py", "register_reader"): "test_tables_formats.py",
    ("own_readers.py", "reader_of"): "test_tables_formats.py",
    ("own_readers.py", "read_own"): "test_tables_formats.py",
    ("own_readers.py", "_loaded"): "test_tables_formats.py",
    ("own_readers.py", "_netcdf"): "test_tables_formats.py",
    ("spreadsheets.py", "sheet_text"): "test_tables_formats.py",
}


def test_every_refusal_of_the_reader_was_judged(tmp_path: Path) -> None:
    """Each function of the reader that refuses is reached by a case above, or named with its own test."""
    folders = [Path(str(package.__file__)).parent for package in (reading, stamps)]
    refusing = set()
    for module in sorted(path for folder in folders for path in folder.glob("*.py")):
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and any(
                isinstance(inner, ast.Raise)
                and isinstance(inner.exc, ast.Call)
                and isinstance(inner.exc.func, ast.Name)
                and inner.exc.func.id == "InputError"
                for inner in ast.walk(node)
            ):
                refusing.add((module.name, node.name))
    reached = set()
    for case in CASES.values():
        reached |= refused(case, tmp_path / case.name)[1]
    assert refusing - reached - set(ELSEWHERE) == set()
    assert set(ELSEWHERE) <= refusing, "remove what does not refuse any more"
    tests = Path(__file__).parents[2]
    assert {path.name for path in tests.rglob("test_*.py")} >= set(ELSEWHERE.values())


def test_a_channel_that_is_missing_is_refused_with_a_remedy(tmp_path: Path) -> None:
    """The refusals of weather: a missing channel, an unlikely unit, a value that no weather has."""
    path = tmp_path / "logger.csv"
    path.write_text("\n".join(["time,T,v", *(f"{line},{2.0 + k}" for k, line in enumerate(rows(12)))]) + "\n")
    options: Options = {"timezone": "UTC", "columns": {"air_temperature": "T"}}
    with pytest.raises(InputError, match=r"logger\.csv: no column for dew_point.*absent: \["):
        Climate.from_table(path, **options)
    absent = ["radiation", "dew_point", "wind_speed", "wind_direction"]
    assert len(Climate.from_table(path, **options, absent=absent).data) == 12
