"""Sensitivity analysis of a building by every method: the same parameters matter."""

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
    indices = {}
    for method in METHODS:
        found = mc.sensitivity_analysis(
            building, climate,
            outputs=["wall.interface_1_temperature"], method=method, vary=PATHS,
            start="2023-03-01", end="2023-03-03", step="1h", measurements=measured, replicates=4,
            groups=None,
        )  # fmt: skip
        assert found.units == ("degC",)
        indices[method] = found.index[:, 0]
        assert found.ranking("wall.interface_1_temperature")[0] == PATHS[0]
        assert found.effect[0, 0] < 0.0
    assert indices["rbd-fast"] == pytest.approx(indices["spectral"], abs=0.05)
    assert indices["sobol"] == pytest.approx(indices["spectral"], abs=0.15)
    # Elementary effects of a mildly non-linear wall.
    assert indices["morris"] == pytest.approx(indices["spectral"], abs=0.1)


def test_factors_have_ranges_distributions_and_groups(building: Building) -> None:
    found = factors_of(
        building,
        ranges={PATHS[0]: (0.03, 0.05)},
        distributions={PATHS[1]: "log-uniform"},
        groups={"coefficients": [PATHS[3], "surfaces.wall.outside.convection.coefficient"]},
        leave_out=[PATHS[2]],
    )
    by_path = {factor.path: factor for factor in found}
    assert (by_path[PATHS[0]].low, by_path[PATHS[0]].high) == (0.03, 0.05)
    assert by_path[PATHS[1]].distribution == "log-uniform"
    assert by_path[PATHS[3]].group == "coefficients"
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
def test_errors_of_factors_of_a_building(building: Building, keywords: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        factors_of(building, **keywords)


def test_the_same_seed_gives_the_same_numbers(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    keywords: dict[str, Any] = {
        "outputs": ["core.temperature"], "vary": PATHS[:2], "start": "2023-03-01",
        "end": "2023-03-02", "step": "1h", "measurements": measured, "replicates": 3, "method": "morris",
    }  # fmt: skip
    reported: list[tuple[int, int]] = []
    one = mc.sensitivity_analysis(building, climate, progress=lambda *k: reported.append(k), **keywords)
    assert reported[-1] == (one.runs, one.runs)
    assert np.array_equal(one.index, mc.sensitivity_analysis(building, climate, **keywords).index)


@pytest.fixture(scope="module")
def options(measured: Measurements) -> dict[str, Any]:
    return {
        "outputs": ["wall.interface_1_temperature"], "start": "2023-03-01", "end": "2023-03-03",
        "step": "1h", "measurements": measured, "replicates": 3, "method": "morris", "progress": False,
    }  # fmt: skip


def test_vary_gives_paths_or_ranges(building: Building, climate: Climate, options: dict[str, Any]) -> None:
    narrow = mc.sensitivity_analysis(
        building, climate, vary={PATHS[0]: (0.03, 0.05), PATHS[1]: None}, **options
    )
    wide = mc.sensitivity_analysis(
        building, climate, vary={PATHS[0]: (0.02, 0.06), PATHS[1]: None}, **options
    )
    named = mc.sensitivity_analysis(building, climate, vary=PATHS[:2], **options)
    assert narrow.names == wide.names == PATHS[:2]
    # The building's own range of the conductivity is 0.02 to 0.06.
    assert np.array_equal(wide.index, named.index)
    assert abs(narrow.effect[0, 0]) < 0.7 * abs(wide.effect[0, 0])


def test_values_in_place_of_the_buildings_are_kept_fixed(
    building: Building, climate: Climate, options: dict[str, Any]
) -> None:
    given = {PATHS[2]: 0.8}
    changed = mc.sensitivity_analysis(building, climate, vary=PATHS[:2], parameters=given, **options)
    replaced = mc.sensitivity_analysis(building.replace(given), climate, vary=PATHS[:2], **options)
    assert changed.effect == pytest.approx(replaced.effect, rel=1e-9)
    everything = mc.sensitivity_analysis(building, climate, parameters=given, **options)
    assert PATHS[2] not in everything.names
    with pytest.raises(InputError, match="is in vary and in parameters"):
        mc.sensitivity_analysis(building, climate, vary=PATHS, parameters=given, **options)
    with pytest.raises(InputError, match="expected a list"):
        mc.sensitivity_analysis(building, climate, vary=PATHS[0], **options)


def test_times_are_local_and_go_into_arrays(
    building: Building, climate: Climate, options: dict[str, Any]
) -> None:
    found = mc.sensitivity_analysis(building, climate, vary=PATHS, **(options | {"method": "spectral"}))
    assert found.times is not None
    assert str(found.times[0]) == "2023-03-01 00:00:00+01:00"
    arrays = found.to_xarray()
    assert arrays["S1_over_time"].dims == ("parameter", "time", "output")
    assert arrays["time"].values[0] == np.datetime64("2023-02-28T23:00")
    assert arrays["local_time"].values[0] == np.datetime64("2023-03-01T00:00")
    assert arrays.attrs["timezone"]
    assert found.plot("day").get_xlabel() == "hour of the day, local time [h]"
