"""The LGI cell in a form that Mascarin, EnergyPlus and a hand-written program model in the same way.

Differences from the shipped example: constant surface heat transfer coefficients (each program has its own
correlations), ground of a constant temperature, one emissivity for both surfaces of the steel sheet, no
corrugation, one conductivity for solid and liquid, and infrared radiation of the sky given with the
weather. The weather is that of the shipped virtual experiment.
"""

from __future__ import annotations

import pandas as pd

import mascarin as mc
from mascarin.building import Building
from mascarin.examples import FOLDER
from mascarin.weather import Climate

SIGMA = 5.670374419e-8
SKY_EMISSIVITY = 0.85
START, END = "2010-08-01", "2010-11-01"
OUTPUTS = {
    "room air": "room.air_temperature",
    "plasterboard": "ceiling.inside_temperature",
    "PCM top": "ceiling.outside_temperature",
    "gap air": "air_gap.air_temperature",
    "steel": "roof.inside_temperature",
}
#: Surface heat transfer coefficients outside and inside [W/(m2 K)]: roof, ceiling and floor as in table 4 of
#: the paper before its identification (doi:10.3390/en9010009), the others assumed.
FILMS = {"roof": (25.0, 3.5), "ceiling": (1.0, 1.0), "floor": (None, 3.5)}
OTHER_FILMS = (15.0, 3.0)


def building() -> Building:
    """The cell."""
    cell = mc.load(FOLDER / "lgi" / "building.yaml")
    changes: dict[str, object] = {
        "site.sky": {"kind": "measured"},
        "surfaces.floor.outside": {"ground": {"mean": 22.5}},
        "surfaces.roof.inside.emissivity": 0.9,
        "surfaces.roof.outside.area_factor": 1.0,
        "surfaces.roof.inside.area_factor": 1.0,
        "materials.energain.conductivity": 0.2,
    }
    for name in cell.surfaces:
        outside, inside = FILMS.get(name, OTHER_FILMS)
        if outside is not None:
            changes[f"surfaces.{name}.outside.convection"] = outside
        changes[f"surfaces.{name}.inside.convection"] = inside
    return cell.replace(changes)


def table() -> pd.DataFrame:
    """The weather, every quarter of an hour, with the sky's infrared [W/m2]."""
    read = pd.read_csv(FOLDER / "lgi" / "lgi_virtual.csv", parse_dates=["time"]).set_index("time")
    read["infrared"] = SKY_EMISSIVITY * SIGMA * (read["outdoor_air"] + 273.15) ** 4
    return read


def climate(weather: pd.DataFrame) -> Climate:
    """The weather as a climate of Mascarin."""
    columns = {
        "air_temperature": "outdoor_air",
        **{
            name: name
            for name in (
                "relative_humidity", "wind_speed", "wind_direction", "pressure", "infrared",
                "global_horizontal", "diffuse_horizontal",
            )
        },
    }  # fmt: skip
    return Climate.from_table(weather.reset_index(), timezone="UTC+4", columns=columns, time="time")
