"""Buildings: their parts as objects, YAML files, parameters by path, checks.

`Building` is made from the parts below, from a YAML file (`load`) or from a mapping. Parts refer to each
other by name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mascarin.building.base.number import Number
from mascarin.building.building import Building
from mascarin.building.checks.overview import check
from mascarin.building.engine_input import EngineDescription
from mascarin.building.engine_input.ratings import WindowRating, window_ratings
from mascarin.building.ground_floor import on_ground
from mascarin.building.ground_slab import EdgeInsulation, Soil
from mascarin.building.json_schemas import json_schema
from mascarin.building.outputs.output import Output
from mascarin.building.parameters.parameter import Parameter
from mascarin.building.parts.air.air_path import AirPath, Door, Opening
from mascarin.building.parts.air.humidity import (
    CoolingCoil,
    Humidistat,
    Humidity,
    SurfaceHumidity,
    VapourGain,
    ZoneHumidity,
)
from mascarin.building.parts.air.leakage import LEAKAGES, LeakageLaw
from mascarin.building.parts.air.schedule import (
    FractionDays,
    FractionPoint,
    FractionSchedule,
    HumidityRatioDays,
    HumidityRatioPoint,
    HumidityRatioSchedule,
    TemperatureDays,
    TemperaturePoint,
    TemperatureSchedule,
)
from mascarin.building.parts.air.set_point import SetPoint
from mascarin.building.parts.air.vent import (
    DifferenceBand,
    LowBand,
    LowRise,
    NoWind,
    PressureTable,
    RainBand,
    TemperatureBand,
    Vent,
    VentControl,
    WindBand,
)
from mascarin.building.parts.air.ventilation import UnitFlow, VentilationUnit
from mascarin.building.parts.air.zone import (
    EvenSun,
    FloorSun,
    Gain,
    GivenSun,
    IdealLoads,
    Infiltration,
    MassShares,
    StratifiedAir,
    SunShares,
    TextInfiltration,
    TracedSun,
    Ventilation,
    Zone,
)
from mascarin.building.parts.envelope.bridge import ThermalBridge
from mascarin.building.parts.envelope.convection import CLASSES, ConvectionLaw, Measured
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.building.parts.envelope.imposed import IMPOSED_LAWS, ImposedLaw
from mascarin.building.parts.envelope.surface import (
    Construction,
    Exposure,
    Ground,
    Layer,
    Side,
    Surface,
    WallSensor,
)
from mascarin.building.parts.materials.formula_curve import FormulaCurve
from mascarin.building.parts.materials.history_laws import Supercooling
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance, Solid, VariableSolid
from mascarin.building.parts.materials.phase_change import (
    CapacityLaw,
    FractionsLaw,
    GaussianLaw,
    GumbelLaw,
    Hysteresis,
    LinearLaw,
    SmoothStepLaw,
    TableLaw,
    TanhLaw,
    TriangleLaw,
)
from mascarin.building.parts.materials.sorption import SORPTIONS, Published, SorptionLaw, TabulatedSorption
from mascarin.building.parts.materials.text_law import ConductivityLaw, TextSky
from mascarin.building.parts.openings.blind import Blind
from mascarin.building.parts.openings.glazing import (
    Angular,
    DiffuseOptics,
    FilledGap,
    GivenGap,
    Pane,
    PaneGlazing,
    SimpleGlazing,
)
from mascarin.building.parts.openings.window import Frame, Shade, Window, WindowInside, WindowOutside
from mascarin.building.parts.site import (
    SKIES,
    CloudFactor,
    CloudLayer,
    Site,
    SkyLaw,
    Wind,
)
from mascarin.building.parts.soil_block import OutdoorsBefore, SoilBlock, SoilEdge
from mascarin.building.reading import load
from mascarin.building.tables import parameter_table
from mascarin.physics import moist_air

# The classes of the engine's table of laws are made when the package is imported; these lines tell type
# checkers of those that are shipped.
if TYPE_CHECKING:
    AlamdariHammond = ConvectionLaw
    Constant = ConvectionLaw
    Doe2 = ConvectionLaw
    Iso15099 = ConvectionLaw
    LinearWind = ConvectionLaw
    Mowitt = ConvectionLaw
    Guichard2016Eq5 = ConvectionLaw
    Power = ConvectionLaw
    PowerLaw = ConvectionLaw
    Tarp = ConvectionLaw
    BruntSky = SkyLaw
    ClarkAllenSky = SkyLaw
    MartinBerdahlSky = SkyLaw
    MeasuredSky = SkyLaw
    OffsetSky = SkyLaw
    LeakageFactor = LeakageLaw
    LeakageStackWind = LeakageLaw
    LinearSorption = SorptionLaw
    ImposedSoil = ImposedLaw

__all__ = [
    "AirPath",
    "AlamdariHammond",
    "Angular",
    "Blind",
    "Building",
    "CapacityLaw",
    "CloudFactor",
    "CloudLayer",
    "ConductivityLaw",
    "Constant",
    "Construction",
    "CoolingCoil",
    "DifferenceBand",
    "DiffuseOptics",
    "Doe2",
    "Door",
    "EdgeInsulation",
    "EngineDescription",
    "EvenSun",
    "Exposure",
    "FilledGap",
    "FloorSun",
    "FormulaCurve",
    "FormulaLaw",
    "FractionDays",
    "FractionPoint",
    "FractionSchedule",
    "FractionsLaw",
    "Frame",
    "Gain",
    "GaussianLaw",
    "GivenGap",
    "GivenSun",
    "Ground",
    "Guichard2016Eq5",
    "GumbelLaw",
    "Humidistat",
    "Humidity",
    "HumidityRatioDays",
    "HumidityRatioPoint",
    "HumidityRatioSchedule",
    "Hysteresis",
    "IdealLoads",
    "ImposedLaw",
    "Infiltration",
    "Iso15099",
    "Layer",
    "LeakageLaw",
    "LinearLaw",
    "LinearWind",
    "LowBand",
    "LowRise",
    "MassShares",
    "Measured",
    "Mowitt",
    "NoWind",
    "Number",
    "Opening",
    "OutdoorsBefore",
    "Output",
    "Pane",
    "PaneGlazing",
    "Parameter",
    "PhaseChangeMaterial",
    "Power",
    "PowerLaw",
    "PressureTable",
    "Published",
    "RainBand",
    "Resistance",
    "SetPoint",
    "Shade",
    "Side",
    "SimpleGlazing",
    "Site",
    "SkyLaw",
    "SmoothStepLaw",
    "Soil",
    "SoilBlock",
    "SoilEdge",
    "Solid",
    "SorptionLaw",
    "StratifiedAir",
    "SunShares",
    "Supercooling",
    "Surface",
    "SurfaceHumidity",
    "TableLaw",
    "TabulatedSorption",
    "TanhLaw",
    "Tarp",
    "TemperatureBand",
    "TemperatureDays",
    "TemperaturePoint",
    "TemperatureSchedule",
    "TextInfiltration",
    "TextSky",
    "ThermalBridge",
    "TracedSun",
    "TriangleLaw",
    "UnitFlow",
    "VapourGain",
    "VariableSolid",
    "Vent",
    "VentControl",
    "Ventilation",
    "VentilationUnit",
    "WallSensor",
    "Wind",
    "WindBand",
    "Window",
    "WindowInside",
    "WindowOutside",
    "WindowRating",
    "Zone",
    "ZoneHumidity",
    "check",
    "json_schema",
    "load",
    "moist_air",
    "on_ground",
    "parameter_table",
    "window_ratings",
]
# Every law of the engine's tables.
_LAWS = {**CLASSES, **SKIES, **LEAKAGES, **SORPTIONS, **IMPOSED_LAWS}
globals().update(_LAWS)
__all__ += [name for name in _LAWS if name not in __all__]


def __dir__() -> list[str]:
    return __all__
