"""The table of laws and outputs written as text on the page of a building."""

from __future__ import annotations

from mascarin.examples import box
from mascarin.pages.view.formulas import formulas
from mascarin.pages.view.page import render

LAW = {
    "formula": "c*abs(dT)^n + b",
    "c": {"value": 2.3, "range": [1, 4], "unit": "W/(m2 K^(1+n))"},
    "n": 0.33,
    "b": {"value": 1.5, "unit": "W/(m2 K)"},
    "valid": "abs(dT) < 30",
    "source": "a paper of 2020",
}


def test_formulas_stand_with_numbers_units_validity_and_source() -> None:
    """Two sides with the same law are one row; an output has its formula."""
    building = box().replace(
        {
            "surfaces.facade.inside.convection": LAW,
            "derived_outputs": {"gain": {"formula": "a*facade.inside_flux", "unit": "W",
                                         "a": {"value": 12, "unit": "m2"}}},
        }
    )  # fmt: skip
    law, output = formulas(building)
    assert law["paths"] == ["surfaces.facade.inside.convection"]
    assert law["formula"] == LAW["formula"]
    numbers = "c = 2.3 W/(m² K^(1+n)), 1 to 4; n = 0.33; b = 1.5 W/(m² K)"
    assert law["numbers"].replace("\N{NO-BREAK SPACE}", " ") == numbers
    assert (law["valid"], law["source"]) == ("abs(dT) < 30", "a paper of 2020")
    assert output["numbers"].replace("\N{NO-BREAK SPACE}", " ") == "a = 12 m²"
    page = render(building)
    assert "Laws and outputs written as text" in page
    assert "convection c*abs(dT)^n + b" in page
    assert "Laws and outputs written as text" not in render(box())
