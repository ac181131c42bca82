"""Numbers of a description as parameters: ties, sources, numbers without effect."""
