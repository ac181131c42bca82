"""What is worked out once: for check and run, for all members of a sweep, for all edges of a building."""

from __future__ import annotations

import gc
import pickle
import subprocess
import sys
from datetime import timedelta, timezone
from typing import Any
from zoneinfo import ZoneInfo

import numpy as np
import pytest

import mascarin as mc
from mascarin._io.memory import uncollected
from mascarin.building import Building
from mascarin.building.checks.consistency import MOST_SURFACES
from mascarin.building.engine_input import description as engine_input
from mascarin.building.geometry import BoxIndex, Polygon
from mascarin.ensemble import members
from mascarin.errors import InputError
from mascarin.examples import FOLDER, box, box_climate
from mascarin.simulation import Simulation
from mascarin.weather import forcing


def counted(monkeypatch: pytest.MonkeyPatch, owner: Any, name: str) -> list[Any]:
    """What a function is called with from now on."""
    calls, real = [], getattr(owner, name)

    def call(*given: Any, **named: Any) -> Any:
        calls.append(given)
        return real(*given, **named)

    monkeypatch.setattr(owner, name, call)
    return calls


def cell() -> Building:
    return mc.load(FOLDER / "lgi" / "building.yaml")


def test_check_and_run_describe_a_building_once(monkeypatch: pytest.MonkeyPatch) -> None:
    building, calls = cell(), counted(monkeypatch, engine_input, "_describe")
    building.check("15min")
    first = building.to_engine(900.0)
    first.values[:] = 0.0  # a copy: what is kept stays
    assert building.to_engine(900.0).values.any()
    assert len(calls) == 1
    building.to_engine(60.0)
    assert len(calls) == 2


def test_a_building_is_pickled_without_what_was_worked_out() -> None:
    building = cell()
    before = pickle.dumps(building)
    building.check()
    assert len(pickle.dumps(building)) == len(before)
    again = pickle.loads(pickle.dumps(building))  # noqa: S301  # our own
    assert again == building
    assert again.to_engine().json == building.to_engine().json


def test_objects_are_collected_again_after_reading() -> None:
    def stopped() -> None:
        with uncollected():
            assert not gc.isenabled()
            raise InputError("within")

    with pytest.raises(InputError, match="within"):
        stopped()
    assert gc.isenabled()
    gc.disable()
    try:
        cell()
        assert not gc.isenabled()  # as it was
    finally:
        gc.enable()


def test_boxes_in_a_grid_are_found_as_by_comparing_all() -> None:
    rng = np.random.default_rng(5)
    polygons = []
    for k, (x, y, z, wide) in enumerate(rng.uniform([-20, -20, 0, 0.1], [20, 20, 9, 3], (200, 4)).tolist()):
        corners = [(x, y, z), (x + wide, y, z), (x + wide, y, z + wide), (x, y, z + wide)]
        polygons.append(Polygon.of(f"p{k}", corners))
    far = [(-90.0, 0.0, 0.0), (90.0, 0.0, 0.0), (90.0, 0.0, 50.0), (-90.0, 0.0, 50.0)]
    polygons.append(Polygon.of("large", far))
    index, slack = BoxIndex(polygons), 2e-3
    low, high = (np.array([polygon.box[end] for polygon in polygons]) for end in (0, 1))
    for polygon in polygons:
        a, b = map(np.array, polygon.box)
        around = np.flatnonzero(((low <= a + slack) & (high >= b - slack)).all(axis=1))
        touching = np.flatnonzero(((low <= b + slack) & (high >= a - slack)).all(axis=1))
        assert index.around(polygon) == around.tolist()
        assert index.touching(polygon) == touching.tolist()


def test_a_zone_of_too_many_surfaces_is_refused_with_what_it_would_take() -> None:
    plain = box().to_dict()
    name, surface = next(iter(plain["surfaces"].items()))
    many = {f"{name}_{k}": surface for k in range(MOST_SURFACES + 1 - len(plain["surfaces"]))}
    takes = r"230 MB of memory and about 0\.075 min for each day, its derivatives 1\.2 GB and 5 min"
    with pytest.raises(InputError, match=f"{MOST_SURFACES + 1} surfaces.*{takes}"):
        Building.from_dict(plain | {"surfaces": plain["surfaces"] | many})


def test_the_weather_of_a_place_is_worked_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    climate, building = box_climate(), box()
    first = Simulation(building, climate, step="1h").compiled.forcing
    calls = counted(monkeypatch, forcing, "fill_radiation")
    again = Simulation(building.replace({"zones.room.volume": 40.0}), climate, step="1h").compiled.forcing
    assert not calls
    np.testing.assert_array_equal(first, again)
    turned = building.replace({"site.longitude": float(building.site.longitude) + 1.0})
    moved = Simulation(turned, climate, step="1h").compiled.forcing
    assert len(calls) == 1
    assert not np.array_equal(first, moved)


def test_a_sweep_makes_the_building_of_each_structure_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = counted(monkeypatch, Building, "replace")
    films = ["tarp", "alamdari_hammond", "tarp"]
    path = "surfaces.facade.inside.convection"
    found = mc.sweep(box(), box_climate(), {path: films}, step="1h", outputs=["room.air_temperature"])
    assert len(calls) == 2
    alone = Simulation(box().replace({path: "tarp"}), box_climate(), step="1h").run()["room.air_temperature"]
    np.testing.assert_array_equal(found["room.air_temperature"][2], alone)


def test_more_structures_than_are_kept_give_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(members, "_MOST_NUMBERS", 0)
    samples = {"surfaces.facade.inside.convection": ["tarp", "alamdari_hammond"]}
    options: dict[str, Any] = {"step": "1h", "outputs": ["room.air_temperature"]}
    few = mc.sweep(box(), box_climate(), samples, **options)
    monkeypatch.undo()
    many = mc.sweep(box(), box_climate(), samples, **options)
    np.testing.assert_array_equal(few["room.air_temperature"], many["room.air_temperature"])


def test_schedules_of_clocks_that_never_change_need_no_pandas() -> None:
    from mascarin.building import FractionSchedule
    from mascarin.weather.schedules import pieces_of

    hours = [{"at": "00:00", "value": 0}, {"at": "08:00", "value": 1}, {"at": "18:00", "value": 0.2}]
    schedule = FractionSchedule(days={"weekdays": hours, "weekends": hours[:1]})
    start = 1357000000.0
    plain = pieces_of(schedule, timezone(timedelta(hours=-7)), start, start + 9e5)
    named = pieces_of(schedule, ZoneInfo("America/Phoenix"), start, start + 9e5)  # by pandas, UTC-7 all year
    for one, other in ((plain.knots, named.knots), (plain.first, named.first), (plain.last, named.last)):
        np.testing.assert_array_equal(one, other)


def test_a_run_imports_nothing_that_it_does_not_need() -> None:
    """A run of a description on the command line: no figures, tables, statistics or files of results."""
    code = (
        "import sys; import mascarin; from mascarin.cli import main\n"
        "from mascarin.examples import FOLDER\n"
        "main(['run', str(FOLDER / 'box.yaml'), '--weather', 'shipped:golden', '--end', '01-02'])\n"
        "heavy = {'pandas', 'scipy', 'matplotlib', 'xarray', 'plotly', 'h5netcdf', 'pyarrow', 'pvlib',\n"
        "         'mascarin.figures', 'mascarin.pages', 'mascarin.calibration', 'mascarin.energyplus',\n"
        "         'mascarin.genopt', 'mascarin.optimization', 'mascarin.study.study', 'mascarin.design'}\n"
        "sys.exit(', '.join(sorted(heavy & set(sys.modules))) or None)"
    )
    process = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert "balance" in process.stdout
    assert process.returncode == 0, process.stderr[-300:]


def test_an_import_alone_reads_no_part_of_the_package() -> None:
    code = (
        "import sys; before = set(sys.modules); import mascarin\n"
        "new = [name for name in set(sys.modules) - before if name.startswith('mascarin.')]\n"
        "sys.exit(', '.join(sorted(set(new) | {'numpy', 'pydantic'} & set(sys.modules))) or None)"
    )
    process = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert process.returncode == 0, process.stderr


def test_a_check_imports_no_pandas() -> None:
    code = (
        "import sys; from mascarin.examples import FOLDER; from mascarin.building import load\n"
        "load(FOLDER / 'lgi' / 'building.yaml').check('15min'); sys.exit('pandas' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
