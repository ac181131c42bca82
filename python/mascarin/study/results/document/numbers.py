"""Numbers as JSON holds them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def plain(values: Any) -> Any:
    """Arrays as nested lists; values that are not finite as null."""
    if isinstance(values, np.ndarray):
        return [plain(value) for value in values]
    number = float(values)
    return number if math.isfinite(number) else None


def rounded(values: np.ndarray[Any, np.dtype[np.float64]]) -> list[float]:
    """A list of numbers with four decimals."""
    return [round(float(value), 4) for value in values]
