"""Random surfaces, windows and shades around the zones of a random building."""

from __future__ import annotations

import math
from typing import Any

from mascarin.building.base.law_table import CONVECTION, IMPOSED, LawRow
from mascarin.building.base.part import Part
from mascarin.building.parts.envelope.surface import Side
from mascarin.building.parts.openings.window import WindowOutside
from random_draw import Draw, four, numbers_of
from random_schedules import Schedules

Json = dict[str, Any]
Point = list[float]


# --- sides --------------------------------------------------------------------------------------------------


def _may_stand(row: LawRow, facing: str) -> bool:
    """Whether a published law may stand on a side."""
    return row.sides == "any" or facing == "outdoors" or (row.sides == "air" and facing == "zone")


def _published(draw: Draw, row: LawRow, facing: str) -> Json:
    """A published law with some of its numbers, within their ranges."""

    def numbers() -> Json:
        return numbers_of(draw, row, outdoors=facing == "outdoors")

    if row.by_direction:
        return {"kind": row.kind, "upward": numbers(), "downward": numbers()}
    return {"kind": row.kind, **numbers()}


def _rows() -> list[LawRow]:
    """Published laws of convection in the order in which cases got their numbers, before one was renamed."""
    rows = dict(CONVECTION)
    renamed = rows.pop("guichard2016_eq5")
    position = list(rows).index("power")
    return [*list(rows.values())[:position], renamed, *list(rows.values())[position:]]


def film(draw: Draw, facing: str) -> Any:
    """A surface heat transfer coefficient that suits what the side faces."""
    plain = draw.of(draw.log(0.5, 40.0), draw.noted(draw.number(2.0, 20.0), 1.0))
    factor: Json = {"factor": draw.number(0.5, 2.0)} if draw.chance(0.3) else {}
    any_air = [
        plain,
        *(_published(draw, row, facing) for row in _rows() if _may_stand(row, facing)),
        {"kind": "measured", "column": "h_film"} | factor,
        {
            "kind": "text",
            "formula": "c*abs(dT)^n + b",
            "c": draw.noted(draw.number(0.5, 4.0), 0.5),
            "n": draw.number(0.1, 0.6),
            "b": draw.number(0.0, 2.0),
            "valid": "abs(dT) < 40",
            "source": "a paper",
        },
        {
            "formula": "c*cbrt(abs(dT)) + b",
            "numbers": {"c": draw.number(0.5, 4.0), "b": draw.number(0.0, 2.0)},
        },
    ]
    if facing == "zone":
        any_air += ["tarp", "alamdari_hammond"]
    if facing == "outdoors":
        any_air += [
            "tarp",
            "doe2",
            {"formula": "sqrt((c*abs(dT)^(1/3))^2 + (b*V^m)^2)", "c": 1.31, "b": 3.2, "m": 0.8},
        ]
    return draw.one(any_air)


def _irradiance(draw: Draw, part: type[Part], column: str) -> Json:
    """A measured irradiance: of the free plane, or behind what shades it where a part has this key."""
    keys: Json = {"irradiance": column}
    if "behind_obstacles" in part.model_fields and draw.chance(0.4):
        keys["behind_obstacles"] = draw.of(True, True, False)
    return keys


def outdoors(draw: Draw) -> Json:
    """A side that faces the weather, or parts of it."""
    side: Json = {
        "outdoors": True,
        "convection": film(draw, "outdoors"),
        "emissivity": draw.number(0.04, 0.95),
    }
    exposed = {"sun": True, "wind": True, "sky": True}
    if draw.chance(0.12):
        exposed = {key: draw.chance(0.5) for key in exposed}
        side["exposure"] = exposed
    if exposed["sun"]:
        side["absorptance"] = draw.noted(draw.number(0.0, 1.0), 0.0)
        if draw.chance(0.08):
            side |= _irradiance(draw, Side, "G_wall")
    if ((exposed["sun"] and "irradiance" not in side) or exposed["sky"]) and draw.chance(0.15):
        side["sky_view"] = draw.number(0.0, 1.0)
        if exposed["sun"] and "irradiance" not in side:
            # From the number that is drawn: all other draws stay as they are.
            side["ground_view"] = 1.0 - side["sky_view"]
    if exposed["wind"] and draw.chance(0.25):
        side["height"] = draw.log(0.5, 60.0)
    if draw.chance(0.1):
        side["area_factor"] = draw.number(0.8, 2.0)
    if draw.chance(0.4):
        side["longwave"] = draw.of(
            "none", "exact", {"kind": "linearised", "reference": draw.number(-20.0, 40.0)}
        )
    return side


def inside(draw: Draw, zone: str) -> Json:
    """A side that faces a zone."""
    return {
        "zone": zone,
        "convection": film(draw, "zone"),
        "emissivity": draw.of(0.9, draw.number(0.04, 0.95)),
        "absorptance": draw.number(0.0, 1.0),
    }


def _heat_flux(draw: Draw, schedules: Schedules) -> Any:
    if draw.chance(0.3):
        return draw.number(-15.0, 30.0)
    if draw.chance(0.5):
        column: Json = {"column": "q_foil"} | ({"unit": "W/m2"} if draw.chance(0.5) else {})
        return column | ({"factor": draw.number(-0.5, 1.0)} if draw.chance(0.5) else {})
    return {"flux": draw.number(-15.0, 30.0)} | schedules.maybe("on", 0.5)


def beyond(draw: Draw, schedules: Schedules) -> Json:
    """A side that faces neither the weather nor a zone."""
    ground: Json = draw.of(
        {"temperature": draw.number(-5.0, 25.0)},
        {"mean": draw.number(0.0, 20.0), "amplitude": draw.number(0.0, 10.0)},
        {
            "mean": draw.number(0.0, 20.0),
            "amplitude": draw.number(0.0, 10.0),
            "coldest_day": draw.whole(1, 365),
        },
    )
    way = draw.whole(0, 5)
    if way == 0:
        return {"adiabatic": True}
    if draw.chance(0.1):
        return {"heat_flux": _heat_flux(draw, schedules)}
    laws = [row for row in IMPOSED.values() if row.kind != "ground"]
    if way == 5:
        law = draw.one(laws)
        numbers = numbers_of(draw, law)
        coefficient: Json = {"convection": film(draw, "given")} if draw.chance(0.5) else {}
        if law.gives_coefficient:
            coefficient = {}
        return {"imposed": {"kind": law.kind, **numbers}} | coefficient
    side: Json = (
        {"measured": draw.of("T_a", "T_b", ["T_a", "T_b"])}
        if way == 1
        else {"scheduled": schedules.named("around")}
        if way == 2
        else {"ground": ground}
    )
    if draw.chance(0.5):
        side["convection"] = film(draw, "given")
        if way == 1 and draw.chance(0.3):
            side |= {"irradiance": "G_wall", "absorptance": draw.number(0.1, 0.9)}
        if draw.chance(0.1):
            side["area_factor"] = draw.number(0.8, 1.5)
    return side


# --- windows ------------------------------------------------------------------------------------------------


def _blind(draw: Draw, schedules: Schedules) -> Json:
    through = draw.of(0.0, draw.number(0.0, 0.6))
    blind: Json = {
        "position": draw.of("outside", "inside"),
        "transmittance": through,
        "reflectance": four((0.999 - through) * draw.number(0.0, 1.0)),
    }
    if draw.chance(0.6):
        blind["resistance"] = draw.log(0.02, 1.0)
    else:
        blind["shutter_resistance"] = draw.number(0.0, 0.5)
        blind["air_permeability"] = draw.of("very_high", "high", "average", "low", "tight")
    if draw.chance(0.3):
        blind["emissivity"] = draw.number(0.05, 0.95)
    if draw.chance(0.3):
        blind["cover"] = draw.number(0.0, 1.0)
    if draw.chance(0.3):
        blind["radiation"] = draw.number(0.0, 600.0)
    if blind["position"] == "inside" and through > 0.0:
        blind["to_air"] = four(1.0 - through)
    return blind | schedules.maybe("on", 0.4)


def window(draw: Draw, schedules: Schedules, surface: str, between: bool, glazings: list[str]) -> Json:
    """A window without its size, in a wall to outdoors or between two zones."""
    tree: Json = {"surface": surface, "glazing": draw.one(glazings)}
    outer: Json = {"convection": film(draw, "zone" if between else "outdoors")}
    if not between:
        if draw.chance(0.08):
            outer |= _irradiance(draw, WindowOutside, "G_pane")
        elif draw.chance(0.1):
            outer["sky_view"] = draw.number(0.1, 1.0)
            outer["ground_view"] = 1.0 - outer["sky_view"]
        if draw.chance(0.2):
            outer["height"] = draw.log(0.5, 60.0)
        if draw.chance(0.3):
            outer["longwave"] = draw.of("none", "exact", {"kind": "linearised", "reference": 10})
        if draw.chance(0.3):
            tree["blind"] = _blind(draw, schedules)
    if draw.chance(0.4):
        tree["frame"] = {"fraction": draw.number(0.05, 0.6), "u_value": draw.log(0.6, 5.5)}
        if draw.chance(0.3):
            tree["frame"] |= {"absorptance": draw.number(0.1, 0.9), "emissivity": draw.number(0.1, 0.95)}
    if not between and draw.chance(0.2):
        tree["reveal"] = draw.log(0.02, 0.5)
    if draw.chance(0.2):
        tree["cavity_height"] = draw.log(0.2, 3.0)
    return tree | {"outside": outer, "inside": {"convection": film(draw, "zone")}}


def pane_of(wall: list[Point], u: tuple[float, float], v: tuple[float, float]) -> list[Point]:
    """Corners of a rectangle in a wall of four corners, by fractions along its first and last edge."""
    origin, along, up = wall[0], wall[1], wall[3]

    def at(s: float, t: float) -> Point:
        return [round(o + s * (a - o) + t * (b - o), 6) for o, a, b in zip(origin, along, up, strict=True)]

    return [at(u[0], v[0]), at(u[1], v[0]), at(u[1], v[1]), at(u[0], v[1])]


# --- drawn buildings ----------------------------------------------------------------------------------------


def turned(points: list[Point], angle: float) -> list[Point]:
    """Points turned about the vertical [deg]."""
    s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    return [[round(c * x - s * y, 6), round(s * x + c * y, 6), round(z, 6)] for x, y, z in points]


def row_of_rooms(draw: Draw, zones: list[str], attic: str | None) -> dict[str, tuple[list[Point], str, str]]:
    """Rooms in a row, with an attic above them or none.

    Returns
    -------
    dict
        By surface: corners counter-clockwise seen from outside [m], what is outside and what is inside.
    """
    depth, height, x = draw.number(2.0, 9.0), draw.number(2.2, 5.0), 0.0
    shell: dict[str, tuple[list[Point], str, str]] = {}
    for at, zone in enumerate(zones):
        a, b, h, d = x, x + draw.number(2.0, 9.0), height, depth
        above = attic or "outdoors"
        shell[f"{zone}_floor"] = ([[a, 0, 0], [a, d, 0], [b, d, 0], [b, 0, 0]], "beyond", zone)
        shell[f"{zone}_roof"] = ([[a, 0, h], [b, 0, h], [b, d, h], [a, d, h]], above, zone)
        shell[f"{zone}_south"] = ([[a, 0, 0], [b, 0, 0], [b, 0, h], [a, 0, h]], "outdoors", zone)
        shell[f"{zone}_north"] = ([[b, d, 0], [a, d, 0], [a, d, h], [b, d, h]], "outdoors", zone)
        before = zones[at - 1] if at else "outdoors"
        shell[f"{zone}_west"] = ([[a, d, 0], [a, 0, 0], [a, 0, h], [a, d, h]], before, zone)
        x = b
    shell["last_east"] = (
        [[x, 0, 0], [x, depth, 0], [x, depth, height], [x, 0, height]],
        "outdoors",
        zones[-1],
    )
    if attic is not None:
        d, h, top = depth, height, height + draw.number(0.5, 3.0)
        ridge = [[0, d / 2, top], [x, d / 2, top]]
        shell["pitch_south"] = ([[0, 0, h], [x, 0, h], ridge[1], ridge[0]], "outdoors", attic)
        shell["pitch_north"] = ([[x, d, h], [0, d, h], ridge[0], ridge[1]], "outdoors", attic)
        shell["gable_west"] = ([[0, d, h], [0, 0, h], ridge[0]], "outdoors", attic)
        shell["gable_east"] = ([[x, 0, h], [x, d, h], ridge[1]], "outdoors", attic)
    angle = draw.of(0.0, 0.0, draw.number(-180.0, 180.0))
    return {name: (turned(points, angle), out, inner) for name, (points, out, inner) in shell.items()}


def shade(draw: Draw, wall: list[Point]) -> Json:
    """An overhang above a wall or a fin beside it, or a screen before it."""
    (x0, y0, _), (x1, y1, _), top = wall[0], wall[1], wall[3][2]
    length = math.hypot(x1 - x0, y1 - y0)
    out = draw.number(0.3, 4.0)
    # Outwards is to the right of the lower edge, whose corners are counter-clockwise seen from outside.
    ox, oy = out * (y1 - y0) / length, -out * (x1 - x0) / length
    kind = draw.whole(0, 2)
    if kind == 0:
        z = four(top + draw.number(0.01, 1.0))
        points = [[x0, y0, z], [x1, y1, z], [x1 + ox, y1 + oy, z], [x0 + ox, y0 + oy, z]]
    elif kind == 1:
        points = [[x0, y0, 0.0], [x0 + ox, y0 + oy, 0.0], [x0 + ox, y0 + oy, top], [x0, y0, top]]
    else:
        points = [
            [x0 + ox, y0 + oy, 0.0],
            [x1 + ox, y1 + oy, 0.0],
            [x1 + ox, y1 + oy, top],
            [x0 + ox, y0 + oy, top],
        ]
    return {"vertices": [[round(c, 6) for c in point] for point in points]}
