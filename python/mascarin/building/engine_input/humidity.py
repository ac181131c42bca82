"""Humidity as the engine reads it."""

from __future__ import annotations

from collections.abc import Mapping

from mascarin.building.engine_input.air import driven, schedule_of
from mascarin.building.engine_input.ids import Ids, Json, Positions, below, deeper
from mascarin.building.parts.air.humidity import CoolingCoil, Humidistat, Humidity, VapourGain
from mascarin.building.parts.description import Description
from mascarin.building.parts.materials.sorption import SorptionLaw
from mascarin.building.parts.moisture_surfaces import VapourSide, vapour_sides


def describe_humidity(building: Description, positions: Positions, ids: Mapping[str, int]) -> Json | None:
    """Describe the vapour balances of the zones; None where air has no humidity."""
    humidity = building.humidity
    if humidity is None:
        return None
    part_ids = below(ids, "humidity")
    return {
        "initial": part_ids("initial"),
        "lewis": part_ids("lewis"),
        "zones": [_zone(humidity, name, positions, part_ids) for name in building.zones],
        "buffers": [
            _buffer(building, humidity, side, (ids, part_ids))
            for side in vapour_sides(building)
            if side.takes_up
        ],
        "recoveries": [
            part_ids(f"recovery.{name}") if name in humidity.recovery else None
            for name in building.ventilation_units
        ],
    }


def _zone(humidity: Humidity, name: str, positions: Positions, ids: Ids) -> Json:
    zone = humidity.zones[name]
    part_ids = deeper(ids, f"zones.{name}")
    written: Json = {
        "storage": part_ids("storage"),
        "gains": [
            {"name": key, **_gain(gain, positions, deeper(part_ids, f"gains.{key}"))}
            for key, gain in zone.gains.items()
        ],
    }
    if isinstance(zone.drying, CoolingCoil):
        written["drying"] = {
            "kind": "coil",
            "sensible_heat_ratio": part_ids("drying.sensible_heat_ratio"),
            "temperature": part_ids("drying.coil_temperature"),
        }
    elif zone.drying is not None:
        control = _control(zone.drying, positions, deeper(part_ids, "drying"))
        written["drying"] = {"kind": "controlled", "control": control}
    if zone.humidifying is not None:
        written["humidifying"] = _control(zone.humidifying, positions, deeper(part_ids, "humidifying"))
    return written


def _gain(gain: VapourGain, positions: Positions, ids: Ids) -> Json:
    if gain.power is not None:
        activity = {} if gain.activity is None else {"activity": ids("activity")}
        return {"power": ids("power"), **activity, **schedule_of(gain, positions)}
    return driven(gain, "rate", positions, ids)


def _control(plant: Humidistat, positions: Positions, ids: Ids) -> Json:
    key, value = plant.setpoint
    kind, number = ("relative", "humidity") if key == "relative_humidity" else ("ratio", "ratio")
    if value.course is None:
        point: Json = {"kind": kind, number: ids(f"{key}.constant")}
    else:
        point = {"kind": f"{kind}_scheduled", "channel": positions[value.course]}
    capacity = None if plant.capacity is None else ids("capacity")
    return {"setpoint": point, "capacity": capacity, **schedule_of(plant, positions)}


def _buffer(
    building: Description, humidity: Humidity, side: VapourSide, ids: tuple[Mapping[str, int], Ids]
) -> Json:
    all_ids, part_ids = ids
    sorption = humidity.materials[side.material]
    inner_ids = deeper(part_ids, f"materials.{side.material}")
    written: Json = {
        "surface": list(building.surfaces).index(side.surface),
        "side": side.side,
        "resistance_factor": inner_ids("vapour_resistance"),
        "thickness": all_ids[f"constructions.{side.construction}.layers.{side.layer}.thickness"],
        "depth": {"kind": "period", "period": part_ids("period")},
    }
    if isinstance(sorption, SorptionLaw):
        numbers = {number.name: inner_ids(number.name) for number in sorption.row.numbers}
        written["sorption"] = {"kind": sorption.kind, **numbers}
    else:
        humidities, contents = sorption.table(side.density)
        written["sorption"] = {
            "kind": "table",
            "humidities": humidities,
            "contents": contents,
            "factor": inner_ids("factor"),
        }
    if sorption.depth is not None:
        written["depth"] = {"kind": "given", "depth": inner_ids("depth")}
    if sorption.deep_depth is not None:
        written["deep"] = {"kind": "given", "depth": inner_ids("deep_depth")}
    elif humidity.deep_period is not None:
        written["deep"] = {"kind": "period", "period": part_ids("deep_period")}
    exception = humidity.surfaces.get(side.surface)
    if exception is not None and exception.paint is not None:
        written["coating"] = part_ids(f"surfaces.{side.surface}.paint")
    return written
