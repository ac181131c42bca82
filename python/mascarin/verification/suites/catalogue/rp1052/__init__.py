"""Analytical tests of the fabric of a building, ASHRAE project 1052-RP."""
