"""Ten planes that look at the sky of six climates."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

#: Tilt and azimuth. [deg]
_PLANES: Final = {
    "Horizontal": (0, 0),
    "South 90": (90, 180),
    "East 90": (90, 90),
    "North 90": (90, 0),
    "West 90": (90, 270),
    "Southeast 90": (90, 135),
    "Southwest 90": (90, 225),
    "East 30": (30, 90),
    "South 30": (30, 180),
    "West 30": (30, 270),
}
#: Latitude and longitude [deg], altitude [m], time zone, reflectance of the ground [-].
_SITES: Final = {
    "WD100": (39.833, -104.65, 1650.0, "UTC-7", 0.0),
    "WD200": (33.633, -84.433, 308.0, "UTC-5", 0.0),
    "WD300": (-33.393, -70.786, 474.0, "UTC-4", 0.0),
    "WD400": (71.286, -156.767, 10.0, "UTC-9", 0.0),
    "WD500": (28.567, 77.103, 236.8, "Asia/Kolkata", 0.0),
    "WD600": (39.833, -104.65, 1650.0, "UTC-7", 0.2),
}
_PROGRAMS: Final = "ABCDEFGH"
#: Of the sum of the weather file on the horizontal plane. [-]
_OF_FILE: Final = 0.005


def tree(case: str) -> Tree:
    """Describe ten planes of one square metre."""
    latitude, longitude, altitude, timezone, reflectance = _SITES[case]
    outside = {"outdoors": True, "convection": 10, "emissivity": 0.9, "absorptance": 0.5}
    sides = {"outside": outside, "inside": {"zone": "room", "convection": 3, "emissivity": 0.9}}
    surfaces = {
        _key(plane): {"construction": "plate", "area": 1, "tilt": tilt, "azimuth": azimuth, **sides}
        for plane, (tilt, azimuth) in _PLANES.items()
    }
    return {
        "name": case,
        "site": {
            "latitude": latitude,
            "longitude": longitude,
            "altitude": altitude,
            "timezone": timezone,
            "ground_reflectance": reflectance,
        },
        "materials": {"plate": {"conductivity": 0.1, "density": 100, "specific_heat": 1000}},
        "constructions": {"plate": {"layers": [{"material": "plate", "thickness": 0.05}]}},
        "zones": {"room": {"volume": 10}},
        "surfaces": surfaces,
    }


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Irradiance of the year by climate and plane."""
    from mascarin.weather import Climate

    for case in _SITES:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"{case}.epw"
            file.write_text(data.text(f"{case}.epw"), encoding="utf-8")
            climate = Climate.from_epw(file)
        outputs = [f"{_key(plane)}.incident_solar" for plane in _PLANES]
        _, table = simulated(data.building(tree(case)), climate, outputs, "15min", 15.0)
        sums = table.iloc[1:].mean() * 8.760
        rows = _rows(data.text(f"annual_{case}_analysis.csv"))
        for plane in _PLANES:
            horizontal = plane == "Horizontal"
            name = "Total Horizontal Radiation" if horizontal else f"Total Radiation on {plane}"
            of_file, *programs = rows[f"Annual {name} Values"]
            peers = {p: 1e-3 * v for p, v in zip(_PROGRAMS, programs, strict=False) if np.isfinite(v)}
            value = float(sums[f"{_key(plane)}.incident_solar"])
            if horizontal:
                reference = 1e-3 * of_file
                limits = around(reference, _OF_FILE * reference)
            else:
                reference = float(np.median(list(peers.values())))
                limits = min(peers.values()), max(peers.values())
            yield VerdictLine(case, plane, "kWh/m2", value, reference, limits, {} if horizontal else peers)


def _key(plane: str) -> str:
    return plane.replace(" ", "_").lower()


def _rows(text: str) -> dict[str, list[float]]:
    """Numbers of each row: that of the weather file, then the programs; NaN where a program has none."""
    rows = {}
    for line in text.splitlines():
        name, *cells = line.split(",")
        rows[name.strip()] = [_number(cell) for cell in cells]
    return rows


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return float("nan")
