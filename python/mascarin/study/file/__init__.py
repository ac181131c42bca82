"""The file of a study: its keys, its checks, and the files that it names."""

from __future__ import annotations
