"""Uncertainty of sensors by the GUM."""

from __future__ import annotations

from typing import Any

import pytest

from mascarin.errors import InputError
from mascarin.measurements import Sensor, SensorUncertainty


def test_standard_and_expanded_uncertainty_differ_by_the_coverage_factor() -> None:
    standard = Sensor("q", standard_uncertainty=2.0, relative_standard_uncertainty=0.01).uncertainty("W/m2")
    expanded = Sensor("q", expanded_uncertainty=3.92, relative_expanded_uncertainty=0.0196).uncertainty(
        "W/m2"
    )
    assert standard == SensorUncertainty(2.0, 0.01)
    assert (expanded.absolute, expanded.relative) == pytest.approx((2.0, 0.01), rel=1e-15)


def test_a_thermometer_without_uncertainty_has_half_a_kelvin() -> None:
    assert Sensor("t").uncertainty("degC") == SensorUncertainty(0.5 / 1.96)
    # With a relative part alone, the half kelvin stays.
    assert Sensor("t", relative_expanded_uncertainty=0.05).uncertainty("degC").absolute == 0.5 / 1.96


def test_other_units_need_an_uncertainty() -> None:
    with pytest.raises(
        InputError, match=r"flux: found no uncertainty, expected one, because the unit is W/m2"
    ):
        Sensor("q").uncertainty("W/m2", "flux")
    assert Sensor("q", relative_expanded_uncertainty=0.0196).uncertainty("W/m2").absolute == 0.0


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (
            {"standard_uncertainty": 0.1, "expanded_uncertainty": 0.2},
            "found: 0.1 beside expanded_uncertainty 0.2",
        ),
        ({"expanded_uncertainty": -0.2}, r"expanded_uncertainty\n +found: -0\.2\n +expected: greater than 0"),
        ({"relative_standard_uncertainty": float("nan")}, r"relative_standard_uncertainty\n +found: nan"),
    ],
)
def test_contradictory_uncertainties_are_refused(given: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        Sensor("t", **given)


# --- the keys of a study file ---------------------------------------------------------------------------


def test_the_older_key_of_a_study_is_the_expanded_uncertainty() -> None:
    given = {"column": "T", "output": "room.air_temperature"}
    older, newer, standard = (
        Sensor.model_validate(given | {key: value})
        for key, value in (
            ("uncertainty", 0.3),
            ("expanded_uncertainty", 0.3),
            ("standard_uncertainty", 0.3 / 1.96),
        )
    )
    assert older == newer
    for sensor in (older, standard):
        assert sensor.expanded == pytest.approx(0.3, rel=1e-15)
        assert sensor.uncertainty("degC", "room").absolute == pytest.approx(0.3 / 1.96, rel=1e-15)
    assert Sensor.model_validate(given).expanded == 0.5
    with pytest.raises(InputError, match=r"sensors.flux: found no uncertainty"):
        Sensor.model_validate(given).uncertainty("W/m2", "sensors.flux")


def test_both_keys_of_a_study_are_refused() -> None:
    given: dict[str, Any] = {"column": "T", "uncertainty": 0.3, "standard_uncertainty": 0.1}
    with pytest.raises(InputError, match=r"0\.1 beside expanded_uncertainty 0\.3"):
        Sensor(**given)


def test_the_study_and_python_have_the_same_sensor() -> None:
    """One class: what a study file says of a sensor is what `calibrate` is given."""
    from mascarin.study import Sensor as OfStudies

    assert OfStudies is Sensor
    assert Sensor("T", expanded_uncertainty=0.3) == Sensor.model_validate(
        {"column": "T", "expanded_uncertainty": 0.3}
    )


@pytest.mark.parametrize("name", ["relative", "relative_expanded_uncertainty"])
def test_the_relative_part_has_two_names(name: str) -> None:
    assert Sensor("q", **{name: 0.05}).uncertainty("W/m2").relative == pytest.approx(0.05 / 1.96, rel=1e-15)
