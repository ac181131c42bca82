from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.physics import dew_point
from mascarin.weather import CHANNELS, Climate, Place, summary

GILLOT = Place(-20.892, 55.529, 8.0)


def gillot(data_dir: Path, **changes: Any) -> Climate:
    options: dict[str, Any] = {
        "timezone": "UTC+4",
        "time": "AAAAMMJJHH",
        "time_format": "%Y%m%d%H",
        "stamps": "end",
        "columns": {
            "air_temperature": "T",
            "dew_point": "TD",
            "wind_speed": "FF",
            "wind_direction": "DD",
            "pressure": {"column": "PSTAT", "unit": "hPa"},
            "global_horizontal": {"column": "GLO", "unit": "J/cm2"},
        },
        "latitude": GILLOT.latitude,
        "longitude": GILLOT.longitude,
        "altitude": GILLOT.altitude,
    }
    return Climate.from_table(data_dir / "weather" / "gillot_2023_meteo_france.csv", **(options | changes))


def test_real_hourly_record(data_dir: Path) -> None:
    climate = gillot(data_dir)
    assert climate.index[0].isoformat() == "2022-12-31T23:00:00+04:00"
    assert climate.data.loc["2023-01-01 00:00+04:00", "air_temperature"] == 23.2  # spot value stays
    raw = pd.read_csv(climate_path(data_dir), sep=";", skipinitialspace=True)
    stamped = raw.loc[raw["AAAAMMJJHH"] == 2023010112, "GLO"].iloc[0]
    row = climate.data.loc["2023-01-01 11:00+04:00"]
    assert row["global_horizontal"] == pytest.approx(stamped * 1e4 / 3600.0)
    assert row["pressure"] == pytest.approx(100.0 * raw["PSTAT"].iloc[11])
    text = " ".join(climate.provenance)
    for said in (
        "9172 rows of 1 h",
        "the end of its interval",
        "J/cm2 (the file) converted to W/m2",
        "Erbs",
        "Kimball 1928",
    ):
        assert said in text
    assert summary(climate)["sha256"] == "4bc1d1e3dace763a92590536ecc5c39e27362187139d58153eaea5a360b56f8c"


def climate_path(data_dir: Path) -> Path:
    return data_dir / "weather" / "gillot_2023_meteo_france.csv"


def test_split_of_the_real_record_closes(data_dir: Path) -> None:
    climate = gillot(data_dir)
    forcing = climate.fill_gaps("2h").forcing(GILLOT, "2023-01-01", "2024-01-01", 3600.0)
    weights = np.array([np.sqrt(0.5), 1.0 - np.sqrt(0.5)])
    total = forcing[..., CHANNELS.index("global_horizontal")] @ weights
    expected = climate.data.loc["2023-01-01 00:00+04:00":"2023-12-31 23:00+04:00", "global_horizontal"]
    assert np.max(np.abs(total - expected.to_numpy())) < 1e-10
    diffuse = forcing[..., CHANNELS.index("diffuse_horizontal")] @ weights
    assert 0.3 < diffuse.sum() / total.sum() < 0.55
    direct = forcing[..., CHANNELS.index("direct_normal")]
    assert direct.min() >= 0.0
    assert 800.0 < np.quantile(direct, 0.999) < 1200.0


def test_humidity_becomes_dew_point() -> None:
    climate = table({"relative_humidity": "RH"})
    assert climate.data["dew_point"].iloc[0] == pytest.approx(
        dew_point(np.array([20.0]), np.array([60.0]))[0]
    )
    assert "relative_humidity" not in climate.data.columns
    with pytest.raises(InputError, match=r"relative humidity 0.6 %|unit: '1'|expected 0 .. 100"):
        table({"relative_humidity": {"column": "RH", "scale": 3.0}})
    shares = table({"relative_humidity": {"column": "share", "unit": "1"}})
    assert shares.data["dew_point"].iloc[0] == pytest.approx(climate.data["dew_point"].iloc[0])


def frame(count: int = 48) -> pd.DataFrame:
    index = pd.date_range("2024-06-01", periods=count, freq="1h", tz="UTC")
    hour = np.arange(count) % 24
    sun = np.maximum(0.0, np.cos(2.0 * np.pi * (hour + 0.5 - 12.0) / 24.0)) * 600.0
    return pd.DataFrame(
        {
            "T": 20.0,
            "RH": 60.0,
            "share": 0.6,
            "G": sun,
            "D": 0.4 * sun,
            "B": 0.8 * sun,
            "v": 2.0,
            "dir": 90.0,
        },
        index=index,
    )


def table(columns: dict[str, Any], **options: Any) -> Climate:
    base = {"air_temperature": "T", "global_horizontal": "G", "wind_speed": "v", "wind_direction": "dir"}
    return Climate.from_table(frame(), **({"timezone": "UTC", "columns": base | columns} | options))


@pytest.mark.parametrize(
    ("columns", "basis", "note"),
    [
        ({"global_horizontal": "G"}, "global+diffuse", "Erbs"),
        ({"global_horizontal": "G", "diffuse_horizontal": "D"}, "global+diffuse", "by closure"),
        (
            {"direct_normal": "B", "diffuse_horizontal": "D"},
            "direct+diffuse",
            "global irradiance from direct",
        ),
        (
            {"global_horizontal": "G", "direct_normal": "B"},
            "direct+diffuse",
            "diffuse irradiance from global and",
        ),
    ],
)
def test_missing_irradiances_are_derived_and_said(columns: dict[str, str], basis: str, note: str) -> None:
    climate = Climate.from_table(
        frame(),
        timezone="UTC",
        columns={
            "air_temperature": "T",
            "relative_humidity": "RH",
            "wind_speed": "v",
            "wind_direction": "dir",
        }
        | columns,
        latitude=45.0,
        longitude=0.0,
    )
    assert climate.record.radiation_basis == basis
    assert {"direct_normal", "diffuse_horizontal", "global_horizontal", "cloud_cover"} <= set(
        climate.data.columns
    )
    assert any(note in sentence for sentence in climate.provenance)
    assert climate.data["direct_normal"].max() < 1361.0
    assert climate.data["diffuse_horizontal"].min() >= 0.0


def test_what_follows_from_a_column_is_not_assumed() -> None:
    """Humidity tells the dew point, global and diffuse the direct irradiance, though said to be absent."""
    measured = frame()
    columns = {"air_temperature": "T", "relative_humidity": "RH", "wind_speed": "v", "wind_direction": "dir"}
    columns |= {"global_horizontal": "G", "diffuse_horizontal": "D"}
    plain = Climate.from_table(measured, timezone="UTC", columns=columns).completed(Place(45.0, 0.0))
    for absent in (["dew_point", "direct_normal"], ["dew_point", "radiation"]):
        stated = Climate.from_table(measured, timezone="UTC", columns=columns, absent=absent)
        np.testing.assert_array_equal(
            stated.completed(Place(45.0, 0.0)).data.to_numpy(), plain.data.to_numpy()
        )
    with pytest.raises(
        InputError, match="found dew_point with the value 9, but it follows from relative_humidity"
    ):
        Climate.from_table(measured, timezone="UTC", columns=columns, absent={"dew_point": 9.0})


def test_absent_channels_are_assumed_only_when_stated() -> None:
    base = {"air_temperature": "T"}
    for absent, missing in (
        ((), "dew_point"),
        (("dew_point",), "wind_speed"),
        (("dew_point", "wind_speed"), "wind_direction"),
        (("dew_point", "wind_speed", "wind_direction"), "global_horizontal"),
    ):
        with pytest.raises(InputError, match=rf"table: no column for {missing} \["):
            Climate.from_table(frame(), timezone="UTC", columns=base, absent=absent)
    climate = Climate.from_table(
        frame(),
        timezone="UTC",
        columns=base,
        absent={
            "relative_humidity": 40.0,
            "wind_speed": 1.5,
            "wind_direction": 270.0,
            "global_horizontal": 0.0,
        },
    ).completed(Place(45.0, 0.0))
    row = climate.data.iloc[5]
    assert (row["wind_speed"], row["wind_direction"], row["direct_normal"], row["cloud_cover"]) == (
        1.5,
        270.0,
        0.0,
        0.0,
    )
    assert row["dew_point"] == pytest.approx(dew_point(np.array([20.0]), np.array([40.0]))[0])
    assert "table: wind_speed was not measured; assumed 1.5 m/s throughout." in climate.provenance
    forcing = climate.forcing(Place(45.0, 0.0), "2024-06-01", "2024-06-02", 3600.0)
    for name in ("infrared", "pressure"):
        assert np.isnan(forcing[..., CHANNELS.index(name)]).all()
    assert not np.isnan(np.delete(forcing, [3, 6], axis=-1)).any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"columns": {"air_temprature": "T"}},
            "'air_temprature' is no climate channel. Did you mean 'air_temperature'",
        ),
        ({"columns": {"air_temperature": "Tair"}}, "no column 'Tair'"),
        ({"timezone": ""}, "a time zone is required"),
        (
            {"absent": ["humidity"]},
            "'humidity' is no channel that may be absent. Did you mean 'relative_humidity'",
        ),
        ({"absent": ["wind_speed"]}, "wind_speed is both mapped to a column and stated to be absent"),
        ({"extra": ["wind_speed"]}, "'wind_speed' is a climate channel; name it under columns"),
        ({"mean": ["Pyr"]}, "mean: 'Pyr' is not read"),
        ({"stamps": "middle"}, "stamps is 'middle', expected 'start' or 'end'"),
        (
            {"columns": {"diffuse_horizontal": "D"}, "instant": ["diffuse_horizontal"]},
            "all means or all instants",
        ),
        ({"columns": {"dew_point": "T"}}, "give dew_point or relative_humidity, not both"),
    ],
)
def test_bad_options_are_refused(options: dict[str, Any], words: str) -> None:
    columns = {"relative_humidity": "RH"} | options.pop("columns", {})
    with pytest.raises(InputError, match=words):
        table(columns, **options)


def test_lgi_record_is_read_whole(repository: Path) -> None:
    path = repository / "python" / "mascarin" / "examples" / "lgi" / "lgi_virtual.csv"
    names = (
        "relative_humidity",
        "wind_speed",
        "wind_direction",
        "pressure",
        "global_horizontal",
        "diffuse_horizontal",
    )
    climate = Climate.from_table(
        path,
        timezone="Indian/Reunion",
        columns={name: name for name in names} | {"air_temperature": "outdoor_air"},
        extra=["slab_underside"],
    )
    forcing = climate.forcing(
        Place(-21.34, 55.48), "2010-08-01", "2010-11-01", 900.0, channels=["slab_underside"]
    )
    assert forcing.shape == (8832, 2, 16)
    last = forcing[:, 1]
    stamped = climate.data.iloc[1:]
    assert last[:-1, 0] == pytest.approx(stamped["air_temperature"].to_numpy())
    assert last[:-1, 15] == pytest.approx(stamped["slab_underside"].to_numpy())
    weights = np.array([np.sqrt(0.5), 1.0 - np.sqrt(0.5)])
    total = forcing[..., CHANNELS.index("global_horizontal")] @ weights
    assert np.max(np.abs(total - climate.data["global_horizontal"].to_numpy())) < 1e-10
    assert forcing[..., CHANNELS.index("direct_normal")].max() < 1100.0


def logger(folder: Path, row: int, name: str, entry: float, **options: Any) -> Climate:
    """Two days of hours, one entry changed; row 0 is in line 2."""
    index = pd.date_range("2024-06-01", periods=48, freq="1h")
    frame = pd.DataFrame({"T": 20.0, "RH": 60.0, "d": 90.0, "L": 300.0}, index=index)
    frame.loc[index[row], name] = entry
    path = folder / "logger.csv"
    frame.to_csv(path, index_label="time")
    columns: dict[str, Any] = {
        "air_temperature": "T",
        "relative_humidity": "RH",
        "wind_direction": "d",
        "infrared": "L",
    } | options.pop("columns", {})
    absent = ["wind_speed", "radiation"]
    return Climate.from_table(path, timezone="UTC", columns=columns, absent=absent, **options)


@pytest.mark.parametrize(("name", "channel"), [("T", "air_temperature"), ("L", "infrared")])
@pytest.mark.parametrize("stamps", ["start", "end"])
@pytest.mark.parametrize("row", [10, 46])
def test_lines_are_those_of_the_file_whichever_end_a_stamp_marks(
    tmp_path: Path, row: int, stamps: str, name: str, channel: str
) -> None:
    end = "2024-06-02 23:00" if stamps == "end" else "2024-06-03"
    start = "2024-05-31 23:00" if stamps == "end" else "2024-06-01"
    for entry, words in ((np.nan, "has no value"), (2730.0, "is 2730 at")):
        climate = logger(tmp_path, row, name, entry, stamps=stamps)
        with pytest.raises(InputError, match=rf"^logger.csv:{row + 2}: {channel} {words}") as caught:
            climate.forcing(Place(45.0, 0.0), start, end, 3600.0)
        # A spot value stays at its stamp; a mean moves to the start of its interval.
        shift = pd.Timedelta(hours=int(stamps == "end" and name == "L"))
        assert f"{pd.Timestamp('2024-06-01') + pd.Timedelta(hours=row) - shift:%Y-%m-%d %H:%M}" in str(
            caught.value
        )


@pytest.mark.parametrize("stamps", ["start", "end"])
def test_line_of_an_impossible_humidity(tmp_path: Path, stamps: str) -> None:
    with pytest.raises(InputError, match=r"^logger.csv:12: relative humidity 160 %"):
        logger(tmp_path, 10, "RH", 160.0, stamps=stamps)


def test_kelvin_without_a_unit_is_refused_and_with_it_taken(tmp_path: Path) -> None:
    frame = pd.DataFrame({"T": 283.15}, index=pd.date_range("2024-06-01", periods=48, freq="1h", name="time"))
    frame.to_csv(tmp_path / "kelvin.csv")
    absent = ["dew_point", "wind_speed", "wind_direction", "radiation"]

    def read(column: dict[str, object]) -> np.ndarray:
        climate = Climate.from_table(
            tmp_path / "kelvin.csv", timezone="UTC", columns={"air_temperature": column}, absent=absent
        )
        return np.asarray(climate.forcing(Place(45.0, 0.0), "2024-06-01", "2024-06-02", 3600.0)[..., 0])

    words = (
        r"^kelvin.csv:2: air_temperature: found a mean of 283.2 .* degC in the column 'T', for which no unit "
        r"is stated; .* They look like K: state the unit, .column: 'T', unit: 'K'."
    )
    with pytest.raises(InputError, match=words):
        read({"column": "T"})
    assert read({"column": "T", "unit": "K"}) == pytest.approx(10.0)


def test_a_code_for_variable_wind_is_not_a_direction(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^logger.csv:12: wind_direction is 990 at"):
        logger(tmp_path, 10, "d", 990.0).forcing(Place(45.0, 0.0), "2024-06-01", "2024-06-02", 3600.0)
    west = logger(tmp_path, 10, "d", -90.0)
    assert west.data["wind_direction"].iloc[10] == 270.0
