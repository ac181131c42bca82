"""A room for EnergyPlus with one kind of air flow, glazing or heating each: written for the tests.

``bench/energyplus_flows.py`` writes them as files, and makes the table of results from runs of EnergyPlus.
"""

from __future__ import annotations

from typing import Final

_ROOM: Final = """\
Version,25.2;
Timestep,4;
Building,flows,0,Suburbs,0.04,0.4,FullExterior,25,6;
SurfaceConvectionAlgorithm:Inside,TARP;
SurfaceConvectionAlgorithm:Outside,DOE-2;
HeatBalanceAlgorithm,ConductionTransferFunction;
SimulationControl,No,No,No,No,Yes;
RunPeriod,days,{begin},,{end},,Sunday,No,No,No,No,No;
Site:Location,Chicago,41.98,-87.92,-6,201;
GlobalGeometryRules,UpperLeftCorner,CounterClockWise,World;
ShadowCalculation,PolygonClipping,Periodic,1;
Material,concrete,MediumRough,0.15,1.4,2200,900,0.9,0.7,0.7;
Material,insulation,MediumRough,0.10,0.04,30,1200,0.9,0.7,0.7;
Material,board,MediumSmooth,0.0125,0.25,900,1000,0.9,0.3,0.3;
Construction,wall,concrete,insulation,board;
Construction,slab,insulation,concrete;
Construction,glazing,glass;
ScheduleTypeLimits,any;
Schedule:Constant,on,any,1;
Schedule:Compact,night,any,Through: 12/31,For: AllDays,Until: 7:00,1,Until: 20:00,0,Until: 24:00,1;
Schedule:Compact,limit,any,Through: 12/31,For: AllDays,Until: 12:00,21,Until: 24:00,25;
Schedule:Constant,heat20,any,20;
Schedule:Constant,cool26,any,26;
Schedule:Constant,dual,any,4;
Zone,room,0,0,0,0,1,1,autocalculate,autocalculate;
BuildingSurface:Detailed,N,Wall,wall,room,,Outdoors,,SunExposed,WindExposed,,4,5,5,3,5,5,0,0,5,0,0,5,3;
BuildingSurface:Detailed,E,Wall,wall,room,,Outdoors,,SunExposed,WindExposed,,4,5,0,3,5,0,0,5,5,0,5,5,3;
BuildingSurface:Detailed,S,Wall,wall,room,,Outdoors,,SunExposed,WindExposed,,4,0,0,3,0,0,0,5,0,0,5,0,3;
BuildingSurface:Detailed,W,Wall,wall,room,,Outdoors,,SunExposed,WindExposed,,4,0,5,3,0,5,0,0,0,0,0,0,3;
BuildingSurface:Detailed,F,Floor,slab,room,,Adiabatic,,NoSun,NoWind,,4,0,0,0,0,5,0,5,5,0,5,0,0;
BuildingSurface:Detailed,R,Roof,wall,room,,Outdoors,,SunExposed,WindExposed,,4,0,5,3,0,0,3,5,0,3,5,5,3;
FenestrationSurface:Detailed,pane,Window,glazing,S,,,,1,4,1,0,2.2,1,0,0.8,4,0,0.8,4,0,2.2;
ElectricEquipment,equipment,room,on,EquipmentLevel,{power},,,0,0,0;
Output:Variable,*,Zone Mean Air Temperature,hourly;
"""
_GLASS: Final = "WindowMaterial:SimpleGlazingSystem,glass,2.0,0.5;\n"
_LEAK: Final = "ZoneInfiltration:DesignFlowRate,leak,room,on,AirChanges/Hour,,,,0.5,1,0,0,0;\n"
_STAT: Final = (
    "ZoneControl:Thermostat,stat,room,dual,ThermostatSetpoint:DualSetpoint,set;\n"
    "ThermostatSetpoint:DualSetpoint,set,heat20,cool26;\n"
)
_NETWORK: Final = (
    "AirflowNetwork:SimulationControl,n,MultizoneWithoutDistribution,SurfaceAverageCalculation,OpeningHeight,"
    "LowRise,500,ZeroNodePressures,1e-5,1e-6,-0.5,0,1;\n"
    "AirflowNetwork:MultiZone:Surface:Crack,crack,0.01,0.65;\n"
    + "".join(f"AirflowNetwork:MultiZone:Surface,{wall},crack,,1;\n" for wall in "NESW")
)
_OPENING: Final = (
    "AirflowNetwork:MultiZone:Component:SimpleOpening,simple,0.001,0.65,0.01,0.6;\n"
    "AirflowNetwork:MultiZone:Surface,pane,simple,,0.2;\n"
)
_WINTER, _SUMMER = ("1,8,,1,14", "7,8,,7,14")
_VENT: Final = "ZoneVentilation:DesignFlowRate,vent,room"


def _room(days: str, *parts: str, power: int = 500, glass: str = _GLASS) -> str:
    begin, end = days.split(",,")
    return _ROOM.format(begin=begin, end=end, power=power) + glass + "".join(parts)


#: Files by name, and the largest rms difference of the air temperature that is due to the programs [K].
FLOWS: Final[dict[str, tuple[str, float]]] = {
    "density_winter": (_room(_WINTER, _LEAK), 0.25),
    "density_hot_room": (_room(_SUMMER, _LEAK, power=1200), 0.25),
    "wind_and_square_by_schedule": (
        _room(
            _WINTER,
            "ZoneInfiltration:DesignFlowRate,leak,room,night,AirChanges/Hour,,,,1.5,0,0,0.224,0.01;\n",
        ),
        0.2,
    ),
    "leakage_area": (
        _room(_WINTER, "ZoneInfiltration:EffectiveLeakageArea,leak,room,on,200,0.000145,0.000174;\n"),
        0.15,
    ),
    "leakage_area_by_schedule": (
        _room(_WINTER, "ZoneInfiltration:EffectiveLeakageArea,leak,room,night,300,0.000145,0.000174;\n"),
        0.25,
    ),
    "flow_coefficient": (
        _room(_WINTER, "ZoneInfiltration:FlowCoefficient,leak,room,on,0.05,0.0784,0.67,0.128,0.5;\n"),
        0.25,
    ),
    "indoor_and_difference": (
        _room(_SUMMER, _LEAK, f"{_VENT},on,AirChanges/Hour,,,,3,Natural,0,1,1,0,0,0,22,,100,,2;\n"),
        0.4,
    ),
    "upper_limits_and_wind": (
        _room(
            _SUMMER,
            _LEAK,
            f"{_VENT},night,AirChanges/Hour,,,,3,Natural,0,1,1,0,0,0,20,,33,,-100,,5,,22,,6;\n",
            power=100,
        ),
        0.4,
    ),
    "limit_by_schedule": (
        _room(_SUMMER, _LEAK, f"{_VENT},on,AirChanges/Hour,,,,3,Natural,0,1,1,0,0,0,,limit,100,,0;\n"),
        0.5,
    ),
    "open_area": (
        _room(
            _SUMMER,
            _LEAK,
            "ZoneVentilation:WindandStackOpenArea,open,room,0.05,on,0.5,180,1,0.6,22,,100,,1;\n",
        ),
        0.5,
    ),
    "network_of_cracks": (
        _room(_WINTER, _NETWORK, "AirflowNetwork:MultiZone:Zone,room,NoVent;\n"),
        0.2,
    ),
    "network_at_night": (
        _room(
            _SUMMER,
            _NETWORK,
            _OPENING,
            "AirflowNetwork:MultiZone:Zone,room,Constant,,0,0,100,0,300000,night;\n",
        ),
        0.4,
    ),
    "network_by_temperature": (
        _room(
            _SUMMER,
            _NETWORK,
            _OPENING,
            "AirflowNetwork:MultiZone:Zone,room,Temperature,cool26,0,0,100,0,300000;\n",
        ),
        0.6,
    ),
    "network_with_a_given_flow": (
        _room(
            _WINTER,
            _NETWORK,
            "AirflowNetwork:MultiZone:Zone,room,NoVent;\n",
            "AirflowNetwork:MultiZone:SpecifiedFlowRate,hood,0.03,MassFlow;\n",
            "AirflowNetwork:MultiZone:Surface,R,hood,,1;\n",
        ),
        0.25,
    ),
    "network_with_a_given_supply": (
        _room(
            _SUMMER,
            _NETWORK,
            "AirflowNetwork:MultiZone:Zone,room,NoVent;\n",
            "AirflowNetwork:MultiZone:SpecifiedFlowRate,blower,-0.04,VolumetricFlow;\n",
            "AirflowNetwork:MultiZone:Surface,R,blower,,1;\n",
        ),
        0.25,
    ),
    "network_with_an_exhaust_fan": (
        _room(
            _SUMMER,
            _NETWORK,
            _STAT,
            "AirflowNetwork:MultiZone:Zone,room,NoVent;\n",
            "AirflowNetwork:MultiZone:Component:ZoneExhaustFan,fan,0.002,0.65;\n",
            "AirflowNetwork:MultiZone:Surface,R,fan,,1;\n",
            "ZoneHVAC:EquipmentConnections,room,list,,ex,air,out;\n",
            "ZoneHVAC:EquipmentList,list,SequentialLoad,Fan:ZoneExhaust,fan,1,1;\n",
            "Fan:ZoneExhaust,fan,night,0.6,125,0.05,ex,exhaust out;\n",
        ),
        0.35,
    ),
    "single_pane": (
        _room(_SUMMER, _LEAK, glass="WindowMaterial:SimpleGlazingSystem,glass,5.7,0.8;\n"),
        0.3,
    ),
    "low_gain": (
        _room(_SUMMER, _LEAK, glass="WindowMaterial:SimpleGlazingSystem,glass,1.5,0.28;\n"),
        0.4,
    ),
    "baseboard": (
        _room(
            _WINTER,
            _LEAK,
            _STAT,
            "ZoneHVAC:EquipmentConnections,room,list,,,air,out;\n",
            "ZoneHVAC:EquipmentList,list,SequentialLoad,ZoneHVAC:Baseboard:Convective:Electric,bb,1,1;\n",
            "ZoneHVAC:Baseboard:Convective:Electric,bb,on,HeatingDesignCapacity,1500,,,1;\n",
            power=100,
        ),
        0.2,
    ),
    "exhaust_fan": (
        _room(
            _SUMMER,
            _LEAK,
            _STAT,
            "ZoneHVAC:EquipmentConnections,room,list,,ex,air,out;\n",
            "ZoneHVAC:EquipmentList,list,SequentialLoad,Fan:ZoneExhaust,fan,1,1;\n",
            "Fan:ZoneExhaust,fan,on,0.6,125,0.02,ex,exhaust out;\n",
        ),
        0.35,
    ),
}
