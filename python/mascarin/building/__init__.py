"""Buildings: their parts as objects, YAML files, parameters by path, checks.

`Building` is made from the parts below, from a YAML file (`load`) or from a mapping. Parts refer to each
other by name.
"""

from __future__ import annotations

from mascarin.building.blind import Blind
from mascarin.building.bridge import ThermalBridge
from mascarin.building.building import Building
from mascarin.building.checks import check
from mascarin.building.convection import (
    CLASSES,
    AlamdariHammond,
    Constant,
    Doe2,
    Iso15099,
    LinearWind,
    Measured,
    Mowitt,
    PaperEq5,
    Power,
    PowerLaw,
    Tarp,
)
from mascarin.building.engine_input import EngineDescription
from mascarin.building.formula_curve import FormulaCurve
from mascarin.building.formula_law import FormulaLaw
from mascarin.building.glazing import (
    Angular,
    DiffuseOptics,
    FilledGap,
    GivenGap,
    Pane,
    PaneGlazing,
    SimpleGlazing,
)
from mascarin.building.ground_floor import on_ground
from mascarin.building.humidity import (
    CoolingCoil,
    Humidistat,
    Humidity,
    SurfaceHumidity,
    VapourGain,
    ZoneHumidity,
)
from mascarin.building.json_schemas import json_schema
from mascarin.building.leakage import LeakageFactor, LeakageStackWind
from mascarin.building.material import PhaseChangeMaterial, Resistance, Solid
from mascarin.building.number import Number
from mascarin.building.outputs import Output
from mascarin.building.parameters import Parameter
from mascarin.building.phase_change import (
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
from mascarin.building.ratings import WindowRating, window_ratings
from mascarin.building.reading import load
from mascarin.building.schedule import (
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
from mascarin.building.set_point import SetPoint
from mascarin.building.site import (
    BruntSky,
    ClarkAllenSky,
    CloudFactor,
    CloudLayer,
    MartinBerdahlSky,
    MeasuredSky,
    OffsetSky,
    Site,
    Wind,
)
from mascarin.building.sorption import LinearSorption, Published, TabulatedSorption
from mascarin.building.surface import Construction, Exposure, Ground, Layer, Sensor, Side, Surface
from mascarin.building.tables import parameter_table
from mascarin.building.vent import (
    DifferenceBand,
    LowRise,
    NoWind,
    PressureTable,
    RainBand,
    TemperatureBand,
    Vent,
    VentControl,
    WindBand,
)
from mascarin.building.ventilation import UnitFlow, VentilationUnit
from mascarin.building.window import Frame, Shade, Window, WindowInside, WindowOutside
from mascarin.building.zone import (
    AirPath,
    Door,
    EvenSun,
    FloorSun,
    Gain,
    GivenSun,
    IdealLoads,
    Infiltration,
    Opening,
    SunShares,
    TracedSun,
    Ventilation,
    Zone,
)
from mascarin.physics import moist_air

__all__ = [
    "AirPath",
    "AlamdariHammond",
    "Angular",
    "Blind",
    "BruntSky",
    "Building",
    "CapacityLaw",
    "ClarkAllenSky",
    "CloudFactor",
    "CloudLayer",
    "Constant",
    "Construction",
    "CoolingCoil",
    "DifferenceBand",
    "DiffuseOptics",
    "Doe2",
    "Door",
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
    "GumbelLaw",
    "Humidistat",
    "Humidity",
    "HumidityRatioDays",
    "HumidityRatioPoint",
    "HumidityRatioSchedule",
    "Hysteresis",
    "IdealLoads",
    "Infiltration",
    "Iso15099",
    "Layer",
    "LeakageFactor",
    "LeakageStackWind",
    "LinearLaw",
    "LinearSorption",
    "LinearWind",
    "LowRise",
    "MartinBerdahlSky",
    "Measured",
    "MeasuredSky",
    "Mowitt",
    "NoWind",
    "Number",
    "OffsetSky",
    "Opening",
    "Output",
    "Pane",
    "PaneGlazing",
    "PaperEq5",
    "Parameter",
    "PhaseChangeMaterial",
    "Power",
    "PowerLaw",
    "PressureTable",
    "Published",
    "RainBand",
    "Resistance",
    "Sensor",
    "SetPoint",
    "Shade",
    "Side",
    "SimpleGlazing",
    "Site",
    "SmoothStepLaw",
    "Solid",
    "SunShares",
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
    "ThermalBridge",
    "TracedSun",
    "TriangleLaw",
    "UnitFlow",
    "VapourGain",
    "Vent",
    "VentControl",
    "Ventilation",
    "VentilationUnit",
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
# Every law of the engine's table, those that are not named above too.
globals().update(CLASSES)
__all__ += [name for name in CLASSES if name not in __all__]


def __dir__() -> list[str]:
    return __all__
