"""Every feature of a building in a model of EnergyPlus: it is converted, or what is left out is named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

import pytest

from crossing_features import FEATURES
from idf_samples import IDF
from mascarin.building import Building
from mascarin.building.reading import parse
from mascarin.energyplus import convert, yaml_text


class Objects(NamedTuple):
    """Objects of EnergyPlus for a feature.

    Attributes
    ----------
    text : str
        What is added to the model of `idf_samples`.
    has : callable
        Whether a building has the feature; None where the objects are left out.
    named : str
        Class that a finding names where the objects are left out.
    """

    text: str
    has: Callable[[Building], bool] | None
    named: str = ""


_HYSTERESIS = """
Material,Lining,MediumSmooth,0.012,0.25,900,1000;
MaterialProperty:PhaseChangeHysteresis,Lining,20000,0.25,900,1000,1,23,1,0.25,900,1000,1,20,1;
Construction,Melting,Brick,Lining;
BuildingSurface:Detailed,Side,Wall,Melting,Store,,Outdoors,,SunExposed,WindExposed,autocalculate,4,
  4,0,3, 4,0,0, 4,3,0, 4,3,3;
"""
_BLIND = """
WindowMaterial:Shade,Roller,0.1,0.6,0.1,0.6,0.9,0,0.003,0.1,0.05,0.5,0.5,0.5,0.5,0;
WindowShadingControl,Noon,Room,1,ExteriorShade,,AlwaysOn,,,No,No,Roller,FixedSlatAngle,,,,,Sequential,Window;
"""
_NETWORK = """
AirflowNetwork:SimulationControl,Network,MultizoneWithoutDistribution,SurfaceAverageCalculation;
AirflowNetwork:MultiZone:Zone,Room,Temperature,Warm,0,0,100,0,300000;
AirflowNetwork:MultiZone:Surface:Crack,Crack,0.01,0.65;
AirflowNetwork:MultiZone:Component:SimpleOpening,Casement,0.001,0.65,0.01,0.6;
AirflowNetwork:MultiZone:Surface,East,Crack,,1;
AirflowNetwork:MultiZone:Surface,Between,Crack,,1;
AirflowNetwork:MultiZone:Surface,Window,Casement,,0.3;
"""
_GIVEN_FLOW = (
    f"{_NETWORK}AirflowNetwork:MultiZone:SpecifiedFlowRate,Hood,0.02,MassFlow;\n"
    "AirflowNetwork:MultiZone:Surface,Back,Hood,,1;\n"
)
_INNER = (
    "FenestrationSurface:Detailed,Hatch,Window,Glass,Between,,autocalculate,,1,4, 3,5,2, 3,5,1, 1,5,1, 1,5,2;"
)
#: The second one has another schedule than the first, which is the infiltration of the zone.
_STACK = """
ZoneVentilation:WindandStackOpenArea,Slit,Store,0.1,Always,autocalculate,0,1,autocalculate;
ZoneVentilation:WindandStackOpenArea,Flap,Store,0.1,Used,autocalculate,0,1,autocalculate;
"""
_LOGGED = (
    "Schedule:File,Logged,Any,logged.csv,2,1,8760,Comma,No,60;\nLights,Lamp,Store,Logged,LightingLevel,50;"
)

_MAT = """
ConstructionProperty:InternalHeatSource,Plane,Wall,1,1,1,0.2;
ZoneHVAC:LowTemperatureRadiant:Electric,Mat,,Store,Back,HeatingDesignCapacity,300,,,MeanAirTemperature,
  HalfFlowPower,1,Warm;
ZoneHVAC:EquipmentConnections,Store,Store list,,,Store node,;
ZoneHVAC:EquipmentList,Store list,SequentialLoad,ZoneHVAC:LowTemperatureRadiant:Electric,Mat,1,1,,;
"""

_SKIN = """
SurfaceProperty:HeatTransferAlgorithm,Back,MoisturePenetrationDepthConductionTransferFunction;
MaterialProperty:MoisturePenetrationDepth:Settings,Brick,6,0.0068,0.939,0.0202,12.2,0.004,0.008,0.0001,500;
"""
_KIVA = """
Foundation:Kiva,Pad,20,,,,,,,,0.3;
BuildingSurface:Detailed,Ground,Floor,Wall,Store,,Foundation,Pad,NoSun,NoWind,autocalculate,4,
  4,3,0, 6,3,0, 6,0,0, 4,0,0;
"""

_PATTERN = """
RoomAirModelType,Model,Store,UserDefined,DIRECT;
RoomAir:TemperaturePattern:UserDefined,Pattern,Store,Always,Numbers;
Schedule:Constant,Numbers,Any,1;
RoomAir:TemperaturePattern:ConstantGradient,Gradient,1,0,0,0,1.5;
"""

#: By feature: objects, and whether the building has it.
OBJECTS: Final[dict[str, Objects]] = {
    "nothing": Objects("", lambda one: len(one.zones) == 2),
    "own curves": Objects("", lambda one: any(m.kind == "pcm" for m in one.materials.values())),
    "hysteresis": Objects(
        _HYSTERESIS, lambda one: any(getattr(m, "hysteresis", None) for m in one.materials.values())
    ),
    "vents": Objects(_NETWORK, lambda one: len(one.vents) == 4),
    "fans in vents": Objects(_GIVEN_FLOW, lambda one: one.zones["Store"].makeup_air == "vents"),
    "controls": Objects(_NETWORK, lambda one: len(one.controls) == 1),
    "boundaries and densities": Objects(
        "", lambda one: getattr(one.zones["Room"].infiltration.density, "kind", "") == "outdoors"
    ),
    "laws as text": Objects(
        "ZoneInfiltration:FlowCoefficient,Test,Store,Always,0.05,0.0784,0.67,0.128,0.5;",
        lambda one: "abs(dT)^0.67" in getattr(one.zones["Store"].infiltration, "formula", ""),
    ),
    "openings": Objects(_STACK, lambda one: bool(one.openings)),
    "blinds": Objects(_BLIND, lambda one: any(window.blind for window in one.windows.values())),
    "loads": Objects("", lambda one: any(zone.loads for zone in one.zones.values())),
    "interior windows": Objects(_INNER, lambda one: len(one.windows) == 2),
    "measured columns": Objects(_LOGGED, lambda one: "Lamp" in one.zones["Store"].gains),
    "mechanical air": Objects("", lambda one: bool(one.air_paths)),
    "shades": Objects("", lambda one: bool(one.shades)),
    "heat sources": Objects(_MAT, lambda one: len(one.heat_sources) == 1),
    "humidity": Objects(_SKIN, lambda one: one.humidity is not None),
    "soil": Objects(_KIVA, None, "Foundation:Kiva"),
    "stratified air": Objects(_PATTERN, None, "RoomAirModelType"),
}
#: Features that a model of EnergyPlus cannot have, with the reason.
WITHOUT_OBJECTS: Final = {
    "products": "the catalogue belongs to Mascarin",
    "thermal bridges": "EnergyPlus has no object for them",
    "supercooling": "hysteresis of EnergyPlus has two curves, and no nucleation",
    "sensors and ties": "outputs inside walls belong to nodes, and numbers are not tied",
    "derived outputs": "what follows from outputs is not part of a model of EnergyPlus",
    "weather errors": "a weather file of EnergyPlus is taken to be right",
    "column errors": "a weather file of EnergyPlus is taken to be right",
    "posterior": "only a study of Mascarin writes one",
}


def test_every_feature_is_crossed_with_the_conversion() -> None:
    missing = sorted(set(FEATURES) - set(OBJECTS) - set(WITHOUT_OBJECTS))
    assert missing == [], (
        f"features that are not crossed with 'mascarin convert': {missing}. Enter their objects of EnergyPlus"
        " in OBJECTS of test_crossing_convert.py, or the reason why there are none in WITHOUT_OBJECTS"
    )


@pytest.mark.parametrize("feature", list(OBJECTS))
def test_a_feature_is_converted_or_named(feature: str, tmp_path: Path) -> None:
    file, objects = tmp_path / "model.idf", OBJECTS[feature]
    file.write_text(IDF + objects.text, encoding="utf-8")
    (tmp_path / "logged.csv").write_text("hour,value\n" + "".join(f"{h},0.5\n" for h in range(8760)))
    conversion = convert(file)
    left = [f"{finding.kind} {finding.name}: {finding.what}" for finding in conversion.findings]
    if objects.has is None:
        assert any(objects.named in line for line in left), left
    else:
        assert objects.has(conversion.building), left
    assert parse(yaml_text(conversion), "model.yaml") == conversion.building
    assert conversion.building.check()
