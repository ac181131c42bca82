from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import pooch
import pytest

from mascarin._io.sealed.cache import cache_folder
from mascarin.errors import InputError
from mascarin.weather.reading import data as data_module
from mascarin.weather.reading.data import FILES, data_file


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """No data folder and an empty cache."""
    monkeypatch.delenv("MASCARIN_DATA", raising=False)
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    return tmp_path


@pytest.mark.parametrize("known", FILES, ids=lambda known: known.name)
def test_pinned_hashes_are_those_of_the_files(
    data_dir: Path, monkeypatch: pytest.MonkeyPatch, known: data_module.DataFile
) -> None:
    monkeypatch.setenv("MASCARIN_DATA", str(data_dir))
    path = data_file(known.name)
    assert path == data_dir / known.path
    assert hashlib.sha256(path.read_bytes()).hexdigest() == known.sha256
    assert data_file(known.path) == path


def test_a_flat_folder_will_do(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_DATA", str(empty))
    (empty / "pcm_products.csv").write_text("x", encoding="utf-8")
    assert data_file("pcm_products.csv") == empty / "pcm_products.csv"


def test_unknown_name_gets_a_suggestion() -> None:
    with pytest.raises(
        InputError, match=r"data:wall_bench.csv: no such data set. Did you mean 'wall_bench_2024.csv'"
    ):
        data_file("wall_bench.csv")


def test_cache_is_used_only_with_the_pinned_hash(
    empty: Path, monkeypatch: pytest.MonkeyPatch, data_dir: Path
) -> None:
    cached = cache_folder() / "pcm" / "pcm_products.csv"
    cached.parent.mkdir(parents=True)
    cached.write_text("damaged", encoding="utf-8")
    with pytest.raises(InputError, match="cannot be downloaded"):
        data_file("pcm_products.csv")
    cached.write_bytes((data_dir / "pcm" / "pcm_products.csv").read_bytes())
    assert data_file("pcm_products.csv") == cached


def test_download_goes_to_the_cache(empty: Path, monkeypatch: pytest.MonkeyPatch, data_dir: Path) -> None:
    asked: list[str] = []
    content = (data_dir / FILES[0].path).read_bytes()

    def download(url: str, output_file: Any, *_: Any, **__: Any) -> None:
        asked.append(url)
        Path(output_file).write_bytes(content)

    monkeypatch.setattr(
        pooch.HTTPDownloader, "__call__", lambda _, *given, **named: download(*given, **named)
    )
    path = data_file("wall_bench_2024.csv")
    assert path == cache_folder() / "wall_bench" / "wall_bench_2024.csv"
    assert path.read_bytes() == content
    assert asked == [FILES[0].url]
    assert data_file("wall_bench_2024.csv") == path
    assert len(asked) == 1


def test_another_file_at_the_source_is_refused(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def download(_: Any, __: str, output_file: Any, *___: Any, **____: Any) -> None:
        Path(output_file).write_text("changed", encoding="utf-8")

    monkeypatch.setattr(pooch.HTTPDownloader, "__call__", download)
    with pytest.raises(
        InputError, match=r"does not match.*set MASCARIN_DATA to a folder that holds wall_bench/"
    ):
        data_file("wall_bench_2024.csv")
    assert not (cache_folder() / "wall_bench" / "wall_bench_2024.csv").exists()
