"""The record of a calibration: every evaluation, written to a file as it is made, so that none is run twice.

A record is a text file of JSON lines. The first line identifies the problem; each further line
holds one evaluation: the parameter values, the cost of each sensor and, where the method needs them, the
residuals; or the exact derivatives at parameter values, where they were computed. Each line is sealed
(`_io.own_records`). A line that is incomplete because the program was killed is removed, and the file is
continued from there; what a damaged line held is computed again, with a warning.
"""

from __future__ import annotations

import base64
import warnings
from array import array
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from mascarin import __version__
from mascarin._io import atomic
from mascarin._io.sealed import own_files, own_records
from mascarin.calibration.base.cost import Cost
from mascarin.errors import InputError

Floats = NDArray[np.float64]

_KIND = f"record of a calibration of version {__version__}"
_FORMAT = 2
#: Beginning of the first line, in every format.
_BEGIN = b'{"mascarin_record":'


class ForeignRecordError(InputError):
    """A file that is no record, or that of another calibration: it is not overwritten."""


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
    ForeignRecordError
        When the record belongs to another problem, or the file is no record, such as a link.

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
                self._file.write(own_records.sealed(self._head, entry).encode())
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
        return own_records.sealed(self._head, entry)

    def _open(self, path: Path) -> None:
        """Read the record, without what is damaged or incomplete, and open the file to append."""
        if path.is_symlink() or (path.exists() and not path.is_file()):
            raise ForeignRecordError(
                f"{path}: found no regular file, expected a record or nothing; name another file"
            )
        lines = self._read(path) if path.exists() else []
        path.parent.mkdir(parents=True, exist_ok=True)
        if lines:
            self._head = own_records.seal_of(lines[0].decode())
        else:
            first = own_records.sealed(_KIND, self._header())
            self._head, lines = own_records.seal_of(first), [first.encode()]
        content = b"".join(lines)
        if not path.exists() or path.read_bytes() != content:
            atomic.write(path, content)
        self._file = path.open("ab")

    def _read(self, path: Path) -> list[bytes]:
        """The sound lines of a record; nothing where all of it is to be computed again."""
        start = own_records.first_line(path)
        try:
            entry = own_records.opened(_KIND, start)
        except own_files.DamagedError:
            begin = path.read_bytes()[: len(_BEGIN)]
            if not _BEGIN.startswith(begin):
                raise ForeignRecordError(
                    f"{path}: the first line is not that of a record of a calibration; name another file"
                ) from None
            if start:  # otherwise it was being written when the process was killed
                _warn(path, "it is damaged or of another version", "everything is computed again")
            return []
        self._check_header(path, entry)
        damages: list[str] = []
        lines = [start]

        def note(number: int, reason: str) -> None:
            damages.append(f"line {number}: {reason}")

        for number, line, evaluation in own_records.further(path, note):
            try:
                self._take(evaluation)
            except (LookupError, TypeError, ValueError, OverflowError) as error:
                note(number, str(error) or type(error).__name__)
            else:
                lines.append(line)
        if damages:
            _warn(path, f"damaged lines: {len(damages)} ({damages[0]})", "what was in them is computed again")
        return lines

    def _check_header(self, path: Path, header: dict[str, Any]) -> None:
        expected = self._header()
        differing = [key for key in expected if header.get(key) != expected[key]]
        if differing:
            msg = (
                f"{path}: this record belongs to another calibration (differing: {', '.join(differing)}); "
                f"name another file, or remove this one to start again"
            )
            raise ForeignRecordError(msg)

    def _take(self, entry: dict[str, Any]) -> None:
        """Remember an evaluation, or slopes, of the record.

        Raises
        ------
        LookupError, TypeError, ValueError
            It is none of this problem, or a number is not finite.
        """
        problem = self.cost.problem
        x = np.array(entry["x"], dtype=np.float64)
        if x.shape != (len(problem.parameters),):
            raise ValueError("it has another number of parameters")
        if "j" in entry:
            slopes = _unpacked(entry["j"], (*problem.measured.shape, len(problem.parameters)))
            if not np.isfinite(slopes).all():
                raise ValueError("a derivative is not finite")
            self._slopes[x.tobytes()] = slopes
            return
        costs = np.array([np.nan if c is None else c for c in entry["c"]], dtype=np.float64)
        if costs.shape != (len(problem.sensors),):
            raise ValueError("it has another number of sensors")
        residuals = _unpacked(entry["r"], problem.measured.shape) if "r" in entry else None
        # Both are undefined where the run failed, and only there.
        if residuals is not None and np.isfinite(residuals).all() != np.isfinite(costs).all():
            raise ValueError("a residual is not finite")
        self._remember(x, costs, residuals)


def _packed(values: Floats) -> str:
    """Bits as text, little-endian on every machine."""
    return base64.b64encode(values.astype("<f8").tobytes()).decode("ascii")


def _unpacked(text: str, shape: tuple[int, ...]) -> Floats:
    return np.frombuffer(base64.b64decode(text, validate=True), dtype="<f8").reshape(shape).astype(float)


def _warn(path: Path, damage: str, remedy: str) -> None:
    warnings.warn(f"{path}: the record of a calibration: {damage}; {remedy}", stacklevel=2)
