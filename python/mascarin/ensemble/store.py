"""The folder of an ensemble: results in Parquet, and a manifest of what was run.

``manifest.json`` describes the ensemble; ``pieces/`` holds the finished chunks of members, each written
completely or not at all; when none is missing they are joined to ``members.parquet``, one row a member, whose
bytes do not depend on interruptions or on the size of the chunks.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import shutil
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final

import numpy as np

from mascarin._io import arrow_files, atomic, display, identity
from mascarin._io.regular import require_text
from mascarin._io.sealed import own_files
from mascarin.ensemble.folder import foreign, require_parquet, table_of
from mascarin.ensemble.manifest import read
from mascarin.ensemble.work import CLOSURE, attributes
from mascarin.errors import InputError
from mascarin.simulation.checks.judgement import JUDGED, OUTSIDE, all_sound
from mascarin.simulation.checks.warning_kinds import RunWarning, kinds_of, with_kinds
from mascarin.simulation.records.labels import time_coordinates
from mascarin.simulation.run_warnings import of_members
from mascarin.simulation.single_precision import Difference, run_in_double
from mascarin.tables.timezones import parse_timezone

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa
    import xarray as xr

    from mascarin.ensemble.members import Members
    from mascarin.ensemble.work import Chunk

MANIFEST: Final = "manifest.json"
RESULTS: Final = "members.parquet"
_STEP_ERROR: Final = "time_step_error"
_CHUNK: Final = re.compile(r"(\d+)-(\d+)\.parquet")
#: Numbers in a row group of the finished file, which is the part that is in memory while it is written.
_GROUP: Final = 2**20
#: Columns by which members are judged: residual [-], temperatures and error by the time step [K], steps in
#: which a law written as text did not hold.
_JUDGED: Final = (*JUDGED, _STEP_ERROR, "beyond_validity")
#: Entries of a manifest that are written at the end.
_AT_END: Final = ("complete", "single_precision", "warnings", "warning_kinds")
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
        self.manifest: dict[str, Any] = read(self.path / MANIFEST)
        #: Names of pieces, and whether they are as they were written.
        self._whole: dict[str, bool] = {}

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
        require_parquet()
        require_text(path)
        if (path / MANIFEST).exists() or not path.exists():
            return
        # What is left where the first file could not be written: the lock, drafts, an empty folder.
        if not path.is_dir() or any(foreign(file) for file in path.iterdir()):
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
        for name in (MANIFEST, RESULTS):
            identity.require_no_input(path / name)
        identity.require_no_inputs_in(own_files.require_folder(path, "pieces"))
        atomic.remove_drafts(path)
        if (path / MANIFEST).exists():
            store = cls(path)
            other = [key for key in _SAME if store.manifest.get(key) != manifest[key]]
            if other:
                raise InputError(
                    f"{path}: found an ensemble that differs in {', '.join(other)}; expected the same one, "
                    "to continue it. Choose another folder, or remove this one"
                )
            store._restore(manifest)
            return store
        (path / "pieces").mkdir(exist_ok=True)
        atomic.write(path / MANIFEST, json.dumps({**manifest, "complete": False}, indent=1) + "\n")
        return cls(path)

    def _restore(self, manifest: Mapping[str, Any]) -> None:
        """Take the entries as they are known, and forget what was damaged: it is run again."""
        entries: dict[str, Any] = {key: self.manifest[key] for key in _AT_END if key in self.manifest}
        self.manifest = {**json.loads(json.dumps(manifest)), **entries}
        self.manifest["complete"] = self.complete and self._has_results()
        if self.complete:
            return
        (self.path / "pieces").mkdir(exist_ok=True)
        for file in (self.path / "pieces").glob("*.parquet"):
            if _CHUNK.fullmatch(file.name) and not self._is_whole(file):
                own_files.remove(file)

    def _has_results(self) -> bool:
        """Whether the finished file has a row for each member, and its columns."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        try:
            with (self.path / RESULTS).open("rb") as file:
                footer = pq.read_metadata(file)
            names = {*footer.schema.to_arrow_schema().names}
        except (OSError, ValueError, pa.ArrowException):
            return False
        return footer.num_rows == self.count and {"member", *_JUDGED, *self.manifest["kept"]} <= names

    def _is_whole(self, file: Path) -> bool:
        """Whether a piece is as it was written; each is read once."""
        if file.name not in self._whole:
            try:
                own_files.read(file, file.name)
            except (OSError, own_files.DamagedError):
                self._whole[file.name] = False
            else:
                self._whole[file.name] = True
        return self._whole[file.name]

    def __repr__(self) -> str:
        return display.text(f"Store '{self.path}'", self._rows())

    def _repr_html_(self) -> str:
        tables = {"Members": self.to_dataframe()} if self.done else {}
        return display.page(f"Store '{self.path}'", self._rows(), tables=tables)

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
        gaps, position = [], 0
        for first, last in sorted(self._chunks()):
            if first > position:
                gaps.append((position, first))
            position = max(position, last)
        return gaps if position >= self.count else [*gaps, (position, self.count)]

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
        content = io.BytesIO()
        pq.write_table(self._table(chunk, members), content)
        own_files.write(target, target.name, content.getvalue())
        self._whole[target.name] = True

    def finish(
        self, single_precision: Sequence[Difference] = (), warnings: Sequence[RunWarning] = ()
    ) -> None:
        """Join the chunks to one file and mark the store as complete.

        Parameters
        ----------
        single_precision : sequence of Difference
            How far the results of some members are from double precision, for the manifest.
        warnings : sequence of RunWarning
            Warnings of a run with the values of the building, for the manifest.
        """
        if self.complete:
            return
        with self._blamed(), atomic.drafted(self.path / RESULTS) as draft, draft.open("wb") as file:
            self._join(file)
        if single_precision:
            self.manifest["single_precision"] = {
                difference.name: difference.to_dict() for difference in single_precision
            }
        self.manifest["warnings"] = list(warnings)
        self.manifest["warning_kinds"] = kinds_of(warnings)
        self.manifest["complete"] = True
        atomic.write(self.path / MANIFEST, json.dumps(self.manifest, indent=1) + "\n")
        shutil.rmtree(self.path / "pieces", ignore_errors=True)

    def _join(self, target: BinaryIO) -> None:
        """Write all chunks to one file, a part at a time."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        rows = max(_GROUP // self._width(), 1)
        held: list[pa.Table] = []
        writer: pq.ParquetWriter | None = None
        with contextlib.ExitStack() as opened:
            for table in self._ordered():
                writer = writer or opened.enter_context(
                    pq.ParquetWriter(target, table.schema, write_page_checksum=True)
                )
                held.append(table)
                joined = pa.concat_tables(held)
                full_rows = len(joined) // rows * rows
                for row in range(0, full_rows, rows):
                    writer.write_table(joined.slice(row, rows).combine_chunks(), row_group_size=rows)
                held = [joined.slice(full_rows)]
            remainder = pa.concat_tables(held) if held else None
            if writer is not None and remainder is not None and len(remainder):
                writer.write_table(remainder.combine_chunks(), row_group_size=rows)

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
        return self._frame().drop(columns=_STEP_ERROR)

    def _frame(self) -> pd.DataFrame:
        import pandas as pd

        series = {*self.manifest["outputs"]} if not self.manifest["objectives"] else set()
        with self._blamed():
            frames = [table.to_pandas(ignore_metadata=True) for table in self._tables(without=series)]
            frame: pd.DataFrame = pd.concat(frames).drop_duplicates("member")
            if not {*_JUDGED, "failure"} <= {*frame.columns}:
                raise KeyError("closure")
            return frame.sort_values("member").set_index("member")

    def warnings(self) -> list[RunWarning]:
        """Warnings about members, and of a run with the values of the building; see `mascarin.sweep`."""
        table = self._frame()
        return self._said([table[name].to_numpy() for name in _JUDGED], 0)

    def sound(self) -> bool:
        """Whether the energy balance of every member closes and every temperature has a cause."""
        return all_sound(self.to_dataframe(), self.precision)

    def _said(self, judged: Sequence[Any], first: int) -> list[RunWarning]:
        options: Any = {"step_seconds": float(self.manifest["step_seconds"]), "precision": self.precision}
        members = of_members(*judged, first=first, **options)
        base = with_kinds(self.manifest.get("warnings", ()), self.manifest.get("warning_kinds"))
        return [*members, *base]

    def single_precision(self) -> list[str]:
        """How far some members are from double precision, and how many were run in it; nothing in double."""
        entries = self.manifest.get("single_precision", {})
        lines = [str(Difference(name, **values)) for name, values in entries.items()]
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
        until = self.count if last is None else last
        with self._blamed():
            return self._dataset(first, until)

    def _dataset(self, first: int, until: int) -> xr.Dataset:
        """Members from `first` to before `until`."""
        import pandas as pd
        import pyarrow as pa

        from mascarin.simulation.records.series import RunDataset

        filters = [("member", ">=", first), ("member", "<", until)]
        table = pa.concat_tables(self._tables(filters=filters)).sort_by("member")
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
            flat = (values if len(dims) == 1 else values.flatten()).to_numpy(zero_copy_only=False)
            data[name] = (dims, flat.reshape((len(members), -1)[: len(dims)]), attributes(name, unit))
        units = self.manifest.get("sample_units", {})
        for path in self.manifest["paths"]:
            column = table.column(f"sample: {path}").to_pandas().to_numpy()
            data[f"sample: {path}"] = ("member", column, attributes(path, units.get(path, "")))
        for name, attrs in zip(JUDGED, (CLOSURE, OUTSIDE), strict=True):
            data[name] = ("member", table.column(name).to_numpy(), attrs)
        reasons = zip(members, table.column("failure").to_pylist(), strict=True)
        coords: dict[str, Any] = {"member": members}
        if len(dims) > 1:
            times = pd.DatetimeIndex(self.manifest["time"]).tz_localize("UTC")
            coords |= time_coordinates(times.tz_convert(parse_timezone(self.manifest["timezone"])))
        facts = {
            "failures": [f"member {member}: {reason}" for member, reason in reasons if reason is not None],
            "warnings": [*map(str, self._said([table.column(name).to_numpy() for name in _JUDGED], first))],
            "timezone": self.manifest["timezone"],
            "mascarin_version": self.manifest["mascarin_version"],
            **({"single_precision": said} if (said := self.single_precision()) else {}),
        }
        return RunDataset(data, coords=coords, attrs=facts)

    def _width(self) -> int:
        """Numbers in a row."""
        recorded = len(self.manifest["kept"])
        rows = 1 if self.manifest["objectives"] else len(self.manifest["time"])
        return recorded * rows + len(self.manifest["paths"]) + 4

    def _chunks(self) -> list[tuple[int, int]]:
        chunks = []
        for file in (self.path / "pieces").glob("*.parquet"):
            name = _CHUNK.fullmatch(file.name)
            if name and int(name[1]) < int(name[2]) <= self.count and self._is_whole(file):
                chunks.append((int(name[1]), int(name[2])))
        return chunks

    def _tables(self, filters: Any = None, without: Collection[str] = ()) -> list[pa.Table]:
        """Tables of the finished file, or of all pieces.

        Raises
        ------
        InputError
            No member has been run.
        """
        if self.complete:
            with arrow_files.opened(self.path / RESULTS) as file:
                return [table_of(file, self.path, filters, without)]
        pieces = [self._piece(*span) for span in sorted(self._chunks())]
        if not pieces:
            raise InputError(f"{self.path}: no member has been run yet")
        return [table_of(io.BytesIO(piece), self.path, filters, without) for piece in pieces]

    def _piece(self, first: int, last: int) -> bytes:
        """Content of a piece."""
        file = self.path / "pieces" / f"{first:012d}-{last:012d}.parquet"
        return own_files.read(file, file.name)

    @contextlib.contextmanager
    def _blamed(self) -> Iterator[None]:
        """What a damaged file raises, as an error with its remedy."""
        import pyarrow as pa

        try:
            yield
        except (OSError, LookupError, ValueError, TypeError, AttributeError, pa.ArrowException) as error:
            if isinstance(error, OSError) and error.errno is not None:
                raise  # of the system, such as a full disk
            raise InputError(
                f"{self.path}: found results that cannot be read ({str(error)[:200]}); expected those of the "
                "manifest. Remove the folder, and run it again"
            ) from None

    def _ordered(self) -> Iterator[pa.Table]:
        """Tables of the chunks in the order of the members, each member once."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        position = 0
        for first, last in sorted(self._chunks()):
            if last <= position:
                continue
            table = pq.read_table(pa.BufferReader(self._piece(first, last)))
            yield table.slice(max(position - first, 0))
            position = last

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
            column = np.ascontiguousarray(chunk.recorded[..., k]) if chunk.recorded.size else None
            columns[name] = self._column(column, count)
        columns |= {name: pa.array(values) for name, values in zip(_JUDGED, chunk.judged, strict=True)}
        columns["failure"] = pa.array([chunk.failures.get(member) for member in numbers], pa.string())
        return pa.table(columns)

    def _column(self, values: Any, count: int) -> Any:
        """Objectives, or series as lists of a fixed length; no number where all members failed."""
        import pyarrow as pa

        rows = 1 if self.manifest["objectives"] else len(self.manifest["time"])
        flat = np.full(count * rows, np.nan) if values is None else values.reshape(-1)
        column = pa.array(flat)
        return column if self.manifest["objectives"] else pa.FixedSizeListArray.from_arrays(column, rows)
