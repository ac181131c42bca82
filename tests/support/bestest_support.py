"""Invented years of the cases of Standard 140, with exact numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mascarin.verification.bestest.catalogue import CASES, Case
from mascarin.verification.bestest.quantities import (
    HOURS,
    ONTO_GLASS,
    ORIENTATIONS,
    THROUGH_GLASS,
    BestestYear,
    has_solar_quantities,
)

if TYPE_CHECKING:
    from mascarin.verification.bestest.quantities import Array


def wave(low: float, high: float) -> Array:
    """Equal days: lowest at midnight, highest at noon. [any]"""
    hours = np.arange(HOURS, dtype=np.float64) % 24
    shape: Array = low + (high - low) * 0.5 * (1.0 - np.cos(2.0 * np.pi * (hours + 0.5) / 24.0))
    return shape


def year(case: Case) -> BestestYear:
    """A year with every series of the case."""
    series = {f"{zone}.air_temperature": wave(10.0, 30.0) for zone in {case.zone, case.floating or case.zone}}
    if case.conditioned:
        series[f"{case.zone}.cooling_load"] = wave(0.0, 2000.0)
        if case.thermostat != "day cooling":
            series[f"{case.zone}.heating_load"] = wave(1000.0, 0.0)
    if case.name == "600":
        series |= {output: wave(0.0, 300.0 + k) for k, output in enumerate(ORIENTATIONS.values())}
        series["sky_temperature"] = wave(-10.0, 0.0)
    if has_solar_quantities(case):
        series |= {ONTO_GLASS: wave(0.0, 300.0), THROUGH_GLASS: wave(0.0, 100.0 if case.shaded else 150.0)}
    return BestestYear(case, series, 1e-14)


def years() -> dict[str, BestestYear]:
    """All cases."""
    return {name: year(case) for name, case in CASES.items()}
