from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.weather import CHANNELS, Climate
from mascarin.weather.derived.sun import SunPath


@pytest.fixture(scope="module")
def epw_lines(data_dir: Path) -> list[str]:
    return (data_dir / "bestest" / "725650TYCST.epw").read_text(encoding="utf-8").splitlines()


@pytest.fixture(scope="module")
def denver(data_dir: Path) -> Climate:
    return Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw")


def column(climate: Climate, name: str) -> np.ndarray:
    return np.asarray(climate.data[name].to_numpy(dtype=np.float64))


def test_denver_is_read_as_its_fact_sheet_says(denver: Climate) -> None:
    assert denver.site is not None
    assert (denver.site.latitude, denver.site.longitude, denver.site.altitude) == (39.83, -104.65, 1650.0)
    assert denver.timezone == "UTC-7"
    assert denver.grid.periodic
    air = column(denver, "air_temperature")
    assert (air.mean(), air.min(), air.max()) == pytest.approx((10.875, -19.4, 40.0), abs=5e-4)
    assert column(denver, "pressure").mean() == pytest.approx(83460.0, abs=1.0)
    assert column(denver, "wind_speed").mean() == pytest.approx(3.92, abs=0.005)
    assert column(denver, "infrared").mean() == pytest.approx(310.0, abs=0.05)
    sums = [
        column(denver, name).sum() / 1000.0
        for name in ("global_horizontal", "direct_normal", "diffuse_horizontal")
    ]
    assert sums == pytest.approx([1670.2, 1977.6, 556.5], abs=0.05)


def test_radiation_starts_an_hour_before_its_stamp_and_spot_values_stay(
    denver: Climate, epw_lines: list[str]
) -> None:
    noon = epw_lines[8 + 11].split(",")  # stamped 12:00: the hour from 11:00
    assert noon[3] == "12"
    row = denver.data.loc["2001-01-01 11:00"]
    assert row["global_horizontal"] == float(noon[13])
    assert denver.data.loc["2001-01-01 12:00", "air_temperature"] == float(noon[6])
    # The year opens with the spot value that closes it, 31 December 24:00.
    assert denver.data["air_temperature"].iloc[0] == float(epw_lines[-1].split(",")[6])
    assert any("hour-ending" in sentence for sentence in denver.provenance)


def test_sun_at_mid_interval_closes_the_radiation_balance(denver: Climate) -> None:
    """At the middle of the hour the root mean square is below 4 W/m2, at its ends above 20."""
    assert denver.site is not None
    grid = denver.grid
    sun = SunPath.over(denver.site.latitude, denver.site.longitude, grid.start, grid.end)
    starts = grid.start + 3600.0 * np.arange(8760)

    def closure(shift: float) -> np.ndarray:
        up = np.maximum(sun.vector(starts + shift)[:, 2], 0.0)
        sky = column(denver, "direct_normal") * up + column(denver, "diffuse_horizontal")
        return np.asarray(sky - column(denver, "global_horizontal"))

    def rms(values: np.ndarray) -> float:
        return float(np.sqrt(np.mean(values**2)))

    assert rms(closure(1800.0)) < 4.0
    assert rms(closure(0.0)) > 20.0
    assert rms(closure(3600.0)) > 20.0
    morning = (starts - grid.start) % 86400.0 < 43200.0
    assert abs(closure(1800.0)[morning].mean() - closure(1800.0)[~morning].mean()) < 1.0


def test_typical_year_represents_any_year_and_is_repeated(denver: Climate) -> None:
    assert denver.site is not None
    air = CHANNELS.index("air_temperature")
    year = denver.forcing(denver.site, "2001-01-01", "2002-01-01", 3600.0, "backward-euler")[:, 0, air]
    turn = denver.forcing(denver.site, "2010-12-31", "2011-01-02", 3600.0, "backward-euler")[:, 0, air]
    assert turn == pytest.approx(np.concatenate([year[-24:], year[:24]]))
    leap = denver.forcing(denver.site, "2024-02-28", "2024-03-02", 3600.0, "backward-euler")[:, 0, air]
    day = 31 + 27  # 28 February, counted from 0
    twice = np.concatenate([year[24 * day : 24 * (day + 1)]] * 2 + [year[24 * (day + 1) : 24 * (day + 2)]])
    # The seam differs by one value: what stands at 24:00 of the first 28 February opens the second.
    same = np.isclose(leap, twice)
    assert same.sum() >= 71
    assert denver.forcing(denver.site, "2024-12-30", "2025-01-02", 3600.0).shape[0] == 72


def test_actual_year_is_that_year(data_dir: Path) -> None:
    gillot = Climate.from_epw(data_dir / "weather" / "REU_Saint-Denis-Gillot_2023_AMY.epw")
    assert gillot.site is not None
    assert not gillot.grid.periodic
    assert gillot.index[0].isoformat() == "2023-01-01T00:00:00+04:00"
    with pytest.raises(InputError, match="outside the data, which cover 2023-01-01 00:00"):
        gillot.forcing(gillot.site, "2012-09-20", "2012-09-25", 900.0)
    typical = Climate.from_epw(data_dir / "weather" / "REU_Saint-Denis-Gillot_2023_AMY.epw", typical=True)
    assert typical.forcing(gillot.site, "2012-09-20", "2012-09-25", 900.0).shape[0] == 480


def changed(lines: list[str], row: int, change: Callable[[list[str]], None]) -> list[str]:
    fields = lines[row].split(",")
    change(fields)
    return [*lines[:row], ",".join(fields), *lines[row + 1 :]]


def set_field(place: int, text: str) -> Callable[[list[str]], None]:
    def change(fields: list[str]) -> None:
        fields[place] = text

    return change


DAMAGES: dict[str, tuple[Callable[[list[str]], list[str]], str]] = {
    "cut inside a line": (
        lambda x: [*x[:500], x[500][:40]],
        r"site.epw:501: found \d+ fields, expected 35.*get it whole",
    ),
    "cut between lines": (
        lambda x: x[:4000],
        "site.epw:4000: the file ends after 3992 hours, expected 8760.*get it whole",
    ),
    "a word for a number": (
        lambda x: changed(x, 99, set_field(6, "warm")),
        r"site.epw:100: air_temperature \(field 7\) is 'warm', expected a number; correct it, or write 99.9,",
    ),
    "not a number": (
        lambda x: changed(x, 99, set_field(13, "nan")),
        r"site.epw:100: global_horizontal \(field 14\) is 'nan', expected a finite number; .* write 9999,",
    ),
    "a row missing": (
        lambda x: [*x[:99], *x[100:]],
        r"site.epw:100: found 1/4 hour 21, expected 1/4 "
        "hour 20",
    ),
    "a row twice": (lambda x: [*x[:99], x[98], *x[99:]], "site.epw:100: found .* a row is missing or twice"),
    "no location": (lambda x: x[1:], "site.epw:1: expected the LOCATION line"),
    "latitude": (lambda x: changed(x, 0, set_field(6, "398.3")), "site.epw:1: latitude is '398.3'"),
    "half-hourly": (
        lambda x: changed(x, 7, set_field(2, "2")),
        "site.epw:10: .* expected 2 rows of each hour",
    ),
    "seven an hour": (lambda x: changed(x, 7, set_field(2, "7")), "site.epw:8: found '7' records per hour"),
    "date": (
        lambda x: changed(x, 20, set_field(1, "Jan")),
        "site.epw:21: date .* is not year,month,day,hour",
    ),
    "empty": (lambda x: [], "site.epw:1: expected the LOCATION line"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_epw_names_the_line(epw_lines: list[str], tmp_path: Path, damage: str) -> None:
    change, words = DAMAGES[damage]
    path = tmp_path / "site.epw"
    path.write_text("\n".join(change(epw_lines)), encoding="utf-8")
    with pytest.raises(InputError, match=words):
        Climate.from_epw(path)


def test_codes_for_missing_values_in_epw(epw_lines: list[str], tmp_path: Path) -> None:
    lines = epw_lines
    for row in range(8, len(lines)):
        fields = lines[row].split(",")
        fields[12] = "9999"
        lines = [*lines[:row], ",".join(fields), *lines[row + 1 :]] if row < 12 else lines
    path = tmp_path / "site.epw"
    path.write_text("\n".join(lines), encoding="utf-8")
    climate = Climate.from_epw(path)
    assert climate.site is not None
    infrared = climate.forcing(climate.site, "2001-01-01", "2001-01-02", 3600.0)[..., 3]
    # These hours have the model, the others what was measured.
    assert np.isfinite(infrared).all()
    assert any("infrared has no value in 4 of 8760 rows" in text for text in climate.record.warnings)
    assert climate.forcing(climate.site, "2001-01-02", "2001-01-03", 3600.0).shape[0] == 24


def tmy3(lines: list[str]) -> list[str]:
    """The same year as a TMY3 table with the columns that are read."""
    head = '725650,"DENVER INTL AP",CO,-7.0,39.830,-104.650,1650'
    names = (
        "Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),DNI (W/m^2),DHI (W/m^2),OpqCld (tenths),Dry-bulb (C),"
        "Dew-point (C),RHum (%),Pressure (mbar),Wdir (degrees),Wspd (m/s)"
    )
    body = []
    for line in lines[8:]:
        f = line.split(",")
        date = f"{int(f[1]):02d}/{int(f[2]):02d}/{f[0]},{int(f[3]):02d}:00"
        body.append(
            ",".join(
                [date, f[13], f[14], f[15], f[23], f[6], f[7], f[8], str(float(f[9]) / 100), f[20], f[21]]
            )
        )
    return [head, names, *body]


def test_tmy3_gives_the_same_climate_without_infrared(
    denver: Climate, epw_lines: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "725650TY.csv"
    path.write_text("\n".join(tmy3(epw_lines)) + "\n", encoding="utf-8")
    climate = Climate.from_tmy(path)
    assert climate.site is not None
    assert climate.site.altitude == 1650.0
    assert climate.grid.periodic
    arguments = ("2001-06-01", "2001-06-08", 900.0)
    own, other = climate.forcing(climate.site, *arguments), denver.forcing(climate.site, *arguments)
    infrared = CHANNELS.index("infrared")
    assert np.isnan(own[..., infrared]).all()
    keep = [place for place in range(len(CHANNELS)) if place != infrared]
    assert np.max(np.abs(own[..., keep] - other[..., keep])) < 1e-9


def test_damaged_tmy3_is_refused(epw_lines: list[str], tmp_path: Path) -> None:
    lines = tmy3(epw_lines)
    path = tmp_path / "tmy.csv"
    path.write_text("\n".join(lines[:3000]), encoding="utf-8")
    with pytest.raises(InputError, match=r"tmy.csv: found 2998 rows, expected 8760"):
        Climate.from_tmy(path)
    path.write_text("\n".join(changed(lines, 700, set_field(6, "warm"))), encoding="utf-8")
    with pytest.raises(
        InputError, match=r"tmy.csv:701: air_temperature \(Dry-bulb \(C\)\) is 'warm', expected"
    ):
        Climate.from_tmy(path)
    path.write_text("time;T\n2024-01-01;3\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"tmy\.csv:1: expected the seven fields"):
        Climate.from_tmy(path)


def changed_epw(lines: list[str], line: int, place: int, text: str, folder: Path) -> Climate:
    path = folder / "site.epw"
    path.write_text("\n".join(changed(lines, line - 1, set_field(place, text))), encoding="utf-8")
    return Climate.from_epw(path)


@pytest.mark.parametrize(("line", "time"), [(100, "2001-01-04 20:00"), (8768, "2001-01-01 00:00")])
@pytest.mark.parametrize(("place", "channel"), [(6, "air_temperature"), (15, "diffuse_horizontal")])
def test_a_missing_value_is_named_with_its_own_line(
    epw_lines: list[str], tmp_path: Path, line: int, time: str, place: int, channel: str
) -> None:
    climate = changed_epw(epw_lines, line, place, "99.9" if place == 6 else "9999", tmp_path)
    assert climate.site is not None
    with pytest.raises(InputError, match=rf"^site.epw:{line}: {channel} has no value") as caught:
        climate.forcing(climate.site, "2001-01-01", "2002-01-01", 3600.0)
    assert place != 6 or time in str(caught.value)
    assert "or repair the file or fill it (in Python: fill_gaps('2h'))" in str(caught.value)


def test_impossible_values_are_refused_where_they_are_used(epw_lines: list[str], tmp_path: Path) -> None:
    climate = changed_epw(epw_lines, 100, 6, "83.15", tmp_path)
    assert climate.site is not None
    words = r"^site.epw:100: air_temperature is 83.15 at 2001-01-04 20:00, expected -90 .. 80 degC; correct"
    with pytest.raises(InputError, match=words):
        climate.forcing(climate.site, "2001-01-01", "2001-02-01", 3600.0)
    assert climate.forcing(climate.site, "2001-02-01", "2001-03-01", 3600.0).shape[0] == 28 * 24
    assert [stretch.kind for stretch in climate.quality()] == ["out_of_range", "spike"]


def test_infrared_of_zero_is_that_of_the_model(epw_lines: list[str], tmp_path: Path) -> None:
    climate = changed_epw(epw_lines, 100, 12, "0", tmp_path)
    assert climate.site is not None
    assert climate.forcing(climate.site, "2001-01-01", "2001-02-01", 3600.0)[..., 3].min() > 100.0
    assert not np.isnan(climate.forcing(climate.site, "2001-02-01", "2001-03-01", 3600.0)[..., 3]).any()


def test_a_leap_year_without_its_day_names_a_remedy_in_the_file(epw_lines: list[str], tmp_path: Path) -> None:
    rows = [",".join(["2024", *line.split(",")[1:]]) for line in epw_lines[8:]]
    path = tmp_path / "site.epw"
    path.write_text("\n".join([*epw_lines[:8], *rows]), encoding="utf-8")
    with pytest.raises(InputError, match=r"2024 has a 29 February.*write a year without one, such as 2023"):
        Climate.from_epw(path)
