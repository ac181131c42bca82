"""Sections of the report: each a module with the values of its template, which stands beside it."""

from __future__ import annotations
