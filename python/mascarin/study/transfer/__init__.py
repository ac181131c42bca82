"""The calibrated building in other houses, seasons and phases."""
