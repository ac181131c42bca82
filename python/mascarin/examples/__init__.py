"""Buildings and studies that come with Mascarin."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from mascarin.errors import InputError, did_you_mean
from mascarin.examples.small import box as box
from mascarin.examples.small import box_climate as box_climate

FOLDER: Final = Path(__file__).parent
#: Studies by the name they are called with.
STUDIES: Final = {"wall-bench": FOLDER / "wall_bench" / "study.yaml", "lgi": FOLDER / "lgi" / "study.yaml"}


def locate(name: str) -> Path:
    """A study file, or a study that comes with Mascarin.

    Parameters
    ----------
    name : str
        Path of a file, or a key of `STUDIES`.

    Raises
    ------
    InputError
        It is neither.
    """
    path = Path(name)
    if path.is_file():
        return path
    if name in STUDIES:
        return STUDIES[name]
    if path.is_dir() and (path / "study.yaml").is_file():
        return path / "study.yaml"
    raise InputError(
        f"{name}: no such study file; expected a YAML file or one of {', '.join(STUDIES)}. "
        f"{did_you_mean(name, STUDIES)}".rstrip()
    )
