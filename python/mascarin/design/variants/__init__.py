"""Designs: variables, inputs, runs, ranking and results."""
