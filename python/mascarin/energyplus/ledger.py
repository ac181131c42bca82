"""Fields and objects that no handler has read: each is without effect, or listed.

A model keeps account of the fields that were read. What is left over with a value other than the default of
its version is compared with the fields that are known to have no effect; all others are listed, and so is a
field that a new version of EnergyPlus adds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from typing import Any, Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.idf import IdfObject

_COUNT: Final = "a count"
_BESIDE: Final = "an area or a temperature that nothing here needs"
_OUTER: Final = "of a layer that is not the surface"
_LIGHT: Final = "visible light"
_METHOD: Final = "of a method that the object does not choose"
_TANK: Final = "inside of the tank and its loop"
_WATER: Final = "of the loop"
_NODE: Final = "connections of systems"
_OTHER_SIDE: Final = "read from the other side of the surface"

#: Fields without effect on temperatures and loads of a zone, by beginning of the class, with the reason.
#: Tried in both programs, or read only where the object chooses their method.
IDLE_FIELDS: Final[Mapping[str, Mapping[str, str]]] = {
    "": {
        "number_of_vertices": _COUNT,
        "end_use_subcategory": "a report",
        "schedule_type_limits_name": "a check of schedules",
        "*visible_*": _LIGHT,
        "*_node_name": _NODE,
        "*_nodelist_name": _NODE,
        "fuel_type": "a report",
        "carbon_dioxide_*": "contaminants",
    },
    "building": {
        "loads_convergence_*": "a control of the solver",
        "temperature_convergence_*": "a control of the solver",
        "m*_number_of_warmup_days": "a control of the solver",
    },
    "buildingsurface:detailed": {
        "space_name": "the whole zone is one volume of air",
        "construction_name": _OTHER_SIDE,
        "view_factor_to_ground": "of a surface that is not outdoors",
    },
    "wall:": {"construction_name": _OTHER_SIDE, "view_factor_to_ground": "of a surface that is not outdoors"},
    "ceiling:": {"construction_name": _OTHER_SIDE},
    "floor:": {"construction_name": _OTHER_SIDE},
    "roof": {"construction_name": _OTHER_SIDE},
    "fenestrationsurface:detailed": {
        "construction_name": _OTHER_SIDE,
        "frame_and_divider_name": _OTHER_SIDE,
        "view_factor_to_ground": "of an opening that is not outdoors",
    },
    "window": {"construction_name": _OTHER_SIDE, "frame_and_divider_name": _OTHER_SIDE},
    "door": {"construction_name": _OTHER_SIDE},
    "glazeddoor": {"construction_name": _OTHER_SIDE, "frame_and_divider_name": _OTHER_SIDE},
    "globalgeometryrules": {
        "daylighting_*": "daylight",
        "starting_vertex_position": "corners run once around the surface, from whichever",
        "rectangular_surface_coordinate_system": "no such surface is in the file",
    },
    "people": {
        "thermal_comfort_*": "a report of comfort",
        "clothing_*": "a report of comfort",
        "air_velocity_*": "a report of comfort",
        "work_efficiency_*": "a report of comfort",
        "ankle_*": "a report of comfort",
        "cold_stress_*": "a report of comfort",
        "enable_ashrae_55_*": "a report of comfort",
        "mean_radiant_temperature_*": "a report of comfort",
        "surface_name_angle_factor_list_name": "a report of comfort",
        "*people*": _METHOD,
        "*area_per_person": _METHOD,
    },
    "lights": {
        "fraction_replaceable": "daylight dims nothing here: see Daylighting",
        "lighting_level": _METHOD,
        "*watts_per_*": _METHOD,
    },
    "electricequipment": {"design_level": _METHOD, "*watts_per_*": _METHOD},
    "gasequipment": {"design_level": _METHOD, "power_per_*": _METHOD},
    "hotwaterequipment": {"design_level": _METHOD, "power_per_*": _METHOD},
    "steamequipment": {"design_level": _METHOD, "power_per_*": _METHOD},
    "otherequipment": {"design_level": _METHOD, "power_per_*": _METHOD},
    "material": {
        "roughness": _OUTER,
        "solar_absorptance": _OUTER,
        "thermal_absorptance": _OUTER,
    },
    "materialproperty:glazingspectraldata": {"*": "read as a table"},
    "windowmaterial:glazing": {
        "*_at_normal_incidence": "of glass that is described by wavelength",
        "poisson*": "mechanics",
        "young*": "mechanics",
        "window_glass_spectral_*": _METHOD,
    },
    "windowproperty:frameanddivider": {
        "divider_*": "dividers are listed with their window",
        "ratio_of_divider_*": "dividers are listed with their window",
        "*_inside_projection": "listed with the frame",
    },
    "zone": {
        "part_of_total_floor_area": "a report",
        "type": "not used by EnergyPlus",
        "floor_area": "no gain or flow by area is in the zone",
        "ceiling_height": "the volume is stated",
        "zone_*side_convection_algorithm": "no surface of the zone needs it",
        "?_origin": "coordinates of the world",
        "direction_of_relative_north": "coordinates of the world",
    },
    "space": {"space_type": "a report", "tags": "a report"},
    "runperiod": {
        "use_weather_file_*_indicators": "rain and snow have no effect here: docs/energyplus.md",
        "use_weather_file_*": "of another run period",
        "end_year": "the period is an option of a run here",
        "day_of_week_for_start_day": "the begin year says it",
        "apply_weekend_holiday_rule": "a date of holidays",
        "treat_weather_as_actual": "dates of the weather file",
        "first_hour_interpolation_starting_values": "the first hour of a run",
    },
    "schedule:year": {"start_*": "a week begins where the one before it ends"},
    "schedule:week:daily": {"*designday_*": "days for sizes", "customday*": "days that do not occur"},
    "schedule:file": {
        "number_of_hours_of_data": _COUNT,
        "adjust_schedule_for_daylight_savings": "listed with the daylight saving time",
    },
    "schedule:day:list": {"minutes_per_item": "read as a table"},
    "site:location": {"keep_site_location_information": "of a weather file with several places"},
    "site:heightvariation": {"air_temperature_gradient_coefficient": "listed with the object"},
    "site:weatherstation": {"air_temperature_sensor_*": "the air has one temperature"},
    "waterheater:": {"*": _TANK},
    "thermalstorage:": {"*": _TANK},
    "wateruse:equipment": {"*": _WATER},
    "zonehvac:equipment": {"*": _NODE},
    "zonehvac:idealloadsairsystem": {
        "maximum_*_air_flow_rate": _METHOD,
        "maximum_sensible_heating_capacity": _METHOD,
        "maximum_total_cooling_capacity": _METHOD,
        "*_supply_air_temperature": "of a supply without a limit",
        "*humidi*": "moisture: listed with the system",
        "latent_heat_recovery_effectiveness": "moisture: listed with the recovery",
        "sensible_heat_recovery_effectiveness": _METHOD,
    },
    "zoneinfiltration:designflowrate": {"*flow*": _METHOD, "air_changes_per_hour": _METHOD},
    "zoneventilation:designflowrate": {
        "*flow*": _METHOD,
        "air_changes_per_hour": _METHOD,
        "fan_*": "electricity of a fan",
    },
    "zoneventilation:windandstackopenarea": {"effective_angle": "the effectiveness is stated"},
    "zonemixing": {"*flow*": _METHOD, "air_changes_per_hour": _METHOD},
    "zonecrossmixing": {"*flow*": _METHOD, "air_changes_per_hour": _METHOD},
    "surfaceproperty:convectioncoefficients": {"*_name": "listed with the coefficient"},
    "heatbalancealgorithm": {"*": "a control of the solver"},
    "airflownetwork:simulationcontrol": {
        "*_tolerance": "a control of the solver",
        "*_limit": "a control of the solver",
        "initialization_*": "a control of the solver",
        "maximum_number_of_iterations": "a control of the solver",
    },
    "airflownetwork:multizone:zone": {
        "*venting*": _METHOD,
        "*_temperature_difference_*": _METHOD,
        "*_enthalpy_difference_*": _METHOD,
        "facade_width": _METHOD,
    },
    "airflownetwork:multizone:windpressurecoefficientvalues": {
        "airflownetwork_multizone_windpressurecoefficientarray_name": "of which there is one",
    },
    "windowmaterial:shade": {
        "thickness": "of a shade whose edges are closed: read there",
        "conductivity": "of a shade whose edges are closed: read there",
    },
    "windowmaterial:screen": {"angle_of_resolution_*": "a report"},
    "windowshadingcontrol": {
        "zone_name": "the windows are named",
        "setpoint*": _METHOD,
        "shading_control_sequence_number": "an order of controls",
    },
    "shading:": {"base_surface_name": "its corners say where it is"},
}
#: Settings of which there is one, and objects that are named by others: unused, they have no effect.
_UNUSED: Final = (
    "surfaceconvectionalgorithm:", "schedule:", "material", "construction", "runperiod", "windowmaterial:",
    "windowproperty:frameanddivider", "windowgap", "thermostatsetpoint:", "zonelist",
    "space", "hvactemplate:thermostat", "externalinterface:", "surfaceproperty:othersidecoefficients",
    "designspecification:", "site:watermains", "zonehvac:equipmentlist", "airflownetwork:multizone:zone",
)  # fmt: skip


def note_unread(context: Context) -> None:
    """Note fields and objects of the classes that were read, that themselves were not.

    Parameters
    ----------
    context : Context
        The conversion, at its end.
    """
    idle = _Idle()
    unused: dict[str, list[IdfObject]] = {}
    for item in context.model.items:
        low = item.kind.casefold()
        if low not in context.model.read or context.findings.about(item, "left out"):
            continue
        if not item.fields.seen and item.fields:
            unused.setdefault(item.kind, []).append(item)
            continue
        for key, value in _stated(item):
            if not idle.knows(low, key):
                context.findings.left_out(
                    item,
                    f"{key.replace('_', ' ')} = {str(value)[:40]}",
                    "this field is not carried over: what it does in EnergyPlus is missing",
                )
    for kind, items in unused.items():
        if kind in ("Version", "Timestep"):
            continue
        if kind.casefold().startswith(_UNUSED):
            context.findings.no_effect(items, "not needed", "nothing that is carried over uses it")
        else:
            for item in items:
                context.findings.left_out(item, "not carried over", "its effect is missing in the results")


def _stated(item: IdfObject) -> Iterator[tuple[str, Any]]:
    """Fields that nothing has read, with values other than their defaults."""
    for key, value in item.fields.unseen().items():
        default = item.defaults.get(key)
        same = default is not None and (
            value == default or str(value).strip().casefold() == str(default).strip().casefold()
        )
        # 0 without a default is nothing; so is what leaves the number to EnergyPlus.
        blank = default is None and (value == 0 or str(value).casefold() in ("autocalculate", "autosize"))
        if not same and not blank and not key.startswith("idf_"):
            yield key, value


class _Idle:
    """Fields without effect, with the answers so far."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str], bool] = {}

    def knows(self, kind: str, key: str) -> bool:
        if (kind, key) not in self._known:
            self._known[kind, key] = any(
                kind.startswith(start) and any(fnmatchcase(key, pattern) for pattern in patterns)
                for start, patterns in IDLE_FIELDS.items()
            )
        return self._known[kind, key]
