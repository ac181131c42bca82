from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from mascarin import __version__
from mascarin.errors import InputError
from mascarin.simulation.energy import FLOWS, EnergyLedger
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.weather import Climate
from simulation_samples import LINEAR, hours, measured, read


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """A day and a half over the end of daylight saving time, local time of Paris."""
    t = hours(2)
    index = pd.date_range("2001-10-27", periods=len(t), freq="1h", tz="Europe/Paris")
    columns = {"air_temperature": 12.0 - 4.0 * np.cos(t / 13751.0), **measured(2)}
    climate = Climate.from_table(
        pd.DataFrame(columns, index=index),
        timezone="Europe/Paris",
        columns={"air_temperature": "air_temperature"},
        extra=list(measured(2)),
        absent=["dew_point", "wind_speed", "wind_direction", "radiation"],
    )
    building = read(LINEAR, tmp_path_factory.mktemp("results"))
    names = [
        "sunny.air_temperature",
        "north.outside_flux",
        "deep.temperature",
        "north.gap_lining_temperature",
    ]
    return simulate(building, climate, step="15min", end="2001-10-28 12:00", outputs=names, initial=15.0)


def test_a_series_is_labelled_in_utc_with_unit_and_zone(run: Results) -> None:
    series = run["sunny.air_temperature"]
    assert series.attrs == {
        "units": "degC",
        "long_name": "sunny.air_temperature",
        "timezone": "Europe/Paris",
    }
    time = pd.DatetimeIndex(series["time"].to_numpy())
    assert time.tz is None
    assert time[0] == pd.Timestamp("2001-10-26 22:00")  # midnight of Paris in summer
    assert time[-1] == pd.Timestamp("2001-10-28 11:00")  # noon of Paris in winter: 37 hours later
    assert len(time) == 37 * 4 + 1
    assert run["north.outside_flux"].attrs["units"] == "W/m2"


def test_the_table_is_in_local_time(run: Results) -> None:
    table = run.frame()
    assert list(table.columns) == list(run)
    assert str(table.index[0]) == "2001-10-27 00:00:00+02:00"
    assert str(table.index[-1]) == "2001-10-28 12:00:00+01:00"
    assert table["deep.temperature"].to_numpy() == pytest.approx(run["deep.temperature"].to_numpy())


def test_names_and_aliases(run: Results) -> None:
    assert len(run) == 4
    assert list(run)[3] == "north.interface_3_temperature"
    assert np.array_equal(run["north.gap_lining_temperature"], run["north.interface_3_temperature"])


def test_a_name_that_was_not_recorded(run: Results) -> None:
    with pytest.raises(InputError) as caught:
        run["sunny.air_temprature"]
    assert "not recorded in this run; name it in outputs=" in str(caught.value)
    assert "'sunny.air_temperature'" in str(caught.value)


def test_netcdf_and_back(run: Results, tmp_path: Path) -> None:
    file = tmp_path / "run.nc"
    run.to_netcdf(file)
    with xr.open_dataset(file, engine="h5netcdf") as back:
        assert list(back.data_vars) == list(run)
        for name in run:
            assert np.array_equal(back[name].to_numpy(), run[name].to_numpy())
            assert back[name].attrs["units"] == run[name].attrs["units"]
        assert np.array_equal(back["time"].to_numpy(), run["deep.temperature"]["time"].to_numpy())
        assert back.attrs["mascarin_version"] == __version__
        assert back.attrs["timezone"] == "Europe/Paris"
        assert json.loads(back.attrs["energy"]) == run.energy.to_dict()
        assert json.loads(back.attrs["provenance"]) == run.provenance.to_dict()


def test_plot_has_an_axis_for_each_unit(run: Results) -> None:
    figure = run.plot()
    assert [axis.get_ylabel() for axis in figure.axes] == ["degC", "W/m2"]
    assert [len(axis.get_lines()) for axis in figure.axes] == [3, 1]
    drawn = figure.axes[1].get_lines()[0].get_ydata()
    assert np.array_equal(np.asarray(drawn), run["north.outside_flux"].to_numpy())
    assert "Europe/Paris" in figure.axes[1].get_xlabel()
    assert [len(axis.get_lines()) for axis in run.plot(["deep.temperature"]).axes] == [1]


def test_the_ledger_adds_up(run: Results) -> None:
    ledger = run.energy
    assert set(ledger.into) == set(FLOWS)
    assert ledger.stored == pytest.approx(sum(ledger.into.values()), rel=1e-9)
    assert ledger.turnover >= sum(abs(value) for value in ledger.into.values())
    assert 0.0 <= ledger.closure <= 1e-10


def test_the_ledger_counts_what_the_faces_pass(run: Results) -> None:
    # The sun reaches this building through one pyranometer: absorptance 0.5, 12 m2, means of straight pieces.
    t = 900.0 * np.arange(37 * 4 + 1)
    sun = np.interp(t, hours(2), measured(2)["pyranometer"])
    # Stages at (g, 1) with weights (1 - g, g): exact for straight lines.
    absorbed = 0.5 * 12.0 * np.trapezoid(sun, t)
    assert run.energy.into["solar"] == pytest.approx(absorbed, rel=1e-9)


def test_the_ledger_in_words_and_for_json() -> None:
    raw = {flow: 3.6e6 * (k + 1) for k, flow in enumerate(FLOWS)} | {
        "stored": 54e6, "turnover": 60e6, "closure": 2e-13,
    }  # fmt: skip
    ledger = EnergyLedger.read(raw)
    assert ledger.to_dict()["solar_joule"] == 3.6e6
    assert ledger.to_dict()["closure"] == 2e-13
    lines = str(ledger).splitlines()
    assert lines[0].split() == ["solar", "1.000", "kWh"]
    assert lines[-2].split() == ["stored", "15.000", "kWh"]
    assert lines[-1] == "relative energy-balance residual 2.0e-13"


def test_another_spacing_keeps_states_and_heat(run: Results) -> None:
    hourly = run.every("1h")
    assert len(hourly.index) == 38
    assert hourly.index[1] - hourly.index[0] == pd.Timedelta("1h")
    flux = run.frame()["north.outside_flux"].to_numpy()
    means = flux[1:].reshape(-1, 4).mean(axis=1)
    np.testing.assert_allclose(hourly.frame()["north.outside_flux"].to_numpy()[1:], means, rtol=1e-12)
    air = run.frame()["sunny.air_temperature"].to_numpy()
    np.testing.assert_allclose(hourly.frame()["sunny.air_temperature"].to_numpy(), air[::4], rtol=1e-12)
    between = run.every("10min").frame()["sunny.air_temperature"].to_numpy()
    assert between[1] == pytest.approx(air[0] + (air[1] - air[0]) * 10 / 15)
    with pytest.raises(InputError, match="shorter than the run"):
        run.every("3d")
