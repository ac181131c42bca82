"""EN ISO 13791: components, and rooms of two shapes in summer."""
