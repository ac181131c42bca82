"""Measured energy of the heater of the test cells ETNA."""
