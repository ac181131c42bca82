"""What several commands share: their inputs, tables, outputs and exit codes."""

from __future__ import annotations
