"""The content of ``study.json``: all results of a study as plain numbers and words."""

from __future__ import annotations
