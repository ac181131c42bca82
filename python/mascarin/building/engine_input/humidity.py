"""Humidity as the engine reads it."""

from __future__ import annotations

from collections.abc import Mapping

from mascarin.building.engine_input.air import driven, schedule_of
from mascarin.building.engine_input.ids import Ids, Json, Places, below, deeper
from mascarin.building.parts.air.humidity import CoolingCoil, Humidistat, Humidity, VapourGain
from mascarin.building.parts.description import Description
from mascarin.building.parts.materials.sorption import LinearSorption
from mascarin.building.parts.moisture_surfaces import VapourSide, vapour_sides


def describe_humidity(building: Description, places: Places, ids: Mapping[str, int]) -> Json | None:
    """Describe the vapour balances of the zones; None where air has no humidity."""
    humidity = building.humidity
    if humidity is None:
        return None
    own = below(ids, "humidity")
    return {
        "initial": own("initial"),
        "lewis": own("lewis"),
        "zones": [_zone(humidity, name, places, own) for name in building.zones],
        "buffers": [
            _buffer(building, humidity, side, (ids, own)) for side in vapour_sides(building) if side.takes_up
        ],
        "recoveries": [
            own(f"recovery.{name}") if name in humidity.recovery else None
            for name in building.ventilation_units
        ],
    }


def _zone(humidity: Humidity, name: str, places: Places, ids: Ids) -> Json:
    zone = humidity.zones[name]
    own = deeper(ids, f"zones.{name}")
    written: Json = {
        "storage": own("storage"),
        "gains": [
            {"name": key, **_gain(gain, places, deeper(own, f"gains.{key}"))}
            for key, gain in zone.gains.items()
        ],
    }
    if isinstance(zone.drying, CoolingCoil):
        written["drying"] = {
            "kind": "coil",
            "sensible_heat_ratio": own("drying.sensible_heat_ratio"),
            "temperature": own("drying.coil_temperature"),
        }
    elif zone.drying is not None:
        control = _control(zone.drying, places, deeper(own, "drying"))
        written["drying"] = {"kind": "controlled", "control": control}
    if zone.humidifying is not None:
        written["humidifying"] = _control(zone.humidifying, places, deeper(own, "humidifying"))
    return written


def _gain(gain: VapourGain, places: Places, ids: Ids) -> Json:
    if gain.power is not None:
        return {"power": ids("power"), **schedule_of(gain, places)}
    return driven(gain, "rate", places, ids)


def _control(plant: Humidistat, places: Places, ids: Ids) -> Json:
    key, given = plant.setpoint
    kind, number = ("relative", "humidity") if key == "relative_humidity" else ("ratio", "ratio")
    if given.course is None:
        point: Json = {"kind": kind, number: ids(f"{key}.constant")}
    else:
        point = {"kind": f"{kind}_scheduled", "channel": places[given.course]}
    capacity = None if plant.capacity is None else ids("capacity")
    return {"setpoint": point, "capacity": capacity, **schedule_of(plant, places)}


def _buffer(
    building: Description, humidity: Humidity, side: VapourSide, ids: tuple[Mapping[str, int], Ids]
) -> Json:
    every, own = ids
    sorption = humidity.materials[side.material]
    at = deeper(own, f"materials.{side.material}")
    written: Json = {
        "surface": list(building.surfaces).index(side.surface),
        "side": side.side,
        "resistance_factor": at("vapour_resistance"),
        "thickness": every[f"constructions.{side.construction}.layers.{side.layer}.thickness"],
        "depth": {"kind": "period", "period": own("period")},
    }
    if isinstance(sorption, LinearSorption):
        written["sorption"] = {"kind": "linear", "capacity": at("capacity")}
    else:
        humidities, contents = sorption.table(side.density)
        written["sorption"] = {
            "kind": "table",
            "humidities": humidities,
            "contents": contents,
            "factor": at("factor"),
        }
    if sorption.depth is not None:
        written["depth"] = {"kind": "given", "depth": at("depth")}
    if sorption.deep_depth is not None:
        written["deep"] = {"kind": "given", "depth": at("deep_depth")}
    elif humidity.deep_period is not None:
        written["deep"] = {"kind": "period", "period": own("deep_period")}
    exception = humidity.surfaces.get(side.surface)
    if exception is not None and exception.paint is not None:
        written["coating"] = own(f"surfaces.{side.surface}.paint")
    return written
