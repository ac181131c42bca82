"""Read a building from YAML."""

from __future__ import annotations

from pathlib import Path

from mascarin.building.base.error_texts import explained
from mascarin.building.building import Building
from mascarin.building.files.inheritance import Inherited, over
from mascarin.building.files.yaml_document import files_of, lines, merged, parse_as, plain, read

__all__ = [
    "Inherited",
    "explained",
    "files_of",
    "lines",
    "load",
    "merged",
    "over",
    "parse",
    "parse_as",
    "plain",
    "read",
]


def load(path: str | Path) -> Building:
    """Read a building from a YAML file; the same as `Building.from_yaml`.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Building
        Checked and immutable.

    Raises
    ------
    InputError
        If the file cannot be read or its description has errors. The text names each error by file, line and
        path, with what was found, what was expected and what to do.

    Examples
    --------
    >>> import tempfile
    >>> from mascarin.building import load
    >>> file = Path(tempfile.mkdtemp()) / "wall.yaml"
    >>> size = file.write_text('''
    ... site: {latitude: 48, longitude: 2, altitude: 100, timezone: Europe/Paris}
    ... materials: {concrete: {conductivity: 1.75, density: 2240, specific_heat: 900}}
    ... constructions: {wall: {layers: [{material: concrete, thickness: 0.2}]}}
    ... surfaces:
    ...   wall: {construction: wall, area: 16, tilt: 90, outside: {measured: T_1}, inside: {measured: T_2}}
    ... ''')
    >>> list(load(file).surfaces)
    ['wall']
    """
    return Building.from_yaml(path)


def parse(text: str, name: str) -> Building:
    """Read a building from YAML text.

    Parameters
    ----------
    text : str
        The text.
    name : str
        Name of the file in messages.

    Returns
    -------
    Building
        Checked and immutable.
    """
    return parse_as(Building, text, name, blanks=False)
