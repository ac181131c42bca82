from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.weather import Climate


def climate() -> Climate:
    index = pd.date_range("2024-06-01", periods=24, freq="1h", tz="UTC")
    frame = pd.DataFrame({"T": np.arange(24.0), "d": 350.0, "v": 1.0}, index=index)
    frame.loc[index[[3, 4]], "T"] = np.nan
    frame.loc[index[10:15], "T"] = np.nan
    frame.loc[index[7], "d"] = 20.0
    frame.loc[index[6], "d"] = np.nan
    return Climate.from_table(
        frame,
        timezone="UTC",
        columns={"air_temperature": "T", "wind_direction": "d", "wind_speed": "v"},
        absent=["dew_point", "radiation"],
    )


def test_short_gaps_are_filled_linearly_and_said() -> None:
    filled = climate().fill_gaps("2h")
    air = filled.data["air_temperature"]
    assert air.iloc[3:5].to_list() == pytest.approx([3.0, 4.0])
    assert air.iloc[10:15].isna().all()
    assert filled.data["wind_direction"].iloc[6] == pytest.approx(5.0)  # from 350 to 20 through north
    assert any(
        "2 missing values of air_temperature filled linearly on request" in s for s in filled.provenance
    )
    assert climate().fill_gaps("5h").data["air_temperature"].iloc[12] == pytest.approx(12.0)


def test_only_the_named_columns() -> None:
    filled = climate().fill_gaps("2h", ["wind_direction"])
    assert filled.data["air_temperature"].isna().sum() == 7
    with pytest.raises(InputError, match="no column 'wind' to fill"):
        climate().fill_gaps("2h", ["wind"])
