"""Regular time series from files: reading, grid of times, time zones, steps, gaps, quality, cache."""
