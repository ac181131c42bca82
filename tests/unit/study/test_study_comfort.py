"""The comfort of the rooms of a study: tables, figures, and what is refused before the first run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.examples import box, box_climate


def study(**keys: Any) -> mc.Study:
    """A study of the box against its own room temperature with noise."""
    climate = box_climate()
    outputs = ["room.air_temperature"]
    air = mc.simulate(box(), climate, step="1h", outputs=outputs).to_dataframe()["room.air_temperature"]
    table = pd.DataFrame({"room": air + np.random.default_rng(1).normal(0.0, 0.05, len(air))})
    measured = mc.Measurements.from_table(table, columns=["room"], timezone="UTC-07:00")
    return mc.Study(
        building=box(),
        climate=climate,
        measurements=measured,
        sensors={"room": {"column": "room", "output": "room.air_temperature"}},
        periods={"identification": ("2001-07-01", "2001-07-03")},
        parameters={"surfaces.facade.outside.absorptance": (0.3, 0.9)},
        identification={"starts": 1},
        step="1h",
        **keys,
    )


def test_a_study_rates_its_rooms_before_and_after_the_calibration(tmp_path: Path) -> None:
    made = study(comfort={"room": {"index": "operative", "band": [18, 26]}})
    results = made.run(tmp_path / "out")
    table = pd.read_csv(tmp_path / "out" / "tables" / "comfort.csv")
    assert set(table["model"]) == {"nominal", "fitted"}
    # A study meshes its walls for the ranges of their parameters: `mc.simulate` alone differs by 0.03 K.
    changed = results.fitted.results.provenance.changed
    run = made.context.models.of_building(box().replace(changed), ["room.mean_radiant_temperature"]).run()
    expected = run.comfort("room", index="operative", band=[18, 26])
    found = table[table["model"] == "fitted"]["degree_hours"].sum()
    assert found == pytest.approx(expected.degree_hours, rel=1e-9)
    assert expected.degree_hours > 0.0
    assert (tmp_path / "out" / "figures" / "comfort-room-fitted-carpet.svg").is_file()


@pytest.mark.parametrize(
    ("comfort", "said"),
    [
        ({"kitchen": {"index": "operative", "band": [18, 26]}}, "found the zone 'kitchen'"),
        ({"room": {"index": "givoni"}}, "room.relative_humidity"),
        ({"room": {"index": "pmv", "humidity": 0.5}}, "Give percent"),
    ],
)
def test_comfort_that_cannot_be_rated_is_refused_before_the_first_run(
    comfort: dict[str, Any], said: str
) -> None:
    with pytest.raises(mc.InputError, match=said):
        study(comfort=comfort)
