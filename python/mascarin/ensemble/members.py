"""The members of an ensemble: what varies between them, checked before anything runs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.building.base.part import cached_on
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Members:
    """Samples by column.

    Attributes
    ----------
    numbers : mapping of str to ndarray, each of shape (M,)
        Parameters that change only numbers: these members are run together in lanes. [unit of each]
    structures : mapping of str to list, each of length M
        What needs another compiled building: structural parameters, and whole parts of the description.
        Members of the same structure are run together.
    """

    numbers: Mapping[str, Array]
    structures: Mapping[str, list[Any]]

    @property
    def count(self) -> int:
        """Number of members."""
        columns: list[Any] = [*self.numbers.values(), *self.structures.values()]
        return len(columns[0])

    @property
    def paths(self) -> list[str]:
        """Paths of all columns."""
        return [*self.numbers, *self.structures]

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each numeric column: the mesh is fine enough for both."""
        return {path: (float(v.min()), float(v.max())) for path, v in self.numbers.items()}

    def part(self, first: int, last: int) -> Members:
        """Members from `first` to before `last`."""
        return Members(
            {path: values[first:last] for path, values in self.numbers.items()},
            {path: values[first:last] for path, values in self.structures.items()},
        )

    def groups(self) -> list[tuple[dict[str, Any], list[int]]]:
        """Members by structure: what is replaced, and the rows of the members that have it in common."""
        by_structure: dict[str, tuple[dict[str, Any], list[int]]] = {}
        for member in range(self.count):
            structure = {path: values[member] for path, values in self.structures.items()}
            by_structure.setdefault(json.dumps(structure, sort_keys=True), (structure, []))[1].append(member)
        return list(by_structure.values())

    def taken(self, order: Sequence[int]) -> Members:
        """Some members, in another order."""
        return Members(
            {path: values[order] for path, values in self.numbers.items()},
            {path: [values[member] for member in order] for path, values in self.structures.items()},
        )

    def by_structure(self) -> list[int]:
        """Members in the order in which those of one structure stand side by side."""
        if not self.structures:
            return list(range(self.count))
        return [member for _, rows in self.groups() for member in rows]

    def digest(self) -> str:
        """Hash of all samples."""
        digest = hashlib.sha256()
        for path, values in self.numbers.items():
            digest.update(path.encode())
            digest.update(np.ascontiguousarray(values).tobytes())
        digest.update(json.dumps(dict(self.structures), sort_keys=True).encode())
        return digest.hexdigest()


#: Numbers of the buildings of other structures that are kept between check and run: some 50 MB of them.
_MOST_NUMBERS: Final = 100_000


def keep_variant(building: Building, structure: Mapping[str, Any]) -> None:
    """Check a structure; the building is kept for its run, unless there are many.

    Parameters
    ----------
    building : Building
        The building that varies.
    structure : mapping of str to any
        What is replaced, by path.

    Raises
    ------
    InputError
        It cannot be replaced so.
    """
    variants = _variants(building)
    changed = building.replace(structure)
    if (len(variants) + 1) * len(building.parameters()) <= _MOST_NUMBERS:
        variants[json.dumps(structure, sort_keys=True)] = changed


def variant(building: Building, structure: Mapping[str, Any]) -> Building:
    """The building with a structure, as its check has left it; it is not kept any longer.

    Parameters
    ----------
    building : Building
        The building that varies.
    structure : mapping of str to any
        What is replaced, by path.
    """
    cached = _variants(building).pop(json.dumps(structure, sort_keys=True), None)
    return building.replace(structure) if cached is None else cached


def _variants(building: Building) -> dict[str, Building]:
    return cached_on(building, "_variants", dict[str, "Building"])


def members(building: Building, samples: Mapping[str, Any] | pd.DataFrame) -> Members:
    """Read samples by column.

    Parameters
    ----------
    building : Building
        The building that varies.
    samples : Mapping or pandas.DataFrame
        Values by path, one for each member. Values of a structural parameter may be numbers or whatever the
        description takes there; the path of a whole part takes what the YAML file would hold.
        [unit of each]

    Raises
    ------
    InputError
        No column, columns of different lengths, an unknown path, a value that the parameter cannot have.
    """
    numbers: dict[str, Array] = {}
    structures: dict[str, list[Any]] = {}
    for key, column in samples.items():
        path, values = str(key), np.asarray(column)
        if values.ndim != 1 or not len(values):
            raise InputError(f"samples: {path} has shape {values.shape}; expected one value for each member")
        if _is_number(building, path, values):
            numbers[building.parameter(path).path] = _numbers(building, path, values)
        else:
            # As given: an array of mixed values would turn the numbers into text.
            values_list = values.tolist() if values.dtype.kind in "fiub" else list(column)
            structures[path] = [_native(building, path, value) for value in values_list]
    _same_length({**numbers, **structures})
    members_read = Members(numbers, structures)
    for structure, rows in members_read.groups() if structures else []:
        try:
            keep_variant(building, structure)
        except InputError as error:
            raise InputError(f"samples: member {rows[0]}: {error}") from None
    return members_read


def _is_number(building: Building, path: str, values: npt.NDArray[Any]) -> bool:
    """Whether a column changes only numbers and needs no other compiled building."""
    if values.dtype.kind not in "fiu":
        return False
    return not building.parameter(path).structural


def _native(building: Building, path: str, value: Any) -> Any:
    """A whole number stays one where the description holds one: a number of nodes, read from a table."""
    if isinstance(value, float) and value.is_integer() and not building.parameter(path).value % 1:
        return int(value)
    return value


def _numbers(building: Building, path: str, values: npt.NDArray[Any]) -> Array:
    column: Array = values.astype(np.float64)
    parameter = building.parameter(path)
    bad = np.flatnonzero(~((column >= parameter.lower) & (column <= parameter.upper)))
    if bad.size:
        raise InputError(
            f"samples: {path} of member {bad[0]} is {column[bad[0]]:g} {parameter.unit}; expected "
            f"{parameter.allowed}"
        )
    return column


def _same_length(columns: Mapping[str, Any]) -> None:
    if not columns:
        raise InputError("samples: no columns; give values by parameter path")
    lengths = {path: len(values) for path, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise InputError(f"samples: found {lengths} values; expected the same number for every path")
