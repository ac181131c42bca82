"""The clock against the sun by a measured plane: right records are never refused, and what is seen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mascarin import Climate
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.simulation.preparation.measured_planes import measured_planes, warnings_of_planes
from mascarin.study import Study
from mascarin.weather.checks.plane_check import on_grid, plane_warnings
from mascarin.weather.checks.plane_shift import MeasuredPlane, shift_by_plane
from mascarin.weather.reading.yearly import shifted
from plane_skies import Drawn, drawn

SIDES = (90.0, 180.0, 270.0)


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


def warned(case: Drawn) -> tuple[str, ...]:
    return plane_warnings(case.record, case.planes, case.site.latitude, case.site.longitude)


def refused(case: Drawn) -> bool:
    try:
        warned(case)
    except InputError:
        return True
    return False


def test_right_records_are_never_refused() -> None:
    """Drawn records, of one plane and of three: clouds, obstacles, wrong azimuths and gains are no clock."""
    rng = np.random.default_rng(31)
    assert not any(refused(drawn(rng, 0.0)) for _ in range(40))
    assert not any(refused(drawn(rng, 0.0, azimuths=SIDES)) for _ in range(8))


def test_the_error_of_a_shift_is_within_its_uncertainty() -> None:
    """Planes that stand upright: four of five errors within one standard uncertainty, none beyond three."""
    rng = np.random.default_rng(32)
    errors = []
    for _ in range(24):
        case = drawn(rng, 30.0, azimuths=(float(rng.choice(SIDES)),))
        shift = shift_by_plane(case.record, case.planes[0], case.site.latitude, case.site.longitude)
        if shift is not None and shift.days >= 3:
            errors.append(abs(shift.late - 1800.0) / shift.uncertainty)
    assert len(errors) > 8
    assert np.mean(np.array(errors) < 1.0) > 0.8
    assert max(errors) < 3.0


def test_planes_that_agree_show_an_hour() -> None:
    rng = np.random.default_rng(33)
    seen = 0
    for case in [drawn(rng, 60.0, azimuths=SIDES) for _ in range(8)]:
        try:
            warned(case)
        except InputError as error:
            seen += 1
            text = str(error)
            assert "later than the sun" in text
            minutes = float(text.split("state shift: ")[1].split("min")[0])
            uncertainty = float(text.split("standard uncertainty ")[1].split(" min")[0])
            assert abs(minutes + 60.0) < 3.0 * uncertainty
            assert "azimuth and tilt" in text
            # The remedies of the text.
            record = shifted(case.record, 60.0 * minutes)
            assert not refused(Drawn(record, case.planes, case.site))
            assert warned(Drawn(replace(case.record, check_sun=False), case.planes, case.site)) == ()
    assert seen >= 2


def test_a_plane_near_the_horizontal_says_nothing() -> None:
    case = drawn(np.random.default_rng(34), 60.0, azimuths=(180.0,))
    flat = [replace(plane, tilt=20.0) for plane in case.planes]
    assert plane_warnings(case.record, flat, case.site.latitude, case.site.longitude) == ()


def test_means_beside_instants() -> None:
    values = np.array([0.0, 2.0, 4.0])
    assert on_grid(values, "mean", "mean") is values
    assert on_grid(values, "instant", "mean").tolist() == [1.0, 3.0, 4.0]
    assert on_grid(values, "mean", "instant").tolist() == [0.0, 1.0, 3.0]


@pytest.fixture(scope="module")
def house(data_dir: Path) -> Study:
    """The Twin House: four upright planes beside global and diffuse irradiance, from instruments."""
    assert data_dir.exists()
    root = Path(__file__).resolve().parents[3]
    return Study.from_yaml(root / "python/mascarin/examples/twin_house/study.yaml")


def test_the_planes_of_a_real_house(house: Study) -> None:
    """The balance of its instruments closes with the stated clock; so do the planes. An hour is refused."""
    assert warnings_of_planes(house.building, house.climate, house.measurements) == ()
    record, site = house.climate.record, house.building.site
    planes = measured_planes(house.building, house.climate, house.measurements)
    assert {plane.azimuth for plane in planes} == {0.0, 90.0, 180.0, 270.0}
    late = shifted(record, 3600.0)
    with pytest.raises(InputError, match=r"the radiation is (5[3-9]|6[0-7]) min .* later than the sun"):
        plane_warnings(late, planes, float(site.latitude), float(site.longitude))
    unchecked = replace(late, check_sun=False)
    assert plane_warnings(unchecked, planes, float(site.latitude), float(site.longitude)) == ()


def test_planes_of_a_building_need_a_direction_and_the_same_rows(house: Study) -> None:
    assert measured_planes(box(), house.climate, house.measurements) == []
    half = Climate(shifted(house.climate.record, 100.0))
    assert measured_planes(house.building, half, house.measurements) == []
    assert isinstance(measured_planes(house.building, house.climate, house.measurements)[0], MeasuredPlane)
