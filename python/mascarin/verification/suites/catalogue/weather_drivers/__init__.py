"""Irradiance of ten planes in six climates, of Standard 140."""
