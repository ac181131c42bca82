"""The shift of a clock against the sun: planted shifts are determined, clouds are not taken for one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin import Climate, Measurements
from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from mascarin.weather.checks.clock_shift import shifts_of
from mascarin.weather.checks.sun_check import check_clock
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.reading.yearly import shifted
from skies import NAMES, sky


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


@pytest.mark.parametrize(
    ("latitude", "minutes", "step"),
    [
        (45.0, -90.0, 1800.0),
        (-33.0, -20.0, 3600.0),
        (0.0, 15.0, 900.0),
        (60.0, 45.0, 600.0),
        (-60.0, 90.0, 3600.0),
    ],
)
def test_planted_shifts_of_clear_days(latitude: float, minutes: float, step: float) -> None:
    rng = np.random.default_rng(1)
    record = sky(rng, latitude, 77.0, "clear", step=step, late=60.0 * minutes, names=NAMES)
    shifts = {shift.by: shift for shift in shifts_of(record, latitude, 77.0)}
    for by in ("balance", "symmetry"):
        # Shifts of 10 min are tried, and interpolated.
        assert shifts[by].late / 60.0 == pytest.approx(minutes, abs=1.0 if by == "balance" else 2.5)
        assert abs(shifts[by].late - 60.0 * minutes) < 2.0 * shifts[by].uncertainty
        # One symmetric day out of these may be all that shows: two tenths of an hour are still seen.
        assert shifts[by].uncertainty < (240.0 if by == "balance" else 420.0)
    assert not shifts["balance"].split
    word = "later" if minutes > 0 else "earlier"
    with pytest.raises(
        InputError, match=rf"is {abs(minutes):.0f} min .* {word} than the sun.*shift: {-minutes:.0f}min"
    ):
        check_clock(record, latitude, 77.0)
    check_clock(shifted(record, -60.0 * minutes), latitude, 77.0)


def test_the_balance_sees_a_shift_below_broken_clouds() -> None:
    rng = np.random.default_rng(2)
    for names, width in ((NAMES, 1.5), (NAMES[:2], 6.0)):
        record = sky(rng, 45.0, 5.0, "broken", late=1800.0, names=names)
        [shift] = [shift for shift in shifts_of(record, 45.0, 5.0) if shift.by == "balance"]
        assert shift.late / 60.0 == pytest.approx(30.0, abs=width)
        with pytest.raises(InputError, match=r"balance of global, direct and diffuse irradiance closes"):
            check_clock(record, 45.0, 5.0)


def test_right_records_are_never_refused() -> None:
    """200 drawn records: none; of those with clear days that are 20 min and more off, 95 %."""
    rng = np.random.default_rng(3)
    places = [-75.0, -60.0, -33.0, 0.0, 20.0, 45.0, 60.0, 72.0]
    for _ in range(200):
        kind = rng.choice(["clear", "mixed", "broken", "fog", "overcast"])
        latitude, longitude = float(rng.choice(places)), float(rng.uniform(-180.0, 180.0))
        record = sky(
            rng, latitude, longitude, kind, step=float(rng.choice([1800.0, 3600.0])),
            days=int(rng.choice([3, 8])),
            start=int(rng.integers(350)), names=NAMES[: rng.integers(1, 4)],
        )  # fmt: skip
        check_clock(record, latitude, longitude)


def test_shifted_records_with_clear_days_are_refused() -> None:
    rng = np.random.default_rng(4)
    detected = 0
    for _ in range(40):
        latitude, longitude = (
            float(rng.choice([-60.0, -33.0, 0.0, 20.0, 45.0, 60.0])),
            float(rng.uniform(-180, 180)),
        )
        late = 60.0 * float(rng.choice([-90, -60, -30, -20, 20, 30, 60, 90]))
        record = sky(
            rng, latitude, longitude, rng.choice(["clear", "mixed"]),
            step=float(rng.choice([1800.0, 3600.0])),
            days=12, start=int(rng.integers(330)), late=late, names=NAMES[: rng.integers(1, 4)],
        )  # fmt: skip
        try:
            check_clock(record, latitude, longitude)
        except InputError:
            detected += 1
    assert detected >= 38


def test_polar_night_has_no_clock() -> None:
    rng = np.random.default_rng(5)
    record = sky(rng, 75.0, 20.0, "clear", start=350, late=7200.0)
    assert shifts_of(record, 75.0, 20.0) == ()
    assert check_clock(record, 75.0, 20.0) == ()


def test_a_split_by_a_model_proves_nothing() -> None:
    """Direct irradiance from global and diffuse with the stated sun closes for any clock."""
    rng = np.random.default_rng(6)
    record = sky(rng, 45.0, 5.0, "overcast", late=2700.0)
    total = record.columns["global_horizontal"]
    sun = SunPath.over(45.0, 5.0, record.grid.start, record.grid.end)
    nodes = record.grid.start + 1800.0 * np.arange(len(total))[:, None] + 100.0 * (np.arange(18) + 0.5)
    up = np.maximum(sun.vector(nodes)[..., 2], 0.0).mean(axis=1)
    beam = np.where(up > 0.1, 0.5 * total / np.maximum(up, 0.1), 0.0)
    columns = {**record.columns, "direct_normal": beam, "diffuse_horizontal": total - beam * up}
    made = replace(record, columns=columns, kinds=dict.fromkeys(columns, "mean"))
    [balance] = [shift for shift in shifts_of(made, 45.0, 5.0) if shift.by == "balance"]
    assert balance.split
    assert abs(balance.late) < 120.0


def table(late: str = "0min") -> pd.DataFrame:
    record = sky(np.random.default_rng(8), 45.0, 5.0, "clear", late=pd.Timedelta(late).total_seconds())
    index = pd.to_datetime(record.grid.start + 1800.0 * np.arange(record.grid.count), unit="s")
    frame = pd.DataFrame({"time": index.strftime("%Y-%m-%d %H:%M"), "T": 15.0, "v": 1.0, "d": 0.0})
    return frame.assign(G=record.columns["global_horizontal"].round(1))


OPTIONS = {
    "timezone": "UTC",
    "columns": {"air_temperature": "T", "global_horizontal": "G", "wind_speed": "v", "wind_direction": "d"},
    "absent": ["dew_point"],
    "latitude": 45.0,
    "longitude": 5.0,
}


def test_the_remedy_of_the_refusal_works_in_a_table(tmp_path: Path) -> None:
    path = tmp_path / "logger.csv"
    table("30min").to_csv(path, index=False)
    with pytest.raises(InputError, match=r"shift: -30min"):
        Climate.from_table(path, **OPTIONS)  # type: ignore[arg-type]
    moved = Climate.from_table(path, shift="-30min", **OPTIONS)  # type: ignore[arg-type]
    assert any("-30 min were added to every stamp" in note for note in moved.provenance)
    kept = Climate.from_table(path, check_sun=False, **OPTIONS)  # type: ignore[arg-type]
    assert moved.grid.start == kept.grid.start - 1800.0
    assert np.array_equal(moved.data["global_horizontal"], kept.data["global_horizontal"])
    series = Measurements.from_table(path, timezone="UTC", shift="-30min").series("G")
    assert epoch_seconds(series.index)[0] == moved.grid.start  # type: ignore[arg-type]
    for wrong in ("half an hour", "--30min", "25h"):
        with pytest.raises(InputError, match="shift: found"):
            Climate.from_table(path, shift=wrong, **OPTIONS)  # type: ignore[arg-type]


def test_values_at_the_stamp_are_named_as_a_remedy(tmp_path: Path) -> None:
    """Hourly values at hh:10 that are read as means look half an hour late."""
    time = pd.date_range("2024-05-01 00:10", periods=240, freq="1h", tz="UTC")
    sun = SunPath.over(45.0, 5.0, epoch_seconds(time)[0], epoch_seconds(time)[-1])
    up = np.maximum(sun.vector(epoch_seconds(time))[:, 2], 0.0)
    total = 1098.0 * up * np.exp(-0.057 / np.maximum(up, 1e-3))
    frame = pd.DataFrame(
        {"time": time.strftime("%Y-%m-%d %H:%M"), "T": 15.0, "v": 1.0, "d": 0.0, "G": total.round(1)}
    )
    path = tmp_path / "satellite.csv"
    frame.to_csv(path, index=False)
    with pytest.raises(InputError, match="kind: instant in the columns of irradiance"):
        Climate.from_table(path, **OPTIONS)  # type: ignore[arg-type]
    Climate.from_table(path, instant=["global_horizontal"], **OPTIONS)  # type: ignore[arg-type]
    frame["time"] = time.strftime("%Y%m%d:%H%M")
    frame.to_csv(path, index=False)
    read = Climate.from_table(path, **OPTIONS)  # type: ignore[arg-type]
    assert read.kinds["global_horizontal"] == "instant"
    assert any("stamps of PVGIS" in note for note in read.provenance)


def test_a_weather_file_may_be_shifted(tmp_path: Path) -> None:
    plain, moved = (
        Climate.shipped("golden"),
        Climate.from_epw("shipped:golden", shift="30min", check_sun=False),
    )
    assert moved.grid.start == plain.grid.start + 1800.0
    assert plain.site is not None
    early = plain.forcing(plain.site, "2001-06-01 00:00", "2001-06-03 00:00", 3600.0)
    late = moved.forcing(plain.site, "2001-06-01 00:30", "2001-06-03 00:30", 3600.0)
    assert np.allclose(early[..., 0], late[..., 0], atol=1e-9)
    turn = moved.forcing(plain.site, "2001-12-31 23:00", "2002-01-01 02:00", 1800.0)
    assert np.isfinite(turn[..., 0]).all()
    with pytest.raises(InputError, match=r"30 min .* later than the sun"):
        Climate.from_epw("shipped:golden", shift="30min").completed()


def test_half_a_sine_from_six_to_six_is_no_shifted_clock() -> None:
    """Synthetic days, as examples have them: the sun of 1 March is 12 min late, and nothing lies at night."""
    time = pd.date_range("2023-03-01", periods=24 * 14, freq="1h")
    sine = 600.0 * np.maximum(np.sin(np.pi * (time.hour.to_numpy() + 0.5 - 6.0) / 12.0), 0.0)
    frame = pd.DataFrame({"time": time, "T": 15.0, "v": 1.0, "d": 0.0, "G": sine})
    Climate.from_table(frame, **{**OPTIONS, "longitude": 0.0})  # type: ignore[arg-type]
