"""Frames of pvlib.iotools: the same weather as in the file, for stamps at any part of an interval."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pvlib
import pytest

from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from mascarin.weather import CHANNELS, STAGES, Climate
from mascarin.weather.derived.sun import SunPath

LATITUDE, LONGITUDE = 45.8, 4.8
GREENSBORO = Path(pvlib.__file__).parent / "data" / "723170TYA.CSV"
STILL = {"wind_speed": 0.0, "wind_direction": 0.0}


def sun_up(index: pd.DatetimeIndex) -> Any:
    seconds = epoch_seconds(index)
    return np.maximum(SunPath.over(LATITUDE, LONGITUDE, seconds[0], seconds[-1]).vector(seconds)[:, 2], 0.0)


def frame(stamps: str, step: str = "1h", days: int = 3) -> pd.DataFrame:
    """Sky and temperature by means over intervals, with stamps at one part of them; the sun decides."""
    fine = pd.date_range("2024-06-01", periods=days * 1440, freq="1min", tz="UTC")
    up = sun_up(fine)
    whole = pd.DataFrame(
        {"ghi": 700.0 * up + 100.0 * (up > 0.0), "dhi": 100.0 * (up > 0.0), "temp_air": 15.0 + 5.0 * up},
        index=fine,
    )
    means = whole.resample(step).mean()
    means["relative_humidity"] = 60.0
    shift = {"start": 0.0, "middle": 0.5, "end": 1.0}[stamps]
    return means.set_axis(means.index + shift * pd.Timedelta(step), axis=0)


def read(data: Any, **options: Any) -> Climate:
    given: dict[str, Any] = {"latitude": LATITUDE, "longitude": LONGITUDE, "absent": STILL}
    return Climate.from_pvlib(data, **(given | options))


@pytest.mark.parametrize("stamps", ["start", "middle", "end"])
def test_means_belong_to_the_interval_that_the_stamp_marks(stamps: Any) -> None:
    climate = read(frame(stamps), stamps=stamps)
    expected = frame("start")
    assert climate.index[0].isoformat() == "2024-06-01T00:00:00+00:00"
    assert climate.timezone == "UTC"
    np.testing.assert_array_equal(climate.data["global_horizontal"], expected["ghi"])
    assert climate.kinds["global_horizontal"] == "mean"
    assert climate.kinds["air_temperature"] == ("mean" if stamps == "middle" else "instant")
    weights = np.array(STAGES["sdirk2"][1])
    place = climate.site
    assert place is not None
    forcing = climate.forcing(place, "2024-06-01", "2024-06-03", 3600.0)
    total = forcing[..., CHANNELS.index("global_horizontal")] @ weights
    assert np.max(np.abs(total - expected["ghi"].to_numpy()[:48])) < 1e-9
    if stamps == "middle":
        air = forcing[..., CHANNELS.index("air_temperature")] @ weights
        assert np.max(np.abs(air - expected["temp_air"].to_numpy()[:48])) < 1e-9


def test_instantaneous_values_stay_at_their_stamps() -> None:
    index = pd.date_range("2024-06-01 00:10", periods=72, freq="1h", tz="UTC")
    up = sun_up(index)
    parts = {"poa_direct": 600.0 * up, "poa_sky_diffuse": 100.0 * up, "poa_ground_diffuse": 0.0}
    data = pd.DataFrame({**parts, "temp_air": 15.0, "wind_speed": 2.0}, index=index)
    meta = {"inputs": {"location": {"latitude": LATITUDE, "longitude": LONGITUDE, "elevation": 170.0}}}
    climate = Climate.from_pvlib((data, meta), stamps="instant", absent=["dew_point", "wind_direction"])
    assert climate.site is not None
    assert climate.site.altitude == 170.0
    assert climate.kinds["global_horizontal"] == "instant"
    assert climate.index[0].minute == 10
    np.testing.assert_allclose(climate.data["global_horizontal"], 700.0 * up)
    with pytest.raises(InputError, match=r"inclined plane .poa_global.*surface_tilt=0"):
        read(pd.DataFrame({"poa_global": 600.0 * up, "temp_air": 15.0}, index=index), stamps="instant")


def test_a_shift_of_the_stamps_is_found_by_the_sun() -> None:
    with pytest.raises(InputError, match="does not follow the sun"):
        read(frame("end").shift(3, freq="1h"), stamps="end")


def test_tmy3_is_the_same_as_from_its_file() -> None:
    whole = Climate.from_tmy(GREENSBORO)
    climate = Climate.from_pvlib(pvlib.iotools.read_tmy3(GREENSBORO, map_variables=True))
    assert climate.grid.periodic
    place = whole.site
    assert place is not None
    period = ("2015-12-28", "2016-03-03", 3600.0)
    ours, theirs = climate.forcing(place, *period), whole.forcing(place, *period)
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-9, equal_nan=True)


def test_epw_is_the_same_as_from_its_file(data_dir: Path) -> None:
    path = data_dir / "bestest" / "725650TYCST.epw"
    whole = Climate.from_epw(path)
    climate = Climate.from_pvlib(pvlib.iotools.read_epw(path))
    assert climate.grid.periodic
    place = whole.site
    assert place is not None
    period = ("2015-12-28", "2016-03-03", 3600.0)
    ours, theirs = climate.forcing(place, *period), whole.forcing(place, *period)
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-9, equal_nan=True)


def test_typical_year_of_pvgis_is_repeated() -> None:
    index = pd.date_range("1990-01-01", periods=8760, freq="1h", tz="UTC")
    up = sun_up(index)
    data = pd.DataFrame(
        {
            "temp_air": np.arange(8760.0) / 1000.0,
            "relative_humidity": 70.0,
            "ghi": 700.0 * up,
            "dni": 600.0 * (up > 0.0),
            "dhi": 100.0 * up,
            "IR(h)": 320.0,
            "wind_speed": 2.0,
            "wind_direction": 90.0,
            "pressure": 99000.0,
        },
        index=index,
    )
    data["dhi"] = data["ghi"] - data["dni"] * up
    meta = {"months_selected": [{"month": 1, "year": 2010}], "inputs": {"location": {"latitude": 45.8}}}
    climate = Climate.from_pvlib((data, meta), longitude=LONGITUDE, stamps="instant", check_sun=False)
    assert climate.grid.periodic
    assert climate.kinds["infrared"] == "instant"
    place = climate.site
    assert place is not None
    forcing = climate.forcing(place, "2022-12-31 22:00", "2023-01-01 02:00", 3600.0, "backward-euler")
    # Hours 23:00 of the last day, then 0:00 and 1:00 of the same year.
    assert forcing[:, 0, CHANNELS.index("air_temperature")] == pytest.approx([8.759, 0.0, 0.001, 0.002])


def test_reanalysis_gives_diffuse_and_wind_by_components() -> None:
    data = frame("end").drop(columns=["dhi", "relative_humidity"])
    data["bhi"] = frame("end")["ghi"] - frame("end")["dhi"]
    data["temp_dew"], data["pressure"], data["longwave_down"] = 8.0, 98000.0, 330.0
    data["u10"], data["v10"] = 3.0, -4.0  # to the east and to the south: wind from the north-west
    climate = Climate.from_pvlib(data, latitude=LATITUDE, longitude=LONGITUDE)
    np.testing.assert_allclose(climate.data["diffuse_horizontal"], frame("start")["dhi"], atol=1e-9)
    assert climate.data["wind_speed"].iloc[0] == pytest.approx(5.0)
    assert climate.data["wind_direction"].iloc[0] == pytest.approx(323.13, abs=0.01)
    assert climate.data["infrared"].iloc[0] == 330.0


def test_pressure_in_hpa_is_recognized() -> None:
    data = frame("middle").assign(pressure=985.0)
    climate = read(data, stamps="middle")
    assert climate.data["pressure"].iloc[0] == 98500.0
    assert any("hPa" in text for text in climate.provenance)


@pytest.mark.parametrize(
    ("data", "options", "words"),
    [
        (frame("start"), {}, "not known what the stamps mark; state stamps='start', 'middle' or 'end'"),
        (frame("start"), {"stamps": "left"}, "stamps is 'left'"),
        (frame("start").tz_localize(None), {"stamps": "start"}, "stamps have no time zone"),
        (frame("start").reset_index(drop=True), {"stamps": "start"}, "index of the frame is RangeIndex"),
        (frame("start"), {"stamps": "start", "latitude": None}, "latitude and longitude are not known"),
        (frame("start"), {"stamps": "start", "absent": ()}, "no column for wind_speed"),
        (frame("start"), {"stamps": "start", "typical": True}, "rows"),
        (frame("start"), {"stamps": "start", "typical": True, "timezone": "Europe/Paris"}, "summer time"),
    ],
)
def test_what_cannot_be_known_is_refused(data: Any, options: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read(data, **options)


def test_stamps_without_a_zone_are_read_in_the_zone_that_is_stated() -> None:
    data = frame("start")
    local = data.tz_convert("Europe/Paris").tz_localize(None)
    climate = read(local, stamps="start", timezone="Europe/Paris")
    assert climate.timezone == "Europe/Paris"
    assert climate.index[0] == data.index[0]
