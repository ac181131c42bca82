"""Energy balances that do not close are reported; cells with measured melting curves settle."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.simulation.checks.energy import FLOWS, EnergyLedger

#: Nine bends within 6 K: flat and steep in turn.
BENDS = {
    "kind": "fractions",
    "temperatures": [18.0, 18.9, 19.0, 19.8, 19.9, 21.2, 21.3, 22.4, 22.5, 24.0],
    "fractions": [0.0, 0.02, 0.22, 0.25, 0.45, 0.48, 0.74, 0.77, 0.97, 1.0],
}
SHARP = {"kind": "tanh", "width": 0.5}
PLACES = {"north": (90, 0), "east": (90, 90), "south": (90, 180), "west": (90, 270), "roof": (0, 0)}


def lined(law: dict[str, Any], thickness: float, nodes: int, **zone: Any) -> dict[str, Any]:
    """A light room lined with a phase-change material."""
    wax = {
        "kind": "pcm", "density": 900, "conductivity": [0.35, 0.11], "specific_heat": 1450,
        "latent_heat": 180e3, "law": law,
    }  # fmt: skip
    if law is SHARP:
        wax["melting_temperature"] = 21.0
    outside = {"outdoors": True, "convection": 20, "emissivity": 0.9, "absorptance": 0.6}
    inside = {"zone": "room", "convection": "tarp", "emissivity": 0.9}
    return {
        "name": "lined",
        "site": {"latitude": 39.83, "longitude": -104.65, "altitude": 1650, "timezone": "UTC-7"},
        "materials": {"wax": wax, "board": {"conductivity": 0.16, "density": 800, "specific_heat": 1090}},
        "constructions": {
            "lining": {
                "layers": [
                    {"material": "board", "thickness": 0.012},
                    {"material": "wax", "thickness": thickness, "nodes": nodes},
                ]
            }
        },
        "zones": {"room": {"volume": 30, "infiltration": 0.5, **zone}},
        "surfaces": {
            name: {
                "construction": "lining", "area": 12, "tilt": tilt, "azimuth": azimuth,
                "outside": outside, "inside": inside,
            }
            for name, (tilt, azimuth) in PLACES.items()
        },
    }  # fmt: skip


@pytest.fixture(scope="module")
def climate(data_dir: Path) -> mc.Climate:
    return mc.Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw")


@pytest.mark.parametrize(("thickness", "nodes"), [(0.005, 4), (0.02, 8), (0.05, 6)])
@pytest.mark.parametrize("step", ["15min", "1h"])
def test_measured_melting_curves_settle(climate: mc.Climate, thickness: float, nodes: int, step: str) -> None:
    """Newton's method went to and fro between the bends: a step in two was divided, or the run stopped."""
    building = mc.Building.from_dict(lined(BENDS, thickness, nodes))
    run = mc.simulate(building, climate, step=step, start="2001-07-01", end="2001-07-04", initial=20.0)
    stages = 2 * (len(run["room.air_temperature"]) + 6)
    assert run.provenance.halved_steps <= 2
    assert run.provenance.newton_iterations < 12 * stages
    assert run.energy.closes


def test_an_open_balance_is_in_the_result(climate: mc.Climate) -> None:
    building = mc.Building.from_dict(lined(SHARP, 0.005, 4))
    period: dict[str, Any] = {"start": "2001-07-01", "end": "2001-07-03", "step": "1h"}
    run = mc.simulate(building, climate, scheme="apparent-capacity", **period)
    assert run.energy.relative_residual > 1e-3
    assert not run.energy.closes
    assert run.warnings[0].startswith("the energy balance does not close: ")
    said = mc.simulate(building, climate, **period).warnings
    assert not any("energy balance" in line for line in said)


def test_the_command_ends_with_1(data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "lined.yaml"
    mc.Building.from_dict(lined(SHARP, 0.005, 4)).to_yaml(file)
    weather = str(data_dir / "bestest" / "725650TYCST.epw")
    words = ["run", str(file), "--weather", weather, "--start", "2001-07-01", "--end", "2001-07-02"]
    assert cli.main([*words, "--step", "1h", "--scheme", "apparent-capacity"]) == 1
    assert "warning: the energy balance does not close" in capsys.readouterr().err
    assert cli.main([*words, "--step", "1h"]) == 0
    assert "does not close" not in capsys.readouterr().err


SHEET = {"conductivity": 50, "density": 7800, "specific_heat": 480}
FOAM = {"conductivity": 0.04, "density": 30, "specific_heat": 900}
CONCRETE = {"conductivity": 1.7, "density": 2300, "specific_heat": 900}


def shell(layers: list[dict[str, Any]], **zone: Any) -> mc.Building:
    """The room with other walls."""
    described = lined(SHARP, 0.005, 4, **zone)
    described["materials"] = {"sheet": SHEET, "foam": FOAM, "concrete": CONCRETE}
    described["constructions"]["lining"]["layers"] = layers
    return mc.Building.from_dict(described)


def test_a_step_too_long_for_a_bare_sheet_is_reported(climate: mc.Climate) -> None:
    """The error is the distance to a run with short steps; the step that is named brings it below 0.2 K."""
    building = shell([{"material": "sheet", "thickness": 0.001}])
    period: dict[str, Any] = {"start": "2001-07-01", "end": "2001-07-04", "outputs": ["room.air_temperature"]}

    def air(step: str) -> tuple[Any, tuple[str, ...]]:
        run = mc.simulate(building, climate, step=step, **period)
        return run.records[:, 0], run.warnings

    exact, _ = air("1min")
    hourly, said = air("1h")
    assert len(said) == 1
    assert said[0].startswith("zones.room: the time step of 60 min is too long")
    error = float(np.sqrt(np.mean((hourly - exact[::60]) ** 2)))
    assert error > 0.2
    better = int(said[0].split("take a step of ")[1].split()[0])
    finer, said = air(f"{better}min")
    assert said == ()
    assert float(np.sqrt(np.mean((finer - exact[::better]) ** 2))) < 0.2


@pytest.mark.parametrize("step", ["15min", "1h"])
def test_other_rooms_have_no_warning(climate: mc.Climate, step: str) -> None:
    foam = {"material": "foam", "thickness": 0.06}
    concrete = {"material": "concrete", "thickness": 0.1}
    sheet = {"material": "sheet", "thickness": 0.001}
    for layers in ([foam, concrete], [sheet, foam], [concrete, foam]):
        run = mc.simulate(shell(layers), climate, step=step, start="2001-07-01", end="2001-07-04")
        assert run.warnings == ()


def test_set_points_that_jump_are_no_reason(climate: mc.Climate) -> None:
    building = shell([{"material": "sheet", "thickness": 0.001}], heating={"setpoint": 25})
    run = mc.simulate(building, climate, step="1h", start="2001-07-01", end="2001-07-04")
    assert run.warnings == ()


@pytest.mark.parametrize(
    ("residual", "closes"), [(0.0, True), (1e-10, True), (1.1e-10, False), (float("nan"), False)]
)
def test_the_limit(residual: float, closes: bool) -> None:
    ledger = EnergyLedger(dict.fromkeys(FLOWS, 0.0), 0.0, 1.0, residual)
    assert ledger.closes is closes
    assert bool(ledger.warnings()) is not closes
