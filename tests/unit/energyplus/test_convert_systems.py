"""Doors of cold rooms, vapour and cold water of EnergyPlus: entered parts, and both programs.

Results of EnergyPlus lie in ``idf_small/energyplus.npz``, made by ``bench/energyplus_small.py``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin.energyplus import Conversion, convert
from mascarin.energyplus.zones.doors import discharge
from mascarin.energyplus.zones.water import mains_temperature
from mascarin.errors import InputError
from small_models import energyplus_small

HERE = Path(__file__).resolve().parents[2]
SMALL = HERE / "idf_small"


@pytest.fixture(scope="module")
def bench(data_dir: Path) -> Any:
    """The module that reads the references."""
    return energyplus_small()


def changed(tmp_path: Path, name: str, *changes: tuple[str, str]) -> Conversion:
    """A small model with changes."""
    text = (SMALL / f"{name}.idf").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "model.idf").write_text(text, encoding="utf-8")
    return convert(tmp_path / "model.idf")


# ------------------------------------------------------------------ doors


@pytest.mark.parametrize(("cold", "warm", "factor"), [(20.0, 23.0, 1.1), (3.0, 23.0, 0.8)])
def test_the_flow_of_a_door_is_that_of_energyplus(cold: float, warm: float, factor: float) -> None:
    # The mass flow of the Engineering Reference, by hand: 4 m2, 2.5 m high, at 98930 Pa.
    gas, pressure, gravity = 287.05, 98930.0, 9.80665
    dense, light, site = (pressure / (gas * (273.15 + t)) for t in (cold, warm, 15.0))
    density_factor = (2.0 / (1.0 + (dense / light) ** (1.0 / 3.0))) ** 1.5
    theirs = 0.221 * 4.0 * dense * density_factor * factor * math.sqrt((1.0 - light / dense) * gravity * 2.5)
    mean = 273.15 + 0.5 * (cold + warm)
    ours = discharge(cold, warm) / 3.0 * 4.0 * site * math.sqrt(gravity * 2.5 * (warm - cold) / mean)
    assert ours == pytest.approx(theirs, rel=1e-9)


def test_a_door_has_its_size_its_curtain_and_its_schedule(tmp_path: Path) -> None:
    curtain = convert(SMALL / "cold_door_free.idf").description["air_paths"]["door"]
    assert curtain["between"] == ["a", "b"]
    assert curtain["door"]["width"] * curtain["door"]["height"] == pytest.approx(4.0)
    assert curtain["door"]["open"] == 0.5
    free = changed(tmp_path, "cold_door_free", ("half,2.5,4,AirCurtain", "half,,,None"))
    plain = free.description["air_paths"]["door"]["door"]
    assert (plain["width"], plain["height"]) == (3.0, 3.0), "the defaults of EnergyPlus: 9 m2, 3 m high"
    assert plain["discharge"] == pytest.approx(2.0 * curtain["door"]["discharge"], rel=1e-5)
    strip = changed(tmp_path, "cold_door_free", ("AirCurtain", "StripCurtain"))
    assert strip.description["air_paths"]["door"]["door"]["discharge"] == pytest.approx(
        0.1 * plain["discharge"], rel=1e-5
    )


def test_a_closed_door_and_a_missing_zone(tmp_path: Path) -> None:
    closed = changed(tmp_path, "cold_door_free", ("half,any,0.5", "half,any,0"))
    assert "air_paths" not in closed.description
    with pytest.raises(InputError, match=r"ZoneRefrigerationDoorMixing 'door'"):
        changed(tmp_path, "cold_door_free", ("door,a,b", "door,a,cellar"))


def test_heat_through_a_door_is_that_of_energyplus(bench: Any) -> None:
    conversion = convert(SMALL / "cold_door_ideal.idf")
    year = int(conversion.start[:4])
    theirs = bench.reference("cold_door_ideal")
    ours = bench.simulated(conversion, start=f"{year}-01-01", end=f"{year}-02-01")
    # The door is most of both loads: without it a heats 3287 in place of 9903 kWh a year.
    for zone, which in (("a", "heating"), ("b", "cooling")):
        assert ours[zone].loads[which].sum() == pytest.approx(theirs[zone].loads[which][0], rel=0.03)


# ------------------------------------------------------------------ vapour


def test_an_isotherm_and_its_layers() -> None:
    humidity = convert(SMALL / "vapour_steady.idf").description["humidity"]
    board, screed = humidity["materials"]["board"], humidity["materials"]["screed"]
    by_humidity = dict(zip(board["humidities"], board["contents"], strict=True))
    # 900 kg/m3 of board, u = 0.0068 phi^0.939 + 0.0202 phi^12.2.
    assert by_humidity[0.5] == pytest.approx(900.0 * (0.0068 * 0.5**0.939 + 0.0202 * 0.5**12.2), rel=1e-6)
    assert by_humidity[1.0] == pytest.approx(24.3)
    assert (board["depth"], board["deep_depth"], board["vapour_resistance"]) == (0.004, 0.008, 6.0)
    assert screed == {"capacity": 44.0, "vapour_resistance": 6.6, "depth": 0.004}, "a line, and one layer"
    # 0.1 mm of a coating of 500 is 50 mm of still air, at the boards alone.
    assert humidity["surfaces"] == {f"room_{side}": {"paint": 0.05} for side in "NESWR"}


def test_depths_of_their_own_and_layers_deeper_than_the_board() -> None:
    board = convert(SMALL / "vapour.idf").description["humidity"]["materials"]["board"]
    # By hand at 24 degC, 45 %, 101325 Pa: slope of the isotherm, permeability of still air over 6.
    slope = 0.0068 * 0.939 * 0.45 ** (0.939 - 1.0) + 0.0202 * 12.2 * 0.45**11.2
    permeability = 2.0e-7 * 297.15**0.81 / 101325.0 / 6.0
    surface, deep = (
        math.sqrt(permeability * 2984.7 * hours * 3600.0 / (900.0 * slope * math.pi)) for hours in (24, 504)
    )
    share = 0.0125 / (surface + deep)
    assert board["depth"] + board["deep_depth"] == pytest.approx(0.0125, rel=1e-6)
    assert board["depth"] == pytest.approx(share * surface, rel=1e-3)
    # What is stored and what resists is the same as in layers of these depths.
    assert board["contents"][-1] * board["depth"] == pytest.approx(24.3 * surface, rel=1e-3)
    assert board["vapour_resistance"] * board["deep_depth"] == pytest.approx(6.0 * deep, rel=1e-3)


def test_vapour_of_gains_and_set_points_of_humidity() -> None:
    zone = convert(SMALL / "vapour_ideal.idf").description["humidity"]["zones"]["room"]
    # 100 W of latent heat, by the enthalpy of vapour at the usual 23 degC.
    assert zone["gains"]["room_equipment"]["rate"] == pytest.approx(100.0 / (2500940.0 + 1858.95 * 23.0))
    assert zone["drying"] == {"relative_humidity": 0.6}
    assert zone["humidifying"] == {"relative_humidity": 0.3}


def test_a_coil_dries_by_default(tmp_path: Path) -> None:
    usual = changed(tmp_path, "vapour_ideal", (",Humidistat,,Humidistat;", ";"))
    drying = usual.description["humidity"]["zones"]["room"]["drying"]
    assert drying["sensible_heat_ratio"] == 0.7
    # 7.7 g/kg is saturated at about 10 degC at this altitude.
    assert drying["coil_temperature"] == pytest.approx(10.0, abs=0.3)


def test_no_vapour_without_its_method(tmp_path: Path) -> None:
    plain = ("MoisturePenetrationDepthConduction", "Conduction")
    conversion = changed(tmp_path, "vapour", plain)
    assert "humidity" not in conversion.description
    assert conversion.complete
    converted = changed(
        tmp_path,
        "vapour",
        plain,
        ("  SimulationControl,", "  SurfaceProperty:HeatTransferAlgorithm,room N,"
         "MoisturePenetrationDepthConductionTransferFunction;\n  SimulationControl,"),
    )  # fmt: skip
    surfaces = converted.description["humidity"]["surfaces"]
    assert surfaces["room_N"] == {"paint": 0.05}
    assert surfaces["room_S"] == {"sealed": True}, "solved by heat alone"
    assert surfaces["room_F"] == {"sealed": True}


def test_a_content_that_falls_is_left_out(tmp_path: Path) -> None:
    conversion = changed(tmp_path, "vapour_steady", ("0.0068,0.939,0.0202", "-0.0068,0.939,0.0002"))
    assert "board" not in conversion.description["humidity"]["materials"]
    assert not conversion.complete


def test_humidity_at_a_constant_temperature_is_that_of_energyplus(bench: Any) -> None:
    # Both programs solve the same equations there. A source 5 % larger gives 0.50 %, no second layer 0.9 %, a
    # floor that takes up nothing 1.0 %.
    conversion = convert(SMALL / "vapour_steady.idf")
    year = int(conversion.start[:4])
    ours = bench.simulated(conversion, start=f"{year}-01-01", end=f"{year}-02-01")["room"].humidity
    theirs = bench.reference("vapour_steady")["room"].humidity[:744]
    assert float(np.std(theirs)) > 5.0, "the room swings"
    assert float(np.sqrt(np.mean((ours - theirs) ** 2))) < 0.4


def test_the_stated_effect_of_sorption_is_right_within_a_factor_of_two() -> None:
    # `vapour.idf` in EnergyPlus 25.2 by this method and by conduction alone: rms of the hourly air of a year.
    measured = 0.295
    findings = convert(SMALL / "vapour.idf").findings
    stated = {one.kelvin or 0.0 for one in findings if "MoisturePenetrationDepth" in one.kind}
    assert all(0.5 * measured <= kelvin <= 2.0 * measured for kelvin in stated)
    assert len(stated) == 1


def test_humidity_that_moves_with_temperatures_is_near_energyplus(bench: Any) -> None:
    # The rules of both programs differ: docs/humidity.md.
    conversion = convert(SMALL / "vapour_ideal.idf")
    year = int(conversion.start[:4])
    ours = bench.simulated(conversion, start=f"{year}-01-01", end=f"{year}-02-01")["room"].humidity
    theirs = bench.reference("vapour_ideal")["room"].humidity[:744]
    assert float(np.sqrt(np.mean((ours - theirs) ** 2))) < 2.0
    findings = [one for one in conversion.findings if "MoisturePenetrationDepth" in one.kind]
    assert {one.level for one in findings} == {"approximated"}


# ------------------------------------------------------------------ water and people


def test_water_of_the_mains() -> None:
    # `Site Mains Water Temperature` of EnergyPlus 25.2 on 1, 2 and 3 January, with 9.7 degC and 28.1 K.
    for day, theirs in ((1, 8.35679719), (2, 8.28262861), (3, 8.2098669)):
        assert mains_temperature(9.7, 28.1, day) == pytest.approx(theirs, abs=1e-7)
    # Half a year later south of the equator: by 180 degrees.
    mean = mains_temperature(9.7, 0.0, 1)
    assert mains_temperature(9.7, 28.1, 40, south=True) - mean == pytest.approx(
        mean - mains_temperature(9.7, 28.1, 40)
    )


def test_people_follow_the_air_temperature(tmp_path: Path) -> None:
    people = "  People,crowd,room,on,People,2,,,0.3,,active;\n  Schedule:Constant,active,any,120;\n"
    conversion = changed(
        tmp_path, "base_ideal", ("  Output:Variable,*,Zone Mean", people + "  Output:Variable,*,Zone Mean")
    )
    crowd = conversion.building.zones["room"].gains["crowd"]
    assert (float(crowd.power or 0), float(crowd.radiative), float(crowd.activity or 0)) == (240, 0.3, 120)
    (finding,) = [item for item in conversion.findings if item.kind == "People"]
    assert "moisture is left out" in finding.effect


@pytest.mark.parametrize(
    ("line", "warm"),
    [
        ("ZoneCrossMixing,mix,b,on,Flow/Zone,0.05,,,,a,3;", "a"),
        ("ZoneMixing,mix,b,on,Flow/Zone,0.05,,,,a,3;", "a"),
        ("ZoneMixing,mix,b,on,Flow/Zone,0.05,,,,a,-3;", "b"),
    ],
)
def test_mixing_at_a_temperature_difference_is_controlled(tmp_path: Path, line: str, warm: str) -> None:
    """Above zero the source has to be warmer by it, below zero colder; the flow is between both zones."""
    conversion = changed(tmp_path, "oa_mixing", ("ZoneMixing,mix,b,on,Flow/Zone,0.05,,,,a,0;", line))
    (path,) = conversion.building.air_paths.values()
    assert path.control is not None
    control = conversion.building.controls[path.control]
    assert (control.zone, control.reference_zone) == (warm, "b" if warm == "a" else "a")
    assert control.difference is not None
    assert (float(control.difference.open), float(control.difference.close)) == (3.0, 3.0)
    assert set(path.between) == {"a", "b"}


# ------------------------------------------------------------------ economizers

IDEAL_END = "NoLimit,,,NoLimit,,,,,None,,None,oa;"
ECONOMIZER = "NoLimit,,,NoLimit,,,,,None,,None,oa,,None,DifferentialDryBulb;"
LIMITED = "NoLimit,,,LimitFlowRate,0.3,,,,None,,None,oa,,None,DifferentialDryBulb;"
COOLER = ("cool26,any,26", "cool26,any,24")


@pytest.mark.parametrize(
    ("system", "theirs"), [(IDEAL_END, 119.4), (ECONOMIZER, 68.2), (LIMITED, 78.0)], ids=["no", "free", "0.3"]
)
def test_cooling_with_an_economizer_is_that_of_energyplus(
    bench: Any, tmp_path: Path, system: str, theirs: float
) -> None:
    # "Zone Ideal Loads Supply Air Sensible Cooling Energy" of EnergyPlus 25.2 in May. [kWh]
    conversion = changed(tmp_path, "mechanical_outdoor_air", (IDEAL_END, system), COOLER)
    room = bench.simulated(conversion, start="2017-04-17", end="2017-06-01")["room"]
    ours = room.loads["cooling"][-31 * 24 :].sum()
    assert ours == pytest.approx(theirs, rel=0.025)
    assert room.air.max() < 24.001


def economizer_findings(conversion: Conversion) -> list[tuple[str, str]]:
    return [(one.level, one.what) for one in conversion.findings if "economizer" in one.what]


def test_an_economizer_has_a_law_beside_the_leaks(tmp_path: Path) -> None:
    conversion = changed(tmp_path, "mechanical_outdoor_air", (IDEAL_END, LIMITED), COOLER)
    room = conversion.description["zones"]["room"]
    (leaks,) = (part for part in room["ventilation"].values() if "air_changes" in part)
    assert leaks["air_changes"] == 0.5, "the constant infiltration of the file"
    # 0.25 m3/s above the least flow, in 75 m3: 12 per hour.
    assert room["infiltration"]["formula"].startswith("12*(min(max((Ti - 23.8)/0.2, 0), 1)")
    assert economizer_findings(conversion) == [("approximated", "an economizer that follows the load")]
    enthalpy = changed(
        tmp_path,
        "mechanical_outdoor_air",
        (IDEAL_END, LIMITED.replace("DryBulb", "Enthalpy")),
    )
    assert ("approximated", "an economizer by enthalpy") in economizer_findings(enthalpy)


@pytest.mark.parametrize(
    ("change", "levels"),
    [
        (("AirChanges/Hour,,,,0.5,1,0,0,0", "AirChanges/Hour,,,,0.5,1,0,0.1,0"), ["left out"]),
        (("cool26,any,26", "cool26,any,20"), ["left out"]),
        (("Flow/Zone,0,0,0.05", "Flow/Zone,0,0,0.4"), []),
        (("dual,any,4", "dual,any,1"), []),
    ],
    ids=["leaks by wind", "no range", "flow above its limit", "no cooling"],
)
def test_an_economizer_that_is_no_law_is_listed(
    tmp_path: Path, change: tuple[str, str], levels: list[str]
) -> None:
    conversion = changed(tmp_path, "mechanical_outdoor_air", (IDEAL_END, LIMITED), change)
    assert [level for level, _ in economizer_findings(conversion)] == levels


def test_an_economizer_follows_the_schedules_of_its_system_and_set_point(tmp_path: Path) -> None:
    conversion = changed(
        tmp_path,
        "mechanical_outdoor_air",
        (IDEAL_END, LIMITED),
        (
            "Schedule:Constant,cool26,any,26;",
            "Schedule:Compact,cool26,any,Through: 12/31,For: AllDays,Until: 8:00,30,Until: 18:00,25,"
            "Until: 24:00,30;",
        ),
    )
    room = conversion.description["zones"]["room"]
    assert "Ti - 24.8" in room["infiltration"]["formula"], "the lower set point"
    schedule = conversion.description["schedules"][room["infiltration"]["schedule"]]
    points = [(point["at"], point["value"]) for point in schedule["days"]["all"]]
    assert points == [("00:00", 0), ("08:00", 1), ("18:00", 0)]
