"""The licence of Mascarin and those of the Rust crates inside of it, in wheel, source distribution and FMU.

``python packaging/licenses.py`` writes ``python/mascarin/LICENSES.txt`` anew; ``--check`` compares it with
``Cargo.lock`` instead, without a network and without the sources of the crates.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
TEXT = ROOT / "python/mascarin/LICENSES.txt"
#: The library of the wheel, and that of an FMU, which the wheel contains.
_PACKAGES = ("mascarin-python", "mascarin-fmu")
_TARGETS = ("x86_64-unknown-linux-gnu", "aarch64-apple-darwin", "x86_64-pc-windows-msvc")
_RULE = "=" * 78
_HEAD = """The licence of Mascarin stands first. Mascarin contains the Rust crates below in compiled
form. Each stands under the licence named beside it; its own copyright and licence files follow. The
scripts inside of pages have their licences beside them in the package.
Written by packaging/licenses.py from Cargo.lock.
"""


def crates() -> list[dict[str, Any]]:
    """Return the crates of others that are linked or generate code, as cargo describes them, by name."""
    packages: dict[str, dict[str, Any]] = {}
    for target in _TARGETS:
        metadata = _metadata(target)
        by_id = {package["id"]: package for package in metadata["packages"]}
        for identity in _linked(metadata, by_id):
            if by_id[identity]["source"]:
                packages[identity] = by_id[identity]
    return sorted(packages.values(), key=lambda package: (package["name"], package["version"]))


def _metadata(target: str) -> dict[str, Any]:
    command = ["cargo", "metadata", "--format-version=1", "--locked", f"--filter-platform={target}"]
    answer = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    metadata: dict[str, Any] = json.loads(answer.stdout)
    return metadata


def _linked(metadata: dict[str, Any], by_id: dict[str, dict[str, Any]]) -> set[str]:
    """Identities reached from the two libraries by normal dependencies."""
    dependencies = {
        node["id"]: [
            entry["pkg"] for entry in node["deps"] if any(kind["kind"] is None for kind in entry["dep_kinds"])
        ]
        for node in metadata["resolve"]["nodes"]
    }
    waiting = [identity for identity, package in by_id.items() if package["name"] in _PACKAGES]
    reached: set[str] = set()
    while waiting:
        identity = waiting.pop()
        if identity not in reached:
            reached.add(identity)
            waiting += dependencies[identity]
    return reached


def titles(packages: list[dict[str, Any]]) -> list[str]:
    """Return the line of each crate: name, version and licence expression."""
    return [f"{package['name']} {package['version']} ({package['license']})" for package in packages]


def _licence_files(package: dict[str, Any]) -> list[Path]:
    folder = Path(package["manifest_path"]).parent
    words = ("LICEN", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE")
    return sorted(path for path in folder.iterdir() if path.is_file() and path.name.upper().startswith(words))


def text(packages: list[dict[str, Any]]) -> str:
    """Return the whole text; a licence file that several crates share word by word stands once."""
    sections = [_HEAD, (ROOT / "LICENSE").read_text(encoding="utf-8")]
    first_holder: dict[str, str] = {}
    for title, package in zip(titles(packages), packages, strict=True):
        sections.append(f"{_RULE}\n{title}\n{_RULE}\n")
        for path in _licence_files(package):
            content = path.read_text(encoding="utf-8", errors="replace").strip()
            holder = first_holder.setdefault(content, f"{package['name']}, {path.name}")
            same = holder != f"{package['name']}, {path.name}"
            sections.append(f"{path.name}: the same text as that of {holder}\n" if same else f"{content}\n")
        if not _licence_files(package):
            sections.append(f"(no licence file; {package['repository']})\n")
    return "\n".join(sections)


def main() -> int:
    """Write the text, or check that it names exactly the crates of Cargo.lock."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    packages = crates()
    if not parser.parse_args().check:
        TEXT.write_text(text(packages), encoding="utf-8")
        return 0
    lines = TEXT.read_text(encoding="utf-8").splitlines()
    stated = [lines[row + 1] for row in range(len(lines) - 2) if lines[row] == lines[row + 2] == _RULE]
    differences = sorted(set(stated) ^ set(titles(packages)))
    if differences:
        print(
            f"error: {TEXT.name} and Cargo.lock differ in {', '.join(differences)}. "
            "Run `python packaging/licenses.py`.",
            file=sys.stderr,
        )
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
