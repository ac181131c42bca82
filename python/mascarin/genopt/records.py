"""The record of evaluations: a log from which a run can continue, and a table."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections import defaultdict, deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from mascarin._io import atomic, identity, own_files
from mascarin.errors import InputError
from mascarin.genopt.project import Project

FORMAT = 1
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

    def line(self) -> str:
        """The record as one line of JSON."""
        step, x, choices = self.key
        return json.dumps(
            {
                "number": self.number,
                "step": step,
                "x": x,
                "choices": choices,
                "costs": self.costs,
                "seconds": round(self.seconds, 4),
                "attempts": self.attempts,
                "reason": self.reason,
            },
            separators=(",", ":"),
        )


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
        self._file = self.path.open("w", encoding="utf-8")
        self._put(json.dumps({"format": FORMAT, "project": dict(digests)}))

    def resume(self, digests: Mapping[str, str]) -> list[Record]:
        """Read an earlier log and continue it.

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
            There is no log, or it belongs to another project.
        """
        if not self.path.exists():
            msg = f"there is no log '{self.path}' to resume from; start without --resume"
            raise InputError(msg)
        data = self.path.read_bytes()
        # A line without an end was being written when the run was killed.
        complete = data[: data.rfind(b"\n") + 1]
        try:
            lines = complete.decode("utf-8").splitlines()
        except UnicodeDecodeError as error:
            msg = (
                f"{self.path}: damaged, it is not text ({error.reason}); remove it or start without --resume"
            )
            raise InputError(msg) from error
        if not lines:
            self.begin(digests)
            return []
        _compare(self.path, lines[0], digests)
        records = [
            _record(self.path, i, line)
            for i, line in enumerate(lines[1:], start=2)
            if not line.startswith(_END)
        ]
        if len(complete) < len(data):
            with self.path.open("r+b") as file:
                file.truncate(len(complete))
        self._file = self.path.open("a", encoding="utf-8")
        return records

    def add(self, record: Record) -> None:
        """Append a run."""
        self._put(record.line())

    def end(self, reason: str) -> None:
        """Write that the optimization has ended."""
        self._put(json.dumps({"end": reason}))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _put(self, line: str) -> None:
        """Write one line at once."""
        if self._file is not None:
            self._file.write(line + "\n")
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


def _compare(path: Path, line: str, digests: Mapping[str, str]) -> None:
    """Check that a log belongs to this project."""
    try:
        head = own_files.json_of(line)
        own_files.require(head if isinstance(head, dict) else {}, {"project": dict, "format": int})
        recorded = head["project"]
        version = head["format"]
    except own_files.DamagedError as error:
        msg = f"{path}:1: not a log of evaluations; remove it or start without --resume"
        raise InputError(msg) from error
    if version != FORMAT:
        msg = f"{path}:1: format {version}, this version reads {FORMAT}; start without --resume"
        raise InputError(msg)
    changed = sorted(k for k in {*recorded, *digests} if recorded.get(k) != digests.get(k))
    if changed:
        msg = (
            f"{path}: results of another project: changed since then: {', '.join(changed)}. "
            "Undo the change, or start without --resume"
        )
        raise InputError(msg)


def _record(path: Path, number: int, line: str) -> Record:
    """A record from its line."""
    try:
        d = own_files.json_of(line)
        _check(d if isinstance(d, dict) else {})
        return Record(
            (d["step"], tuple(d["x"]), tuple(d["choices"])),
            None if d["costs"] is None else tuple(d["costs"]),
            d["seconds"],
            d["attempts"],
            d["reason"],
            d["number"],
            replayed=True,
            logged=True,
        )
    except (ValueError, OverflowError) as error:
        msg = f"{path}:{number}: broken line ({error}); remove it to continue from the others"
        raise InputError(msg) from error


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
