"""Optimisers beyond GenOpt's, under names of their own."""

from __future__ import annotations

from mascarin.genopt.algorithm import Algorithm

ALGORITHMS: dict[str, Algorithm] = {}
