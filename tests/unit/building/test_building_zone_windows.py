"""Windows between two zones: conduction, long wave, and the sun that passes, against closed forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin import Simulation, simulate
from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.weather import Climate

#: Diffuse transmittance, and absorptances of the panes, from outside and from inside.
OUTER, INNER = (0.6, (0.1, 0.05), (0.08, 0.12)), (0.5, (0.2, 0.1), (0.15, 0.05))


def glazing(transmittance: float, front: tuple[float, ...], back: tuple[float, ...]) -> dict[str, Any]:
    """Two panes whose optics are the same at all angles below 90 deg."""
    pane = {"thickness": 0.004, "emissivity": 0.84}
    angles = [0, 30, 60, 80, 89, 90]
    return {
        "kind": "panes",
        "panes": [pane, pane],
        "gaps": [{"conductance": 5.0}],
        "angular": {
            "angles": angles,
            "transmittance": [*[transmittance] * 5, 0],
            "absorptance": [[*[one] * 5, 0] for one in front],
            "diffuse": {"transmittance": transmittance, "absorptance": list(front)},
            "back": {"transmittance": transmittance, "absorptance": list(back)},
        },
    }


def side(zone: str, absorptance: float) -> dict[str, Any]:
    return {"zone": zone, "convection": 3, "emissivity": 0.9, "absorptance": absorptance}


OUTDOORS = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.5}
WINDOW = {"outside": {"convection": 15}, "inside": {"convection": 3}}


def house(sun: str | None = "area", inner: Mapping[str, Any] | None = None, **more: Any) -> Building:
    """A sunspace 4 m wide, 2 m deep and 3 m high, south of a room 4 m deep, with a window between them."""

    def ring(x: float, y: float, u: float, v: float) -> list[list[float]]:
        return [[x, y, 0], [u, v, 0], [u, v, 3], [x, y, 3]]

    def flat(y: float, v: float, z: float) -> list[list[float]]:
        return [[0, y, z], [4, y, z], [4, v, z], [0, v, z]]

    def shell(vertices: list[list[float]], zone: str, absorptance: float) -> dict[str, Any]:
        return {
            "construction": "shell",
            "vertices": vertices,
            "outside": OUTDOORS,
            "inside": side(zone, absorptance),
        }

    surfaces = {
        "south": shell(ring(0, 0, 4, 0), "sun", 0.5),
        "east": shell(ring(4, 0, 4, 2), "sun", 0.4),
        "west": shell(ring(0, 2, 0, 0), "sun", 0.4),
        "roof": shell(flat(0, 2, 3), "sun", 0.3),
        "floor": shell(flat(0, 2, 0)[::-1], "sun", 0.7),
        "between": {"construction": "shell", "vertices": ring(0, 2, 4, 2),
                    "outside": side("sun", 0.6), "inside": side("room", 0.5)},
        "room_north": shell(ring(4, 6, 0, 6), "room", 0.5),
        "room_east": shell(ring(4, 2, 4, 6), "room", 0.5),
        "room_west": shell(ring(0, 6, 0, 2), "room", 0.5),
        "room_roof": shell(flat(2, 6, 3), "room", 0.3),
        "room_floor": shell(flat(2, 6, 0)[::-1], "room", 0.8),
    }  # fmt: skip
    zone: dict[str, Any] = {"infiltration": 0.3} | ({"sun": sun} if sun else {})
    inside = WINDOW | {"outside": {"convection": 3}}
    return Building.from_dict(
        {
            "name": "house",
            "site": {"latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC"},
            "materials": {"board": {"conductivity": 0.16, "density": 800, "specific_heat": 1000}},
            "constructions": {"shell": {"layers": [{"material": "board", "thickness": 0.1}]}},
            "glazings": {"outer": glazing(*OUTER), "inner": glazing(*INNER)},
            "zones": {"sun": dict(zone), "room": dict(zone)},
            "surfaces": surfaces,
            "windows": {
                "front": WINDOW
                | {
                    "surface": "south",
                    "glazing": "outer",
                    "vertices": [[1, 0, 1], [3, 0, 1], [3, 0, 2.5], [1, 0, 2.5]],
                },
                "inner": inside
                | {
                    "surface": "between",
                    "glazing": "inner",
                    "vertices": [[0.5, 2, 0.5], [3, 2, 0.5], [3, 2, 2], [0.5, 2, 2]],
                }
                | dict(inner or {}),
            },
        }
        | more
    )  # fmt: skip


def climate(beam: float, diffuse: float, air: float = 5.0) -> Climate:
    table = pd.DataFrame(
        {"air_temperature": air, "dew_point": 0.0, "wind_speed": 1.0, "wind_direction": 0.0,
         "direct_normal": beam, "diffuse_horizontal": diffuse},
        index=pd.date_range("2001-03-18", periods=73, freq="1h", tz="UTC"),
    )  # fmt: skip
    names = list(table.columns)
    return Climate.from_table(
        table, timezone="UTC", columns={name: name for name in names}, instant=names, check_sun=False
    )


def day(described: Building, weather: Climate, *names: str) -> Any:
    period: dict[str, Any] = {"start": "2001-03-18", "end": "2001-03-20"}
    run = simulate(described, weather, step="15min", initial=15.0, outputs=list(names), **period)
    assert run.energy.closure < 1e-10
    return run


def test_the_sun_that_passes_by_area() -> None:
    """In each zone the irradiance is even: what passes back and forth is a geometric series."""
    described = house("area")
    names = ("front", "inner", "sun", "room")
    more = ("sun.lost_solar", "room.lost_solar", "room_floor.inside_absorbed_solar", "inner.absorbed_solar")
    run = day(described, climate(400.0, 100.0), *(f"{name}.transmitted_solar" for name in names), *more)
    entering, passing, sunspace, room = (run[f"{name}.transmitted_solar"].to_numpy() for name in names)
    assert entering.max() > 500.0
    front, window = 3.0, 3.75
    # Areas times absorptances, glass with what it absorbs and transmits, seen from inside the zone.
    opaque = (12.0 - front) * 0.5 + 2 * 6.0 * 0.4 + 8.0 * 0.3 + 8.0 * 0.7 + (12.0 - window) * 0.6
    first = opaque + front * (0.6 + sum(OUTER[2])) + window * (0.5 + sum(INNER[1]))
    second = (12.0 - window) * 0.5 + 12.0 * 0.5 + 2 * 12.0 * 0.5 + 16.0 * 0.3 + 16.0 * 0.8
    second += window * (0.5 + sum(INNER[2]))
    there, back = window * 0.5 / first, window * 0.5 / second
    into_room = entering * there / (1.0 - there * back)
    np.testing.assert_allclose(passing, into_room * (1.0 - back), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(room, passing, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(sunspace, entering - passing, rtol=1e-9, atol=1e-9)
    # The glass between loses nothing outdoors.
    all_in_sunspace = entering + into_room * back
    np.testing.assert_allclose(
        run["sun.lost_solar"], front * 0.6 / first * all_in_sunspace, rtol=1e-9, atol=1e-9
    )
    np.testing.assert_array_equal(run["room.lost_solar"], 0.0)
    np.testing.assert_allclose(
        run["room_floor.inside_absorbed_solar"], 0.8 * into_room / second, rtol=1e-9, atol=1e-9
    )
    glass = sum(INNER[1]) * all_in_sunspace / first + sum(INNER[2]) * into_room / second
    np.testing.assert_allclose(run["inner.absorbed_solar"], glass, rtol=1e-9, atol=1e-9)


def test_zones_in_a_row_by_area() -> None:
    """Four zones without vertices: the powers that pass solve a linear system, built here from areas."""
    count, area, window = 4, 12.0, 5.0
    wall = {"construction": "shell", "area": area, "tilt": 90}
    surfaces: dict[str, Any] = {
        "south": wall | {"azimuth": 180, "outside": OUTDOORS, "inside": side("z0", 0.5)},
        "end": wall | {"azimuth": 0, "outside": {"adiabatic": True}, "inside": side("z3", 0.9)},
    }
    windows = {"front": WINDOW | {"surface": "south", "glazing": "outer", "area": window}}
    for k in range(count - 1):
        surfaces[f"w{k}"] = wall | {
            "azimuth": 180, "outside": side(f"z{k}", 0.6), "inside": side(f"z{k + 1}", 0.7)
        }  # fmt: skip
        inner = WINDOW | {"surface": f"w{k}", "glazing": "inner", "area": window}
        windows[f"p{k}"] = inner | {"outside": {"convection": 3}}
    described = house("area", zones={f"z{k}": {"volume": 40} for k in range(count)}, surfaces=surfaces,
                      windows=windows)  # fmt: skip
    names = [f"z{k}.transmitted_solar" for k in range(count)]
    run = day(described, climate(400.0, 100.0), "front.transmitted_solar", "z0.lost_solar", *names)
    opaque = area - window
    taken = np.zeros(count)  # areas times what is absorbed or transmitted
    taken[0] = opaque * (0.5 + 0.6) + window * (0.6 + sum(OUTER[2])) + window * (0.5 + sum(INNER[1]))
    taken[1:-1] = opaque * (0.7 + 0.6) + window * (1.0 + sum(INNER[1]) + sum(INNER[2]))
    taken[-1] = opaque * 0.7 + area * 0.9 + window * (0.5 + sum(INNER[2]))
    # Sun that reaches each zone: from outdoors, and what its neighbours let pass.
    matrix = np.eye(count)
    for k in range(count - 1):
        matrix[k, k + 1] = -window * 0.5 / taken[k + 1]
        matrix[k + 1, k] = -window * 0.5 / taken[k]
    entering = run["front.transmitted_solar"].to_numpy()
    reaching = np.linalg.solve(matrix, np.outer([1.0, 0.0, 0.0, 0.0], entering))
    for k, name in enumerate(names):
        inner_windows = (k > 0) + (k < count - 1)
        kept = reaching[k] * (1.0 - inner_windows * window * 0.5 / taken[k])
        np.testing.assert_allclose(run[name], kept, rtol=1e-9, atol=1e-9)
    lost = window * 0.6 / taken[0] * reaching[0]
    np.testing.assert_allclose(run["z0.lost_solar"], lost, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("sun", ["area", "floor", "geometry"])
def test_all_of_the_sun_is_absorbed_or_lost(sun: str) -> None:
    """What enters is absorbed by the surfaces of both zones and by glass, or lost outdoors."""
    described = house(sun)
    areas = {name: float(surface.area or 0.0) for name, surface in described.surfaces.items()}
    areas["south"] -= 3.0
    areas["between"] -= 3.75
    sides = [(name, "inside") for name in described.surfaces] + [("between", "outside")]
    run = day(described, climate(600.0, 80.0), "front.transmitted_solar", "front.absorbed_solar",
              "inner.absorbed_solar", "inner.transmitted_solar", "sun.lost_solar", "room.lost_solar",
              "room.transmitted_solar", "front.incident_solar",
              *(f"{name}.{which}_absorbed_solar" for name, which in sides))  # fmt: skip
    absorbed = sum(areas[name] * run[f"{name}.{which}_absorbed_solar"] for name, which in sides)
    # The outer panes absorb of the sun from outside, too.
    outside = 3.0 * sum(OUTER[1]) * run["front.incident_solar"]
    inside = 3.0 * run["front.absorbed_solar"] - outside + 3.75 * run["inner.absorbed_solar"]
    total = absorbed + inside + run["sun.lost_solar"] + run["room.lost_solar"]
    # Beyond 89 deg the table falls to nothing: there the panes absorb less from outside.
    entering = run["front.transmitted_solar"]
    steep = np.isclose(entering, 3.0 * OUTER[0] * run["front.incident_solar"], rtol=1e-9)
    assert steep.sum() > 180
    np.testing.assert_allclose(total[steep], entering[steep], rtol=1e-9, atol=1e-6)
    assert float(run["inner.transmitted_solar"].max()) > 10.0
    into = run.energy.into
    assert into["transmitted"] > 0.0


def test_heat_through_the_glass_in_steady_state() -> None:
    """Without sun, between zones held at 30 and 10 degC: two coefficients of 3 W/(m2 K) and a gap of 5."""
    zones = {
        name: {
            "infiltration": 0,
            "longwave": "none",
            "heating": {"setpoint": set_point},
            "cooling": {"setpoint": set_point},
        }
        for name, set_point in (("sun", 30), ("room", 10))
    }  # fmt: skip
    described = house(None, zones=zones)
    names = ("inner.outside_temperature", "inner.inside_temperature")
    outer, inner = (day(described, climate(0.0, 0.0), *names)[name].to_numpy()[-1] for name in names)
    glass = 2 * 0.004 / 1.0
    flux = 20.0 / (1 / 3 + glass + 1 / 5 + 1 / 3)
    assert outer == pytest.approx(30.0 - flux / 3, abs=1e-6)
    assert inner == pytest.approx(10.0 + flux / 3, abs=1e-6)
    assert any(
        line.startswith("window inner:") and f"U {1 / (1 / 3 + glass + 1 / 5 + 1 / 3):.3f}" in line
        for line in check(described)
    )


def test_long_wave_exchange_on_both_sides() -> None:
    """The glass takes part in the exchange of both zones: warmer walls warm it beyond the air."""
    described = house("area")
    run = day(described, climate(0.0, 0.0), "inner.outside_longwave", "inner.inside_longwave",
              "inner.outside_convection", "inner.inside_convection")  # fmt: skip
    assert float(abs(run["inner.outside_longwave"]).max()) > 0.1
    assert float(abs(run["inner.inside_longwave"]).max()) > 0.1
    assert run["inner.outside_convection"].to_numpy()[-1] == pytest.approx(3.0)
    names = [output.name for output in described.outputs()]
    assert "inner.incident_solar" not in names
    assert "inner.solar_transmittance" not in names


def test_turning_the_wall_between_changes_nothing() -> None:
    """The same window, with its outside in the other zone and its panes reversed."""
    one = house("geometry")
    turned = house("geometry")
    data = turned.to_dict()
    wall, window = data["surfaces"]["between"], data["windows"]["inner"]
    for part in (wall, window):
        part["vertices"] = part["vertices"][::-1]
    wall["outside"], wall["inside"] = wall["inside"], wall["outside"]
    data["glazings"]["inner"] = glazing(INNER[0], INNER[2][::-1], INNER[1][::-1])
    names = ("room.air_temperature", "sun.air_temperature", "inner.transmitted_solar")
    runs = [day(each, climate(600.0, 80.0), *names) for each in (one, Building.from_dict(data))]
    for name in names[:2]:
        np.testing.assert_allclose(runs[0][name], runs[1][name], atol=1e-6)
    np.testing.assert_allclose(runs[0][names[2]], -runs[1][names[2]], atol=1e-6)


def test_a_frame_and_gas_between_zones() -> None:
    data = house("geometry").to_dict()
    pane = {"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}
    data["glazings"]["inner"] = {
        "kind": "panes",
        "panes": [pane, pane],
        "gaps": [{"thickness": 0.012, "gas": "air"}],
    }
    data["windows"]["inner"]["frame"] = {"fraction": 0.2, "u_value": 2.0}
    data["windows"]["inner"]["outside"] = {"convection": "iso15099"}
    run = day(Building.from_dict(data), climate(600.0, 80.0), "room.transmitted_solar")
    assert float(run["room.transmitted_solar"].max()) > 10.0


def test_derivatives_and_ensembles_with_a_window_between_zones() -> None:
    described = house("area")
    paths = [
        "glazings.inner.angular.transmittance_scale",
        "windows.inner.area",
        "surfaces.floor.inside.absorptance",
    ]
    period: dict[str, Any] = {"start": "2001-03-18", "end": "2001-03-19"}
    name = "room.air_temperature"
    simulation = Simulation(
        described, climate(400.0, 100.0), outputs=[name], step="1h", initial=15.0, **period
    )
    slopes = simulation.jacobian(paths)[f"d {name}"]
    mean = simulation.gradient(Mean(name))
    base = simulation.compiled.values  # noqa: PD011
    vectors = [base]
    for path in paths:
        value = described.parameter(path).value
        there, back = (simulation.run({path: value + sign})[name].to_numpy() for sign in (1e-4, -1e-4))
        found = slopes.sel(parameter=path).to_numpy()
        np.testing.assert_allclose(found, (there - back) / 2e-4, atol=1e-5, rtol=1e-4)
        assert mean.slopes[path] == pytest.approx(found.mean(), rel=1e-9)
        vectors.append(np.where(np.array(simulation.compiled.paths) == path, value + 1e-4, base))
    together = simulation.compiled.ensemble(np.array(vectors))[0]
    for vector, records in zip(vectors, together, strict=True):
        np.testing.assert_array_equal(simulation.compiled.run(vector)[0], records)


@pytest.mark.parametrize(
    ("inner", "sun", "said"),
    [
        ({"outside": {"convection": 3, "height": 2}}, "area", r"inner\.outside\.height[\s\S]*two zones"),
        ({"outside": {"convection": 3, "longwave": "none"}}, "area", r"windows\.inner\.outside\.longwave"),
        ({"outside": {"convection": "doe2"}}, "area", r"inner\.outside\.convection[\s\S]*without wind"),
        ({"surface": "floor"}, "area", r"outside the outline|off the plane|wrong order"),
    ],
)  # fmt: skip
def test_what_a_window_between_zones_cannot_have(inner: dict[str, Any], sun: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        house(sun, inner)


def test_given_shares_say_nothing_of_a_window_between_zones() -> None:
    data = house("area").to_dict()
    data["zones"]["sun"]["sun"] = {"kind": "shares", "shares": {"floor": 1.0}}
    with pytest.raises(InputError, match=r"zones\.sun\.sun[\s\S]*'inner' to another zone[\s\S]*sun: area"):
        Building.from_dict(data)
