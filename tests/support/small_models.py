"""The bench of small models of EnergyPlus, as a module."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from conftest import DATA, unavailable

BENCH = Path(__file__).resolve().parents[2] / "bench"


def energyplus_small() -> Any:
    """`bench/energyplus_small.py`; the test fails, or is left out, where its weather is absent."""
    sys.path.insert(0, str(BENCH))
    try:
        import energyplus_small as bench  # type: ignore[import-not-found]
    finally:
        sys.path.remove(str(BENCH))
    if not bench.WEATHER.is_file():
        unavailable(f"no weather at {bench.WEATHER}", DATA)
    return bench
