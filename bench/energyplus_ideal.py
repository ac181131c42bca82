"""A model of EnergyPlus of any version as one of 25.2 with ideal loads, for a comparison of both programs.

What has no zones, surfaces, gains or air flows goes: programs, air and water, plants, templates. Each
zone with a thermostat, also that of a template, has ideal loads without limits and without outdoor air. The
site is that of the weather file, the shadows are those of each day, and the run periods are given.

    python bench/energyplus_ideal.py MODEL OUT.epJSON WEATHER.epw
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import idfkit

Section = dict[str, dict[str, Any]]

VERSION = (25, 2, 0)
#: Groups of the schema that stay.
GROUPS = frozenset(
    (
        "Simulation Parameters", "Location and Climate", "Schedules", "Surface Construction Elements",
        "Thermal Zones and Surfaces", "Advanced Construction, Surface, Zone Concepts",
        "Detailed Ground Heat Transfer", "Room Air Models", "Internal Gains", "Daylighting", "Zone Airflow",
        "AirflowNetwork", "Zone HVAC Controls and Thermostats", "Performance Curves", "Performance Tables",
    )
)  # fmt: skip
#: Beginnings of the classes of these groups that go.
GOES = (
    "Version", "Timestep", "SimulationControl", "PerformancePrecision", "ConvergenceLimits", "HVACSystemRoot",
    "ShadowCalculation", "ZoneAirContaminantBalance", "SizingPeriod", "RunPeriod", "Site:Location",
    "Site:WaterMains", "AirflowNetwork:Distribution", "AirflowNetwork:IntraZone", "ZoneControl:Humidistat",
    "ZoneControl:Thermostat:", "ThermostatSetpoint:ThermalComfort", "ZoneControl:ContaminantController",
    "ZoneContaminant", "SurfaceContaminant", "SurfaceControl:MovableInsulation:Air",
)  # fmt: skip
STAYS = ("RunPeriodControl:",)
#: Former names of fields.
_PLACE = "zone_or_zonelist_or_space_or_spacelist_name"
_BY_AREA = {
    "watts_per_zone_floor_area": "watts_per_floor_area",
    "power_per_zone_floor_area": "power_per_floor_area",
}
_EQUIPMENT = {"zone_or_zonelist_name": _PLACE, "zone_name": _PLACE, **_BY_AREA}
_FLOW = {
    "zone_or_zonelist_name": _PLACE,
    "flow_per_zone_floor_area": "flow_rate_per_floor_area",
    "flow_rate_per_zone_floor_area": "flow_rate_per_floor_area",
    "flow_per_exterior_surface_area": "flow_rate_per_exterior_surface_area",
}
_SPACE = {"zone_name": "zone_or_space_name", "source_zone_name": "source_zone_or_space_name"}
_MIXING = _SPACE | {"flow_rate_per_zone_floor_area": "flow_rate_per_floor_area"}
_MIXING |= {
    f"{most}_{old}temperature_schedule_name": f"{most}_{new}_temperature_schedule_name"
    for most in ("minimum", "maximum")
    for old, new in (("zone_", "receiving"), ("source_zone_", "source"))
}
RENAMED = {
    "People": {
        "zone_or_zonelist_name": _PLACE,
        "people_per_zone_floor_area": "people_per_floor_area",
        "zone_floor_area_per_person": "floor_area_per_person",
    },
    "Lights": {"zone_or_zonelist_name": _PLACE, **_BY_AREA},
    **{f"{kind}Equipment": _EQUIPMENT for kind in ("Electric", "Gas", "HotWater", "Steam", "Other")},
    "ZoneInfiltration:DesignFlowRate": _FLOW,
    "ZoneVentilation:DesignFlowRate": _FLOW,
    "ZoneInfiltration:EffectiveLeakageArea": _SPACE,
    "ZoneInfiltration:FlowCoefficient": _SPACE,
    "ZoneVentilation:WindandStackOpenArea": _SPACE,
    "ZoneMixing": _MIXING,
    "ZoneCrossMixing": _MIXING,
    "InternalMass": {"zone_name": "zone_or_zonelist_name"},
}
OUTPUTS = (
    "Zone Mean Air Temperature", "Zone Air System Sensible Heating Energy",
    "Zone Air System Sensible Cooling Energy", "Enclosure Windows Total Transmitted Solar Radiation Energy",
)  # fmt: skip
_THERMOSTAT = "ZoneControl:Thermostat"
_DUAL = "ThermostatSetpoint:DualSetpoint"


@dataclass(frozen=True)
class Prepared:
    """A model that EnergyPlus 25.2 reads.

    Attributes
    ----------
    model : dict
        Content of the epJSON file.
    dropped : dict of str to int
        Number of objects by class, and of fields by class and field, that 25.2 does not have.
    """

    model: dict[str, Section]
    dropped: dict[str, int]


def prepared(file: Path, weather: Path, periods: tuple[tuple[date, date], ...], steps: int) -> Prepared:
    """A model with ideal loads; ``periods`` by first and last day, ``steps`` in an hour."""
    stated = _read(file)
    schema = idfkit.get_schema_manager().get_schema(VERSION)
    dropped: Counter[str] = Counter()
    model: dict[str, Section] = {}
    for kind, objects in stated.items():
        if kind not in schema:
            dropped[kind] += len(objects)
        elif _stays(kind, schema.get_group(kind)):
            model[kind] = {
                name: _fields(kind, values, schema.get_inner_schema(kind) or {}, dropped)
                for name, values in objects.items()
            }
    _without_fans(model)
    _renew(model, weather, periods, steps)
    _condition(model, stated)
    return Prepared(model, dict(dropped))


def _read(file: Path) -> dict[str, Section]:
    if file.suffix.casefold() == ".epjson":
        return dict(json.loads(file.read_text(encoding="utf-8")))
    try:
        file.read_text(encoding="utf-8")
        encoding = "utf-8"
    except UnicodeDecodeError:
        encoding = "latin-1"
    stated: dict[str, Section] = {}
    for item in idfkit.parse_idf(file, encoding=encoding).all_objects:
        objects = stated.setdefault(str(item.obj_type), {})
        name = str(item.name or f"{item.obj_type} {len(objects) + 1}")
        name = f"{name} {len(objects) + 1}" if name in objects else name
        objects[name] = {key: value for key, value in dict(item.data).items() if value not in (None, "")}
    return stated


def _stays(kind: str, group: str | None) -> bool:
    return group in GROUPS and (kind.startswith(STAYS) or not kind.startswith(GOES))


def _fields(
    kind: str, values: dict[str, Any], schema: dict[str, Any], dropped: Counter[str]
) -> dict[str, Any]:
    """Fields of an object with the names and words of 25.2."""
    known = schema.get("properties", {})
    fields: dict[str, Any] = {}
    for stated_key, value in values.items():
        key = stated_key
        if key not in known:
            key = RENAMED.get(kind, {}).get(key, key)
        if key in known:
            fields[key] = _fitted(value, known[key])
        elif not key.startswith("idf_"):
            dropped[f"{kind}.{key}"] += 1
    if (
        kind == "People"
        and str(values.get("mean_radiant_temperature_calculation_type", "")).lower() == "zoneaveraged"
    ):
        fields["mean_radiant_temperature_calculation_type"] = "EnclosureAveraged"
    if kind == "AirflowNetwork:SimulationControl":
        fields["airflownetwork_control"] = {
            "multizonewithdistribution": "MultizoneWithoutDistribution",
            "multizonewithdistributiononlyduringfanoperation": "MultizoneWithoutDistribution",
        }.get(str(fields.get("airflownetwork_control", "")).lower(), fields.get("airflownetwork_control"))
    return {key: value for key, value in fields.items() if value is not None}


def _fitted(value: Any, schema: dict[str, Any]) -> Any:
    """A value with the words and kinds of numbers of the schema."""
    kinds = schema.get("anyOf", [schema])
    if isinstance(value, list):
        inner = schema.get("items", {}).get("properties", {})
        return [
            {key: _fitted(part, inner.get(key, {})) for key, part in row.items() if part not in (None, "")}
            if isinstance(row, dict)
            else row
            for row in value
        ]
    for kind in kinds:
        for word in kind.get("enum", ()) if isinstance(value, str) else ():
            if str(word).casefold() == value.strip().casefold():
                return word
    whole = isinstance(value, float) and value.is_integer()
    return int(value) if whole and any(kind.get("type") == "integer" for kind in kinds) else value


def _without_fans(model: dict[str, Section]) -> None:
    """Take the exhaust fans of systems out of an air flow network."""
    fans = {name.casefold() for name in model.pop("AirflowNetwork:MultiZone:Component:ZoneExhaustFan", {})}
    surfaces = model.get("AirflowNetwork:MultiZone:Surface", {})
    for name, values in list(surfaces.items()):
        if str(values.get("leakage_component_name", "")).casefold() in fans:
            del surfaces[name]


def _renew(
    model: dict[str, Section], weather: Path, periods: tuple[tuple[date, date], ...], steps: int
) -> None:
    """Site, time, shadows and outputs."""
    with weather.open(encoding="latin-1") as lines:
        head = lines.readline().split(",")
    places = ("latitude", "longitude", "time_zone", "elevation")
    model["Site:Location"] = {
        head[1]: {key: float(text) for key, text in zip(places, head[6:10], strict=True)}
    }
    model["Version"] = {"Version 1": {"version_identifier": ".".join(map(str, VERSION[:2]))}}
    model["Timestep"] = {"Timestep 1": {"number_of_timesteps_per_hour": steps}}
    model["ShadowCalculation"] = {
        "ShadowCalculation 1": {
            "shading_calculation_method": "PolygonClipping",
            "shading_calculation_update_frequency_method": "Periodic",
            "shading_calculation_update_frequency": 1,
        }
    }
    sizing = ("do_zone_sizing_calculation", "do_system_sizing_calculation", "do_plant_sizing_calculation")
    model["SimulationControl"] = {
        "SimulationControl 1": {
            **dict.fromkeys((*sizing, "run_simulation_for_sizing_periods"), "No"),
            "run_simulation_for_weather_file_run_periods": "Yes",
        }
    }
    of_weather = ("holidays_and_special_days", "daylight_saving_period", "rain_indicators", "snow_indicators")
    no = dict.fromkeys(
        ("apply_weekend_holiday_rule", *(f"use_weather_file_{what}" for what in of_weather)), "No"
    )
    model["RunPeriod"] = {
        f"period {k}": {
            "begin_month": first.month, "begin_day_of_month": first.day, "begin_year": first.year,
            "end_month": last.month, "end_day_of_month": last.day, "end_year": last.year,
            "day_of_week_for_start_day": f"{first:%A}", **no,
        }
        for k, (first, last) in enumerate(periods, start=1)
    }  # fmt: skip
    model["Output:Variable"] = {
        f"output {k}": {"key_value": "*", "variable_name": name, "reporting_frequency": "Hourly"}
        for k, name in enumerate(OUTPUTS, start=1)
    }


def _condition(model: dict[str, Section], stated: dict[str, Section]) -> None:
    """Ideal loads for each zone with a thermostat."""
    for zone, thermostat in _templates(stated):
        _enter_template(model, zone, thermostat)
    system = {
        "heating_limit": "NoLimit",
        "cooling_limit": "NoLimit",
        "dehumidification_control_type": "None",
        "humidification_control_type": "None",
    }
    for zone in dict.fromkeys(_controlled(model)):
        model.setdefault("ZoneHVAC:EquipmentConnections", {})[f"{zone} connections"] = {
            "zone_name": zone,
            "zone_conditioning_equipment_list_name": f"{zone} list",
            "zone_air_inlet_node_or_nodelist_name": f"{zone} in",
            "zone_air_node_name": f"{zone} air",
            "zone_return_air_node_or_nodelist_name": f"{zone} return",
        }
        row = {
            "zone_equipment_object_type": "ZoneHVAC:IdealLoadsAirSystem",
            "zone_equipment_name": f"{zone} ideal",
            "zone_equipment_cooling_sequence": 1,
            "zone_equipment_heating_or_no_load_sequence": 1,
        }
        model.setdefault("ZoneHVAC:EquipmentList", {})[f"{zone} list"] = {
            "load_distribution_scheme": "SequentialLoad",
            "equipment": [row],
        }
        model.setdefault("ZoneHVAC:IdealLoadsAirSystem", {})[f"{zone} ideal"] = {
            "zone_supply_air_node_name": f"{zone} in",
            **system,
        }


def _controlled(model: dict[str, Section]) -> Iterator[str]:
    lists = {name.casefold(): values for name, values in model.get("ZoneList", {}).items()}
    for values in model.get(_THERMOSTAT, {}).values():
        name = str(values["zone_or_zonelist_name"])
        rows = lists.get(name.casefold(), {}).get("zones")
        yield from [name] if rows is None else [str(row["zone_name"]) for row in rows]


def _templates(stated: dict[str, Section]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Zones of HVAC templates with their thermostats."""
    thermostats = {
        name.casefold(): values for name, values in stated.get("HVACTemplate:Thermostat", {}).items()
    }
    for kind, objects in stated.items():
        for values in objects.values() if kind.startswith("HVACTemplate:Zone") else ():
            thermostat = thermostats.get(str(values.get("template_thermostat_name", "")).casefold())
            if thermostat is not None:
                yield str(values["zone_name"]), thermostat


def _enter_template(model: dict[str, Section], zone: str, thermostat: dict[str, Any]) -> None:
    points = {}
    for which, usual in (("heating", 20.0), ("cooling", 24.0)):
        held = thermostat.get(f"{which}_setpoint_schedule_name")
        if held is None:
            held = f"{zone} {which} set point"
            value = thermostat.get(f"constant_{which}_setpoint", usual)
            model.setdefault("Schedule:Constant", {})[held] = {"hourly_value": value}
        points[f"{which}_setpoint_temperature_schedule_name"] = held
    model.setdefault(_DUAL, {})[f"{zone} set points"] = points
    model.setdefault("Schedule:Constant", {})["two set points"] = {"hourly_value": 4.0}
    model.setdefault(_THERMOSTAT, {})[f"{zone} thermostat"] = {
        "zone_or_zonelist_name": zone,
        "control_type_schedule_name": "two set points",
        "control_1_object_type": _DUAL,
        "control_1_name": f"{zone} set points",
    }


def main() -> None:
    """Write one model."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    for key in ("model", "out", "weather"):
        parser.add_argument(key, type=Path)
    options = parser.parse_args()
    year = ((date(2017, 1, 1), date(2017, 12, 31)),)
    preparation = prepared(options.model, options.weather, year, 4)
    options.out.write_text(json.dumps(preparation.model, indent=1), encoding="utf-8")
    print("\n".join(f"{number:5d} {key}: not in 25.2" for key, number in preparation.dropped.items()))


if __name__ == "__main__":
    main()
