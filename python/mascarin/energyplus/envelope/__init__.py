"""Surfaces, materials, windows and what shades them."""
