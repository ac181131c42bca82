"""Random buildings that draw every feature of the description; one whole number gives one case.

`description` is a pure function of the seed. Its parts are drawn in `random_shells` (surfaces, windows,
shades), `random_materials`, `random_air` (flows, loads, humidity), `random_laws` (formulas, errors of the
weather) and `random_schedules`; `random_weather` makes the weather and the measured columns. `undrawn`
compares what was drawn with the keys of the description, so that a key that is added later is missed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args

import random_air
import random_heat_sources
import random_laws
import random_materials
import random_shells
import random_soil
from mascarin.building import Building
from mascarin.building.base.law_table import DIFFUSE, SKY
from mascarin.building.base.part import Part
from random_draw import Draw, four, numbers_of
from random_schedules import Schedules
from random_weather import Weather

Json = dict[str, Any]


def description(seed: int, weather: Weather) -> Json:
    """A building by its seed, as a YAML file would hold it.

    Parameters
    ----------
    seed : int
        The case.
    weather : Weather
        Where it stands, and whether the weather has infrared radiation.
    """
    draw = Draw(f"building {seed}")
    maker = _Maker(draw, weather)
    return maker.building(seed)


class _Maker:
    """A building on its way."""

    def __init__(self, draw: Draw, weather: Weather) -> None:
        self.draw, self.weather = draw, weather
        self.schedules = Schedules(draw)
        self.tree: Json = {}

    def building(self, seed: int) -> Json:
        draw, tree = self.draw, self.tree
        count = draw.of(1, 1, 1, 2, 2, 3, 4, 6)
        zones = [f"z{at}" for at in range(count)]
        tree |= {"name": f"case {seed}", "site": self._site()}
        tree["materials"] = random_materials.materials(draw)
        tree["constructions"] = {
            f"c{at}": random_materials.construction(draw, tree["materials"]) for at in range(draw.whole(1, 4))
        }
        tree["glazings"] = {f"g{at}": random_materials.glazing(draw) for at in range(draw.whole(1, 2))}
        attic = "attic" if draw.chance(0.2) and count < 5 else None
        drawn = draw.chance(0.4)
        names = [*zones, *([attic] if attic else [])]
        tree["zones"] = {
            name: random_air.zone(draw, self.schedules, [other for other in names if other != name])
            for name in names
        }
        tree["surfaces"], tree["windows"] = {}, {}
        if drawn:
            self._drawn(zones, attic)
        else:
            self._listed(names)
        self._sun(drawn)
        self._air(names)
        self._sensors()
        if draw.chance(0.45):
            tree["humidity"] = random_air.humidity(draw, self.schedules, tree)
        if draw.chance(0.1):
            tree["ties"] = {"zones.*.volume": "factor"}
        if self.schedules.made:
            tree["schedules"] = self.schedules.made
        if not tree["windows"]:
            del tree["windows"], tree["glazings"]
        random_laws.add(Draw(f"laws {seed}"), tree)
        random_laws.add_to_sky(Draw(f"sky {seed}"), tree["site"])
        random_air.controlled_flows(tree)
        random_air.operative_set_points(tree)
        random_heat_sources.add(Draw(f"heat sources {seed}"), tree)
        random_soil.add(Draw(f"soil {seed}"), tree)
        return tree

    def _site(self) -> Json:
        draw, place = self.draw, self.weather.place
        site: Json = dict(place)
        if draw.chance(0.2):
            site["air_density"] = draw.number(0.7, 1.4)
        if draw.chance(0.2):
            site["air_specific_heat"] = draw.number(1000.0, 1040.0)
        if draw.chance(0.4):
            site["ground_reflectance"] = draw.of(0.0, draw.number(0.0, 0.9))
        if draw.chance(0.4):
            wind: Json = {"terrain": draw.of("open", "suburb", "city", "sea")}
            wind |= {"mast_height": draw.log(2.0, 60.0)} if draw.chance(0.4) else {}
            wind |= {"mast_exponent": 0.2, "mast_layer": 350} if draw.chance(0.2) else {}
            wind |= {"exponent": draw.number(0.0, 0.5), "layer": 400} if draw.chance(0.2) else {}
            site["wind"] = wind
        skies: list[Any] = [
            "martin_berdahl", "clark_allen", "brunt",
            {"kind": "offset", "depression": draw.number(-5.0, 40.0)},
            {"kind": "martin_berdahl", "a": 0.711, "b": 0.56, "c": 0.73},
            {"kind": "brunt", "a": 0.6, "b": 0.06},
            {"kind": "clark_allen", "a": 0.787, "b": 0.764},
        ]  # fmt: skip
        # Models that the engine's tables have beside these.
        stated = {"martin_berdahl", "clark_allen", "brunt", "offset", "measured"}
        skies += [
            {"kind": row.kind, **numbers_of(draw, row)} for row in SKY.values() if row.kind not in stated
        ]
        if self.weather.infrared:
            skies += ["measured", {"kind": "measured", "scale": draw.number(0.8, 1.2)}] * 3
        if draw.chance(0.7):
            site["sky"] = draw.one(skies)
        if draw.chance(0.3):
            site["cloud"] = draw.of(
                "factor", "layer", {"kind": "factor", "c1": 0.02, "c2": -0.003, "c3": 0.0003},
                {"kind": "layer", "emissivity": draw.number(0.0, 1.0), "base": draw.number(100.0, 12_000.0)},
            )  # fmt: skip
        if draw.chance(0.6):
            site["diffuse"] = draw.of(*dict.fromkeys(("perez", "hay_davies", "isotropic", *DIFFUSE)))
        if draw.chance(0.25):
            azimuths = sorted({draw.whole(0, 359) for _ in range(draw.whole(1, 6))})
            site["horizon"] = [[azimuth, draw.of(0.0, draw.number(0.0, 60.0))] for azimuth in azimuths]
        if draw.chance(0.2):
            site["self_shading"] = draw.chance(0.5)
        return site

    # --- surfaces -------------------------------------------------------------------------------------------

    def _outside(self, facing: str) -> Json:
        if facing == "outdoors":
            return random_shells.outdoors(self.draw)
        if facing == "beyond":
            return random_shells.beyond(self.draw, self.schedules)
        return random_shells.inside(self.draw, facing)

    def _put(self, name: str, shape: Json, facing: str, zone: str) -> None:
        draw = self.draw
        self.tree["surfaces"][name] = {
            "construction": draw.one(sorted(self.tree["constructions"])),
            **shape,
            "outside": self._outside(facing),
            "inside": random_shells.inside(draw, zone),
        }

    def _drawn(self, zones: list[str], attic: str | None) -> None:
        """Surfaces with vertices, windows in them, shades before them."""
        draw = self.draw
        shell = random_shells.row_of_rooms(draw, zones, attic)
        glazings = sorted(self.tree["glazings"])
        for name, (points, facing, zone) in shell.items():
            if facing == "outdoors" and draw.chance(0.08):
                facing = "beyond"
            self._put(name, {"vertices": points}, facing, zone)
            if (
                len(points) != 4
                or facing == "beyond"
                or not draw.chance(0.35 if facing == "outdoors" else 0.12)
            ):
                continue
            halves = draw.of([(0.05, 0.95)], [(0.05, 0.45), (0.55, 0.95)])
            for at, (left, right) in enumerate(halves):
                entry = random_shells.window(draw, self.schedules, name, facing != "outdoors", glazings)
                low = draw.number(0.02, 0.4)
                size: Json = {
                    "vertices": random_shells.pane_of(
                        points, (left, right), (low, draw.number(low + 0.2, 0.97))
                    )
                }
                self.tree["windows"][f"{name}_pane_{at}"] = entry | size
        lit = [
            name for name, entry in self.tree["surfaces"].items()
            if entry["outside"].get("outdoors") and entry["outside"].get("exposure", {"sun": True})["sun"]
            and "irradiance" not in entry["outside"]
        ]  # fmt: skip
        walls = [name for name in shell if name.endswith(("_south", "_north", "_east")) and name in lit]
        for at in range(draw.of(0, 0, 1, 2) if walls else 0):
            points = shell[draw.one(walls)][0]
            if len(points) == 4 and points[0][2] == points[1][2] == 0.0:
                self.tree.setdefault("shades", {})[f"shade_{at}"] = random_shells.shade(draw, points)

    def _listed(self, names: list[str]) -> None:
        """Surfaces with areas, tilts and azimuths."""
        draw, glazings = self.draw, sorted(self.tree["glazings"])
        for at, zone in enumerate(names):
            floor = draw.log(2.0, 120.0)
            sloped = draw.of(0.0, 0.0, draw.number(0.0, 60.0))
            self._put(f"{zone}_floor", {"area": floor, "tilt": 180, "azimuth": 0}, "beyond", zone)
            self._put(f"{zone}_roof", {"area": floor, "tilt": sloped, "azimuth": 180}, "outdoors", zone)
            for k in range(draw.whole(1, 3)):
                name, area = f"{zone}_wall_{k}", draw.log(2.0, 60.0)
                shape = {
                    "area": area,
                    "tilt": draw.of(90, 90, 75),
                    "azimuth": draw.of(0, 90, 180, 270, draw.number(-360.0, 360.0)),
                }
                facing = draw.of("outdoors", "outdoors", "outdoors", "beyond")
                self._put(name, shape, facing, zone)
                if facing == "outdoors" and draw.chance(0.45):
                    self._window(name, area, False, glazings)
            if at:
                name, area = f"{zone}_between", draw.log(2.0, 30.0)
                self._put(
                    name, {"area": area, "tilt": draw.of(90, 0), "azimuth": 90}, draw.one(names[:at]), zone
                )
                if draw.chance(0.2):
                    self._window(name, area, True, glazings)
            if draw.chance(0.3):
                shape = {"area": draw.log(1.0, 80.0), "tilt": 90, "azimuth": 0, "internal_mass": True}
                self._put(f"{zone}_mass", shape, zone, zone)
        if draw.chance(0.08):
            sample: Json = {"construction": "c0", "area": 1, "tilt": 90, "azimuth": 0}
            sides = {"outside": self._outside("beyond"), "inside": self._outside("beyond")}
            self.tree["surfaces"]["sample"] = sample | sides
        if draw.chance(0.06):  # the inner side in the weather
            wall = self.tree["surfaces"][f"{names[0]}_roof"]
            wall["outside"], wall["inside"] = wall["inside"], wall["outside"]

    def _window(self, wall: str, area: float, between: bool, glazings: list[str]) -> None:
        window = random_shells.window(self.draw, self.schedules, wall, between, glazings)
        window["area"] = self.draw.noted(four(area * self.draw.number(0.02, 0.9)), 0.0)
        steep = 60.0 <= self.tree["surfaces"][wall].get("tilt", 0.0) <= 120.0
        if steep and not between and self.draw.chance(0.2):
            depth = self.draw.log(0.1, 2.0)
            gap, extension = self.draw.number(0.0, 1.0), self.draw.number(0.0, 1.0)
            whole = {"depth": depth, "gap": gap, "extension": extension}
            window["overhang"] = self.draw.of(depth, whole, {"depth": depth})
        self.tree["windows"][f"{wall}_pane"] = window

    # --- what depends on the surfaces -----------------------------------------------------------------------

    def _sun(self, drawn: bool) -> None:
        """How the sun is spread in zones with windows, and given view factors."""
        draw, tree = self.draw, self.tree
        walls = {
            name: [side.get("zone") for side in (entry["outside"], entry["inside"])]
            for name, entry in tree["surfaces"].items()
        }
        for zone, entry in tree["zones"].items():
            faced = [name for name, both in walls.items() if zone in both]
            panes = [pane for pane in tree["windows"].values() if zone in walls[pane["surface"]]]
            inner = any(all(walls[pane["surface"]]) for pane in panes)
            if panes and draw.chance(0.7):
                ways: list[Any] = ["area", "floor"] + (["geometry"] * 3 if drawn else [])
                entry["sun"] = draw.one(
                    ways
                    + (
                        []
                        if inner
                        else [_shares(draw, faced, {name for name in faced if walls[name] == [zone, zone]})]
                        * 2
                    )
                )
            if panes and not inner and draw.chance(0.15):
                entry["solar_to_air"] = draw.number(0.0, 0.5)
            twice = any(both == [zone, zone] for both in (walls[name] for name in faced))
            if not panes and not twice and len(faced) > 2 and draw.chance(0.15):
                entry["view_factors"] = {
                    name: {other: 1.0 / (len(faced) - 1) for other in faced if other != name}
                    for name in faced
                }

    def _air(self, names: list[str]) -> None:
        draw, tree = self.draw, self.tree
        controls = random_air.controls(draw, names)
        vertical = {
            name: entry["inside"]["zone"]
            for name, entry in tree["surfaces"].items()
            if entry["outside"].get("outdoors") and entry.get("tilt", 0) == 90
        }
        air_paths = random_air.paths(draw, self.schedules, names)
        units = random_air.units(draw, self.schedules, names)
        for name in sorted(random_air.moved(air_paths, units)):
            tree["zones"][name]["makeup_air"] = "outdoors"
        sections = {
            "air_paths": air_paths,
            "ventilation_units": units,
            "controls": controls,
            "openings": random_air.openings(draw, self.schedules, names, sorted(controls)),
            "vents": random_air.vents(draw, self.schedules, names, vertical, sorted(controls)),
        }
        tree |= {section: parts for section, parts in sections.items() if parts}

    def _sensors(self) -> None:
        draw, tree = self.draw, self.tree
        for at in range(draw.of(0, 0, 1, 2)):
            name = draw.one(sorted(tree["surfaces"]))
            layers = tree["constructions"][tree["surfaces"][name]["construction"]]["layers"]
            deep = sum(_plain(layer.get("thickness", 0.0)) for layer in layers)
            tree.setdefault("sensors", {})[f"sensor_{at}"] = {
                "surface": name, "depth": draw.of(0.0, four(0.99 * deep * draw.number(0.0, 1.0)))
            }  # fmt: skip


def _plain(number: Any) -> float:
    return float(number["value"] if isinstance(number, dict) else number)


def _shares(draw: Draw, faced: list[str], inner: set[str]) -> Json:
    """Fractions of the sun by surface that sum to one with what is lost."""

    def part() -> Json:
        weights = [draw.number(0.05, 1.0) for _ in range(len(faced) + 1)]
        *each, lost = [four(weight / sum(weights)) for weight in weights]
        shares = dict(zip(faced, each, strict=True))
        masses = {
            name: {"outside": four(0.7 * shares[name]), "inside": four(0.3 * shares.pop(name))}
            for name in faced
            if name in inner
        }
        return {"shares": shares, "lost": lost} | ({"masses": masses} if masses else {})

    return {"kind": "shares", **part(), **({"diffuse": part()} if draw.chance(0.5) else {})}


# --- what was drawn -----------------------------------------------------------------------------------------

#: Keys that no case needs to have: what reading fills in by itself, and what a study writes.
FILLED = {
    ("Layer", "name"), ("TableLaw", "curve"), ("FractionsLaw", "curve"), ("Building", "posterior"),
    ("ThermalBridge", "converted"),
}  # fmt: skip
#: Keys that change no run but by a conversion, which `test_building_dimensions` tries.
OF_DIMENSIONS = {
    ("Building", "dimensions"), ("Dimensions", "areas"), ("Dimensions", "bridges"),
    ("Surface", "dimensions"), ("ThermalBridge", "dimensions"), ("ThermalBridge", "excess"),
}  # fmt: skip
#: Parts that only a study writes, sealed by a checksum, and that change no run: `test_study_carried`.
OF_STUDIES = {"Posterior", "SensorPosterior"}


def drawn_keys(part: Any) -> set[tuple[str, str]]:
    """Classes of the description with their keys, as far as a building gives them."""
    keys: set[tuple[str, str]] = set()
    if isinstance(part, Part):
        for key in part.model_fields_set | ({"kind"} & type(part).model_fields.keys()):
            keys.add((type(part).__name__, key))
            keys |= drawn_keys(getattr(part, key))
    elif isinstance(part, dict):
        for value in part.values():
            keys |= drawn_keys(value)
    elif isinstance(part, tuple | list):
        for value in part:
            keys |= drawn_keys(value)
    return keys


def known_keys() -> set[tuple[str, str]]:
    """All classes that a building is made of, with all their keys."""
    keys: set[tuple[str, str]] = set()
    waiting: list[Any] = [Building]
    seen: set[Any] = set()
    while waiting:
        annotation = waiting.pop()
        if isinstance(annotation, type) and issubclass(annotation, Part) and annotation not in seen:
            seen.add(annotation)
            for key, info in annotation.model_fields.items():
                keys.add((annotation.__name__, key))
                waiting.append(info.annotation)
        else:
            waiting += [inner for inner in get_args(annotation) if inner not in seen]
    return keys


def undrawn(buildings: Iterable[Building]) -> list[str]:
    """Keys of the description that none of some buildings gives."""
    drawn = set().union(*(drawn_keys(building) for building in buildings))
    missing = known_keys() - drawn - FILLED - OF_DIMENSIONS
    return sorted(f"{owner}.{key}" for owner, key in missing if owner not in OF_STUDIES)
