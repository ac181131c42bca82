"""Weather as a record: its channels, its site, and the view that climates and measurements are."""

from __future__ import annotations
