"""The page of designs: what is the same in all designs is said, and not drawn."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from mascarin.pages.design.page import _fronts


def test_an_objective_that_is_the_same_in_all_designs_has_no_figure() -> None:
    values = {"hot": np.array([1.0, 2.0, 3.0]), "cycles": np.zeros(3), "mass": np.array([3.0, 2.0, 1.0])}
    units = {"hot": "K h", "cycles": "d", "mass": "kg"}
    results: Any = SimpleNamespace(
        inputs=SimpleNamespace(
            file=SimpleNamespace(objectives=values),
            objective=lambda name: SimpleNamespace(unit=units[name], least=True),
        ),
        ranked_by="hot",
        designs=[(0,), (1,), (2,)],
        values=lambda name: values[name],
        front=lambda names: np.array([True, True, False]),
        winners=lambda: [0],
        label=str,
    )
    cycles, mass = _fronts(results)
    assert (cycles["title"], cycles["drawing"]) == ("cycles: 0\u00a0d in all designs", "")
    assert mass["title"].startswith("hot and mass")
    assert "<svg" in mass["drawing"]
