"""Descriptions as YAML."""
