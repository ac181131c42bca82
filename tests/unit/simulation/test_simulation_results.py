from __future__ import annotations

import json
import pickle
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import xarray as xr
from matplotlib.dates import num2date
from matplotlib.figure import Figure

from mascarin import __version__
from mascarin.errors import InputError
from mascarin.simulation.checks.energy import FLOWS, EnergyLedger
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind
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


def test_a_series_has_the_local_clock_beside_utc(run: Results) -> None:
    local = pd.DatetimeIndex(run["deep.temperature"]["local_time"].to_numpy())
    assert (local == run.index.tz_localize(None)).all()
    assert local[0] == pd.Timestamp("2001-10-27 00:00")
    # 02:00 to 03:00 stands twice on the night when daylight saving time ends.
    assert (local == pd.Timestamp("2001-10-28 02:30")).sum() == 2
    assert (run.to_xarray()["local_time"].to_numpy() == local).all()


def test_the_table_is_in_local_time(run: Results) -> None:
    table = run.to_dataframe()
    assert list(table.columns) == list(run)
    assert str(table.index[0]) == "2001-10-27 00:00:00+02:00"
    assert str(table.index[-1]) == "2001-10-28 12:00:00+01:00"
    assert table["deep.temperature"].to_numpy() == pytest.approx(run["deep.temperature"].to_numpy())


def test_names_and_aliases(run: Results) -> None:
    assert len(run) == 4
    assert list(run)[3] == "north.gap_lining_temperature"  # the name that was asked for
    assert np.array_equal(run["north.gap_lining_temperature"], run["north.interface_3_temperature"])


def test_results_are_a_mapping(run: Results) -> None:
    assert isinstance(run, Mapping)
    assert list(run.keys()) == list(run)
    assert [series.name for series in run.values()] == list(run)
    assert [name for name, _ in run.items()] == list(run)
    assert "north.gap_lining_temperature" in run  # an alias
    assert "sunny.air_temprature" not in run
    assert run.get("sunny.air_temprature") is None
    assert run.get("sunny.air_temprature", 0.0) == 0.0
    series = run.get("deep.temperature")
    assert series is not None
    assert np.array_equal(series, run["deep.temperature"])


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


def test_results_read_back_are_equal(run: Results, tmp_path: Path) -> None:
    file = tmp_path / "run.nc"
    full = replace(run, warnings=(RunWarning("surfaces.north, layer pcm: stayed solid", WarningKind.LATENT),))
    full.to_netcdf(file)
    back = Results.open(file)
    assert back == full
    assert back != run
    assert back != replace(full, records=full.records + 1e-12)
    assert back.provenance.to_dict() == full.provenance.to_dict()
    assert back.energy == full.energy
    assert back.warnings == full.warnings
    assert back.to_dataframe().equals(full.to_dataframe())
    assert back.index.tz is not None
    assert str(back.index[-1]) == "2001-10-28 12:00:00+01:00"
    assert back["north.gap_lining_temperature"].attrs == run["north.gap_lining_temperature"].attrs
    assert [file.name for file in tmp_path.iterdir()] == ["run.nc"]
    again = tmp_path / "again.nc"
    back.to_netcdf(again)
    assert Results.open(str(again)) == full


@pytest.mark.parametrize("ending", ["nc", "csv", "parquet"])
def test_every_kind_of_file_is_read_back_to_the_bit(run: Results, ending: str, tmp_path: Path) -> None:
    file = tmp_path / f"run.{ending}"
    run.write(file)
    assert Results.open(file) == run


def test_tables_have_units_and_local_times(run: Results, tmp_path: Path) -> None:
    run.write(tmp_path / "run.csv")
    run.write(tmp_path / "run.parquet")
    names = ["run.csv", "run.csv-metadata.json", "run.parquet"]
    assert sorted(file.name for file in tmp_path.iterdir()) == names
    beside = json.loads((tmp_path / names[1]).read_text(encoding="utf-8"))
    units = {column["titles"]: column.get("unit") for column in beside["tableSchema"]["columns"]}
    assert units == {"time": None, **{name: run[name].attrs["units"] for name in run}}
    assert beside["mascarin"]["mascarin_version"] == __version__
    made_from = json.loads(beside["mascarin"]["provenance"])
    assert len(made_from["building_sha256"]) == 64
    table = pd.read_csv(tmp_path / "run.csv")
    assert table["time"].iloc[-1] == str(run.index[-1])
    frame = pd.read_parquet(tmp_path / "run.parquet")
    assert frame.equals(run.to_dataframe())
    schema = pq.read_schema(tmp_path / "run.parquet")
    assert {name: schema.field(name).metadata[b"unit"].decode() for name in run} == {
        name: run[name].attrs["units"] for name in run
    }


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_tables_of_something_else_are_refused(run: Results, ending: str, tmp_path: Path) -> None:
    file = tmp_path / f"run.{ending}"
    run.write(file)
    if ending == "csv":
        Path(f"{file}-metadata.json").unlink()
    else:
        file.write_bytes(b"no parquet")
    with pytest.raises(InputError, match="found no results of a run"):
        Results.open(file)
    with pytest.raises(InputError, match=r"expected a file ending in \.nc, \.csv or \.parquet"):
        run.write(tmp_path / "run.xlsx")


@pytest.mark.parametrize(
    ("content", "message"),
    [(None, "no such file; give the path"), (b"no NetCDF", "found no results of a run")],
)
def test_files_of_something_else_are_refused(tmp_path: Path, content: bytes | None, message: str) -> None:
    file = tmp_path / "other.nc"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(InputError, match=rf"other\.nc: {message}"):
        Results.open(file)


def test_a_data_set_of_something_else_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "other.nc"
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(file, engine="h5netcdf")
    with pytest.raises(InputError, match="found no results of a run"):
        Results.open(file)


def test_results_can_be_pickled(run: Results) -> None:
    assert pickle.loads(pickle.dumps(run)) == run  # noqa: S301 (own data)


def test_results_are_described_in_a_few_lines(run: Results) -> None:
    lines = [RunWarning(f"warning {k}", WarningKind.STEP) for k in range(30)]
    text = repr(replace(run, warnings=tuple(lines)))
    assert len(text.splitlines()) == 15
    assert max(len(line) for line in text.splitlines()) <= 100
    assert "Results of 'linear'" in text
    assert "2001-10-27 00:00 to 2001-10-28 12:00 Europe/Paris" in text
    assert "relative residual" in text
    page = run._repr_html_()
    assert page.count("<details>") == 2
    assert "<svg" in page
    assert "deep.temperature" in page


def test_plot_has_axes_for_each_unit(run: Results) -> None:
    figure = run.plot()
    assert [axis.get_ylabel() for axis in figure.axes] == ["[°C]", "[W/m²]"]
    assert [len(axis.get_lines()) for axis in figure.axes] == [3, 1]
    drawn = figure.axes[1].get_lines()[0].get_ydata()
    assert np.array_equal(np.asarray(drawn), run["north.outside_flux"].to_numpy())
    assert "local time (Europe/Paris)" in figure.axes[1].get_xlabel()
    assert [len(axis.get_lines()) for axis in run.plot(["deep.temperature"]).axes] == [1]
    assert len(run.plot("deep.temperature").axes) == 1


def test_a_figure_is_known_to_pyplot(run: Results) -> None:
    from matplotlib import pyplot

    figure = run.plot(["deep.temperature"])
    assert figure.number in pyplot.get_fignums()
    pyplot.close(figure)


def test_plot_has_local_time_that_does_not_go_back(run: Results) -> None:
    axis = run.plot(["deep.temperature"]).axes[0]
    days = np.asarray(axis.get_lines()[0].get_xdata(), dtype=np.float64)
    # 25 hours in the second night: daylight saving time ends.
    assert np.diff(days) * 24.0 == pytest.approx(0.25)
    first, last = num2date([days[0], days[-1]], tz=run.index.tz)  # type: ignore[no-untyped-call]
    assert (f"{first:%d %H:%M}", f"{last:%d %H:%M}") == ("27 00:00", "28 12:00")
    locator = axis.xaxis.get_major_locator()
    assert str(getattr(locator, "tz", None)) == "Europe/Paris"


def test_plot_uses_the_axes_of_the_reader(run: Results) -> None:
    figure = Figure()
    above, below = figure.subplots(2, 1)
    assert run.plot(["deep.temperature"], ax=below) is figure
    assert (len(above.get_lines()), len(below.get_lines())) == (0, 1)
    assert below.get_ylabel() == "[°C]"
    run.plot(ax=[above, below])
    assert (len(above.get_lines()), len(below.get_lines())) == (3, 2)
    one = Figure().subplots()
    run.plot(ax=one)
    assert len(one.get_lines()) == 4
    assert one.get_ylabel() == "[°C], [W/m²]"
    with pytest.raises(InputError, match="found 3 axes, expected one, or one for each unit"):
        run.plot(ax=[above, below, one])


def test_the_ledger_adds_up(run: Results) -> None:
    ledger = run.energy
    assert set(ledger.into) == set(FLOWS)
    assert ledger.stored == pytest.approx(sum(ledger.into.values()), rel=1e-9)
    assert ledger.turnover >= sum(abs(value) for value in ledger.into.values())
    assert 0.0 <= ledger.relative_residual <= 1e-10
    assert ledger.closure == ledger.relative_residual


def test_the_ledger_counts_the_heat_absorbed_at_surfaces(run: Results) -> None:
    # The sun reaches this building through one pyranometer: absorptance 0.5, 12 m2, means of straight pieces.
    t = 900.0 * np.arange(37 * 4 + 1)
    sun = np.interp(t, hours(2), measured(2)["pyranometer"])
    # Stages at (g, 1) with weights (1 - g, g): exact for straight lines.
    absorbed = 0.5 * 12.0 * np.trapezoid(sun, t)
    assert run.energy.into["solar"] == pytest.approx(absorbed, rel=1e-9)


def test_the_ledger_as_text_and_for_json() -> None:
    raw = {flow: 3.6e6 * (k + 1) for k, flow in enumerate(FLOWS)} | {
        "stored": 54e6, "turnover": 60e6, "closure": 2e-13,
    }  # fmt: skip
    ledger = EnergyLedger.read(raw)
    assert EnergyLedger.from_dict(ledger.to_dict()) == ledger
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
    flux = run.to_dataframe()["north.outside_flux"].to_numpy()
    means = flux[1:].reshape(-1, 4).mean(axis=1)
    np.testing.assert_allclose(hourly.to_dataframe()["north.outside_flux"].to_numpy()[1:], means, rtol=1e-12)
    air = run.to_dataframe()["sunny.air_temperature"].to_numpy()
    np.testing.assert_allclose(
        hourly.to_dataframe()["sunny.air_temperature"].to_numpy(), air[::4], rtol=1e-12
    )
    between = run.every("10min").to_dataframe()["sunny.air_temperature"].to_numpy()
    assert between[1] == pytest.approx(air[0] + (air[1] - air[0]) * 10 / 15)
    with pytest.raises(InputError, match="shorter than the run"):
        run.every("3d")
