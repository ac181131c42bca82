"""Quantities that follow from the estimates: heat loss by destination, capacity, time constant, U values.

Each is computed from the building with the values of a sample of the posterior, so that its interval has the
correlations between the parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.checks.conductances import BASIS, SUM, by_destination, conductances
from mascarin.building.checks.conductances import TITLE as CONDUCTANCES
from mascarin.building.engine_input.ratings import window_ratings
from mascarin.building.heat_loss import heat_loss
from mascarin.errors import InputError
from mascarin.study.context.phase_change import daily_range, day_of, latent_heat_of, melting_layers
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.estimates import DerivedEntry

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.engine_input.ratings import WindowRating
    from mascarin.calibration import Calibration
    from mascarin.calibration.errors.joint_posterior import JointPosterior
    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation

    Array = npt.NDArray[np.float64]

#: Buildings that are computed, at most; and runs of the model.
_MOST: Final = 100
_FEW_RUNS: Final = 32
_SEED: Final = 17
#: Title of the table of the report.
#: Beginning of the names of the latent heat.
LATENT: Final = "latent heat used per day"
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

    @property
    def entry(self) -> DerivedEntry:
        """The quantity for the results of a study, with six digits."""
        numbers = {key: float(f"{getattr(self, key):.6g}") for key in ("value", "low", "high")}
        return DerivedEntry(name=self.name, unit=self.unit, **numbers)


def derived_quantities(fit: Calibration, joint: JointPosterior | None = None) -> list[DerivedQuantity]:
    """Compute heat loss, capacity, time constant, solar apertures and U values with their intervals.

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
    estimates = dict(zip(fit.problem.paths, fit.x.tolist(), strict=True))
    # The engine rates the glass; it does so again only where glass itself is calibrated.
    glass = any(path.startswith(("glazings.", "windows.")) for path in fit.problem.paths)
    ratings = None if glass else window_ratings(building)
    center = _numbers(building, estimates, ratings)
    found: list[dict[tuple[str, str], float]] = []
    for row in _sample(fit, joint):
        values = {p.path: p.value(z) for p, z in zip(fit.problem.parameters, row, strict=True)}
        try:
            found.append(_numbers(building, values, ratings))
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


def _numbers(
    building: Building, values: dict[str, float], ratings: Mapping[str, WindowRating] | None
) -> dict[tuple[str, str], float]:
    """All quantities of a building with other values, by name and unit."""
    found = heat_loss(building.replace(values), ratings)
    numbers = {("heat loss coefficient", "W/K"): found.total}
    numbers |= {(f"heat loss, {place}", "W/K"): value for place, value in found.destinations.items()}
    numbers[("effective heat capacity", "Wh/K")] = found.capacity
    if np.isfinite(found.time_constant):
        numbers[("time constant", "h")] = found.time_constant
    numbers |= {(f"solar aperture, {part}", "m2"): value for part, value in found.apertures.items()}
    numbers |= {(f"U value, {name}", "W/(m2 K)"): value for name, value in found.u_values.items()}
    return {key: value for key, value in numbers.items() if np.isfinite(value)}


def latent_heat_used(
    simulation: Simulation, results: Results, fit: Calibration, joint: JointPosterior | None = None
) -> list[DerivedQuantity]:
    """Compute the latent heat that phase-change layers take up on a day, with its interval.

    On a day it is the range of the mean liquid fraction times the latent heat of the layer; the mean of all
    whole days of the record is given.

    Parameters
    ----------
    simulation, results
        The calibrated model over the record and its run, with the liquid fractions.
    fit, joint
        As for `derived_quantities`.

    Returns
    -------
    list of DerivedQuantity
        One for each layer whose material states its latent heat.
    """
    layers = melting_layers(simulation.building)
    names = [output.name for output in results.outputs]
    days = day_of(results.index)
    if not layers or days is None:
        return []
    rows = _sample(fit, joint)[:_FEW_RUNS]
    paths, problem = fit.problem.paths, fit.problem
    values = np.concatenate([fit.x[None], problem.values(rows)])
    base = simulation.vector(fit.values)
    records, _, _ = simulation.ensemble(simulation.varied(list(paths), values, base))
    quantities, tail = [], 0.5 * (1.0 - fit.confidence)
    for layer in layers:
        ranges = daily_range(records[..., names.index(layer.liquid_fraction)], days)
        heats = []
        for value, part in zip(values, ranges, strict=True):
            building = simulation.building.replace(dict(zip(paths, value.tolist(), strict=True)))
            heats.append(float(part) * latent_heat_of(building, layer) / 3600.0)
        if not np.isfinite(heats).all() or not any(heats):
            continue
        low, high = np.quantile(heats[1:], [tail, 1.0 - tail])
        name = f"{LATENT}, {layer.surface}"
        quantities.append(
            DerivedQuantity(name, "Wh", heats[0], min(float(low), heats[0]), max(float(high), heats[0]))
        )
    return quantities


def conductance_table(fit: Calibration) -> TableEntry | None:
    """Conductances by destination, as described and calibrated, as a table of the report.

    Parameters
    ----------
    fit : Calibration
        Of a building.

    Returns
    -------
    TableEntry or None
        None without a building or without any conductance.
    """
    building = fit.nominal_building
    if building is None:
        return None
    values = dict(zip(fit.problem.paths, fit.x.tolist(), strict=True))
    described, calibrated = (
        by_destination(conductances(each)) for each in (building, building.replace(values))
    )
    after = {(row.destination, row.kind, row.element, row.zone): row.value for row in calibrated}
    rows = [
        [
            row.destination,
            row.element,
            "" if row.element == SUM else row.kind,
            "" if row.element == SUM else row.zone,
            row.value,
            after.get((row.destination, row.kind, row.element, row.zone)),
        ]
        for row in described
    ]
    return (
        TableEntry(
            title=CONDUCTANCES,
            caption=BASIS,
            columns=["to", "element", "kind", "zone", "described [W/K]", "calibrated [W/K]"],
            rows=rows,
            section="parameters",
            significant=["described [W/K]", "calibrated [W/K]"],
        )
        if rows
        else None
    )


def derived_table(found: list[DerivedQuantity]) -> TableEntry:
    """The same as a table of the report."""
    latent = any(one.name.startswith(LATENT) for one in found)
    return TableEntry(
        title=TITLE,
        caption=(
            "From the description with the estimates: laws by wind at 4 m/s, correlations of surfaces as in "
            "ISO 6946, infiltration, with that of pressure tests, at 4 m/s and 10 K; ventilation and latent "
            "heat are left out of conductances. Solar apertures are those of windows at normal incidence and "
            "of opaque outer surfaces, without shading. "
            + ("Latent heat is the daily range of the liquid fraction, mean of all days. " if latent else "")
            + "The intervals are those of the calibration with the correlations of its parameters; "
            "numbers that are not calibrated count as known."
        ),
        columns=["quantity", "value", "95 % low", "95 % high", "unit"],
        rows=[[one.name, one.value, one.low, one.high, one.unit] for one in found],
        section="parameters",
        significant=["value", "95 % low", "95 % high"],
    )
