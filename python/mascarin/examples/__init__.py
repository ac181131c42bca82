"""Example buildings and studies."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from mascarin.errors import InputError, did_you_mean
from mascarin.examples.clear import clear_days
from mascarin.examples.small import box, box_climate
from mascarin.examples.synthetic import SyntheticWall, synthetic_wall

__all__ = [
    "DESIGNS",
    "FOLDER",
    "STUDIES",
    "SyntheticWall",
    "box",
    "box_climate",
    "clear_days",
    "locate",
    "locate_design",
    "synthetic_wall",
]

FOLDER: Final = Path(__file__).parent
#: Example studies by name.
STUDIES: Final = {
    "wall-bench": FOLDER / "wall_bench" / "study.yaml",
    "lgi": FOLDER / "lgi" / "study.yaml",
    "twin-house": FOLDER / "twin_house" / "study.yaml",
    "twin-house-n2": FOLDER / "twin_house" / "study_n2.yaml",
}

#: Example design studies by name.
DESIGNS: Final = {"reunion-house": FOLDER / "reunion_house" / "design.yaml"}


def locate(name: str) -> Path:
    """Find a study file, or an example study by its name.

    Parameters
    ----------
    name : str
        Path of a file or of a folder with ``study.yaml``, or a key of `STUDIES`.

    Returns
    -------
    Path
        The study file.

    Raises
    ------
    InputError
        There is no such file and no such example.

    Examples
    --------
    >>> from mascarin.examples import locate
    >>> locate("lgi").name
    'study.yaml'
    """
    return _found(name, "study", STUDIES)


def locate_design(name: str) -> Path:
    """Find a design file, or an example by its name.

    Parameters
    ----------
    name : str
        Path of a file or of a folder with ``design.yaml``, or a key of `DESIGNS`.

    Returns
    -------
    Path
        The design file.

    Raises
    ------
    InputError
        There is no such file and no such example.

    Examples
    --------
    >>> from mascarin.examples import locate_design
    >>> locate_design("reunion-house").name
    'design.yaml'
    """
    return _found(name, "design", DESIGNS)


def _found(name: str, kind: str, examples: Mapping[str, Path]) -> Path:
    """A file, the file of this kind in a folder, or an example."""
    path = Path(name)
    if path.is_file():
        return path
    if name in examples:
        return examples[name]
    if path.is_dir() and (path / f"{kind}.yaml").is_file():
        return path / f"{kind}.yaml"
    raise InputError(
        f"{name}: found no {kind} file, expected a YAML file or the name of an example. "
        f"{did_you_mean(name, examples)}"
    )


def __dir__() -> list[str]:
    return __all__
