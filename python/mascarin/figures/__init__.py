"""Figures: functions that draw arrays on matplotlib axes, and the writing of figures to files."""

from __future__ import annotations
