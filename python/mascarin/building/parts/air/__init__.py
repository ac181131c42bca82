"""Zones and their air: gains, ventilation, humidity, set points, schedules."""
