"""The whole method as one pipeline that can be interrupted and goes on where it was."""

from __future__ import annotations

from mascarin.study.pipeline import Findings, ModelRun, Study

__all__ = ["Findings", "ModelRun", "Study"]
