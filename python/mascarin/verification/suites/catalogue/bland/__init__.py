"""Conduction through one layer after a step of the outdoor air, solved analytically by Bland."""
