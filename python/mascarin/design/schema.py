"""JSON Schema of a design file, for editors."""

from __future__ import annotations

from typing import Any

from mascarin.building.json_schemas import schema_of
from mascarin.design.variants.description import DesignFile


def design_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a design file.

    Returns
    -------
    dict
        Every key has a description.

    Examples
    --------
    >>> "objectives" in design_schema()["properties"]
    True
    """
    return schema_of(DesignFile)
