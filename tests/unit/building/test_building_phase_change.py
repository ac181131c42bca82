"""Phase-change materials that cannot be as they are described: each error says what to do."""

from __future__ import annotations

from typing import Any

import pytest

import mascarin as mc
from mascarin.errors import InputError

b = mc.building

TANH = {"kind": "tanh", "width": 1.0}
TABLE = {"kind": "table", "temperatures": [20, 22, 24, 26], "enthalpies": [0, 4000, 1.5e5, 1.54e5]}
FRACTIONS = {"kind": "fractions", "temperatures": [22, 24], "fractions": [0, 1]}


def material(**changes: Any) -> mc.building.PhaseChangeMaterial:
    given = {
        "conductivity": 0.2, "density": 800, "specific_heat": 2000, "latent_heat": 1.5e5,
        "melting_temperature": 23, "law": TANH,
    }  # fmt: skip
    given |= changes
    return b.PhaseChangeMaterial(**{key: value for key, value in given.items() if value is not None})


@pytest.mark.parametrize(
    ("changes", "found", "advice"),
    [
        ({"latent_heat": None}, "latent_heat: needed by the tanh law", "Add 'latent_heat:'"),
        ({"melting_temperature": None}, "needed by the tanh law", "Add 'melting_temperature:'"),
        (
            {"law": TABLE, "latent_heat": None},
            "the table law includes the melting temperature",
            "vary the law's temperature_shift",
        ),
        (
            {
                "law": TABLE, "latent_heat": None, "melting_temperature": None,
                "hysteresis": {"model": "curve_track", "freezing_temperature": 21},
            },
            "the law table with hysteresis",
            "kind: fractions",
        ),
        (
            {"hysteresis": {"model": "curve_track"}},
            "needed by the tanh law",
            "Add 'freezing_temperature:'",
        ),
        (
            {
                "law": FRACTIONS, "melting_temperature": None,
                "hysteresis": {"model": "curve_track", "freezing_temperature": 21},
            },
            "the fractions law includes the freezing temperature",
            "Add 'law: {kind: fractions, ...}' below hysteresis",
        ),
        (
            {"hysteresis": {"model": "curve_track", "freezing_temperature": 25}},
            "never more liquid on heating than on cooling",
            "Exchange the two curves",
        ),
        ({"melting_temperature": 296.15}, "a temperature in degC below 200", "296.15 K are 23.00 degC"),
        ({"latent_heat": 150}, "at least 1000 J/kg", "150 kJ/kg are 150000 J/kg"),
        (
            {
                "law": {**TABLE, "enthalpies": [0, 4, 150, 154]}, "latent_heat": None,
                "melting_temperature": None,
            },
            "at least 1000 J/kg of latent and sensible heat",
            "Write the table in J/kg, not kJ/kg",
        ),
    ],
)  # fmt: skip
def test_what_does_not_fit_together_is_refused(changes: dict[str, Any], found: str, advice: str) -> None:
    with pytest.raises(InputError) as caught:
        material(**changes)
    assert found in str(caught.value)
    assert advice in str(caught.value)


def test_the_same_materials_without_the_errors_are_accepted() -> None:
    assert material().latent_heat == 1.5e5
    material(law=TABLE, latent_heat=None, melting_temperature=None)
    material(hysteresis={"model": "curve_track", "freezing_temperature": 21})
