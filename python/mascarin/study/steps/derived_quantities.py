"""Quantities that follow from the estimates: heat loss by destination, capacity, time constant, U values.

Each is computed from the building with the values of a sample of the posterior, so that its interval has the
correlations between the parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.building.heat_loss import heat_loss
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.calibration import Calibration
    from mascarin.calibration.errors.joint_posterior import JointPosterior

    Array = npt.NDArray[np.float64]

#: Buildings that are computed, at most.
_MOST: Final = 100
_SEED: Final = 17
#: Title of the table of the report.
TITLE: Final = "Heat loss and storage of the calibrated building"


@dataclass(frozen=True, slots=True)
class DerivedQuantity:
    """A quantity with its interval.

    Attributes
    ----------
    name, unit : str
        What it is.
    value : float
        At the estimates. [unit]
    low, high : float
        Ends of the interval of the confidence of the calibration. [unit]

    Examples
    --------
    >>> DerivedQuantity("heat loss coefficient", "W/K", 51.0, 46.0, 56.0).value
    51.0
    """

    name: str
    unit: str
    value: float
    low: float
    high: float

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file, with six digits."""
        numbers = {key: float(f"{getattr(self, key):.6g}") for key in ("value", "low", "high")}
        return {"name": self.name, "unit": self.unit, **numbers}


def derived_quantities(fit: Calibration, joint: JointPosterior | None = None) -> list[DerivedQuantity]:
    """Compute heat loss, capacity, time constant and U values with their intervals.

    Parameters
    ----------
    fit : Calibration
        Of a building.
    joint : JointPosterior, optional
        Its joint distribution with the errors of sensors and model, where these are estimated.

    Returns
    -------
    list of DerivedQuantity
        Empty for a building without zones, or without a building.
    """
    building = fit.nominal_building
    if building is None or not building.zones:
        return []
    center = _numbers(building, dict(zip(fit.problem.paths, fit.x.tolist(), strict=True)))
    found: list[dict[tuple[str, str], float]] = []
    for row in _sample(fit, joint):
        values = {p.path: p.value(z) for p, z in zip(fit.problem.parameters, row, strict=True)}
        try:
            found.append(_numbers(building, values))
        except InputError:
            continue  # a value of the sample that its part does not allow
    quantities = []
    tail = 0.5 * (1.0 - fit.confidence)
    for (name, unit), value in center.items():
        drawn = [one[name, unit] for one in found if (name, unit) in one] or [value]
        low, high = np.quantile(drawn, [tail, 1.0 - tail])
        # The interval contains the estimate, which may be on the end of a range.
        quantities.append(DerivedQuantity(name, unit, value, min(float(low), value), max(float(high), value)))
    return quantities


def _sample(fit: Calibration, joint: JointPosterior | None) -> Array:
    """Positions of the parameters in their ranges, shape (n, P). [-]"""
    if joint is not None:
        sample = joint.widened()
        return np.asarray(sample[:: max(1, len(sample) // _MOST)])
    covariance = np.atleast_2d(fit.uncertainty.covariance)
    rng = np.random.default_rng(_SEED)
    center = fit.problem.positions(fit.x)
    value, vectors = np.linalg.eigh(np.nan_to_num(covariance))
    root = vectors * np.sqrt(np.maximum(value, 0.0))
    return np.asarray(np.clip(center + rng.standard_normal((_MOST, center.size)) @ root.T, 0.0, 1.0))


def _numbers(building: Building, values: dict[str, float]) -> dict[tuple[str, str], float]:
    """All quantities of a building with other values, by name and unit."""
    found = heat_loss(building.replace(values))
    numbers = {("heat loss coefficient", "W/K"): found.total}
    numbers |= {(f"heat loss, {place}", "W/K"): value for place, value in found.destinations.items()}
    numbers[("effective heat capacity", "Wh/K")] = found.capacity
    if np.isfinite(found.time_constant):
        numbers[("time constant", "h")] = found.time_constant
    numbers |= {(f"U value, {name}", "W/(m2 K)"): value for name, value in found.u_values.items()}
    return {key: value for key, value in numbers.items() if np.isfinite(value)}


def derived_table(found: list[DerivedQuantity]) -> dict[str, Any]:
    """The same as a table of the report."""
    return {
        "title": TITLE,
        "caption": (
            "From the description with the estimates: laws by wind at 4 m/s, correlations of surfaces as in "
            "ISO 6946, infiltration at 4 m/s and 10 K; pressure tests, ventilation and latent heat are left "
            "out. "
            "The intervals are those of the calibration with the correlations of its parameters; numbers "
            "that are not calibrated count as known."
        ),
        "columns": ["quantity", "value", "95 % low", "95 % high", "unit"],
        "rows": [[one.name, one.value, one.low, one.high, one.unit] for one in found],
        "section": "parameters",
        "significant": ["value", "95 % low", "95 % high"],
    }
