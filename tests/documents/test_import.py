from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import mascarin

HEAVY = ["matplotlib", "numpy", "pandas", "pvlib", "pydantic", "ruamel.yaml", "scipy", "xarray"]


def loaded_after(code: str) -> list[str]:
    """Heavy modules that are loaded once `code` has run in a fresh interpreter."""
    script = f"{code}\nimport json, sys\nprint(json.dumps([m for m in {HEAVY!r} if m in sys.modules]))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    found: list[str] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_import_is_light() -> None:
    assert loaded_after("import mascarin") == []


def test_import_of_simulation_and_ensemble_is_light() -> None:
    assert loaded_after("import mascarin.simulation, mascarin.ensemble") == []


def test_dir_lists_public_names_alone() -> None:
    packages = [getattr(mascarin, name) for name in dir(mascarin)]
    for module in (mascarin, *(package for package in packages if isinstance(package, ModuleType))):
        assert sorted(dir(module)) == sorted(module.__all__)
        assert not [name for name in dir(module) if name.startswith("_") and name != "__version__"]


@pytest.mark.parametrize("words", [["--help"], ["--version"]])
def test_command_line_starts_light(words: list[str]) -> None:
    assert loaded_after(f"import mascarin.cli; assert mascarin.cli.main({words!r}) == 0") == []


def test_a_run_needs_no_tables(tmp_path: Path) -> None:
    """They would take longer to import than the building to run."""
    box = Path(mascarin.__file__).parent / "examples" / "box.yaml"
    words = ["run", str(box), "--weather", "shipped:golden", "--start", "2001-07-01", "--end", "2001-07-02"]
    code = f"import mascarin.cli; assert mascarin.cli.main({words!r}) == 0"
    assert loaded_after(code) == ["numpy", "pydantic"]


def test_a_run_with_a_measured_table_needs_pandas_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What reading the table gave is kept."""
    monkeypatch.delenv("MASCARIN_CACHE")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    folder = Path(mascarin.__file__).parent / "examples" / "lgi"
    words = ["run", str(folder / "building.yaml"), "--weather", str(folder / "study.yaml")]
    words += ["--start", "2010-08-02", "--end", "2010-08-03"]
    code = f"import mascarin.cli; assert mascarin.cli.main({words!r}) == 0"
    assert "pandas" in loaded_after(code)
    assert loaded_after(code) == ["numpy", "pydantic"]


def test_a_run_to_a_file_needs_no_tables(tmp_path: Path) -> None:
    box = Path(mascarin.__file__).parent / "examples" / "box.yaml"
    words = ["run", str(box), "--weather", "shipped:golden", "--start", "2001-07-01", "--end", "2001-07-02"]
    words += ["-o", str(tmp_path / "run.nc")]
    code = f"import mascarin.cli; assert mascarin.cli.main({words!r}) == 0"
    assert loaded_after(code) == ["numpy", "pydantic"]


#: Modules of Mascarin that read calorimeter files, other readers of tables, pages and ensembles.
OTHER_MODULES = ["mascarin.materials.dsc", "mascarin.ensemble", "mascarin.pages", "mascarin.calibration"]


#: Parts of the shipped box.
BUILT = [
    "Building", "CloudFactor", "Constant", "Construction", "Exposure", "Infiltration", "Layer", "OffsetSky",
    "Radiosity", "Side", "Site", "Solid", "Surface", "Wind", "Zone",
]  # fmt: skip


def test_a_run_imports_and_builds_what_it_has() -> None:
    """Neither modules of other commands, nor validators of parts that the building does not have."""
    box = Path(mascarin.__file__).parent / "examples" / "box.yaml"
    words = ["run", str(box), "--weather", "shipped:golden", "--start", "2001-07-01", "--end", "2001-07-02"]
    script = f"""
import json, sys
import mascarin.cli
assert mascarin.cli.main({words!r}) == 0
from mascarin.building.base.part import Part
def classes(kind):
    return {{kind, *(inner for below in kind.__subclasses__() for inner in classes(below))}}
built = sorted(kind.__name__ for kind in classes(Part) if kind.__pydantic_complete__)
print(json.dumps([built, [name for name in {OTHER_MODULES!r} if name in sys.modules]]))
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    built, modules = json.loads(done.stdout.splitlines()[-1])
    assert modules == []
    assert built == BUILT


@pytest.mark.parametrize("name", sorted(set(mascarin.__all__) - {"__version__"}))
def test_every_public_name_is_there_and_documented(name: str) -> None:
    value = getattr(mascarin, name)
    assert callable(value) or isinstance(value, ModuleType)
    assert value.__doc__
    assert name in dir(mascarin)


def test_no_package_has_the_name_of_a_public_function() -> None:
    packages = {path.parent.name for path in Path(mascarin.__file__).parent.glob("*/__init__.py")}
    functions = {name for name in mascarin.__all__ if not isinstance(getattr(mascarin, name), ModuleType)}
    assert not packages & functions


def test_unknown_name() -> None:
    with pytest.raises(AttributeError, match="No mascarin attribute nothing"):
        _ = mascarin.nothing  # type: ignore[attr-defined]
