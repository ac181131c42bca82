"""The parts of a description, the description, and what follows from it."""
