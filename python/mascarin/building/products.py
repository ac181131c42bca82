"""Materials taken from the library of products: ``ceiling_pcm: {product: RT25HC}``.

The short form is written out before anything is checked, each number with the product's source beside it.
What the user gives as well stands in place of the product's; what neither knows is refused.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pydantic_core import core_schema

from mascarin.building.number import problem, shown
from mascarin.errors import InputError
from mascarin.materials.library import DIRECTIONS, PROPERTIES, Curve, Product, product, suggestion

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic.json_schema import JsonSchemaValue


class FromLibrary:
    """Annotation: a material may name a product, and hold only what differs from it."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Write the product out first, then read the material."""
        return core_schema.no_info_before_validator_function(expand, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Allow the short form beside the whole material."""
        name = {"type": "string", "description": "Product of the library: 'mascarin materials' lists them"}
        short = {"type": "object", "properties": {"product": name}, "required": ["product"]}
        return {"anyOf": [handler(schema), short]}


def expand(raw: Any) -> Any:
    """Write out a material that names a product; anything else stays as it is.

    Raises
    ------
    PydanticCustomError
        If there is no such product, it is given another kind, or neither it nor the user knows a property.
    """
    if not isinstance(raw, Mapping) or raw.get("product") is None:
        return raw
    one = _named(raw["product"])
    if raw.get("kind", "pcm") != "pcm":
        raise problem(f"kind: {raw['kind']}", "kind: pcm, or none", f"{one.name} is a phase-change material.")
    written: dict[str, Any] = {"kind": "pcm"}
    written |= {key: _noted(one.raw[key], one) for key in PROPERTIES if key in one.raw}
    written |= {key: value for key, value in raw.items() if value is not None}
    written["product"] = one.name
    _complete(written, one)
    law = _law(raw.get("law"), one)
    if law is None:
        raise problem(
            f"no law; {one.name} has no curves",
            "law: how it melts",
            "Add 'law:', such as {kind: tanh, width: 1.0}.",
        )
    written["law"] = law
    return _melting(one) | written if _by_melting_temperature(law) else written


def _complete(written: Mapping[str, Any], one: Product) -> None:
    gaps = [key for key in PROPERTIES if key not in written]
    if gaps:
        raise problem(
            f"no {' and no '.join(gaps)}; the source of {one.name} does not say",
            ", ".join(f"{key}: a value from you" for key in gaps),
            f"Write {gaps[0]}: beside product:.",
        )


def _named(name: Any) -> Product:
    if not isinstance(name, str):
        raise problem(f"product: {shown(name)}", "the name of a product", "'mascarin materials' lists them.")
    try:
        return product(name)
    except InputError:
        help_ = f"{suggestion(name)} 'mascarin materials' lists them.".strip()
        raise problem(f"product: {name}", "a product of the library", help_) from None


def _noted(raw: Any, one: Product) -> Any:
    """Give each number its source."""
    if isinstance(raw, list):
        return [_noted(item, one) for item in raw]
    notes = dict(raw) if isinstance(raw, Mapping) else {"value": raw}
    return {"source": one.source} | notes


def _law(given: Any, one: Product) -> Any:
    """The law: as given, by the word for a curve, or the product's own; None where it has none."""
    if given is None:
        return _own_law(one)
    if not isinstance(given, str):
        return given
    curve = getattr(one, given) if given in DIRECTIONS else None
    if curve is None:
        known = [name for name in DIRECTIONS if getattr(one, name) is not None]
        raise problem(
            f"law: {given}",
            f"law: {' or '.join(known) or '{kind: ...}'}, the curves known of {one.name}, or {{kind: ...}}",
            "Choose a curve, or write a law.",
        )
    return _table(one, curve)


def _own_law(one: Product) -> Any:
    if one.heating is not None:
        return _table(one, one.heating)
    if "law" not in one.raw:
        return None
    numbers = {key: _noted(value, one) for key, value in one.raw["law"].items() if key != "kind"}
    return {"kind": one.raw["law"]["kind"]} | numbers


def _table(one: Product, curve: Curve) -> dict[str, Any]:
    enthalpies = one.enthalpies(curve.temperatures, curve.liquid_fraction)
    return {
        "kind": "table",
        "temperatures": _noted(list(curve.temperatures), one),
        "enthalpies": _noted(list(enthalpies), one),
    }


def _by_melting_temperature(law: Any) -> bool:
    """Whether latent heat and melting temperature stand beside the law, not in it."""
    kind = law.get("kind") if isinstance(law, Mapping) else getattr(law, "kind", None)
    return kind != "table"


def _melting(one: Product) -> dict[str, Any]:
    known = {"latent_heat": one.number("latent_heat"), "melting_temperature": one.melting_temperature}
    written = {key: _noted(one.raw.get(key, value), one) for key, value in known.items() if value is not None}
    if "melting_temperature" not in one.raw and "melting_temperature" in written:
        written["melting_temperature"]["source"] = f"half of the heating curve; {one.source}"
    return written
