"""The files of a GenOpt project: syntax, numbers, functions, entries."""

from __future__ import annotations
