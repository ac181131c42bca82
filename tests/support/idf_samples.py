"""A small model of EnergyPlus with most of what is converted: written for the tests."""

from __future__ import annotations

#: Two rooms: one heated and cooled, with a window, a phase-change layer, people and lights.
IDF = """\
! A model for tests.
Version,25.2;
Building,Two rooms,20,Suburbs,0.04,0.4,FullExterior,25,6;
GlobalGeometryRules,UpperLeftCorner,Counterclockwise,Relative;
Site:Location,Somewhere,40,-75,-5,100;
Site:GroundTemperature:BuildingSurface,18,18,18,18,18,18,18,18,18,18,18,18;
Timestep,4;
HeatBalanceAlgorithm,ConductionFiniteDifference;
RunPeriod,Year,1,1,,12,31,,Tuesday,Yes,Yes,No,Yes,Yes;
Material,Brick,Rough,0.2,0.8,1800,900,0.9,0.7,0.7;
Material,Board,MediumSmooth,0.012,0.25,900,1000;  !- the inside
Material:NoMass,Wool,Rough,2.0,0.9,0.7,0.7;
MaterialProperty:PhaseChange,Board,0,
  -20,0,     !- temperature and enthalpy
  23,43000,
  26,90000,
  60,124000;
WindowMaterial:SimpleGlazingSystem,Pane,2.7,0.6;
Construction,Wall,Brick,Wool,Board;
Construction,Slab,Brick;
Construction,Glass,Pane;
Zone,Room,0,0,0,0,1,1,3,60;
Zone,Store,0,0,5,0,1,1,3,36;
BuildingSurface:Detailed,South,Wall,Wall,Room,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  0,0,3, 0,0,0, 4,0,0, 4,0,3;
BuildingSurface:Detailed,East,Wall,Wall,Room,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  4,0,3, 4,0,0, 4,5,0, 4,5,3;
BuildingSurface:Detailed,West,Wall,Wall,Room,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  0,5,3, 0,5,0, 0,0,0, 0,0,3;
BuildingSurface:Detailed,Roof,Roof,Wall,Room,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  0,5,3, 0,0,3, 4,0,3, 4,5,3;
BuildingSurface:Detailed,Floor,Floor,Slab,Room,,Ground,,NoSun,NoWind,autocalculate,4,
  0,0,0, 0,5,0, 4,5,0, 4,0,0;
BuildingSurface:Detailed,Between,Wall,Slab,Room,,Surface,Behind,NoSun,NoWind,autocalculate,4,
  4,5,3, 4,5,0, 0,5,0, 0,5,3;
BuildingSurface:Detailed,Behind,Wall,Slab,Store,,Surface,Between,NoSun,NoWind,autocalculate,4,
  0,0,3, 0,0,0, 4,0,0, 4,0,3;
BuildingSurface:Detailed,Back,Wall,Wall,Store,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  4,3,3, 4,3,0, 0,3,0, 0,3,3;
FenestrationSurface:Detailed,Window,Window,Glass,South,,autocalculate,,1,4,
  1,0,2, 1,0,1, 3,0,1, 3,0,2;
Shading:Zone:Detailed,Overhang,South,,4,
  0,-1,3, 0,0,3, 4,0,3, 4,-1,3;
ScheduleTypeLimits,Any;
Schedule:Constant,Always,Any,1;
Schedule:Compact,Used,Any,
  Through: 12/31,
  For: Weekdays, Until: 8:00,0, Until: 18:00,1, Until: 24:00,0,
  For: AllOtherDays, Until: 24:00,0.1;
Schedule:Constant,Warm,Any,20;
Schedule:Constant,Cool,Any,26;
Schedule:Constant,Activity,Any,120;
People,Workers,Room,Used,People,2,,,0.3,,Activity;
Lights,Lamps,Room,Used,Watts/Area,,8,,0,0.4,0.2,0;
ElectricEquipment,Devices,Room,Used,EquipmentLevel,150,,,0,0.3,0;
ZoneInfiltration:DesignFlowRate,Leaks,Room,Always,AirChanges/Hour,,,,0.5,0.6,0.036,0.12,0;
ZoneVentilation:DesignFlowRate,Fan,Store,Used,Flow/Zone,0.02,,,,Natural,0,1,1,0,0,0;
ZoneMixing,Door,Store,Always,Flow/Zone,0.01,,,,Room,0;
HVACTemplate:Thermostat,Held,Warm,,Cool,;
HVACTemplate:Zone:IdealLoadsAirSystem,Room,Held;
Output:Variable,*,Zone Mean Air Temperature,Hourly;
"""
