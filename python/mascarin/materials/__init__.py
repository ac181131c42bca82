"""What real phase-change products are made of; in `dsc`, what a calorimeter says about one's own."""

from __future__ import annotations

from mascarin.materials.library import Curve, Product, product, products, search

__all__ = ["Curve", "Product", "product", "products", "search"]
