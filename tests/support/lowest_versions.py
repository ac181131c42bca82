"""Print the lowest declared version of each dependency, and what the tests need: for ``make test-lowest``."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

from packaging.requirements import Requirement

#: What the tests import beside the package.
TESTS = [
    "fmpy",
    "hypothesis",
    "ipykernel",
    "jsonschema",
    "nbclient",
    "nbformat",
    "numpydoc",
    "pytest",
    "pytest-xdist",
]


def lowest(text: str) -> str:
    """Requirement that pins the lower bound of another."""
    requirement = Requirement(text)
    bounds = [bound.version for bound in requirement.specifier if bound.operator == ">="]
    return f"{requirement.name}=={bounds[0]}"


def main(file: Path) -> None:
    """Print one requirement a line."""
    project = tomllib.loads(file.read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    texts = [
        *project["dependencies"],
        *(t for name in sorted(extras) if name not in ("dev", "docs") for t in extras[name]),
    ]
    sys.stdout.write("\n".join(sorted({lowest(text) for text in texts}) + TESTS) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
