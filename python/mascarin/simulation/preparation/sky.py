"""The sky of a run: infrared radiation of the weather, unless the building gives a model."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate

_MODEL: Final = ("site.sky.", "site.cloud.")


def with_sky_of(building: Building, climate: Climate, used: Iterable[str] = ()) -> Building:
    """Take the infrared radiation of the weather, unless the building gives a model of the sky.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    used : iterable of str
        Paths of parameters that vary. Where they belong to the model of the sky, the model is kept.

    Returns
    -------
    Building
        With ``site.sky: measured``, if the weather has infrared radiation in every interval, or in some of
        those of a weather file of a year, and the building gives neither ``site.sky`` nor ``site.cloud``;
        else the same building. Hours of a weather file without a value have that of the default model
        (`mascarin.weather.checks.missing_infrared`).

    Examples
    --------
    >>> from mascarin.examples import box, box_climate
    >>> building = box()
    >>> with_sky_of(building, box_climate()) is building
    True
    """
    stated = {"sky", "cloud"} & building.site.model_fields_set
    if stated or any(path.startswith(_MODEL) for path in used):
        return building
    values = climate.data.get("infrared")
    measured = None if values is None else values.notna()
    if measured is None or not bool(measured.all() or (climate.record.of_year and measured.any())):
        return building
    return building.replace({"site.sky": "measured"})
