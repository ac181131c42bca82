from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def unavailable(reason: str) -> None:
    """Skip the test; under continuous integration, where nothing may be missing, fail it."""
    if os.environ.get("CI"):
        pytest.fail(f"{reason} (CI is set: nothing may be skipped for missing data)", pytrace=False)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of measured and reference data: MASCARIN_DATA, or shared/data beside the repository."""
    folder = Path(os.environ.get("MASCARIN_DATA") or ROOT.parent / "shared" / "data")
    if not folder.is_dir():
        unavailable(f"no data folder at {folder}: set MASCARIN_DATA")
    return folder


@pytest.fixture(scope="session")
def repository() -> Path:
    """Root of the repository."""
    return ROOT
