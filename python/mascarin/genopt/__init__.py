"""Runs GenOpt projects: the same files and the same listings, with any simulation program.

The names are imported when they are first used, because one evaluation of an exported study is a process of
its own and must start quickly.
"""

from __future__ import annotations

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
