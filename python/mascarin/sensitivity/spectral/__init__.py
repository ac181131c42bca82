"""The spectral method: a Fourier amplitude sensitivity test with random phases (see `analysis`)."""

from __future__ import annotations

from mascarin.sensitivity.spectral.analysis import SpectralCollector, analyze
from mascarin.sensitivity.spectral.designs import Design, design
from mascarin.sensitivity.spectral.result import SpectralSensitivity

__all__ = ["Design", "SpectralCollector", "SpectralSensitivity", "analyze", "design"]


def __dir__() -> list[str]:
    return __all__
