"""A room of 27 m3 in Atlanta with one wall, and its weather."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

LATITUDE: Final = 33.77
LONGITUDE: Final = -84.42
INSIDE_FILM: Final = 3.076
CLOSED: Final = {"adiabatic": True}

#: A layer: thickness [m], conductivity [W/(m K)], density [kg/m3], specific heat [J/(kg K)].
Layers = Sequence[tuple[float, float, float, float]]


def outdoors(film: float, absorptance: float = 0.0, longwave: str | None = "none") -> Tree:
    """The side of a wall that looks outdoors."""
    side: Tree = {"outdoors": True, "convection": film, "emissivity": 0.9, "absorptance": absorptance}
    return side if longwave is None else side | {"longwave": longwave}


def indoors(film: float = INSIDE_FILM, emissivity: float = 0.9) -> Tree:
    """The side of a wall that looks into the room."""
    return {"zone": "room", "convection": film, "emissivity": emissivity}


def site(**more: Any) -> Tree:
    """Atlanta, with a black ground."""
    return {
        "latitude": LATITUDE, "longitude": LONGITUDE, "altitude": 0, "timezone": "UTC-5",
        "ground_reflectance": 0, "diffuse": "isotropic", **more,
    }  # fmt: skip


def room(
    layers: Layers,
    outside: Mapping[str, Any],
    inside: Mapping[str, Any],
    *,
    zone: Mapping[str, Any] | None = None,
    keys_of_site: Mapping[str, Any] | None = None,
    area: float = 9.0,
    tilt: float = 90.0,
    azimuth: float = 0.0,
    vertices: Sequence[Sequence[float]] | None = None,
    **more: Any,
) -> Tree:
    """Describe a room with one wall.

    Parameters
    ----------
    layers : sequence
        From outside to inside.
    outside, inside : mapping
        Sides of the wall. A second wall faces the room where this one does not.
    zone, keys_of_site : mapping, optional
        More keys of the zone and of the site.
    area, tilt, azimuth : float
        Of the wall, where it has no vertices. [m2], [deg]
    vertices : sequence, optional
        Corners of the wall. [m]
    **more
        More sections of the description.
    """
    names = [f"layer{number}" for number in range(len(layers))]
    keys = ("conductivity", "density", "specific_heat")
    materials = {
        name: dict(zip(keys, layer[1:], strict=True)) for name, layer in zip(names, layers, strict=True)
    }
    built = [{"material": name, "thickness": layer[0]} for name, layer in zip(names, layers, strict=True)]
    face: Tree = {"area": area, "tilt": tilt, "azimuth": azimuth}
    if vertices is not None:
        face = {"vertices": [list(map(float, corner)) for corner in vertices]}
    surfaces = {"wall": {"construction": "wall", **face, "outside": outside, "inside": inside}}
    if "zone" not in inside:
        other = {"construction": "wall", "area": 1, "tilt": 90, "azimuth": 0}
        surfaces["other"] = {**other, "outside": CLOSED, "inside": indoors(1.0)}
    return {
        "name": "room",
        "site": site(**(keys_of_site or {})),
        "materials": materials,
        "constructions": {"wall": {"layers": built}},
        "zones": {"room": {"volume": 27, "longwave": "none", **(zone or {})}},
        "surfaces": surfaces,
        **more,
    }


def weather(columns: Mapping[str, Array], *, extra: Sequence[str] = (), step: str = "1h") -> Climate:
    """Make weather of arrays; it begins on 21 August."""
    return CasePlace(LATITUDE, LONGITUDE, "Etc/GMT+5", "2001-08-21", step).climate(columns, extra=extra)


def steady_air(temperature: float, hours: int = 60) -> Climate:
    """Weather of one temperature. [degC]"""
    return weather({"air_temperature": np.full(hours, temperature)})


def rows(data: CaseData, name: str) -> list[list[str]]:
    """Cells of a table."""
    return list(csv.reader(io.StringIO(data.text(f"{name}.csv"))))


def numbers(data: CaseData, name: str, columns: Sequence[int], needed: int) -> Array:
    """Rows of a table whose first `needed` columns are numbers; NaN where a further cell is none."""
    table = []
    for row in rows(data, name):
        cells = [number(row[column]) if column < len(row) else float("nan") for column in columns]
        if np.isfinite(cells[:needed]).all():
            table.append(cells)
    return np.array(table)


def number(cell: str) -> float:
    """Value of a cell; NaN for words."""
    try:
        return float(cell)
    except ValueError:
        return float("nan")
