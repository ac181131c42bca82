from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

import mascarin

# Where the name to import is not the name to install.
IMPORT_NAMES = {
    "lazy-loader": "lazy_loader",
    "pillow": "PIL",
    "pydantic-core": "pydantic_core",
    "PyYAML": "yaml",
    "ruamel.yaml": "ruamel",
}
# Not imported by us: the time zones of systems without their own, and the NetCDF engine behind xarray.
USED_BY_NAME = {"tzdata", "h5netcdf"}


@pytest.fixture(scope="module")
def project(repository: Path) -> dict[str, Any]:
    table = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))
    section: dict[str, Any] = table["project"]
    return section


@pytest.fixture(scope="module")
def pinned(repository: Path) -> dict[str, Version]:
    lines = (repository / "constraints.txt").read_text(encoding="utf-8").split()
    pairs = [line.split("==") for line in lines]
    return {canonicalize_name(name): Version(version) for name, version in pairs}


def test_versions_agree(project: dict[str, Any], repository: Path) -> None:
    cargo = tomllib.loads((repository / "Cargo.toml").read_text(encoding="utf-8"))
    citation = (repository / "CITATION.cff").read_text(encoding="utf-8")
    assert "version" in project["dynamic"]  # maturin takes that of Cargo.toml
    assert cargo["workspace"]["package"]["version"] == mascarin.__version__
    assert f"\nversion: {mascarin.__version__}\n" in citation
    assert mascarin.__version__ in (repository / "CHANGELOG.md").read_text(encoding="utf-8")


def test_every_dependency_is_pinned_within_its_bounds(
    project: dict[str, Any], pinned: dict[str, Version]
) -> None:
    extras = [text for texts in project["optional-dependencies"].values() for text in texts]
    for text in [*project["dependencies"], *extras]:
        requirement = Requirement(text)
        version = pinned[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version), f"{text}: pinned at {version}"


def test_the_engine_is_measured_with_the_crates_it_is_shipped_with(repository: Path) -> None:
    shipped, measured = (
        {one["name"]: one["version"] for one in tomllib.loads(file.read_text(encoding="utf-8"))["package"]}
        for file in (repository / "Cargo.lock", repository / "bench" / "engine" / "Cargo.lock")
    )
    common = shipped.keys() & measured.keys()
    assert {"mascarin-engine", "rayon", "serde_json"} <= common
    assert {name: shipped[name] for name in common} == {name: measured[name] for name in common}


def test_the_lock_has_the_same_versions_with_hashes(repository: Path) -> None:
    stated = (repository / "constraints.txt").read_text(encoding="utf-8").split()
    locked = re.split(r"\n(?! )", (repository / "constraints.lock").read_text(encoding="utf-8").strip())
    versions = {entry.split()[0].lower().replace("_", "-").replace(".", "-") for entry in locked}
    differences = versions ^ {line.lower().replace("_", "-").replace(".", "-") for line in stated}
    assert not differences, f"run `make lock`: {differences}"
    for entry in locked:
        hashes = re.findall(r"--hash=sha256:[0-9a-f]{64}\b", entry)
        assert hashes, f"{entry.split()[0]}: no hash; run `make lock`"


def test_constraints_hold_versions_only(repository: Path) -> None:
    for line in (repository / "constraints.txt").read_text(encoding="utf-8").splitlines():
        assert re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.]+", line), line


def imported_packages(repository: Path) -> set[str]:
    """Packages from elsewhere that the modules import, in functions and for types as well."""
    imported: set[str] = set()
    for path in (repository / "python" / "mascarin").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                imported.add(node.module.split(".")[0])
    return imported - sys.stdlib_module_names - {"mascarin"}


def names(texts: list[str]) -> set[str]:
    found = {Requirement(text).name for text in texts}
    return {IMPORT_NAMES.get(name, name) for name in found}


def test_what_is_imported_is_declared_and_the_reverse(project: dict[str, Any], repository: Path) -> None:
    imported = imported_packages(repository)
    extras = [t for name, texts in project["optional-dependencies"].items() if name != "dev" for t in texts]
    assert imported <= names(project["dependencies"] + extras)
    assert names(project["dependencies"]) - USED_BY_NAME <= imported


def test_every_dependency_has_its_reason(project: dict[str, Any], repository: Path) -> None:
    text = (repository / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("|")]
    extras = [t for name, texts in project["optional-dependencies"].items() if name != "dev" for t in texts]
    for dependency in project["dependencies"] + extras:
        name = Requirement(dependency).name
        assert any(re.search(rf"\b{re.escape(name)}\b", row) for row in rows), f"{name}: no reason"


def test_nothing_is_built_for_one_processor_only(repository: Path) -> None:
    """The same bits on every machine: no target-cpu in any build file."""
    files = [repository / "Cargo.toml", repository / "Makefile", *repository.glob(".cargo/*")]
    assert not [f for f in files if re.search(r"target-cpu\s*=", f.read_text(encoding="utf-8"))]


def test_the_conda_package_needs_what_the_wheel_needs(project: dict[str, Any], repository: Path) -> None:
    names_there = {"matplotlib": "matplotlib-base", "pvlib": "pvlib-python", "tzdata": "python-tzdata"}
    recipe = yaml.safe_load((repository / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8"))
    listed = {line.replace(" ", "") for line in recipe["requirements"]["run"]} - {"python>=3.11"}
    wanted = (Requirement(text) for text in project["dependencies"])
    assert listed == {names_there.get(one.name, one.name).lower() + str(one.specifier) for one in wanted}
    assert recipe["context"]["version"] == mascarin.__version__


def test_a_release_is_built_for_every_system_of_the_page(repository: Path) -> None:
    release = yaml.safe_load(
        (repository / ".github" / "workflows" / "release.yml").read_text(encoding="utf-8")
    )
    built = {one["target"] for one in release["jobs"]["wheels"]["strategy"]["matrix"]["include"]}
    assert built == {"x86_64", "aarch64", "aarch64-apple-darwin", "x86_64-apple-darwin", "x64"}
    publish = release["jobs"]["publish"]
    assert publish["permissions"] == {"id-token": "write", "attestations": "write", "contents": "read"}
    assert set(publish["needs"]) == {"tests", "wheels", "sdist"}


def test_the_tests_run_on_every_version_of_python_that_is_declared(
    project: dict[str, Any], repository: Path
) -> None:
    tests = yaml.safe_load((repository / ".github" / "workflows" / "test.yml").read_text(encoding="utf-8"))
    declared = {text.rpartition(" ")[2] for text in project["classifiers"] if re.search(r":: 3\.\d+$", text)}
    assert set(tests["jobs"]["tests"]["strategy"]["matrix"]["python"]) == declared


def test_workflows_pin_actions_by_commit(repository: Path) -> None:
    uses = [
        line.split("uses:", 1)[1].strip()
        for path in sorted((repository / ".github" / "workflows").glob("*.yml"))
        for line in path.read_text(encoding="utf-8").splitlines()
        if "uses:" in line
    ]
    assert len(uses) > 10
    floating = [
        action
        for action in uses
        if not action.startswith("./") and not re.fullmatch(r"\S+@[0-9a-f]{40} # v\d+\.\d+\.\d+", action)
    ]
    assert floating == []


def test_a_release_waits_for_the_tests(repository: Path) -> None:
    folder = repository / ".github" / "workflows"
    release = yaml.safe_load((folder / "release.yml").read_text(encoding="utf-8"))["jobs"]
    assert release["tests"]["uses"] == "./.github/workflows/test.yml"
    tests = yaml.safe_load((folder / "test.yml").read_text(encoding="utf-8"))
    assert "workflow_call" in tests[True]  # YAML reads `on` as true


def test_forms_of_the_repository_are_valid(repository: Path) -> None:
    for path in sorted((repository / ".github" / "ISSUE_TEMPLATE").glob("*.yml")):
        form = yaml.safe_load(path.read_text(encoding="utf-8"))
        for item in form.get("body", []):
            assert item["type"] in {"markdown", "textarea", "input", "dropdown", "checkboxes"}, path.name
            assert item["attributes"]["label"], path.name
    for page in ("CODE_OF_CONDUCT.md", "SECURITY.md", "SUPPORT.md", "RELEASING.md", "CONTRIBUTING.md"):
        for link in re.findall(r"\]\(([^)#]+)", (repository / page).read_text(encoding="utf-8")):
            assert link.startswith("https://") or (repository / link).exists(), (page, link)


def test_licences_of_all_crates_travel_with_the_library(repository: Path) -> None:
    command = [sys.executable, "packaging/licenses.py", "--check"]
    answer = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    texts = ["LICENSE", "python/mascarin/LICENSES.txt"]
    texts += [str(path.relative_to(repository)) for path in repository.glob("python/mascarin/**/*.LICENSE")]
    project = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    text = (repository / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    recipe = yaml.safe_load(re.sub(r"\$\{\{.*?\}\}", "x", text))
    assert sorted(project["license-files"]) == sorted(texts)
    assert sorted(recipe["about"]["license_file"]) == sorted(texts)


def test_licences_of_all_crates_may_stand_in_this_library(repository: Path) -> None:
    allowed = set(tomllib.loads((repository / "deny.toml").read_text(encoding="utf-8"))["licenses"]["allow"])
    lines = (repository / "python/mascarin/LICENSES.txt").read_text(encoding="utf-8").splitlines()
    rule = "=" * 78
    titles = [lines[row + 1] for row in range(len(lines) - 2) if lines[row] == lines[row + 2] == rule]
    assert len(titles) > 20
    for title in titles:
        expression = title.split(" (", 1)[1].removesuffix(")")
        for alternatives in re.split(r"\bAND\b", expression):
            names = set(re.split(r"\bOR\b|/", alternatives.strip("() ")))
            assert {name.strip() for name in names} & allowed, title


def test_the_paper_cites_what_its_references_list(repository: Path) -> None:
    text = (repository / "paper/paper.md").read_text(encoding="utf-8")
    references = (repository / "paper/paper.bib").read_text(encoding="utf-8")
    listed = re.findall(r"^@\w+\{(\w+),", references, flags=re.MULTILINE)
    assert len(listed) == len(set(listed))
    assert set(re.findall(r"@(\w+\d{4}|slPCMlib|corrai)\b", text)) == set(listed)
    for picture in re.findall(r"\]\((\S+?\.png)\)", text):
        assert (repository / "paper" / picture).is_file()
    # A paper of that journal has 750 to 1750 words.
    assert 750 <= len(text.split()) <= 1750


def test_long_files_of_tests_exist_and_begin_first(repository: Path) -> None:
    files = {path.name for path in (repository / "tests").rglob("test_*.py")}
    text = (repository / "tests" / "conftest.py").read_text(encoding="utf-8")
    long = re.findall(r'"(test_\w+\.py)"', text.partition("LONG = (")[2].partition(")")[0])
    assert len(long) > 3
    assert set(long) <= files
    for name in ("Makefile", ".github/workflows/test.yml"):
        runs = (repository / name).read_text(encoding="utf-8").count("--dist=loadfile")
        assert (
            runs
            == (repository / name).read_text(encoding="utf-8").count("loadfile --no-loadscope-reorder")
            > 0
        )
