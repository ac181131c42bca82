"""A climate in numbers: table of months, degree days, sun."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.physics import humidity_of_dew_point

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.weather.climate import Climate

#: Direct irradiance from which on the sun shines, by the World Meteorological Organization. [W/m2]
SUNSHINE: Final = 120.0


@dataclass(frozen=True, eq=False)
class Overview:
    """A climate in numbers.

    Attributes
    ----------
    months : pandas.DataFrame
        One row for each month of the record, with its unit in the name of each column.
    heating_base, cooling_base : float
        Bases of the degree days. [degC]
    heating_degree_days, cooling_degree_days : float
        Sum over the days of the distance of the daily mean from the base. [K d]
    sunshine : float
        Time with direct normal irradiance above 120 W/m2. [h]
    days : int
        Whole days of the record.

    Examples
    --------
    >>> from mascarin.examples import box_climate
    >>> overview(box_climate()).days
    3
    """

    months: pd.DataFrame
    heating_base: float
    cooling_base: float
    heating_degree_days: float
    cooling_degree_days: float
    sunshine: float
    days: int


def overview(climate: Climate, *, heating_base: float = 18.0, cooling_base: float = 24.0) -> Overview:
    """Table of months, degree days and sun of a climate.

    Parameters
    ----------
    climate : Climate
        The climate.
    heating_base, cooling_base : float
        Daily mean below or above which a degree day counts. [degC]

    Returns
    -------
    Overview
        The climate in numbers.

    Examples
    --------
    >>> import mascarin as mc
    >>> months = overview(mc.Climate.shipped("tampa")).months
    >>> float(months["air, mean [degC]"].loc["2001-07"].round(1))
    27.9
    """
    import pandas as pd

    data, hours = climate.data, climate.grid.interval / 3600.0
    local = data.index.tz_localize(None)  # type: ignore[attr-defined]
    month, day = local.to_period("M"), local.to_period("D")
    air = data["air_temperature"]
    table = {"air, mean [degC]": air.groupby(month).mean()}
    daily = air.groupby(day)
    daily_month = pd.PeriodIndex(daily.mean().index).asfreq("M")
    table["air, daily maximum [degC]"] = daily.max().groupby(daily_month).mean()
    table["air, daily minimum [degC]"] = daily.min().groupby(daily_month).mean()
    table["air, lowest [degC]"] = air.groupby(month).min()
    table["air, highest [degC]"] = air.groupby(month).max()
    if "dew_point" in data:
        humid = pd.Series(humidity_of_dew_point(air, data["dew_point"]), index=data.index)
        table["relative humidity [%]"] = humid.groupby(month).mean()
    if "wind_speed" in data:
        table["wind [m/s]"] = data["wind_speed"].groupby(month).mean()
    for name in ("global_horizontal", "direct_normal", "diffuse_horizontal"):
        if name in data:
            column = f"{name.replace('_', ', ')} [kWh/m2]"
            table[column] = data[name].groupby(month).sum(min_count=1) * hours / 1000.0
    means = daily.mean()[daily.size() * hours >= 23.0]
    sunshine = np.nan
    if "direct_normal" in data:
        sunshine = float((data["direct_normal"] >= SUNSHINE).sum() * hours)
    months = pd.DataFrame(table)
    months.index = pd.Index([str(period) for period in months.index], name="month")
    return Overview(
        months, heating_base, cooling_base,
        float(np.maximum(heating_base - means, 0.0).sum()),
        float(np.maximum(means - cooling_base, 0.0).sum()),
        sunshine, len(means),
    )  # fmt: skip
