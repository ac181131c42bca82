"""Irradiance that is brighter than possible: found in records that are wrong, not in good ones."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from mascarin.examples import box
from mascarin.simulation.run import simulate
from mascarin.weather import Climate
from mascarin.weather.checks.brightness import MOST, OFFSET, findings, too_bright
from mascarin.weather.derived.completion import extraterrestrial_horizontal

COLUMNS = (
    "air_temperature", "dew_point", "wind_speed", "wind_direction", "global_horizontal", "diffuse_horizontal",
    "direct_normal",
)  # fmt: skip


def shifted(name: str, minutes: float) -> Climate:
    """A shipped year whose stamps are too early."""
    climate = Climate.shipped(name)
    table = climate.to_dataframe()[list(COLUMNS)]
    index = pd.DatetimeIndex(table.index)
    table.index = index - pd.Timedelta(minutes=minutes)
    zone = f"UTC{str(index.tz)[3:6]}"
    columns = {column: column for column in COLUMNS}
    return Climate.from_table(table, timezone=zone, columns=columns, check_sun=False)


@pytest.mark.parametrize("name", ["tampa", "golden", "tucson"])
def test_shipped_years_have_no_finding(name: str) -> None:
    climate = Climate.shipped(name)
    place = climate.site
    assert place is not None
    assert findings(climate.record, place.latitude, place.longitude) == ()
    assert not [part for part in climate.quality() if "extraterrestrial" in part.detail]


def test_good_records_exceed_the_extraterrestrial_irradiance_with_a_low_sun() -> None:
    """25 hours of Tampa do, at most 8 W/m2: without a limit above 1 they would be findings."""
    climate = Climate.shipped("tampa")
    place = climate.site
    assert place is not None
    most = extraterrestrial_horizontal(climate.record, place.latitude, place.longitude, "mean")
    assert int((climate.record.columns["global_horizontal"] > most).sum()) == 25


@pytest.mark.parametrize("name", ["golden", "tampa"])
def test_stamps_that_are_off_by_most_of_an_hour_are_found(name: str) -> None:
    place = Climate.shipped(name).site
    assert place is not None
    wrong = shifted(name, 50.0)
    bright = too_bright(wrong.record, place.latitude, place.longitude)
    assert bright["global_horizontal"].sum() > 200
    (first, *_) = findings(wrong.record, place.latitude, place.longitude)
    assert f"global_horizontal is above {MOST:g} times the extraterrestrial irradiance" in first
    assert "Check time zone, stamps, unit and sensor" in first


def hour(total: float) -> Climate:
    """Two days of constant global irradiance at the equator."""
    index = pd.date_range("2001-03-20", periods=48, freq="1h", tz="UTC")
    columns = ("air_temperature", "dew_point", "wind_speed", "wind_direction", "global_horizontal")
    table = pd.DataFrame(dict.fromkeys(columns, 1.0) | {"global_horizontal": total}, index=index)
    names = {name: name for name in columns}
    return Climate.from_table(table, timezone="UTC", columns=names, check_sun=False)


def test_the_limit() -> None:
    """Above 1.5 times the mean over the hour and the offset of the sensor, and not below."""
    record = hour(21.0).record
    most = extraterrestrial_horizontal(record, 0.0, 0.0, "mean")
    assert most.max() == pytest.approx(1360.8 * np.cos(np.radians(7.5)), rel=0.02)
    assert most.min() == 0.0
    assert too_bright(record, 0.0, 0.0) == {}
    assert (
        too_bright(hour(600.0).record, 0.0, 0.0)["global_horizontal"] == (MOST * most + OFFSET < 600.0)
    ).all()


def test_a_run_says_it() -> None:
    building = box()
    wrong = hour(800.0)
    results = simulate(building, wrong, step="1h", start="2001-03-20", end="2001-03-20 06:00")
    assert any("times the extraterrestrial irradiance" in text for text in results.warnings)
    said = results.provenance.to_dict()["climate"]["provenance"]
    assert any("times the extraterrestrial irradiance" in text for text in said)


@pytest.mark.parametrize("diffuse", ["isotropic", "hay_davies", "perez"])
@pytest.mark.parametrize(
    ("latitude", "altitude"), [(0.0, 0.0), (67.0, 0.0), (-33.0, 4000.0), (-80.0, 2800.0)]
)
def test_nothing_above_extraterrestrial_plus_reflected(
    diffuse: str, latitude: float, altitude: float
) -> None:
    """Weather that no sky can have, on walls and roofs of all directions, at sea level and on mountains."""
    rng = np.random.default_rng(1)
    index = pd.date_range("2001-06-20", periods=49, freq="1h", tz="UTC")
    names = (
        "air_temperature",
        "dew_point",
        "wind_speed",
        "wind_direction",
        "direct_normal",
        "diffuse_horizontal",
    )
    table = pd.DataFrame(dict.fromkeys(names, 1.0), index=index)
    table["direct_normal"] = rng.choice([0.0, 50.0, 900.0, 1400.0], 49)
    table["diffuse_horizontal"] = rng.choice([0.0, 1.0, 80.0, 500.0, 1150.0], 49)
    climate = Climate.from_table(
        table, timezone="UTC", columns={name: name for name in names}, check_sun=False
    )
    for tilt, azimuth in ((90.0, 0.0), (90.0, 90.0), (90.0, 180.0), (90.0, 270.0), (30.0, 180.0), (0.0, 0.0)):
        building = box().replace(
            {
                "site.latitude": latitude, "site.altitude": altitude, "surfaces.facade.tilt": tilt,
                "surfaces.facade.azimuth": azimuth, "site.diffuse": diffuse,
            }
        )  # fmt: skip
        incident = simulate(building, climate, step="15min", outputs=["facade.incident_solar"]).records[:, 0]
        reflected = float(building.site.ground_reflectance) * 0.5 * (1.0 - np.cos(np.radians(tilt)))
        assert incident.max() <= 1408.0 * (1.0 + reflected)
        assert incident.min() >= 0.0
