"""Methods that look for the best parameters and for their distribution."""

from __future__ import annotations
