"""Times of a series are selected with their offset: nothing is taken as UTC or as local time by silence."""

from __future__ import annotations

import tempfile
from datetime import datetime
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

import pandas as pd
import pytest
import xarray as xr

import mascarin as mc
from mascarin.ensemble import Statistic, sweep_into
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


def data_sets() -> dict[str, xr.Dataset]:
    """Every data set over time that the package gives."""
    path = "surfaces.facade.outside.absorptance"
    outputs = ["room.air_temperature"]
    run = mc.simulate(box(), box_climate(), step="1h", outputs=outputs)
    with tempfile.TemporaryDirectory() as folder:
        samples = {path: [0.3, 0.6]}
        store = sweep_into(f"{folder}/s", box(), box_climate(), samples, step="1h", outputs=outputs)
        stored = store.to_xarray()
    return {
        "run": run.to_xarray(),
        "sweep": mc.sweep(box(), box_climate(), samples, step="1h", outputs=outputs),
        "store": stored,
        "jacobian": mc.jacobian(box(), box_climate(), [path], step="1h", outputs=outputs),
    }


def test_every_data_set_asks_for_the_offset_as_a_run_does() -> None:
    name, noon = "room.air_temperature", "2001-07-01 12:00-07:00"
    for kind, data in data_sets().items():
        by_position = data[name].isel(time=12).to_numpy()
        assert by_position.tolist() != data[name].isel(time=19).to_numpy().tolist(), kind
        assert data.sel(time=noon)[name].to_numpy().tolist() == by_position.tolist(), kind
        assert data[name].sel(time=noon).to_numpy().tolist() == by_position.tolist(), kind
        # Also after a part was taken, members and coordinates were changed, and by names in brackets.
        for part in (data[[name]], data.assign_attrs(a=1), data.copy(), data.isel(time=slice(2, None))):
            for chosen in (part, part[name]):
                with pytest.raises(InputError, match=r"without an offset.*2001-07-01 0\d:00-07:00'"):
                    chosen.sel(time="2001-07-01 12:00")
        with pytest.raises(InputError, match="expected the time of a record from 2001-07-01 00:00-07:00"):
            data.sel(time="2003-07-01 12:00Z")
        assert data["time"].attrs["long_name"] == "time (UTC)", kind
        assert data["local_time"].attrs["long_name"].startswith("local time"), kind
        assert data.attrs["timezone"], kind


def test_what_is_not_a_time_is_missed_in_the_words_of_xarray() -> None:
    sweep = data_sets()["sweep"]
    with pytest.raises(KeyError, match="member"):
        sweep.sel(member=99, time="2001-07-01 12:00-07:00")
    assert sweep.sel(member=1)["room.air_temperature"].dims == ("time",)


def test_files_say_which_clock_their_times_are(tmp_path: Path) -> None:
    mc.simulate(box(), box_climate(), step="1h").to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as data:
        assert data["time"].attrs["long_name"] == "time (UTC)"
        assert data["local_time"].attrs["long_name"] == "local time (zone: attribute timezone)"


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
