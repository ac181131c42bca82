"""Derived outputs as the engine reads them."""

from __future__ import annotations

from collections.abc import Mapping

from mascarin.building.engine_input.ids import Json
from mascarin.building.outputs.output import outputs
from mascarin.building.parts.description import Description


def describe_derived(building: Description, ids: Mapping[str, int]) -> list[Json]:
    """Describe the derived outputs: formula, numbers, and the outputs that each uses."""
    if not building.derived_outputs:
        return []
    by_name = {output.name: output for output in outputs(building)}
    return [
        {
            "name": name,
            "law": {
                "formula": derived.formula,
                "numbers": [
                    {"name": number, "value": ids[f"derived_outputs.{name}.{number}"]}
                    for number in derived.numbers
                ],
            },
            "of": [
                {"name": word, "kind": by_name[word].kind, "place": by_name[word].place}
                for word in derived.used
                if word in by_name
            ],
        }
        for name, derived in building.derived_outputs.items()
    ]
