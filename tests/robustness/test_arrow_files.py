"""Files that Arrow reads are opened by Arrow: its threads hold no objects of the interpreter."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin._io import arrow_files
from mascarin.ensemble import sweep_into
from mascarin.errors import InputError
from mascarin.examples import box, box_climate


@pytest.fixture
def readers(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What Parquet's library is given to read, whoever calls it."""
    import pyarrow.parquet as pq

    sources: list[Any] = []
    read_table, parquet_file = pq.read_table, pq.ParquetFile

    def table(source: Any, **options: Any) -> Any:
        sources.append(source)
        return read_table(source, **options)

    class Watched(parquet_file):  # type: ignore[misc, valid-type]
        def __init__(self, source: Any, **options: Any) -> None:
            sources.append(source)
            super().__init__(source, **options)

    monkeypatch.setattr(pq, "read_table", table)
    monkeypatch.setattr(pq, "ParquetFile", Watched)
    return sources


def test_results_are_read_without_objects_of_the_interpreter(tmp_path: Path, readers: list[Any]) -> None:
    import pyarrow as pa

    samples = {"surfaces.facade.outside.absorptance": list(np.linspace(0.1, 0.9, 3))}
    outputs = ["room.air_temperature"]
    store = sweep_into(tmp_path / "store", box(), box_climate(), samples, step="1h", outputs=outputs)
    assert len(store.to_dataframe()) == 3
    run = mc.simulate(box(), box_climate(), step="1h")
    run.write(tmp_path / "run.parquet")
    assert mc.Results.open(tmp_path / "run.parquet") == run
    assert readers
    assert all(isinstance(source, pa.NativeFile | str | Path) for source in readers), readers
    assert not any(isinstance(source, pa.PythonFile) for source in readers)


@pytest.mark.skipif(sys.platform != "linux", reason="names of bytes")
def test_a_name_that_is_no_text_is_opened_as_well(tmp_path: Path) -> None:
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.bin"))
    path.write_bytes(b"abc")
    with arrow_files.opened(path) as file:
        assert file.read() == b"abc"


def test_a_finished_sweep_whose_table_is_gone_says_so(tmp_path: Path) -> None:
    store = sweep_into(
        tmp_path / "sweep", box(), box_climate(), {"zones.room.volume": [25.0, 30.0]}, step="1h"
    )
    (tmp_path / "sweep" / "members.parquet").unlink()
    with pytest.raises(InputError, match=r"members\.parquet: found no such file.*Run it again"):
        store.to_dataframe()
