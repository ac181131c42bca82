"""Building thermal fabric cases of ANSI/ASHRAE Standard 140 (BESTEST), with the results of six programs."""

from __future__ import annotations
