"""Tables as loggers and spreadsheets write them: encodings, separators, decimal commas, lines above names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mascarin import Measurements
from mascarin.errors import InputError
from mascarin.tables.reading.table import read_table

STAMPS = ["2024-09-04 00:00", "2024-09-04 00:15", "2024-09-04 00:30", "2024-09-04 00:45"]


def table(
    separator: str = ";", decimal: str = ".", head: str = "", names: str = "Zeit;Süd °C;G [W/m²]"
) -> str:
    rows = [names.replace(";", separator)]
    for k, stamp in enumerate(STAMPS):
        rows.append(separator.join([stamp, f"{20 + k / 8:.3f}".replace(".", decimal), f"{10 * k}"]))
    return head + "\n".join(rows) + "\n"


def read(folder: Path, text: str | bytes, **options: object) -> Measurements:
    path = folder / "logger.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return Measurements.from_table(path, timezone="UTC+1", **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1"]
)
def test_names_with_degree_signs_in_any_encoding(tmp_path: Path, encoding: str) -> None:
    found = read(tmp_path, table().encode(encoding))
    assert list(found.data.columns) == ["Süd °C", "G [W/m²]"]
    assert found.data["Süd °C"].tolist() == [20.0, 20.125, 20.25, 20.375]
    said = [note for note in found.provenance if "read as" in note]
    assert len(said) == (not encoding.startswith("utf-8"))


def test_a_spreadsheet_is_no_table(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"logger.csv: found bytes that are no text.*saved as CSV"):
        read(tmp_path, b"PK\x03\x04\x14\x00\x06\x00\x08\x00" + bytes(range(256)) * 4)


@pytest.mark.parametrize("separator", [";", "\t", "|"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_the_decimal_mark_is_found(tmp_path: Path, separator: str, decimal: str) -> None:
    found = read(tmp_path, table(separator, decimal))
    assert found.data["Süd °C"].tolist() == [20.0, 20.125, 20.25, 20.375]


def test_quoted_decimal_commas_between_commas(tmp_path: Path) -> None:
    text = 'time,T\n2024-09-04 00:00,"20,5"\n2024-09-04 00:15,"20,75"\n'
    assert read(tmp_path, text).data["T"].tolist() == [20.5, 20.75]


def test_decimal_commas_between_commas_without_quotes_are_refused(tmp_path: Path) -> None:
    text = "time,T\n2024-09-04 00:00,20,5\n2024-09-04 00:15,20,75\n"
    with pytest.raises(InputError, match=r"logger.csv:2: .*another separator"):
        read(tmp_path, text)


HEADS = {
    "one line": "Logger 12\n",
    "names and values": "Device;ABC-1\nSerial;123\nStart;2024-09-04 00:00\nInterval;900\n\n",
    "sentences": "# made by hand, T in degC\n# second line; with marks; in it\n",
    "spreadsheet": "sep=;\n",
}


@pytest.mark.parametrize("head", HEADS.values(), ids=HEADS)
def test_lines_above_the_header_are_left_out(tmp_path: Path, head: str) -> None:
    found = read(tmp_path, table(head=head))
    assert list(found.data.columns) == ["Süd °C", "G [W/m²]"]
    assert found.data.shape == (4, 2)
    assert any(f"are in line {head.count(chr(10)) + 1}" in note for note in found.provenance)


def test_the_lines_of_errors_count_from_the_start_of_the_file(tmp_path: Path) -> None:
    text = table(head=HEADS["names and values"]).replace("20.125", "2O.125")
    with pytest.raises(InputError, match=r"line 8: found '2O.125', expected a number"):
        read(tmp_path, text)


@pytest.mark.parametrize(
    "units", ["yyyy-mm-dd hh:mm;°C;W/m²", ";[°C];[W/m²]", "TS;Deg C;W/m^2\n;Smp;Avg", "-;degC;W/m2"]
)
def test_rows_of_units_are_no_data(tmp_path: Path, units: str) -> None:
    found = read(tmp_path, table(names=f"time;T;G\n{units}"))
    assert list(found.data.columns) == ["T", "G"]
    assert found.data["G"].tolist() == [0.0, 10.0, 20.0, 30.0]
    assert any("has units" in note for note in found.provenance)


def test_a_campbell_logger(tmp_path: Path) -> None:
    """The four header lines of TOA5 (Campbell Scientific, CR1000 manual, "TOA5")."""
    text = (
        '"TOA5","station","CR1000","1234","CR1000.Std.32","CPU:house.CR1","5555","T15"\n'
        '"TIMESTAMP","RECORD","T_in","G"\n"TS","RN","Deg C","W/m^2"\n"","","Avg","Avg"\n'
        '"2024-09-04 00:00:00",0,20.5,0\n"2024-09-04 00:15:00",1,20.6,1\n"2024-09-04 00:30:00",2,"NAN",3\n'
    )
    found = read(tmp_path, text)
    assert list(found.data.columns) == ["RECORD", "T_in", "G"]
    assert np.isnan(found.data["T_in"].to_numpy()).tolist() == [False, False, True]


def test_rows_that_end_with_a_separator(tmp_path: Path) -> None:
    text = "time;T\n2024-09-04 00:00;20,5;\n2024-09-04 00:15;20,75;\n"
    assert read(tmp_path, text).data["T"].tolist() == [20.5, 20.75]


def test_a_table_without_names_is_refused(tmp_path: Path) -> None:
    text = "".join(f"{stamp};{k};{k}\n" for k, stamp in enumerate(STAMPS))
    with pytest.raises(InputError, match=r"logger.csv:1: found the first row of data.*no names of columns"):
        read(tmp_path, text)


def test_stated_lines_are_taken_as_they_are(tmp_path: Path) -> None:
    found = read(tmp_path, table(head="a;b;c\n1;2;3\n"), skip_lines=2)
    assert list(found.data.columns) == ["Süd °C", "G [W/m²]"]


def test_one_column_of_numbers_may_be_called_like_a_unit(tmp_path: Path) -> None:
    """A header of short names is no row of units: there is nothing above it."""
    text = "h;T;K\n" + "".join(f"{stamp};{k};{k}\n" for k, stamp in enumerate(STAMPS))
    assert list(read_table_names(tmp_path, text)) == ["T", "K"]


def read_table_names(folder: Path, text: str) -> list[str]:
    path = folder / "logger.csv"
    path.write_text(text, encoding="utf-8")
    return [str(name) for name in read_table(path, timezone="UTC").frame.columns]
