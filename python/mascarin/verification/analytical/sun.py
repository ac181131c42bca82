"""The sun: irradiance on inclined planes and position, compared with pvlib."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from mascarin.verification.analytical import setup
from mascarin.verification.analytical.check import Case, Check

_PLANES: Final = ((0.0, 0.0), (20.0, 0.0), (90.0, 90.0), (90.0, 180.0), (60.0, 300.0), (180.0, 0.0))
_MODELS: Final = {"isotropic": "isotropic", "hay_davies": "haydavies", "perez": "perez"}
_ALBEDO: Final = 0.2
#: The irradiance follows from a balance of fluxes below 2000 W/m2 with temperatures known to 1e-6 K.
IRRADIANCE_ERROR: Final = 1e-4


def _weather(days: int) -> dict[str, setup.Array]:
    """Radiation of days with varying clearness at the place of the case, every 10 min."""
    import pandas as pd
    from pvlib import solarposition

    t = setup.times(days * setup.DAY, 600.0)
    stamps = pd.date_range(setup.START, periods=len(t), freq="10min", tz="UTC")
    zenith = solarposition.get_solarposition(stamps, *_LOCATION)["zenith"].to_numpy()
    height = np.maximum(np.cos(np.radians(zenith)), 0.0)
    clear = 0.5 + 0.5 * np.sin(2.0 * np.pi * t / (0.9 * setup.DAY))
    return {
        "direct_normal": 900.0 * clear * np.sqrt(height),
        "diffuse_horizontal": (250.0 - 170.0 * clear) * np.sqrt(height),
    }


_LOCATION: Final = (43.5, 1.5)


def _transposition(name: str) -> Iterator[Check]:
    from pvlib import atmosphere, irradiance

    from mascarin.weather import CHANNELS

    surfaces = "".join(
        f"  p{k}: {{construction: panel, area: 1, tilt: {tilt}, azimuth: {azimuth}, "
        "inside: {measured: behind}, "
        "outside: {outdoors: true, convection: 1, emissivity: 0.9, absorptance: 1, longwave: none}}\n"
        for k, (tilt, azimuth) in enumerate(_PLANES)
    )
    weather = setup.climate(600.0, {**_weather(4), "behind": 20.0})
    for model, pvlib_model in _MODELS.items():
        described = setup.building(
            f"site: {{latitude: {_LOCATION[0]}, longitude: {_LOCATION[1]}, altitude: 0, timezone: UTC, "
            f"diffuse: {model}, ground_reflectance: {_ALBEDO}, sky: {{kind: offset, depression: 0}}}}\n"
            "materials: {panel: {kind: resistance, resistance: 1}}\n"
            "constructions: {panel: {layers: [{material: panel}]}}\n"
            f"surfaces:\n{surfaces}"
        )
        outputs = [f"p{k}.outside_{what}" for k in range(len(_PLANES)) for what in ("flux", "temperature")]
        marched = setup.simulation(described, weather, step=900.0, outputs=outputs, initial=20.0)
        records = marched.run().records[1:]
        row = weather.forcing(described.site, marched.start, marched.end, 900.0, "sdirk2", ["behind"])[:, -1]
        channel = {quantity: row[:, k] for k, quantity in enumerate(CHANNELS)}
        zenith = np.degrees(np.arccos(np.clip(channel["sun_up"], -1.0, 1.0)))
        bearing = np.degrees(np.arctan2(channel["sun_east"], channel["sun_north"])) % 360.0
        worst = 0.0
        # pvlib's Perez model divides by the air mass, which has no value below the horizon.
        daytime = zenith < 89.9
        for k, (tilt, azimuth) in enumerate(_PLANES):
            flux, surface = records[:, 2 * k], records[:, 2 * k + 1]
            simulated = flux + (surface - channel["air_temperature"])  # a I + h (Ta - T) = q with a = h = 1
            extra = {} if model == "isotropic" else {"dni_extra": channel["direct_normal_extra"][daytime]}
            if model == "perez":
                extra["airmass"] = atmosphere.get_relative_airmass(zenith[daytime])
            expected = irradiance.get_total_irradiance(
                tilt, azimuth, zenith[daytime], bearing[daytime], channel["direct_normal"][daytime],
                channel["global_horizontal"][daytime], channel["diffuse_horizontal"][daytime],
                albedo=_ALBEDO, model=pvlib_model, **extra,
            )["poa_global"]  # fmt: skip
            worst = max(worst, float(np.max(np.abs(simulated[daytime] - np.asarray(expected)))))
        yield Check.most(
            name,
            f"{model}, largest difference on {len(_PLANES)} planes",
            "W/m2",
            worst,
            high=IRRADIANCE_ERROR,
        )


def _position(name: str) -> Iterator[Check]:
    import pandas as pd
    from pvlib import solarposition

    from mascarin.weather.derived.sun import SunPath

    locations = ((67.3, 14.4), (43.5, -1.5), (0.0, 0.0), (-21.3, 55.5), (-54.8, -68.3))
    days = pd.to_datetime(["2024-02-29", "2023-06-21", "2023-09-23", "2024-12-31"], utc=True)
    for latitude, longitude in locations:
        worst = 0.0
        for day in days:
            times = pd.date_range(day, periods=480, freq="197s")
            seconds = (times - pd.Timestamp(0, tz="UTC")).total_seconds().to_numpy(dtype=np.float64)
            simulated = SunPath.over(latitude, longitude, seconds[0], seconds[-1]).vector(seconds)
            reference = solarposition.get_solarposition(times, latitude, longitude)
            zenith, azimuth = (
                np.radians(reference["zenith"].to_numpy()),
                np.radians(reference["azimuth"].to_numpy()),
            )
            vector = np.stack(
                [np.sin(zenith) * np.sin(azimuth), np.sin(zenith) * np.cos(azimuth), np.cos(zenith)], axis=-1
            )
            apart = np.linalg.norm(simulated - vector, axis=-1)
            worst = max(worst, float(np.degrees(np.max(apart))))
        where = f"{abs(latitude):g} {'N' if latitude >= 0 else 'S'}"
        yield Check.most(name, f"largest angle to the sun of pvlib, {where}", "deg", worst, high=3e-4)


CASES: Final = (
    Case(
        name="transposition",
        problem="Six planes on four days of varying clearness at 43.5 N, every 15 min; the irradiance "
        "follows from the balance of fluxes of each plane.",
        answer="pvlib.irradiance.get_total_irradiance for the same sun and radiation, sun more than 0.1 "
        "deg above the horizon",
        source="Liu & Jordan 1963, Hay & Davies 1980, Perez et al. 1990 "
        "(doi:10.1016/0038-092X(90)90055-H) as in pvlib, doi:10.21105/joss.05994",
        tolerance="1e-4 W/m2: the surface temperatures of the balance are known to 1e-6 K.",
        topics=("building",),
        work=_transposition,
    ),
    Case(
        name="sun position",
        problem="Five latitudes from 67 N to 55 S on four days, including 29 February, every 197 s.",
        answer="pvlib.solarposition (SPA), without refraction",
        source="Reda & Andreas 2004, doi:10.1016/j.solener.2003.12.003",
        tolerance="0.0003 deg, the stated uncertainty of the algorithm.",
        topics=("building",),
        work=_position,
    ),
)
