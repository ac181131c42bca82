"""Climate and Measurements as objects: descriptions, plots, frames, pickling."""

from __future__ import annotations

import pickle

import matplotlib as mpl
import matplotlib.dates
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.weather import Climate, Measurements, Place

mpl.use("Agg")
SITE = Place(-21.34, 55.48, 55.0, "Saint-Pierre")


@pytest.fixture(scope="module")
def climate() -> Climate:
    index = pd.date_range("2024-06-01", periods=48, freq="1h", tz="Indian/Reunion")
    hour = np.arange(48) % 24
    sun = np.maximum(0.0, np.cos(2.0 * np.pi * (hour + 0.25 - 12.0) / 24.0))
    table = pd.DataFrame({"T": 20.0 + 5.0 * sun, "G": 600.0 * sun, "plane": 300.0 * sun}, index=index)
    return Climate.from_table(
        table,
        columns={"air_temperature": "T", "global_horizontal": "G"},
        extra=["plane"],
        absent=["dew_point", "wind_speed", "wind_direction"],
        latitude=SITE.latitude,
        longitude=SITE.longitude,
        altitude=SITE.altitude,
    )


@pytest.fixture(scope="module")
def measured(climate: Climate) -> Measurements:
    return Measurements.from_table(climate.to_dataframe()[["plane", "air_temperature"]], mean=["plane"])


def test_descriptions_are_short_and_name_the_local_time(climate: Climate, measured: Measurements) -> None:
    for thing in (climate, measured):
        lines = repr(thing).splitlines()
        assert len(lines) <= 15
        assert "Indian/Reunion" in repr(thing)
        page = thing._repr_html_()
        assert page.count("<svg") >= 1
        assert "<table" in page
    assert "55 m" in repr(climate)
    plt.close("all")


def test_a_frame_is_a_copy_in_local_time(climate: Climate) -> None:
    frame = climate.to_dataframe()
    assert str(frame.index.tz) == "Indian/Reunion"  # type: ignore[attr-defined]
    frame["air_temperature"] = 0.0
    assert climate.to_dataframe()["air_temperature"].iloc[0] >= 20.0


def test_a_plot_uses_the_axes_and_the_local_time_of_the_reader(climate: Climate) -> None:
    figure, axes = plt.subplots()
    assert climate.plot("air_temperature", ax=axes) is axes
    assert "Indian/Reunion" in axes.get_xlabel()
    assert axes.get_ylabel() == "[°C]"
    days = np.asarray(axes.lines[0].get_xdata(), dtype=np.float64)
    first = matplotlib.dates.num2date(days[0], tz=climate.index.tz)  # type: ignore[no-untyped-call]
    assert first.isoformat() == "2024-06-01T00:00:00+04:00"
    figure.canvas.draw()
    labels = [label.get_text() for label in axes.get_xticklabels()]
    assert "Jun" in labels[0] or "Jun" in "".join(labels)
    own = climate.plot(["global_horizontal", "direct_normal"])
    assert len(own.lines) == 2
    with pytest.raises(InputError, match="several units"):
        climate.plot(["air_temperature", "global_horizontal"])
    with pytest.raises(InputError, match="Did you mean 'air_temperature'"):
        climate.plot("air_temprature")
    plt.close("all")


def test_a_climate_can_be_pickled(climate: Climate, measured: Measurements) -> None:
    again: Climate = pickle.loads(pickle.dumps(climate))  # noqa: S301
    pd.testing.assert_frame_equal(again.to_dataframe(), climate.to_dataframe())
    period = ("2024-06-01", "2024-06-02", 900.0)
    np.testing.assert_array_equal(again.forcing(SITE, *period), climate.forcing(SITE, *period))
    copied: Measurements = pickle.loads(pickle.dumps(measured))  # noqa: S301
    pd.testing.assert_frame_equal(copied.to_dataframe(), measured.to_dataframe())


def test_names_are_few(climate: Climate, measured: Measurements) -> None:
    public = [name for name in dir(climate) if not name.startswith("_")]
    assert len(public) <= 26, public
    assert {"from_epw", "from_tmy", "from_table", "from_pvlib", "to_dataframe", "plot"} <= set(public)
    assert len([name for name in dir(measured) if not name.startswith("_")]) <= 24


def test_a_frame_without_a_zone_needs_one(climate: Climate) -> None:
    naive = climate.to_dataframe().tz_localize(None)
    with pytest.raises(InputError, match="table: timezone: a time zone is required"):
        Measurements.from_table(naive)
    assert Measurements.from_table(naive, timezone="Indian/Reunion").index[0] == climate.index[0]
