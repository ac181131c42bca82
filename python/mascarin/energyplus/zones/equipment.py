"""Zone equipment other than ideal loads: what of it heats and what cools, and how much of it is radiated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import year
from mascarin.energyplus.model.year import Year, constant
from mascarin.energyplus.zones.zones import Zone

#: Beginnings of the classes that only heat, only cool, or do neither; all others do both.
_HEATS: Final = (
    "zonehvac:baseboard", "zonehvac:unitheater", "zonehvac:hightemperatureradiant",
    "zonehvac:lowtemperatureradiant:electric",
)  # fmt: skip
_COOLS: Final = ("zonehvac:windowairconditioner", "zonehvac:coolingpanel", "zonehvac:evaporativecooler")
_NEITHER: Final = (
    "fan:zoneexhaust", "zonehvac:dehumidifier", "zonehvac:energyrecoveryventilator", "zonehvac:humidifier",
    "waterheater",
)  # fmt: skip
_RADIANT: Final = (
    "ZoneHVAC:Baseboard:RadiantConvective:Water", "ZoneHVAC:Baseboard:RadiantConvective:Steam",
    "ZoneHVAC:Baseboard:RadiantConvective:Electric", "ZoneHVAC:HighTemperatureRadiant",
    "ZoneHVAC:LowTemperatureRadiant:Electric", "ZoneHVAC:LowTemperatureRadiant:VariableFlow",
    "ZoneHVAC:LowTemperatureRadiant:ConstantFlow",
)  # fmt: skip
BASEBOARDS: Final = (
    "ZoneHVAC:Baseboard:Convective:Electric",
    "ZoneHVAC:Baseboard:Convective:Water",
    *_RADIANT,
)


@dataclass(frozen=True)
class Plant:
    """Heating or cooling of a zone.

    Attributes
    ----------
    available : Year
        Above 0 where it is available.
    capacity : float or None
        Largest power; None without a limit. [W]
    radiative : float
        Part of it that is radiated to the surfaces. [-]
    """

    available: Year
    capacity: float | None = None
    radiative: float = 0.0


def replaced(context: Context, zone: Zone, systems: list[IdfObject]) -> dict[str, Plant]:
    """Heating and cooling in place of the equipment of a zone; neither where none of it heats or cools.

    Parameters
    ----------
    context : Context
        The conversion.
    zone : Zone
        The zone.
    systems : list of IdfObject
        Its equipment, in the order of its list.
    """
    plants: dict[str, Plant] = {}
    for system in systems:
        kind = system.kind.casefold()
        if kind == "fan:zoneexhaust":
            context.findings.no_effect(
                [system], "an exhaust fan", "EnergyPlus brings no outdoor air into the zone for it"
            )
            continue
        if kind.startswith(_NEITHER):
            continue
        does = ("heating",) if kind.startswith(_HEATS) else ("cooling",) if kind.startswith(_COOLS) else None
        plant = _baseboard(context, system) if kind.startswith("zonehvac:baseboard") else None
        if plant is None:
            words = "and ".join(f"{which} " for which in does or ("heating", "cooling"))
            context.findings.left_out(
                system,
                f"the system of zone '{zone.item.name}'",
                f"ideal {words}without limits replaces it: its capacity, fans, outdoor air and radiant "
                "surfaces have no effect",
            )
            plant = Plant(constant(1.0), radiative=_radiated(system))
        for which in does or ("heating", "cooling"):
            plants.setdefault(which, plant)
    return plants


def _radiated(system: IdfObject) -> float:
    if system.kind not in _RADIANT:
        return 0.0
    share = system.number("fraction_radiant", "fraction_of_input_converted_to_radiant_energy")
    return min(max(share or 0.0, 0.0), 1.0)


@reads(*BASEBOARDS)
def _baseboard(context: Context, system: IdfObject) -> Plant | None:
    """A baseboard: heating of its capacity; None where EnergyPlus finds the capacity from design days."""
    on = year(context, system, "availability_schedule_name")
    method = system.word("heating_design_capacity_method")
    capacity = system.number("heating_design_capacity")
    if method not in ("", "heatingdesigncapacity") or capacity is None:
        return None
    return Plant(on, capacity, _radiated(system))
