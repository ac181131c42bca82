"""Files that Mascarin writes for itself: sealed, bounded, confined to their folder."""

from __future__ import annotations
