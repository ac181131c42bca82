"""What belongs to the folder of an ensemble, and what it needs."""

from __future__ import annotations

from pathlib import Path

from mascarin._io import atomic, locks
from mascarin.errors import InputError


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
