"""Suspicious parts of measured series: stuck, filled, copied, spikes, missing, out of range."""

from __future__ import annotations

from mascarin.tables.quality.defects import Defect, Stretch, find, mask, runs

__all__ = ["Defect", "Stretch", "find", "mask", "runs"]
