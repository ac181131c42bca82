"""Files and text shared by all packages: atomic writes, folder locks, short descriptions of objects."""

from __future__ import annotations
