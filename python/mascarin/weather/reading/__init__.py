"""Weather and measurements from files, frames and the data that is shipped."""

from __future__ import annotations
