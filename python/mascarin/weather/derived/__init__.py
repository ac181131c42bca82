"""Quantities that follow from others: the sun, radiation on surfaces, what completes a record."""

from __future__ import annotations
