"""Files that Mascarin writes for itself: what is damaged, of another version, or of someone else."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin._io.locks import FolderLock
from mascarin._io.sealed import own_files
from mascarin.errors import InputError
from mascarin.study.context import step_cache as kept
from mascarin.study.context.storage import Workspace


def test_every_changed_byte_is_found() -> None:
    file = own_files.sealed("test", b"some content")
    assert own_files.opened("test", file) == b"some content"
    for k in range(len(file)):
        for bit in (1, 128):
            damaged = file[:k] + bytes([file[k] ^ bit]) + file[k + 1 :]
            with pytest.raises(own_files.DamagedError):
                own_files.opened("test", damaged)
        with pytest.raises(own_files.DamagedError):
            own_files.opened("test", file[:k])
    with pytest.raises(own_files.DamagedError, match="another version or kind"):
        own_files.opened("other", file)


def test_arrays_come_back_with_all_bits() -> None:
    arrays: dict[str, Any] = {
        "numbers": np.array([[1.0 / 3.0, np.nan], [np.inf, -0.0]]),
        "single": np.array([0.1], dtype=np.float32),
        "scalar": np.array(3),
        "flags": np.array([True, False]),
        "empty": np.empty((0, 3)),
        "words": np.array(["roof", "Wände"]),
        "times": np.array(["2020-01-01"], dtype="datetime64[ns]"),
    }
    notes, again = own_files.unpacked(own_files.packed({"a": [1, None]}, arrays))
    assert notes == {"a": [1, None]}
    for name, values in arrays.items():
        assert again[name].dtype == values.dtype
        assert again[name].shape == values.shape
        assert again[name].tobytes() == values.tobytes()
    with pytest.raises(TypeError, match="object"):
        own_files.packed(None, {"a": np.array([None])})


@pytest.mark.parametrize(
    "entry",
    [
        ["a", "<f8", [10**11]], ["a", "<f8", [-1]], ["a", "<f8", [2, "x"]], ["a", "|O", [1]],
        ["a", "<U999999999", [1]], ["a", "V8", [1]], ["a", "<f8", [True]], ["a", "<f8", [1] * 40],
        ["a", "<f8"], [1, "<f8", [1]], "a", None, ["a", "f8,f8", [1]], ["a", "<f8", [2**40, 2**40]],
    ],
)  # fmt: skip
def test_a_claim_that_the_file_cannot_hold_takes_no_memory(entry: Any) -> None:
    head = json.dumps({"notes": None, "arrays": [entry]}).encode()
    with pytest.raises(own_files.DamagedError):
        own_files.unpacked(len(head).to_bytes(8, "little") + head + b"\0" * 8)


def test_a_key_that_may_be_empty_may_not_be_missing() -> None:
    kinds: dict[str, Any] = {"costs": (list, type(None)), "n": int}
    own_files.require({"costs": None, "n": 1}, kinds)
    own_files.require({"n": 1}, kinds, further=("costs",))
    for content in ({"n": 1}, {"costs": [], "n": True}, {"costs": {}, "n": 1}, {}):
        with pytest.raises(own_files.DamagedError):
            own_files.require(content, kinds)


def test_nested_json_is_bounded() -> None:
    for depth in (own_files.DEEPEST + 1, 900, 100_000):
        with pytest.raises(own_files.DamagedError):
            own_files.json_of("[" * depth + "]" * depth)
    assert own_files.json_of("[" * own_files.DEEPEST + "]" * own_files.DEEPEST)


@pytest.mark.parametrize(
    "name", ["../a", "/a", "a/../../b", "", "a\0", "C:/a", "a\\b", 5, None, "link/a", "."]
)
def test_names_stay_in_their_folder(name: Any, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out" / "link").symlink_to(tmp_path / "elsewhere")
    path = own_files.inside(tmp_path / "out", name)
    assert path is None or path == tmp_path / "out"
    assert own_files.inside(tmp_path / "out", "tables/a.csv") == tmp_path / "out" / "tables" / "a.csv"


TREES: list[Any] = [
    {"known": 5}, {"known": -1}, {"array": "zz"}, {"array": 5}, {"class": "os:system", "fields": {}},
    {"class": "mascarin.nowhere:X", "fields": {}}, {"class": "mascarin.errors:InputError", "fields": {}},
    {"class": "mascarin.simulation.single_precision:Difference", "fields": {"x": {"value": 1}}},
    {"class": 5, "fields": {}}, {"class": "mascarin.", "fields": {}},
    {"class": "mascarin.a..b:c", "fields": {}},
    {"class": "mascarin.__main__:main", "fields": {}}, {"mapping": [[{"list": []}, {"value": 1}]]},
    {"mapping": 5}, {"mapping": [[1]]}, {"tuple": 5}, {"list": "abc"}, {"value": [1]}, [], None, 5,
    {"class": "mascarin.validation.days:DriverRange", "fields": []},
]  # fmt: skip


@pytest.mark.parametrize("tree", TREES)
def test_a_result_of_another_structure_is_computed_again(tree: Any, tmp_path: Path) -> None:
    with Workspace(tmp_path, {"a": 1}) as workspace:
        assert kept.kept(workspace, "key", lambda: 7) == 7
        (file,) = workspace.folder.glob("kept-*")
        own_files.write(file, file.stem, own_files.packed(tree, {}))
        assert kept.kept(workspace, "key", lambda: 8) == 8
        assert kept.kept(workspace, "key", lambda: 9) == 8


def test_an_old_kind_of_kept_file_is_computed_again(tmp_path: Path) -> None:
    with Workspace(tmp_path, {"a": 1}) as workspace:
        kept.kept(workspace, "key", lambda: 7)
        (file,) = workspace.folder.glob("kept-*")
        np.savez(file, tree=np.frombuffer(b'{"value": 5}', dtype=np.uint8))
        assert kept.kept(workspace, "key", lambda: 8) == 8
        workspace.keep("runs", 0, {"values": np.arange(3.0)})
        np.save(workspace.path("runs-000000003.npy"), np.arange(3.0))
        assert [first for first, _ in workspace.kept("runs")] == [0]


def test_only_results_of_the_folder_are_removed(tmp_path: Path) -> None:
    out, precious = tmp_path / "out", tmp_path / "precious"
    precious.mkdir()
    names = ["../precious/a.txt", str(precious / "b.txt"), "tables/old.csv", "notes.txt", "link/c.csv",
             "tables/../../precious/a.txt", "tables/linked.csv", 5, None, [], {}, "study.yaml"]  # fmt: skip
    with Workspace(out, {"a": 1}) as workspace:
        workspace.record("study", [])
    (out / "tables").mkdir()
    kept_files = [
        precious / "a.txt",
        precious / "b.txt",
        precious / "c.csv",
        out / "notes.txt",
        out / "study.yaml",
    ]
    for file in (*kept_files, out / "tables" / "old.csv"):
        file.write_text("secret")
    (out / "link").symlink_to(precious)
    (out / "tables" / "linked.csv").symlink_to(precious / "a.txt")
    record = out / ".work" / "results.json"
    content = json.loads(record.read_text())
    content["study"]["files"] += names
    record.write_text(json.dumps(content))
    with Workspace(out, {"a": 1}) as workspace:
        workspace.record("study", [])
    assert not (out / "tables" / "old.csv").exists()
    assert all(file.read_text() == "secret" for file in kept_files)
    for damaged in (
        "",
        "[]",
        "5",
        '{"study": 5}',
        '{"study": {"inputs": 1, "files": 2}}',
        "[" * 99_999,
        "\udcff",
    ):
        record.write_bytes(damaged.encode("utf-8", "surrogateescape"))
        with Workspace(out, {"a": 1}) as workspace:
            workspace.record("study", [])


@pytest.mark.skipif(sys.platform == "win32", reason="links need a right there")
@pytest.mark.parametrize("name", [".work", "tables", "figures"])
def test_a_folder_of_results_that_leads_elsewhere_is_refused(name: str, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "mine.npy").write_text("secret")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / name).symlink_to(elsewhere)
    with pytest.raises(InputError, match="remove the link"):
        Workspace(tmp_path / "out", {"a": 1})
    assert [file.name for file in elsewhere.iterdir()] == ["mine.npy"]


@pytest.mark.skipif(sys.platform == "win32", reason="links need a right there")
def test_a_lock_that_is_a_link_does_not_empty_a_file(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("secret")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / ".lock").symlink_to(tmp_path / "mine.txt")
    with pytest.raises(InputError, match="found a link"):
        FolderLock(tmp_path / "out")
    assert (tmp_path / "mine.txt").read_text() == "secret"


def test_a_file_in_the_place_of_the_folder_of_a_study_is_named(tmp_path: Path) -> None:
    (tmp_path / ".work").write_text("x")
    with pytest.raises(InputError, match=r"\.work: found a file, expected a folder of Mascarin; remove"):
        Workspace(tmp_path, {"study": "a"})


def test_a_damaged_manifest_of_a_study_is_computed_again(tmp_path: Path) -> None:
    with Workspace(tmp_path, {"a": 1}):
        pass
    for damaged in ("", "[]", "[" * 99_999, "null", "{"):
        (tmp_path / ".work" / "manifest.json").write_text(damaged)
        with pytest.warns(UserWarning, match="computed again"), Workspace(tmp_path, {"a": 1}):
            pass


@pytest.mark.parametrize("text", ["1" + "0" * 400, "-1" + "0" * 400, "[1" + "0" * 301 + "]"])
def test_a_whole_number_that_is_no_float_is_damage(text: str) -> None:
    with pytest.raises(own_files.DamagedError, match="digits"):
        own_files.json_of(text)
    assert own_files.json_of("1" + "0" * 300) == 10**300
