"""Checks of a building before a run."""

from __future__ import annotations

import pytest

from building_samples import EVERYTHING, ROOM, everything, room
from mascarin.building import Building, check
from mascarin.building.checks.u_values import time_constant, u_value
from mascarin.building.engine_input.mesh import choose
from mascarin.building.parts.site_air import density
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.simulation.linear_model import state_space


def test_u_value_of_a_wall() -> None:
    """0.2 m of concrete at 1.75 W/(m K) between the surface resistances 0.04 and 0.13 m2K/W of ISO 6946."""
    building = room()
    assert u_value(building, building.surfaces["south"]) == pytest.approx(1 / (0.04 + 0.2 / 1.75 + 0.13))


def test_u_value_of_a_floor_on_the_ground() -> None:
    building = everything()[0]
    layers = 0.1 / 1.75 + 0.15 + 0.02 / 1.75
    assert u_value(building, building.surfaces["floor"]) == pytest.approx(1 / (layers + 0.17))


def test_a_given_coefficient_is_used_where_it_includes_radiation() -> None:
    """Outdoors without separate long-wave exchange the constant coefficient is used, otherwise ISO 6946."""
    combined = parse(
        ROOM.replace("emissivity: 0.9, absorptance", "longwave: none, emissivity: 0.9, absorptance"), "x"
    )
    assert u_value(combined, combined.surfaces["south"]) == pytest.approx(1 / (1 / 15 + 0.2 / 1.75 + 0.13))
    assert "surface resistances: described outside, ISO 6946 inside" in check(combined)[2]
    both = combined.replace({"zones.room.longwave": "none"})
    assert u_value(both, both.surfaces["south"]) == pytest.approx(1 / (1 / 15 + 0.2 / 1.75 + 1 / 3))
    assert check(both)[2].endswith(", described surface resistances")
    corrugated = both.replace({"surfaces.south.outside.area_factor": 1.2})
    assert u_value(corrugated, corrugated.surfaces["south"]) == pytest.approx(
        1 / (1 / 18 + 0.2 / 1.75 + 1 / 3)
    )


def test_an_adiabatic_side_has_no_heat_flow() -> None:
    building = room()
    assert u_value(building, building.surfaces["rest"]) == 0.0
    total = 16 * u_value(building, building.surfaces["south"])
    assert f"UA {total:.2f} W/K" in check(building)[1]


def infiltration(building: Building) -> float:
    return float(check(building)[1].split("infiltration ")[1].split(" W/K")[0])


def test_density_of_the_air_is_that_of_the_engine() -> None:
    """Standard atmosphere: 1013.25 hPa at sea level, 826 hPa at 1700 m; a written density comes first."""
    site = room().replace({"site.altitude": 0.0}).site
    assert density(site) == pytest.approx(1.2250, abs=2e-4)
    low, high = (room().replace({"site.altitude": metres}) for metres in (55.0, 1650.0))
    assert density(high.site) / density(low.site) == pytest.approx(0.824, abs=0.001)
    assert infiltration(high) / infiltration(low) == pytest.approx(0.824, abs=0.002)
    written = room().replace({"site.air_density": 1.0})
    assert infiltration(written) == pytest.approx(1.0 * 1006 * 0.5 * 30 / 3600, abs=0.005)


def test_the_engine_uses_the_same_density() -> None:
    """The part of the air's rate by convection is proportional to 1/density, that by air changes is not."""
    linear = parse(
        ROOM.replace("emissivity: 0.9, absorptance", "longwave: none, emissivity: 0.9, absorptance"), "x"
    ).replace({"zones.room.longwave": "none"})

    def by_films(building: Building) -> float:
        system = state_space(building)
        air = next(i for i, name in enumerate(system.states) if "air" in name)
        return float(-system.a[air, air] - 0.5 / 3600)

    light = by_films(linear.replace({"site.air_density": 1.0}))
    for metres in (0.0, 55.0, 1650.0):
        high = linear.replace({"site.altitude": metres})
        assert light / by_films(high) == pytest.approx(density(high.site), rel=1e-9)


def test_smallest_time_constant() -> None:
    """Nine equal nodes: those inside have neighbours on both sides."""
    building = room()
    nodes = choose(building, 900).nodes["wall", "concrete"]
    width = 0.2 / nodes
    inner = 2240 * 900 * width / (2 * 1.75 / width)
    outer = 2240 * 900 * width / (1.75 / width + 1 / (0.5 * width / 1.75 + 1 / 15))
    assert time_constant(building, "wall", choose(building, 900)) == pytest.approx(min(inner, outer))


def test_lines_of_a_check() -> None:
    lines = check(room(), 900)
    assert lines[0] == "room: 1 zone, 2 surfaces, 37 parameters"
    assert lines[1].startswith("zone room: 30 m3, 2 surfaces of 66.00 m2, UA ")
    assert "infiltration 5.07 W/K (air of 1.211 kg/m3)" in lines[1]
    assert "view factors approximated by areas" in lines[1]
    assert lines[2].startswith(
        "surface south: wall, 16.00 m2, tilt 90, azimuth 180, outdoors -> room, U 3.518 W/(m2 K), "
        "ISO 6946 surface resistances"
    )
    assert lines[3].endswith("adiabatic -> room, U 0.000 W/(m2 K), adiabatic")
    assert lines[4].startswith("construction wall: nodes concrete 9, smallest time constant ")


def noted(building: Building, word: str, step: float = 900.0) -> list[str]:
    return [line for line in check(building, step) if line.startswith(f"{word}:")]


def test_a_step_that_may_overshoot_is_no_warning_but_stands_with_the_time_constant() -> None:
    building = room()
    least = time_constant(building, "wall", choose(building, 900))
    said = (
        f"smallest time constant {least:.0f} s (after a jump, steps above {2.4 * least:.0f} s may overshoot"
    )
    assert sum(said in line for line in check(building, 900.0)) == 1
    assert not any("overshoot" in line for line in noted(building, "warning"))
    coarse = building.replace({"constructions.wall.layers.concrete.nodes": 1})
    assert not any("overshoot" in line for line in check(coarse, 900.0))


def test_surfaces_that_cannot_enclose_the_volume() -> None:
    small = parse(ROOM.replace("area: 50", "area: 5"), "x")
    assert any(
        "21.00 m2 of surfaces cannot enclose 30 m3 (a sphere needs 46.69 m2)" in w
        for w in noted(small, "warning")
    )
    assert not any("sphere" in w for w in noted(room(), "warning"))
    huge = parse(ROOM.replace("volume: 30", "volume: 1.0e+308"), "x")  # its square is no number
    assert any("cannot enclose 1e+308 m3" in w for w in noted(huge, "warning"))


def test_a_surface_larger_than_all_others() -> None:
    """Two surfaces enclose a zone only if they are equal; internal mass does not enclose it."""
    told = [w for w in noted(room(), "warning") if "zones.room: the surfaces cannot enclose it" in w]
    assert len(told) == 1
    assert "rest has 50.00 m2, all others together 16.00 m2" in told[0]
    assert not [w for w in warned_of(room(), {"surfaces.rest.area": 16.0}) if "cannot enclose it" in w]
    closed = everything()[0]
    assert not [w for w in noted(closed, "warning") if "zones.room: the surfaces" in w]
    # Without the mass the room's walls still enclose it; with walls too small, mass is no help.
    heavy = {"surfaces.mass.area": 500.0, "surfaces.floor.area": 40.0}
    assert [w for w in warned_of(closed, heavy) if "zones.room: the surfaces" in w and "floor has 40.00" in w]


def warned_of(building: Building, values: dict[str, float]) -> list[str]:
    return noted(building.replace(values), "warning")


@pytest.mark.parametrize(
    ("values", "told"),
    [
        # A foam whose conductivity was written in mW/(m K).
        (
            {"conductivity": 30.0, "density": 30.0, "specific_heat": 1400.0},
            "no material of 30 kg/m3 conducts 30",
        ),
        # A density in g/cm3, a conductivity in mW/(m K), a resistance in place of a conductivity.
        ({"conductivity": 0.5, "density": 2.0, "specific_heat": 900.0}, "a diffusivity of 0.00028 m2/s"),
        ({"conductivity": 1750.0}, "a diffusivity of 0.00087 m2/s"),
        ({"conductivity": 0.00175}, "a diffusivity of 8.7e-10 m2/s"),
        ({"conductivity": 0.03, "density": 30.0, "specific_heat": 1400.0}, None),
        ({"conductivity": 400.0, "density": 8960.0, "specific_heat": 385.0}, None),
    ],
)
def test_properties_in_wrong_units_are_warned_of(values: dict[str, float], told: str | None) -> None:
    changed = {f"materials.concrete.{key}": value for key, value in values.items()}
    found = [w for w in warned_of(room(), changed) if "materials.concrete:" in w]
    assert len(found) == (told is not None)
    assert told is None or (told in found[0] and "W/(m K)" in found[0])


def test_both_phases_are_checked() -> None:
    found = warned_of(everything()[0], {"materials.wax.conductivity.liquid": 40.0})
    fitting = "warning: materials.wax (liquid): a diffusivity of 1.7e-05"
    assert not any(w.startswith(fitting) for w in found)  # high, and still within what is known
    found = warned_of(everything()[0], {"materials.wax.conductivity.liquid": 0.018})
    assert any("materials.wax (liquid): a diffusivity of 7.4e-09 m2/s" in w for w in found)
    assert not any("materials.wax (solid)" in w for w in found)


def test_a_specific_heat_in_kilojoules_is_an_error() -> None:
    with pytest.raises(InputError, match=r"found: 1\.4\s+expected: a number at least 100"):
        room().replace({"materials.concrete.specific_heat": 1.4})


def test_vertices_that_contradict_area_and_volume() -> None:
    text = EVERYTHING.replace("    vertices: [[0, 0, 3]", "    area: 8\n    vertices: [[0, 0, 3]")
    assert any(
        "8.00 m2 are given, the vertices enclose 9.12 m2" in w for w in noted(parse(text, "x"), "warning")
    )


def test_assumptions_are_listed() -> None:
    told = noted(room(), "assumed")
    assert any("site.sky: infrared of the weather file, else martin_berdahl" in line for line in told)
    assert any("site.diffuse: perez" in line for line in told)
    assert any("zones.room: view factors by areas" in line for line in told)
    assert any("zones.room.capacity_factor = 1 (" in line for line in told)


def test_melting_is_shown_by_its_width() -> None:
    lines = check(everything()[0], 900)
    assert "material wax: 71000 J/kg about 23.4 degC, half-width 1 K" in lines
    assert "material salt: 150000 J/kg about 27 degC, half-width 1.5 K" in lines
    assert "material curve: melts between 20 and 22 degC, by its table" in lines


def test_unlimited_radiant_loads_are_named() -> None:
    from mascarin.examples import box

    building = box()
    (zone,) = building.zones
    radiant = building.replace({f"zones.{zone}.cooling": {"setpoint": 24, "radiative": 0.95}})
    lines = [line for line in check(radiant) if "% of it is radiation" in line]
    assert lines == [
        f"warning: zones.{zone}.cooling: 95 % of it is radiation and it has no capacity: 1 W at the air "
        "needs 20 W. It gives at most what surfaces at 20 degC emit, 419 W/m2 of black ones. "
        "Give a capacity [W]"
    ]
    limited = radiant.replace({f"zones.{zone}.cooling": {"setpoint": 24, "radiative": 0.95, "capacity": 500}})
    assert not [line for line in check(limited) if "% of it is radiation" in line]
