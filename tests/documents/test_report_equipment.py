"""The model section of a report names what a building has beside its surfaces."""

from __future__ import annotations

from mascarin.examples import box
from mascarin.study.results.document.equipment import equipment


def test_units_and_heat_sources_have_rows() -> None:
    building = box().replace(
        {
            "ventilation_units": {"fan": {"supply": {"room": 0.01}, "exhaust": {"room": 0.01}}},
            "constructions.facade": {
                "layers": [
                    {"material": "concrete", "thickness": 0.1},
                    {"material": "concrete", "thickness": 0.1, "name": "inner"},
                ]
            },
            "surfaces.facade.construction": "facade",
            "heat_sources": {"foil": {"surface": "facade", "after": "concrete", "electric": {"power": 50}}},
        }
    )
    rows = dict(equipment(building))
    assert rows["ventilation unit fan"] == "supply to room, exhaust from room"
    assert rows["heat source foil"] == "electric, in facade after concrete"
