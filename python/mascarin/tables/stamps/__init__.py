"""Stamps of tables: which columns hold them, and how they are written."""
