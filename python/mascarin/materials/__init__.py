"""Phase-change products with their properties, and materials from calorimeter files (`from_dsc`)."""

from __future__ import annotations

from mascarin.materials.dsc import DscMaterial, from_dsc
from mascarin.materials.dsc_several import from_dsc_files
from mascarin.materials.library import Curve, Product, product, products, search

__all__ = ["Curve", "DscMaterial", "Product", "from_dsc", "from_dsc_files", "product", "products", "search"]


def __dir__() -> list[str]:
    return __all__
