"""A measured test cell: its room, and the study that identifies it with the data of a logger."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.templates.new_buildings import building_of
from mascarin.templates.short_texts import quoted

if TYPE_CHECKING:
    from mascarin.templates.room import Room
    from mascarin.templates.study_text import LoggerRecord

#: Channels of the weather without which a cell cannot be simulated.
_NEEDED: Final = ("air_temperature", "global_horizontal")
#: Channels that are stated to be absent where the logger does not have them.
#: Weather that may be absent, and what is taken then.
_ABSENT: Final = {
    "wind_speed": "still air",
    "wind_direction": "wind from north",
    "dew_point": "70 % of humidity",
}


def cell_study(
    room: Room, record: LoggerRecord, weather: Mapping[str, str], sensors: Mapping[str, str]
) -> str:
    """The study of a cell, as text.

    Parameters
    ----------
    room : Room
        The cell.
    record : LoggerRecord
        The logger file.
    weather : mapping of str to str
        Channel of the weather -> column of the file.
    sensors : mapping of str to str
        Column -> output of the building, such as ``room.air_temperature``.

    Raises
    ------
    InputError
        A column or an output that is not there, or too little weather.
    """
    from mascarin.templates.study_text import study_lines

    missing = [channel for channel in _NEEDED if channel not in weather]
    if missing:
        raise InputError(
            f"--column: found no {', '.join(missing)}; expected the weather beside the cell, such as "
            "--column air_temperature=T_out --column global_horizontal=G"
        )
    if not sensors:
        raise InputError(
            "--sensor: found none; expected at least one temperature that is compared, such as "
            "--sensor T_room=room.air_temperature"
        )
    for option, columns in (("--column", weather.values()), ("--sensor", sensors)):
        for column in columns:
            record.require(column, option)
    building = building_of(room)
    wind = [channel for channel in ("wind_speed", "wind_direction") if channel not in weather]
    if building.vents and wind:
        raise InputError(
            f"--column: found no {', '.join(wind)}; expected both, because the wind drives air through "
            f"{', '.join(f'vents.{name}' for name in building.vents)}, such as --column wind_speed=V "
            "--column wind_direction=D. Or write --gap closed"
        )
    for output in sensors.values():
        building.output(output)
    return (
        "\n".join(study_lines(record, "My cell", _climate(record, weather), sensors, _parameters(room)))
        + "\n"
    )


def _climate(record: LoggerRecord, weather: Mapping[str, str]) -> Iterator[str]:
    yield "climate:"
    yield "  measured:"
    yield f"    table: {quoted(record.path.name)}"
    yield f"    timezone: {quoted(record.timezone)}"
    yield "    columns:"
    for channel, column in weather.items():
        yield f"      {channel}: {quoted(column)}"
    humid = {"dew_point", "relative_humidity"} & {*weather}
    absent = [
        channel for channel in _ABSENT if channel not in weather and not (channel == "dew_point" and humid)
    ]
    if absent:
        taken = [
            _ABSENT[channel] for channel in absent if channel != "wind_direction" or "wind_speed" in weather
        ]
        yield f"    # Not measured: {', '.join(taken)}."
        yield f"    absent: [{', '.join(absent)}]"


def _parameters(room: Room) -> Iterator[str]:
    """Numbers that are rarely known and that air and surface temperatures tell about."""
    yield "zones.room.infiltration.constant"
    yield "surfaces.roof.outside.absorptance"
    materials = {layer.name: layer for part in room.layers.values() for layer in part}
    for name, layer in materials.items():
        conductivity = layer.material.get("conductivity")
        if isinstance(conductivity, dict) and float(conductivity["value"]) < 0.1:
            yield f"materials.{name}.conductivity"
