from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.tables.quality import Stretch, find, mask, runs
from mascarin.weather import Climate, Measurements

SHARED = {"time": "AAAAMMJJHH", "time_format": "%Y%m%d%H", "stamps": "end"}


def of_kind(stretches: list[Stretch], kind: str) -> dict[str, list[Stretch]]:
    found: dict[str, list[Stretch]] = {}
    for stretch in stretches:
        if stretch.kind == kind:
            found.setdefault(stretch.channel, []).append(stretch)
    return found


# ---------------------------------------------------------------------- real records


def test_wall_bench_dead_sensor_and_filled_end_are_found(data_dir: Path) -> None:
    measured = Measurements.from_table(
        data_dir / "wall_bench" / "wall_bench_2024.csv", timezone="Europe/Paris"
    )
    stretches = measured.quality()
    stuck = of_kind(stretches, "stuck")
    assert list(stuck) == ["T_ins_1"]
    (dead,) = stuck["T_ins_1"]
    assert abs(dead.start - pd.Timestamp("2024-09-07 05:08", tz="Europe/Paris")) <= pd.Timedelta("2min")
    assert dead.end == measured.index[-1]
    assert "20.4436" in dead.detail
    filled = of_kind(stretches, "forward_filled")
    temperatures = [name for name in measured.data.columns if name != "Pyr"]
    assert sorted(filled) == sorted(temperatures)
    for (stretch,) in filled.values():
        assert stretch.count == pytest.approx(49, abs=1)
        assert stretch.end == measured.index[-1]
    assert len(stretches) == 1 + len(temperatures)


@pytest.mark.parametrize("every", ["1min", "5min", "15min", "1h"])
@pytest.mark.parametrize("digits", [1, 3, 12])
def test_dead_sensor_is_found_in_coarser_copies_too(data_dir: Path, every: str, digits: int) -> None:
    path = data_dir / "wall_bench" / "wall_bench_2024.csv"
    data = Measurements.from_table(path, timezone="UTC").data
    stretches = find(data.resample(every).mean().round(digits))
    (dead,) = of_kind(stretches, "stuck")["T_ins_1"]
    assert abs(dead.start - pd.Timestamp("2024-09-07 05:08", tz="UTC")) <= pd.Timedelta("2h")
    assert {s.channel for s in stretches if s.kind not in ("stuck", "forward_filled")} == set()
    assert list(of_kind(stretches, "stuck")) == ["T_ins_1"]


def test_good_channels_of_the_virtual_experiment_raise_no_alarm(repository: Path) -> None:
    path = repository / "python" / "mascarin" / "examples" / "lgi" / "lgi_virtual.csv"
    assert Measurements.from_table(path, timezone="UTC+4").quality() == []


def test_real_hourly_record_raises_only_its_true_gap(data_dir: Path) -> None:
    names = ["T", "TD", "U", "FF", "DD", "PSTAT", "RR1", "GLO", "INS", "T20", "T50", "T100", "TSV"]
    path = data_dir / "weather" / "gillot_2023_meteo_france.csv"
    options: dict[str, Any] = dict(SHARED)
    stretches = Measurements.from_table(path, timezone="UTC+4", columns=names, **options).quality()
    assert [(s.channel, s.kind, s.count) for s in stretches] == [("PSTAT", "missing", 1)]
    assert stretches[0].start == pd.Timestamp("2023-09-01 15:00", tz="UTC+04:00")


@pytest.mark.parametrize("name", ["bestest/725650TYCST.epw", "weather/REU_Saint-Denis-Gillot_2023_AMY.epw"])
def test_weather_years_raise_no_alarm(data_dir: Path, name: str) -> None:
    assert Climate.from_epw(data_dir / name).quality() == []


# ---------------------------------------------------------------------- made defects


def made(step: float, days: float, resolution: float, seed: int = 1) -> pd.DataFrame:
    """Three temperatures, a sun and a wind, as a logger of some step and resolution gives them."""
    random = np.random.default_rng(seed)
    count = int(days * 86400.0 / step)
    time = np.arange(count) * step / 86400.0
    columns = {}
    for place, swing in enumerate((6.0, 3.0, 1.5)):
        drift = np.cumsum(random.normal(0.0, 0.3 * np.sqrt(step / 86400.0), count))
        values = 20.0 + swing * np.sin(2.0 * np.pi * (time - 0.3)) + drift + random.normal(0.0, 0.02, count)
        columns[f"T{place}"] = np.round(values / resolution) * resolution if resolution else values
    sun = np.maximum(0.0, 800.0 * np.sin(2.0 * np.pi * (time - 0.25))) * random.uniform(0.3, 1.0, count)
    columns["sun"] = np.round(sun, 1)
    gusts = np.convolve(random.normal(0.0, 1.0, count + 9), np.ones(10), mode="valid")
    columns["wind"] = np.maximum(0.0, np.round(1.0 + 0.5 * gusts, 1))
    index = pd.date_range("2024-05-01", periods=count, freq=pd.Timedelta(seconds=step), tz="UTC")
    return pd.DataFrame(columns, index=index)


LOGGERS = [
    (60.0, 8.0, 0.0),
    (60.0, 8.0, 0.01),
    (60.0, 8.0, 0.1),
    (900.0, 40.0, 0.0),
    (900.0, 40.0, 0.1),
    (3600.0, 120.0, 0.1),
]


@pytest.mark.parametrize(("step", "days", "resolution"), LOGGERS)
def test_sound_loggers_of_any_step_and_resolution_raise_no_alarm(
    step: float, days: float, resolution: float
) -> None:
    for seed in range(3):
        assert find(made(step, days, resolution, seed)) == []


@pytest.mark.parametrize(("step", "days", "resolution"), LOGGERS)
def test_a_day_stuck_is_found_and_alone(step: float, days: float, resolution: float) -> None:
    data = made(step, days, resolution)
    first, rows = len(data) // 2, int(86400.0 / step)
    data.loc[data.index[first : first + rows], "T0"] = data["T0"].iloc[first]
    stretches = find(data)
    assert [(s.channel, s.kind) for s in stretches] == [("T0", "stuck")]
    assert abs(stretches[0].count - rows) <= max(3, 0.05 * rows)
    assert abs((stretches[0].start - data.index[first]).total_seconds()) <= max(2.0 * step, 3600.0)


def test_forward_filled_gap_inside_the_record() -> None:
    data = made(900.0, 20.0, 0.0)
    data.iloc[700:712] = data.iloc[699].to_numpy()
    filled = of_kind(find(data), "forward_filled")
    assert {"T0", "T1", "T2"} <= set(filled)
    for name in ("T0", "T1", "T2"):
        (stretch,) = filled[name]
        assert (stretch.start, stretch.end, stretch.count) == (data.index[700], data.index[711], 12)


def test_forward_filled_end_of_some_channels_only() -> None:
    data = made(60.0, 8.0, 0.01)
    for name in ("T0", "T1", "T2"):
        data.loc[data.index[-40:], name] = data[name].iloc[-41]
    filled = of_kind(find(data), "forward_filled")
    assert set(filled) == {"T0", "T1", "T2"}
    assert "to the end of the record" in filled["T0"][0].detail


@pytest.mark.parametrize("width", [1, 2, 3])
def test_spikes_are_found_where_they_are(width: int) -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[500 : 500 + width, 1] += 25.0
    data.iloc[900 : 900 + width, 2] -= 12.0
    spikes = of_kind(find(data), "spike")
    assert {name: [(s.start, s.count) for s in found] for name, found in spikes.items()} == {
        "T1": [(data.index[500], width)],
        "T2": [(data.index[900], width)],
    }


def test_a_step_is_not_a_spike_and_passing_clouds_are_not_either() -> None:
    data = made(60.0, 8.0, 0.0)
    data.iloc[4000:, 1] += 8.0  # a heater goes on
    cloud = np.where(np.random.default_rng(0).random(len(data)) < 0.3, 0.2, 1.0)
    data["sun"] *= cloud
    assert of_kind(find(data), "spike") == {}


def test_missing_values_and_codes_out_of_range() -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[100:110, 0] = np.nan
    data.iloc[300:303, 1] = -999.0
    stretches = find(data)
    assert [(s.channel, s.kind, s.count) for s in stretches] == [
        ("T0", "missing", 10),
        ("T1", "out_of_range", 3),
        ("T1", "spike", 3),
    ]
    assert "-999 is outside" in stretches[1].detail


@pytest.mark.parametrize("limits", [None, {"T2": (-50.0, 60.0)}, {"T2": (-50.0, 40.0)}])
def test_a_lone_jump_is_a_spike_even_where_it_is_out_of_range(
    limits: dict[str, tuple[float, float]] | None,
) -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[700, 2] = data["T2"].iloc[700] + 25.0
    stretches = find(data, limits=limits)
    assert [(s.start, s.count) for s in of_kind(stretches, "spike")["T2"]] == [(data.index[700], 1)]
    beyond = limits != {"T2": (-50.0, 60.0)}
    assert [s.kind for s in stretches] == (["out_of_range"] if beyond else []) + ["spike"]
    hidden = mask(data, stretches, kinds=["stuck", "spike"])
    assert hidden.iloc[700, 2]
    assert hidden.to_numpy().sum() == 1


def test_good_values_between_codes_are_no_spikes() -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[300:330, 1] = -999.0
    data.iloc[332:360, 1] = -999.0
    assert [(s.kind, s.count) for s in find(data)] == [("out_of_range", 30), ("out_of_range", 28)]


def test_a_spike_beside_a_code_is_found_too() -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[300, 1] = -999.0
    data.iloc[301, 1] = data["T1"].iloc[301] + 12.0
    spikes = of_kind(find(data), "spike")
    assert [(s.start, s.count) for s in spikes["T1"]] == [(data.index[301], 1)]


def test_given_limits_are_used() -> None:
    data = made(900.0, 20.0, 0.1)
    highest = float(data["T0"].max())
    stretches = find(data, limits={"T0": (-50.0, highest - 0.5)})
    assert {s.kind for s in stretches} == {"out_of_range"}
    assert sum(s.count for s in stretches) == int((data["T0"] > highest - 0.5).sum())


def test_a_dead_channel_is_stuck_unless_it_is_a_set_number() -> None:
    data = made(900.0, 5.0, 0.0)
    data["dead"] = 20.443636
    data["pressure"] = 100700.0
    (stretch,) = find(data)
    assert (stretch.channel, stretch.kind, stretch.count) == ("dead", "stuck", len(data))


def test_a_pyranometer_dead_for_days_is_not_night() -> None:
    data = made(900.0, 40.0, 0.0)
    data.iloc[1000:1500, 3] = 0.0
    (stretch,) = find(data)
    assert (stretch.channel, stretch.kind) == ("sun", "stuck")
    assert 499 <= stretch.count <= 600


def test_wind_direction_passing_north_is_no_spike() -> None:
    data = made(3600.0, 60.0, 0.0)
    data["direction"] = (10.0 * np.random.default_rng(2).normal(size=len(data)).cumsum()) % 360.0
    assert of_kind(find(data), "spike") == {}


def test_mask_covers_what_was_found_and_nothing_else() -> None:
    data = made(900.0, 20.0, 0.1)
    data.iloc[100:110, 0] = np.nan
    data.iloc[300:303, 1] = -999.0
    stretches = find(data)
    hidden = mask(data, stretches)
    assert hidden.shape == data.shape
    assert hidden.to_numpy().sum() == 13
    assert hidden.iloc[300:303, 1].all()
    assert mask(data, stretches, kinds=["missing"]).to_numpy().sum() == 10


def test_short_tables_are_not_judged() -> None:
    data = made(900.0, 5.0, 0.0).iloc[:3]
    assert find(data) == []
    assert find(data.iloc[:1]) == []


def test_runs() -> None:
    flags = np.array([True, True, False, True, False, False, True])
    assert runs(flags) == [(0, 2), (3, 4), (6, 7)]
    assert runs(np.zeros(3, dtype=bool)) == []


# ---------------------------------------------------------------------- switched columns


def switched(kind: str, days: int = 20, step: int = 10) -> np.ndarray:
    """Power, position or set point of something that is switched, made up."""
    rng = np.random.default_rng(5)
    count = days * 1440 // step
    hours = np.arange(count) * step / 60.0
    match kind:
        case "heater with a thermostat":
            on = rng.random(count // 6).repeat(6) < 0.4
            power = np.where(on, 1500.0, 0.0)
            power[count // 3 : count // 2] = 0.0  # off for more than three days
        case "measured power":
            on = np.resize(rng.random(count // 12).repeat(12) < 0.5, count)
            power = np.where(on, 1200.0 + 8.0 * rng.standard_normal(count), 0.0)
            power[: count // 4] = 0.0
        case "standby, then unplugged":
            on = np.resize(rng.random(count // 12).repeat(12) < 0.4, count)
            power = np.where(on, 900.0 + 5.0 * rng.standard_normal(count), 2.0 + 0.3 * rng.random(count))
            power[2 * count // 3 :] = 0.0
        case "two steps":
            power = np.array([0.0, 750.0, 1500.0])[rng.integers(0, 3, count // 40 + 1)].repeat(40)[:count]
        case "set point":
            power = np.where((hours % 24 > 6) & (hours % 24 < 22) & (hours % 168 < 120), 21.0, 17.0)
        case "window contact":
            power = ((hours > 100) & (hours < 110)).astype(float)
        case "always on after a week":
            power = np.where(hours < 168.0, 0.0, 500.0)
        case _:
            raise AssertionError(kind)
    return power


SWITCHED = (
    "heater with a thermostat", "measured power", "standby, then unplugged", "two steps", "set point",
    "window contact", "always on after a week",
)  # fmt: skip


@pytest.mark.parametrize("kind", SWITCHED)
def test_switched_columns_are_never_stuck(kind: str) -> None:
    values = switched(kind)
    index = pd.date_range("2024-01-01", periods=len(values), freq="10min", tz="UTC")
    rng = np.random.default_rng(1)
    room = 20.0 + np.cumsum(0.02 * rng.standard_normal(len(values)))
    data = pd.DataFrame({"switch": values, "room": room}, index=index)
    assert [s for s in find(data) if s.kind in ("stuck", "forward_filled")] == []


def test_all_switched_columns_together_are_not_filled() -> None:
    index = pd.date_range("2024-01-01", periods=20 * 144, freq="10min", tz="UTC")
    data = pd.DataFrame({kind: switched(kind) for kind in SWITCHED}, index=index)
    assert [s for s in find(data) if s.kind in ("stuck", "forward_filled")] == []


def test_a_stuck_sensor_beside_a_heater_is_still_found() -> None:
    values = switched("measured power")
    index = pd.date_range("2024-01-01", periods=len(values), freq="10min", tz="UTC")
    rng = np.random.default_rng(1)
    room = 20.0 + np.cumsum(0.02 * rng.standard_normal(len(values)))
    room[1500:1900] = room[1500]
    found = find(pd.DataFrame({"heater": values, "room": room}, index=index))
    assert [(s.channel, s.kind, s.count) for s in found] == [("room", "stuck", 399)]


def test_the_heaters_of_the_twin_house_are_not_stuck(data_dir: Path) -> None:
    path = data_dir / "twinhouse" / "twinhouse_O5_exp1.csv"
    stretches = Measurements.from_table(path, timezone="UTC+1").quality()
    assert [s for s in stretches if s.kind in ("stuck", "forward_filled")] == []
