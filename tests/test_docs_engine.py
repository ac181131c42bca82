"""The examples of docs/engine.md, followed step by step on a copy of the engine."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "engine.md"

_STEP = re.compile(
    r"<!-- (new|before|replace|append): ([^\s:]+)(?:: (.*?))? -->\n```\w+\n(.*?)```\n", re.DOTALL
)
#: Tests inside of the engine, which run by themselves: here they would only be compiled once more.
_TESTS = re.compile(r"#\[cfg\(test\)\](?=\n(?:#\[.*\]\n)*mod \w*tests\b)")


def applied(step: re.Match[str], root: Path) -> Path:
    """Do one step of the page in a copy of the project; the file that it changes."""
    verb, place, anchor, text = step.groups()
    file = root / place
    if verb == "new":
        assert not file.exists()
        file.write_text(text, encoding="utf-8")
        return file
    before = file.read_text(encoding="utf-8")
    if verb == "append":
        file.write_text(before + text, encoding="utf-8")
        return file
    assert anchor in before, f"{place} has no '{anchor}'"
    if verb == "replace":
        file.write_text(before.replace(anchor, text.rstrip("\n"), 1), encoding="utf-8")
    else:
        at = before.rfind("\n", 0, before.index(anchor)) + 1
        file.write_text(before[:at] + text + before[at:], encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project in which every step of the page is done."""
    root = tmp_path_factory.mktemp("engine")
    for name in ("Cargo.toml", "Cargo.lock"):
        shutil.copy(ROOT / name, root / name)
    shutil.copytree(ROOT / "crates", root / "crates")
    shutil.copytree(ROOT / "python" / "mascarin", root / "python" / "mascarin")
    steps = list(_STEP.finditer(PAGE.read_text(encoding="utf-8")))
    assert len(steps) >= 14
    done = {applied(step, root) for step in steps}
    for file in (root / "crates" / "engine" / "src").rglob("*.rs"):
        if file not in done:
            text = file.read_text(encoding="utf-8")
            file.write_text(_TESTS.sub("#[cfg(any())]", text), encoding="utf-8")
    return root


def test_a_law_and_an_output_are_added_by_the_page(copy: Path) -> None:
    cargo = shutil.which("cargo")
    assert cargo is not None
    # Unoptimised and without debug information: what counts is that it compiles and that both tests pass.
    environment = {
        **os.environ,
        "CARGO_TARGET_DIR": str(ROOT / "target" / "guide"),
        "CARGO_PROFILE_DEV_DEBUG": "0",
        "RUST_MIN_STACK": str(256 << 20),
    }
    command = [cargo, "test", "--package", "mascarin-engine", "--lib", "--locked", "--offline", "--"]
    command += ["khalifa_by_hand", "heat_content_of_air"]
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


def test_the_law_is_known_to_the_description_language(copy: Path) -> None:
    code = (
        "from pydantic import TypeAdapter\n"
        "from mascarin.building.convection import SOURCES, Convection, Khalifa\n"
        "law = TypeAdapter(Convection).validate_python({'kind': 'khalifa'})\n"
        "assert isinstance(law, Khalifa) and 'khalifa' in SOURCES\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(copy / "python")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
