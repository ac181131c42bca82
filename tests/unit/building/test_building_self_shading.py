"""Surfaces that shade each other: which of them; sun, sky, ground, long-wave radiation by closed forms."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest

from mascarin import Simulation, simulate
from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.building.geometry import Polygon, in_front
from mascarin.building.parts.self_shading import expected_seconds, obstructions, pairs_with_shades
from mascarin.cli import main
from mascarin.weather import CHANNELS, Climate

Array = npt.NDArray[np.float64]
Corners = list[list[float]]

OUTDOORS = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}


def wall(
    corners: Corners, zone: str | None = None, outside: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    inside = (
        {"adiabatic": True}
        if zone is None
        else {"zone": zone, "convection": 3, "emissivity": 0.9, "absorptance": 0.6}
    )
    return {
        "construction": "shell",
        "vertices": corners,
        "outside": OUTDOORS if outside is None else outside,
        "inside": inside,
    }


def block(
    name: str, low: tuple[float, float], high: tuple[float, float], top: float, foot: float = 0.0
) -> dict[str, dict[str, Any]]:
    """The six surfaces of a zone between two corners."""
    (x, y), (u, v) = low, high
    rings = {
        "south": [[x, y, foot], [u, y, foot], [u, y, top], [x, y, top]],
        "east": [[u, y, foot], [u, v, foot], [u, v, top], [u, y, top]],
        "north": [[u, v, foot], [x, v, foot], [x, v, top], [u, v, top]],
        "west": [[x, v, foot], [x, y, foot], [x, y, top], [x, v, top]],
        "roof": [[x, y, top], [u, y, top], [u, v, top], [x, v, top]],
        "floor": [[x, v, foot], [u, v, foot], [u, y, foot], [x, y, foot]],
    }
    found = {f"{name}_{side}": wall(ring, name) for side, ring in rings.items()}
    found[f"{name}_floor"]["outside"] = {"ground": {"temperature": 12}}
    return found


def building(surfaces: Mapping[str, Any], zones: tuple[str, ...] = (), **more: Any) -> Building:
    site = {"latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC", "diffuse": "isotropic"}
    return Building.from_dict(
        {
            "name": "court",
            "site": site
            | {"sky": {"kind": "offset", "depression": 20}, "ground_reflectance": 0.3}
            | more.pop("site", {}),
            "materials": {"board": {"conductivity": 0.16, "density": 800, "specific_heat": 1000}},
            "constructions": {"shell": {"layers": [{"material": "board", "thickness": 0.1}]}},
            "zones": {zone: {"infiltration": 0.3} for zone in zones},
            "surfaces": dict(surfaces),
            **more,
        }
    )


def weather(beam: float, diffuse: float, hours: int = 24) -> Climate:
    """A day in March of constant direct normal and diffuse horizontal radiation."""
    table = pd.DataFrame(
        {
            "air_temperature": 15.0, "dew_point": 5.0, "wind_speed": 1.0, "wind_direction": 0.0,
            "direct_normal": beam, "diffuse_horizontal": diffuse,
        },
        index=pd.date_range("2001-03-18", periods=hours + 1, freq="1h", tz="UTC"),
    )  # fmt: skip
    columns = {name: name for name in table.columns}
    return Climate.from_table(table, timezone="UTC", columns=columns, instant=list(columns), check_sun=False)


def incident(described: Building, climate: Climate, *names: str) -> tuple[Array, list[Array]]:
    """Direction of the sun at the steps of a day, and irradiance of surfaces [W/m2]."""
    simulation = Simulation(
        described, climate, step="30min", scheme="backward-euler", initial=15.0, start="2001-03-18",
        end="2001-03-19", outputs=[f"{name}.incident_solar" for name in names],
    )  # fmt: skip
    run = simulation.run()
    rows = climate.forcing(described.site, simulation.start, simulation.end, 1800.0, "backward-euler", [])[
        :, -1
    ]
    places = [list(CHANNELS).index(key) for key in ("sun_east", "sun_north", "sun_up")]
    direction: Array = np.asarray(rows[:, places], dtype=np.float64)
    return direction, [run[f"{name}.incident_solar"].to_numpy()[1:] for name in names]


def fraction(
    sun: Array, found: Array, normal: tuple[float, float, float], beam: float
) -> tuple[Array, Array]:
    """Sunlit fraction where the sun is in front of a plane, and these steps."""
    facing = sun @ np.array(normal)
    lit = (facing > 1e-3) & (sun[:, 2] > 1e-3)
    return found[lit] / (beam * facing[lit]), lit


# --- which surfaces -------------------------------------------------------------------------------


def test_a_part_of_a_wall_in_front_of_the_plane() -> None:
    ring = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 0.0, 3.0), (0.0, 0.0, 3.0)]
    south = Polygon.of("south", ring)

    def moved(y: float) -> Polygon:
        return Polygon.of("other", [(x, y, z) for x, _, z in ring])

    through = Polygon.of("fin", [(6, -1, 0), (6, 1, 0), (6, 1, 3), (6, -1, 3)])
    others = [south, moved(-5.0), moved(5.0), through, moved(-0.0005)]
    assert in_front(south, others) == [1, 3]
    assert in_front(south.reversed(), others) == [2, 3]
    # A plane is known to 1 mm per metre: corners rounded to 1 mm do not shade a wall 30 m away.
    far = Polygon.of("far", [(34.0, -0.02, 0.0), (64.0, -0.02, 0.0), (64.0, -0.02, 3.0), (34.0, -0.02, 3.0)])
    near = Polygon.of("near", [(2.0, -0.02, 1.0), (3.0, -0.02, 1.0), (3.0, -0.02, 2.0), (2.0, -0.02, 2.0)])
    assert in_front(south, [far, near]) == [1]
    # Corners far away do not hide that a long wall, or a long beam above, passes close by.
    for low, high in ((0.0, 9.0), (5.0, 6.0)):
        long = [(5000.0, -3.0, low), (-5000.0, -3.0, low), (-5000.0, -3.0, high), (5000.0, -3.0, high)]
        assert in_front(south, [Polygon.of("long", long)]) == [0]


@pytest.mark.parametrize("angle", [0.0, 17.3, 45.0, 211.7])
def test_nothing_stands_in_front_of_a_convex_building(angle: float) -> None:
    """Two zones in a row, turned: the engine gets the same description as without geometry."""
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    parts = block("one", (0.0, 0.0), (5.0, 6.0), 3.0) | block("two", (5.0, 0.0), (11.0, 6.0), 3.0)
    del parts["two_west"]
    parts["one_east"]["outside"] = {"zone": "two", "convection": 3, "emissivity": 0.9}
    for part in parts.values():
        part["vertices"] = [
            [round(cosine * x - sine * y, 3), round(sine * x + cosine * y, 3), z]
            for x, y, z in part["vertices"]
        ]
    described = building(parts, ("one", "two"))
    assert obstructions(described) == {}
    assert "shaded_by" not in described.to_engine().json
    assert "shading: no surface stands in front of another" in check(described)


def court() -> dict[str, dict[str, Any]]:
    """A wall 10 m wide that faces south, and a wing 8 m long to the south at its east end."""
    parts = block("main", (0.0, 0.0), (14.0, 6.0), 3.0) | block("wing", (10.0, -8.0), (14.0, 0.0), 3.0)
    del parts["wing_north"]
    south = parts["main_south"]["vertices"]
    parts["main_south"]["vertices"] = [[x if x == 0.0 else 10.0, y, z] for x, y, z in south]
    between = [[10.0, 0.0, 0.0], [14.0, 0.0, 0.0], [14.0, 0.0, 3.0], [10.0, 0.0, 3.0]]
    inner = {"zone": "wing", "convection": 3, "emissivity": 0.9}
    return parts | {"between": wall(between, "main", inner)}


def test_the_surfaces_in_front_of_those_of_a_court() -> None:
    described = building(court(), ("main", "wing"))
    found = obstructions(described)
    # Walls and roof of the wing stand before the plane of the south wall; not the floor and the wall between.
    assert found == {
        ("main_south", "outside"): ["wing_south", "wing_east", "wing_west", "wing_roof"],
        ("wing_west", "outside"): ["main_south", "main_north", "main_west", "main_roof"],
    }
    surfaces = json.loads(described.to_engine().json)["surfaces"]
    names = [surface["name"] for surface in surfaces]
    shaded = {surface["name"]: surface["outside"].get("shaded_by") for surface in surfaces}
    assert [names[k] for k in shaded["main_south"]] == found["main_south", "outside"]
    line = next(line for line in check(described) if line.startswith("shading:"))
    assert line.startswith(
        "shading: 8 pairs of surfaces (main_south by wing_south, wing_east, wing_west, wing_roof;"
    )
    off = described.replace({"site.self_shading": False})
    assert obstructions(off) == {}
    assert "shaded_by" not in off.to_engine().json
    assert "shading: surfaces do not shade each other (site.self_shading: false)" in check(off)


def test_check_says_that_nothing_shades_without_vertices() -> None:
    bare = {"construction": "shell", "area": 9, "tilt": 90, "azimuth": 180, "outside": OUTDOORS,
            "inside": {"adiabatic": True}}  # fmt: skip
    assert "shading: nothing shades: no surface outdoors has vertices" in check(building({"facade": bare}))
    lines = check(building(court() | {"dormer": bare}, ("main", "wing")))
    line = next(line for line in lines if line.startswith("shading:"))
    assert line.endswith("without vertices, unshaded: dormer")


def test_a_run_says_how_long_its_shadows_take(
    tmp_path: Path, data_dir: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    site = {"latitude": 39.83, "longitude": -104.65, "altitude": 1650, "timezone": "UTC-7"}
    file = tmp_path / "court.yaml"
    building(court(), ("main", "wing"), site=site).to_yaml(file)
    words = ["run", str(file), "--weather", str(data_dir / "bestest" / "725650TYCST.epw")]
    words += ["--start", "2001-03-01", "--end", "2001-03-02"]
    for least, said in ((2.0, False), (0.0, True)):
        monkeypatch.setattr("mascarin.commands.run.LONG", least)
        assert main(words) == 0
        assert ("shading: about 0 s for the shadows" in capsys.readouterr().err) == said
    assert expected_seconds({("south", "outside"): ["a"] * 1000}) == pytest.approx(1.2364)


def test_shades_count_in_the_estimate() -> None:
    slats = {
        f"slat{k}": {
            "vertices": [[0, -0.5, 0.1 * k], [4, -0.5, 0.1 * k], [4, -0.4, 0.1 * k], [0, -0.4, 0.1 * k]]
        }
        for k in range(1, 21)
    }
    plain = block("main", (0.0, 0.0), (4.0, 4.0), 3.0)
    described = building(plain, ("main",), shades=slats)
    found = pairs_with_shades(described)
    # All of them stand in front of the south wall; they lie below the roof and behind the other walls.
    assert found == (20, 0)
    (line,) = (line for line in check(described) if line.startswith("shading:"))
    assert line == "shading: no surface stands in front of another; 20 pairs with shades, about 1 s in a year"
    # 20 pairs, half of the 70080 stages, 1.4 us.
    assert expected_seconds({}, shades=found) == pytest.approx(0.5 * 70080 * 20 * 1.4e-6)
    # A neighbour across the street.
    across = {"house": {"vertices": [[-9, -20, 0], [9, -20, 0], [9, -20, 9], [-9, -20, 9]]}}
    assert pairs_with_shades(building(plain, ("main",), shades=across)) == (0, 4)


# --- sun ------------------------------------------------------------------------------------------


def test_the_shadow_of_a_tower_on_a_low_roof() -> None:
    """On a long strip the shadow of a very long tower, 9 m above it, reaches 9 m/tan of the sun."""
    tower = block("tower", (-900.0, -4.0), (901.0, 0.0), 12.0)
    low = block("low", (0.0, 0.0), (1.0, 50.0), 3.0)
    sun, (found,) = incident(building(tower | low, ("tower", "low")), weather(600.0, 0.0), "low_roof")
    # The ground below is not seen by a roof.
    share, lit = fraction(sun, found, (0.0, 0.0, 1.0), 600.0)
    reach = np.clip(-9.0 * sun[lit, 1] / sun[lit, 2], 0.0, 50.0)
    assert reach.min() < 8.0
    assert reach.max() > 12.0
    np.testing.assert_allclose(share, 1.0 - reach / 50.0, atol=1e-9)


def test_the_wing_of_a_court_shades_its_wall() -> None:
    """Beam on the south wall: t west of the wing its shadow is 3 m less t up/east high."""
    described = building(court(), ("main", "wing"), site={"ground_reflectance": 0.0})
    sun, (found,) = incident(described, weather(700.0, 0.0), "main_south")
    share, lit = fraction(sun, found, (0.0, -1.0, 0.0), 700.0)
    expected = []
    for east, north, up in sun[lit]:
        if east <= 0.0:
            expected.append(1.0)
            continue
        slope = up / east
        reach = min(10.0, 8.0 * east / -north, 3.0 / slope)
        expected.append(1.0 - (3.0 * reach - 0.5 * slope * reach**2) / 30.0)
    assert min(expected) < 0.6
    np.testing.assert_allclose(share, expected, atol=1e-9)


def test_a_fin_beside_a_window() -> None:
    """A tall wall of 1 m, 0.3 m east of a window of 1.5 m: its shadow is east/-north wide, less the gap."""
    fin = wall([[4.0, 0.0, 0.0], [4.0, -1.0, 0.0], [4.0, -1.0, 90.0], [4.0, 0.0, 90.0]], outside=OUTDOORS)
    fin["inside"] = OUTDOORS
    pane = {"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}
    film = {"convection": 5}
    described = building(
        block("room", (0.0, 0.0), (6.0, 5.0), 3.0) | {"fin": fin},
        ("room",),
        site={"ground_reflectance": 0.0},
        glazings={"clear": {"kind": "panes", "panes": [pane]}},
        windows={
            "pane": {"surface": "room_south", "glazing": "clear", "outside": film, "inside": film,
                     "vertices": [[2.2, 0, 1], [3.7, 0, 1], [3.7, 0, 2.5], [2.2, 0, 2.5]]}
        },
    )  # fmt: skip
    names = ("pane", "fin")
    sun, (glass, found) = incident(described, weather(700.0, 0.0), *names)
    share, lit = fraction(sun, glass, (0.0, -1.0, 0.0), 700.0)
    width = np.maximum(sun[lit, 0] / -sun[lit, 1], 0.0)
    expected = 1.0 - np.clip(width - 0.3, 0.0, 1.5) / 1.5
    assert expected.min() < 0.1
    assert expected.max() == 1.0
    np.testing.assert_allclose(share, expected, atol=1e-9)
    assert found.max() > 0.0


def rays(described: Building, name: str, sun: Array, points: Array) -> float:
    """Fraction of points of a surface from which a ray to the sun meets no other surface."""
    free = np.ones(len(points), dtype=bool)
    for other, surface in described.surfaces.items():
        if other == name or surface.outside.ground is not None:
            continue
        polygon = Polygon.of(other, [[float(c) for c in corner] for corner in surface.vertices or ()])
        along = float(sun @ polygon.normal)
        if abs(along) < 1e-9:
            continue
        way = -polygon.height_of(points) / along
        flat = polygon.in_plane(points + way[:, None] * sun)
        corners = polygon.in_plane(polygon.points)
        edges = np.roll(corners, -1, axis=0) - corners
        off = flat[:, None] - corners
        inside = (edges[:, 0] * off[..., 1] - edges[:, 1] * off[..., 0] > 0.0).all(axis=1)
        free &= ~(inside & (way > 1e-6))
    return float(free.mean())


@pytest.mark.parametrize("seed", range(3))
def test_random_blocks_against_rays(seed: int) -> None:
    """Detached blocks of random size and place, with rectangles as faces."""
    random = np.random.default_rng(seed)
    parts: dict[str, Any] = {}
    zones = tuple(f"b{k}" for k in range(4))
    for k, zone in enumerate(zones):
        corner = np.array([8.0 * (k % 2), 8.0 * (k // 2)]) + random.uniform(0.0, 1.5, 2)
        size = random.uniform(3.0, 6.0, 3) * (1.0, 1.0, 2.5)
        parts |= block(zone, tuple(corner), tuple(corner + size[:2]), size[2])
    described = building(parts, zones, site={"ground_reflectance": 0.0})
    names = [f"b{k}_{side}" for k in range(4) for side in ("south", "east", "west", "roof")]
    sun, irradiances = incident(described, weather(700.0, 0.0), *names)
    worst, shaded = 0.0, 0
    grid = (np.stack(np.meshgrid(np.arange(40), np.arange(40)), axis=-1).reshape(-1, 2) + 0.5) / 40.0
    for name, found in zip(names, irradiances, strict=True):
        polygon = Polygon.of(
            name, [[float(c) for c in corner] for corner in described.surfaces[name].vertices or ()]
        )
        a, b, _, d = polygon.points
        points = a + grid[:, :1] * (b - a) + grid[:, 1:] * (d - a)
        share, lit = fraction(sun, found, tuple(polygon.normal), 700.0)
        for direction, one in list(zip(sun[lit], share, strict=True))[::3]:
            worst = max(worst, abs(rays(described, name, direction, points) - one))
            shaded += one < 0.95
    assert shaded > 20
    assert worst < 0.02


# --- sky, ground, long wave -----------------------------------------------------------------------


def alley(width: float, height: float, other: float, **more: Any) -> Building:
    """A wall that faces south, ``north``, and opposite to it a very long one of another height."""
    long = 4000.0
    near = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, height], [-1.0, 0.0, height]]
    far = [[long, -width, 0.0], [-long, -width, 0.0], [-long, -width, other], [long, -width, other]]
    return building({"north": wall(near), "south": wall(far)}, **more)


def views(width: float, height: float, other: float) -> tuple[float, float]:
    """View factors to sky and ground: means of (1 - sin)/2 over the height, past the other wall."""
    y = (np.arange(4000) + 0.5) / 4000 * height
    top, foot = (other - y) / np.hypot(other - y, width), y / np.hypot(y, width)
    above, below = np.maximum(top, 0.0), np.minimum(top, 0.0)
    return float(np.mean(0.5 * (1.0 - above))), float(np.mean(0.5 * (1.0 - foot - below)))


@pytest.mark.parametrize(("width", "height", "other"), [(5.0, 3.0, 3.0), (3.0, 2.5, 12.0), (20.0, 9.0, 4.0)])
def test_sky_and_ground_in_an_alley(width: float, height: float, other: float) -> None:
    described = alley(width, height, other)
    _, (found,) = incident(described, weather(0.0, 100.0), "north")
    lit = found > 0.0
    sky, ground = views(width, height, other)
    np.testing.assert_allclose(found[lit], 100.0 * (sky + 0.3 * ground), rtol=2e-3)


def test_long_wave_radiation_in_an_alley() -> None:
    described = alley(5.0, 3.0, 6.0)
    run = simulate(
        described, weather(0.0, 0.0), step="30min", initial=15.0, start="2001-03-18", end="2001-03-19",
        outputs=["north.outside_longwave", "north.outside_temperature"],
    )  # fmt: skip
    sky = views(5.0, 3.0, 6.0)[0] * math.sqrt(0.5)

    def black(celsius: Any) -> Any:
        return 5.670374419e-8 * (celsius + 273.15) ** 4

    at = run["north.outside_temperature"].to_numpy()
    expected = 0.9 * (sky * black(15.0 - 20.0) + (1.0 - sky) * black(15.0) - black(at))
    np.testing.assert_allclose(run["north.outside_longwave"].to_numpy(), expected, atol=0.05)


def test_a_given_view_of_the_sky_includes_what_stands_in_front() -> None:
    free = alley(5.0, 3.0, 6.0, site={"self_shading": False, "ground_reflectance": 0.0})
    change = {"surfaces.north.outside.sky_view": 0.2}
    shaded = free.replace({"site.self_shading": True} | change)
    _, (one,) = incident(shaded, weather(0.0, 100.0), "north")
    _, (other,) = incident(free.replace(change), weather(0.0, 100.0), "north")
    assert other.max() == pytest.approx(20.0)
    np.testing.assert_array_equal(one, other)
    _, (least,) = incident(free.replace({"site.self_shading": True}), weather(0.0, 100.0), "north")
    assert least.max() == pytest.approx(100.0 * views(5.0, 3.0, 6.0)[0], rel=2e-3)
