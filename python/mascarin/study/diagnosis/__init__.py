"""Causes of the remaining error of a study: signatures of the model, search, words."""

from __future__ import annotations
