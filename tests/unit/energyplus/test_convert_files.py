"""Example files of EnergyPlus that nobody here wrote: all convert, and their results beside EnergyPlus."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import DATA, unavailable

from mascarin.building.reading import parse
from mascarin.energyplus import convert, yaml_text
from mascarin.energyplus.model.handlers import HANDLERS
from mascarin.energyplus.model.idf import IdfModel, read

BENCH = Path(__file__).resolve().parents[3] / "bench"
#: What is left out of each file: beginnings of the classes.
LEFT_OUT = {
    "1ZoneUncontrolled": set(),
    "1ZoneUncontrolledFourAlgorithms": {"MaterialProperty", "SurfaceProperty"},
    "1ZoneUncontrolledWithHysteresisPCM": set(),
    "1ZoneUncontrolled_win_1": {"Construction"},
    "4ZoneWithShading_Simple_1": set(),
    "5Zone_IdealLoadsAirSystems_ReturnPlenum": {"AirLoopHVAC"},
    "AirflowNetwork3zVent": set(),
    "CondFD1ZonePurchAirAutoSizeWithPCM": set(),
    "GroundTempOSCCompactSched": set(),
    "PurchAirWindowBlind": set(),
    "SolarShadingTest": {"Shading"},
    "VentilationSimpleTest": set(),
    "WindowTestsSimple": {"Site"},
}


@pytest.fixture(scope="module")
def files(data_dir: Path) -> Path:
    """Folder of the example files, beside that of the data."""
    folder = data_dir.parent / "peers" / "idf"
    if not folder.is_dir():
        unavailable(f"no example files of EnergyPlus at {folder}", DATA)
    return folder


@pytest.fixture(scope="module")
def bench(files: Path) -> Any:
    """The module that makes the table of the documentation."""
    sys.path.insert(0, str(BENCH))
    try:
        import energyplus_files  # type: ignore[import-not-found]
    finally:
        sys.path.remove(str(BENCH))
    return energyplus_files


@pytest.mark.parametrize("name", sorted(LEFT_OUT))
def test_every_file_converts_and_names_what_it_leaves_out(
    files: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    models: list[IdfModel] = []

    def remembered(path: Path) -> IdfModel:
        models.append(read(path))
        return models[-1]

    monkeypatch.setattr("mascarin.energyplus.conversion.read", remembered)
    found = convert(files / f"{name}.idf")
    assert models[0].looked_up <= set(HANDLERS), "a handler declares the classes that it reads"
    kinds = {one.kind.partition(":")[0] for one in found.findings if one.level == "left out"}
    assert kinds == LEFT_OUT[name]
    assert found.building.check()
    assert parse(yaml_text(found), name) == found.building


@pytest.mark.parametrize("name", ["1ZoneUncontrolledWithHysteresisPCM", "PurchAirWindowBlind"])
def test_epjson_gives_the_same_building(files: Path, name: str) -> None:
    first, second = convert(files / f"{name}.idf"), convert(files / f"{name}.epJSON")
    for section in ("site", "materials", "constructions", "glazings", "surfaces", "windows", "shades"):
        # epJSON orders objects by name: so are parts that are made for several of them.
        assert first.description.get(section) == second.description.get(section)
    powers = [
        {
            (zone, gain): (float(one.power or 0.0), float(one.radiative))
            for zone, part in building.zones.items()
            for gain, one in part.gains.items()
        }
        for building in (first.building, second.building)
    ]
    assert powers[0] == powers[1]
    told = [{(f.level, f.kind, f.name, f.what) for f in one.findings} for one in (first, second)]
    assert told[0] == told[1]


# Largest deviations: root mean square and mean of the zone temperatures [K], heating and cooling in a year.
CLOSE = {
    "1ZoneUncontrolled": (0.32, 0.05, 0.0, 0.0),
    "4ZoneWithShading_Simple_1": (0.1, 0.03, 0.01, 0.02),
    "GroundTempOSCCompactSched": (0.2, 0.1, 0.04, 0.03),
}


@pytest.mark.parametrize("name", sorted(CLOSE))
def test_results_beside_energyplus(bench: Any, name: str) -> None:
    _, rows = bench.compared(name)
    rms, mean, heating, cooling = CLOSE[name]
    for row in rows:
        assert row.rms < rms
        assert abs(row.mean) < mean
        for pair, limit in ((row.heating, heating), (row.cooling, cooling)):
            if pair is not None:
                assert pair[0] == pytest.approx(pair[1], rel=limit)
