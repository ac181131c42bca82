"""Phase-change products with their properties, and materials from calorimeter files (`from_dsc`)."""

from __future__ import annotations

from mascarin.materials.dsc import DscMaterial, from_dsc
from mascarin.materials.library import Curve, Product, product, products, search

__all__ = ["Curve", "DscMaterial", "Product", "from_dsc", "product", "products", "search"]


def __dir__() -> list[str]:
    return __all__
