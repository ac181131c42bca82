"""The examples of docs/engine.md, followed step by step on a copy of the engine."""

from __future__ import annotations

import filecmp
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from guide_steps import applied, steps_of

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "engine.md"
TARGET = ROOT / "target" / "guide"

#: Tests inside of the engine, which run by themselves: here they would only be compiled once more.
_TESTS = re.compile(r"#\[cfg\(test\)\](?=\n(?:#\[.*\]\n)*mod \w*tests\b)")


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project in which every step of the page is done.

    It stays in the folder of the build, and only files with another content are written: where neither the
    engine nor the page has changed since the last time, nothing is compiled again.
    """
    root = tmp_path_factory.mktemp("engine")
    for name in ("Cargo.toml", "Cargo.lock"):
        shutil.copy(ROOT / name, root / name)
    for name in ("crates", "python/mascarin"):
        shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
    steps = steps_of(PAGE.read_text(encoding="utf-8"))
    assert len(steps) >= 3
    done = {applied(step, root) for step in steps}
    for file in (root / "crates" / "engine" / "src").rglob("*.rs"):
        if file not in done:
            text = file.read_text(encoding="utf-8")
            file.write_text(_TESTS.sub("#[cfg(any())]", text), encoding="utf-8")
    return mirrored(root, TARGET / "copy")


def mirrored(new: Path, folder: Path) -> Path:
    """Give a folder the files of another one; those with the same content keep their time."""
    wanted_files = {path.relative_to(new) for path in new.rglob("*") if path.is_file()}
    for path in folder.rglob("*"):
        if path.is_file() and path.relative_to(folder) not in wanted_files:
            path.unlink()
    for name in sorted(wanted_files):
        path = folder / name
        if not path.exists() or not filecmp.cmp(new / name, path, shallow=False):
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(new / name, path)
    return folder


def test_a_mirror_writes_only_what_differs(tmp_path: Path) -> None:
    new, folder = tmp_path / "new", tmp_path / "folder"
    (new / "src").mkdir(parents=True)
    (new / "src" / "same.rs").write_text("a", encoding="utf-8")
    (new / "src" / "other.rs").write_text("b", encoding="utf-8")
    mirrored(new, folder)
    os.utime(folder / "src" / "same.rs", (1.0, 1.0))
    (folder / "src" / "gone.rs").write_text("c", encoding="utf-8")
    (new / "src" / "other.rs").write_text("B", encoding="utf-8")  # of the same length
    mirrored(new, folder)
    assert {path.name: path.read_text(encoding="utf-8") for path in (folder / "src").iterdir()} == {
        "same.rs": "a", "other.rs": "B",
    }  # fmt: skip
    assert (folder / "src" / "same.rs").stat().st_mtime == 1.0


def cargo(copy: Path, *words: str, **settings: str) -> str:
    """What cargo prints in the copy."""
    program = shutil.which("cargo")
    assert program is not None
    environment = {
        **os.environ,
        "CARGO_TARGET_DIR": str(TARGET),
        "CARGO_PROFILE_DEV_DEBUG": "0",
        "PYO3_PYTHON": sys.executable,
        "RUST_MIN_STACK": str(256 << 20),
        **settings,
    }
    command = [program, *words[:1], "--locked", "--offline", *words[1:]]
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_law_and_an_output_are_added_by_the_page(copy: Path) -> None:
    # Unoptimised and without debug information: what counts is that it compiles and that both tests pass.
    words = ("--package", "mascarin-engine", "--lib", "--", "khalifa_by_hand", "heat_content_of_air")
    assert "4 passed" in cargo(copy, "test", *words, "swinbank_by_hand", "unheated_by_hand")


def test_a_law_is_one_new_file() -> None:
    steps = steps_of(PAGE.read_text(encoding="utf-8"), "Example: add a convection law")
    laws = "crates/engine/src/physics/convection/laws"
    assert [(step[1], step[2]) for step in steps] == [("new", f"{laws}/khalifa.rs")]


def test_a_model_of_the_sky_is_one_new_file() -> None:
    steps = steps_of(PAGE.read_text(encoding="utf-8"), "Example: add a model of the sky")
    skies = "crates/engine/src/physics/longwave/skies"
    assert [(step[1], step[2]) for step in steps] == [("new", f"{skies}/swinbank.rs")]


def test_a_boundary_takes_at_most_four_files() -> None:
    steps = steps_of(PAGE.read_text(encoding="utf-8"), "Example: add a boundary of a side")
    files = {step[2] for step in steps}
    assert 0 < len(files) <= 4
    assert files == {"crates/engine/src/physics/imposed/laws/unheated.rs"}


def test_an_output_is_a_row_of_one_file() -> None:
    steps = steps_of(PAGE.read_text(encoding="utf-8"), "Example: add an output")
    assert {step[2] for step in steps} == {"crates/engine/src/run/outputs/mod.rs"}


@pytest.fixture(scope="module")
def package(copy: Path) -> Path:
    """The Python package of the copy with its engine; the folder to import from."""
    # A little optimised: unoptimised, a stage does not fit into the stack of Python's threads. Otherwise as
    # the library for a first try, which has less to compile.
    settings = {
        "OPT_LEVEL": "1",
        "CODEGEN_UNITS": "16",
        "DEBUG_ASSERTIONS": "false",
        "OVERFLOW_CHECKS": "false",
    }
    profile = {f"CARGO_PROFILE_DEV_{key}": value for key, value in settings.items()}
    cargo(copy, "build", "--package", "mascarin-python", "--no-default-features", **profile)
    library = next(
        TARGET / "debug" / name
        for name in ("lib_engine.so", "lib_engine.dylib", "_engine.dll")
        if (TARGET / "debug" / name).exists()
    )
    for old in (copy / "python" / "mascarin").glob("_engine.*[!i]"):
        old.unlink()
    name = "_engine.pyd" if library.suffix == ".dll" else "_engine.abi3.so"
    shutil.copy(library, copy / "python" / "mascarin" / name)
    return copy / "python"


def test_a_melting_law_with_a_state_takes_three_files() -> None:
    steps = steps_of(PAGE.read_text(encoding="utf-8"), "Example: add a melting law with a state")
    assert {step[2] for step in steps} == {
        "crates/engine/src/physics/pcm/history/delay.rs",
        "crates/engine/src/physics/pcm/history/mod.rs",
        "python/mascarin/building/parts/materials/history_laws.py",
    }


def followed(package: Path, script: str, folder: Path) -> None:
    """Run a program of the tests with the copy of the package."""
    paths = [package, ROOT / "docs" / "site", ROOT / "tests" / "support"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "documents" / script), str(folder)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))},
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines()[-1] == str(package / "mascarin")


def test_the_output_is_in_runs_derivatives_units_and_pages(package: Path, tmp_path: Path) -> None:
    followed(package, "guide_output.py", tmp_path)


def test_the_melting_law_is_in_runs_derivatives_units_and_pages(package: Path, tmp_path: Path) -> None:
    followed(package, "guide_melting.py", tmp_path)


def test_the_law_is_in_runs_derivatives_calibration_units_and_pages(package: Path, tmp_path: Path) -> None:
    followed(package, "guide_law.py", tmp_path)


def test_the_sky_is_in_runs_derivatives_calibration_units_and_pages(package: Path, tmp_path: Path) -> None:
    followed(package, "guide_sky.py", tmp_path)


def test_the_boundary_is_in_runs_derivatives_units_and_pages(package: Path, tmp_path: Path) -> None:
    followed(package, "guide_boundary.py", tmp_path)


def test_the_reference_of_the_copy_is_complete(package: Path) -> None:
    paths = [package, ROOT / "docs" / "site"]
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-q",
            "-p",
            "no:cacheprovider",
            "-n",
            "0",
            "tests/documents/test_docs_reference.py",
        ],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
