"""Zones, their gains, air and plants."""
