"""Programs of this folder find what the tests share; pytest finds it by itself. Imported before all else."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
