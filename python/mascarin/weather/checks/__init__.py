"""Whether a record can be right: sun and clock, brightness, place, missing infrared radiation."""

from __future__ import annotations
