"""What a run refuses because of the description alone, ``mascarin check`` refuses with the same words."""

from __future__ import annotations

import copy
import dataclasses
import os
import random
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from conftest import SEED

import fuzz_mutation
import random_cases
from mascarin import cli
from mascarin._io.durations import seconds_of
from mascarin.building import Building, check
from mascarin.building.files.yaml_text import text_of
from mascarin.errors import InputError, SolverError

#: Refusals that depend on the period or the weather: check knows neither.
OF_THE_PERIOD = (
    "at the end of the step from",
    "in the step from",
    "climate: ",
    "measurements: ",
    "period: ",
    "controls.",
    "initial",
    # `check` knows neither the scheme nor the table of measurements.
    "scheme: found",
    "no measured column",
)
CASES = 80


def refusal(work: Callable[[], Any]) -> str | None:
    """The words of an input error."""
    try:
        work()
    except InputError as error:
        return str(error)
    except SolverError:
        return None
    return None


def mutated_case(seed: int) -> random_cases.Case:
    """A random building with one or two values changed."""
    case, draw = random_cases.case(seed), random.Random(seed)
    tree = copy.deepcopy(case.tree)
    for _ in range(draw.choice((0, 1, 1, 2))):
        draw.choice((fuzz_mutation.mutate, fuzz_mutation._scale))(tree, draw)
    return dataclasses.replace(case, tree=tree)


def _run(case: random_cases.Case, building: Building) -> None:
    case.simulation(building).run()


def test_check_refuses_what_a_run_refuses() -> None:
    start, checked = int(os.environ[SEED]) % 10**6, 0
    for seed in range(start, start + CASES):
        case = mutated_case(seed)
        try:
            building = case.building()
        except InputError:
            continue
        by_check = refusal(partial(check, building, seconds_of(case.options["step"])))
        by_run = refusal(partial(_run, case, building))
        if by_run is not None and any(words in by_run for words in OF_THE_PERIOD):
            continue
        assert by_check == by_run, f"case {seed}"
        checked += 1
    assert checked > CASES // 6


def _room(corner: float, roof: float = 3.0) -> dict[str, Any]:
    """A room of six polygons; the ceiling is at `roof` in one corner, and a corner is moved in the plan."""
    floor = [[0, 0, 0], [0, 5, 0], [4, 5, 0], [4, 0, 0]]
    ceiling = [[0, 0, 3], [4, 0, 3], [4, 5, roof], [0, 5, roof]]
    south = [[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]]
    east = [[4, 0, 0], [4, 5, 0], [4, 5, 3], [4, 0, 3]]
    north = [[4, 5, 0], [corner, 5, 0], [corner, 5, 3], [4, 5, 3]]
    west = [[0, 5, 0], [0, 0, 0], [0, 0, 3], [0, 5, 3]]
    air = {"convection": 5, "absorptance": 0.6, "emissivity": 0.9}
    sides = {"construction": "wall", "inside": {"zone": "room", **air}, "outside": {"outdoors": True, **air}}
    shell = {"floor": floor, "ceiling": ceiling, "south": south, "east": east, "north": north, "west": west}
    return {
        "name": "room",
        "site": {"latitude": 39.74, "longitude": -105.18, "timezone": "UTC-7", "altitude": 1829},
        "materials": {"brick": {"conductivity": 0.5, "density": 1500, "specific_heat": 900}},
        "constructions": {"wall": {"layers": [{"material": "brick", "thickness": 0.2}]}},
        "zones": {"room": {"volume": 60.0}},
        "surfaces": {name: {**sides, "vertices": vertices} for name, vertices in shell.items()},
    }


@pytest.mark.parametrize(("corner", "words"), [(0.0, None), (1.0, "open edges: floor")])
def test_a_zone_that_is_open(
    corner: float, words: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "room.yaml"
    file.write_text(text_of(_room(corner)), encoding="utf-8")
    period = ("--weather", "shipped:golden", "--start", "2001-01-01", "--end", "2001-01-02", "--step", "1h")
    said = []
    for command in (("check", str(file), "--step", "1h"), ("run", str(file), *period, "--initial", "15")):
        code = cli.main([*command])
        errors = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error: ")]
        assert code == (0 if words is None else 2), errors
        said.append(errors)
    assert said[0] == said[1]
    assert words is None or words in said[0][0]


def test_coordinates_far_from_the_origin_are_refused() -> None:
    tree = _room(0.0)
    tree["surfaces"]["north"]["vertices"][0] = [1e200, 5, 0]
    with pytest.raises(InputError, match=r"within 1e\+09 m of the origin"):
        Building.from_dict(tree)
