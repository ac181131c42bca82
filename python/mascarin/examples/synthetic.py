"""A wall with synthetic measurements, for examples and first trials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.weather import Climate, Measurements

_DESCRIPTION: Final[dict[str, Any]] = {
    "name": "Synthetic wall",
    "site": {"latitude": 45.0, "longitude": 5.0, "altitude": 200.0, "timezone": "UTC+1"},
    "materials": {
        "insulation": {
            "conductivity": {"value": 0.04, "range": [0.02, 0.06]}, "density": 30.0, "specific_heat": 1400.0,
        },
        "brick": {
            "conductivity": {"value": 0.6, "range": [0.3, 1.2]}, "density": 1700.0, "specific_heat": 850.0,
        },
    },
    "constructions": {
        "wall": {
            "layers": [
                {"material": "insulation", "thickness": 0.06}, {"material": "brick", "thickness": 0.12},
            ]
        }
    },
    "surfaces": {
        "wall": {
            "construction": "wall", "area": 4.0, "tilt": 90.0, "azimuth": 180.0,
            "outside": {
                "outdoors": True, "irradiance": "sun", "emissivity": 0.9,
                "absorptance": {"value": 0.5, "range": [0.2, 0.8]}, "convection": 15.0,
            },
            "inside": {"measured": "room", "convection": 8.0},
        }
    },
}  # fmt: skip
_TRUE: Final = {"materials.insulation.conductivity": 0.033, "surfaces.wall.outside.absorptance": 0.62}
_NOT_MEASURED: Final = (
    "wind_speed", "wind_direction", "dew_point", "global_horizontal", "diffuse_horizontal", "direct_normal",
)  # fmt: skip


@dataclass(frozen=True)
class SyntheticWall:
    """An insulated brick wall between outdoor air and a room, with synthetic measurements.

    Attributes
    ----------
    building : Building
        The wall as described. The conductivity of its insulation and its solar absorptance are wrong.
    climate : Climate
        Nine days of hourly weather.
    measurements : Measurements
        Columns ``room`` and ``sun``, which are boundary conditions, and ``joint``, the temperature between
        insulation and brick, computed with the true parameters, with noise of 0.05 K.
    table : pandas.DataFrame
        Both as a logger keeps them: hourly local stamps (UTC+1), and columns ``air``, ``sun``, ``room`` and
        ``joint``. [degC, W/m2]

    Examples
    --------
    >>> from mascarin.examples import synthetic_wall
    >>> wall = synthetic_wall()
    >>> wall.measurements.data.shape
    (216, 3)
    """

    building: Building
    climate: Climate
    measurements: Measurements
    table: pd.DataFrame


def synthetic_wall() -> SyntheticWall:
    """Make a wall with synthetic measurements.

    Returns
    -------
    SyntheticWall
        The same numbers at each call.

    Examples
    --------
    >>> from mascarin.examples import synthetic_wall
    >>> synthetic_wall().building.parameter("materials.insulation.conductivity").value
    0.04
    """
    # Heavy libraries, which are not needed to list the example studies.
    import numpy as np

    from mascarin.building import Building
    from mascarin.simulation.simulation import Simulation
    from mascarin.weather import Climate, Measurements

    building = Building.model_validate(_DESCRIPTION)
    table = _boundary_conditions()
    climate = Climate.from_table(
        table,
        timezone="UTC+1",
        columns={"air_temperature": "air"},
        absent=_NOT_MEASURED,
        latitude=45.0,
        longitude=5.0,
        altitude=200.0,
    )
    results = Simulation(
        building.replace(_TRUE),
        climate,
        step="1h",
        end=table.index[-1],
        outputs=["wall.interface_1_temperature"],
        measurements=Measurements.from_table(table, timezone="UTC+1"),
    ).run()
    noise = np.random.default_rng(1).normal(0.0, 0.05, len(table))
    table["joint"] = results.records[:, 0] + noise
    table = table.round(3)
    measurements = Measurements.from_table(table, timezone="UTC+1", columns=["room", "sun", "joint"])
    return SyntheticWall(building, climate, measurements, table)


def _boundary_conditions() -> pd.DataFrame:
    """Outdoor air [degC], solar irradiance on the wall [W/m2] and room air [degC] of days that differ."""
    import numpy as np
    import pandas as pd

    index = pd.date_range("2023-03-01", periods=216, freq="1h", name="time")
    hours = np.arange(216.0)
    clear = 0.55 + 0.45 * np.sin(1.7 * np.floor(hours / 24.0))
    table = pd.DataFrame(index=index)
    table["air"] = 8.0 + 2.5 * np.sin(hours / 31.0) + 5.0 * np.sin((hours - 9.0) * np.pi / 12.0)
    table["sun"] = np.maximum(np.sin((hours % 24.0 - 6.0) * np.pi / 12.0), 0.0) * 700.0 * clear
    table["room"] = 20.0 + 1.5 * np.sin((hours - 7.0) * np.pi / 12.0) + np.sin(hours / 17.0)
    return table
