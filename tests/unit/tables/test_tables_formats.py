"""Further files of each format, one of three damaged: read as they are, or refused; never read wrongly."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from logger_files import ALL, TIMES, TRUE, File, write
from mascarin import Measurements
from mascarin.errors import InputError
from mascarin.tables.reading.own_readers import register_reader
from mascarin.tables.times import epoch_seconds

FILES = [pytest.param(file, id=file.name) for maker in ALL.values() for file in maker()]
TRUTH = dict(zip(epoch_seconds(TIMES.tz_localize("UTC")).tolist(), TRUE.tolist(), strict=True))


def read_or_refused(path: Path, options: dict[str, Any], column: str) -> tuple[pd.Series | None, str]:
    try:
        return Measurements.from_table(path, **options).series(column), ""
    except InputError as error:
        return None, str(error)


@pytest.mark.parametrize("file", FILES)
def test_files_are_read_as_they_are_or_refused(file: File, tmp_path: Path) -> None:
    path = write(file, tmp_path)
    options = {"timezone": "UTC", **file.options}
    series, refusal = read_or_refused(path, options, file.column)
    if series is None:
        assert file.damaged, refusal
        assert file.name in refusal
        return
    values, seconds = series.to_numpy(), epoch_seconds(series.index)  # type: ignore[arg-type]
    there = np.isfinite(values)
    assert there.sum() >= len(seconds) - 1
    # Fahrenheit of two decimals is exact to 0.003 K.
    assert values[there] == pytest.approx([TRUTH[s] for s in seconds[there].tolist()], abs=0.0031)


@pytest.mark.parametrize("unit", ["degC", "K", "degree_Celsius"])
def test_netcdf_with_units(unit: str, tmp_path: Path) -> None:
    data = xr.Dataset(
        {"t2m": ("time", TRUE + (273.15 if unit == "K" else 0.0), {"units": unit})}, {"time": TIMES}
    )
    data.to_netcdf(tmp_path / "series.nc")
    read = Measurements.from_table(tmp_path / "series.nc", timezone="UTC")
    assert read.series("t2m").to_numpy() == pytest.approx(TRUE, abs=1e-9)
    assert "the file" in read.record.origins["t2m"].line


def test_netcdf_of_a_field_is_refused_and_one_place_of_it_is_read(tmp_path: Path) -> None:
    field = xr.Dataset(
        {"t2m": (("time", "latitude"), np.stack([TRUE, TRUE], axis=1), {"units": "degC"})},
        {"time": TIMES, "latitude": [45.0, 46.0]},
    )
    field.to_netcdf(tmp_path / "field.nc")
    with pytest.raises(InputError, match=r"varies with 'time' alone.*data.sel\(latitude"):
        Measurements.from_table(tmp_path / "field.nc", timezone="UTC")
    field.sel(latitude=45.0).to_netcdf(tmp_path / "place.nc")
    assert Measurements.from_table(tmp_path / "place.nc", timezone="UTC").series("t2m").iloc[5] == TRUE[5]
    (tmp_path / "cut.nc").write_bytes((tmp_path / "place.nc").read_bytes()[:900])
    with pytest.raises(InputError, match="cannot be read as NetCDF"):
        Measurements.from_table(tmp_path / "cut.nc", timezone="UTC")


def test_parquet(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    pd.DataFrame({"time": TIMES, "T [degF]": TRUE * 1.8 + 32.0}).to_parquet(tmp_path / "a.parquet")
    read = Measurements.from_table(tmp_path / "a.parquet", timezone="UTC")
    assert read.series("T [degF]").to_numpy() == pytest.approx(TRUE, abs=1e-9)
    (tmp_path / "b.parquet").write_bytes((tmp_path / "a.parquet").read_bytes()[:500])
    with pytest.raises(InputError, match="cannot be read as Parquet"):
        Measurements.from_table(tmp_path / "b.parquet", timezone="UTC")


def test_a_reader_of_ones_own_in_python(tmp_path: Path) -> None:
    path = tmp_path / "log.dtf"
    path.write_text("".join(f"{t:%Y-%m-%dT%H:%M}!{v}\n" for t, v in zip(TIMES, TRUE, strict=True)))

    def reader(path: Path) -> pd.DataFrame:
        frame = pd.read_csv(path, sep="!", names=["time", "T"])
        frame.attrs["units"] = {"T": "degC"}
        return frame

    register_reader(".DTF", reader)
    try:
        read = Measurements.from_table(path, timezone="UTC")
        assert read.series("T").to_numpy() == pytest.approx(TRUE)
        assert any("log.dtf: read by" in note for note in read.provenance)
        register_reader("dtf", lambda path: 1 / 0)  # type: ignore[arg-type, return-value]
        with pytest.raises(
            InputError, match=r"reader '<lambda>' for files ending in \.dtf failed \(ZeroDivisionError"
        ):
            Measurements.from_table(path, timezone="UTC")
        register_reader("dtf", lambda path: "text")  # type: ignore[arg-type, return-value]
        with pytest.raises(InputError, match=r"returned str; expected a pandas\.DataFrame"):
            Measurements.from_table(path, timezone="UTC")
    finally:
        register_reader("dtf", None)


def test_a_reader_of_an_installed_package(tmp_path: Path) -> None:
    """The metadata of a distribution as pip installs it, in a folder of the path of another process."""
    site = tmp_path / "site"
    folder = site / "dtf_reader-1.0.dist-info"
    folder.mkdir(parents=True)
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: dtf-reader\nVersion: 1.0\n")
    (folder / "entry_points.txt").write_text("[mascarin.table_readers]\ndtf = dtf_reader:read\n")
    (site / "dtf_reader.py").write_text(
        "import pandas as pd\n\n\ndef read(path):\n    return pd.read_csv(path, sep='!', "
        "names=['time', 'T'])\n"
    )
    path = tmp_path / "log.dtf"
    path.write_text("".join(f"{t:%Y-%m-%dT%H:%M}!{v}\n" for t, v in zip(TIMES, TRUE, strict=True)))
    code = (
        "import mascarin; "
        f"print(mascarin.Measurements.from_table({str(path)!r}, timezone='UTC').series('T').iloc[7])"
    )
    paths = os.pathsep.join([str(site), *sys.path])
    ran = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=True,
    )
    assert float(ran.stdout) == TRUE[7]
