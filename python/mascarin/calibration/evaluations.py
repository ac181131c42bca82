"""The record of a calibration: every evaluation, written to a file as it is made, so that none is run twice.

A record is a text file of JSON lines. The first line identifies the problem; each further line
holds one evaluation: the parameter values, the cost of each sensor and, where the method needs them, the
residuals; or the exact derivatives at parameter values, where they were computed. A line that is incomplete
because the program was killed is removed, and the file is continued from there.
"""

from __future__ import annotations

import base64
import json
from array import array
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from mascarin._io import own_files
from mascarin.calibration.cost import Cost
from mascarin.errors import InputError

Floats = NDArray[np.float64]

_FORMAT = 1


@dataclass(frozen=True, eq=False)
class Trace:
    """All evaluations in the order in which they were made.

    Attributes
    ----------
    x : ndarray, shape (n, P)
        Parameter values. [unit of each parameter]
    cost : ndarray, shape (n,)
        Total cost; infinite where the model could not be simulated.
    of_sensors : ndarray, shape (n, S)
        Cost of each sensor.
    replayed : int
        How many of them came from the record. [-]

    Examples
    --------
    >>> trace = Trace(np.array([[1.0], [2.0]]), np.array([3.0, 2.0]), np.array([[3.0], [2.0]]), 0)
    >>> trace.x[trace.cost.argmin()]
    array([2.])
    """

    x: Floats
    cost: Floats
    of_sensors: Floats
    replayed: int


class Evaluator:
    """Evaluates parameter vectors in batches, each only once, and keeps the record.

    Parameters
    ----------
    cost : Cost
        The cost, with its problem.
    path : Path, optional
        File of the record; continued when it exists. Without it nothing is written.
    keep_residuals : bool
        Whether residuals are kept and recorded too; least squares needs them. `costs` never keeps them.
    batch : int
        Largest number of parameter vectors in one call of the model. [-]
    on_batch : callable, optional
        Called after each batch with the number of evaluations and the lowest cost so far.

    Raises
    ------
    InputError
        When the record belongs to another problem.

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 0.0, 10.0),),
    ...     (FitSensor("room", np.array([4.0, 6.0]), 0.1),),
    ...     lambda x: np.tile(x[:, :, None], (1, 2, 1)),
    ... )
    >>> with Evaluator(Cost(problem, "rmse")) as evaluator:
    ...     evaluator.costs(np.array([[5.0], [5.0], [6.0]])).round(3)
    ...     evaluator.count
    array([1.   , 1.   , 1.414])
    2
    """

    def __init__(
        self,
        cost: Cost,
        path: Path | None = None,
        *,
        keep_residuals: bool = False,
        batch: int = 64,
        on_batch: Callable[[int, float], object] | None = None,
    ) -> None:
        self.cost = cost
        self._path = path
        self._keep = keep_residuals
        self._batch = batch
        self._on_batch = on_batch
        self._rows: dict[bytes, int] = {}
        # Flat, because a multi-start search makes a million evaluations.
        self._x = array("d")
        self._of_sensors = array("d")
        self._residuals: dict[int, Floats] = {}
        self._slopes: dict[bytes, Floats] = {}
        self._lowest = np.inf
        if path is not None:
            self._open(path)
        self.replayed = self.count

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file of the record."""
        if self._path is not None:
            self._file.close()

    @property
    def count(self) -> int:
        """Number of different parameter vectors evaluated, those from the record included. [-]"""
        return len(self._rows)

    def costs(self, x: Floats) -> Floats:
        """Compute total costs of parameter vectors (M, P), shape (M,)."""
        return self.cost.total(x, self.of_sensors(x))

    def prepare(self, x: Floats) -> None:
        """Evaluate parameter vectors (M, P), with residuals where they are kept."""
        self._evaluated(x, keep=self._keep)

    def of_sensors(self, x: Floats) -> Floats:
        """Compute the cost of each sensor at parameter vectors (M, P), shape (M, S)."""
        n = len(self.cost.problem.sensors)
        rows = self._evaluated(x, keep=False)
        return np.array([self._of_sensors[k * n : (k + 1) * n] for k in rows])

    def residuals(self, x: Floats) -> Floats:
        """Compute residuals at parameter vectors (M, P), shape (M, T, S); NaN where a run failed. [unit]"""
        if not self._keep:
            return self.cost.problem.residuals(x)
        return np.stack([self._residuals[k] for k in self._evaluated(x, keep=True)])

    def slopes(self, x: Floats) -> Floats:
        """Compute exact derivatives of the residuals, once for each parameter vector.

        Parameters
        ----------
        x : ndarray, shape (P,)
            Values of the parameters. [unit of each]

        Returns
        -------
        ndarray, shape (T, S, P)
            Derivatives. [unit of the sensor / unit of the parameter]
        """
        key = np.ascontiguousarray(x, dtype=np.float64).tobytes()
        if key not in self._slopes:
            self._slopes[key] = self.cost.problem.jacobian(x)
            if self._path is not None:
                entry = {"x": x.tolist(), "j": _packed(self._slopes[key])}
                self._file.write((json.dumps(entry, allow_nan=False) + "\n").encode())
                self._file.flush()
        return self._slopes[key]

    def trace(self) -> Trace:
        """Return all evaluations so far."""
        problem = self.cost.problem
        x = np.array(self._x, dtype=np.float64).reshape(-1, len(problem.parameters))
        of_sensors = np.array(self._of_sensors, dtype=np.float64).reshape(-1, len(problem.sensors))
        return Trace(x, self.cost.total(x, of_sensors), of_sensors, self.replayed)

    def _evaluated(self, x: Floats, *, keep: bool) -> list[int]:
        """Row of each parameter vector; evaluates the new ones, and those whose residuals are missing."""
        keys = [row.tobytes() for row in np.ascontiguousarray(x, dtype=np.float64)]
        new = list(dict.fromkeys(k for k in keys if self._lacks(k, keep)))
        members = np.array([np.frombuffer(k) for k in new]).reshape(len(new), x.shape[1])
        for first in range(0, len(new), self._batch):
            self._run(members[first : first + self._batch], keep)
        return [self._rows[k] for k in keys]

    def _lacks(self, key: bytes, keep: bool) -> bool:
        return key not in self._rows or (keep and self._rows[key] not in self._residuals)

    def _run(self, x: Floats, keep: bool) -> None:
        residuals = self.cost.problem.residuals(x)
        of_sensors = self.cost.of_sensors(residuals)
        lines = []
        for k in range(x.shape[0]):
            stored_residuals = residuals[k] if keep else None
            self._remember(x[k], of_sensors[k], stored_residuals)
            if self._path is not None:
                lines.append(self._line(x[k], of_sensors[k], stored_residuals))
        if self._path is not None:
            # One write per batch; it is complete even if the program is killed right after it.
            self._file.write("".join(lines).encode())
            self._file.flush()
        if self._on_batch is not None:
            self._on_batch(self.count, float(self._lowest))

    def _remember(self, x: Floats, of_sensors: Floats, residuals: Floats | None) -> None:
        key = x.tobytes()
        if key not in self._rows:
            self._rows[key] = len(self._rows)
            self._x.extend(x.tolist())
            self._of_sensors.extend(of_sensors.tolist())
            self._lowest = min(self._lowest, float(self.cost.total(x[None], of_sensors[None])[0]))
        if residuals is not None:
            self._residuals[self._rows[key]] = residuals

    def _header(self) -> dict[str, Any]:
        problem = self.cost.problem
        return {
            "mascarin_record": _FORMAT,
            "problem": problem.fingerprint(),
            "cost": self.cost.name,
            "weights": [s.weight for s in problem.sensors],
            "residuals": self._keep,
            "parameters": list(problem.paths),
            "sensors": [s.name for s in problem.sensors],
        }

    def _line(self, x: Floats, of_sensors: Floats, residuals: Floats | None) -> str:
        # repr of a float is its shortest text that reads back to the same bits; NaN is written as null.
        entry: dict[str, Any] = {
            "x": x.tolist(),
            "c": [c if np.isfinite(c) else None for c in of_sensors.tolist()],
        }
        if residuals is not None:
            entry["r"] = _packed(residuals)
        return json.dumps(entry, allow_nan=False) + "\n"

    def _open(self, path: Path) -> None:
        """Read the record, remove an incomplete last line, and open the file to append."""
        complete_bytes = 0
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise InputError(
                f"{path}: found no regular file, expected a record or nothing; name another file"
            )
        if path.exists():
            complete_bytes = self._read(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("r+b" if path.exists() else "w+b")
        self._file.truncate(complete_bytes)
        self._file.seek(complete_bytes)
        if complete_bytes == 0:
            self._file.write((json.dumps(self._header()) + "\n").encode())
            self._file.flush()

    def _read(self, path: Path) -> int:
        """Read complete lines and return their number of bytes."""
        complete_bytes = 0
        with path.open("rb") as file:
            for number, line in enumerate(file, start=1):
                if not line.endswith(b"\n"):
                    break
                entry = _parsed(path, number, line)
                if number == 1:
                    self._check_header(path, entry)
                else:
                    self._take(path, number, entry)
                complete_bytes += len(line)
        return complete_bytes

    def _check_header(self, path: Path, header: dict[str, Any]) -> None:
        expected = self._header()
        if header.get("mascarin_record") != _FORMAT:
            raise InputError(
                f"{path}: the first line is not that of a record of a calibration; name another file"
            )
        differing = [key for key in expected if header.get(key) != expected[key]]
        if differing:
            msg = (
                f"{path}: this record belongs to another calibration (differing: {', '.join(differing)}); "
                f"name another file, or remove this one to start again"
            )
            raise InputError(msg)

    def _take(self, path: Path, number: int, entry: dict[str, Any]) -> None:
        problem = self.cost.problem
        if "j" in entry:
            self._take_slopes(path, number, entry)
            return
        try:
            x = np.array(entry["x"], dtype=np.float64)
            costs = np.array([np.nan if c is None else c for c in entry["c"]], dtype=np.float64)
            residuals = None
            if "r" in entry:
                residuals = _unpacked(entry["r"], problem.measured.shape)
            fits = x.shape == (len(problem.parameters),) and costs.shape == (len(problem.sensors),)
        except (KeyError, TypeError, ValueError, OverflowError):
            fits = False
        if not fits:
            msg = f"{path}:{number}: not an evaluation of this problem; remove the line or name another file"
            raise InputError(msg)
        self._remember(x, costs, residuals)

    def _take_slopes(self, path: Path, number: int, entry: dict[str, Any]) -> None:
        shape = self.cost.problem.measured.shape
        try:
            x = np.array(entry["x"], dtype=np.float64)
            self._slopes[x.tobytes()] = _unpacked(entry["j"], (*shape, len(self.cost.problem.parameters)))
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            msg = f"{path}:{number}: not slopes of this problem; remove the line or name another file"
            raise InputError(msg) from error


def _packed(values: Floats) -> str:
    """Bits as text, little-endian on every machine."""
    return base64.b64encode(values.astype("<f8").tobytes()).decode("ascii")


def _unpacked(text: str, shape: tuple[int, ...]) -> Floats:
    return np.frombuffer(base64.b64decode(text, validate=True), dtype="<f8").reshape(shape).astype(float)


def _parsed(path: Path, number: int, line: bytes) -> dict[str, Any]:
    try:
        entry = own_files.json_of(line)
    except own_files.DamagedError as error:
        msg = f"{path}:{number}: not a line of JSON ({error}); remove the line or name another file"
        raise InputError(msg) from error
    if not isinstance(entry, dict):
        msg = f"{path}:{number}: expected a JSON object"
        raise InputError(msg)
    return entry
