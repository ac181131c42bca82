"""The sections of a building, without its checks and methods, for the modules that these are made of."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Literal

from pydantic import Field, WithJsonSchema

from mascarin.building.base.dimensions import Dimensions
from mascarin.building.base.names import Name
from mascarin.building.base.part import Part, Shorthand
from mascarin.building.parts.air.air_path import AirPath, Opening
from mascarin.building.parts.air.humidity import Humidity
from mascarin.building.parts.air.schedule import Schedule
from mascarin.building.parts.air.vent import Vent, VentControl
from mascarin.building.parts.air.ventilation import VentilationUnit
from mascarin.building.parts.air.zone import Zone
from mascarin.building.parts.derived_output import DerivedOutput
from mascarin.building.parts.envelope.surface import Construction, Surface, WallSensor
from mascarin.building.parts.heat_source import HeatSource
from mascarin.building.parts.materials.material import Material
from mascarin.building.parts.openings.glazing import Glazing
from mascarin.building.parts.openings.window import Shade, Window
from mascarin.building.parts.posterior import Posterior
from mascarin.building.parts.site import Site
from mascarin.building.parts.soil_block import SoilBlock
from mascarin.building.parts.weather import Weather
from mascarin.building.parts.zone_surfaces import Connections


class Description(Part):
    """The sections of a building."""

    name: str = Field("building", description="Name of the building, the title of its results")
    site: Site = Field(description="Site of the building")
    weather: Weather | None = Field(
        None, description="Gain, offset and clock of columns of the weather; none: as it was read"
    )
    dimensions: Annotated[Dimensions, Shorthand(word="areas")] | None = Field(
        None,
        description="Dimensions of the areas (a word) and of the thermal bridges; none: not stated",
    )
    materials: dict[Name, Material] = Field(default_factory=dict, description="Materials by name")
    constructions: dict[Name, Construction] = Field(
        default_factory=dict, description="Layered constructions by name"
    )
    schedules: dict[Name, Schedule] = Field(default_factory=dict, description="Schedules by name")
    zones: dict[Name, Zone] = Field(default_factory=dict, description="Air zones by name")
    air_paths: dict[Name, AirPath] = Field(default_factory=dict, description="Air between zones, by name")
    ventilation_units: dict[Name, VentilationUnit] = Field(
        default_factory=dict, description="Mechanical ventilation, by name"
    )
    humidity: Humidity | None = Field(None, description="Humidity of the air; none: air without vapour")
    openings: dict[Name, Opening] = Field(
        default_factory=dict, description="Openings between zones and outdoors, by name"
    )
    vents: dict[Name, Vent] = Field(
        default_factory=dict, description="Openings of the pressure network of wind and stack, by name"
    )
    controls: dict[Name, VentControl] = Field(
        default_factory=dict, description="What opens and closes openings and vents, by name"
    )
    surfaces: dict[Name, Surface] = Field(
        default_factory=dict, description="Walls, roofs, floors, doors by name"
    )
    glazings: dict[Name, Glazing] = Field(default_factory=dict, description="Glazings by name")
    windows: dict[Name, Window] = Field(default_factory=dict, description="Windows in the surfaces by name")
    shades: dict[Name, Shade] = Field(
        default_factory=dict, description="Overhangs, fins and other opaque screens outdoors by name"
    )
    heat_sources: dict[Name, HeatSource] = Field(
        default_factory=dict, description="Heat released between layers of surfaces, by name"
    )
    soil_blocks: dict[Name, SoilBlock] = Field(
        default_factory=dict, description="Soil beneath and around floors and basements, by name"
    )
    sensors: dict[Name, WallSensor] = Field(
        default_factory=dict, description="Thermometers inside walls by name"
    )
    derived_outputs: dict[Name, DerivedOutput] = Field(
        default_factory=dict, description="Outputs that follow from others by a formula, by name"
    )
    ties: dict[str, Literal["factor", "value"]] = Field(
        default_factory=dict,
        description="Path with * -> how all numbers that it matches vary as one parameter of that path: by a "
        "common factor, or by a common value",
    )
    posterior: Annotated[Posterior | None, WithJsonSchema({"type": "object"})] = Field(
        None, description="What a calibration found, as a study has written it; for bands of a comparison"
    )

    @cached_property
    def connections(self) -> Connections:
        """Which surfaces and windows belong to which zone and wall."""
        return Connections(self.surfaces, self.windows)
