"""Calorimeter files of a known material, in the ways that instruments write them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

SOLID, LIQUID, LATENT, CENTRE, WIDTH = 2000.0, 2400.0, 150000.0, 24.0, 0.8
RATE = 0.25  # K/min


def temperatures() -> Array:
    return np.arange(10.0, 38.0001, 0.05)


def fraction(t: Array, centre: float = CENTRE) -> Array:
    return 0.5 + 0.5 * np.tanh((t - centre) / WIDTH)


def enthalpy(t: Array, centre: float = CENTRE) -> Array:
    """h(T, xi), with the latent heat at the temperature at which half is liquid [J/kg]."""
    over = t - centre
    return SOLID * over + fraction(t, centre) * (LATENT + (LIQUID - SOLID) * over)


def heat(t: Array, centre: float = CENTRE) -> Array:
    """Its exact slope [J/(kg K)]."""
    over, f = t - centre, fraction(t, centre)
    slope = 0.5 / (WIDTH * np.cosh(over / WIDTH) ** 2)
    return SOLID + (LIQUID - SOLID) * f + slope * (LATENT + (LIQUID - SOLID) * over)


def write(
    path: Path,
    columns: dict[str, Array],
    *,
    separator: str = ",",
    number: Callable[[float], str] = lambda x: f"{x:.8g}",
    head: str = "",
) -> Path:
    rows = [separator.join(map(number, row)) for row in np.column_stack(list(columns.values()))]
    path.write_text(head + separator.join(columns) + "\n" + "\n".join(rows) + "\n", encoding="utf-8")
    return path
