"""Comparison of simulations with measurements: metrics, criteria, residual analysis, reference cases."""
