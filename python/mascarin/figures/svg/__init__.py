"""Drawings of pages as SVG: charts, axes, buildings, carpets."""
