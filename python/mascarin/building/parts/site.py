"""The site: position, wind profile, sky, ground."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.law_classes import PublishedLaw, classes_of, union_of
from mascarin.building.base.law_table import DIFFUSE, SKY
from mascarin.building.base.number import Number, problem
from mascarin.building.base.part import Part, Shorthand, fault, refuse
from mascarin.building.parts.materials.text_law import TextSky
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic import ModelWrapValidatorHandler

ASHRAE_WIND = "ASHRAE Handbook of Fundamentals 2017, ch. 24, table 1"
MARTIN = "Martin & Berdahl 1984, doi:10.1016/0038-092X(84)90162-2"
CLARK = "Clark & Allen 1978, Proc. 2nd National Passive Solar Conference, Philadelphia"

#: The models that are used where none is given.
DEFAULT_SKY: Final = "martin_berdahl"
DEFAULT_DIFFUSE: Final = "perez"

#: Exponent and thickness [m] of the boundary layer over a kind of terrain.
TERRAINS = {"open": (0.14, 270.0), "suburb": (0.22, 370.0), "city": (0.33, 460.0), "sea": (0.10, 210.0)}


class Wind(Part):
    """Power-law profile of the wind speed, from the mast to a surface with a height.

    Examples
    --------
    >>> Wind(terrain="city")
    Wind(terrain=city, mast_height=10 m, mast_exponent=0.14, mast_layer=270 m, exponent=0.33, layer=...)
    """

    terrain: Literal["open", "suburb", "city", "sea"] = Field(
        "open", description="Terrain around the building: gives exponent and layer where they are not given"
    )
    mast_height: q.MastHeight = Number(10.0, source="WMO-No. 8: standard height of anemometers")
    mast_exponent: q.WindExponent = Number(0.14, source=f"{ASHRAE_WIND}: open terrain")
    mast_layer: q.BoundaryLayer = Number(270.0, source=f"{ASHRAE_WIND}: open terrain")
    exponent: q.WindExponent | None = None
    layer: q.BoundaryLayer | None = None

    @model_validator(mode="before")
    @classmethod
    def _by_terrain(cls, raw: Any) -> Any:
        if not isinstance(raw, dict) or str(raw.get("terrain", "open")) not in TERRAINS:
            return raw
        terrain = raw.get("terrain", "open")
        exponent, layer = (
            Number(value, source=f"{ASHRAE_WIND}: {terrain}", derived=True) for value in TERRAINS[terrain]
        )
        return {"exponent": exponent, "layer": layer} | raw


def wind_factor(wind: Wind, height: float) -> float:
    """Wind speed at a height of the site over that at the mast, as in the engine.

    Parameters
    ----------
    wind : Wind
        The profile.
    height : float
        Height above the ground. [m]

    Returns
    -------
    float
        ``(mast_layer/mast_height)^mast_exponent (height/layer)^exponent``; heights below 0.1 m count as
        0.1 m. [-]

    References
    ----------
    ASHRAE Handbook of Fundamentals 2017, ch. 24, eq. 4.

    Examples
    --------
    >>> round(wind_factor(Wind(terrain="suburb"), 10.0), 3)
    0.717
    """
    mast = float(wind.mast_layer / wind.mast_height) ** float(wind.mast_exponent)
    return float(mast * (max(float(height), 0.1) / float(wind.layer or 1.0)) ** float(wind.exponent or 0.0))


class SkyLaw(PublishedLaw):
    """A published model of the emission of the sky: a class for each row of the engine's table.

    Examples
    --------
    >>> from mascarin.building import BruntSky, SkyLaw
    >>> isinstance(BruntSky(), SkyLaw)
    True
    """

    if TYPE_CHECKING:

        def __init__(self, **numbers: Any) -> None: ...

    @property
    def clouded(self) -> bool:
        """Whether `Site.cloud` has no effect on it."""
        return self.row.clouds is None

    @property
    def weather(self) -> frozenset[str]:
        """Columns of the weather that it needs."""
        return frozenset(self.row.weather)


#: Classes of the models by their names; the default comes first.
SKIES: Final = classes_of(sorted(SKY.values(), key=lambda row: row.kind != DEFAULT_SKY), SkyLaw, "{}Sky")
globals().update(SKIES)

if TYPE_CHECKING:
    Sky = SkyLaw | TextSky
    Diffuse = str
else:
    Sky = Annotated[
        union_of([*SKIES.values(), TextSky]),
        Field(discriminator="kind"),
        Shorthand(word="kind", implied=("formula", "text")),
    ]
    Diffuse = Literal[tuple(sorted(DIFFUSE, key=lambda kind: kind != DEFAULT_DIFFUSE))]


class CloudFactor(Part):
    """Factor ``1 + c1 N + c2 N^2 + c3 N^3`` on the clear sky's emissivity, cloud cover N in tenths.

    Examples
    --------
    >>> CloudFactor()
    CloudFactor(c1=0.0224, c2=-0.0035, c3=0.00028)
    """

    kind: Literal["factor"] = "factor"
    c1: q.CloudCoefficient = Number(0.0224, source=CLARK)
    c2: q.CloudCoefficient = Number(-0.0035, source=CLARK)
    c3: q.CloudCoefficient = Number(0.00028, source=CLARK)


class CloudLayer(Part):
    """Opaque layer: adds ``(1 - clear) N/10 emissivity exp(-base/8200 m)`` to the clear sky's emissivity.

    Examples
    --------
    >>> CloudLayer(base=2000)
    CloudLayer(emissivity=1, base=2000 m)
    """

    kind: Literal["layer"] = "layer"
    emissivity: q.CloudEmissivity = Number(1.0, source=MARTIN)
    base: q.CloudBase = Number(1200.0, source="a typical base of low clouds (WMO-No. 407)", assumed=True)


Cloud = Annotated[CloudFactor | CloudLayer, Field(discriminator="kind"), Shorthand(word="kind")]


def _timezone(text: str) -> str:
    """Accept an IANA name or a fixed offset such as ``UTC+4`` or ``UTC-03:30``."""
    if utc_offset_minutes(text) is not None:
        return text
    from zoneinfo import ZoneInfo

    try:
        ZoneInfo(text)
    except (KeyError, ValueError, OSError):
        raise problem(
            f"'{text}'", "an IANA time zone such as Europe/Paris, or UTC+4", _nearest(text)
        ) from None
    return text


def _nearest(text: str) -> str:
    from zoneinfo import available_timezones

    return did_you_mean(text, available_timezones()) or "The position of the sun needs a time zone."


def utc_offset_minutes(text: str) -> int | None:
    """Minutes that a fixed zone such as ``UTC+4`` is ahead of UTC; None for any other text."""
    match = re.fullmatch(r"UTC(?:([+-])(\d{1,2})(?::(\d{2}))?)?", text)
    if match is None:
        return None
    sign, hours, minutes = match.groups()
    total = 60 * int(hours or 0) + int(minutes or 0)
    return None if total > 14 * 60 or int(minutes or 0) > 59 else (-total if sign == "-" else total)


class Site(Part):
    """Site of the building: position, clock, wind, sky.

    Examples
    --------
    >>> site = Site(latitude=48.1, longitude=11.6, altitude=520, timezone="Europe/Berlin")
    >>> site.diffuse
    'perez'
    """

    latitude: q.Latitude
    longitude: q.Longitude
    altitude: q.Altitude
    air_density: q.AirDensity | None = None
    air_specific_heat: q.AirSpecificHeat | None = None
    timezone: Annotated[str, AfterValidator(_timezone)] = Field(
        description="Time zone of the local clock: an IANA name such as Europe/Paris, or UTC+4"
    )
    ground_reflectance: q.GroundReflectance = Number(
        0.2, source="Liu & Jordan 1963, doi:10.1016/0038-092X(63)90006-9"
    )
    wind: Wind = Field(default_factory=lambda: Wind(), description="Wind profile")
    sky: Sky = Field(
        default_factory=lambda: SKIES["MartinBerdahlSky"](kind=DEFAULT_SKY),
        description="Long-wave emission of the sky",
    )
    cloud: Cloud = Field(
        default_factory=CloudLayer,
        description="Effect of clouds on the sky's emissivity: as a factor, or as an opaque layer",
    )
    sky_exponent: q.SkyExponent | None = None
    sky_diurnal: q.SkyDiurnal | None = None
    diffuse: Diffuse = Field(
        DEFAULT_DIFFUSE, description="Model of diffuse short-wave radiation on a tilted plane"
    )
    horizon: tuple[tuple[q.HorizonAzimuth, q.HorizonElevation], ...] = Field(
        (),
        description="Azimuth, rising, and elevation of terrain and far obstacles; interpolated between them, "
        "none: free",
    )
    self_shading: bool = Field(True, description="Whether surfaces with vertices shade each other")

    @model_validator(mode="after")
    def _around(self) -> Site:
        azimuths = [float(azimuth) for azimuth, _ in self.horizon]
        for before, after in pairwise([*azimuths, 360.0]):
            if self.horizon and after <= before:
                refuse(
                    fault(
                        ("horizon",),
                        f"azimuth {after:g} after {before:g}",
                        "rising azimuths, clockwise from north, each once",
                        "Sort the points by azimuth; write 0 in place of 360.",
                    )
                )
        return self

    @model_validator(mode="wrap")
    @classmethod
    def _clouds_of_the_sky(cls, raw: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Take the effect of clouds that belongs to the model of the clear sky, where none is given."""
        if not isinstance(raw, Mapping):
            return handler(raw)
        cloud = raw.get("cloud")
        if cloud is None:
            site = handler({**raw, "cloud": {"kind": _cloud_kind(raw.get("sky"))}})
            site.model_fields_set.discard("cloud")
            return site
        if isinstance(cloud, Mapping) and "kind" not in cloud:
            kind = "layer" if {"emissivity", "base"} & set(cloud) else "factor"
            raw = {**raw, "cloud": {"kind": kind, **cloud}}
        return handler(raw)


def _cloud_kind(sky: Any) -> str:
    """The effect of clouds that a model is published with, or used with by others."""
    kind = sky.get("kind") if isinstance(sky, Mapping) else getattr(sky, "kind", sky)
    if kind in (None, "text"):
        kind = DEFAULT_SKY
    return (SKY[kind].clouds if kind in SKY else None) or "factor"
