"""Types of arrays."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.floating[Any]]
"""Numbers."""

Flags: TypeAlias = npt.NDArray[np.bool_]
"""True or false."""

Halvings: TypeAlias = npt.NDArray[np.uint8]
"""How often an interval is halved for each step."""

Lines: TypeAlias = npt.NDArray[np.int64]
"""Row or line numbers."""
