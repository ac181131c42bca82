"""Angle factors from a seat against closed forms, the mean radiant temperature there, and bad seats."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from design_support import written
from mascarin.building.geometry import Polygon, plane_factor, solid_angle, view_factors
from mascarin.comfort import ComfortSettings, SeatView, seen_from
from mascarin.design import read_design, run_design

LONG, WIDE, HIGH = 5.0, 4.0, 2.5
CORNERS: dict[str, list[list[float]]] = {
    "floor": [[0, 0, 0], [0, WIDE, 0], [LONG, WIDE, 0], [LONG, 0, 0]],
    "roof": [[0, 0, HIGH], [LONG, 0, HIGH], [LONG, WIDE, HIGH], [0, WIDE, HIGH]],
    "south": [[0, 0, 0], [LONG, 0, 0], [LONG, 0, HIGH], [0, 0, HIGH]],
    "north": [[LONG, WIDE, 0], [0, WIDE, 0], [0, WIDE, HIGH], [LONG, WIDE, HIGH]],
    "west": [[0, WIDE, 0], [0, 0, 0], [0, 0, HIGH], [0, WIDE, HIGH]],
    "east": [[LONG, 0, 0], [LONG, WIDE, 0], [LONG, WIDE, HIGH], [LONG, 0, HIGH]],
}
SIGMA = 5.670374419e-8
#: A window in the south wall, from x 1 to 4 m and z 0.8 to 2 m.
WINDOW = [[1, 0, 0.8], [4, 0, 0.8], [4, 0, 2.0], [1, 0, 2.0]]
NEAR, FAR = (2.5, 0.5, 0.6), (2.5, 3.5, 0.6)


def room() -> mc.Building:
    """A room with vertices and a window in its south wall."""
    outside = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.5}
    surfaces: dict[str, Any] = {
        name: {
            "construction": "wall",
            "vertices": corners,
            "outside": outside,
            "inside": {"zone": "room", "absorptance": 0.6, "convection": 3, "emissivity": 0.9},
        }
        for name, corners in CORNERS.items()
    }
    surfaces["south"]["inside"]["emissivity"] = 0.2
    plain = {
        "name": "room with a seat",
        "site": {"latitude": 39.7, "longitude": -105.2, "altitude": 1800, "timezone": "UTC-7"},
        "materials": {"board": {"conductivity": 0.2, "density": 800, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "board", "thickness": 0.05}]}},
        "glazings": {"clear": {"kind": "simple", "u_value": 5.5, "solar_heat_gain": 0.8}},
        "zones": {"room": {"infiltration": 0.5}},
        "surfaces": surfaces,
        "windows": {
            "window": {
                "surface": "south",
                "glazing": "clear",
                "vertices": WINDOW,
                "outside": {"convection": 15},
                "inside": {"convection": 3},
            }
        },
    }
    return mc.Building.from_dict(plain)


@pytest.fixture(scope="module")
def building() -> mc.Building:
    return room()


def corner_angle(a: float, b: float, d: float) -> float:
    """Solid angle of a rectangle ``a x b`` from a point at the distance ``d`` above one of its corners."""
    return math.atan2(a * b, d * math.sqrt(a * a + b * b + d * d))


def angle(point: tuple[float, float, float]) -> float:
    """Solid angle of the window, from the four rectangles that have a corner before the point [sr]."""
    x, y, z = point

    def signed(a: float, b: float) -> float:
        return math.copysign(1.0, a * b) * corner_angle(abs(a), abs(b), y)

    return sum(
        sign * signed(edge - x, height - z)
        for edge, s in ((4.0, 1), (1.0, -1))
        for height, sign in ((2.0, s), (0.8, -s))
    )


@pytest.mark.parametrize("posture", ["sphere", "seated", "standing"])
@pytest.mark.parametrize("facing", [None, 37.0])
def test_factors_of_a_closed_room_sum_to_one(
    building: mc.Building, posture: Any, facing: float | None
) -> None:
    """Before they are normalized: the polygons leave nothing open and count nothing twice."""
    from mascarin.comfort.seat import _factor

    total = sum(_factor(Polygon.of(n, c[::-1]), NEAR, posture, facing) for n, c in CORNERS.items())
    assert total == pytest.approx(1.0, abs=1e-12)
    view = seen_from(building, "room", NEAR, posture, facing)
    assert sum(view.factors) == pytest.approx(1.0, abs=1e-14)
    assert min(view.factors) > 0.0
    # All surfaces alike exchange nothing.
    alike = np.array([21.5] * len(view.sides) + [0.0] * len(view.sides))
    assert view.radiant(np.tile(alike, (3, 1))) == pytest.approx([21.5] * 3, abs=1e-10)


@pytest.mark.parametrize("point", [NEAR, FAR, (0.3, 1.7, 2.2)])
def test_the_window_is_seen_under_its_solid_angle(
    building: mc.Building, point: tuple[float, float, float]
) -> None:
    view = seen_from(building, "room", point)
    factors = dict(zip(view.sides, view.factors, strict=True))
    assert factors["window.inside"] == pytest.approx(angle(point) / (4 * math.pi), rel=1e-12)
    whole = sum(
        corner_angle(a, b, point[1]) for a in (point[0], LONG - point[0]) for b in (point[2], HIGH - point[2])
    )
    assert factors["south.inside"] == pytest.approx((whole - angle(point)) / (4 * math.pi), rel=1e-12)


def test_a_seat_beside_a_cold_window_is_colder() -> None:
    """By ``(F_near - F_far) 18 K`` for black surfaces at 20 degC around glass of 2 degC, linearized."""
    building = room()
    found = {}
    for name, point in (("near", NEAR), ("far", FAR)):
        view = seen_from(building, "room", point)
        black = SeatView(view.sides, view.factors)
        cold = np.array([2.0 if side.startswith("window") else 20.0 for side in black.sides])
        found[name] = float(black.radiant(cold))
        share = angle(point) / (4 * math.pi)
        fourth = share * 275.15**4 + (1 - share) * 293.15**4
        assert found[name] == pytest.approx(fourth**0.25 - 273.15, abs=1e-9)
    linear = 18.0 * (angle(NEAR) - angle(FAR)) / (4 * math.pi)
    assert 1.5 < found["far"] - found["near"] < linear


def test_a_person_sees_planes_by_their_projected_areas(building: mc.Building) -> None:
    """The roof from a small plane below it, by the closed form; seated 0.18 of 1.4 look up, 0.26 sideways."""
    x, y, z = NEAR
    d = HIGH - z

    def parallel(a: float, b: float) -> float:
        p, q = a / d, b / d
        r, s = math.sqrt(1 + p * p), math.sqrt(1 + q * q)
        return (p / r * math.atan(q / r) + q / s * math.atan(p / s)) / (2 * math.pi)

    def upright(a: float, b: float) -> float:
        """A rectangle above a vertical plane: ``a`` is counted along its normal, ``b`` across."""
        return (math.atan(b / d) - d / math.hypot(d, a) * math.atan(b / math.hypot(d, a))) / (2 * math.pi)

    up = sum(parallel(a, b) for a in (x, LONG - x) for b in (y, WIDE - y))
    roof = Polygon.of("roof", CORNERS["roof"][::-1])
    assert plane_factor(roof, NEAR, (0, 0, 1)) == pytest.approx(up, rel=1e-12)
    assert plane_factor(roof, NEAR, (0, 0, -1)) == 0.0
    front = upright(WIDE - y, x) + upright(WIDE - y, LONG - x)
    assert plane_factor(roof, NEAR, (0, 1, 0)) == pytest.approx(front, rel=1e-12)
    back = upright(y, x) + upright(y, LONG - x)
    sides = upright(x, y) + upright(x, WIDE - y) + upright(LONG - x, y) + upright(LONG - x, WIDE - y)
    for facing, weights in ((None, (0.26, 0.26)), (0.0, (0.30, 0.22)), (90.0, (0.22, 0.30))):
        view = seen_from(building, "room", NEAR, "seated", facing)
        by_hand = (0.18 * up + weights[0] * (front + back) + weights[1] * sides) / 1.4
        assert view.factors[view.sides.index("roof.inside")] == pytest.approx(by_hand, rel=1e-12)


def test_a_polygon_with_a_notch_and_one_from_behind() -> None:
    """The fan over a notch cancels what is outside: a whole rectangle less the one that is cut out."""
    notched = Polygon.of("l", [[0, 0, 1], [0, 2, 1], [1, 2, 1], [1, 1, 1], [2, 1, 1], [2, 0, 1]])
    point = (0.4, 0.3, 0.0)
    whole, cut = (Polygon.of("r", [[a, a, 1], [a, 2, 1], [2, 2, 1], [2, a, 1]]) for a in (0, 1))
    assert solid_angle(notched, point) == pytest.approx(
        solid_angle(whole, point) - solid_angle(cut, point), rel=1e-12
    )
    up = (0.0, 0.6, 0.8)
    assert plane_factor(notched, point, up) == pytest.approx(
        plane_factor(whole, point, up) - plane_factor(cut, point, up), rel=1e-12
    )
    assert solid_angle(notched, (0.4, 0.3, 2.0)) == pytest.approx(-solid_angle(notched, point), rel=1e-12)


def test_comfort_of_a_run_at_a_seat(building: mc.Building, tmp_path: Path) -> None:
    """From the series of the surfaces; a design rates its room at the same seat alike."""
    view = seen_from(building, "room", NEAR)
    climate = mc.Climate.shipped("golden")
    recorded = ["room.air_temperature", "room.mean_radiant_temperature", *view.outputs]
    span: dict[str, Any] = {"start": "2001-01-05", "end": "2001-01-06", "step": "1h"}
    moved = building.replace({f"site.{key}": value for key, value in {
        "latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"}.items()})  # fmt: skip
    run = mc.simulate(moved, climate, outputs=recorded, **span)
    keys: dict[str, Any] = {"index": "operative", "band": [18, 26]}
    seated = run.comfort("room", building=moved, seat=NEAR, **keys)
    found = seated.to_dataframe()["mean_radiant_temperature"].to_numpy()
    # Radiosities of gray surfaces from their temperatures and view factors alone.
    outlines = CORNERS | {"window": WINDOW}
    names = [side.removesuffix(".inside") for side in view.sides]
    exchange = view_factors([Polygon.of(name, outlines[name][::-1]) for name in names])
    emissivity = np.array([{"south": 0.2, "window": 0.84}.get(name, 0.9) for name in names])
    kelvin = np.stack([run[f"{side}_temperature"].to_numpy() for side in view.sides]) + 273.15
    emitted = emissivity[:, None] * SIGMA * kelvin**4
    leaving = np.linalg.solve(np.eye(len(names)) - (1.0 - emissivity)[:, None] * exchange, emitted)
    by_hand = (np.array(view.factors) @ leaving / SIGMA) ** 0.25 - 273.15
    assert found == pytest.approx(by_hand, abs=1e-6)
    black = SeatView(view.sides, view.factors).radiant((kelvin - 273.15).T)
    assert np.abs(black - by_hand).max() > 0.05
    assert "at the seat [2.5, 0.5, 0.6]" in seated.notes[0]
    plain = run.comfort("room", **keys)
    assert abs(seated.degree_hours - plain.degree_hours) > 0.5
    with pytest.raises(mc.InputError, match="expected the building of the run"):
        run.comfort("room", seat=NEAR, **keys)
    short = mc.simulate(moved, climate, outputs=recorded[:3], **span)
    with pytest.raises(mc.InputError, match=r"not recorded.*seen_from\(building, 'room', seat\)"):
        short.comfort("room", building=moved, seat=NEAR, **keys)

    objective = {"kind": "comfort", "zones": ["room"], "comfort": {**keys, "seat": list(NEAR)}}
    variables = {"walls": {"path": "constructions.wall.layers.board.thickness", "values": [0.05, 0.1]}}
    file = written(
        tmp_path, objectives={"seat": objective}, uncertainty=None, variables=variables,
        climates={"golden": {"epw": "shipped:golden", "start": "01-05", "end": "01-06"}},
    )  # fmt: skip
    (tmp_path / "building.yaml").write_text(json.dumps(building.to_dict()), encoding="utf-8")
    designs = run_design(read_design(file), tmp_path / "out")
    assert designs.values("seat")[0] == pytest.approx(seated.degree_hours, rel=1e-3)
    higher = {**room().to_dict()["windows"]["window"], "vertices": [[x, y, z + 0.3] for x, y, z in WINDOW]}
    shapes = {"window": {"variants": {"low": {}, "high": {"windows.window": higher}}}}
    written(tmp_path, objectives={"seat": objective}, variables=shapes, uncertainty=None)
    (tmp_path / "building.yaml").write_text(json.dumps(building.to_dict()), encoding="utf-8")
    with pytest.raises(mc.InputError, match="a seat that sees the surfaces of the designs differently"):
        read_design(file)
    coated = {"low": {"path": "surfaces.roof.inside.emissivity", "values": [0.1, 0.9]}}
    uncertain = {"parameters": ["surfaces.roof.inside.emissivity"], "samples": 4}
    for chosen, unknown in ((coated, None), (variables, uncertain)):
        written(tmp_path, objectives={"seat": objective}, variables=chosen, uncertainty=unknown)
        (tmp_path / "building.yaml").write_text(json.dumps(building.to_dict()), encoding="utf-8")
        with pytest.raises(mc.InputError, match="the same vertices and emissivities"):
            read_design(file)


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ((2.5, 0.5, 3.0), r"outside of zone 'room'.*z 0 to 2.5 m"),
        ((2.5, 0.0, 1.0), "on 'window' of zone 'room'|on 'south' of zone 'room'"),
    ],
)
def test_seats_that_cannot_be_are_refused(building: mc.Building, at: Any, said: str) -> None:
    with pytest.raises(mc.InputError, match=said):
        seen_from(building, "room", at)


def test_rooms_that_are_open_or_hidden_are_refused() -> None:
    """Without the roof, what is open is said; in a bent room, the wall that hides a part of it."""
    plain = room().to_dict()
    roofless = {name: one for name, one in plain["surfaces"].items() if name != "roof"}
    zones = {"room": {"infiltration": 0.5, "volume": 50}}
    opened = mc.Building.from_dict(plain | {"surfaces": roofless, "zones": zones})
    missing = 4 * math.pi - sum(
        solid_angle(Polygon.of(n, c[::-1]), NEAR) for n, c in CORNERS.items() if n != "roof"
    )
    with pytest.raises(mc.InputError, match=rf"{missing:.2f} of 12.57 sr are open.*first open edge"):
        seen_from(opened, "room", NEAR)
    bent = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]
    surfaces = {
        f"wall_{k}": {**plain["surfaces"]["south"], "vertices": [[*a, 0], [*b, 0], [*b, 3], [*a, 3]]}
        for k, (a, b) in enumerate(zip(bent, [*bent[1:], bent[0]], strict=True))
    }
    surfaces["floor"] = {**plain["surfaces"]["floor"], "vertices": [[*p, 0] for p in reversed(bent)]}
    surfaces["roof"] = {**plain["surfaces"]["roof"], "vertices": [[*p, 3] for p in bent]}
    corner = mc.Building.from_dict(plain | {"surfaces": surfaces, "windows": {}, "glazings": {}})
    assert len(seen_from(corner, "room", (1.0, 1.0, 0.6)).factors) == 8  # from here all of it is seen
    with pytest.raises(mc.InputError, match="'wall_3' of zone 'room' seen from behind"):
        seen_from(corner, "room", (3.5, 1.0, 0.6))


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"posture": "seated"}, "Add 'seat"),
        ({"seat": [1, 1, 1], "facing": 90}, "posture: seated or standing"),
        ({"seat": [1, 1]}, "seat"),
    ],
)
def test_settings_of_a_seat_that_do_not_fit_are_refused(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(mc.InputError, match=said):
        ComfortSettings(index="operative", band=[20, 26], **keys)
