"""Features of a building for the crossing tests: each is a small building that has it.

A section of the description, or a kind of output, that no building here has, fails
`test_crossing.test_every_section_and_output_kind_belongs_to_a_feature`: add a feature, or add it to one.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import pandas as pd

from mascarin.building import Building
from mascarin.building.parts.posterior import Posterior, SensorPosterior, table_of

Json = dict[str, Any]

START, END = "2001-07-02", "2001-07-03"
ZONE = "UTC-05:00"
#: The parameters that entrances vary; every building has them.
VARIED: Final = ("zones.room.volume", "surfaces.south.outside.absorptance")

_BASE: Final[Json] = {
    "name": "room",
    "site": {"latitude": 27.97, "longitude": -82.53, "altitude": 6, "timezone": ZONE},
    "materials": {"board": {"conductivity": 0.2, "density": 800, "specific_heat": 1000}},
    "constructions": {"wall": {"layers": [{"material": "board", "thickness": 0.05}]}},
    "zones": {
        "room": {
            "volume": {"value": 30, "range": [25, 35]}, "infiltration": 0.5,
            "longwave": {"kind": "linearised", "reference": 25},
        }
    },
    "surfaces": {
        "south": {
            "construction": "wall",
            "area": 12,
            "tilt": 90,
            "azimuth": 180,
            "outside": {
                "outdoors": True, "convection": 15, "emissivity": 0.9,
                "longwave": {"kind": "linearised", "reference": 25},
                "absorptance": {"value": 0.5, "range": [0.3, 0.7]},
            },
            "inside": {"zone": "room", "convection": 3, "emissivity": 0.9, "absorptance": 0.5},
        },
    },
}  # fmt: skip


def _side(zone: str) -> Json:
    return {"zone": zone, "convection": 3, "emissivity": 0.9, "absorptance": 0.5}


def _out() -> Json:
    linear = {"kind": "linearised", "reference": 25}
    return {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.5, "longwave": linear}


def _second_room(tree: Json) -> None:
    """A hall behind the room."""
    tree["zones"]["hall"] = {
        "volume": 40,
        "infiltration": 0.3,
        "longwave": {"kind": "linearised", "reference": 25},
    }
    tree["surfaces"] |= {
        "between": {"construction": "wall", "area": 9, "tilt": 90, "azimuth": 0, "outside": _side("hall"),
                    "inside": _side("room")},
        "north": {"construction": "wall", "area": 12, "tilt": 90, "azimuth": 0, "outside": _out(),
                  "inside": _side("hall")},
    }  # fmt: skip


def _window(tree: Json, wall: str = "south") -> None:
    tree["glazings"] = {"clear": {"kind": "simple", "u_value": 2.7, "solar_heat_gain": 0.6}}
    outer = {"convection": 3 if wall == "between" else 15}
    pane = {"surface": wall, "glazing": "clear", "area": 2, "outside": outer, "inside": {"convection": 3}}
    tree["windows"] = {"pane": pane}


def _ceiling(tree: Json, material: Json) -> None:
    """A roof with a layer that melts."""
    tree["materials"]["pcm"] = material
    layers = [{"material": "board", "thickness": 0.02}, {"material": "pcm", "thickness": 0.01}]
    tree["constructions"]["roof"] = {"layers": layers}
    tree["surfaces"]["roof"] = {"construction": "roof", "area": 10, "tilt": 0, "outside": _out(),
                                "inside": _side("room")}  # fmt: skip


_WAX: Final[Json] = {
    "kind": "pcm", "conductivity": 0.2, "density": 900, "specific_heat": 2000, "latent_heat": 150000,
    "melting_temperature": 29, "law": {"kind": "tanh", "width": 1.0},
}  # fmt: skip


def _products(tree: Json) -> None:
    _ceiling(tree, {"product": "RT28HC"})


def _curves(tree: Json) -> None:
    law = {"kind": "table", "temperatures": [20, 26, 29, 33], "enthalpies": [0, 15000, 140000, 150000]}
    _ceiling(tree, {"kind": "pcm", "conductivity": 0.2, "density": 900, "specific_heat": 2000, "law": law})


def _hysteresis(tree: Json) -> None:
    _ceiling(tree, _WAX | {"hysteresis": {"model": "curve_switch", "freezing_temperature": 27}})


def _supercooling(tree: Json) -> None:
    law = {"model": "supercooling", "degree": 2, "time_constant": 600}
    _ceiling(tree, _WAX | {"hysteresis": law})


def _humidity(tree: Json) -> None:
    _loads(tree)
    tree["humidity"] = {
        "materials": {"board": "gypsum"},
        "zones": {
            "room": {
                "gains": {"people": {"power": 60}},
                "drying": {"relative_humidity": 0.6},
                "humidifying": {"relative_humidity": 0.4, "capacity": 50},
            }
        },
    }


def _vents(tree: Json) -> None:
    _second_room(tree)
    tree["vents"] = {
        "casement": {"zone": "room", "surface": "south", "area": 0.1, "height": 0.8, "elevation": 1.5,
                     "pressure": "low_rise"},
        "grille": {"between": ["room", "hall"], "area": 0.05, "elevation": 1},
        "cowl": {"zone": "hall", "azimuth": 0, "area": 0.05, "elevation": 3, "pressure": "low_rise"},
    }  # fmt: skip


def _fans_in_vents(tree: Json) -> None:
    _vents(tree)
    tree["zones"]["hall"]["makeup_air"] = "vents"
    tree["ventilation_units"] = {"hood": {"exhaust": {"hall": 0.02}}}
    tree["surfaces"]["south"]["outside"]["ground_view"] = 0.3


def _controls(tree: Json) -> None:
    _vents(tree)
    tree["controls"] = {
        "warmth": {"zone": "room", "indoor": {"open": 27, "close": 25}},
        "mild": {
            "zone": "room",
            "indoor_below": {"open": 32, "close": 34},
            "outdoor_below": {"open": 29, "close": 31},
        },
    }
    tree["vents"]["casement"]["control"] = "warmth"
    tree["schedules"] = {"half": {"kind": "fraction", "value": 0.5}}
    room = tree["zones"]["room"]
    room["infiltration"] = {"constant": 0.5, "schedule": "half", "control": "mild"}
    room["ventilation"] = {"fan": {"flow": 0.01, "control": "warmth"}}


def _heat_sources(tree: Json) -> None:
    tree["schedules"] = {"half": {"kind": "fraction", "value": 0.5}}
    layer = tree["constructions"]["wall"]["layers"][0]
    tree["constructions"]["active"] = {"layers": [layer | {"name": "lower"}, layer | {"name": "upper"}]}
    tree["controls"] = {"cold": {"zone": "room", "indoor_below": {"open": 18, "close": 20}}}
    faces = {"construction": "active", "area": 9, "tilt": 180, "outside": {"adiabatic": True}}
    tree["surfaces"] |= {name: faces | {"inside": _side("room")} for name in ("heated", "wet")}
    heating = {"zone": "room", "setpoint": 20, "mode": "heating"}
    water = {"flow": {"flow": 0.02, "schedule": "half"}, "supply": 35, "conductance": 12}
    tree["heat_sources"] = {
        "mat": {"surface": "heated", "after": "lower", "electric": 60, "control": "cold"},
        "pipes": {"surface": "wet", "after": "lower", "water": water, "thermostat": heating},
    }


def _openings(tree: Json) -> None:
    tree["openings"] = {"slit": {"zone": "room", "area": 0.02, "height": 0.5}}


def _blinds(tree: Json) -> None:
    _window(tree)
    tree["schedules"] = {"noon": {"kind": "fraction", "days": {"all": [
        {"at": "00:00", "value": 0}, {"at": "11:00", "value": 1}, {"at": "15:00", "value": 0}]}}}  # fmt: skip
    blind = {"position": "outside", "transmittance": 0.1, "reflectance": 0.6, "resistance": 0.1}
    tree["windows"]["pane"]["blind"] = blind | {"schedule": "noon"}


def _loads(tree: Json) -> None:
    tree["zones"]["room"] |= {"heating": {"setpoint": 20}, "cooling": {"setpoint": 25, "capacity": 1500}}


def _stratified_air(tree: Json) -> None:
    """A gradient in a room whose height follows from its floor."""
    tree["surfaces"]["floor"] = {"construction": "wall", "area": 12, "tilt": 180,
                                 "outside": {"adiabatic": True}, "inside": _side("room")}  # fmt: skip
    tree["zones"]["room"]["air_gradient"] = 1.5


def _bridges(tree: Json) -> None:
    tree["dimensions"] = {"areas": "external", "bridges": "external"}
    wall = next(name for name, part in tree["surfaces"].items() if "outdoors" in part["outside"])
    tree["zones"]["room"]["thermal_bridges"] = {
        "edge": {"psi": 0.1, "length": 12},
        "corner": {"psi": 0.1, "length": 3, "dimensions": "internal", "excess": {wall: 0.2}},
        "glass": {"psi": 0.05, "length": 6, "dimensions": "any"},
    }


def _interior_windows(tree: Json) -> None:
    _second_room(tree)
    _window(tree, "between")
    tree["windows"]["outer"] = tree["windows"]["pane"] | {"surface": "south", "outside": {"convection": 15}}


def _measured_columns(tree: Json) -> None:
    tree["zones"]["room"]["gains"] = {"heater": {"column": "P_heater"}}
    tree["surfaces"]["south"]["outside"]["irradiance"] = "G_south"
    tree["surfaces"]["back"] = {"construction": "wall", "area": 9, "tilt": 90, "azimuth": 0,
                                "outside": {"measured": "T_back", "convection": 8},
                                "inside": _side("room")}  # fmt: skip


def _mechanical_air(tree: Json) -> None:
    _second_room(tree)
    tree["ventilation_units"] = {
        "unit": {
            "supply": {"room": {"flow": 0.01, "density": 1.2}},
            "exhaust": {"hall": {"flow": 0.01, "density": 1.2}},
            "recovery": 0.7,
        }
    }
    tree["air_paths"] = {
        "overflow": {"between": ["room", "hall"], "flow": 0.01, "density": 1.2, "one_way": True},
        "door": {"between": ["room", "hall"], "door": {"width": 0.9, "height": 2}},
    }


def _shades(tree: Json) -> None:
    wall = tree["surfaces"]["south"]
    del wall["area"], wall["tilt"], wall["azimuth"]
    wall["vertices"] = [[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]]
    tree["surfaces"]["rest"] = {"construction": "wall", "area": 40, "tilt": 90, "azimuth": 0,
                                "outside": {"adiabatic": True}, "inside": _side("room")}  # fmt: skip
    tree["shades"] = {"overhang": {"vertices": [[0, 0, 3.1], [4, 0, 3.1], [4, -1, 3.1], [0, -1, 3.1]]}}


def _sensors_and_ties(tree: Json) -> None:
    tree["sensors"] = {"core": {"surface": "south", "depth": 0.02}}
    tree["ties"] = {"materials.*.density": "factor"}


def _laws_as_text(tree: Json) -> None:
    tree["materials"]["board"]["conductivity"] = {"formula": "k*(1 + a*T)", "k": 0.19, "a": 0.003}
    tree["zones"]["room"]["infiltration"] = {"formula": "c*sqrt(0.02*abs(dT) + 0.01*V^2)", "c": 0.8}
    tree["site"]["sky"] = {"kind": "text", "formula": "a + b*sqrt(pw/100)", "a": 0.52, "b": 0.065}
    tree["site"] |= {"sky_exponent": 1.2, "sky_diurnal": 15}


def _derived_outputs(tree: Json) -> None:
    tree["derived_outputs"] = {
        "gain": {"formula": "A*south.inside_flux", "A": {"value": 12, "unit": "m2"}, "unit": "W"},
        "overheat": "max(room.air_temperature - 26, 0)",
        "half": "gain/2",
    }


def _weather_errors(tree: Json) -> None:
    tree["weather"] = {
        "clock": 120,
        "columns": {
            "radiation": {"gain": {"value": 1.03, "range": [0.9, 1.1]}},
            "air_temperature": {"offset": {"value": -0.3, "range": [-1, 1]}},
        },
    }


def _column_errors(tree: Json) -> None:
    """Errors of a measured column of the building."""
    _measured_columns(tree)
    tree["weather"] = {"columns": {"T_back": {"offset": 0.2, "clock": 600}}}


def _posterior(tree: Json) -> None:
    """What an earlier study has written; tests/unit/study/test_study_carried.py makes one by a study."""
    volume, absorptance = VARIED
    sample = np.random.default_rng(5).normal([0.5, 30.0], [0.05, 1.0], (20, 2))
    air = SensorPosterior(
        output="room.air_temperature", unit="degC", range=(22.0, 33.0), repeating=0.1, daily=0.1,
        independent=0.1, limit=0.5, errors={"offset": (0.1, 0.8)},
    )  # fmt: skip
    section = Posterior.sealed(
        study="earlier", mascarin="1.0", confidence=0.95, days=3, stated=True,
        intervals={absorptance: (0.5, 0.4, 0.6)}, numbers={volume: 30.0},
        sample=table_of((absorptance, volume), sample), sensors={"air": air},
        weather={"air_temperature": (26.0, 28.0)},
    )  # fmt: skip
    tree["posterior"] = section.model_dump(mode="json")


def _boundaries_and_densities(tree: Json) -> None:
    """A heat flux, the soil below a floor, air of another density, and keys that sides share."""
    tree["surfaces"]["heated"] = {"construction": "wall", "area": 4, "tilt": 90, "azimuth": 0,
                                  "outside": {"heat_flux": {"flux": 5}}, "inside": _side("room")}  # fmt: skip
    soil = {"kind": "soil", "mean": 22, "amplitude": 4, "depth": 1, "coldest_day": 15}
    tree["surfaces"]["floor"] = {"construction": "wall", "area": 12, "tilt": 180,
                                 "outside": {"imposed": soil}, "inside": {"zone": "room"}}  # fmt: skip
    tree["defaults"] = {"indoors": {"convection": 3, "emissivity": 0.9, "absorptance": 0.5}}
    tree["zones"]["room"]["infiltration"] = {"constant": 0.5, "density": "outdoors"}


def _soil(tree: Json) -> None:
    """The floor of a basement on a strip of soil."""
    tree["soil_blocks"] = {
        "below": {"width": 3, "wall_thickness": 0.2, "conductivity": 1.5, "heat_capacity": 2.5e6,
                  "basement_depth": 1, "contact": "floor",
                  "before": {"mean": 22, "amplitude": 4, "coldest_day": 40}},
    }  # fmt: skip
    tree["surfaces"]["floor"] = {"construction": "wall", "area": 12, "tilt": 180,
                                 "outside": {"soil": "below"}, "inside": _side("room")}  # fmt: skip


def _plain(tree: Json) -> None:
    """A room without anything."""


#: Every feature: what it changes in a room.
FEATURES: Final[dict[str, Callable[[Json], None]]] = {
    "nothing": _plain,
    "boundaries and densities": _boundaries_and_densities,
    "products": _products,
    "own curves": _curves,
    "hysteresis": _hysteresis,
    "supercooling": _supercooling,
    "humidity": _humidity,
    "vents": _vents,
    "fans in vents": _fans_in_vents,
    "controls": _controls,
    "heat sources": _heat_sources,
    "soil": _soil,
    "openings": _openings,
    "blinds": _blinds,
    "loads": _loads,
    "stratified air": _stratified_air,
    "thermal bridges": _bridges,
    "interior windows": _interior_windows,
    "measured columns": _measured_columns,
    "mechanical air": _mechanical_air,
    "shades": _shades,
    "sensors and ties": _sensors_and_ties,
    "laws as text": _laws_as_text,
    "derived outputs": _derived_outputs,
    "weather errors": _weather_errors,
    "column errors": _column_errors,
    "posterior": _posterior,
}


def description(feature: str) -> Json:
    """The room with a feature, as a file would hold it."""
    tree = copy.deepcopy(_BASE)
    FEATURES[feature](tree)
    return tree


def building(feature: str) -> Building:
    """The room with a feature."""
    return Building.from_dict(description(feature))


def measured() -> pd.DataFrame:
    """Weather and measured columns of four days, local stamps: a logger's table."""
    index = pd.date_range("2001-07-01", periods=24 * 4, freq="1h", name="time")
    hours = np.arange(len(index))
    wave = np.sin((hours - 9.0) * np.pi / 12.0)
    return pd.DataFrame(
        {
            "air_temperature": (27.0 + 5.0 * wave).round(2),
            "dew_point": np.full(len(index), 18.0),
            "cloud_cover": np.full(len(index), 3.0),
            "wind_speed": (3.0 + 2.0 * np.sin(hours / 5.0)).round(2),
            "wind_direction": (40.0 + 7.0 * hours) % 360.0,
            "direct_normal": np.maximum(600.0 * np.sin((hours - 6.5) * np.pi / 12.0), 0.0).round(1),
            "diffuse_horizontal": np.maximum(150.0 * np.sin((hours - 6.5) * np.pi / 12.0), 0.0).round(1),
            "T_back": (26.0 + 3.0 * wave).round(2),
            "P_heater": np.where(hours % 24 < 6, 300.0, 0.0),
            "G_south": np.maximum(200.0 * wave, 0.0).round(1),
            "air": (27.0 + 4.0 * wave + 0.1 * np.sin(hours * 7.0)).round(3),
        },
        index=index,
    )
