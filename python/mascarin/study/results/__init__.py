"""Results of a study as tables, files and plain numbers."""

from __future__ import annotations
