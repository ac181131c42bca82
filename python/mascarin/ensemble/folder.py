"""What belongs to the folder of an ensemble, and what it needs."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from mascarin._io import atomic, locks, memory
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pyarrow as pa


def require_parquet() -> None:
    """Refuse a store where pyarrow is not installed.

    Raises
    ------
    InputError
        It is not.
    """
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise InputError(
            "a store needs pyarrow, which is not installed: pip install 'mascarin[parquet]'"
        ) from None


def foreign(file: Path) -> bool:
    """Whether a file is none that the beginning of an ensemble leaves."""
    if file.name == locks.NAME or file.suffix == atomic.PART:
        return False
    return not (file.name == "pieces" and file.is_dir() and not any(file.iterdir()))


def table_of(file: BinaryIO, folder: Path, filters: Any, without: Collection[str]) -> pa.Table:
    """Columns of a Parquet file.

    Parameters
    ----------
    file : file
        The open file: Parquet's library takes no names with bytes that are no text.
    folder : Path
        Its folder, for errors.
    filters : list of tuple or None
        Rows that are read, as pyarrow takes them.
    without : collection of str
        Columns that are left out.

    Raises
    ------
    InputError
        It claims more than memory holds.
    """
    import pyarrow.parquet as pq

    footer = pq.read_metadata(file)
    names = [name for name in footer.schema.to_arrow_schema().names if name not in without]
    if filters is None:
        memory.require(8 * footer.num_rows * len(names), f"{folder}: the results", "read fewer members")
    file.seek(0)
    return pq.read_table(file, columns=names, filters=filters, page_checksum_verification=True)
