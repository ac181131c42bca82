"""Verification: the simulation compared with analytical solutions and with other programs (BESTEST)."""

from __future__ import annotations
