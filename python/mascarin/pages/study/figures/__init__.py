"""Figures of the page of a study."""
