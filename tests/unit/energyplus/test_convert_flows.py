"""Air flows, glazings and equipment of EnergyPlus, beside its own results.

The references are hourly air temperatures of EnergyPlus 25.2 in a week (`bench/energyplus_flows.py`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from idf_flows import FLOWS
from mascarin.energyplus import convert

TABLE = Path(__file__).parents[2] / "data" / "energyplus_flows.csv"
EPW = "weather/USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw"


@pytest.fixture(scope="module")
def chicago(data_dir: Path) -> mc.Climate:
    return mc.Climate.from_epw(data_dir / EPW)


@pytest.mark.parametrize("name", sorted(FLOWS))
def test_beside_energyplus(name: str, tmp_path: Path, chicago: mc.Climate) -> None:
    """Hourly air temperatures of a week."""
    text, limit = FLOWS[name]
    path = tmp_path / f"{name}.idf"
    path.write_text(text, encoding="utf-8")
    conversion = convert(path)
    run = mc.simulate(
        conversion.building,
        chicago,
        start=conversion.start,
        end=conversion.end,
        step="15min",
        outputs=["room.air_temperature"],
    )
    assert run.energy.closes
    air = run.to_dataframe()["room.air_temperature"].to_numpy()[1:].reshape(-1, 4).mean(axis=1)
    reference = pd.read_csv(TABLE, comment="#")[name].to_numpy()
    difference = float(np.sqrt(np.mean((air - reference) ** 2)))
    assert difference < limit
    assert conversion.complete
