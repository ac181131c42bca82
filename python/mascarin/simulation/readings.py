"""What the engine records for each output, and the outputs that are calculated from two records."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Output

    Array = npt.NDArray[np.float64]

#: Outputs that are calculated from the air and the mean radiant temperature.
_DERIVED: Final = ("operative_temperature", "globe_temperature")
_PARTS: Final = ("air_temperature", "mean_radiant_temperature")


@dataclass(frozen=True)
class Readings:
    """What the engine records, and how each output follows from the records.

    Attributes
    ----------
    probes : str
        What the engine records, as JSON.
    recipes : tuple of (str, tuple of int)
        Kind of each output and the columns of the records that it is calculated from.
    """

    probes: str
    recipes: tuple[tuple[str, tuple[int, ...]], ...]

    @classmethod
    def of(cls, outputs: Sequence[Output]) -> Readings:
        """Find what to record for some outputs."""
        probes: list[dict[str, Any]] = []

        def column(kind: str, place: Mapping[str, int]) -> int:
            probe = {"kind": kind, **place}
            if probe not in probes:
                probes.append(probe)
            return probes.index(probe)

        recipes: list[tuple[str, tuple[int, ...]]] = []
        for output in outputs:
            kinds = _PARTS if output.kind in _DERIVED else (output.kind,)
            recipes.append((output.kind, tuple(column(kind, output.place) for kind in kinds)))
        return cls(json.dumps(probes), tuple(recipes))

    def values(self, records: Array) -> Array:
        """Outputs from records, along the last axis."""
        columns = [column for _, (column, *_) in self.recipes]
        plain = all(kind not in _DERIVED for kind, _ in self.recipes)
        if plain and columns == list(range(records.shape[-1])):
            return records
        found = [_reading(kind, [records[..., c] for c in places]) for kind, places in self.recipes]
        return np.stack(found, axis=-1)

    def slopes(self, records: Array, slopes: Array) -> Array:
        """Derivatives of outputs from those of records, along the last axis, by the chain rule."""
        columns = []
        for kind, places in self.recipes:
            parts = [records[..., c] for c in places]
            terms = (_by_part(kind, parts, k) * slopes[..., c] for k, c in enumerate(places))
            columns.append(sum(terms, np.zeros(slopes.shape[:-1])))
        return np.stack(columns, axis=-1)

    def weights(self, records: Array, weights: Array) -> Array:
        """Weights on records from weights on outputs: the transpose of `slopes`.

        Parameters
        ----------
        records : ndarray, shape (rows, probes)
            What the engine recorded.
        weights : ndarray, shape (rows, outputs)
            Derivative of a quantity by each output.

        Returns
        -------
        ndarray, shape (rows, probes)
            Derivative of the quantity by each record.
        """
        found = np.zeros_like(records)
        for k, (kind, places) in enumerate(self.recipes):
            parts = [records[:, c] for c in places]
            for i, c in enumerate(places):
                found[:, c] += weights[:, k] * _by_part(kind, parts, i)
        return found


def globe_temperature(air: Array, radiant: Array, diameter: float = 0.15, emissivity: float = 0.95) -> Array:
    """Temperature of a black globe in still air.

    Balances radiation with natural convection, ``1.4 (|dT|/D)^0.25`` (ISO 7726:1998, annex B).

    Parameters
    ----------
    air, radiant : ndarray
        Air and mean radiant temperature. [degC]
    diameter : float
        Diameter of the globe. [m]
    emissivity : float
        Long-wave emissivity of the globe. [-]

    Returns
    -------
    ndarray
        Globe temperature. [degC]

    Examples
    --------
    >>> globe_temperature(np.array([20.0]), np.array([30.0])).round(1)
    array([26.2])
    """
    sigma, kelvin = 5.670374419e-8, 273.15
    globe = 0.5 * (air + radiant)
    for _ in range(20):
        convection = 1.4 * (np.maximum(np.abs(globe - air), 1e-3) / diameter) ** 0.25
        mean = 0.5 * (globe + radiant) + kelvin
        radiation = 4.0 * emissivity * sigma * mean**3
        globe = 0.5 * globe + 0.5 * (convection * air + radiation * radiant) / (convection + radiation)
    return np.asarray(globe)


def _by_part(kind: str, parts: Sequence[Array], k: int) -> Array | float:
    """Derivative of an output by one of the records that it is calculated from. [-]"""
    if kind not in _DERIVED:
        return 1.0
    # Small, because the coefficient at a globe changes fast where globe and air are equally warm.
    nudge = 1e-6
    up, down = ([p + sign * nudge * (j == k) for j, p in enumerate(parts)] for sign in (1.0, -1.0))
    return (_reading(kind, up) - _reading(kind, down)) / (2.0 * nudge)


def _reading(kind: str, parts: Sequence[Array]) -> Array:
    if kind == "operative_temperature":
        return 0.5 * (parts[0] + parts[1])
    if kind == "globe_temperature":
        return globe_temperature(parts[0], parts[1])
    return parts[0]
