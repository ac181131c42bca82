"""Samplers of distributions, and whether their chains have converged. They know nothing of buildings."""
