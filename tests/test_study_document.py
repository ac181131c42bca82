"""Parts of ``study.json`` from results that are made here."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pandas as pd

from mascarin.sensitivity import Factor
from mascarin.sensitivity.spectral import analyze, design
from mascarin.study.document.sensitivity import importance
from mascarin.study.setup import Setup


def test_frequencies_are_those_of_the_groups() -> None:
    factors = [
        Factor("a", 0.0, 1.0, group="walls"),
        Factor("b", 0.0, 1.0, group="walls"),
        Factor("c", 0.0, 1.0),
        Factor("d", 0.0, 1.0),
    ]
    plan = design(factors, seed=3)
    x = plan.all_samples()
    # Each output depends on one group only, so that its strongest line is the frequency of that group.
    results = {"of_walls": x[:, 0] + x[:, 1], "of_c": x[:, 2], "of_d": x[:, 3]}
    found = {name: analyze(plan, y, names=[name]) for name, y in results.items()}
    days = (pd.Timestamp("2023-03-01", tz="UTC"), pd.Timestamp("2023-03-02", tz="UTC"))
    study = cast("Setup", SimpleNamespace(identification=days))
    for output, group in (("of_walls", "walls"), ("of_c", "c"), ("of_d", "d")):
        content = importance(study, found[output])
        power = content["spectra"][output]["power"]
        strongest = content["spectra"][output]["frequencies"][power.index(max(power))]
        assert list(content["frequencies"]) == ["walls", "c", "d"]
        assert content["frequencies"][group] == strongest
