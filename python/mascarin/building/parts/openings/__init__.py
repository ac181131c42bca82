"""Windows: glazing, frames, shades and blinds."""
