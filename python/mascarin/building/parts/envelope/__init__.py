"""Surfaces with their layers, convection and thermal bridges."""
