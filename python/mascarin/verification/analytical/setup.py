"""Test setup of the cases: buildings from YAML text, boundary conditions as columns of a table.

The cases are simulated like the building of a user: YAML, model, climate from a table, simulation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.simulation.preparation.options import Scheme
    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

DAY: Final = 86400.0
HOUR: Final = 3600.0
START: Final = "2001-01-01"

SITE: Final = (
    "site: {latitude: 0, longitude: 0, altitude: 0, timezone: UTC, sky: {kind: offset, depression: 0}}\n"
)
"""A site without effect: sea level, sky as warm as the air."""

_CHANNELS: Final = (
    "air_temperature",
    "dew_point",
    "cloud_cover",
    "wind_speed",
    "wind_direction",
    "global_horizontal",
    "direct_normal",
    "diffuse_horizontal",
)


def times(length: float, interval: float) -> Array:
    """Return times from 0 to a length, both included, shape (n + 1,). [s]"""
    return interval * np.arange(round(length / interval) + 1, dtype=np.float64)


def climate(interval: float, columns: Mapping[str, Array | float]) -> Climate:
    """Make a climate from columns of instants; without a column: no wind, no sun, air of 20 degC.

    Parameters
    ----------
    interval : float
        Spacing of the stamps. [s]
    columns : mapping of str to ndarray or float
        Climate channels by their names; every other name is a measured column. [unit of each]

    Returns
    -------
    Climate
        As `Climate.from_table` gives it.
    """
    import pandas as pd

    from mascarin.weather import Climate

    channels = {"air_temperature": 20.0, **columns}
    count = max(len(np.atleast_1d(column)) for column in channels.values())
    index = pd.date_range(START, periods=count, freq=pd.Timedelta(seconds=interval), tz="UTC")
    absent = [name for name in ("dew_point", "wind_speed", "wind_direction") if name not in channels]
    sunny = "direct_normal" in channels
    return Climate.from_table(
        pd.DataFrame(
            {name: np.broadcast_to(np.asarray(c), count) for name, c in channels.items()}, index=index
        ),
        timezone="UTC",
        columns={name: name for name in channels if name in _CHANNELS},
        extra=[name for name in channels if name not in _CHANNELS],
        absent=absent if sunny else [*absent, "radiation"],
        instant=[name for name in channels if name in _CHANNELS],
    )


def building(text: str) -> Building:
    """Read a building from YAML text; without a site it gets one without effect."""
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from mascarin.building import load

    with TemporaryDirectory() as folder:
        file = Path(folder) / "case.yaml"
        file.write_text(text if "site:" in text else SITE + text, encoding="utf-8")
        return load(file)


def simulation(
    described: Building,
    weather: Climate,
    *,
    step: float,
    outputs: Sequence[str],
    initial: float,
    scheme: Scheme = "sdirk2",
    length: float | None = None,
) -> Simulation:
    """Prepare a simulation from one initial temperature, over the table or its first part. [s, degC]"""
    import pandas as pd

    from mascarin.simulation.simulation import Simulation

    # The last stamp is the end: the interval behind it is not simulated.
    end = weather.index[-1] if length is None else weather.index[0] + pd.Timedelta(seconds=length)
    return Simulation(
        described, weather, step=step, end=end, outputs=list(outputs), initial=initial, scheme=scheme
    )


def run(
    text: str,
    interval: float,
    columns: Mapping[str, Array | float],
    *,
    step: float,
    outputs: Sequence[str],
    initial: float = 20.0,
    scheme: Scheme = "sdirk2",
    length: float | None = None,
) -> Results:
    """Build and simulate; arguments as for `building`, `climate` and `simulation`."""
    prepared = simulation(
        building(text),
        climate(interval, columns),
        step=step,
        outputs=outputs,
        initial=initial,
        scheme=scheme,
        length=length,
    )
    return prepared.run()


def steady(value: float) -> Array:
    """Return a constant boundary condition: two stamps of one value. [any]"""
    return np.full(2, value)


def harmonic(series: Array, step: float, period: float) -> complex:
    """Fit the amplitude ``a`` of ``Im(a e^{i w t})`` to the last period of a series, without its drift.

    Parameters
    ----------
    series : ndarray, shape (n + 1,)
        Values from time 0 on.
    step : float
        Spacing. [s]
    period : float
        Period; a whole number of steps. [s]

    Returns
    -------
    complex
        Amplitude. [unit of the series]
    """
    count = round(period / step)
    t = step * np.arange(len(series) - count, len(series))
    w = 2.0 * np.pi / period
    basis = np.column_stack([np.ones(count), (t - t[0]) / period, np.sin(w * t), np.cos(w * t)])
    parts = np.linalg.lstsq(basis, series[-count:], rcond=None)[0]
    return complex(parts[2], parts[3])
