"""Slabs on the ground of the IEA, by ISO 13370."""
