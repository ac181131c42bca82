"""The record of evaluations: a log from which a run can continue, and a table."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import warnings
from collections import defaultdict, deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from mascarin._io import atomic, identity
from mascarin._io.sealed import own_files, own_records
from mascarin.errors import InputError
from mascarin.genopt.files.project import Project

FORMAT = 2
#: Runs of a program of the user do not depend on the version of Mascarin.
_KIND = "log of a search"
_END = '{"end":'
Key = tuple[int, tuple[float, ...], tuple[int, ...]]


@dataclass
class Record:
    """One run of the simulation program.

    Parameters
    ----------
    key : tuple
        Step number, continuous values and indices of discrete values.
    costs : tuple of float or None
        All costs, None for a failed run [own units].
    seconds : float
        Wall time [s].
    attempts : int
        How often the program was started [-].
    reason : str
        Why it failed, empty when it did not.
    number : int
        Simulation number; 0 for a run in advance that has not been needed [-].
    replayed : bool
        Whether it comes from the log of an earlier run.
    logged : bool
        Whether it has been written to the log.
    """

    key: Key
    costs: tuple[float, ...] | None
    seconds: float = 0.0
    attempts: int = 1
    reason: str = ""
    number: int = 0
    replayed: bool = False
    logged: bool = False

    def entry(self) -> dict[str, Any]:
        """The record as the content of one line."""
        step, x, choices = self.key
        return {
            "number": self.number,
            "step": step,
            "x": x,
            "choices": choices,
            "costs": self.costs,
            "seconds": round(self.seconds, 4),
            "attempts": self.attempts,
            "reason": self.reason,
        }


def fingerprint(project: Project) -> dict[str, str]:
    """Compute a digest of everything that the result of a run depends on.

    Parameters
    ----------
    project : Project
        The project.

    Returns
    -------
    dict of str to str
        Digests by name; the settings of the algorithm are not included, because they may change.
    """
    parts: dict[str, Any] = {
        "command": [project.command, project.prefix, project.suffix, project.keep_extension],
        "error messages": project.errors,
        "number format": project.number_format,
        "costs": [[o.name, o.delimiter, o.column, o.function] for o in project.objectives],
        "parameter names": [p.name for p in project.continuous],
        "discrete values": [[p.name, *p.values] for p in project.discrete],
        "functions": sorted(project.functions.items()),
        "step number": project.settings.write_step,
        "file names": [
            [str(e.path.relative_to(project.folder)) for e in group]
            for group in (project.input, project.log, project.output)
        ],
    }
    out = {name: _digest(json.dumps(value).encode()) for name, value in parts.items()}
    for entry in project.template:
        out[f"template '{entry.name}'"] = _digest(entry.path.read_bytes())
    return out


class Log:
    """The log of runs, one line of JSON each.

    Parameters
    ----------
    path : Path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._head = ""
        self._file: TextIO | None = None

    def begin(self, digests: Mapping[str, str]) -> None:
        """Begin a new log; an existing one is kept under another name.

        Parameters
        ----------
        digests : mapping of str to str
            From `fingerprint`.
        """
        identity.require_no_input(self.path)
        if self.path.exists():
            self.path.replace(self.path.with_suffix(".previous.jsonl"))
        first = own_records.sealed(_KIND, {"format": FORMAT, "project": dict(digests)})
        self._head = own_records.seal_of(first)
        self._file = self.path.open("w", encoding="utf-8")
        self._write(first)

    def resume(self, digests: Mapping[str, str]) -> list[Record]:
        """Read an earlier log and continue it; a run whose line is damaged is made again, with a warning.

        Parameters
        ----------
        digests : mapping of str to str
            From `fingerprint`.

        Returns
        -------
        list of Record
            The runs in it.

        Raises
        ------
        InputError
            There is no log, its first line is damaged, or it belongs to another project.
        """
        if not self.path.exists():
            msg = f"there is no log '{self.path}' to resume from; start without --resume"
            raise InputError(msg)
        try:
            first = own_records.first_line(self.path)
        except own_files.DamagedError as error:
            raise InputError(f"{self.path}: {error}; remove it or start without --resume") from None
        if not first:
            self.begin(digests)
            return []
        _compare(self.path, first, digests)
        self._head = own_records.seal_of(first.decode())
        records, lines = self._read([first])
        content = b"".join(lines)
        if self.path.read_bytes() != content:
            atomic.write(self.path, content)
        self._file = self.path.open("a", encoding="utf-8")
        return records

    def _read(self, lines: list[bytes]) -> tuple[list[Record], list[bytes]]:
        """Runs and sound lines of a log; damaged lines are warned of."""
        records: list[Record] = []
        damages: list[str] = []

        def note(number: int, reason: str) -> None:
            damages.append(f"line {number}: {reason}")

        for number, line, entry in own_records.further(self.path, note):
            if "end" not in entry:
                try:
                    records.append(_record(entry))
                except (ValueError, OverflowError) as error:
                    note(number, str(error))
                    continue
            lines.append(line)
        if damages:
            warnings.warn(
                f"{self.path}: damaged lines: {len(damages)} ({damages[0]}); these simulations are run again",
                stacklevel=3,
            )
        return records, lines

    def add(self, record: Record) -> None:
        """Append a run."""
        self._put(record.entry())

    def end(self, reason: str) -> None:
        """Write that the optimization has ended."""
        self._put({"end": reason})

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _put(self, entry: Mapping[str, Any]) -> None:
        """Write one line."""
        if self._file is not None:
            self._write(own_records.sealed(self._head, entry))

    def _write(self, line: str) -> None:
        """Write a line at once."""
        if self._file is not None:
            self._file.write(line)
            self._file.flush()


def interrupted(path: Path) -> int:
    """Count the runs in the log of an optimization that did not end.

    Parameters
    ----------
    path : Path
        The log.

    Returns
    -------
    int
        The number, 0 when there is no log or it is complete [-].
    """
    if not path.exists():
        return 0
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    return 0 if lines and lines[-1].startswith(_END) else max(len(lines) - 1, 0)


class Replay:
    """Results of an earlier run, each to be used once.

    Parameters
    ----------
    records : iterable of Record
        The earlier runs.
    """

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self._left: defaultdict[Key, deque[Record]] = defaultdict(deque)
        for record in records:
            self._left[record.key].append(record)

    def take(self, key: Key) -> Record | None:
        """The next result of a key, None when there is none."""
        queue = self._left.get(key)
        return queue.popleft() if queue else None

    def cost(self, key: Key) -> float | None:
        """Cost of a key without taking it."""
        queue = self._left.get(key)
        return queue[0].costs[0] if queue and queue[0].costs is not None else None


def write_table(path: Path, project: Project, records: Sequence[Record]) -> None:
    """Write all evaluations as a table.

    Parameters
    ----------
    path : Path
        A file ending in ``.csv`` or ``.parquet``.
    project : Project
        The project.
    records : sequence of Record
        The runs.

    Raises
    ------
    InputError
        Another ending, or Parquet cannot be written.
    """
    check_table(path)
    columns = table_columns(project)
    rows = [_row(project, r) for r in records]
    if path.suffix.lower() == ".csv":
        text = io.StringIO(newline="")
        writer = csv.writer(text)
        writer.writerow(columns)
        writer.writerows(["" if v is None else v for v in row] for row in rows)
        atomic.write(path, text.getvalue())
        return
    import pandas as pd

    with atomic.replacing(path) as file:
        pd.DataFrame(rows, columns=columns).to_parquet(file, index=False)


def check_table(path: Path) -> None:
    """Check that the table can be written at the end.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        It cannot; the text has the reason.
    """
    kind = path.suffix.lower()
    if kind not in (".csv", ".parquet"):
        msg = f"'{path}' ends in '{path.suffix}'; expected .csv or .parquet"
        raise InputError(msg)
    if not path.absolute().parent.is_dir():
        msg = f"'{path.absolute().parent}' is not a directory; make it first"
        raise InputError(msg)
    if kind == ".parquet":
        import importlib.util

        if importlib.util.find_spec("pyarrow") is None:
            msg = f"'{path}' needs pyarrow: pip install 'mascarin[parquet]', or write .csv"
            raise InputError(msg)


def table_columns(project: Project) -> list[str]:
    """Return the titles of the table; a cost with the name of a parameter gets a suffix.

    Parameters
    ----------
    project : Project
        The project.

    Returns
    -------
    list of str
        Titles.
    """
    taken = {"simulation", "status", "step_number", "seconds", "attempts", "reason"}
    names = []
    for name, kind in (
        *((n, "parameter") for n in project.names),
        *((o.name, "cost") for o in project.objectives),
    ):
        title = name if name not in taken else f"{name} ({kind})"
        taken.add(title)
        names.append(title)
    return ["simulation", "status", "step_number", *names, "seconds", "attempts", "reason"]


def _row(project: Project, r: Record) -> list[Any]:
    """One row of the table."""
    step, x, choices = r.key
    status = "failed" if r.costs is None else "ok" if r.number else "ahead"
    chosen = [p.values[k] for p, k in zip(project.discrete, choices, strict=True)]  # noqa: PD011
    costs = r.costs if r.costs is not None else (None,) * len(project.objectives)
    return [r.number or None, status, step, *x, *chosen, *costs, r.seconds, r.attempts, r.reason]


def _compare(path: Path, line: bytes, digests: Mapping[str, str]) -> None:
    """Check that a log belongs to this project."""
    try:
        head = own_records.opened(_KIND, line)
        own_files.require(head, {"project": dict, "format": int})
    except own_files.DamagedError as error:
        msg = (
            f"{path}:1: not the first line of a log of evaluations ({error}); remove it or start "
            "without --resume"
        )
        raise InputError(msg) from error
    if head["format"] != FORMAT:
        raise InputError(
            f"{path}:1: found format {head['format']}, expected {FORMAT}; remove it or start without --resume"
        )
    recorded = head["project"]
    changed = sorted(k for k in {*recorded, *digests} if recorded.get(k) != digests.get(k))
    if changed:
        msg = (
            f"{path}: results of another project: changed since then: {', '.join(changed)}. "
            "Undo the change, or start without --resume"
        )
        raise InputError(msg)


def _record(entry: Mapping[str, Any]) -> Record:
    """A record from its line.

    Raises
    ------
    DamagedError
        It is damaged.
    """
    _check(entry)
    return Record(
        (entry["step"], tuple(entry["x"]), tuple(entry["choices"])),
        None if entry["costs"] is None else tuple(entry["costs"]),
        entry["seconds"],
        entry["attempts"],
        entry["reason"],
        entry["number"],
        replayed=True,
        logged=True,
    )


def _check(record: Mapping[str, Any]) -> None:
    """Refuse a line whose values have other types.

    Raises
    ------
    DamagedError
        It is damaged.
    """
    own_files.require(
        record,
        {
            "step": int, "x": list, "choices": list, "costs": (list, type(None)), "seconds": (int, float),
            "attempts": int, "reason": str, "number": int,
        },
    )  # fmt: skip
    for key, kinds in (("x", (int, float)), ("choices", (int,)), ("costs", (int, float))):
        for value in record[key] or ():
            if not isinstance(value, kinds) or isinstance(value, bool):
                raise own_files.DamagedError(f"{key}: found {type(value).__name__}")


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
