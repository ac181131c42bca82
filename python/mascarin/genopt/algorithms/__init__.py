"""The algorithms that a command file can name, and their settings."""

from __future__ import annotations
