"""More names in laws of convection, conductivity, infiltration, sky and outputs as text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from fmu_support import instance
from mascarin.building import Building, TextInfiltration
from mascarin.ensemble import sweep
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.fmu import export
from mascarin.measurements import Sensor
from mascarin.simulation.simulation import Simulation
from mascarin.verification.analytical import setup

BUILDINGS = Path(mc.__file__).parent / "verification" / "bestest" / "buildings"
OUTSIDE = "surfaces.facade.outside.convection"
INSIDE = "surfaces.facade.inside.convection"
AROUND = {
    "formula": "c*(273.15 + Ts)^0.5/17*abs(dT)^(1/3) + b*V*(1 + cos(wind_angle*pi/180))\n"
    "+ s*sun/100 + 0.1*height",
    "c": {"value": 1.5, "range": [1, 2]},
    "b": {"value": 1.2, "range": [0.5, 2]},
    "s": {"value": 0.1, "range": [0.0, 0.5]},
    "valid": "Ts > -60 and Ta < 80",
}
IN_ROOM = {
    "formula": "c*(273.15 + Ta)^0.5/17*abs(dT)^(1/3) + 0.4*air_change",
    "c": {"value": 1.5, "range": [1, 2]},
}
CONDUCTIVITY = {
    "formula": "k*(1 + a*T)",
    "k": {"value": 1.5, "range": [1, 2], "unit": "W/(m K)"},
    "a": {"value": 0.004, "range": [0.001, 0.006], "unit": "1/K"},
    "valid": "T > -50",
}
INFILTRATION = {
    "formula": "c*sqrt(s*abs(dT) + w*V^2) + 0.001*(Ti + 60)",
    "c": {"value": 1.0, "range": [0.5, 2]},
    "s": {"value": 0.015, "range": [0.01, 0.02]},
    "w": {"value": 0.02, "range": [0.005, 0.04]},
}
SKY = {
    "formula": "a + b*sqrt(pw/100)",
    "a": {"value": 0.6, "range": [0.5, 0.7]},
    "b": {"value": 0.06, "range": [0.04, 0.08]},
}
DERIVED: dict[str, Any] = {
    "gain": {
        "formula": "A*facade.inside_flux + k*(facade.inside_temperature - room.air_temperature)",
        "A": {"value": 10.0, "range": [5, 15], "unit": "m2"},
        "k": {"value": 2.0, "unit": "W/K"},
        "unit": "W",
    },
    "half": "gain/2",
    "flux": {"formula": "facade.inside_flux - facade.outside_flux", "unit": "W/m2"},
}


def box_with(changes: dict[str, Any]) -> Building:
    description = box().to_dict()
    for path, value in changes.items():
        part, keys = description, path.split(".")
        for key in keys[:-1]:
            part = part.setdefault(key, {})
        part[keys[-1]] = value
    return Building.from_dict(description)


def material() -> str:
    return next(iter(box().materials))


def run_of(building: Building, outputs: list[str], **options: Any) -> Simulation:
    options = {"step": "1h", "initial": 20.0, **options}
    return Simulation(building, box_climate(), outputs=outputs, **options)


def all_laws() -> Building:
    return box_with(
        {
            OUTSIDE: AROUND,
            INSIDE: IN_ROOM,
            "surfaces.facade.outside.height": 3.0,
            f"materials.{material()}.conductivity": CONDUCTIVITY,
            "zones.room.infiltration": INFILTRATION,
            "site.sky": SKY,
            "derived_outputs": DERIVED,
        }
    )


PATHS = [
    *(f"{OUTSIDE}.{name}" for name in "cbs"),
    f"{INSIDE}.c",
    *(f"zones.room.infiltration.{name}" for name in "csw"),
    *(f"site.sky.{name}" for name in "ab"),
    "derived_outputs.gain.A",
]


def paths() -> list[str]:
    return [*PATHS, *(f"materials.{material()}.conductivity.{name}" for name in "ka")]


OUTPUTS = ["facade.outside_temperature", "room.air_temperature", "gain"]


def test_a_coefficient_by_the_air_the_angle_and_the_height() -> None:
    law = {"formula": "8 + 0.05*Ta + 0.01*wind_angle + height", "valid": "Ta > -60"}
    building = box_with({OUTSIDE: law, "surfaces.facade.outside.height": 3.0})
    run = run_of(building, ["facade.outside_convection"])
    tilt, azimuth = (float(getattr(building.surfaces["facade"], key)) for key in ("tilt", "azimuth"))
    cosine = np.sin(np.radians(tilt)) * np.cos(np.radians(200.0 - azimuth))
    expected = 8.0 + 0.05 * run.weather("air_temperature") + 0.01 * np.degrees(np.arccos(cosine)) + 3.0
    assert np.ptp(expected) > 0.3
    assert np.abs(run.run().records[1:, 0] - expected[1:]).max() < 1e-9


def test_in_a_zone_the_air_is_that_at_the_start_of_the_step() -> None:
    law = {"formula": "2 + 0.05*Ta + 0.5*air_change"}
    building = box_with({INSIDE: law, "zones.room.infiltration": 0.6})
    run = run_of(building, ["facade.inside_convection", "room.air_temperature", "room.air_changes"]).run()
    coefficient, air, changes = run.records.T
    assert np.abs(np.diff(air)).max() > 0.05
    # The first step is made in parts: its last part starts later.
    assert np.abs(coefficient[2:] - (2.0 + 0.05 * air[1:-1] + 0.5 * changes[2:])).max() < 1e-9


def test_the_sun_and_the_surface_in_a_coefficient() -> None:
    law = {"formula": "6 + sun/100 + 0*Ts"}
    building = box_with({OUTSIDE: law})
    names = ["facade.outside_convection", "facade.incident_solar"]
    coefficient, sun = run_of(building, names, scheme="backward-euler").run().records.T
    assert sun.max() > 100.0
    assert np.abs(coefficient[1:] - (6.0 + sun[1:] / 100.0)).max() < 1e-9


def test_derivatives_by_the_numbers_of_all_laws() -> None:
    run = run_of(all_laws(), OUTPUTS)
    slopes = run.jacobian_vector(paths())[1]
    assert np.abs(slopes).max(axis=(1, 2)).min() > 1e-6
    for k, path in enumerate(paths()):
        value = run.building.parameter(path).value
        low, high = (
            run.jacobian_vector(paths(), run.vector({path: value * (1.0 + sign * 1e-4)}))[0]
            for sign in (-1, 1)
        )
        quotient = (high - low) / (2e-4 * value)
        assert np.abs(quotient - slopes[k]).max() < 2e-4 * np.abs(slopes[k]).max(), path
    # Reverse: a weighted sum of all records.
    weights = np.random.default_rng(3).normal(size=slopes.shape[1:])

    def objective(series: Any) -> tuple[float, dict[str, Any]]:
        columns = {name: weights[:, k] for k, name in enumerate(OUTPUTS)}
        return float(sum((series[name] * column).sum() for name, column in columns.items())), columns

    found = run.gradient(objective)
    for k, path in enumerate(paths()):
        expected = (weights * slopes[k]).sum()
        assert found.slopes[path] == pytest.approx(expected, rel=1e-8, abs=1e-8), path


def test_members_of_a_sweep_have_the_bits_of_runs_alone() -> None:
    building = all_laws()
    samples = {path: np.linspace(0.97, 1.03, 9) * building.parameter(path).value for path in paths()}
    options: dict[str, Any] = {"outputs": OUTPUTS, "step": "1h", "initial": 20.0}
    swept = sweep(building, box_climate(), samples, **options)
    for member in (0, 5, 8):
        one = building.with_values({path: column[member] for path, column in samples.items()})
        alone = mc.simulate(one, box_climate(), **options)
        for k, name in enumerate(OUTPUTS):
            assert np.array_equal(swept[name].to_numpy()[member], alone.records[:, k])


def test_a_unit_has_the_laws_and_the_derived_output(tmp_path: Path) -> None:
    run = run_of(all_laws(), OUTPUTS)
    chosen = ["derived_outputs.gain.A", "zones.room.infiltration.c", f"{INSIDE}.c"]
    export(run, tmp_path / "box.fmu", parameters=chosen)
    values = {chosen[0]: 11.0, chosen[1]: 1.2, chosen[2]: 1.4}
    expected = run.run(values).records
    with instance(tmp_path / "box.fmu") as unit:
        unit.start(**values)
        found = unit.run(OUTPUTS, 0, len(expected) - 1, 3600.0)
        unit.slave.terminate()
    assert np.abs(found - expected[1:]).max() < 1e-9


def test_a_constant_conductivity_as_text_runs_as_the_number() -> None:
    name = material()
    value = float(box().parameter(f"materials.{name}.conductivity").value)
    numbers, text = (
        run_of(box_with({f"materials.{name}.conductivity": law}), OUTPUTS[:2], step="10min").run().records
        for law in (value, {"formula": "k + 0*T", "k": value})
    )
    # A layer of constant properties is solved by other operations.
    assert np.abs(text - numbers).max() < 1e-9


def test_a_steady_wall_whose_conductivity_rises_with_temperature() -> None:
    # The integral of the conductivity over temperature gives the flux: k (30 - 10)(1 + 20 a)/0.2.
    text = """
materials:
  brick: {conductivity: {formula: "0.8*(1 + 0.01*T)", valid: "T > -20"}, density: 800, specific_heat: 900}
constructions: {wall: {layers: [{material: brick, thickness: 0.2, nodes: 40}]}}
surfaces: {wall: {construction: wall, area: 1, tilt: 90, outside: {measured: T_1}, inside: {measured: T_2}}}
"""
    columns: dict[str, Any] = {"T_1": np.full(481, 10.0), "T_2": 30.0}
    run = setup.run(text, 3600.0, columns, step=3600.0, outputs=["wall.inside_flux", "wall.outside_flux"])
    expected = -0.8 * 20.0 * (1.0 + 0.01 * 20.0) / 0.2
    assert np.abs(run.records[-1] / expected - 1.0).max() < 2e-4


def test_the_stack_and_wind_of_a_pressure_test_as_text() -> None:
    test = {"kind": "stack_wind", "n50": 2.2}
    n = 2.2 * 0.08**0.65 * 10.0 * 0.15**0.5
    law = {"formula": "n*sqrt(0.000145*abs(dT) + 0.000174*V^2)", "n": n}
    built_in, text = (
        run_of(box_with({"zones.room.infiltration": value}), [*OUTPUTS[:2], "room.air_changes"]).run().records
        for value in ({"blower_door": test}, law)
    )
    assert np.abs(text - built_in).max() < 1e-9
    assert isinstance(box_with({"zones.room.infiltration": law}).zones["room"].infiltration, TextInfiltration)


def test_brunts_sky_as_text_and_a_temperature() -> None:
    names = [*OUTPUTS[:1], "sky_temperature"]
    brunt = {"kind": "brunt", "a": 0.6, "b": 0.06}
    layer = {"cloud": {"kind": "layer"}}
    built_in, text = (
        run_of(box_with({"site.sky": sky, **{f"site.{k}": v for k, v in layer.items()}}), names).run().records
        for sky in (brunt, SKY)
    )
    assert np.abs(text - built_in).max() < 1e-9
    sky = {"formula": "To - 12", "of": "temperature"}
    run = run_of(box_with({"site.sky": sky}), names)
    found = run.run().records[1:, 1]
    assert np.abs(found + 12.0 - run.weather("air_temperature")[1:]).max() < 1e-9


def test_derived_outputs_are_outputs() -> None:
    building = all_laws()
    names = ["gain", "half", "flux", "facade.inside_flux", "facade.outside_flux",
             "facade.inside_temperature", "room.air_temperature"]  # fmt: skip
    gain, half, flux, inside, outside, surface, air = run_of(building, names).run().records.T
    assert np.allclose(gain, 10.0 * inside + 2.0 * (surface - air), rtol=0, atol=1e-9)
    assert np.array_equal(half, gain / 2.0)
    assert np.allclose(flux, inside - outside, rtol=0, atol=1e-12)
    output = building.output("flux")
    assert (output.unit, output.mean, building.output("gain").mean, output.usual) == (
        "W/m2",
        True,
        False,
        False,
    )
    assert Building.from_dict(building.to_dict()) == building


def test_two_numbers_are_calibrated_by_a_derived_output() -> None:
    building, climate = all_laws(), box_climate()
    truth = {f"{OUTSIDE}.c": 1.7, "derived_outputs.gain.A": 12.0}
    run = mc.simulate(building.with_values(truth), climate, step="1h", outputs=["gain", OUTPUTS[0]])
    noise = 1e-3 * np.random.default_rng(5).normal(size=run.records.shape)
    table = pd.DataFrame(run.records + noise, columns=["Q", "T"], index=run.index)
    sensors = {
        "gain": Sensor("Q", standard_uncertainty=1e-3),
        OUTPUTS[0]: Sensor("T", standard_uncertainty=1e-3),
    }
    found = mc.calibrate(
        building, climate, mc.Measurements.from_table(table, timezone="UTC-07:00"), step="1h", warm_up="1d",
        sensors=sensors, vary=list(truth),
    )  # fmt: skip
    for path, value in truth.items():
        assert found.values[path] == pytest.approx(value, rel=1e-2)  # noqa: PD011


def test_a_sensitivity_of_a_derived_output_names_the_numbers() -> None:
    chosen = ["derived_outputs.gain.A", f"{OUTSIDE}.c"]
    found = mc.sensitivity_analysis(
        all_laws(), box_climate(), outputs=["gain"], method="morris", step="1h", vary=chosen
    )
    assert set(found.ranking("gain", 2)) == set(chosen)


def test_windows_have_laws_of_what_is_around_them() -> None:
    building = mc.load(BUILDINGS / "600.yaml")
    name = next(iter(building.windows))
    law = {"formula": "8 + wind_angle/100 + 0.02*(Ts + 40) + sun/500", "valid": "Ts > -39"}
    changed = building.replace({f"windows.{name}.outside.convection": law})
    assert changed.windows[name].outside.convection.kind == "text"
    with pytest.raises(InputError, match="No wind reaches this side"):
        building.replace({f"windows.{name}.inside.convection": law})


def material_as(law: str) -> tuple[str, str]:
    return ("conductivity: 1.75", f"conductivity: {law}")


def leak(law: str) -> tuple[str, str]:
    return ("infiltration: 0.5", f"infiltration: {law}")


def sky(law: str) -> tuple[str, str]:
    return ("sky: {kind: offset}", f"sky: {law}")


def outside(law: str) -> tuple[str, str]:
    return ("convection: 20", f"convection: {law}")


def derived(section: str) -> tuple[str, str]:
    return ("surfaces:\n", f"derived_outputs: {section}\nsurfaces:\n")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (material_as('{formula: "0.04*(1 + T"}'), "the end of the formula (column 12"),
        (material_as('{formula: "0.04 + a*T"}'), "found: the name 'a' (column 8 of the text)"),
        (material_as('{formula: "k + 0*T", k: {value: 1, unit: "W/(m2 K)"}}'), "a formula in W/(m2 K)"),
        (material_as('{formula: "1/(T - 20)", valid: "T > 18"}'), "a conductivity that is finite"),
        (material_as('{formula: "1 - T/50"}'), "a conductivity of 0.00001 to 10000 W/(m K)"),
        (leak('{formula: "0.1 +* V"}'), "found: '*' (column 6 of the text)"),
        (leak('{formula: "0.1*U"}'), "found: the name 'U' (column 5 of the text)"),
        (leak('{formula: "3*exp(-abs(dT))"}'), "a heat flow n dT that falls"),
        (leak('{formula: "0.1 + 0*(a + V)", a: {value: 1, unit: K}}'), "K beside m s^-1"),
        (leak('{formula: "1/(V - 3)"}'), "an air change"),
        (sky('{formula: "0.6 + x"}'), "found: the name 'x' (column 7 of the text)"),
        (sky('{formula: "0.6 + log(pw - 500)"}'), "an emissivity of the sky that is finite"),
        (sky('{formula: "0.1*To"}'), "an emissivity of the sky of 0 to 1.5"),
        (sky('{formula: "0.5 + a*pw", a: {value: 1e-4, unit: "1/K"}}'), "a formula in"),
        (outside('{formula: "3 + air_change"}'), "This side faces no zone"),
        (outside('{formula: "3 + (Ts - 40)^2/20"}'), "falls from"),
        (outside('{formula: "3 + Ta", valid: "sun < 9"}'), "Say where the law holds by dT, Ts, Ta and V"),
        (outside('{formula: "a*sun", a: {value: 1, unit: "1/m"}}'), "a formula in"),
        (derived('{gain: "room.air_temperature*(2"}'), "the formula (column 24 of the text)"),
        (derived('{gain: "room.air_temprature*2"}'), "(column 1 of the text)"),
        (derived('{gain: "room.air_temperature + facade.inside_flux"}'), "K beside W/m2"),
        (derived('{gain: {formula: "abs(facade.inside_flux)", unit: W}}'), "a formula in W/m2"),
        (derived('{a: "2*b", b: "a + room.air_temperature"}'), "a loop of derived outputs: a -> b -> a"),
        (derived('{sky_temperature: "2*room.air_temperature"}'), "a name that no other output has"),
    ],
)  # fmt: skip
def test_bad_texts_are_refused_with_file_line_and_column(
    change: tuple[str, str], words: str, tmp_path: Path
) -> None:
    text = (Path(mc.__file__).parent / "examples" / "box.yaml").read_text("utf-8")
    assert change[0] in text
    file = tmp_path / "bad.yaml"
    file.write_text(text.replace(*change), "utf-8")
    place = text.replace(*change).split(change[1])[0].count("\n") + 1
    with pytest.raises(InputError) as refused:
        mc.load(file)
    assert words in str(refused.value), str(refused.value)
    assert f"bad.yaml:{place}:" in str(refused.value)


def test_values_beyond_the_ranges_that_make_no_law() -> None:
    path = f"materials.{material()}.conductivity.a"
    with pytest.raises(InputError, match=r"a conductivity of .* Take other values"):
        run_of(all_laws(), OUTPUTS).jacobian_vector([path], run_of(all_laws(), OUTPUTS).vector({path: 0.03}))


def limited_laws() -> Building:
    """The cell with laws that hold in a part of the day only."""
    return box_with(
        {
            f"materials.{material()}.conductivity": CONDUCTIVITY | {"valid": "T < 21"},
            "zones.room.infiltration": INFILTRATION | {"valid": "abs(dT) < 4"},
            "site.sky": SKY | {"kind": "text", "valid": "pw < 100"},
        }
    )


LIMITED = ["room.air_temperature"]


def test_a_run_outside_of_the_validity_of_each_law_warns() -> None:
    simulation = run_of(limited_laws(), LIMITED)
    run = simulation.run()
    found = {line.split(":")[0]: line for line in run.warnings if "'valid'" in line}
    (layer,) = [place for place in found if "(layer" in place]
    assert set(found) == {layer, "zone room", "site"}
    assert "its law of conductivity" in found[layer]
    assert "with T from 2" in found[layer]
    assert "its law of infiltration" in found["zone room"]
    room, outdoor = run.records[1:, 0], simulation.weather("air_temperature")[1:]
    outside = np.abs(room - outdoor) >= 4.0
    assert 0 < int(outside.sum()) < len(outside)
    assert f"at the end of {int(outside.sum())} step" in found["zone room"]
    difference = (room - outdoor)[outside]
    assert f"dT from {difference.min():.1f} to {difference.max():.1f} K" in found["zone room"]
    assert "its law of the sky" in found["site"]
    assert "pw " in found["site"]


def test_a_law_that_holds_does_not_warn_and_a_unit_warns(tmp_path: Path) -> None:
    assert not [line for line in run_of(all_laws(), LIMITED).run().warnings if "'valid'" in line]
    run = run_of(limited_laws(), LIMITED)
    export(run, tmp_path / "box.fmu")
    steps = len(run.run().records) - 1
    with instance(tmp_path / "box.fmu") as unit:
        unit.start()
        unit.run(LIMITED, 0, steps, 3600.0)
        unit.slave.terminate()
        for law in ("conductivity", "infiltration", "the sky"):
            assert any(f"law of {law} does not hold" in text for _, text in unit.heard)


def test_clouds_act_on_a_sky_whose_validity_names_them() -> None:
    """An emissivity without clouds is that of the clear sky, wherever it says that it holds."""
    plain, limited = (
        run_of(box_with({"site.sky": SKY | {"kind": "text"} | more}), ["sky_temperature"]).run().records
        for more in ({}, {"valid": "cloud < 2"})
    )
    assert np.array_equal(plain, limited)
    law = box_with({"site.sky": SKY | {"kind": "text", "valid": "cloud < 2"}}).site.sky
    assert not law.clouded


def test_a_number_that_only_the_validity_uses() -> None:
    law = INFILTRATION | {"most": {"value": 4.0, "range": [3, 5]}, "valid": "abs(dT) < most"}
    run = run_of(box_with({"zones.room.infiltration": law}), LIMITED).run()
    assert [line for line in run.warnings if line.startswith("zone room: its law of infiltration")]
