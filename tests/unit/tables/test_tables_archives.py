"""Files of stations and archives, and thirty further files of loggers: read as they are, or refused."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from archive_files import ALL, STATION, bsrn, meteo_france
from logger_files import TIMES, TRUE, File, write
from mascarin import Climate, Measurements
from mascarin.errors import InputError
from mascarin.tables.stamps.iso_stamps import iso_stamps
from mascarin.tables.times import epoch_seconds
from mascarin.weather.checks.clock_shift import shifts_of
from test_tables_formats import read_or_refused

FILES = [pytest.param(file, id=file.name) for maker in ALL.values() for file in maker()]
TRUTH = dict(zip(epoch_seconds(TIMES.tz_localize("UTC")).tolist(), TRUE.tolist(), strict=True))


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


def test_there_are_thirty() -> None:
    assert len(FILES) == 30


@pytest.mark.parametrize("file", FILES)
def test_files_are_read_as_they_are_or_refused(file: File, tmp_path: Path) -> None:
    path = write(file, tmp_path)
    series, refusal = read_or_refused(path, {"timezone": "UTC", **file.options}, file.column)
    if series is None:
        assert file.damaged, refusal
        assert file.name in refusal
        return
    values, seconds = series.to_numpy(), epoch_seconds(series.index)  # type: ignore[arg-type]
    there = np.isfinite(values)
    assert there.sum() >= len(seconds) - 1
    assert values[there] == pytest.approx([TRUTH[s] for s in seconds[there].tolist()], abs=0.0031)


def test_one_station_of_a_departement(tmp_path: Path) -> None:
    """The remedy of the refusal, taken from its text: the rows of one station in a file of their own."""
    [whole] = [file for file in meteo_france() if file.damaged]
    path = write(whole, tmp_path)
    with pytest.raises(InputError, match=r"found 2 stations.*grep -E") as refused:
        Measurements.from_table(path, timezone="UTC")
    pattern = str(refused.value).split("grep -E '^")[1].split("'")[0]
    assert pattern == f"(NUM_POSTE|0*{int(STATION)};)"
    rows = [line for line in path.read_text().splitlines() if re.match(pattern, line)]
    (tmp_path / "station.csv").write_text("\n".join(rows) + "\n")
    read = Measurements.from_table(tmp_path / "station.csv", timezone="Europe/Paris", stamps="end")
    assert read.at("T", pd.DatetimeIndex(["2023-07-13 03:00"], tz="Europe/Paris"))[0] == TRUE[6]
    # 100 J/cm2 in an hour are 278 W/m2.
    assert read.series("GLO").max() > 270.0
    assert "J/cm2" in read.record.origins["GLO"].line


def test_a_station_to_archive_file(tmp_path: Path) -> None:
    (tmp_path / "xxx0723.dat").write_text(bsrn())
    (tmp_path / "xxx0723.dat.gz").write_bytes(gzip.compress(bsrn().encode()))
    for name in ("xxx0723.dat", "xxx0723.dat.gz"):
        read = Measurements.from_table(tmp_path / name, timezone="UTC+1")
        assert read.grid.interval == 60.0
        assert read.series("ghi").iloc[:3].tolist() == [0.0, 1.0, 2.0]
        assert read.series("temp_air").iloc[60] == pytest.approx(16.0)
        assert read.series("dni").isna().all()
        assert read.series("pressure").iloc[0] == pytest.approx(95500.0)
        assert read.series("ghi").index[0].isoformat() == "2023-07-01T01:00:00+01:00"


def test_damaged_archives_are_refused_by_line(tmp_path: Path) -> None:
    whole = bsrn()
    lines = whole.splitlines()
    (tmp_path / "cut.dat").write_text("\n".join(lines[:101]) + "\n")
    (tmp_path / "half.dat").write_text("\n".join([*lines[:50], lines[50][:20], *lines[51:]]) + "\n")
    (tmp_path / "none.dat").write_text(whole.replace("*U0100", "*U0300"))
    (tmp_path / "cut.dat.gz").write_bytes(gzip.compress(whole.encode())[:200])
    for name, said in (("cut.dat", "cut.dat:101: found"), ("half.dat", "half.dat:51: found"),
                       ("none.dat", "expected 0100"), ("cut.dat.gz", "gzip cannot unpack")):  # fmt: skip
        with pytest.raises(InputError, match=said):
            Measurements.from_table(tmp_path / name, timezone="UTC")


def test_tmy2(tmp_path: Path) -> None:
    """The file that pvlib has of Miami, whose clock the balance of its irradiances confirms."""
    import pvlib

    path = Path(pvlib.__file__).parent / "data" / "12839.tm2"
    climate = Climate.from_tmy(path)
    assert climate.site is not None
    assert (round(climate.site.longitude, 2), climate.timezone, len(climate.data)) == (-80.27, "UTC-5", 8760)
    assert climate.file == "12839.tm2"
    assert climate.data["air_temperature"].max() == pytest.approx(33.9)
    assert climate.data["cloud_cover"].between(0.0, 10.0).all()
    [balance, _] = shifts_of(climate.record, climate.site.latitude, climate.site.longitude)
    assert abs(balance.late) < 120.0
    with pytest.raises(InputError, match="does not follow the sun"):
        Climate.from_tmy(path, shift="1h")
    lines = path.read_text().splitlines()
    (tmp_path / "cut.tm2").write_text("\n".join(lines[:5000]))
    with pytest.raises(InputError, match=r"found 4999 hours.*expected 8760"):
        Climate.from_tmy(tmp_path / "cut.tm2")
    (tmp_path / "short.tm2").write_text("\n".join([*lines[:70], lines[70][:90], *lines[71:]]))
    with pytest.raises(InputError, match=r"short\.tm2:71: found a line of 90 characters"):
        Climate.from_tmy(tmp_path / "short.tm2")


def test_a_real_file_of_meteo_france(data_dir: Path) -> None:
    """Overseas hours are those of the place: the zone is the user's, the units are those of the archive."""
    path = data_dir / "weather" / "gillot_2023_meteo_france.csv"
    read = Measurements.from_table(path, timezone="Indian/Reunion", columns=["T", "FF", "U", "PSTAT"])
    assert read.timezone == "Indian/Reunion"
    assert read.series("PSTAT").dropna().between(9.6e4, 1.04e5).all()
    assert "degC" in read.record.origins["T"].line
    with pytest.raises(InputError, match="no column 'QT'"):
        Measurements.from_table(path, timezone="Indian/Reunion", columns=["QT"])


@pytest.mark.parametrize("form", ["%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M:%S"])
def test_stamps_read_at_once_are_those_of_pandas(form: str) -> None:
    text = pd.Series(pd.date_range("1999-12-31 23:00", periods=3000, freq="7h13min").strftime(form))
    times = iso_stamps(text)
    assert times is not None
    assert (times == pd.to_datetime(text, format=form).to_numpy()).all()
    for wrong in (
        "2023-02-30 00:00",
        "2023-13-01 00:00",
        "2023-01-01 24:00",
        "2023-01-01 0x:00",
        "2023-01-01",
    ):
        assert iso_stamps(pd.concat([text, pd.Series([wrong])])) is None
