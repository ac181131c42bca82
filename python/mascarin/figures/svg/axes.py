"""Axes and figures that several sections use."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
from markupsafe import Markup

from mascarin.figures.svg.chart import Array, Axis


@dataclass(frozen=True)
class Figure:
    """A drawing with its words."""

    title: str
    drawing: Markup
    caption: str = ""


def hours_of(count: int, step: float) -> Array:
    """Hours since the first of so many instants."""
    hours: Array = np.arange(count, dtype=np.float64) * (step / 3600.0)
    return hours


def time_axis(first: datetime, hours: float) -> Axis:
    """Axis in hours from a first instant with marks at midnights."""
    to_midnight = (24.0 - (first.hour + first.minute / 60.0)) % 24.0
    days = max(1.0, hours / 24.0)
    day_spacing = max(1, math.ceil(days / 6.0))
    marks = np.arange(to_midnight, hours + 1e-6, 24.0 * day_spacing)
    names = [short_day(first + timedelta(hours=float(m))) for m in marks]
    return Axis(0.0, max(hours, 1e-6), [float(m) for m in marks], names)


def short_day(time: datetime) -> str:
    """Day and month, such as 5 Oct."""
    return f"{time.day} {time:%b}"


def hour_marks(hours: Array) -> tuple[list[float], list[str]]:
    """Marks at every sixth hour, and their names."""
    low, high = float(hours.min(initial=0.0)), float(hours.max(initial=24.0))
    marks = [float(h) for h in range(0, 25, 6) if low - 1e-9 <= h <= high + 1e-9]
    return marks, [f"{int(m)}" for m in marks]
