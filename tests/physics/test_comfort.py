"""Comfort indices against the tables of the standards, their limits of validity, and hours of discomfort."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.comfort import INDICES, ComfortSettings, Conditions, Evaluation, Surroundings, discomfort
from mascarin.comfort.adaptive import EN_WEIGHTS, weighted_mean
from mascarin.comfort.givoni import zone
from mascarin.comfort.heat_balance import dissatisfied
from mascarin.examples import box, box_climate
from mascarin.physics import humidity_ratio, relative_humidity, saturation_pressure

NAN = float("nan")
OUTPUTS = ["room.air_temperature", "room.mean_radiant_temperature"]

# ISO 7730:2005, table D.1, without its line 7, whose value could not be checked
# (FedericoTartarini/validation-data-comfort-models, MIT, leaves it out too):
# air and radiant temperature, air speed, relative humidity, met, clo, PMV, PPD.
ISO_7730 = np.array(
    [
        (22.0, 22.0, 0.10, 60, 1.2, 0.5, -0.75, 17),
        (27.0, 27.0, 0.10, 60, 1.2, 0.5, 0.77, 17),
        (27.0, 27.0, 0.30, 60, 1.2, 0.5, 0.44, 9),
        (23.5, 25.5, 0.10, 60, 1.2, 0.5, -0.01, 5),
        (23.5, 25.5, 0.30, 60, 1.2, 0.5, -0.55, 11),
        (19.0, 19.0, 0.10, 40, 1.2, 1.0, -0.60, 13),
        (23.5, 23.5, 0.30, 40, 1.2, 1.0, 0.12, 5),
        (23.0, 21.0, 0.10, 40, 1.2, 1.0, 0.05, 5),
        (23.0, 21.0, 0.30, 40, 1.2, 1.0, -0.16, 6),
        (22.0, 22.0, 0.10, 60, 1.6, 0.5, 0.05, 5),
        (27.0, 27.0, 0.10, 60, 1.6, 0.5, 1.17, 34),
        (27.0, 27.0, 0.30, 60, 1.6, 0.5, 0.95, 24),
    ]
)

# ANSI/ASHRAE 55-2017, table D3: air and radiant temperature, air speed, relative humidity, met, clo, SET.
ASHRAE_SET = np.array(
    [
        (25, 25, 0.15, 50, 1.0, 0.5, 23.8), (10, 25, 0.15, 50, 1.0, 0.5, 16.8),
        (15, 25, 0.15, 50, 1.0, 0.5, 19.2), (20, 25, 0.15, 50, 1.0, 0.5, 21.5),
        (30, 25, 0.15, 50, 1.0, 0.5, 26.4), (40, 25, 0.15, 50, 1.0, 0.5, 34.3),
        (25, 25, 0.15, 10, 1.0, 0.5, 23.3), (25, 25, 0.15, 90, 1.0, 0.5, 24.9),
        (25, 25, 0.10, 50, 1.0, 0.5, 24.0), (25, 25, 0.60, 50, 1.0, 0.5, 21.3),
        (25, 25, 1.10, 50, 1.0, 0.5, 20.2), (25, 10, 0.15, 50, 1.0, 0.5, 15.3),
        (25, 40, 0.15, 50, 1.0, 0.5, 31.6), (25, 25, 0.15, 50, 1.0, 0.1, 20.7),
        (25, 25, 0.15, 50, 1.0, 1.0, 27.2), (25, 25, 0.15, 50, 2.0, 0.5, 25.9),
        (25, 25, 0.15, 50, 4.0, 0.5, 30.5), (25, 25, 1.10, 50, 2.0, 0.5, 24.0),
        (25, 25, 1.10, 50, 3.0, 0.5, 27.4), (29, 25, 1.10, 50, 1.5, 0.5, 25.0),
        (27, 25, 1.10, 50, 1.5, 0.75, 26.2), (25, 31, 1.70, 50, 1.5, 0.5, 23.1),
    ]
)  # fmt: skip


def conditions(row: np.ndarray, *, relative: bool = False) -> Conditions:
    """Conditions of a row of a table; its air speed may be relative to the moving body."""
    air, radiant, speed, humidity, met, clo = (float(x) for x in row[:6])
    still = speed - 0.3 * max(met - 1.0, 0.0) if relative else speed
    return Conditions(
        np.array([air]), np.array([radiant]), humidity, air_speed=still, metabolic_rate=met, clothing=clo
    )


def _first(found: Evaluation) -> float:
    return float(found.values.flat[0])  # noqa: PD011


@pytest.mark.parametrize("row", ISO_7730)
def test_pmv_is_that_of_the_table_of_iso_7730(row: np.ndarray) -> None:
    found = INDICES["pmv"].evaluate(conditions(row, relative=True), "C")
    # Nine lines agree in both digits; three differ by less than one in the last digit that is printed, with
    # the program of annex D and with the equations solved to 1e-10 as well.
    assert _first(found) == pytest.approx(row[6], abs=0.0099)
    assert round(float(dissatisfied(_first(found)))) == row[7]


def test_pmv_agrees_with_the_table_in_both_digits_in_nine_lines() -> None:
    found = [_first(INDICES["pmv"].evaluate(conditions(row, relative=True), "C")) for row in ISO_7730]
    assert sum(np.round(found, 2) == ISO_7730[:, 6]) == 9


def test_set_is_that_of_the_table_of_ashrae_55() -> None:
    index = INDICES["set"]
    found = [_first(index.evaluate(conditions(row), (0.0, 50.0))) for row in ASHRAE_SET]
    np.testing.assert_array_equal(np.round(found, 1), ASHRAE_SET[:, 6])


# EN 16798-1:2019 table B.3 and formula B.2.2; ASHRAE 55-2020 section 5.4.2; upper limits with moving air.
@pytest.mark.parametrize(
    ("name", "category", "mean", "speed", "low", "high"),
    [
        ("adaptive-en", "I", 20.0, 0.1, 22.4, 27.4),
        ("adaptive-en", "II", 20.0, 0.1, 21.4, 28.4),
        ("adaptive-en", "III", 30.0, 0.1, 23.7, 32.7),
        ("adaptive-en", "II", 20.0, 0.6, 21.4, 29.6),
        ("adaptive-en", "II", 20.0, 0.9, 21.4, 30.2),
        ("adaptive-en", "II", 20.0, 1.2, 21.4, 30.6),
        ("adaptive-ashrae", "80", 20.0, 0.1, 20.5, 27.5),
        ("adaptive-ashrae", "90", 20.0, 0.1, 21.5, 26.5),
        ("adaptive-ashrae", "80", 33.5, 1.2, 24.685, 33.885),
    ],
)
def test_adaptive_limits_are_those_of_the_standards(
    name: str, category: str, mean: float, speed: float, low: float, high: float
) -> None:
    here = Conditions(
        np.array([29.0]), np.array([29.0]), running_mean=mean, prevailing_mean=mean, air_speed=speed
    )
    found = INDICES[name].evaluate(here, category)
    assert (float(np.min(found.low)), float(np.min(found.high))) == pytest.approx((low, high))


def test_running_mean_weighs_the_days_before_as_en_16798() -> None:
    daily = np.array([20.0, 22.0, 24.0, 23.0, 21.0, 25.0, 26.0, 30.0, 18.0])
    by_hand = (26.0 + 0.8 * 25.0 + 0.6 * 21.0 + 0.5 * 23.0 + 0.4 * 24.0 + 0.3 * 22.0 + 0.2 * 20.0) / 3.8
    found = weighted_mean(daily, EN_WEIGHTS)
    assert np.isnan(found[:7]).all()
    assert found[7] == pytest.approx(by_hand)
    assert weighted_mean(daily, EN_WEIGHTS, periodic=True)[0] == pytest.approx(
        (18.0 + 0.8 * 30.0 + 0.6 * 26.0 + 0.5 * 25.0 + 0.4 * 21.0 + 0.3 * 23.0 + 0.2 * 24.0) / 3.8
    )


def test_heat_index_and_utci_are_the_published_ones() -> None:
    # National Weather Service, chart of the heat index: 90 degF and 70 % give 106 degF (to 1 degF).
    hot = Conditions(np.array([(90.0 - 32.0) / 1.8]), np.array([32.0]), 70.0)
    found = _first(INDICES["heat-index"].evaluate(hot))
    assert round(found * 1.8 + 32.0) in (105, 106)
    # UTCI of 25 degC, 50 %, 1 m/s without radiation: 24.6 degC (Bröde et al. 2012, program UTCI_a002).
    mild = Conditions(np.array([25.0]), np.array([25.0]), 50.0, air_speed=1.0)
    assert _first(INDICES["utci"].evaluate(mild)) == pytest.approx(24.6, abs=0.05)


def test_outside_its_validity_an_index_is_nan_and_the_time_is_counted() -> None:
    air = np.array([25.0, 31.0, 9.0, 29.0, 29.0])
    here = Conditions(air, air, np.array([50.0, 50.0, 50.0, 90.0, 40.0]), air_speed=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = INDICES["pmv"].evaluate(here, "B")
    # 29 degC at 90 % has a vapour pressure of 3600 Pa: above 2700 Pa.
    np.testing.assert_array_equal(np.isnan(found.values), [False, True, True, True, False])
    totals = discomfort(found, [1.0, 2.0, 4.0, 8.0, 16.0])
    assert float(totals.undefined_hours) == 14.0
    assert float(totals.reasons["air temperature above 30 degC"]) == 2.0
    assert float(totals.reasons["air temperature below 10 degC"]) == 4.0
    assert float(totals.reasons["vapour pressure above 2700 Pa"]) == 8.0
    assert float(totals.hours) <= 17.0


@pytest.mark.parametrize(
    ("name", "mean", "valid"),
    [
        ("adaptive-en", 9.9, False), ("adaptive-en", 10.0, True), ("adaptive-en", 30.1, False),
        ("adaptive-ashrae", 33.5, True), ("adaptive-ashrae", 33.6, False),
    ],
)  # fmt: skip
def test_adaptive_models_end_at_their_outdoor_temperatures(name: str, mean: float, valid: bool) -> None:
    here = Conditions(np.array([25.0]), np.array([25.0]), running_mean=mean, prevailing_mean=mean)
    assert bool(np.isfinite(_first(INDICES[name].evaluate(here)))) is valid


# Givoni 1992: still air 18 to 29 degC, 26 degC in humid air, 4 to 17 g/kg, up to 80 %; 32 degC at 2 m/s.
@pytest.mark.parametrize(
    ("air", "humidity", "speed", "comfortable"),
    [
        (28.9, 40.0, 0.1, True), (29.1, 40.0, 0.1, False), (25.9, 79.0, 0.1, True), (27.0, 79.0, 0.1, False),
        (24.0, 85.0, 0.1, False), (31.9, 40.0, 2.0, True), (32.1, 40.0, 2.0, False), (30.4, 40.0, 1.0, False),
        (30.2, 40.0, 1.0, True), (17.9, 60.0, 0.1, False), (32.1, 40.0, 5.0, False),
    ],
)  # fmt: skip
def test_givoni_zone(air: float, humidity: float, speed: float, comfortable: bool) -> None:
    here = Conditions(np.array([air]), np.array([air]), humidity, air_speed=speed)
    found = discomfort(INDICES["givoni"].evaluate(here), [1.0])
    assert (float(found.hours) == 0.0) is comfortable
    assert float(zone(2.0)[:, 0].max()) == 32.0


def test_air_drier_than_givonis_zones_is_not_rated() -> None:
    here = Conditions(np.array([25.0]), np.array([25.0]), 10.0)
    assert float(discomfort(INDICES["givoni"].evaluate(here), [1.0]).undefined_hours) == 1.0


def test_moist_air_follows_its_definitions() -> None:
    # ASHRAE 2021 Fundamentals, chapter 1, table 3: 3169.8 Pa at 25 degC, 611.2 Pa at 0 degC, within 0.4 %.
    assert saturation_pressure([0.0, 25.0]) == pytest.approx([611.2, 3169.8], rel=0.004)
    w = humidity_ratio([10.0, 30.0], [80.0, 40.0], 95000.0)
    assert relative_humidity([10.0, 30.0], w, 95000.0) == pytest.approx([80.0, 40.0])
    vapour = 0.4 * float(saturation_pressure(30.0))
    assert w[1] == pytest.approx(0.621945 * vapour / (95000.0 - vapour))


def test_hours_and_degree_hours_of_a_known_course() -> None:
    times = pd.date_range("2001-07-02", periods=97, freq="30min", tz="UTC")
    air = np.where(np.arange(97) % 48 >= 24, 29.0, 24.0)  # 12 h warm a day
    settings = ComfortSettings(index="operative", band=[20, 26], hours=[["10:00", "14:00"]])
    found = settings.discomfort(air, air, settings.occupied(times))
    assert float(found.assessed_hours) == pytest.approx(8.0)
    assert float(found.hours) == pytest.approx(4.0)
    assert float(found.degree_hours) == pytest.approx(12.0)
    weekend = ComfortSettings(index="operative", band=[20, 26], days="weekends")
    assert float(weekend.occupied(times).sum()) == 0.0  # a Monday and a Tuesday
    night = ComfortSettings(index="operative", band=[20, 26], hours=[["22:00", "06:00"]])
    assert float(night.occupied(times).sum()) == pytest.approx(16.0, abs=0.26)


def test_many_runs_at_once_are_rated_as_each_alone() -> None:
    air = 20.0 + 12.0 * np.random.default_rng(2).random((3, 4, 50))
    settings = ComfortSettings(index="givoni", humidity=60.0)
    together = settings.discomfort(air, air - 1.0, np.ones(50))
    alone = settings.discomfort(air[1, 2], air[1, 2] - 1.0, np.ones(50))
    assert together.degree_hours.shape == (3, 4)
    assert together.degree_hours[1, 2] == alone.degree_hours
    assert together.hours[1, 2] == alone.hours


@pytest.fixture(scope="module")
def run() -> mc.Results:
    return mc.simulate(box(), box_climate(), step="1h", outputs=OUTPUTS)


def test_a_room_with_outdoor_moisture_has_the_dew_point_of_the_climate(run: mc.Results) -> None:
    found = run.comfort("room", box_climate(), index="givoni", humidity="outdoor")
    row = found.to_dataframe().iloc[30]
    expected = 100.0 * saturation_pressure(10.0) / saturation_pressure(row["air_temperature"])
    assert row["relative_humidity"] == pytest.approx(float(expected), rel=1e-6)
    assert any("humidity ratio of the outdoor air" in note for note in found.notes)
    assert found.by_month()["occupied"].sum() == pytest.approx(72.0)
    assert found.to_dict()["hours_of_discomfort"] == found.hours


def test_a_building_with_humidity_brings_its_own() -> None:
    damp = box().replace({"humidity": {"zones": {"room": {"gains": {"people": {"power": 40}}}}}})
    outputs = [*OUTPUTS, "room.relative_humidity"]
    run = mc.simulate(damp, box_climate(), step="1h", outputs=outputs)
    table = run.comfort("room", index="givoni").to_dataframe()
    simulated = 100.0 * run["room.relative_humidity"].to_numpy()
    assert table["relative_humidity"].to_numpy() == pytest.approx(simulated[: len(table)], rel=1e-12)
    assert 20.0 < simulated.mean() < 100.0


def test_running_mean_needs_seven_days_before(run: mc.Results) -> None:
    found = run.comfort("room", box_climate())
    assert found.to_dict()["undefined_hours"] == 72.0
    assert any("fewer than seven days" in why for why in found.to_dict()["not_valid"])


def test_a_typical_year_has_days_before_new_year(data_dir: Path) -> None:
    climate = mc.Climate.from_epw(data_dir / "weather" / "USA_FL_Tampa.Intl.AP.722110_TMY3.epw")
    times = pd.DatetimeIndex([pd.Timestamp("2001-01-01 12:00", tz=climate.index.tz)])
    daily = climate.data["air_temperature"].groupby(climate.index.day_of_year).mean()
    by_hand = np.average([daily.loc[365 - k] for k in range(7)], weights=EN_WEIGHTS)
    assert Surroundings.of(climate, times).running_mean[0] == pytest.approx(by_hand)


@pytest.mark.parametrize("kind", ["series", "carpet", "profile", "psychrometric"])
def test_every_figure_draws_values(run: mc.Results, kind: str) -> None:
    found = run.comfort("room", box_climate(), index="givoni", humidity="outdoor")
    axes = found.plot(kind).axes[0]
    assert axes.lines or axes.collections


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"index": "operatif"}, "Did you mean 'operative'"),
        ({"index": "pmv"}, "humidity: found none"),
        ({"index": "pmv", "humidity": 0.6}, "Give percent, such as 60"),
        ({"index": "pmv", "humidity": "simulated"}, "Record the output ZONE.relative_humidity"),
        ({"index": "pmv", "humidity": 50, "category": "D"}, "A, B, C"),
        ({"index": "operative"}, "such as [20, 26]"),
        ({"index": "operative", "band": [26, 20]}, "such as [20, 26]"),
        ({"index": "givoni", "humidity": "outdoor"}, "no climate"),
        ({"index": "adaptive-en"}, "climate=..."),
        ({"index": "adaptive-en", "humidity": 50}, "Leave it out"),
        ({"index": "adaptive-en", "air_speed": -1}, "air_speed"),
        ({"zone": "kitchen", "index": "operative", "band": [20, 26]}, "zone: found 'kitchen'"),
    ],
)
def test_what_cannot_be_rated_is_refused_with_what_to_do(
    run: mc.Results, keys: dict[str, object], said: str
) -> None:
    with pytest.raises(mc.InputError, match=said.replace("[", r"\[").replace(".", r"\.")):
        run.comfort(**keys)  # type: ignore[arg-type]


def test_temperatures_that_were_not_recorded_are_named() -> None:
    run = mc.simulate(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    with pytest.raises(mc.InputError, match=r"room\.mean_radiant_temperature: not recorded"):
        run.comfort(index="operative", band=[20, 26])


def test_without_the_package_the_message_says_what_to_install(
    run: mc.Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "pythermalcomfort", None)
    with pytest.raises(mc.InputError, match=r"pip install 'mascarin\[comfort\]'"):
        run.comfort(index="pmv", humidity=50)
    assert run.comfort(index="givoni", humidity=50).hours >= 0.0
