"""Errors of sensors and model, estimated together with the parameters."""

from __future__ import annotations
