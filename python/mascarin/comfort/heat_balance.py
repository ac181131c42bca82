"""Indices from the heat balance of a person: PMV, SET, heat index and UTCI, by the package pythermalcomfort.

Each has limits of validity. Outside of them the value is NaN and the reason is counted; nothing is
extrapolated. pythermalcomfort is an extra and is imported when the first of these indices is calculated.

References
----------
ISO 7730:2005, clause 4.1 (limits) and annex D (program and table of examples).
ANSI/ASHRAE Standard 55-2020, normative appendix D (SET).
Rothfusz 1990, The heat index equation, National Weather Service technical attachment SR 90-23.
Bröde et al. 2012, International Journal of Biometeorology 56, 481-494, doi:10.1007/s00484-011-0454-1 (UTCI).
Tartarini & Schiavon 2020, SoftwareX 12, 100578, doi:10.1016/j.softx.2020.100578 (pythermalcomfort).
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from mascarin._io.limits import above, below
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Evaluation, Flags, Floats
from mascarin.errors import InputError
from mascarin.physics import saturation_pressure

PMV_CATEGORIES: Final = {"A": (-0.2, 0.2), "B": (-0.5, 0.5), "C": (-0.7, 0.7)}
"""Limits of the PMV, ISO 7730 table A.1. [-]"""

Limits = tuple[float, float]

#: What the equations were fitted for: key of the quantity -> its name, lowest and highest value, unit.
_PMV: Final = {
    "air": ("air temperature", 10.0, 30.0, "degC"),
    "radiant": ("mean radiant temperature", 10.0, 40.0, "degC"),
    "speed": ("relative air speed", 0.0, 1.0, "m/s"),
    "vapour": ("vapour pressure", 0.0, 2700.0, "Pa"),
    "met": ("metabolic rate", 0.8, 4.0, "met"),
    "clo": ("clothing", 0.0, 2.0, "clo"),
    "value": ("PMV", -2.0, 2.0, ""),
}
_SET: Final = {
    "air": ("air temperature", 10.0, 40.0, "degC"),
    "radiant": ("mean radiant temperature", 10.0, 40.0, "degC"),
    "speed": ("air speed", 0.0, 2.0, "m/s"),
    "met": ("metabolic rate", 1.0, 4.0, "met"),
    "clo": ("clothing", 0.0, 1.5, "clo"),
}
_HEAT_INDEX: Final = {
    "air": ("air temperature", 26.7, 45.0, "degC"),  # 80 degF; the table that was fitted ends at 110 degF
    "humidity": ("relative humidity", 40.0, 100.0, "%"),
}
_UTCI: Final = {
    "air": ("air temperature", -50.0, 50.0, "degC"),
    "difference": ("mean radiant less air temperature", -30.0, 70.0, "K"),
    "speed": ("wind speed at 10 m", 0.5, 17.0, "m/s"),
    "vapour": ("vapour pressure", 0.0, 5000.0, "Pa"),
}


def pmv(conditions: Conditions, category: str) -> Evaluation:
    """Predicted mean vote between the limits of a category of ISO 7730."""
    low, high = PMV_CATEGORIES[category]
    inputs = _inputs(conditions)
    met = conditions.metabolic_rate
    # Moving arms and legs adds to the air speed: ISO 7730 takes the speed relative to the person.
    speed = inputs["speed"] + 0.3 * max(met - 1.0, 0.0)
    vote = _called(
        "pmv_ppd_iso", "pmv", tdb=inputs["air"], tr=inputs["radiant"], vr=speed, rh=inputs["humidity"],
        met=met, clo=conditions.clothing,
    )  # fmt: skip
    return _limited(vote, _PMV, {**inputs, "speed": speed, "value": vote}, (low, high))


def dissatisfied(vote: npt.ArrayLike) -> Floats:
    """Predicted percentage of dissatisfied people.

    Parameters
    ----------
    vote : array_like
        Predicted mean vote.

    Returns
    -------
    ndarray
        ISO 7730, equation 5. [%]

    Examples
    --------
    >>> dissatisfied([0.0, 0.5, -0.75]).round(1)
    array([ 5. , 10.2, 16.8])
    """
    square = np.asarray(vote, dtype=np.float64) ** 2
    return np.asarray(100.0 - 95.0 * np.exp(-0.03353 * square**2 - 0.2179 * square), dtype=np.float64)


def standard_effective_temperature(conditions: Conditions, limits: Limits) -> Evaluation:
    """Standard effective temperature between two temperatures."""
    inputs = _inputs(conditions)
    # The two-node model counts the motion of the body by itself: the air speed is that in the room.
    result = _called(
        "set_tmp", "set", tdb=inputs["air"], tr=inputs["radiant"], v=inputs["speed"], rh=inputs["humidity"],
        met=conditions.metabolic_rate, clo=conditions.clothing,
    )  # fmt: skip
    return _limited(result, _SET, inputs, limits)


def heat_index(conditions: Conditions, limits: Limits) -> Evaluation:
    """Heat index of Rothfusz below a temperature."""
    inputs = _inputs(conditions)
    result = _called("heat_index_rothfusz", "hi", tdb=inputs["air"], rh=inputs["humidity"])
    return _limited(result, _HEAT_INDEX, inputs, limits)


def utci(conditions: Conditions, limits: Limits) -> Evaluation:
    """Universal thermal climate index between two temperatures; the air speed is the wind at 10 m."""
    inputs = _inputs(conditions)
    inputs["difference"] = inputs["radiant"] - inputs["air"]
    result = _called(
        "utci", "utci", tdb=inputs["air"], tr=inputs["radiant"], v=inputs["speed"], rh=inputs["humidity"]
    )
    return _limited(result, _UTCI, inputs, limits)


def _inputs(conditions: Conditions) -> dict[str, Floats]:
    """What the equations take, all of one shape."""
    names = ("air", "radiant", "humidity", "speed", "met", "clo")
    quantities = (
        conditions.air_temperature, conditions.radiant_temperature, conditions.humidity,
        conditions.air_speed, conditions.metabolic_rate, conditions.clothing,
    )  # fmt: skip
    arrays = (np.asarray(quantity, dtype=np.float64) for quantity in quantities)
    by_name = dict(zip(names, np.broadcast_arrays(*arrays), strict=True))
    vapour = saturation_pressure(by_name["air"]) * by_name["humidity"] / 100.0
    return {**by_name, "vapour": vapour}


def _called(function: str, field: str, **inputs: Any) -> Floats:
    """A function of pythermalcomfort without its own limits, which would be counted for no reason."""
    try:
        from pythermalcomfort import models
    except ImportError:
        raise InputError(
            f"the comfort index of {function} needs the package pythermalcomfort: pip install "
            "'mascarin[comfort]'. The adaptive models, the operative temperature and Givoni's zones need no "
            "other package"
        ) from None
    result = getattr(models, function)(**inputs, limit_inputs=False, round_output=False)
    return np.asarray(getattr(result, field), dtype=np.float64)


def _limited(
    values: Floats,
    limits: dict[str, tuple[str, float, float, str]],
    inputs: dict[str, Floats],
    comfort: Limits,
) -> Evaluation:
    """Values inside the limits of an equation, NaN elsewhere, with the reasons."""
    outside: dict[str, Flags] = {}
    for key, (name, low, high, unit) in limits.items():
        outside[f"{name} below {low:g} {unit}".rstrip()] = below(inputs[key], low)
        outside[f"{name} above {high:g} {unit}".rstrip()] = above(inputs[key], high)
    invalid = np.any(np.stack(np.broadcast_arrays(*outside.values())), axis=0)
    return Evaluation(np.where(invalid, np.nan, values), *comfort, outside)
