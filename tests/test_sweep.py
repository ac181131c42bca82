"""Ensembles: members in order, the same bits alone and together, failures that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin.climate import Climate, Measurements
from mascarin.errors import InputError
from mascarin.model import Building, load
from mascarin.simulation import simulate
from mascarin.sweep import sweep
from study_support import BUILDING, drivers, open_climate

JOINT = "wall.interface_1_temperature"
K = "materials.insulation.conductivity"
FILM = "surfaces.wall.inside.convection.coefficient"


@pytest.fixture(scope="module")
def building(tmp_path_factory: pytest.TempPathFactory) -> Building:
    path = tmp_path_factory.mktemp("building") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return load(path)


@pytest.fixture(scope="module")
def climate() -> Climate:
    return open_climate(drivers())


@pytest.fixture(scope="module")
def measured() -> Measurements:
    return Measurements.from_table(drivers(), timezone="UTC+1")


def test_members_come_in_order_with_their_samples(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    samples = {K: [0.02, 0.04, 0.06], FILM: [4.0, 8.0, 12.0]}
    found = sweep(
        building, climate, samples, outputs=[JOINT], step="1h", start="2023-03-01", end="2023-03-04",
        measurements=measured,
    )  # fmt: skip
    assert found[JOINT].dims == ("member", "time")
    assert found[JOINT].shape == (3, 73)
    assert found[JOINT].attrs["units"] == "degC"
    np.testing.assert_array_equal(found["samples"], np.column_stack([samples[K], samples[FILM]]))
    assert found["parameter"].to_numpy().tolist() == [K, FILM]
    assert (found["closure"] < 1e-10).all()
    assert found.attrs["failures"] == []
    assert found.attrs["timezone"] == "UTC+1"
    # Times are UTC without a zone: local midnight is 23:00 of the day before.
    assert pd.Timestamp(found["time"].to_numpy()[0]) == pd.Timestamp("2023-02-28 23:00")
    # The better it insulates, the nearer the joint is to the room.
    mean = found[JOINT].mean("time").to_numpy()
    assert mean[0] > mean[1] > mean[2]


def test_a_member_does_not_depend_on_the_others(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    span = {"step": "1h", "start": "2023-03-01", "end": "2023-03-03", "measurements": measured}
    # The same mesh for all: the worst ends of the ranges are among each of the samples.
    values = np.array([0.02, 0.06, 0.031, 0.05, 0.045, 0.033, 0.027, 0.058, 0.041, 0.022])
    whole = sweep(building, climate, {K: values}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    part = sweep(building, climate, {K: values[[0, 1, 7]]}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    np.testing.assert_array_equal(part[JOINT].to_numpy(), whole[JOINT].to_numpy()[[0, 1, 7]])


def test_a_sweep_of_one_is_a_run(building: Building, climate: Climate, measured: Measurements) -> None:
    nominal = float(building.parameter(K).value)
    span = {"step": "1h", "start": "2023-03-01", "end": "2023-03-03", "measurements": measured}
    one = sweep(building, climate, {K: [nominal]}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    run = simulate(building, climate, outputs=[JOINT], **span)  # type: ignore[arg-type]
    np.testing.assert_allclose(one[JOINT].to_numpy()[0], run.records[:, 0], atol=1e-9)


def test_a_frame_of_samples_is_taken_too(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    frame = pd.DataFrame({K: [0.03, 0.05]})
    found = sweep(
        building, climate, frame, outputs=[JOINT], step="1h", end="2023-03-02", measurements=measured
    )
    assert found.sizes["member"] == 2


@pytest.mark.parametrize(
    ("samples", "says"),
    [
        ({}, "samples: no columns; give values by parameter path"),
        ({K: [0.03, 0.04], FILM: [8.0]}, "expected one vector of the same length"),
        ({K: []}, "expected one vector"),
        ({K: [0.03, -1.0]}, r"of member 1 is -1 W/\(m K\); expected a value from 0 to"),
        ({K: [0.03, float("nan")]}, "of member 1 is nan"),
        ({"materials.insulation.conductivty": [1.0]}, "Did you mean 'materials.insulation.conductivity'"),
        ({"site.latitude": [44.0, 45.0]}, "structural"),
    ],
)
def test_samples_that_cannot_be_are_refused(
    samples: dict[str, list[float]], says: str, building: Building, climate: Climate, measured: Measurements
) -> None:
    with pytest.raises(InputError, match=says):
        sweep(building, climate, samples, outputs=[JOINT], step="1h", end="2023-03-02", measurements=measured)


def test_an_unknown_output_is_refused(
    building: Building, climate: Climate, measured: Measurements, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"wall.interface_1_temperature"):
        sweep(building, climate, {K: [0.03]}, outputs=["wall.interface_1_temprature"], measurements=measured)
