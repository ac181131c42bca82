"""Materials taken from the library of products: ``ceiling_pcm: {product: RT25HC}``.

The short form is expanded before anything is checked, each number with the source of the product. What the
user gives as well replaces what the product has; a property that neither gives is an error.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from mascarin.building.base.number import Number, problem, shown
from mascarin.errors import InputError
from mascarin.materials.library import DIRECTIONS, PROPERTIES, Curve, Product, product, suggestion

DEFAULT_CURVE: Final = "heating"
"""Curve that a product melts by when the user names none."""


def expand(raw: Any) -> Any:
    """Expand a material that names a product; anything else stays as it is.

    Parameters
    ----------
    raw : mapping or other
        The material as it was given.

    Returns
    -------
    mapping or other
        The same with all properties. Numbers of the product are marked as derived, so that they are derived
        again when the product is replaced.

    Raises
    ------
    PydanticCustomError
        There is no such product, another kind is given, or neither product nor user give a property.
    """
    if not isinstance(raw, Mapping) or raw.get("product") is None:
        return raw
    item = _named(raw["product"])
    if raw.get("kind", "pcm") != "pcm":
        raise problem(
            f"kind: {raw['kind']}", "kind: pcm, or none", f"{item.name} is a phase-change material."
        )
    stated = {key: value for key, value in raw.items() if value is not None}
    expanded: dict[str, Any] = {"kind": "pcm"}
    expanded |= {key: _noted(item.raw[key], item) for key in PROPERTIES if key in item.raw}
    expanded |= {key: _over(expanded.get(key), value) for key, value in stated.items()}
    expanded["product"] = item.name
    _complete(expanded, item)
    if stated.get("hysteresis") is not None:
        return _with_hysteresis(expanded, stated, item)
    law = _law(stated.get("law"), item)
    if law is None:
        raise problem(
            f"no law; {item.name} has no curves",
            "law: how it melts",
            "Add 'law:', such as {kind: tanh, width: 1.0}.",
        )
    expanded["law"] = law
    return _melting(item) | expanded if _by_melting_temperature(law) else expanded


def _with_hysteresis(expanded: dict[str, Any], stated: Mapping[str, Any], item: Product) -> dict[str, Any]:
    """The material with the curves of the product as liquid fractions, which hysteresis needs."""
    law = _heating_fractions(stated.get("law"), item)
    hysteresis = _cooling_fractions(stated["hysteresis"], law, item)
    numbers = _melting(item)
    if _is_fractions(law):
        numbers = {"latent_heat": _with_tolerance(_latent_heat(item, law), item)}
    return numbers | expanded | {"law": law, "hysteresis": hysteresis}


def _heating_fractions(stated: Any, item: Product) -> Any:
    """The heating curve: a law as given, else that of the product."""
    named = (
        stated if isinstance(stated, str) else stated.get("curve") if isinstance(stated, Mapping) else None
    )
    if named is not None and named != DEFAULT_CURVE:
        raise problem(
            f"law: {named} beside hysteresis",
            f"law: {DEFAULT_CURVE}, or none; the cooling curve belongs below hysteresis",
            "Remove 'law:'.",
        )
    is_law = isinstance(stated, Mapping) and "kind" in stated and named is None
    if is_law or not (stated is None or isinstance(stated, str | Mapping)):
        return stated
    more = (
        {key: value for key, value in stated.items() if key != "kind"} if isinstance(stated, Mapping) else {}
    )
    if item.heating is not None:
        return _fractions(item, item.heating, DEFAULT_CURVE) | more
    default = _own_law(item)
    if default is None or named is not None:
        raise problem(
            f"hysteresis; {item.name} has no heating curve",
            "law: how it melts, by its liquid fraction",
            "Add 'law:', such as {kind: tanh, width: 1.0}, and freezing_temperature below hysteresis.",
        )
    return default | more


def _cooling_fractions(stated: Any, law: Any, item: Product) -> Any:
    """What is given of the hysteresis, with the cooling curve of the product where no other is given."""
    if not isinstance(stated, Mapping):
        keys = ("model", "freezing_temperature", "law")
        if not all(hasattr(stated, key) for key in keys):
            return stated
        stated = {key: getattr(stated, key) for key in keys if getattr(stated, key) is not None}
    shape = stated.get("law")
    named = shape if isinstance(shape, str) else shape.get("curve") if isinstance(shape, Mapping) else None
    if named is not None and named != "cooling":
        raise problem(f"hysteresis.law: {named}", "hysteresis.law: cooling, or none", "Remove this 'law:'.")
    partial = isinstance(shape, Mapping) and ("kind" not in shape or named is not None)
    if shape is not None and named is None and not partial:
        return stated
    if shape is None and (stated.get("freezing_temperature") is not None or not _is_fractions(law)):
        return stated  # the shape of the heating curve, about another temperature
    if item.cooling is None:
        raise problem(
            f"hysteresis without a cooling curve; the source of {item.name} does not give it",
            "hysteresis: {model: ..., law: {kind: fractions, ...}}, or another law with freezing_temperature",
            "Add the cooling curve, or choose a product with both curves: 'mascarin materials' shows them.",
        )
    more = {key: value for key, value in shape.items() if key != "kind"} if partial else {}
    return {**stated, "law": _fractions(item, item.cooling, "cooling") | more}


def _is_fractions(law: Any) -> bool:
    kind = law.get("kind") if isinstance(law, Mapping) else getattr(law, "kind", None)
    return kind == "fractions"


def _fractions(item: Product, curve: Curve, name: str) -> dict[str, Any]:
    return {
        "kind": "fractions",
        "curve": name,
        "temperatures": _noted(list(curve.temperatures), item),
        "fractions": _noted(list(curve.liquid_fraction), item),
    }


def _latent_heat(item: Product, law: Any) -> Number:
    """Latent heat in the middle of the heating curve, to which a law of fractions refers.

    That of the product is at its melting temperature; between the two lies a difference of sensible heat.
    """
    latent: Number = _noted(item.raw["latent_heat"], item)
    heats, centre = item.pair("specific_heat"), item.melting_temperature
    points = law.get("temperatures") if isinstance(law, Mapping) else law.temperatures
    if heats is None or centre is None or heats[0] == heats[1] or not points:
        return latent
    middle = 0.5 * (float(points[0]) + float(points[-1]))
    moved = float(latent) + (heats[1] - heats[0]) * (middle - centre)
    note = f"at {middle:g} degC, from {float(latent):g} J/kg at {centre:g} degC; {latent.source}"
    return Number(round(moved, 1), source=note, assumed=latent.assumed, derived=True)


def _over(default: Any, stated: Any) -> Any:
    """A property as given; a mapping of one phase takes the other phase from the product."""
    if default is None or not isinstance(stated, Mapping) or "value" in stated:
        return stated
    solid, liquid = default if isinstance(default, list) else (default, default)
    return {"solid": solid, "liquid": liquid} | dict(stated)


def _complete(expanded: Mapping[str, Any], item: Product) -> None:
    gaps = [key for key in PROPERTIES if key not in expanded]
    if gaps:
        raise problem(
            f"no {' and no '.join(gaps)}; the source of {item.name} does not give it",
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


def _noted(raw: Any, item: Product, source: str | None = None) -> Any:
    """Numbers of a product with their source, marked as derived."""
    if isinstance(raw, list):
        return [_noted(entry, item, source) for entry in raw]
    notes = dict(raw) if isinstance(raw, Mapping) else {"value": raw}
    span = notes.get("range")
    return Number(
        float(notes["value"]),
        range=None if span is None else (float(span[0]), float(span[1])),
        source=notes.get("source", source or item.source),
        assumed=bool(notes.get("assumed", False)),
        derived=True,
    )


def _law(stated: Any, item: Product) -> Any:
    """The law: as given, a curve of the product by its name, or the product's law; None where it has none."""
    if isinstance(stated, str):
        return _table(item, _curve(stated, item), stated)
    if isinstance(stated, Mapping) and "kind" not in stated:
        curve = stated.get("curve")
        default = _own_law(item) if curve is None else _table(item, _curve(curve, item), curve)
        return None if default is None else default | dict(stated)
    if isinstance(stated, Mapping) and stated.get("curve") is not None:
        raise problem(
            "curve beside kind",
            "one of the two: the curve of the product, or a law",
            "Remove 'kind:' or 'curve:'.",
        )
    return _own_law(item) if stated is None else stated


def _curve(name: Any, item: Product) -> Curve:
    curve = getattr(item, name) if name in DIRECTIONS else None
    if curve is None:
        names = [key for key in DIRECTIONS if getattr(item, key) is not None]
        raise problem(
            f"law: {name}",
            f"law: {' or '.join(names) or '{kind: ...}'}, the curves known of {item.name}, or {{kind: ...}}",
            "Choose a curve, or write a law.",
        )
    chosen: Curve = curve
    return chosen


def _own_law(item: Product) -> dict[str, Any] | None:
    if item.heating is not None:
        return _table(item, item.heating, DEFAULT_CURVE)
    if "law" not in item.raw:
        return None
    numbers = {key: _noted(value, item) for key, value in item.raw["law"].items() if key != "kind"}
    return {"kind": item.raw["law"]["kind"]} | numbers


def _table(item: Product, curve: Curve, name: str) -> dict[str, Any]:
    enthalpies = item.enthalpies(curve.temperatures, curve.liquid_fraction)
    return {
        "kind": "table",
        "curve": name,
        "temperatures": _noted(list(curve.temperatures), item),
        "enthalpies": _noted(list(enthalpies), item),
        **_scale(item),
    }


def _scale(item: Product) -> dict[str, Number]:
    """Factor on the curve with the tolerance of the maker; none for a maker that states none."""
    if item.heat_tolerance is None:
        return {}
    half, reason = item.heat_tolerance
    span = (1.0 - half, 1.0 + half)
    return {
        "enthalpy_scale": Number(1.0, range=span, source=f"the curve as measured; {reason}", derived=True)
    }


def _with_tolerance(heat: Number, item: Product) -> Number:
    """A latent heat with the tolerance of the maker as its range, unless the product has one."""
    if item.heat_tolerance is None or heat.range is not None:
        return heat
    half, reason = item.heat_tolerance
    span = (float(heat) * (1.0 - half), float(heat) * (1.0 + half))
    source = f"{heat.source}; {reason}"
    return Number(float(heat), range=span, source=source, assumed=heat.assumed, derived=True)


def _by_melting_temperature(law: Any) -> bool:
    """Whether latent heat and melting temperature are given beside the law, not in it."""
    kind = law.get("kind") if isinstance(law, Mapping) else getattr(law, "kind", None)
    return kind != "table"


def _melting(item: Product) -> dict[str, Any]:
    names = {"latent_heat": item.number("latent_heat"), "melting_temperature": item.melting_temperature}
    half = f"half of the heating curve; {item.source}"
    numbers = {
        key: _noted(item.raw.get(key, value), item, half if key not in item.raw else None)
        for key, value in names.items()
        if value is not None
    }
    if "latent_heat" in numbers:
        numbers["latent_heat"] = _with_tolerance(numbers["latent_heat"], item)
    return numbers
