"""The room of SimQuality, 30 m3 with six surfaces, and its weather."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

#: Conductivity [W/(m K)], density [kg/m3] and specific heat [J/(kg K)].
_MATERIALS: Final = {
    "stone": (1.2, 2000, 1000),
    "insulation": (0.04, 50, 1000),
    "good_insulation": (0.02, 50, 1000),
    "board": (0.14, 800, 1500),
}
#: Area [m2], tilt and azimuth [deg].
SURFACES: Final = {
    "north": (6.0, 90, 0),
    "south": (6.0, 90, 180),
    "east": (15.0, 90, 90),
    "west": (15.0, 90, 270),
    "roof": (10.0, 0, 0),
    "floor": (10.0, 180, 0),
}
INSIDE_FILM: Final = 2.5
OUTSIDE_FILM: Final = 8.0
VOLUME: Final = 30.0
#: Columns of an EPW file.
_AIR, _GLOBAL, _DIRECT, _DIFFUSE = 6, 13, 14, 15

#: A layer: material and thickness [m]. A wall has its layers from outside to inside.
Layers = Sequence[tuple[str, float]]

INSULATED: Final[Layers] = (("board", 0.005), ("insulation", 0.1), ("stone", 0.2))
"""With the stone inside."""


def site() -> dict[str, Any]:
    """Potsdam."""
    return {
        "latitude": 52.383, "longitude": 13.067, "altitude": 0, "timezone": "UTC+1",
        "ground_reflectance": 0.2,
    }  # fmt: skip


def materials(*walls: Layers) -> Tree:
    """Describe the materials of some walls."""
    names = dict.fromkeys(name for layers in walls for name, _ in layers)
    keys = ("conductivity", "density", "specific_heat")
    return {name: dict(zip(keys, _MATERIALS[name], strict=True)) for name in names}


def construction(layers: Layers) -> Tree:
    """Describe the layers of a wall."""
    return {"layers": [{"material": name, "thickness": thickness} for name, thickness in layers]}


def outdoors(absorptance: float = 0.0) -> Tree:
    """The side of a wall that looks outdoors; there is no long-wave exchange in the suite."""
    return {
        "outdoors": True,
        "convection": OUTSIDE_FILM,
        "emissivity": 0.9,
        "absorptance": absorptance,
        "longwave": "none",
    }


def indoors(zone: str) -> Tree:
    """The side of a wall that looks into a room."""
    return {"zone": zone, "convection": INSIDE_FILM, "emissivity": 0.9, "absorptance": 1.0}


def room(
    layers: Layers,
    *,
    absorptance: float = 0.0,
    volume: float = VOLUME,
    zone: Mapping[str, Any] | None = None,
    **more: Any,
) -> Tree:
    """Describe a room whose six surfaces have the same layers.

    Parameters
    ----------
    layers : sequence of (str, float)
        From outside to inside.
    absorptance : float
        For sun, outside. [-]
    volume : float
        [m3]
    zone : mapping, optional
        More keys of the room.
    **more
        More sections of the description.
    """
    surfaces = {
        name: {
            "construction": "wall",
            "area": area,
            "tilt": tilt,
            "azimuth": azimuth,
            "outside": outdoors(absorptance),
            "inside": indoors("room"),
        }
        for name, (area, tilt, azimuth) in SURFACES.items()
    }
    return {
        "name": "simquality",
        "site": site(),
        "materials": materials(layers),
        "constructions": {"wall": construction(layers)},
        "zones": {"room": {"volume": volume, "longwave": "none", **(zone or {})}},
        "surfaces": surfaces,
        **more,
    }


def epw(data: CaseData, name: str) -> Array:
    """Hourly air temperature [degC], global, direct and diffuse irradiance [W/m2] of an EPW file, (n, 4)."""
    rows = data.text(f"{name}.epw").splitlines()[8:]
    columns = (_AIR, _GLOBAL, _DIRECT, _DIFFUSE)
    return np.loadtxt(io.StringIO("\n".join(rows)), delimiter=",", usecols=columns, ndmin=2)


def air_alone(temperatures: Array, hours: int) -> Climate:
    """Weather with nothing but the temperature of the air; a row is the value at the end of its hour."""
    rows = temperatures[: hours + 3]
    return CasePlace().climate({"air_temperature": np.r_[rows[0], rows]})


def with_sun(table: Array, hours: int = 8760) -> Climate:
    """Weather with sun; radiation is a mean over the hour of its row."""
    air, total, direct, diffuse = table[:hours].T
    return CasePlace().climate(
        {
            "air_temperature": air,
            "direct_normal": direct,
            "diffuse_horizontal": diffuse,
            "global_horizontal": total,
        }
    )
