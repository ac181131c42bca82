"""Descriptions that several tests use."""

from __future__ import annotations

from typing import Any

from mascarin.building import Building
from mascarin.building.reading import parse

# One closed room: small, and free of anything that the tests do not look at.
ROOM = """\
name: room
site: {latitude: 48, longitude: 2, altitude: 100, timezone: Europe/Paris}
materials:
  concrete: {conductivity: 1.75, density: 2240, specific_heat: 900, source: a table}
constructions:
  wall:
    layers:
      - {material: concrete, thickness: 0.2}
zones:
  room: {volume: 30, infiltration: 0.5}
surfaces:
  south:
    construction: wall
    area: 16
    tilt: 90
    azimuth: 180
    outside: {outdoors: true, convection: 15, emissivity: 0.9, absorptance: 0.6}
    inside: {zone: room, convection: 3, emissivity: 0.9}
  rest:
    construction: wall
    area: 50
    tilt: 90
    azimuth: 0
    outside: {adiabatic: true}
    inside: {zone: room, convection: 3, emissivity: 0.9}
sensors:
  core: {surface: south, depth: 0.1}
"""

# Every kind of part once; the kinds of sky follow below.
EVERYTHING = """\
name: everything
site:
  latitude: -21.3
  longitude: 55.5
  altitude: {value: 55, range: [40, 70], source: a map}
  timezone: UTC+4
  wind: {terrain: suburb}
  diffuse: hay_davies
materials:
  concrete: {conductivity: 1.75, density: 2240, specific_heat: 900, source: a table}
  gap: {kind: resistance, resistance: 0.15}
  wax:
    kind: pcm
    conductivity: [0.22, 0.18]
    density: 855
    specific_heat: {solid: 3134, liquid: 2833}
    latent_heat: 71000
    melting_temperature: 23.4
    law: {kind: tanh, gamma: 0.04, delta_t: 0.01}
  salt:
    kind: pcm
    conductivity: 0.5
    density: [1500, 1450]
    specific_heat: 2000
    latent_heat: 150000
    melting_temperature: 27
    law: {kind: tanh, width: 1.5}
  curve:
    kind: pcm
    conductivity: 0.2
    density: 800
    specific_heat: 2000
    law:
      kind: table
      temperatures: [15, 20, 22, 23]
      enthalpies: [0, 2.0e+4, 9.0e+4, 1.2e+5]
      melting_range: [20, 22]
constructions:
  wall:
    layers:
      - {material: concrete, thickness: 0.1, nodes: 5}
      - {material: gap}
      - {name: lining, material: concrete, thickness: 0.02}
  ceiling:
    layers:
      - {material: wax, thickness: 0.00526}
      - {material: salt, thickness: 0.01}
      - {material: curve, thickness: 0.01}
schedules:
  day: {kind: fraction, days: {all: [{at: "00:00", value: 0.1, ramp_to: 0.4}, {at: "08:00", value: 1},
                                     {at: "18:00", value: 0.3}]}}
  always: {kind: fraction, value: 0.9}
  cool: {kind: temperature, days: {weekdays: [{at: "00:00", value: 27}], weekends: [{at: "00:00", value: 29},
         {at: "12:00", value: 29, ramp_to: 28}], holidays: [{at: "00:00", value: 30}]}, holidays: ["12-25"]}
  warm: {kind: temperature, value: 15}
glazings:
  clear:
    kind: panes
    panes:
      - thickness: 0.004
        emissivity: 0.84
        transmittance: 0.83
        reflectance: 0.08
        density: 2500
        specific_heat: 750
      - {thickness: 0.004, emissivity: 0.84, transmittance: 0.83, reflectance: 0.08}
      - {thickness: 0.004, emissivity: [0.1, 0.84], transmittance: 0.6, reflectance: [0.2, 0.25]}
    gaps: [{thickness: 0.06, gas: argon}, {conductance: 5}]
  listed:
    kind: panes
    panes: [{thickness: 0.006, emissivity: 0.84}]
    angular:
      angles: [0, 60, 90]
      transmittance: [0.8, 0.7, 0]
      reflectance: [0.1, 0.2, 1]
      absorptance: [[0.1, 0.1, 0]]
      diffuse: {transmittance: 0.7, reflectance: 0.2, absorptance: [0.1]}
  plain: {kind: simple, u_value: 2.1, solar_heat_gain: 0.7}
windows:
  pane:
    surface: west
    glazing: clear
    area: 1
    cavity_height: 0.3
    frame: {fraction: 0.2, u_value: 2}
    outside: {convection: 15, sky_view: 0.4, ground_view: 0.45, height: 1.5,
              longwave: {kind: linearised, reference: 20}}
    inside: {convection: 3}
  light:
    surface: roof
    glazing: listed
    vertices: [[1, 1, 3.166666667], [2, 1, 3.166666667], [2, 2, 3.333333333], [1, 2, 3.333333333]]
    outside: {convection: {kind: mowitt}}
    inside: {convection: iso15099}
  hatch: {surface: roof, glazing: plain, area: 1, outside: {convection: 15}, inside: {convection: 3}}
shades:
  hood: {vertices: [[0, 0, 4], [3, 0, 4], [3, -1, 4], [0, -1, 4]]}
zones:
  room:
    volume: 27
    sun: area
    capacity_factor: 2
    infiltration: {constant: 0.2, temperature: 0.01, wind: 0.02}
    longwave: radiosity
    gains:
      people: {power: 100, activity: 110, radiative: 0.5, schedule: day}
      lamp: {power: 20}
    ventilation:
      fan: {air_changes: 1.5, schedule: day}
      shaft: {flow: 0.002}
    heating: {setpoint: 24, capacity: 40, schedule: always}
    cooling: {setpoint: {schedule: cool}, capacity: 60}
  attic:
    volume: 9
    infiltration: {value: 0.3, range: [0, 1]}
    longwave: {kind: linearised, reference: 25}
    sun: {kind: shares, shares: {ceiling: 0.95}, lost: 0.05}
    view_factors:
      roof: {ceiling: 1.0}
      ceiling: {roof: 0.8, light: 0.1, hatch: 0.1}
      light: {ceiling: 1.0}
      hatch: {ceiling: 1.0}
  shaft: {volume: 4, longwave: none, heating: {setpoint: {schedule: warm}}}
air_paths:
  hatch: {between: [room, attic], flow: 0.01, schedule: always}
openings:
  ridge: {zone: attic, area: 0.02, height: 0.3}
  eaves: {zone: attic, area: 0.01, height: 0.4, discharge: 0.6, wind_coefficient: 0.25, schedule: day}
surfaces:
  roof:
    construction: wall
    vertices: [[0, 0, 3], [3, 0, 3], [3, 3, 3.5], [0, 3, 3.5]]
    outside: {outdoors: true, convection: tarp, emissivity: 0.9, absorptance: 0.8, area_factor: 1.1}
    inside: {zone: attic, convection: {kind: alamdari_hammond}, emissivity: 0.25}
  ceiling:
    construction: ceiling
    area: 9
    tilt: 0
    outside: {zone: attic, convection: {kind: guichard2016_eq5, factor: 0.8}, emissivity: 0.05}
    inside:
      zone: room
      emissivity: 0.9
      absorptance: 0.5
      convection:
        kind: power
        upward: {a: 0.1, b: 1.5, n: 0.33}
        downward: {b: 0.6, n: 0.25}
  floor:
    construction: wall
    area: 9
    tilt: 180
    outside: {ground: {mean: 22, amplitude: 2, coldest_day: 200}}
    inside:
      zone: room
      convection: {kind: linear_wind, constant: 3, wind: 0}
      emissivity: 0.9
      absorptance: 0.6
  west:
    construction: wall
    area: 9
    tilt: 90
    azimuth: 270
    outside:
      outdoors: true
      convection: {kind: mowitt}
      emissivity: 0.9
      absorptance: 0.4
      sky_view: 0.4
      ground_view: 0.45
      height: 1.5
      longwave: {kind: linearised, reference: 24}
    inside: {zone: room, convection: 2.5, emissivity: 0.9, absorptance: 0.5}
  east:
    construction: wall
    area: 9
    tilt: 90
    azimuth: 90
    outside:
      outdoors: true
      convection: {kind: linear_wind, constant: 11.4, wind: 5.7}
      emissivity: 0.9
      absorptance: 0.4
      longwave: none
    inside: {zone: room, convection: 2.5, emissivity: 0.9, absorptance: 0.5}
  north:
    construction: wall
    area: 9
    tilt: 90
    azimuth: 0
    outside: {measured: T_out, convection: 12, irradiance: G_north, absorptance: 0.4}
    inside: {zone: shaft, convection: 2.5}
  mass:
    construction: wall
    area: 4
    tilt: 90
    azimuth: 0
    internal_mass: true
    outside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.5}
    inside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.5}
  south:
    construction: wall
    area: 9
    tilt: 90
    azimuth: 180
    outside: {outdoors: true, convection: doe2, emissivity: 0.9, absorptance: 0.4}
    inside: {zone: shaft, convection: 2.5}
  held: {construction: wall, area: 1, tilt: 90, outside: {measured: T_face}, inside: {adiabatic: true}}
sensors:
  core: {surface: west, depth: 0.05}
"""

SKIES = [
    {"kind": "martin_berdahl"},
    {"kind": "clark_allen"},
    {"formula": "0.6 + a*pw^0.5", "a": 0.002, "source": "a paper of 2020"},
    {"kind": "brunt"},
    {"kind": "offset", "depression": 9},
    {"kind": "measured"},
]


def room() -> Building:
    """The closed room."""
    return parse(ROOM, "room.yaml")


#: Laws for the materials wax, salt and curve of `EVERYTHING`, beside those that stand there.
MELTING = [
    ("{kind: smooth_step, width: 1.2}", "{kind: gaussian, width: 0.8}", "capacity"),
    ("{kind: gumbel, width: 0.6}", "{kind: linear, width: 1.0}", "fractions"),
    (
        "{kind: triangle, below: 2.0, above: 1.0}\n    hysteresis: {model: curve-switch, "
        "freezing_temperature: 22.3, law: {kind: smooth_step, width: 1.0, continuity: 2}}",
        "{kind: gumbel, width: 0.5, tail: high}",
        "two curves",
    ),
    (
        "{kind: smooth_step, width: 0.7}\n    hysteresis: "
        "{model: supercooling, degree: 4, time_constant: 300}",
        "{kind: linear, width: 0.6}\n    hysteresis: {model: supercooling, degree: 6, rate: 1e-4}",
        "fractions",
    ),
    (
        '{formula: "1/(1 + exp(-(T - Tm)/w))", w: {value: 1, unit: K}, range: [-8, 8]}',
        "{kind: linear, width: 1.0}",
        "fractions",
    ),
]
_CURVES = {
    "capacity": """{kind: capacity, temperatures: [15, 20, 21, 22, 23],
      capacities: [2000, 2500, 60000, 2500, 2000], melting_range: [20, 22]}
    latent_heat: 60000""",
    "fractions": """{kind: fractions, temperatures: [19, 21, 22], fractions: [0, 0.6, 1]}
    latent_heat: 60000""",
    "two curves": """{kind: fractions, temperatures: [23, 24.5, 25.2], fractions: [0, 0.6, 1]}
    latent_heat: 60000
    hysteresis:
      model: curve_switch
      law: {kind: fractions, temperatures: [22.7, 24.3, 25], fractions: [0, 0.6, 1]}""",
}


def everything_melting(wax: str, salt: str, curve: str) -> Building:
    """`EVERYTHING` with other laws of phase change."""
    text = EVERYTHING.replace("{kind: tanh, gamma: 0.04, delta_t: 0.01}", wax)
    text = text.replace("{kind: tanh, width: 1.5}", salt)
    start, end = text.index("\n      kind: table"), text.index("\nconstructions:")
    return parse(text[:start] + " " + _CURVES[curve] + text[end:], "everything.yaml")


#: What has no value in `EVERYTHING`, by path.
OPTIONAL = {
    "site.air_density": 1.16,
    "site.air_specific_heat": 1012,
    "site.sky_exponent": {"value": 1.4, "source": "between an isotropic sky and Walton 1983"},
    "site.sky_diurnal": {"value": -12, "source": "a pyrgeometer beside the model"},
    "glazings.plain.transmittance": 0.6,
    "glazings.listed.angular.back": {"transmittance": 0.7, "reflectance": 0.15, "absorptance": [0.15]},
    "surfaces.north.outside.convection": {"kind": "measured", "column": "h_north"},
    "surfaces.west.inside.convection": {"formula": "c*abs(dT)^n", "c": 1.31, "n": 0.33},
    "zones.attic.infiltration": {"formula": "c*(1 + V)", "c": 0.05},
    "materials.concrete": {
        "conductivity": {"formula": "1.7 + a*T", "a": 0.002}, "density": 2300, "specific_heat": 900,
    },
    "derived_outputs": {"swing": {"formula": "k*room.air_temperature", "k": 2}},
    "weather": {"clock": 60, "columns": {"wind_speed": {"gain": 0.9, "offset": 0.1, "clock": 30}}},
    "zones.attic.sun": {
        "kind": "shares", "shares": {"ceiling": 0.95}, "lost": 0.05,
        "diffuse": {"shares": {"ceiling": 0.9}, "lost": 0.1},
    },
    "zones.room.sun": {
        "kind": "shares", "shares": {"west": 0.7}, "masses": {"mass": {"outside": 0.2, "inside": 0.1}},
        "diffuse": {"shares": {"west": 0.4}, "masses": {"mass": {"outside": 0.3, "inside": 0.3}}},
    },
}  # fmt: skip


#: Densities of flows, air that moves in zones, heat given to surfaces, reveals and overhangs, by path.
FREEDOM: dict[str, Any] = {
    "zones.room.infiltration.density": 1.2,
    "zones.room.ventilation.fan.density": "outdoors",
    "zones.attic.infiltration": {"constant": 0.3, "density": "zone"},
    "air_paths.hatch.density": "zone",
    "zones.room.mixing_air_change": {"air_changes": 10, "schedule": "day"},
    "zones.attic.mixing_air_change": {"column": "T_out", "factor": 0.5},
    "zones.room.air_gradient": {"gradient": 1.5, "schedule": "day"},
    "zones.attic.air_gradient": {"column": "T_out", "factor": 0.05},
    "surfaces.floor.outside": {"heat_flux": {"flux": 5, "schedule": "day"}},
    "surfaces.south.outside": {"heat_flux": {"column": "T_out", "factor": 0.5}},
    "surfaces.west.inside.convection": "beausoleil_morrison",
    "windows.pane.reveal": 0.1,
    "windows.pane.overhang": {"depth": 0.5, "gap": 0.1, "extension": 0.2},
    "windows.light.reveal": 0.05,
}


#: Heat sources between layers, by path.
HEAT_SOURCES: dict[str, Any] = {
    "heat_sources": {
        "foil": {
            "surface": "ceiling",
            "after": "wax",
            "electric": {"power": 15, "schedule": "day"},
            "thermostat": {"zone": "room", "setpoint": 24, "range": 8, "mode": "heating"},
        },
        "plate": {"surface": "ceiling", "after": "wax", "electric": {"column": "T_out", "factor": 0.2}},
        "pipes": {
            "surface": "ceiling",
            "after": "salt",
            "water": {"flow": {"flow": 0.005, "schedule": "day"}, "supply": 18, "conductance": 9},
            "thermostat": {"zone": "attic", "setpoint": {"schedule": "cool"}, "range": 12, "mode": "cooling"},
        },
        "tubes": {
            "surface": "ceiling",
            "after": "salt",
            "water": {
                "flow": {"column": "T_out", "unit": "kg/h", "factor": 0.3},
                "supply": {"column": "T_out"},
                "effectiveness": 0.7,
            },
        },
    }
}


#: A floor on a block of soil, by path.
SOIL: dict[str, Any] = {
    "soil_blocks": {
        "below": {
            "length": 3,
            "width": 2,
            "wall_thickness": 0.3,
            "basement_depth": 0.3,
            "conductivity": 1.5,
            "heat_capacity": 2.5e6,
            "inside_film": 4,
            "outdoor_film": 20,
            "absorptance": 0.7,
            "emissivity": 0.92,
            "far": 5,
            "depth": 5,
            "deep_temperature": 14,
            "edge": {"position": "vertical", "extent": 0.8, "thickness": 0.08, "conductivity": 0.04},
            "before": {"mean": 15, "amplitude": 8, "coldest_day": 20},
        }
    },
    "surfaces.floor.outside": {"soil": "below"},
}

#: What a house has beside that: in zones by path, and other sections.
IN_ZONES: dict[tuple[str, str], dict[str, Any]] = {
    ("room", "gains"): {"heater": {"column": "T_out", "radiative": 0.3}},
    ("room", "infiltration"): {"blower_door": {"kind": "factor", "n50": 2}},
    ("attic", "infiltration"): {"blower_door": {"kind": "stack_wind", "n50": 2}},
    ("room", "thermal_bridges"): {
        "edge": {"psi": 0.05, "length": 10, "dimensions": "any"},
        "post": {"chi": 0.1, "zone": "attic"},
        "soil": {"psi": 0.1, "length": 4, "ground": {"mean": 10, "amplitude": 3}},
        "yard": {"chi": 0.2, "measured": ["T_out"]},
    },
}


def _band(opens: float, closes: float, half: float) -> dict[str, Any]:
    """Limits of a control with ranges."""
    both = {"open": opens, "close": closes}
    return {key: {"value": value, "range": [value - half, value + half]} for key, value in both.items()}


SECTIONS: dict[str, dict[str, Any]] = {
    "schedules": {
        "dry_air": {"kind": "humidity_ratio", "value": 0.0112},
        "dry_by_day": {
            "kind": "humidity_ratio",
            "days": {
                "all": [{"at": "00:00", "value": 0.012, "ramp_to": 0.011}, {"at": "12:00", "value": 0.011}]
            },
        },
    },
    "air_paths": {
        "door": {"between": ["room", "attic"], "door": {"width": 0.9, "height": 2}, "control": "warmer"},
        "overflow": {"between": ["room", "attic"], "column": "T_out", "one_way": True},
    },
    "ventilation_units": {
        "unit": {
            "supply": {"room": 0.01, "attic": {"column": "T_out", "unit": "m3/h"}},
            "exhaust": {"attic": {"flow": 0.01, "schedule": "always"}},
            "recovery": 0.7,
        },
        "heater": {"supply": {"room": 0.001}, "temperature": 30},
    },
    "vents": {
        "casement": {
            "zone": "room",
            "surface": "west",
            "area": 0.03,
            "height": 0.8,
            "elevation": 1.5,
            "pressure": {"kind": "low_rise", "side_ratio": 1.4, "shelter": 0.7, "height": 2.5},
            "schedule": "day",
            "control": "warmth",
        },
        "flap": {
            "between": ["room", "attic"],
            "area": 0.01,
            "elevation": 2.6,
            "exponent": {"value": 0.6, "range": [0.5, 0.7]},
            "control": "coolness",
        },
        "cowl": {
            "zone": "attic",
            "azimuth": 20,
            "area": 0.01,
            "elevation": 3.4,
            "pressure": {"kind": "table", "coefficients": [-0.3, -0.6, -0.8, -0.6], "height": 4},
            "control": "calm",
        },
        "grille": {
            "zone": "shaft",
            "area": 0.01,
            "height": 0.3,
            "elevation": 2,
            "pressure": "none",
            "control": "mild",
        },
    },
    "controls": {
        "warmth": {"zone": "room", "indoor": _band(24.2, 23.8, 0.3)},
        "coolness": {
            "zone": "attic",
            "difference": _band(0.2, -0.1, 0.08),
            "minimum_open_time": {"value": 20, "range": [0, 600]},
        },
        "warmer": {"zone": "attic", "reference_zone": "room", "difference": _band(0.003, -0.003, 0.004)},
        "mild": {"zone": "room", "outdoor": _band(22, 21, 2)},
        "calm": {
            "zone": "attic",
            "wind": _band(3.5, 4.2, 0.6),
            "minimum_open_time": {"value": 30, "range": [10, 60]},
            "minimum_closed_time": {"value": 40, "range": [0, 600]},
        },
        "cold": {
            "zone": "attic",
            "indoor_below": {"open": 24, "close": 26},
            "outdoor_below": {"open": 18, "close": 20},
        },
        "dry": {"zone": "attic", "rain": {"column": "T_out", **_band(25, 26, 0.9)}},
    },
    "humidity": {
        "initial": 0.55,
        "period": 24,
        "deep_period": 504,
        "materials": {
            "concrete": {"like": "concrete", "factor": 1.1, "vapour_resistance": 7},
            "wax": {"capacity": 12, "vapour_resistance": 8, "depth": 0.001, "deep_depth": 0.002},
            "curve": {
                "humidities": [0, 0.5, 0.9],
                "contents": [0, 4, 11],
                "factor": 0.9,
                "vapour_resistance": 10,
                "depth": 0.001,
                "deep_depth": 0.002,
            },
        },
        "zones": {
            "room": {
                "storage": 3,
                "gains": {
                    "people": {"power": 8, "activity": 130, "schedule": "day"},
                    "shower": {"rate": 1e-7},
                    "plants": {
                        "column": "T_out",
                        "unit": "g/h",
                        "factor": {"value": 1e-7, "range": [0, 2e-7]},
                    },
                },
                "drying": {"sensible_heat_ratio": 0.75, "coil_temperature": 16},
                "humidifying": {"relative_humidity": 0.62, "capacity": 10},
            },
            "attic": {"drying": {"humidity_ratio": 0.0112, "capacity": 3000}},
        },
        "surfaces": {"ceiling": {"paint": 0.4}},
        "recovery": {"unit": 0.5},
    },
}


#: Blinds, by window, and a measured irradiance.
BLINDS: dict[str, dict[str, Any]] = {
    "light": {
        "position": "outside",
        "transmittance": 0.1,
        "reflectance": 0.5,
        "resistance": 0.15,
        "cover": 0.9,
        "schedule": "day",
        "radiation": 250,
    },
    "hatch": {
        "position": "inside",
        "transmittance": 0.2,
        "reflectance": 0.6,
        "shutter_resistance": 0.1,
        "air_permeability": "high",
    },
}


def house() -> Building:
    """Fans, doors, thermal bridges, pressure tests, measured powers, blinds, radiant loads and humidity."""
    plain: dict[str, Any] = parse(EVERYTHING, "everything.yaml").to_dict()
    for (zone, key), part in IN_ZONES.items():
        given: Any = plain["zones"][zone].get(key, {})
        plain["zones"][zone][key] = (given if isinstance(given, dict) and "value" not in given else {}) | part
    for zone, makeup in (("room", "outdoors"), ("attic", "vents")):
        plain["zones"][zone] |= {"makeup_air": makeup}
    plain["zones"]["room"] |= {"solar_to_air": 0.1, "setpoint_radiant_share": 0.3}
    for plant in ("heating", "cooling"):
        plain["zones"]["room"][plant] |= {"radiative": 0.2}
    for window, blind in BLINDS.items():
        plain["windows"][window] |= {"blind": blind}
    plain["windows"]["pane"]["outside"] |= {"irradiance": "G_west"}
    plain["site"] |= {"horizon": [[60, 4], [200, 20]]}
    plain["openings"]["ridge"] |= {"control": "dry"}
    for section, parts in SECTIONS.items():
        plain[section] = plain.get(section, {}) | parts
    return Building.from_dict(plain)


def everything() -> list[Building]:
    """Every kind of part: once for each sky, with what has no default, with each law of phase change."""
    building = parse(EVERYTHING, "everything.yaml")
    skies = [building.replace({"site.sky": sky}) for sky in SKIES]
    melting = [everything_melting(*laws) for laws in MELTING]
    depths = {
        "humidity.materials.concrete": {"like": "concrete", "depth": 0.002, "deep_depth": 0.004},
        "humidity.materials.wax": {"capacity": 3000, "vapour_resistance": 8},
    }
    freedom = building.replace(FREEDOM)
    soil = {"kind": "soil", "mean": 12, "amplitude": 8, "depth": 1.5, "coldest_day": 40}
    mats = [
        {"kind": "water_mat", "indoor": 12, "steepness": 0.05, "limit": 60, "coefficient": 0.5},
        {"kind": "heating_mat", "power": 100, "limit": 60, "span": 100},
    ]
    imposed = [building.replace({"surfaces.floor.outside": {"imposed": law}}) for law in [soil, *mats]]
    edge = {"psi": 0.1, "length": 5, "excess": {"west": 0.5}}
    converted = building.replace(
        {
            "dimensions": {"areas": "external", "bridges": "internal"},
            "zones.room.thermal_bridges": {"edge": edge},
        }
    )
    further = [freedom, *imposed, converted, building.replace(HEAT_SOURCES), building.replace(SOIL)]
    return [*skies, building.replace(OPTIONAL), house(), house().replace(depths), *further, *melting]
