"""What a run of a building can give, by name."""
