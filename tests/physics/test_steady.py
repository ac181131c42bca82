"""The steady state: sums of U A, ends of long runs, slopes, what has none, the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.cli import main
from mascarin.errors import InputError, SolverError
from mascarin.examples import box, box_climate
from test_boundary_freedom import weather
from test_operative_set_points import AREA, INSIDE, OUTSIDE, RESISTANCE, cell

AIR = {"air_density": 1.2, "air_specific_heat": 1000.0}


def leaky(**zone: Any) -> Building:
    """The cell with infiltration, a bridge and gains, without heating."""
    d = cell(None)
    del d["zones"]["z0"]["heating"]
    d["site"] |= AIR
    bridge = {"psi": 0.1, "length": 30, "outdoors": True}
    d["zones"]["z0"] |= {"infiltration": 0.6, "thermal_bridges": {"edge": bridge}} | zone
    return Building.from_dict(d)


def conductance(rate: float = 0.6) -> float:
    """Sum of U A, air changes and the bridge of the cell [W/K]."""
    wall = AREA / (RESISTANCE + 1.0 / OUTSIDE + 1.0 / INSIDE)
    return wall + 1.2 * 1000.0 * 50.0 * rate / 3600.0 + 0.1 * 30.0


def test_gains_over_the_sum_of_conductances_is_the_rise() -> None:
    state = mc.steady(leaky(gains={"lamp": {"power": 300}}), weather(1, air=-5.0))
    assert state["z0.air_temperature"] == pytest.approx(-5.0 + 300.0 / conductance(), abs=1e-9)
    assert state.flows["gains"] == pytest.approx(300.0, rel=1e-12)
    assert state.imbalance < 1e-12
    assert sum(state.flows.values()) == pytest.approx(0.0, abs=1e-6)


def test_a_load_is_the_loss() -> None:
    building = leaky(heating={"setpoint": 21})
    state = mc.steady(building, weather(1, air=-5.0), outputs=["z0.heating_load"])
    assert state["z0.heating_load"] == pytest.approx(26.0 * conductance(), rel=1e-10)


def test_slopes_are_those_of_the_closed_form() -> None:
    """``T = T_o + P/K``: slopes ``1/K`` by the power, ``-P/K^2 dK/dn`` by the air change."""
    paths = ["zones.z0.gains.lamp.power", "zones.z0.infiltration.constant"]
    state = mc.steady(leaky(gains={"lamp": {"power": 300}}), weather(1, air=-5.0), vary=paths)
    by_power, by_rate = (state.slopes[path]["z0.air_temperature"] for path in paths)
    assert by_power == pytest.approx(1.0 / conductance(), rel=1e-9)
    per_change = 1.2 * 1000.0 * 50.0 / 3600.0
    assert by_rate == pytest.approx(-300.0 / conductance() ** 2 * per_change, rel=1e-9)


def test_the_end_of_a_long_run_comes_to_it() -> None:
    """Natural convection, radiation to the sky, sun in the clouds: forty days of the same weather."""
    calm = weather(40, air=3.0)
    run = mc.simulate(box(), calm, step="1h", initial=10.0)
    state = mc.steady(box(), calm)
    assert "facade.outside_temperature" in state.values
    for name, value in state.values.items():
        assert run[name].to_numpy()[-1] == pytest.approx(value, abs=1e-6)


def test_the_moment_is_that_of_the_weather() -> None:
    noon, night = (mc.steady(box(), box_climate(), moment=f"2001-07-01 {hour}:00") for hour in ("12", "02"))
    assert noon.moment == "2001-07-01 12:00"
    assert noon.flows["solar"] > 1000.0
    assert night.flows["solar"] == 0.0
    assert noon["room.air_temperature"] > night["room.air_temperature"] + 1.0


def test_what_has_no_steady_state_is_refused() -> None:
    d = cell(None)
    del d["zones"]["z0"]["heating"]
    d["zones"]["z0"]["gains"] = {"lamp": {"power": 300}}
    d["surfaces"]["s0"]["outside"] = {"adiabatic": True}
    with pytest.raises(SolverError, match=r"steady state|below|above|limit"):
        mc.steady(Building.from_dict(d), weather(1))


def test_the_command_prints_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cell.yaml"
    d = cell(None)
    d["site"] |= {"latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"}
    file.write_text(json.dumps(d))
    options = ["run", str(file), "--weather", "shipped:golden", "--steady", "--start", "2001-01-15 12:00"]
    assert main([*options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    outdoors = 21.0 - found["flows"]["heating_watt"] * (RESISTANCE + 1 / OUTSIDE + 1 / INSIDE) / AREA
    assert -25.0 < outdoors < 25.0
    assert found["imbalance"] < 1e-9
    assert main(options) == 0
    assert "sum of the flows" in capsys.readouterr().out
    assert main([*options, "--end", "2001-02-01"]) != 0
    assert "beside --steady" in capsys.readouterr().err


def test_a_path_that_does_not_exist_is_refused() -> None:
    with pytest.raises(InputError):
        mc.steady(leaky(), weather(1), vary=["zones.z9.volume"])


def test_a_moment_before_the_weather_is_refused() -> None:
    with pytest.raises(InputError, match="outside the data"):
        mc.steady(leaky(), weather(1), moment="1999-01-01")


def test_the_end_of_the_weather_is_a_moment() -> None:
    """The step that ends there is one of the weather."""
    state = mc.steady(leaky(), weather(1, air=-5.0), moment="2001-01-02 00:00")
    assert state.moment == "2001-01-02 00:00"
    assert state["z0.air_temperature"] == pytest.approx(-5.0, abs=1e-9)


def test_a_law_that_does_not_hold_is_said_where_it_ends() -> None:
    """The air begins at 20 degC, 25 K above the outdoors, and comes to 300 W over all conductances."""
    rise = 300.0 / conductance()
    lamp = {"lamp": {"power": 300}}
    for limit, said in ((0.9 * rise, True), (1.1 * rise, False)):
        law = {"formula": "0.6 + 0*dT", "valid": f"abs(dT) < {limit:.6f}"}
        state = mc.steady(leaky(infiltration=law, gains=lamp), weather(1, air=-5.0))
        assert state["z0.air_temperature"] == pytest.approx(-5.0 + rise, abs=1e-9)
        assert any("in the steady state" in line for line in state.warnings) is said


def test_minimum_times_of_a_control_may_be_longer_than_the_step() -> None:
    d = leaky(gains={"lamp": {"power": 300}}).to_dict()
    d["controls"] = {"warm": {"zone": "z0", "indoor": {"open": 24, "close": 18}, "minimum_open_time": 600}}
    d["openings"] = {"pane": {"zone": "z0", "area": 0.2, "height": 1, "control": "warm"}}
    state = mc.steady(Building.from_dict(d), weather(1, air=18.0))
    assert state.imbalance < 1e-9


def test_the_command_warns_as_a_run_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cell.yaml"
    d = cell(None)
    d["site"] |= {"latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"}
    d["zones"]["z0"]["volume"] = 5e4
    file.write_text(json.dumps(d))
    period = ["--start", "2001-01-15", "--end", "2001-01-16", "--initial", "20"]
    run = ["run", str(file), "--weather", "shipped:golden"]
    assert main([*run, *period]) == 0
    of_run = [line for line in capsys.readouterr().err.splitlines() if "z0: " in line]
    assert main([*run, "--steady", *period[:2]]) == 0
    of_state = capsys.readouterr().err
    assert of_run
    assert all(line in of_state for line in of_run)
    assert "assumed values" in of_state
    assert main([*run, "--steady", "--scheme", "linearly-implicit"]) != 0
    assert "--scheme: found it beside --steady" in capsys.readouterr().err
