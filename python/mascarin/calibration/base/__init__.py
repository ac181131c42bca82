"""What every calibration is made of: problem, cost, evaluated runs, result."""

from __future__ import annotations
