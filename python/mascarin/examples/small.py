"""A box and three days of weather, small enough for the examples in docstrings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate

BOX: Final = Path(__file__).parent / "box.yaml"


def box() -> Building:
    """A concrete box with one zone, ``room``, and one surface, ``facade``.

    Examples
    --------
    >>> list(box().zones)
    ['room']
    """
    from mascarin.building import load  # pydantic, not needed to list the studies

    return load(BOX)


def box_climate() -> Climate:
    """Three clear days in summer at 40 degrees north, every hour.

    Examples
    --------
    >>> len(box_climate().index)
    72
    """
    import numpy as np
    import pandas as pd

    from mascarin.weather import Climate

    hours = np.arange(72)
    day = 2.0 * np.pi * hours / 24.0
    light = np.maximum(-np.cos(day), 0.0)
    table = pd.DataFrame(
        {
            "air_temperature": 22.0 - 6.0 * np.cos(day - 0.6),
            "dew_point": 10.0,
            "wind_speed": 2.0,
            "wind_direction": 200.0,
            "direct_normal": 700.0 * light,
            "diffuse_horizontal": 120.0 * light,
        },
        index=pd.date_range("2001-07-01", periods=72, freq="1h", tz="UTC-07:00"),
    )
    names = list(table.columns)
    return Climate.from_table(
        table, timezone="UTC-07:00", columns={name: name for name in names}, instant=names, check_sun=False
    )
