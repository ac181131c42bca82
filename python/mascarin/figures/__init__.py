"""Figures: functions that draw plain arrays on matplotlib axes, one module for each kind of result."""

from __future__ import annotations
