"""EPW files as people have them: missing fields, several records an hour, other first days, clouds."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import Climate, cli, simulate
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.weather import CHANNELS, Place, write_epw
from mascarin.weather.checks.missing_infrared import sky_emission
from mascarin.weather.reading.shipped import SHIPPED, content, found

Fields = list[str]


@pytest.fixture(scope="module")
def chicago() -> list[Fields]:
    """Lines of the shipped EPW file of Chicago, as fields."""
    assert "chicago" in SHIPPED
    text = content(found("shipped:chicago")).decode("utf-8-sig")
    return [line.split(",") for line in text.splitlines()]


def climate(lines: list[Fields], folder: Path, name: str = "a.epw", **options: bool) -> Climate:
    path = folder / name
    path.write_text("\n".join(",".join(fields) for fields in lines) + "\n", encoding="utf-8")
    return Climate.from_epw(path, **options)


def changed(
    lines: list[Fields], change: Callable[[Fields], None], rows: slice = slice(8, None)
) -> list[Fields]:
    copies = [list(fields) for fields in lines]
    for fields in copies[rows]:
        change(fields)
    return copies


def set_to(*entries: tuple[int, str]) -> Callable[[Fields], None]:
    def change(fields: Fields) -> None:
        for field, text in entries:
            fields[field] = text

    return change


def test_dew_point_from_the_relative_humidity(chicago: list[Fields], tmp_path: Path) -> None:
    true = climate(chicago, tmp_path).data["dew_point"]
    filled = climate(changed(chicago, set_to((7, "99.9"))), tmp_path)
    # The humidity of the file is rounded to 1 %: half of it is 0.1 K at saturation and 2 K at 5 %.
    assert np.quantile(np.abs(filled.data["dew_point"].to_numpy() - true.to_numpy()), 0.9) < 0.4
    assert any("dew point of 8760 hours" in note for note in filled.provenance)
    some = climate(changed(chicago, set_to((7, "99.9")), slice(108, 118)), tmp_path)
    assert any("dew point of 10 hours" in note for note in some.provenance)
    assert some.data["dew_point"].isna().sum() == 0
    neither = climate(changed(chicago, set_to((7, "99.9"), (8, "999")), slice(108, 118)), tmp_path)
    assert neither.data["dew_point"].isna().sum() == 10


def test_direct_and_diffuse_from_global(chicago: list[Fields], tmp_path: Path) -> None:
    true = climate(chicago, tmp_path)
    only = climate(changed(chicago, set_to((14, "9999"), (15, "9999"))), tmp_path)
    assert "direct_normal" not in only.data
    made = only.completed()
    assert made.data["diffuse_horizontal"].sum() == pytest.approx(
        true.data["diffuse_horizontal"].sum(), rel=0.15
    )
    assert made.data["direct_normal"].sum() == pytest.approx(true.data["direct_normal"].sum(), rel=0.15)
    assert any("Erbs" in note for note in made.provenance)
    assert any("diffuse_horizontal and direct_normal have no value" in note for note in made.provenance)


def test_the_command_shows_a_file_without_direct_and_diffuse(
    chicago: list[Fields], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    climate(changed(chicago, set_to((14, "9999"), (15, "9999"))), tmp_path, "b.epw")
    assert cli.main(["weather", str(tmp_path / "b.epw")]) == 0
    assert "nan" not in capsys.readouterr().out


def test_empty_fields_are_missing_values(chicago: list[Fields], tmp_path: Path) -> None:
    read = climate(changed(chicago, set_to((23, ""))), tmp_path)
    assert "cloud_cover" not in read.data
    assert any("8760 empty fields were taken as missing" in note for note in read.provenance)
    assert "cloud_cover" in read.completed().data


def test_infrared_that_is_missing_in_some_hours_is_that_of_the_model_there(tmp_path: Path) -> None:
    golden = [line.split(",") for line in content(found("shipped:golden")).decode("utf-8-sig").splitlines()]
    read = climate(changed(golden, set_to((12, "9999")), slice(4000, 4030)), tmp_path)
    whole = Climate.shipped("golden")
    # Line 4001 is the hour that ends with row 3993; infrared of the format is a value at the stamp.
    rows = np.arange(3993, 4023)
    filled = read.completed().data
    other = np.setdiff1d(np.arange(8760), rows)
    assert np.array_equal(filled["infrared"].to_numpy()[other], whole.data["infrared"].to_numpy()[other])
    state = [filled[name].to_numpy()[rows] for name in ("air_temperature", "dew_point", "cloud_cover")]
    model = sky_emission(*state)
    assert filled["infrared"].to_numpy()[rows] == pytest.approx(model, rel=1e-12)
    assert np.abs(model - whole.data["infrared"].to_numpy()[rows]).max() < 60.0
    first, last = (f"{read.index[row]:%Y-%m-%d}" for row in (3960, 4060))
    building = box().replace({"site.latitude": 39.74, "site.longitude": -105.18})
    plain = simulate(building, read, start=first, end=last, step="1h", initial=20.0)
    assert any("infrared has no value in 30 of 8760 rows: in these" in text for text in plain.warnings)
    channel = CHANNELS.index("infrared")
    place = Place(39.74, -105.18, 1829.0)
    days = ("2001-06-01", "2001-06-05")  # the model is not asked for outside of the gap
    assert np.array_equal(read.forcing(place, *days, 3600.0)[..., channel],
                          whole.forcing(place, *days, 3600.0)[..., channel])  # fmt: skip


def test_the_model_of_missing_infrared_is_that_of_the_engine() -> None:
    index = pd.date_range("2024-01-10", periods=49, freq="1h", tz="UTC")
    still = {"air_temperature": 3.0, "dew_point": -2.0, "wind_speed": 1.0, "wind_direction": 0.0,
             "global_horizontal": 0.0, "cloud_cover": 4.0}  # fmt: skip
    frame = pd.DataFrame(still, index=index)
    columns = {name: name for name in still}
    sky = float(sky_emission(np.array([3.0]), np.array([-2.0]), np.array([4.0]))[0])
    runs = []
    for table, names in ((frame, columns), (frame.assign(infrared=sky), {**columns, "infrared": "infrared"})):
        weather = Climate.from_table(table, columns=names)
        runs.append(simulate(box(), weather, start="2024-01-10", end="2024-01-12", step="1h", initial=20.0))
    for name in runs[0]:
        assert runs[0][name].to_numpy() == pytest.approx(runs[1][name].to_numpy(), abs=1e-8)


def test_the_sky_of_a_run_is_said_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    golden = [line.split(",") for line in content(found("shipped:golden")).decode("utf-8-sig").splitlines()]
    climate(changed(golden, set_to((12, "9999")), slice(4000, 4030)), tmp_path)
    climate(changed(golden, set_to((12, "9999"))), tmp_path, "none.epw")
    for file, words in (
        ("shipped:golden", "infrared radiation of the file in all rows"),
        (
            str(tmp_path / "a.epw"),
            "infrared radiation of the file; in 30 of 8760 rows, which have none, the model",
        ),
        (str(tmp_path / "none.epw"), "no infrared radiation in the file: a model in all rows"),
    ):
        assert cli.main(["weather", file]) == 0
        assert f"sky of a run: {words}" in capsys.readouterr().out


def quarters(lines: list[Fields]) -> list[Fields]:
    """Four records an hour, each with the values of the hour."""
    head = [list(fields) for fields in lines[:8]]
    head[7][2] = "4"
    body = [[*fields[:4], str(minute), *fields[5:]] for fields in lines[8:] for minute in (15, 30, 45, 60)]
    return [*head, *body]


def test_four_records_an_hour(chicago: list[Fields], tmp_path: Path) -> None:
    hourly, read = climate(chicago, tmp_path), climate(quarters(chicago), tmp_path)
    assert (read.grid.interval, read.grid.count) == (900.0, 4 * 8760)
    assert read.data["global_horizontal"].to_numpy()[::4] == pytest.approx(hourly.data["global_horizontal"])
    place = hourly.site
    assert place is not None
    sun = [
        one.forcing(place, "2001-07-01", "2001-07-03", 3600.0)[
            ..., CHANNELS.index("global_horizontal")
        ].mean()
        for one in (hourly, read)
    ]
    assert sun[1] == pytest.approx(sun[0], rel=0.01)


def test_a_typical_year_may_begin_in_july(chicago: list[Fields], tmp_path: Path) -> None:
    july = 8 + 181 * 24
    turned = climate([*chicago[:8], *chicago[july:], *chicago[8:july]], tmp_path)
    true = climate(chicago, tmp_path)
    pd.testing.assert_frame_equal(turned.data, true.data)
    assert turned.record.line("global_horizontal", 0) == 8 + 8760 - 181 * 24 + 1


def test_a_record_of_two_years_begins_where_it_begins(chicago: list[Fields], tmp_path: Path) -> None:
    july = 8 + 181 * 24
    first, second = (changed(part, set_to((0, year)), slice(None)) for part, year in
                     ((chicago[july:], "2022"), (chicago[8:july], "2023")))  # fmt: skip
    read = climate([*chicago[:8], *first, *second], tmp_path)
    assert (read.index[0].isoformat(), read.grid.periodic) == ("2022-07-01T00:00:00-06:00", False)
    assert read.index[-1].isoformat() == "2023-06-30T23:00:00-06:00"
    assert read.data["air_temperature"].iloc[1] == float(chicago[july][6])


def test_hours_from_0_to_23(chicago: list[Fields], tmp_path: Path) -> None:
    def earlier(fields: Fields) -> None:
        fields[3] = str(int(fields[3]) - 1)

    read = climate(changed(chicago, earlier), tmp_path)
    pd.testing.assert_frame_equal(read.data, climate(chicago, tmp_path).data)
    assert any("warning: hours are 0 to 23" in note for note in read.provenance)


def test_a_missing_row_is_still_refused(chicago: list[Fields], tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"a.epw:109: found 1/5 hour 6, expected 1/5 hour 5; a row is missing"
    ):
        climate([*chicago[:108], *chicago[109:]], tmp_path)
    half = quarters(chicago)
    with pytest.raises(InputError, match=r"expected 4 rows of each hour"):
        climate([*half[:109], *half[110:]], tmp_path)


# ---------------------------------------------------------------------- clouds and clocks


def foggy(days: int, shift: float) -> Climate:
    """Days at 37.6 N with 30 % of a clear sky's sun before noon; a clock that is late by a shift [h]."""
    index = pd.date_range("2023-06-01", periods=days * 144, freq="10min", tz="Etc/GMT+8")
    hour = index.hour + index.minute / 60.0 - shift
    sun = np.maximum(np.cos((hour - 12.0) / 14.6 * np.pi), 0.0) * (np.abs(hour - 12.0) < 7.3)
    table = pd.DataFrame({"T": 15.0, "G": 900.0 * sun * np.where(hour < 12.0, 0.3, 1.0)}, index=index)
    return Climate.from_table(
        table, columns={"air_temperature": "T", "global_horizontal": "G"},
        absent=["dew_point", "wind_speed", "wind_direction"], instant=["global_horizontal"], latitude=37.6,
        longitude=-120.0, altitude=0.0,
    )  # fmt: skip


@pytest.mark.parametrize("days", [3, 10])
def test_fog_in_the_morning_is_no_wrong_clock(days: int) -> None:
    assert "direct_normal" in foggy(days, 0.0).completed().data


@pytest.mark.parametrize("shift", [-1.5, 1.5, 3.0])
def test_a_wrong_clock_is_still_refused_in_fog(shift: float) -> None:
    with pytest.raises(InputError, match=r"does not follow the sun.*check_sun: false .*--no-check-sun"):
        foggy(10, shift).completed()


def test_the_check_can_be_declined_for_a_weather_file(
    chicago: list[Fields], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def zone(lines: list[Fields]) -> list[Fields]:
        return [[*lines[0][:8], "0.0", *lines[0][9:]], *lines[1:]]

    with pytest.raises(InputError, match="does not follow the sun"):
        climate(zone(chicago), tmp_path, "z.epw").completed()
    assert "direct_normal" in climate(zone(chicago), tmp_path, "z.epw", check_sun=False).completed().data
    assert cli.main(["weather", str(tmp_path / "z.epw")]) == 2
    capsys.readouterr()
    assert cli.main(["weather", str(tmp_path / "z.epw"), "--no-check-sun"]) == 0


def test_the_polar_night_is_no_stuck_sensor() -> None:
    index = pd.date_range("2023-11-01", periods=24 * 100, freq="1h", tz="Etc/GMT-1")
    day = (index.day_of_year.to_numpy() + index.hour.to_numpy() / 24.0) / 365.0 * 2.0 * np.pi
    up = np.sin(np.radians(69.7)) * np.sin(np.radians(-23.44 * np.cos(day + 0.17)))
    turn = (index.hour.to_numpy() - 11.7) / 12.0 * np.pi
    up = up + np.cos(np.radians(69.7)) * np.cos(np.radians(-23.44 * np.cos(day + 0.17))) * np.cos(turn)
    noise = np.random.default_rng(1).uniform(0.8, 1.2, len(index))
    table = pd.DataFrame({"T": 0.0 + noise, "G": np.maximum(up, 0.0) * 700.0 * noise}, index=index)
    read = Climate.from_table(
        table, columns={"air_temperature": "T", "global_horizontal": "G"},
        absent=["dew_point", "wind_speed", "wind_direction"], latitude=69.7, longitude=18.9, altitude=0.0,
    )  # fmt: skip
    assert [part for part in read.quality() if part.channel == "global_horizontal"] == []
    assert isinstance(read.site, Place)


def test_rows_of_the_log_w01_w02_leap_years(chicago: list[Fields], tmp_path: Path) -> None:
    """W01: February of a leap year with 28 days. W02: 8784 hours of 2020 keep 29 February."""

    def leap_year(fields: Fields) -> None:
        fields[0] = "2020" if fields[1] == "2" else fields[0]

    typical = climate(changed(chicago, leap_year), tmp_path)
    assert len(typical.data) == 8760
    assert typical.grid.periodic
    rows = [list(fields) for fields in chicago]
    for fields in rows[8:]:
        fields[0] = "2020"
    added = [
        [*fields[:2], "29", *fields[3:6], "33.3", *fields[7:]] for fields in rows[8 + 58 * 24 : 8 + 59 * 24]
    ]
    leap = climate([*rows[: 8 + 59 * 24], *added, *rows[8 + 59 * 24 :]], tmp_path)
    assert len(leap.data) == 8784
    day = leap.data.loc["2020-02-29 01:00":"2020-02-29 23:00", "air_temperature"]
    assert (day == 33.3).all()


def test_row_w04_no_infrared_runs_with_the_model(tmp_path: Path) -> None:
    golden = [line.split(",") for line in content(found("shipped:golden")).decode("utf-8-sig").splitlines()]
    none = climate(changed(golden, set_to((12, "9999"))), tmp_path)
    building = box().replace(
        {"site.latitude": 39.74, "site.longitude": -105.18, "site.sky": "martin_berdahl"}
    )
    span: dict[str, Any] = {"start": "2001-07-01", "end": "2001-07-04", "step": "1h", "initial": 20.0}
    plain = simulate(building, none, **span)
    stated = simulate(building, Climate.shipped("golden"), **span)
    for name in plain:
        assert np.array_equal(plain[name].to_numpy(), stated[name].to_numpy())


def test_row_w12_written_and_read_again(tmp_path: Path) -> None:
    for name in ("golden", "chicago"):
        first = Climate.shipped(name)
        write_epw(first, tmp_path / "again.epw")
        again = Climate.from_epw(tmp_path / "again.epw")
        assert again.grid == first.grid
        for channel in ("air_temperature", "global_horizontal", "direct_normal", "infrared"):
            assert again.data[channel].to_numpy() == pytest.approx(first.data[channel].to_numpy(), abs=1e-9)


@pytest.mark.parametrize(
    ("latitude", "longitude", "zone"),
    [
        (28.6, 77.2, 5.5),
        (69.7, 18.9, 1.0),
        (-37.7, 144.8, 10.0),
        (-0.2, -78.5, -5.0),
        (65.0, 179.9, 12.0),
        (-18.0, -179.0, 12.0),
    ],
)
def test_rows_w15_w16_w17_places_of_the_world(
    chicago: list[Fields], tmp_path: Path, latitude: float, longitude: float, zone: float
) -> None:
    """A zone of 5.5 h, midnight sun, date line, south, equator: a clear sky with pvlib's sun passes."""
    import pvlib

    time = pd.date_range("2023-01-01 00:00", periods=8760 * 6, freq="10min", tz="UTC") + pd.Timedelta("5min")
    time -= pd.Timedelta(hours=zone)
    sine = np.sin(
        np.radians(pvlib.solarposition.get_solarposition(time, latitude, longitude)["elevation"].to_numpy())
    )
    sine = np.maximum(sine, 0.0)
    beam = 1361.0 * np.exp(-0.2 / np.maximum(sine, 0.02)) * (sine > 0.0)
    diffuse = 90.0 * np.sqrt(sine)
    means = [x.reshape(8760, 6).mean(axis=1) for x in (beam * sine + diffuse, beam, diffuse)]
    rows = [list(fields) for fields in chicago]
    rows[0][6:9] = [str(latitude), str(longitude), str(zone)]
    for k, fields in enumerate(rows[8:]):
        fields[0] = "2023"
        fields[13:16] = [f"{column[k]:.2f}" for column in means]
    read = climate(rows, tmp_path)
    place = read.site
    assert place is not None
    day = read.completed().forcing(place, "2023-06-20", "2023-06-22", 3600.0)
    total = day[..., CHANNELS.index("global_horizontal")].mean()
    first = int((pd.Timestamp("2023-06-20") - pd.Timestamp("2023-01-01")) / pd.Timedelta("1h"))
    assert total == pytest.approx(means[0][first : first + 48].mean(), rel=0.01)
    dark = [
        part
        for part in read.quality()
        if part.channel in ("global_horizontal", "direct_normal") and part.kind == "stuck"
    ]
    assert not dark
