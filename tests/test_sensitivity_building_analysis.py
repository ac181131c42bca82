"""Sensitivity of a building by every method: the same parameters matter."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building, load
from mascarin.errors import InputError
from mascarin.sensitivity import METHODS, factors_of
from mascarin.weather import Climate, Measurements
from study_support import BUILDING, drivers, open_climate

PATHS = (
    "materials.insulation.conductivity",
    "materials.brick.conductivity",
    "surfaces.wall.outside.absorptance",
    "surfaces.wall.inside.convection.coefficient",
)


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


def test_all_methods_agree_on_a_wall(building: Building, climate: Climate, measured: Measurements) -> None:
    shares = {}
    for method in METHODS:
        found = mc.screen(
            building, climate,
            outputs=["wall.interface_1_temperature"], method=method, parameters=PATHS,
            start="2023-03-01", end="2023-03-03", step="1h", measurements=measured, replicates=4,
            groups=None,
        )  # fmt: skip
        assert found.units == ("degC",)
        shares[method] = found.share[:, 0]
        assert found.ranking("wall.interface_1_temperature")[0] == PATHS[0]
        assert found.effect[0, 0] < 0.0
    assert shares["rbd-fast"] == pytest.approx(shares["spectral"], abs=0.05)
    assert shares["sobol"] == pytest.approx(shares["spectral"], abs=0.15)
    # Elementary effects of a mildly non-linear wall.
    assert shares["morris"] == pytest.approx(shares["spectral"], abs=0.1)


def test_ranges_distributions_and_groups_reach_the_factors(building: Building) -> None:
    found = factors_of(
        building,
        ranges={PATHS[0]: (0.03, 0.05)},
        distributions={PATHS[1]: "log-uniform"},
        groups={"films": [PATHS[3], "surfaces.wall.outside.convection.coefficient"]},
        leave_out=[PATHS[2]],
    )
    by_path = {factor.path: factor for factor in found}
    assert (by_path[PATHS[0]].low, by_path[PATHS[0]].high) == (0.03, 0.05)
    assert by_path[PATHS[1]].distribution == "log-uniform"
    assert by_path[PATHS[3]].group == "films"
    assert PATHS[2] not in by_path
    assert len({f.group for f in found}) == 2


@pytest.mark.parametrize(
    ("keywords", "text"),
    [
        ({"ranges": {"materials.brik.conductivity": (0.1, 1.0)}}, "brick"),
        ({"ranges": {PATHS[0]: (0.05, 0.03)}}, "expected a lower and a higher value"),
        ({"ranges": {PATHS[2]: (0.5, 1.5)}}, "from 0 to 1"),
        ({"groups": {"a": [PATHS[0]], "b": [PATHS[0]]}}, "in the groups a and b"),
        ({"only": []}, "no parameter with a range"),
        ({"distributions": {PATHS[0]: "flat"}}, "none of uniform"),
        ({"leave_out": ["nothing.here"]}, "nothing.here"),
    ],
)
def test_what_cannot_be_used_is_named(building: Building, keywords: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        factors_of(building, **keywords)


def test_the_same_seed_gives_the_same_numbers(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    keywords: dict[str, Any] = {
        "outputs": ["core.temperature"], "parameters": PATHS[:2], "start": "2023-03-01",
        "end": "2023-03-02", "step": "1h", "measurements": measured, "replicates": 3, "method": "morris",
    }  # fmt: skip
    told: list[tuple[int, int]] = []
    one = mc.screen(building, climate, progress=lambda *k: told.append(k), **keywords)
    assert told[-1] == (one.runs, one.runs)
    assert np.array_equal(one.share, mc.screen(building, climate, **keywords).share)
