"""Times of a series are selected with their offset: nothing is taken as UTC or as local time by silence."""

from __future__ import annotations

from datetime import datetime
from typing import Any
from zoneinfo import ZoneInfo

import pandas as pd
import pytest
import xarray as xr

import mascarin as mc
from mascarin.ensemble import Statistic
from mascarin.errors import InputError
from mascarin.examples import box, box_climate

DENVER = ZoneInfo("Etc/GMT+7")


@pytest.fixture(scope="module")
def air() -> xr.DataArray:
    return mc.simulate(box(), box_climate(), step="1h")["room.air_temperature"]


def test_a_time_with_an_offset_is_that_time(air: xr.DataArray) -> None:
    expected = float(air[12])
    assert expected != float(air[19])
    for time in (
        "2001-07-01 12:00-07:00",
        "2001-07-01 19:00Z",
        datetime(2001, 7, 1, 12, tzinfo=DENVER),
        pd.Timestamp("2001-07-01 21:00+02:00"),
        air["time"].to_numpy()[12],  # a value of the coordinate is UTC
    ):
        assert float(air.sel(time=time)) == expected
        assert float(air.sel({"time": time})) == expected
    part = air.sel(time=slice("2001-07-01 12:00-07:00", None))
    assert float(part[0]) == expected
    assert air.sel(time=["2001-07-01 12:00-07:00"]).to_numpy().tolist() == [expected]
    times = pd.DatetimeIndex(["2001-07-01 12:00"], tz=DENVER)
    assert air.sel(time=times).to_numpy().tolist() == [expected]
    assert float(air.sel(time="2001-07-01 12:01-07:00", method="nearest")) == expected
    # Without a time, and after arithmetic, it is a series of xarray as any other.
    assert float((air - 1.0).sel(time="2001-07-01 12:00-07:00")) == pytest.approx(expected - 1.0)
    assert air.sel().equals(air)


@pytest.mark.parametrize(
    "time",
    [
        "2001-07-01 12:00",
        "2001-07-01",
        slice("2001-07-01", None),
        datetime(2001, 7, 1, 12),
        ["2001-07-01 12:00"],
    ],
)
def test_a_time_without_an_offset_is_refused_with_two_that_work(air: xr.DataArray, time: object) -> None:
    with pytest.raises(InputError, match="without an offset") as error:
        air.sel(time=time)
    proposed = str(error.value).split("UTC: '")[1].split("'")[0]
    assert proposed == "2001-07-01 00:00-07:00"
    assert float(air.sel(time=proposed)) == float(air[0])


def test_a_time_beside_the_records_is_refused_with_what_there_is(air: xr.DataArray) -> None:
    with pytest.raises(InputError, match=r"from 2001-07-01 00:00-07:00 to .*method='nearest'"):
        air.sel(time="2003-07-01 12:00-07:00")
    with pytest.raises(InputError, match="found 'noon'"):
        air.sel(time="noon")
    with pytest.raises(InputError, match="from 2001-07-01 07:00Z"):
        air.drop_vars("local_time").sel(time="2003-07-01 12:00Z")


def test_objectives_may_be_texts() -> None:
    samples = {"surfaces.facade.outside.absorptance": [0.3, 0.6]}
    texts = {"hot": "above:26:room.operative_temperature", "peak": "max:room.air_temperature"}
    functions = {name: Statistic.read(text) for name, text in texts.items()}
    outputs = ["room.operative_temperature", "room.air_temperature"]
    by_text = mc.sweep(box(), box_climate(), samples, step="1h", objectives=texts)
    by_function = mc.sweep(box(), box_climate(), samples, step="1h", objectives=functions, outputs=outputs)
    assert by_text["hot"].to_numpy().tolist() == by_function["hot"].to_numpy().tolist()
    assert by_text["peak"].to_numpy().tolist() == by_function["peak"].to_numpy().tolist()
    assert by_text["peak"][1] > by_text["peak"][0]
    # Beside a function, which may read any usual output.
    mixed: dict[str, Any] = {**texts, "mean": lambda run: run["facade.inside_temperature"].mean("time")}
    assert mc.sweep(box(), box_climate(), samples, step="1h", objectives=mixed)["mean"].shape == (2,)
    with pytest.raises(InputError, match="expected min, mean, max or sd"):
        mc.sweep(box(), box_climate(), samples, step="1h", objectives={"hot": "degree hours"})
