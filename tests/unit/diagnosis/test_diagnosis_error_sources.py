"""A known source of error is found; an error that no parameter explains remains."""

from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.diagnosis.error_sources import ErrorSources, explain_missed_aims, find_error_sources
from mascarin.errors import InputError
from mascarin.validation.criteria import Verdict

Floats = NDArray[np.float64]

DAYS = 56
DAY = np.repeat(np.arange(DAYS), 24)
HOUR = np.tile(np.arange(24.0), DAYS)
RANDOM = np.random.default_rng(4)
WEATHER = np.repeat(RANDOM.normal(size=DAYS), 24)
NOISE = 0.05 * RANDOM.normal(size=(DAY.size, 2))
EFFECTS = {
    "sun": np.stack([np.maximum(0.0, np.sin((HOUR - 6.0) / 12.0 * np.pi)), 2.0 * WEATHER], axis=-1),
    "sky": np.stack([WEATHER, np.cos(HOUR / 12.0 * np.pi)], axis=-1),
    "shift": np.ones((DAY.size, 2)),
}
ALLOWED = dict.fromkeys(EFFECTS, (-0.5, 0.5))


def _found(error: Floats, allowed: dict[str, tuple[float, float]] | None = None) -> ErrorSources:
    return find_error_sources(
        {"air": error[:, 0], "roof": error[:, 1]},
        EFFECTS,
        standard_uncertainty=[0.1, 0.1],
        allowed=allowed or ALLOWED,
        days=DAY,
    )


def test_the_wrong_parameter_is_named_with_its_change() -> None:
    found = _found(0.3 * EFFECTS["sky"] + 0.1 * EFFECTS["sun"] + NOISE)
    assert [step.paths[-1] for step in found.steps] == ["sky", "sun"]
    assert found.steps[-1].changes == pytest.approx((-0.3, -0.1), abs=0.005)
    assert found.steps[0].sd[0] < found.sd[0]
    assert found.steps[-1].sd == pytest.approx((0.05, 0.05), rel=0.05)
    assert found.floor("roof") == pytest.approx(0.05, rel=0.05)


def test_an_error_that_no_parameter_explains_remains() -> None:
    storm = 0.4 * np.sin(2.0 * np.pi * DAY / 3.3)[:, None] + NOISE
    found = _found(storm)
    assert found.floor("air") == pytest.approx(found.sd[0], rel=0.05)
    missed = Verdict("sd", "air", "blind", "sd", found.sd[0], 0.1, "degC", passed=False)
    (sentence,) = explain_missed_aims([missed], found, "blind")
    assert sentence.startswith("air: the standard deviation is 0.28")
    assert "no parameter values reach the aim" in sentence
    assert explain_missed_aims([missed], found, "corroboration") == []


def test_an_aim_within_reach_of_the_equations_is_reported() -> None:
    found = _found(0.3 * EFFECTS["sky"] + NOISE)
    missed = Verdict("sd", "roof", "blind", "sd", found.sd[1], 0.1, "degC", passed=False)
    assert "the equations are sufficient" in explain_missed_aims([missed], found, "blind")[0]


def test_a_constant_offset_is_not_attributed_to_a_parameter() -> None:
    found = _found(NOISE + 2.0)
    assert found.sd == pytest.approx((0.05, 0.05), rel=0.05)
    assert "shift" not in [path for step in found.steps for path in step.paths]


def test_changes_stay_inside_the_range() -> None:
    found = _found(0.3 * EFFECTS["sky"] + NOISE, ALLOWED | {"sky": (0.0, 0.5)})
    assert all(step.changes[step.paths.index("sky")] >= -1e-9 for step in found.steps if "sky" in step.paths)
    assert found.floor("roof") > 0.15


def test_random_effects_are_not_named() -> None:
    """On weeks that were not used to find them, parameters without meaning explain nothing."""
    random_effects = {f"p{k}": RANDOM.normal(size=(DAY.size, 2)) for k in range(200)}
    found = find_error_sources(
        {"air": NOISE[:, 0], "roof": NOISE[:, 1]},
        random_effects,
        standard_uncertainty=[0.05, 0.05],
        allowed=dict.fromkeys(random_effects, (-1.0, 1.0)),
        days=DAY,
    )
    assert min(found.all_adjusted.sd) > 0.98 * min(found.sd)
    assert found.steps == ()


def test_without_effects_nothing_is_named() -> None:
    found = find_error_sources({"air": NOISE[:, 0]}, {}, standard_uncertainty=[0.05], allowed={}, days=DAY)
    assert found.steps == ()
    assert found.all_adjusted.paths == ()
    assert found.all_adjusted.sd == pytest.approx(found.sd)


def test_gaps_and_short_records() -> None:
    error = 0.3 * EFFECTS["sky"] + NOISE
    error[100:300, 0] = np.nan
    assert _found(error).steps[0].changes[0] == pytest.approx(-0.3, abs=0.01)
    short = find_error_sources(
        {"air": error[:72, 0], "roof": error[:72, 1]},
        {path: effect[:72] for path, effect in EFFECTS.items()},
        standard_uncertainty=[0.1, 0.1],
        allowed=ALLOWED,
        days=DAY[:72],
    )
    assert short.steps[0].paths == ("sky",)


def test_dictionary_is_json() -> None:
    found = json.loads(json.dumps(_found(0.3 * EFFECTS["sky"] + NOISE).to_dict(), allow_nan=False))
    assert found["steps"][0]["path"] == "sky"
    assert set(found["steps"][0]["sd"]) == {"air", "roof"}
    assert found["all_parameters"]["parameters"] == 3


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match=r"effect of 'a': found shape \(3, 1\), expected \(72, 1\)"):
        find_error_sources(
            {"air": NOISE[:72, 0]},
            {"a": np.ones((3, 1))},
            standard_uncertainty=[0.1],
            allowed={},
            days=DAY[:72],
        )
