"""The steps of a study: from its inputs to results as data."""

from __future__ import annotations
