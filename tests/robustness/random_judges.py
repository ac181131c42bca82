"""What no run may give, judged from its records alone: independent of the engine's own judges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from mascarin.building import Building, Output
from random_cases import Case

Array = npt.NDArray[np.float64]

ABSOLUTE_ZERO = -273.15
#: No room, wall or window is hotter. [degC]
HOTTEST = 2000.0 - 273.15
#: Rounding of records.
ROUNDING = 1e-9
#: Relative residuals of the balances that are reported as faults. [-]
RESIDUAL = 1e-8
#: Irradiance over that of the sun outside of the atmosphere, beside what the ground reflects. [-]
OVER_EXTRATERRESTRIAL = 1.1

#: Outputs that are fractions from 0 to 1.
FRACTIONS = {
    "liquid_fraction", "solar_transmittance", "vent_open", "control_open", "condensation",
    "relative_humidity",
}  # fmt: skip
#: Outputs that are not negative, beside fractions.
NOT_NEGATIVE = {
    "heating_load", "cooling_load", "latent_heating", "latent_cooling", "incident_solar", "air_changes",
    "vent_inflow", "vent_outflow", "convection", "humidity_ratio", "surface_humidity",
    "zone_transmitted_solar", "zone_lost_solar", "absorbed_solar",
}  # fmt: skip
HUMIDITIES = {"humidity_ratio", "relative_humidity", "surface_humidity"}


@dataclass(frozen=True)
class Fault:
    """Something that no run may give.

    Attributes
    ----------
    kind : str
        Its kind, by which faults are counted.
    text : str
        Where it is, and the value.
    """

    kind: str
    text: str


@dataclass(frozen=True)
class Extremes:
    """Lowest and highest values of some records; NaN where there is no such output."""

    lowest: float = math.nan
    highest: float = math.nan
    driest: float = math.nan
    dampest: float = math.nan
    ratio: float = math.nan
    irradiance: float = math.nan
    over_capacity: float = math.nan
    fractions_outside: int = 0


def faults(
    case: Case,
    building: Building,
    outputs: list[Output],
    records: Array,
    changed: Mapping[str, float] | None = None,
) -> list[Fault]:
    """Impossible values in the records of a run.

    Parameters
    ----------
    case : Case
        The case, for its weather.
    building : Building
        Its building.
    outputs : list of Output
        What was recorded.
    records : ndarray, shape (rows, outputs)
        Values. [unit of each]
    changed : mapping of str to float, optional
        Parameters of a member that differ from those of the building. [unit of each]
    """
    list_of_faults: list[Fault] = []
    for k, output in enumerate(outputs):
        values = records[:, k]
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values))[0])
            list_of_faults.append(Fault("not finite", f"{output.name} in row {row}: {values[row]}"))
            continue
        low, high = float(values.min()), float(values.max())
        for kind, at, limit in _outside(case, building, output, low, high, changed or {}):
            where = f"{output.name} in row {_row(values, at)}"
            list_of_faults.append(Fault(kind, f"{where}: {at:.6g} {output.unit} ({limit})"))
    return list_of_faults


def _row(values: Array, value: float) -> int:
    return int(np.flatnonzero(values == value)[0])


def _outside(
    case: Case, building: Building, output: Output, low: float, high: float, changed: Mapping[str, float]
) -> list[tuple[str, float, str]]:
    """Limits that the lowest or the highest value of an output is beyond: kind, value, limit."""
    outside = []
    if output.unit == "degC":
        if low < ABSOLUTE_ZERO:
            outside.append(("below absolute zero", low, f"expected {ABSOLUTE_ZERO:g} degC or more"))
        if high > HOTTEST:
            outside.append(("above 2000 K", high, f"expected {HOTTEST:g} degC or less"))
    if output.kind in NOT_NEGATIVE | FRACTIONS and low < -ROUNDING:
        kind = "negative humidity" if output.kind in HUMIDITIES else f"negative {output.kind}"
        outside.append((kind, low, "expected 0 or more"))
    if output.kind in FRACTIONS and high > 1.0 + ROUNDING:
        outside.append((f"fraction above 1: {output.kind}", high, "expected 1 or less"))
    most = capacity(building, output, changed)
    if high > most * (1.0 + ROUNDING) + ROUNDING:
        outside.append(("load above its capacity", high, f"expected {most:g} W or less"))
    if output.kind == "incident_solar":
        bound = largest_irradiance(case, building, output, changed)
        if high > bound:
            outside.append(("irradiance", high, f"expected {bound:.0f} W/m2 or less"))
    return outside


def capacity(building: Building, output: Output, changed: Mapping[str, float]) -> float:
    """Largest load of an output [W]; infinite for all others."""
    if output.zone is None:
        return math.inf
    name = list(building.zones)[output.zone]
    part: Any = None
    path = ""
    if output.kind in ("heating_load", "cooling_load"):
        which = output.kind.removesuffix("_load")
        part, path = getattr(building.zones[name], which), f"zones.{name}.{which}.capacity"
    elif output.kind in ("latent_heating", "latent_cooling") and building.humidity is not None:
        which = "humidifying" if output.kind == "latent_heating" else "drying"
        part, path = getattr(building.humidity.zones[name], which), f"humidity.zones.{name}.{which}.capacity"
    limit = getattr(part, "capacity", None)
    return math.inf if limit is None else changed.get(path, float(limit))


def largest_irradiance(case: Case, building: Building, output: Output, changed: Mapping[str, float]) -> float:
    """Irradiance on a plane that no sun exceeds [W/m2], or that of its measured column."""
    at = output.surface or 0
    walls = list(building.surfaces.values())
    side = walls[at].outside if at < len(walls) else list(building.windows.values())[at - len(walls)].outside
    sun = case.weather.extraterrestrial
    reflected = changed.get("site.ground_reflectance", float(building.site.ground_reflectance))
    bound = OVER_EXTRATERRESTRIAL * sun * (1.0 + reflected)
    column = side.irradiance
    return bound if column is None else max(bound, 1.0 + float(case.weather.measured[column].max()))


def extremes(building: Building, outputs: list[Output], records: Array) -> Extremes:
    """Lowest and highest values by what they are."""

    def of(*kinds: str, unit: str = "") -> Array:
        chosen = [
            k for k, output in enumerate(outputs) if output.kind in kinds or (unit and output.unit == unit)
        ]
        return records[:, chosen]

    def end(values: Array, *, lowest: bool) -> float:
        if values.size == 0:
            return math.nan
        return float(values.min() if lowest else values.max())

    degrees, damp, fractions = of(unit="degC"), of("relative_humidity"), of(*FRACTIONS)
    loads = [
        float(records[:, k].max()) / most if most > 0.0 else 1.0
        for k, one in enumerate(outputs)
        if math.isfinite(most := capacity(building, one, {}))
    ]
    outside = (fractions < -ROUNDING) | (fractions > 1.0 + ROUNDING)
    return Extremes(
        lowest=end(degrees, lowest=True), highest=end(degrees, lowest=False),
        driest=end(damp, lowest=True), dampest=end(damp, lowest=False),
        ratio=end(of("humidity_ratio"), lowest=True),
        irradiance=end(of("incident_solar"), lowest=False),
        over_capacity=max(loads, default=math.nan),
        fractions_outside=int(outside.sum()),
    )  # fmt: skip
