"""The page of compared designs."""
