"""Effect of each kind of object that is not carried over: a room in EnergyPlus with it, and without it.

    python bench/energyplus_effects.py --energyplus "COMMAND" [NAME ...]

COMMAND runs EnergyPlus 25.2 with three arguments: model (epJSON), weather file, and a folder, where it leaves
``eplusout.csv``. Writes ``effects.csv`` in ``mascarin.energyplus.model``, which the list of findings reads:
rms of the hourly air temperature over a year [K], and the change of heating and cooling together [%] in the
room with ideal loads. Each is measured in two rooms:

- the room of ``tests/idf_small``: 5 x 5 x 3 m, heavy, window to the south, Chicago;
- another: 8 x 6 x 2.7 m, light, turned by 60 degrees, two clear panes, half the heat for its floor, Golden.
"""

from __future__ import annotations

import argparse
import csv
import json
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import idfkit
import numpy as np
import pandas as pd
from energyplus_small import AIR, DATA, SMALL

TABLE = SMALL.parent.parent / "python" / "mascarin" / "energyplus" / "model" / "effects.csv"
#: Loads with those of the outdoor air that the system brings.
LOADS = tuple(
    f"Zone Ideal Loads Supply Air Sensible {which} Energy [J](Hourly)" for which in ("Heating", "Cooling")
)
WEATHER = {
    "small": DATA / "weather" / "USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw",
    "other": DATA / "weather" / "USA_CO_Golden-NREL.724666_TMY3.epw",
}

Model = dict[str, dict[str, dict[str, Any]]]
Change = Callable[[Model], None]


@dataclass(frozen=True)
class Case:
    """A kind of object.

    Attributes
    ----------
    kind : str
        Beginning of its class.
    what : str
        What the list says of it, with stars.
    added : callable
        Adds it to a model.
    both : callable, optional
        Adds to both models what the object acts on.
    without : callable, optional
        Makes the other model what the conversion carries over in its place.
    example : str
        What the list says, where another object stands for the kind; else the list of the model says it.
    """

    kind: str
    what: str
    added: Change
    both: Change | None = None
    without: Change | None = None
    example: str = ""


def put(model: Model, kind: str, **objects: dict[str, Any]) -> None:
    """Add objects of a class; names have blanks for double underscores."""
    model.setdefault(kind, {}).update({name.replace("__", " "): fields for name, fields in objects.items()})


def puts(kind: str, **fields: Any) -> Change:
    """A change that adds one object."""
    return lambda model: put(model, kind, added=dict(fields))


def sets(kind: str, **fields: Any) -> Change:
    """A change of fields of all objects of a class."""

    def change(model: Model) -> None:
        for item in model[kind].values():
            item.update(fields)

    return change


def together(*changes: Change) -> Change:
    """Several changes."""

    def change(model: Model) -> None:
        for part in changes:
            part(model)

    return change


def constant(name: str, value: float) -> Change:
    """A constant schedule."""
    return lambda model: put(
        model, "Schedule:Constant", **{name: {"schedule_type_limits_name": "any", "hourly_value": value}}
    )


def working_day(name: str) -> Change:
    """A schedule of 1 from 8 to 18 h."""
    times = ["Through: 12/31", "For: AllDays", "Until: 8:00", 0, "Until: 18:00", 1, "Until: 24:00", 0]
    return lambda model: put(
        model, "Schedule:Compact",
        **{name: {"schedule_type_limits_name": "any", "data": [{"field": text} for text in times]}},
    )  # fmt: skip


def panes(model: Model, gap: str = "air") -> None:
    """A window of two clear panes."""
    glass = {
        "optical_data_type": "SpectralAverage", "thickness": 0.003, "conductivity": 0.9,
        "solar_transmittance_at_normal_incidence": 0.84,
        "front_side_solar_reflectance_at_normal_incidence": 0.075,
        "back_side_solar_reflectance_at_normal_incidence": 0.075,
        "visible_transmittance_at_normal_incidence": 0.9,
        "front_side_visible_reflectance_at_normal_incidence": 0.08,
        "back_side_visible_reflectance_at_normal_incidence": 0.08,
        "infrared_transmittance_at_normal_incidence": 0.0,
        "front_side_infrared_hemispherical_emissivity": 0.84,
        "back_side_infrared_hemispherical_emissivity": 0.84,
    }  # fmt: skip
    model.pop("WindowMaterial:SimpleGlazingSystem", None)
    put(model, "WindowMaterial:Glazing", glass=glass)
    put(model, "WindowMaterial:Gas", air={"gas_type": "Air", "thickness": 0.013})
    model["Construction"]["glazing"] = {"outside_layer": "glass", "layer_2": gap, "layer_3": "glass"}


def _other_room(model: Model) -> None:
    for kind in ("BuildingSurface:Detailed", "FenestrationSurface:Detailed"):
        for item in model[kind].values():
            corners = item.get("vertices") or [item]
            for corner in corners:
                for key in corner:
                    if "coordinate" in key:
                        axis = next(axis for axis in "xyz" if f"_{axis}_" in key)
                        corner[key] *= {"x": 1.6, "y": 1.2, "z": 0.9}[axis]
    sets("Building", north_axis=60.0)(model)
    model["Material"]["concrete"]["thickness"] = 0.06
    sets("ElectricEquipment", design_level=480.0)(model)
    panes(model)
    model["Site:Location"] = {
        "Golden": {"latitude": 39.74, "longitude": -105.18, "time_zone": -7.0, "elevation": 1829.0}
    }


def base(room: str, name: str) -> Model:
    """A room: free floating (``base``), or with ideal loads (``base_ideal``)."""
    document = idfkit.load_idf(str(SMALL / f"{name}.idf"))
    model: Model = json.loads(idfkit.write_epjson(document, None))
    model["Output:Variable"] = {
        f"o{k}": {"key_value": "*", "variable_name": title, "reporting_frequency": "Hourly"}
        for k, title in enumerate(text.partition(" [")[0] for text in (AIR, *LOADS))
    }
    if room == "other":
        _other_room(model)
    return model


def run(model: Model, room: str, command: str) -> pd.DataFrame:
    """Hourly results of EnergyPlus."""
    return _run(json.dumps(model), room, command)


@cache
def _run(text: str, room: str, command: str) -> pd.DataFrame:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "model.epJSON"
        file.write_text(text, encoding="utf-8")
        arguments = [*shlex.split(command), str(file), str(WEATHER[room]), folder]
        subprocess.run(arguments, check=False, capture_output=True)  # noqa: S603 - the command of the user
        table = Path(folder) / "eplusout.csv"
        if not table.is_file():
            errors = (Path(folder) / "eplusout.err").read_text(encoding="latin-1")
            severe = [line for line in errors.splitlines() if "Severe" in line or "Fatal" in line]
            raise ValueError("; ".join(severe[:6]) or errors[-400:])
        held = pd.read_csv(table)
    return held.rename(columns={name: name.strip().partition(":")[2] for name in held.columns})


def of_file(name: str) -> Change:
    """What a model of ``tests/idf_small`` has more than ``base``: objects and fields."""

    def change(model: Model) -> None:
        plain, other = (
            json.loads(idfkit.write_epjson(idfkit.load_idf(str(SMALL / f"{file}.idf")), None))
            for file in ("base", name)
        )
        for kind, items in other.items():
            if kind == "Output:Variable":
                continue
            for key, fields in items.items():
                before = plain.get(kind, {}).get(key, {})
                more = {field: value for field, value in fields.items() if before.get(field) != value}
                if more:
                    model.setdefault(kind, {}).setdefault(key, {}).update(more)

    return change


def measured(case: Case, room: str, command: str) -> tuple[float, float]:
    """Rms of the air temperature without loads [K], and change of the loads [%]."""
    effects = []
    for name in ("base", "base_ideal"):
        pair = []
        for change in (case.added, case.without):
            model = deepcopy(base(room, name))
            for part in (case.both, change):
                if part is not None:
                    part(model)
            pair.append(run(model, room, command))
        if name == "base":
            miss = pair[0][AIR].to_numpy() - pair[1][AIR].to_numpy()
            effects.append(float(np.sqrt(np.mean(miss[~np.isnan(miss)] ** 2))))
        else:
            loads = [float(np.nansum(held[title].to_numpy())) for title in LOADS for held in pair]
            change_of_loads = abs(loads[0] - loads[1]) + abs(loads[2] - loads[3])
            effects.append(100.0 * change_of_loads / (loads[1] + loads[3]))
    return effects[0], effects[1]


# ------------------------------------------------------------------ the kinds


def _lamps(**more: Any) -> Change:
    fields = {
        "zone_or_zonelist_or_space_or_spacelist_name": "room", "schedule_name": "day",
        "design_level_calculation_method": "LightingLevel", "lighting_level": 250.0,
    }  # fmt: skip
    return together(working_day("day"), puts("Lights", **fields, **more))


def _without_window(model: Model) -> None:
    model.pop("FenestrationSurface:Detailed")


def _front(transmittance: float) -> Change:
    corners = [(-1, -3, 4), (-1, -3, 0), (9, -3, 0), (9, -3, 4)]
    return together(
        constant("through", transmittance),
        puts(
            "Shading:Building:Detailed",
            transmittance_schedule_name="through",
            vertices=[
                {f"vertex_{axis}_coordinate": float(value) for axis, value in zip("xyz", corner, strict=True)}
                for corner in corners
            ],
        ),
    )


def _frame(**fields: Any) -> Change:
    def change(model: Model) -> None:
        put(model, "WindowProperty:FrameAndDivider", edge=dict(fields))
        sets("FenestrationSurface:Detailed", frame_and_divider_name="edge")(model)

    return change


def _shaded(control: str, **fields: Any) -> Change:
    shade = {
        "solar_transmittance": 0.1, "solar_reflectance": 0.6, "visible_transmittance": 0.1,
        "visible_reflectance": 0.6, "infrared_hemispherical_emissivity": 0.9, "infrared_transmittance": 0.0,
        "thickness": 0.003, "conductivity": 0.1, "shade_to_glass_distance": 0.05,
    }  # fmt: skip

    def change(model: Model) -> None:
        put(model, "WindowMaterial:Shade", cloth=shade)
        put(model, "WindowShadingControl", shades={
            "zone_name": "room", "shading_type": "ExteriorShade", "shading_control_type": control,
            "shading_device_material_name": "cloth",
            "fenestration_surfaces": [{"fenestration_surface_name": "room win"}], **fields,
        })  # fmt: skip

    return change


def _roof_plants(model: Model) -> None:
    put(model, "Material:RoofVegetation", plants={})
    layers = list(model["Construction"]["wall"].values())
    model["Construction"]["green"] = dict(
        zip(("outside_layer", "layer_2", "layer_3", "layer_4"), ["plants", *layers], strict=True)
    )
    model["BuildingSurface:Detailed"]["room R"]["construction_name"] = "green"


def _moisture(model: Model) -> None:
    # Gypsum board with the depths of EnergyPlus itself.
    put(model, "MaterialProperty:MoisturePenetrationDepth:Settings", board={
        "water_vapor_diffusion_resistance_factor": 6.0, "moisture_equation_coefficient_a": 0.0068,
        "moisture_equation_coefficient_b": 0.939, "moisture_equation_coefficient_c": 0.0202,
        "moisture_equation_coefficient_d": 12.2, "coating_layer_thickness": 0.0,
        "coating_layer_water_vapor_diffusion_resistance_factor": 0.0,
    })  # fmt: skip
    put(model, "SurfaceProperty:HeatTransferAlgorithm:Construction", vapour={
        "construction_name": "wall",
        "algorithm": "MoisturePenetrationDepthConductionTransferFunction",
    })  # fmt: skip


def _months(values: Iterable[float], ending: str) -> dict[str, float]:
    names = pd.date_range("2001-01-01", periods=12, freq="MS").strftime("%B").str.lower()
    return {f"{name}_{ending}": value for name, value in zip(names, values, strict=True)}


def _daylight(model: Model) -> None:
    put(model, "Daylighting:ReferencePoint", eye={
        "zone_or_space_name": "room", "x_coordinate_of_reference_point": 2.5,
        "y_coordinate_of_reference_point": 1.5, "z_coordinate_of_reference_point": 0.8,
    })  # fmt: skip
    put(model, "Daylighting:Controls", dimming={
        "zone_or_space_name": "room", "lighting_control_type": "Continuous",
        "minimum_input_power_fraction_for_continuous_or_continuousoff_dimming_control": 0.1,
        "minimum_light_output_fraction_for_continuous_or_continuousoff_dimming_control": 0.1,
        "control_data": [{"daylighting_reference_point_name": "eye",
                          "fraction_of_lights_controlled_by_reference_point": 1.0,
                          "illuminance_setpoint_at_reference_point": 500.0}],
    })  # fmt: skip


def _latent(share: float, **more: float) -> Change:
    return lambda model: put(model, "ElectricEquipment", kettle={
        "zone_or_zonelist_or_space_or_spacelist_name": "room", "schedule_name": "on",
        "design_level_calculation_method": "EquipmentLevel", "design_level": 200.0,
        "fraction_latent": share, **more,
    })  # fmt: skip


def _thermostat(kind: str, **fields: Any) -> Change:
    def change(model: Model) -> None:
        if "ZoneControl:Thermostat" in model:
            put(model, kind, control=dict(fields))

    return change


def _outdoor_air(**fields: Any) -> Change:
    """Outdoor air of the ideal loads: 2 per hour; a room without loads has none."""

    def change(model: Model) -> None:
        if IDEAL in model:
            put(model, "DesignSpecification:OutdoorAir", fresh={
                "outdoor_air_method": "AirChanges/Hour", "outdoor_air_flow_air_changes_per_hour": 2.0,
            })  # fmt: skip
            sets(IDEAL, design_specification_outdoor_air_object_name="fresh", **fields)(model)

    return change


def _dehumidified(model: Model) -> None:
    if IDEAL in model:
        put(model, "ZoneControl:Humidistat", dry={
            "zone_name": "room", "humidifying_relative_humidity_setpoint_schedule_name": "h30",
            "dehumidifying_relative_humidity_setpoint_schedule_name": "h50",
        })  # fmt: skip
        sets(IDEAL, dehumidification_control_type="Humidistat", humidification_control_type="Humidistat")(
            model
        )


IDEAL = "ZoneHVAC:IdealLoadsAirSystem"
CASES = {
    "incident_inside": Case("SurfaceProperty:SolarIncidentInside", "*", of_file("incident_inside")),
    "incident_multiplier": Case(
        "SurfaceProperty:IncidentSolarMultiplier", "*", of_file("incident_multiplier")
    ),
    "movable_insulation": Case("SurfaceControl:MovableInsulation", "*", of_file("movable_insulation")),
    "surrounding_surfaces": Case(
        "SurfaceProperty:SurroundingSurfaces", "*", of_file("surrounding_surfaces")
    ),
    "visible": Case(
        "Lights", "visible radiation",
        _lamps(fraction_radiant=0.4, fraction_visible=0.2), without=_lamps(fraction_radiant=0.6),
    ),
    "latent": Case("", "*latent heat", _latent(0.3), without=_latent(0.0, fraction_lost=0.3)),
    "daylight": Case("Daylighting:", "*", _daylight, both=_lamps()),
    "summer_time": Case(
        "RunPeriod", "use weather file daylight*",
        puts("RunPeriodControl:DaylightSavingTime", start_date="2nd Sunday in March",
             end_date="1st Sunday in November"),
        both=_lamps(),
        example="use weather file daylight saving period",
    ),
    "no_window": Case(
        "FenestrationSurface:Detailed", "*no counterpart*", lambda _: None, without=_without_window,
        example="a Construction:WindowEquivalentLayer, which has no counterpart here",
    ),
    "tree": Case("Shading:", "a transmittance*", _front(0.2), without=_front(0.0)),
    "reflections": Case(
        "Building", "reflections*", sets("Building", solar_distribution="FullExteriorWithReflections"),
        both=_front(0.0),
    ),
    "traced": Case(
        "Zone", "surfaces without corners",
        sets("Building", solar_distribution="FullInteriorAndExterior"),
        without=sets("Building", solar_distribution="FullExterior"),
        example="surfaces without corners",
    ),
    "dividers": Case(
        "FenestrationSurface:Detailed", "dividers",
        _frame(divider_type="Suspended", divider_width=0.04, number_of_horizontal_dividers=2,
               number_of_vertical_dividers=2, divider_conductance=3.0, divider_solar_absorptance=0.5,
               divider_thermal_hemispherical_emissivity=0.9),
        both=panes,
    ),
    "frame_edge": Case(
        "WindowProperty:FrameAndDivider", "ratio of frame edge*",
        _frame(frame_width=0.06, frame_conductance=3.0,
               ratio_of_frame_edge_glass_conductance_to_center_of_glass_conductance=1.3),
        without=_frame(frame_width=0.06, frame_conductance=3.0),
    ),
    "frame_projection": Case(
        "WindowProperty:FrameAndDivider", "frame * projection",
        _frame(frame_width=0.06, frame_conductance=3.0, frame_outside_projection=0.05,
               frame_inside_projection=0.05),
        without=_frame(frame_width=0.06, frame_conductance=3.0),
    ),
    "shading_temperature": Case(
        "WindowShadingControl", "*, on*", _shaded("OnIfHighZoneAirTemperature", setpoint=24.0)
    ),
    "green_roof": Case("Material:RoofVegetation", "*", _roof_plants),
    "moisture": Case("MaterialProperty:MoisturePenetrationDepth", "*", _moisture),
    "moisture_method": Case("HeatBalanceAlgorithm", "moisture in walls*", _moisture),
    "operative": Case(
        "ZoneControl:Thermostat:OperativeTemperature", "*",
        _thermostat("ZoneControl:Thermostat:OperativeTemperature", thermostat_name="room stat",
                    radiative_fraction_input_mode="Constant", fixed_radiative_fraction=0.5),
    ),
    "humidistat": Case(
        "ZoneControl:Humidistat", "*", _dehumidified,
        both=together(constant("h30", 30.0), constant("h50", 50.0)),
    ),
    "economizer": Case(
        IDEAL, "an economizer",
        _outdoor_air(outdoor_air_economizer_type="DifferentialDryBulb", cooling_limit="LimitFlowRate",
                     maximum_cooling_air_flow_rate=0.2),
        without=_outdoor_air(cooling_limit="LimitFlowRate", maximum_cooling_air_flow_rate=0.2),
        # Beside infiltration by wind it is not carried over.
        both=sets("ZoneInfiltration:DesignFlowRate", velocity_term_coefficient=0.01),
    ),
    "rain": Case("RunPeriod", "rain*", sets("RunPeriod", use_weather_file_rain_indicators="Yes")),
    "reflectance": Case(
        "Site:GroundReflectance", "a reflectance by month",
        puts("Site:GroundReflectance",
             **_months((0.5, 0.5, 0.4, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.4), "ground_reflectance")),
        without=puts("Site:GroundReflectance", **_months((0.283,) * 12, "ground_reflectance")),
    ),
    "adaptive_outside": Case(
        "", "outside convection by adaptive*",
        sets("SurfaceConvectionAlgorithm:Outside", algorithm="AdaptiveConvectionAlgorithm"),
        without=sets("SurfaceConvectionAlgorithm:Outside", algorithm="TARP"),
    ),
    "adaptive_inside": Case(
        "", "inside convection by adaptive*",
        sets("SurfaceConvectionAlgorithm:Inside", algorithm="AdaptiveConvectionAlgorithm"),
    ),
    "astm_inside": Case(
        "", "inside convection by astm*",
        sets("SurfaceConvectionAlgorithm:Inside", algorithm="ASTMC1340"),
    ),
    "ceiling_diffuser": Case(
        "", "inside convection by ceilingdiffuser*",
        sets("SurfaceConvectionAlgorithm:Inside", algorithm="CeilingDiffuser"),
    ),
    "mixture": Case(
        "WindowMaterial:GasMixture", "*",
        lambda model: panes(model, "mixed"), without=lambda model: panes(model, "argon"),
        both=together(
            lambda model: put(model, "WindowMaterial:GasMixture", mixed={
                "thickness": 0.013, "number_of_gases_in_mixture": 2, "gas_1_type": "Argon",
                "gas_1_fraction": 0.6, "gas_2_type": "Krypton", "gas_2_fraction": 0.4}),
            lambda model: put(model, "WindowMaterial:Gas", argon={"gas_type": "Argon", "thickness": 0.013}),
        ),
    ),
    "storm_window": Case(
        "WindowProperty:StormWindow", "*",
        puts("WindowProperty:StormWindow", window_name="room win", storm_glass_layer_name="glass",
             distance_between_storm_glass_layer_and_adjacent_glass=0.05,
             month_that_storm_glass_layer_is_put_on=10, day_of_month_that_storm_glass_layer_is_put_on=15,
             month_that_storm_glass_layer_is_taken_off=4,
             day_of_month_that_storm_glass_layer_is_taken_off=15),
        both=panes,
    ),
    "humidity_capacity": Case(
        "ZoneCapacitanceMultiplier:ResearchSpecial", "humidity capacity*",
        puts("ZoneCapacitanceMultiplier:ResearchSpecial", zone_or_zonelist_name="room",
             humidity_capacity_multiplier=15.0),
    ),
    "water_vapour": Case(
        "WaterUse:Equipment", "vapour of the water",
        puts("WaterUse:Equipment", peak_flow_rate=1e-5, flow_rate_fraction_schedule_name="on",
             target_temperature_schedule_name="warm", hot_water_supply_temperature_schedule_name="hot",
             zone_name="room", sensible_fraction_schedule_name="zero", latent_fraction_schedule_name="some"),
        both=together(constant("warm", 40.0), constant("hot", 60.0), constant("zero", 0.0),
                      constant("some", 0.05)),
    ),
}  # fmt: skip


def main() -> None:
    """Measure the kinds, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--energyplus", metavar="COMMAND", required=True)
    options = parser.parse_args()
    rows: dict[str, list[str]] = {}
    if TABLE.is_file():
        with TABLE.open(encoding="utf-8", newline="") as held:
            rows = {row[0]: row for row in list(csv.reader(held))[1:]}
    for name in options.names or CASES:
        case = CASES[name]
        try:
            effects = [measured(case, room, options.energyplus) for room in WEATHER]
        except (ValueError, KeyError) as error:
            print(f"{name}: {error}", file=sys.stderr)
            continue
        (kelvin, percent), (other_kelvin, other_percent) = effects
        numbers = [f"{value:.2g}" if value >= 0.005 else "0" for value in
                   (kelvin, other_kelvin, percent, other_percent)]  # fmt: skip
        rows[name] = [name, case.kind, case.what, *numbers]
        print(*rows[name], sep=" | ", flush=True)
    with TABLE.open("w", encoding="utf-8", newline="") as target:
        writer = csv.writer(target, lineterminator="\n")
        writer.writerow(
            ["name", "class", "found", "kelvin", "kelvin_other", "loads_percent", "loads_percent_other"]
        )
        writer.writerows(rows[name] for name in CASES if name in rows)


if __name__ == "__main__":
    main()
