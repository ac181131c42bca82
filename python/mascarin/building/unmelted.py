"""Phase-change layers that neither melted nor froze in a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.material import PhaseChangeMaterial

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.outputs import Output

#: Least change of the liquid fraction that counts as melting or freezing [-].
NOTHING: Final = 0.01


def watched(building: Building) -> list[Output]:
    """Temperature and liquid fraction of every phase-change layer, in pairs."""
    outputs = {output.name: output for output in building.outputs()}
    return [
        outputs[f"{name}.{layer}_{word}"]
        for name, layer, _ in _layers(building)
        for word in ("temperature", "liquid_fraction")
    ]


def warnings(building: Building, records: npt.NDArray[np.float64]) -> list[str]:
    """Warnings about layers that neither melted nor froze.

    Parameters
    ----------
    building : Building
        The building.
    records : ndarray, shape (rows, watched outputs)
        Their values over the run. [degC, -]
    """
    lines = []
    pairs: Sequence[npt.NDArray[np.float64]] = np.split(records, max(records.shape[1] // 2, 1), axis=1)
    for (name, layer, material), pair in zip(_layers(building), pairs, strict=False):
        temperature, fraction = pair.T
        if np.ptp(fraction) >= NOTHING:
            continue
        low, high = material.melting
        state = "solid" if fraction[0] < 0.5 else "liquid"
        freezes = ""
        if material.cooling is not None:
            law, centre = material.cooling
            freezes = f" and freezes from {centre + law.reach[1]:.2f} to {centre + law.reach[0]:.2f} degC"
        lines.append(
            f"surfaces.{name}, layer {layer}: stayed {state}, {temperature.min():.2f} to "
            f"{temperature.max():.2f} degC on the mean; it melts from {low:.2f} to {high:.2f} degC{freezes}: "
            "its latent heat has no effect in this run"
        )
    return lines


def _layers(building: Building) -> Iterator[tuple[str, str, PhaseChangeMaterial]]:
    """Surface, layer and material of every phase-change layer."""
    for name, surface in building.surfaces.items():
        for layer in building.constructions[surface.construction].layers:
            material = building.materials[layer.material]
            if isinstance(material, PhaseChangeMaterial):
                yield name, layer.name, material
