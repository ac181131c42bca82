"""The folder of an ensemble: results in Parquet, and a manifest of what was run.

``manifest.json`` describes the ensemble; ``pieces/`` holds the finished chunks of members, each written
completely or not at all; when none is missing they are joined to ``members.parquet``, one row a member, whose
bytes do not depend on interruptions or on the size of the chunks.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io import atomic, display, locks
from mascarin._io.regular import require_text
from mascarin.ensemble.work import CLOSURE, attributes
from mascarin.errors import InputError
from mascarin.simulation.energy import ensemble_warnings
from mascarin.simulation.labels import time_coordinates
from mascarin.simulation.run_warnings import of_members
from mascarin.simulation.single_precision import Difference, run_in_double
from mascarin.weather.timezones import parse_timezone

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

    from mascarin.ensemble.members import Members
    from mascarin.ensemble.work import Chunk

#: Names that are kept for old programs.
_DEPRECATED: Final = frozenset({"table", "dataset"})
MANIFEST: Final = "manifest.json"
RESULTS: Final = "members.parquet"
#: Column with the error of an air by the time step. [K]
_STEP_ERROR: Final = "time_step_error"
_CHUNK: Final = re.compile(r"(\d+)-(\d+)\.parquet")
#: Numbers in a row group of the finished file, which is the part that is in memory while it is written.
_GROUP: Final = 2**20
#: Entries of a manifest that must be equal to continue an ensemble.
_SAME: Final = ("mascarin_version", "identity", "samples", "members", "kept", "precision")


class Store:
    """Results of an ensemble on disk.

    Parameters
    ----------
    path : Path
        Its folder.

    Attributes
    ----------
    path : Path
        Its folder.
    manifest : dict
        Version, hashes of building, climate and options (`identity`) and of the samples, seed, outputs or
        objectives, units, times, and whether it is complete.

    Raises
    ------
    InputError
        There is no manifest, or it cannot be read.

    Examples
    --------
    >>> Store(Path("nowhere"))
    Traceback (most recent call last):
    mascarin.errors.InputError: nowhere/manifest.json: found no readable manifest ...
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        place = self.path / MANIFEST
        try:
            self.manifest: dict[str, Any] = json.loads(place.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(
                f"{place}: found no readable manifest ({error}); expected the folder of an ensemble, as "
                "sweep_into() or 'mascarin sweep --out' makes it"
            ) from None

    @staticmethod
    def require_usable(path: Path) -> None:
        """Refuse a folder that holds something else than an ensemble.

        Parameters
        ----------
        path : Path
            Folder; it may not exist.

        Raises
        ------
        InputError
            The folder is not empty and holds no ensemble; or pyarrow is not installed.
        """
        _require_parquet()
        require_text(path)
        if (path / MANIFEST).exists() or not path.exists():
            return
        # What is left where the first file could not be written: the lock, drafts, an empty folder.
        if not path.is_dir() or any(_foreign(file) for file in path.iterdir()):
            raise InputError(f"{path}: found a folder that is not empty and no ensemble; choose another")

    @classmethod
    def begin(cls, path: Path, manifest: Mapping[str, Any]) -> Store:
        """Start a store, or continue one of the same ensemble, in a folder that this process has locked.

        Parameters
        ----------
        path : Path
            Folder; it exists.
        manifest : mapping
            Description of the ensemble.

        Raises
        ------
        InputError
            The folder holds something else, or another ensemble; or pyarrow is not installed.
        """
        cls.require_usable(path)
        atomic.remove_drafts(path)
        if (path / MANIFEST).exists():
            store = cls(path)
            other = [key for key in _SAME if store.manifest.get(key) != manifest[key]]
            if other:
                raise InputError(
                    f"{path}: found an ensemble that differs in {', '.join(other)}; expected the same one, "
                    "to continue it. Choose another folder, or remove this one"
                )
            return store
        (path / "pieces").mkdir(exist_ok=True)
        atomic.write(path / MANIFEST, json.dumps({**manifest, "complete": False}, indent=1) + "\n")
        return cls(path)

    def __repr__(self) -> str:
        return display.text(f"Store '{self.path}'", self._rows())

    def _repr_html_(self) -> str:
        tables = {"Members": self.to_dataframe()} if self.done else {}
        return display.page(f"Store '{self.path}'", self._rows(), tables=tables)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in _DEPRECATED]

    def _rows(self) -> list[tuple[str, str]]:
        manifest = self.manifest
        return [
            ("building", str(manifest["building"])),
            ("members", f"{self.done} of {self.count} run"),
            ("parameters", ", ".join(manifest["paths"])),
            ("objectives" if manifest["objectives"] else "outputs", ", ".join(manifest["kept"])),
            ("step", f"{manifest['step_seconds']:g} s, {manifest['scheme']}"),
            *(("single precision", line) for line in self.single_precision()),
        ]

    @property
    def precision(self) -> str:
        """``double`` or ``single``."""
        return str(self.manifest.get("precision", "double"))

    @property
    def count(self) -> int:
        """Members of the ensemble."""
        return int(self.manifest["members"])

    @property
    def complete(self) -> bool:
        """Whether every member has been run."""
        return bool(self.manifest["complete"])

    @property
    def done(self) -> int:
        """Members that have been run."""
        return self.count - sum(last - first for first, last in self.gaps())

    def gaps(self) -> list[tuple[int, int]]:
        """Members that have not been run: ranges of the first and the one after the last."""
        if self.complete:
            return []
        gaps, at = [], 0
        for first, last in sorted(self._chunks()):
            if first > at:
                gaps.append((at, first))
            at = max(at, last)
        return gaps if at >= self.count else [*gaps, (at, self.count)]

    def add(self, chunk: Chunk, members: Members) -> None:
        """Write a chunk, completely or not at all.

        Parameters
        ----------
        chunk : Chunk
            Its results.
        members : Members
            Its samples.
        """
        import pyarrow.parquet as pq

        last = chunk.first + len(chunk.closure)
        target = self.path / "pieces" / f"{chunk.first:012d}-{last:012d}.parquet"
        with atomic.drafted(target) as draft:
            pq.write_table(self._table(chunk, members), draft)

    def finish(self, single_precision: Sequence[Difference] = (), warnings: Sequence[str] = ()) -> None:
        """Join the chunks to one file and mark the store as complete.

        Parameters
        ----------
        single_precision : sequence of Difference
            How far the results of some members are from double precision, for the manifest.
        warnings : sequence of str
            Warnings of a run with the values of the building, for the manifest.
        """
        if self.complete:
            return
        with atomic.drafted(self.path / RESULTS) as draft:
            self._join(draft)
        if single_precision:
            self.manifest["single_precision"] = {one.name: one.to_dict() for one in single_precision}
        self.manifest["warnings"] = list(warnings)
        self.manifest["complete"] = True
        atomic.write(self.path / MANIFEST, json.dumps(self.manifest, indent=1) + "\n")
        shutil.rmtree(self.path / "pieces", ignore_errors=True)

    def _join(self, target: Path) -> None:
        """Write all chunks to one file, a part at a time."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        rows = max(_GROUP // self._width(), 1)
        held: list[pa.Table] = []
        writer: pq.ParquetWriter | None = None
        for table in self._ordered():
            writer = writer or pq.ParquetWriter(target, table.schema)
            held.append(table)
            joined = pa.concat_tables(held)
            whole = len(joined) // rows * rows
            for at in range(0, whole, rows):
                writer.write_table(joined.slice(at, rows).combine_chunks(), row_group_size=rows)
            held = [joined.slice(whole)]
        if writer is not None:
            rest = pa.concat_tables(held)
            if len(rest):
                writer.write_table(rest.combine_chunks(), row_group_size=rows)
            writer.close()

    def to_dataframe(self) -> pd.DataFrame:
        """Samples, objectives, relative energy-balance residual and failures by member; no series.

        Returns
        -------
        pandas.DataFrame
            A row for each member that has been run.

        Raises
        ------
        InputError
            No member has been run.
        """
        import pandas as pd
        import pyarrow.parquet as pq

        series = {*self.manifest["outputs"]} if not self.manifest["objectives"] else set()
        series.add(_STEP_ERROR)
        found = []
        for file in self._files():
            names = [name for name in pq.read_schema(file).names if name not in series]
            found.append(pq.read_table(file, columns=names).to_pandas())
        whole: pd.DataFrame = pd.concat(found).drop_duplicates("member")
        return whole.sort_values("member").set_index("member")

    def warnings(self) -> list[str]:
        """Warnings about members, and of a run with the values of the building; see `mascarin.sweep`."""
        import pyarrow.parquet as pq

        names = ["member", "closure", _STEP_ERROR]
        closure: dict[int, float] = {}
        errors: dict[int, float] = {}
        for file in self._files():
            # Stores of earlier versions do not have the errors by the time step.
            table = pq.read_table(file, columns=[n for n in names if n in pq.read_schema(file).names])
            columns = {name: table.column(name).to_numpy() for name in table.column_names}
            closure |= dict(zip(columns["member"], columns["closure"], strict=True))
            errors |= dict(zip(columns["member"], columns.get(_STEP_ERROR, ()), strict=False))
        members = sorted(closure)
        return self._said(
            np.array([closure[k] for k in members]), np.array([errors.get(k, np.nan) for k in members]), 0
        )

    def balances(self) -> bool:
        """Whether the energy balance of every member closes."""
        return not ensemble_warnings(self.to_dataframe()["closure"].to_numpy(), precision=self.precision)

    def _said(self, closure: Any, step_errors: Any, first: int) -> list[str]:
        step = float(self.manifest["step_seconds"])
        of = of_members(closure, step_errors, step_seconds=step, first=first, precision=self.precision)
        return [*of, *self.manifest.get("warnings", ())]

    def single_precision(self) -> list[str]:
        """How far some members are from double precision, and how many were run in it; nothing in double."""
        found = self.manifest.get("single_precision", {})
        lines = [str(Difference(name, **values)) for name, values in found.items()]
        return [*lines, *run_in_double(self.to_dataframe()["closure"].to_numpy())] if lines else []

    def to_xarray(self, first: int = 0, last: int | None = None) -> xr.Dataset:
        """Members from `first` to before `last`, as `sweep` returns them.

        Parameters
        ----------
        first, last : int
            First member, and the one after the last. Default: all.

        Returns
        -------
        xarray.Dataset
            Each output over (member, time), or each objective over (member); the samples; ``closure``, the
            relative energy-balance residual [-].

        Raises
        ------
        InputError
            Some of them have not been run yet.
        """
        import pandas as pd
        import pyarrow as pa
        import pyarrow.parquet as pq
        import xarray as xr

        until = self.count if last is None else last
        wanted = [("member", ">=", first), ("member", "<", until)]
        table = pa.concat_tables([pq.read_table(file, filters=wanted) for file in self._files()])
        table = table.sort_by("member")
        members = table.column("member").to_numpy()
        if not np.array_equal(members, np.arange(first, until)):
            raise InputError(
                f"{self.path}: members {first} to {until - 1} are not all there; {self.done} of {self.count} "
                "have been run. Run the sweep again: it continues"
            )
        dims = ("member",) if self.manifest["objectives"] else ("member", "time")
        data: dict[str, Any] = {}
        for name, unit in self.manifest["kept"].items():
            values = table.column(name).combine_chunks()
            numbers = values.to_numpy(zero_copy_only=False) if len(dims) == 1 else _matrix(values)
            data[name] = xr.DataArray(numbers, dims=dims, attrs=attributes(name, unit))
        units = self.manifest.get("sample_units", {})
        for path in self.manifest["paths"]:
            column = table.column(f"sample: {path}").to_pandas().to_numpy()
            data[f"sample: {path}"] = ("member", column, attributes(path, units.get(path, "")))
        data["closure"] = ("member", table.column("closure").to_numpy(), CLOSURE)
        reasons = zip(members, table.column("failure").to_pylist(), strict=True)
        coords: dict[str, Any] = {"member": members}
        if len(dims) > 1:
            times = pd.DatetimeIndex(self.manifest["time"]).tz_localize("UTC")
            coords |= time_coordinates(times.tz_convert(parse_timezone(self.manifest["timezone"])))
        facts = {
            "failures": [f"member {member}: {reason}" for member, reason in reasons if reason is not None],
            "warnings": self._said(data["closure"][1], _step_errors(table), first),
            "timezone": self.manifest["timezone"],
            "mascarin_version": self.manifest["mascarin_version"],
            **({"single_precision": said} if (said := self.single_precision()) else {}),
        }
        return xr.Dataset(data, coords=coords, attrs=facts)

    def table(self) -> pd.DataFrame:
        """Deprecated name of `to_dataframe`."""
        return self.to_dataframe()

    def dataset(self, first: int = 0, last: int | None = None) -> xr.Dataset:
        """Deprecated name of `to_xarray`.

        Parameters
        ----------
        first, last : int
            First member, and the one after the last. Default: all.
        """
        return self.to_xarray(first, last)

    def _width(self) -> int:
        """Numbers in a row."""
        kept = len(self.manifest["kept"])
        rows = 1 if self.manifest["objectives"] else len(self.manifest["time"])
        return kept * rows + len(self.manifest["paths"]) + 3

    def _chunks(self) -> list[tuple[int, int]]:
        names = (_CHUNK.fullmatch(file.name) for file in (self.path / "pieces").glob("*.parquet"))
        return [(int(name[1]), int(name[2])) for name in names if name]

    def _files(self) -> list[Path]:
        if self.complete:
            return [self.path / RESULTS]
        found = sorted((self.path / "pieces").glob("*.parquet"))
        if not found:
            raise InputError(f"{self.path}: no member has been run yet")
        return found

    def _ordered(self) -> Iterator[pa.Table]:
        """Tables of the chunks in the order of the members, each member once."""
        import pyarrow.parquet as pq

        at = 0
        for first, last in sorted(self._chunks()):
            if last <= at:
                continue
            table = pq.read_table(self.path / "pieces" / f"{first:012d}-{last:012d}.parquet")
            yield table.slice(max(at - first, 0))
            at = last

    def _table(self, chunk: Chunk, members: Members) -> pa.Table:
        import pyarrow as pa

        count = len(chunk.closure)
        numbers = range(chunk.first, chunk.first + count)
        columns: dict[str, Any] = {"member": pa.array(numbers, pa.int64())}
        for path, values in members.numbers.items():
            columns[f"sample: {path}"] = pa.array(values)
        for path, structures in members.structures.items():
            columns[f"sample: {path}"] = pa.array([json.dumps(shape, sort_keys=True) for shape in structures])
        for k, name in enumerate(self.manifest["kept"]):
            column = np.ascontiguousarray(chunk.kept[..., k]) if chunk.kept.size else None
            columns[name] = self._column(column, count)
        columns["closure"] = pa.array(chunk.closure)
        columns[_STEP_ERROR] = pa.array(chunk.step_errors)
        columns["failure"] = pa.array([chunk.failures.get(member) for member in numbers], pa.string())
        return pa.table(columns)

    def _column(self, values: Any, count: int) -> Any:
        """Objectives, or series as lists of a fixed length; no number where all members failed."""
        import pyarrow as pa

        rows = 1 if self.manifest["objectives"] else len(self.manifest["time"])
        flat = np.full(count * rows, np.nan) if values is None else values.reshape(-1)
        column = pa.array(flat)
        return column if self.manifest["objectives"] else pa.FixedSizeListArray.from_arrays(column, rows)


def _step_errors(table: pa.Table) -> Any:
    """Errors by the time step; a store of an earlier version does not have them."""
    if _STEP_ERROR not in table.column_names:
        return np.full(len(table), np.nan)
    return table.column(_STEP_ERROR).to_numpy()


def _matrix(column: Any) -> Any:
    rows = column.type.list_size
    return column.flatten().to_numpy(zero_copy_only=False).reshape(-1, rows)


def _require_parquet() -> None:
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise InputError(
            "a store needs pyarrow, which is not installed: pip install 'mascarin[parquet]'"
        ) from None


def _foreign(file: Path) -> bool:
    """Whether a file is none that the beginning of an ensemble leaves."""
    if file.name == locks.NAME or file.suffix == atomic.PART:
        return False
    return not (file.name == "pieces" and file.is_dir() and not any(file.iterdir()))
