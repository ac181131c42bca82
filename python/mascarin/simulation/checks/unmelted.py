"""Phase-change layers that neither melted nor froze in a run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.parts.materials.material import PhaseChangeMaterial

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.outputs.output import Output

#: Least change of the liquid fraction that counts as melting or freezing [-].
NOTHING: Final = 0.01


def watched(building: Building) -> list[Output]:
    """Temperature and liquid fraction of every phase-change layer, in pairs."""
    outputs = {output.name: output for output in building.outputs()}
    return [
        outputs[f"{name}.{layer}_{word}"]
        for name, layer, _ in layers(building)
        for word in ("temperature", "liquid_fraction")
    ]


class Extremes:
    """Extremes of what is watched over a run, from its records in blocks.

    Parameters
    ----------
    building : Building
        The building.
    """

    def __init__(self, building: Building) -> None:
        self._layers = list(layers(building))
        self._first: npt.NDArray[np.float64] | None = None
        self._low = self._high = np.empty(0)

    def add(self, records: npt.NDArray[np.float64]) -> None:
        """Add the next records, shape (rows, watched outputs). [degC, -]"""
        if not self._layers or not len(records):
            return
        low, high = records.min(axis=0), records.max(axis=0)
        if self._first is None:
            self._first, self._low, self._high = records[0].copy(), low, high
        else:
            self._low, self._high = np.minimum(self._low, low), np.maximum(self._high, high)

    def warnings(self) -> list[str]:
        """Warnings about layers that neither melted nor froze."""
        lines: list[str] = []
        if self._first is None:
            return lines
        for k, (name, layer, material) in enumerate(self._layers):
            temperature, fraction = 2 * k, 2 * k + 1
            if self._high[fraction] - self._low[fraction] >= NOTHING:
                continue
            low, high = material.melting
            state = "solid" if self._first[fraction] < 0.5 else "liquid"
            freezes = ""
            if material.cooling is not None:
                law, centre = material.cooling
                freezes = f" and freezes from {centre + law.reach[1]:.2f} to {centre + law.reach[0]:.2f} degC"
            lines.append(
                f"surfaces.{name}, layer {layer}: stayed {state}, {self._low[temperature]:.2f} to "
                f"{self._high[temperature]:.2f} degC on the mean; it melts from {low:.2f} to {high:.2f} "
                f"degC{freezes}: its latent heat has no effect in this run"
            )
        return lines


def layers(building: Building) -> Iterator[tuple[str, str, PhaseChangeMaterial]]:
    """Surface, layer and material of every phase-change layer.

    Parameters
    ----------
    building : Building
        The building.
    """
    for name, surface in building.surfaces.items():
        for layer in building.constructions[surface.construction].layers:
            material = building.materials[layer.material]
            if isinstance(material, PhaseChangeMaterial):
                yield name, layer.name, material
