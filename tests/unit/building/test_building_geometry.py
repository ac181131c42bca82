from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mascarin.building import geometry as g
from mascarin.errors import InputError

Point = tuple[float, float, float]
BOX_FACES = {
    "floor": (0, 1, 3, 2),
    "ceiling": (4, 6, 7, 5),
    "north": (2, 3, 7, 6),
    "south": (0, 4, 5, 1),
    "west": (0, 2, 6, 4),
    "east": (1, 5, 7, 3),
}


def box(a: float, b: float, c: float) -> list[g.Polygon]:
    """Faces of a box, normals into it."""
    corners = [(x, y, z) for z in (0.0, c) for y in (0.0, b) for x in (0.0, a)]
    return [g.Polygon.of(name, [corners[i] for i in face]) for name, face in BOX_FACES.items()]


def sloped_room() -> list[g.Polygon]:
    """A 3 m room under a ceiling inclined by 20 degrees to the north, with a door and a window."""
    rise = 1.5 * math.tan(math.radians(20.0))
    low, high = 3.0 - rise, 3.0 + rise
    a, b, c, d = (0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (3.0, 3.0, 0.0), (0.0, 3.0, 0.0)
    e, f, h, k = (0.0, 0.0, high), (3.0, 0.0, high), (3.0, 3.0, low), (0.0, 3.0, low)
    faces: dict[str, list[Point]] = {
        "floor": [a, b, c, d],
        "ceiling": [e, k, h, f],
        "south": [a, e, f, b],
        "north": [d, c, h, k],
        "west": [a, d, k, e],
        "east": [b, f, h, c],
        "door": [(1.0, 0.0, 0.0), (1.0, 0.0, 2.2), (1.7, 0.0, 2.2), (1.7, 0.0, 0.0)],
        "window": [(1.1, 3.0, 1.2), (1.9, 3.0, 1.2), (1.9, 3.0, 2.0), (1.1, 3.0, 2.0)],
    }
    return [g.Polygon.of(name, vertices) for name, vertices in faces.items()]


def hexahedron(numbers: list[float], turn: float) -> list[g.Polygon]:
    """A convex room: a trapezoidal plan under a sloped ceiling, turned about a skew axis."""
    depth, left, right, height, east_slope, north_slope = numbers
    plan = [(0.0, 0.0), (3.0, 0.0), (3.0 - right, depth), (left, depth)]
    bottom = [(x, y, 0.0) for x, y in plan]
    top = [(x, y, height + east_slope * x + north_slope * y) for x, y in plan]
    faces = {"floor": bottom, "ceiling": top[::-1]}
    for i in range(4):
        j = (i + 1) % 4
        faces[f"wall {i}"] = [bottom[j], bottom[i], top[i], top[j]]
    axis = np.array([1.0, 2.0, 3.0]) / math.sqrt(14.0)
    cross = np.cross(np.eye(3), axis)
    matrix = np.eye(3) + math.sin(turn) * cross + (1.0 - math.cos(turn)) * cross @ cross
    return [g.Polygon.of(name, (np.array(v) @ matrix).tolist()) for name, v in faces.items()]


def parallel_factor(a: float, b: float, distance: float) -> float:
    """Howell's catalogue C-11: equal, directly opposed rectangles."""
    x, y = a / distance, b / distance
    u, v = math.sqrt(1 + x * x), math.sqrt(1 + y * y)
    total = 0.5 * math.log(u**2 * v**2 / (1 + x**2 + y**2)) - x * math.atan(x) - y * math.atan(y)
    total += x * v * math.atan(x / v) + y * u * math.atan(y / u)
    return 2.0 / (math.pi * x * y) * total


def perpendicular_factor(common: float, own: float, other: float) -> float:
    """Howell's catalogue C-14: rectangles at a right angle with a common edge."""
    h, w = other / common, own / common
    root = math.hypot(h, w)
    a = (1 + w * w) * (1 + h * h) / (1 + w * w + h * h)
    b = w * w * (1 + w * w + h * h) / ((1 + w * w) * (w * w + h * h))
    c = h * h * (1 + h * h + w * w) / ((1 + h * h) * (h * h + w * w))
    angles = w * math.atan(1 / w) + h * math.atan(1 / h) - root * math.atan(1 / root)
    return (angles + 0.25 * math.log(a * b ** (w * w) * c ** (h * h))) / (math.pi * w)


def test_area_centroid_and_perimeter_of_an_l_shape() -> None:
    outline = [(0, 0, 1), (4, 0, 1), (4, 1, 1), (1, 1, 1), (1, 3, 1), (0, 3, 1)]
    polygon = g.Polygon.of("slab", outline)
    assert polygon.area == pytest.approx(6.0, abs=1e-12)
    assert polygon.perimeter == pytest.approx(14.0, abs=1e-12)
    assert polygon.centroid == pytest.approx([(4 * 2 + 2 * 0.5) / 6, (4 * 0.5 + 2 * 2) / 6, 1.0], abs=1e-12)


@pytest.mark.parametrize(
    ("direction", "tilt", "azimuth"),
    [
        ([0, 0, 1], 0, 0),
        ([0, 0, -1], 180, 0),
        ([0, 1, 0], 90, 0),
        ([1, 0, 0], 90, 90),
        ([0, -1, 0], 90, 180),
        ([-1, 0, 0], 90, 270),
        ([0, math.sin(math.radians(20)), math.cos(math.radians(20))], 20, 0),
        ([-1, 1, -math.sqrt(2)], 135, 315),
    ],
)
def test_tilt_and_azimuth(direction: list[float], tilt: float, azimuth: float) -> None:
    normal = np.array(direction) / np.linalg.norm(direction)
    along = np.cross(normal, [0.3, 0.5, 0.8])
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    corners = np.array([0 * along, 2 * along, 2 * along + across, across])
    polygon = g.Polygon.of("plane", corners.tolist())
    assert polygon.tilt == pytest.approx(tilt, abs=1e-6)
    assert polygon.azimuth == pytest.approx(azimuth, abs=1e-6)
    assert polygon.reversed().tilt == pytest.approx(180 - tilt, abs=1e-6)


@pytest.mark.parametrize(
    ("vertices", "message"),
    [
        ([(0, 0, 0), (1, 0, 0)], "2 vertices; expected at least 3"),
        ([(0, 0), (1, 0), (1, 1)], "vertex 1 is"),
        ([(0, 0, 0), (1, 0, 0), (1, math.nan, 0)], "vertex 3 is"),
        ([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 1, 0)], "vertices 2 and 3 are 0 m apart"),
        ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], "enclose no area"),
        ([(0, 0, 0), (1e9, 0, 0), (1e9, 0.5, 0), (0, 0.5, 0)], "enclose no area"),  # found by make fuzz
        ([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0.1)], "is not plane"),
        ([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0.5, -1, 0)], "edge 1 crosses edge 3"),
    ],
)
def test_an_invalid_outline_is_an_error(vertices: list[Any], message: str) -> None:
    with pytest.raises(InputError, match=r"surface 'wall'") as caught:
        g.Polygon.of("wall", vertices)
    assert message in str(caught.value)


def test_cube_has_the_known_factors() -> None:
    factors = g.view_factors(box(1, 1, 1))
    assert factors[0, 1] == pytest.approx(0.1998248957, abs=1e-9)
    assert factors[0, 2] == pytest.approx((1 - 0.1998248957) / 4, abs=1e-9)


@pytest.mark.parametrize("size", [(3.0, 4.0, 2.5), (3.0, 3.0, 0.28), (0.2, 7.0, 3.0), (1.0, 1.0, 30.0)])
def test_a_box_agrees_with_the_analytical_solution(size: tuple[float, float, float]) -> None:
    a, b, c = size
    factors = g.view_factors(box(a, b, c))
    assert factors[0, 1] == pytest.approx(parallel_factor(a, b, c), abs=1e-11)
    assert factors[2, 3] == pytest.approx(parallel_factor(a, c, b), abs=1e-11)
    assert factors[0, 3] == pytest.approx(perpendicular_factor(a, b, c), abs=1e-11)
    assert factors[5, 0] == pytest.approx(perpendicular_factor(b, c, a), abs=1e-11)


@pytest.mark.parametrize("angle", [20.0, 60.0, 90.0, 135.0, 175.0])
def test_long_hinged_plates(angle: float) -> None:
    """Crossed strings: two plates of width 1 with a common edge, F = 1 - sin(angle/2) when they are long."""
    length, half = 4000.0, math.radians(angle)
    one = g.Polygon.of("one", [(0, 0, 0), (length, 0, 0), (length, 1, 0), (0, 1, 0)])
    y, z = math.cos(half), math.sin(half)
    two = g.Polygon.of("two", [(0, 0, 0), (0, y, z), (length, y, z), (length, 0, 0)])
    factor = g.exchange_areas([one, two])[0, 1] / one.area
    assert factor == pytest.approx(1.0 - math.sin(half / 2.0), abs=3e-4)


def test_skew_edges_agree_with_quadrature() -> None:
    rng = np.random.default_rng(7)
    nodes, weights = np.polynomial.legendre.leggauss(120)
    s = 0.5 * (nodes + 1.0)
    for _ in range(20):
        p0, p1, q0, q1 = rng.normal(size=(4, 3))
        r = (p0 + s[:, None, None] * (p1 - p0)) - (q0 + s[None, :, None] * (q1 - q0))
        expected = 0.25 * weights @ np.log(np.linalg.norm(r, axis=2)) @ weights
        assert g.log_integral(p0, p1, q0, q1) == pytest.approx(expected, abs=2e-7)
        assert g.log_integral(p1, p0, q0, q1) == pytest.approx(g.log_integral(p0, p1, q0, q1), abs=1e-13)


@given(
    st.tuples(
        st.floats(1.0, 6.0),
        st.floats(0.0, 1.2),
        st.floats(0.0, 1.2),
        st.floats(2.0, 4.0),
        st.floats(-0.3, 0.3),
        st.floats(-0.2, 0.5),
    ),
    st.floats(0.0, 6.0),
)
@settings(max_examples=30, deadline=None)
def test_view_factors_of_any_convex_room_sum_to_one(numbers: tuple[float, ...], turn: float) -> None:
    faces = hexahedron(list(numbers), turn)
    factors = g.view_factors(faces)
    exchange = g.exchange_areas(faces)
    assert np.abs(factors.sum(axis=1) - 1.0).max() < 1e-10
    assert np.array_equal(exchange, exchange.T)
    assert np.all(factors >= 0.0)


def test_the_sloped_room() -> None:
    faces = sloped_room()
    factors = g.view_factors(faces)
    names = [f.name for f in faces]
    door, south, window = names.index("door"), names.index("south"), names.index("window")
    assert g.volume(faces) == pytest.approx(27.0, abs=1e-12)
    areas = g.net_areas(faces)
    assert areas[door] == pytest.approx(1.54)
    assert areas[south] == pytest.approx(3.0 * (3.0 + 1.5 * math.tan(math.radians(20))) - 1.54)
    assert areas[names.index("ceiling")] == pytest.approx(9.0 / math.cos(math.radians(20)))
    assert factors[door, south] == 0.0
    assert np.abs(factors.sum(axis=1) - 1.0).max() < 1e-12
    # The wall with its door sees the window as the whole outline does.
    whole = g.exchange_areas([f for f in faces if f.name != "door"])
    parts = g.exchange_areas(faces)
    assert parts[south, window] + parts[door, window] == pytest.approx(whole[south, window - 1], abs=1e-14)


def test_parents_may_be_nested() -> None:
    wall = g.Polygon.of("wall", [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)])
    frame = g.Polygon.of("frame", [(1, 0, 1), (2, 0, 1), (2, 0, 2), (1, 0, 2)])
    pane = g.Polygon.of("pane", [(1.1, 0, 1.1), (1.9, 0, 1.1), (1.9, 0, 1.9), (1.1, 0, 1.9)])
    assert g.parents([wall, frame, pane]) == [None, 0, 1]
    assert g.net_areas([wall, frame, pane]) == pytest.approx([11.0, 0.36, 0.64])
    with pytest.raises(InputError, match="cover the same area"):
        g.parents([wall, g.Polygon.of("again", wall.vertices)])


def test_a_neighbor_in_the_plane_is_no_child() -> None:
    el = g.Polygon.of("el", [(0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 4, 0), (0, 4, 0)])
    bridge = g.Polygon.of("bridge", [(0.5, 0.2, 0), (3.9, 0.2, 0), (3.9, 0.9, 0), (0.5, 3.9, 0)])
    assert g.parents([el, bridge]) == [None, None]


@pytest.mark.parametrize(
    ("low", "high", "meet"),
    [
        ((0.5, 0.0), (1.5, 1.0), True),  # shifted along shared edges
        ((0.25, -1.0), (0.75, 2.0), True),  # a cross
        ((0.0, 0.0), (1.0, 1.0), True),  # itself
        ((0.2, 0.2), (0.8, 0.8), True),  # within
        ((1.0, 0.0), (2.0, 1.0), False),  # an edge in common
        ((1.0, 1.0), (2.0, 2.0), False),  # a corner in common
        ((1.5, 0.0), (2.0, 1.0), False),
    ],
)
def test_overlapping_polygons(low: tuple[float, float], high: tuple[float, float], meet: bool) -> None:
    def drawn(a: tuple[float, float], b: tuple[float, float]) -> g.Polygon:
        return g.Polygon.of("box", [(a[0], 0, a[1]), (b[0], 0, a[1]), (b[0], 0, b[1]), (a[0], 0, b[1])])

    unit, other = drawn((0.0, 0.0), (1.0, 1.0)), drawn(low, high)
    assert unit.overlaps(other) is other.overlaps(unit) is meet
    assert not unit.overlaps(g.Polygon.of("off", [(x, 1.0, z) for x, _, z in other.vertices]))


def test_open_edges_are_named() -> None:
    faces = box(3, 4, 2.5)
    gaps = g.open_edges(faces[1:])
    assert {gap.polygon for gap in gaps} == {"north", "south", "west", "east"}
    assert sum(gap.length for gap in gaps) == pytest.approx(14.0)
    with pytest.raises(InputError, match=r"4 open edges .*north: from .* 3\.000 m"):
        g.volume(faces[1:])
    with pytest.raises(InputError, match=r"sum to .* expected 1"):
        g.view_factors(faces[1:])


def test_a_split_surface_is_closed_where_corners_meet_edges() -> None:
    faces = box(3, 4, 2.5)
    left = g.Polygon.of("left", [(0, 0, 0), (1, 0, 0), (1, 4, 0), (0, 4, 0)])
    right = g.Polygon.of("right", [(1, 0, 0), (3, 0, 0), (3, 4, 0), (1, 4, 0)])
    split = [left, right, *faces[1:]]
    assert g.open_edges(split) == []
    assert g.volume(split) == pytest.approx(30.0, abs=1e-12)
    assert np.abs(g.view_factors(split).sum(axis=1) - 1.0).max() < 1e-12


def test_normals_out_of_the_zone_are_an_error() -> None:
    with pytest.raises(InputError, match="counter-clockwise seen from outside"):
        g.volume([face.reversed() for face in box(1, 1, 1)])


def test_a_zone_that_is_not_convex_is_an_error() -> None:
    plan = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]
    faces = [
        g.Polygon.of("floor", [(x, y, 0) for x, y in plan]),
        g.Polygon.of("ceiling", [(x, y, 3) for x, y in reversed(plan)]),
    ]
    for i, (x, y) in enumerate(plan):
        u, v = plan[(i + 1) % len(plan)]
        faces.append(g.Polygon.of(f"wall {i}", [(u, v, 0), (x, y, 0), (x, y, 3), (u, v, 3)]))
    assert g.volume(faces) == pytest.approx(18.0)
    with pytest.raises(InputError, match="not convex: vertex"):
        g.view_factors(faces)
