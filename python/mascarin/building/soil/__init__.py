"""Soil beneath and around a building: finite volumes, reduced once to a ladder of a few cells."""
