"""What the engine records for the outputs of a run: each quantity once."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Output

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Readings:
    """What the engine records, and the record of each output.

    Attributes
    ----------
    outputs : str
        What the engine records, as JSON.
    columns : tuple of int
        For each output of the run, the position of its record.
    """

    outputs: str
    columns: tuple[int, ...]

    @classmethod
    def of(cls, outputs: Sequence[Output]) -> Readings:
        """Find what to record for some outputs, of which some may be the same."""
        recorded: list[dict[str, Any]] = []
        columns = []
        for output in outputs:
            quantity = {"kind": output.kind, **output.place}
            if quantity not in recorded:
                recorded.append(quantity)
            columns.append(recorded.index(quantity))
        return cls(json.dumps(recorded), tuple(columns))

    def values(self, records: Array) -> Array:
        """Outputs from records, or their derivatives from those of records, along the last axis."""
        if self.columns == tuple(range(records.shape[-1])):
            return records
        return records[..., list(self.columns)]

    def weights(self, records: Array, weights: Array) -> Array:
        """Weights on records from weights on outputs: the transpose of `values`.

        Parameters
        ----------
        records : ndarray, shape (rows, records)
            What the engine recorded.
        weights : ndarray, shape (rows, outputs)
            Derivative of a quantity by each output.

        Returns
        -------
        ndarray, shape (rows, records)
            Derivative of the quantity by each record.
        """
        of_records = np.zeros_like(records)
        for k, column in enumerate(self.columns):
            of_records[:, column] += weights[:, k]
        return of_records
