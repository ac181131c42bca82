"""The examples of docs/extending.md, followed step by step on a copy of the package."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from guide_steps import applied, steps_of

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package with every step of the page; the folder to import from."""
    root = tmp_path_factory.mktemp("extending")
    shutil.copytree(ROOT / "python" / "mascarin", root / "python" / "mascarin")
    for step in steps_of(PAGE):
        applied(step, root)
    return root / "python"


@pytest.mark.parametrize(
    ("section", "file"),
    [
        ("add a metric for criteria", "python/mascarin/validation/comparison.py"),
        ("add an object of EnergyPlus", "python/mascarin/energyplus/zones/gains.py"),
    ],
)
def test_one_file_is_touched(section: str, file: str) -> None:
    assert {step[2] for step in steps_of(PAGE, f"Example: {section}")} == {file}


def run(package: Path, *words: str) -> str:
    paths = [
        package,
        ROOT / "docs" / "site",
        ROOT / "tests" / "unit" / "energyplus",
        ROOT / "tests" / "support",
    ]
    done = subprocess.run(
        [sys.executable, *words],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_metric_and_object_work(package: Path, tmp_path: Path) -> None:
    said = run(package, str(ROOT / "tests" / "documents" / "guide_extending.py"), str(tmp_path))
    assert said.splitlines()[-1] == str(package / "mascarin")


def test_other_tests_hold_with_them(package: Path) -> None:
    """What knows of metrics and of classes agrees: criteria, the pages of keys, handlers, schemas."""
    files = [
        f"tests/{folder}/test_{name}.py"
        for folder, name in (
            ("unit/validation", "validation_criteria"),
            ("unit/validation", "validation_comparison"),
            ("documents", "docs_studies"),
            ("documents", "docs_reference"),
            ("unit/energyplus", "convert_handlers"),
        )
    ]
    run(package, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "0", *files)
