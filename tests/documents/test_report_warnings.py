"""Sentences about a calibration depend on its facts: warnings, contradictions with its data, carried bands.

As in `test_report_notes`, each sentence is made from facts, and again with each fact changed, and with facts
of which the opposite is true: then the sentence is not made.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.calibration import FitParameter
from mascarin.calibration.base.warnings import on_bounds, warnings
from mascarin.calibration.errors.posterior_checks import of_errors, of_estimates
from mascarin.errors import InputError
from mascarin.study.carried import bands
from mascarin.study.steps import predictive_checks

TIMES = pd.date_range("2024-05-01", periods=96, freq="1h", tz="UTC")


def different(base: str, changed: dict[str, str]) -> None:
    """Each changed fact changes the sentence, and each in its own way."""
    same = [name for name, text in changed.items() if text == base or not text]
    assert same == []
    assert len(set(changed.values())) == len(changed)


# --- warnings of a calibration ------------------------------------------------------------------------------


def warned(**facts: Any) -> list[str]:
    """Warnings about two parameters and one sensor; what is not stated gives none."""
    stated: dict[str, Any] = {
        "paths": ("a.k", "b.k"), "effect": (1.0, 1.0), "low": (0.4, 0.4), "high": (0.6, 0.6),
        "correlation": 0.1, "samples": 100.0, "bias": 0.0, "sensor": "air", "unit": "degC", "beside": "",
    } | facts  # fmt: skip
    times = 48
    sensor = SimpleNamespace(name=stated["sensor"], unit=stated["unit"], mask=np.ones(times, dtype=bool))
    problem: Any = SimpleNamespace(
        paths=stated["paths"], sensors=(sensor,), mask=np.ones((times, 1), dtype=bool), sigma=0.1
    )
    c = stated["correlation"]
    uncertainty: Any = SimpleNamespace(
        low=np.array(stated["low"]), high=np.array(stated["high"]),
        correlation=np.array([[1.0, c], [c, 1.0]]), effective_samples=(stated["samples"],),
    )  # fmt: skip
    residuals = np.tile([-0.1, 0.1], times // 2)[:, None] + stated["bias"]
    jacobian = np.tile(np.array(stated["effect"]), (times, 1, 1))
    return warnings(problem, np.full(2, 0.5), uncertainty, residuals, jacobian, stated["beside"])


WARNED: dict[str, tuple[dict[str, Any], dict[str, dict[str, Any]]]] = {
    "has no effect": (
        {"effect": (0.0, 1.0)},
        {"parameter": {"effect": (1.0, 0.0)}, "name": {"paths": ("c.k", "b.k")}},
    ),
    "be distinguished": (
        {"correlation": 0.98},
        {"sign": {"correlation": -0.98}, "size": {"correlation": 0.9995}, "name": {"paths": ("c.k", "b.k")}},
    ),
    "is not determined": (
        {"high": (0.6, 0.99), "low": (0.4, 0.05)},
        {"parameter": {"high": (0.99, 0.6), "low": (0.05, 0.4)}, "size": {"high": (0.6, 0.93)}},
    ),
    "independent samples": ({"samples": 4.0}, {"size": {"samples": 3.0}}),
    "has a bias": (
        {"bias": 0.3},
        {
            "side": {"bias": -0.3}, "size": {"bias": 0.5}, "sensor": {"sensor": "wall"},
            "unit": {"unit": "W/m2"}, "beside": {"beside": ", beside the estimated errors"},
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("words", WARNED)
def test_each_fact_of_a_warning_changes_its_sentence(words: str) -> None:
    facts, changes = WARNED[words]
    (base,) = warned(**facts)
    assert words in base
    different(base, {name: "\n".join(warned(**{**facts, **change})) for name, change in changes.items()})
    assert not any(words in text for text in warned())


def test_a_correlation_that_leaves_no_doubt_is_said_as_such() -> None:
    assert "can hardly be distinguished (correlation +0.980)" in warned(correlation=0.98)[0]
    assert "cannot be distinguished (correlation -0.999" in warned(correlation=-0.9994)[0]
    # Narrow intervals are of use whatever they are correlated with.
    narrow = warned(correlation=0.98, low=(0.49, 0.49), high=(0.51, 0.51))
    assert narrow == []


def bounded(
    z: float, slope: float, width: float = 0.2, unit: str = "K", lower: float = 2.0
) -> dict[str, str]:
    problem: Any = SimpleNamespace(parameters=[FitParameter("a.k", lower, 8.0, unit=unit)])
    uncertainty: Any = SimpleNamespace(low=np.zeros(1), high=np.full(1, width))
    return on_bounds(problem, np.array([z]), np.array([slope]), uncertainty)


def test_each_fact_of_an_estimate_on_a_bound_changes_its_reason() -> None:
    assert bounded(0.5, 1.0) == {}
    base = bounded(0.0, 0.0)["a.k"]
    assert base.startswith("on its lower bound 2 K: within the uncertainty, the data fit best at this end")
    changes = {
        "side": bounded(1.0, 0.0), "beyond": bounded(0.0, 1.0), "undetermined": bounded(0.0, 0.0, 0.9),
        "unit": bounded(0.0, 0.0, unit="W"), "bound": bounded(0.0, 0.0, lower=3.0),
    }  # fmt: skip
    different(base, {name: reasons["a.k"] for name, reasons in changes.items()})
    assert "at less than the range allows" in bounded(0.0, 1.0)["a.k"]
    assert "at more than the range allows" in bounded(1.0, -1.0)["a.k"]
    for z, slope in ((0.0, -1.0), (1.0, 1.0)):  # the cost rises beyond: nothing lies there
        assert "lies beyond" not in bounded(z, slope)["a.k"]
    assert "bound 2:" in bounded(0.0, 0.0, unit="-")["a.k"]


# --- contradictions -----------------------------------------------------------------------------------------


def whitened() -> np.ndarray[Any, Any]:
    return np.random.default_rng(1).standard_normal((6, 24, 2))


def contradicted(
    whitened_errors: Any = None, error: float = 0.5, name: str = "room offset", size: float = 0.1
) -> list[str]:
    """What `of_errors` says of two sensors on six days."""
    joint: Any = SimpleNamespace(
        z=np.zeros(1), mean=np.array([0.5, error]), names=(name,),
        unlimited=np.array([error if abs(error) > 2.0 else 0.0]) if "offset" in name else np.zeros(0),
        whitened=whitened() if whitened_errors is None else whitened_errors,
    )  # fmt: skip
    days = [f"2024-01-0{k}" for k in range(1, 7)]
    return [entry.text for entry in of_errors(joint, ["room", "wall"], {name: size}, days)]


def of_day(day: int, size: float = 2.5) -> np.ndarray[Any, Any]:
    values = whitened()
    values[day] *= size
    return values


def following(sensor: int, share: float = 0.6) -> np.ndarray[Any, Any]:
    values = whitened()
    values[:, 1:, sensor] = 0.8 * values[:, 1:, sensor] + share * values[:, :-1, sensor]
    return values


def test_each_fact_of_an_error_that_contradicts_changes_its_sentence() -> None:
    assert contradicted() == []
    (base,) = contradicted(error=3.1)
    assert "+0.31, 3.1 times its stated standard uncertainty of 0.1" in base
    changes = {
        "side": contradicted(error=-3.1), "size": contradicted(error=4.1),
        "stated": contradicted(error=3.1, size=0.2), "name": contradicted(error=3.1, name="wall offset"),
        "described": contradicted(error=3.1, name="numbers, 1"),
    }  # fmt: skip
    different(base, {name: "\n".join(texts) for name, texts in changes.items()})
    (base,) = contradicted(of_day(3))
    changes = {"day": contradicted(of_day(2)), "size": contradicted(of_day(3, 4.0))}
    different(base, {name: "\n".join(texts) for name, texts in changes.items()})
    (base,) = contradicted(following(1))
    assert base.startswith("wall: errors of neighbouring hours")
    changes = {"sensor": contradicted(following(0)), "size": contradicted(following(1, 0.7))}
    different(base, {name: "\n".join(texts) for name, texts in changes.items()})
    assert contradicted(following(1, -0.6)) == []  # a negative correlation makes no interval too narrow


def test_each_fact_of_an_estimate_that_contradicts_changes_its_sentence() -> None:
    def said(path: str, value: float, reason: str = "", unit: str = "W/(m K)") -> str:
        parameter = FitParameter(path, 0.1, 9.0, unit=unit)
        entries = of_estimates([parameter], np.array([value]), {path: reason} if reason else {})
        return "\n".join(entry.text for entry in entries)

    concrete = "materials.concrete.conductivity"
    assert said(concrete, 1.6) == ""
    base = said(concrete, 0.26)
    assert "the estimate of 0.26 W/(m K)" in base
    different(base, {
        "value": said(concrete, 0.3), "unit": said(concrete, 0.26, unit="W"),
        "material": said("materials.steel.conductivity", 0.26),
        "bound": said(concrete, 1.6, "on its lower bound 1 W"),
        "reason": said(concrete, 1.6, "on its upper bound 1 W"),
    })  # fmt: skip
    assert said(concrete, 1.6, "on its lower bound").startswith(f"{concrete} is on its lower bound; the ")


def checked(part: str, **facts: Any) -> str:
    """What one of the checks of `predictive_checks` says of a study with one sensor."""
    stated: dict[str, Any] = {
        "name": "air", "identification": 0.95, "corroboration": 0.95, "blind": 0.95, "confidence": 0.95,
        "same": False, "use": True, "scatter": 0.1, "uncertainty": 0.25, "unit": "degC", "apart": 0.0,
        "columns": ("T_1", "T_2"), "days": 7, "prior": None, "lower": 1.0, "upper": 2.0, "path": "a.k",
    } | facts  # fmt: skip
    name, rows = stated["name"], len(TIMES)
    reading = SimpleNamespace(absolute=stated["uncertainty"])
    sensor = SimpleNamespace(
        use=stated["use"], output="o", columns=stated["columns"], adds=False, uncertainty=lambda *_: reading
    )
    during = {
        "blind": np.arange(rows) > 40,
        "corroboration": np.arange(rows) > (40 if stated["same"] else 60),
    }
    values = {stated["columns"][0]: np.zeros(rows), stated["columns"][1]: np.full(rows, stated["apart"])}
    parameter = SimpleNamespace(
        path=stated["path"], prior=stated["prior"], lower=stated["lower"], upper=stated["upper"]
    )
    study: Any = SimpleNamespace(
        plan=SimpleNamespace(sensors={name: sensor}, identification=1),
        building=SimpleNamespace(output=lambda _: SimpleNamespace(unit=stated["unit"])),
        observation=SimpleNamespace(names=(name,), times=TIMES, interval=3600.0, measured=np.zeros((rows, 1)),
                                    simulated=lambda *_: np.ones((rows, 1))),
        measurements=SimpleNamespace(at=lambda column, *_: values[column]),
        used={"identification": np.ones((rows, 1), dtype=bool)}, during=during, estimates_errors=True,
        problem=lambda: SimpleNamespace(parameters=[parameter]),
    )  # fmt: skip
    periods = ("identification", "corroboration", "blind")
    intervals = SimpleNamespace(
        coverage={period: np.array([stated[period]]) for period in periods},
        center=np.zeros((rows, 1)), half_width=np.full((rows, 1), 0.5), confidence=stated["confidence"],
    )  # fmt: skip
    results = SimpleNamespace(index=TIMES, records=None)
    arguments: dict[str, tuple[Any, ...]] = {
        "_coverage": (study, SimpleNamespace(results=results), intervals), "_periods": (study, intervals),
    }  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(predictive_checks, "scatter_of", lambda *_: stated["scatter"])
        patch.setattr(predictive_checks, "_days", lambda _: [""] * stated["days"])
        entries = getattr(predictive_checks, part)(*arguments.get(part, (study,)))
        return "\n".join(entry.text for entry in entries)


CHECKED: dict[str, tuple[dict[str, Any], dict[str, dict[str, Any]]]] = {
    "_coverage": (
        {"identification": 0.8},
        {"share": {"identification": 0.7}, "confidence": {"confidence": 0.9}, "name": {"name": "wall"}},
    ),
    "_periods": (
        {"corroboration": 0.7},
        {
            "share": {"corroboration": 0.6}, "name": {"name": "wall"}, "confidence": {"confidence": 0.9},
            "period": {"corroboration": 0.95, "blind": 0.7}, "both": {"blind": 0.7},
        },
    ),
    "_scatters": (
        {"scatter": 0.9},
        {"size": {"scatter": 0.8}, "stated": {"uncertainty": 0.3}, "unit": {"unit": "W"},
         "name": {"name": "w"}},
    ),
    "_twins": (
        {"apart": 2.0},
        {
            "side": {"apart": -2.0}, "size": {"apart": 3.0}, "stated": {"uncertainty": 0.3},
            "columns": {"columns": ("T_1", "T_3")}, "unit": {"unit": "W"}, "name": {"name": "wall"},
        },
    ),
    "_few_days": ({"days": 2}, {"days": {"days": 1}}),
    "_priors": (
        {"prior": (3.0, 0.1)},
        {"mean": {"prior": (4.0, 0.1)}, "lower": {"lower": 0.5}, "upper": {"upper": 2.5},
         "path": {"path": "b"}},
    ),
}  # fmt: skip


@pytest.mark.parametrize("part", CHECKED)
def test_each_fact_of_a_check_changes_its_sentence(part: str) -> None:
    facts, changes = CHECKED[part]
    base = checked(part, **facts)
    assert base
    different(base, {name: checked(part, **{**facts, **change}) for name, change in changes.items()})
    assert checked(part) == ""


def test_checks_say_nothing_of_sensors_that_are_not_used_and_nothing_twice() -> None:
    assert checked("_coverage", identification=0.8, use=False) == ""
    # Blind days that are those of the corroboration are no second period.
    assert checked("_periods", corroboration=0.7, blind=0.7, same=True).count("band contains") == 1
    assert checked("_periods", corroboration=0.7, blind=0.7).count("band contains") == 2
    assert "from 1 day:" in checked("_few_days", days=1)
    assert "from 2 days:" in checked("_few_days", days=2)


# --- carried bands ------------------------------------------------------------------------------------------


def carried(**facts: Any) -> list[str]:
    """What bands say that are made with the posterior of another study; nothing if all is as there."""
    stated: dict[str, Any] = {
        "name": "air", "output": "room.air_temperature", "unit": "degC", "of": "room.air_temperature",
        "range": (0.0, 30.0), "series": 20.0, "weather": 10.0, "ends": (0.0, 20.0),
        "channel": "air_temperature", "study": "First", "value": 1.0, "has": True, "path": "a.k",
    } | facts  # fmt: skip
    sensor: Any = SimpleNamespace(
        output=stated["of"],
        unit="degC",
        range=stated["range"],
        repeating=0.1,
        daily=0.1,
        independent=0.1,
        limit=1.0,
    )
    sensor.model_copy = lambda update: SimpleNamespace(**{**vars(sensor), **update})
    posterior: Any = SimpleNamespace(
        confidence=0.95, days=7, intervals={stated["path"]: (1.0, 0.5, 1.5)}, numbers={},
        study=stated["study"],
        sensors={"T": sensor}, weather={stated["channel"]: stated["ends"]},
    )  # fmt: skip

    def parameter(path: str) -> Any:
        if not stated["has"]:
            raise InputError(path)
        return SimpleNamespace(value=stated["value"])

    simulation: Any = SimpleNamespace(
        building=SimpleNamespace(parameter=parameter), outputs=[SimpleNamespace(unit=stated["unit"])]
    )
    observation: Any = SimpleNamespace(times=TIMES, names=(stated["name"],))
    series = np.full((4, len(TIMES), 1), stated["series"])
    weather = {stated["channel"]: np.full(len(TIMES), stated["weather"])}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bands, "_simulated", lambda *_: series)
        carried = bands.carried_bands(simulation, observation, posterior, [stated["output"]], [0.1], weather)
    return list(carried.words)


CARRIED: dict[str, tuple[dict[str, Any], dict[str, dict[str, Any]]]] = {
    "does not have: a.k": ({"has": False}, {"path": {"path": "b.k"}}),
    "count as known: a.k": ({"value": 2.0}, {"path": {"path": "b.k"}}),
    "no sensor in W": ({"unit": "W", "of": "x.y"}, {"unit": {"unit": "W/m2"}, "name": {"name": "wall"}}),
    "was not measured in the identification": (
        {"of": "wall.air_temperature"},
        {"output": {"output": "attic.air_temperature"}, "name": {"name": "wall"}},
    ),
    "of the simulated values are outside": (
        {"series": 40.0},
        {"range": {"range": (0.0, 35.0)}, "low": {"range": (1.0, 30.0)}, "name": {"name": "wall"}},
    ),
    "air temperature: the daily means of 4 of 4 days": (
        {"weather": 30.0},
        {
            "ends": {"ends": (0.0, 25.0)}, "low": {"ends": (1.0, 20.0)}, "study": {"study": "Second"},
            "channel": {"channel": "wind_speed"},
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("words", CARRIED)
def test_each_fact_of_carried_bands_changes_its_sentence(words: str) -> None:
    facts, changes = CARRIED[words]
    (base,) = carried(**facts)
    assert words in base
    different(base, {name: "\n".join(carried(**{**facts, **change})) for name, change in changes.items()})
    assert carried() == []


def test_days_outside_are_those_outside() -> None:
    weather = np.repeat([10.0, 30.0, 25.0, 10.0], 24)
    posterior: Any = SimpleNamespace(weather={"air_temperature": (0.0, 20.0)}, study="First")
    days = bands.day_numbers(TIMES)
    distance, (words,) = bands._weather_outside(posterior, {"air_temperature": weather}, days, TIMES)
    assert "2 of 4 days" in words
    assert "2024-05-02, 2024-05-03" in words
    assert "2024-05-01" not in words
    assert (distance.reshape(4, 24)[:, 0] > 0.0).tolist() == [False, True, True, False]
