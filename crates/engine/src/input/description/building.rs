//! A whole building.

use serde::Deserialize;

use super::air_flow::{AirPath, DirectedFlow, Door, Opening, VentilationUnit};
use super::bridge::ThermalBridge;
use super::construction::Construction;
use super::convection::TextLaw;
use super::heat_source::HeatSource;
use super::humidity::Humidity;
use super::material::Material;
use super::parameter::Parameter;
use super::site::Site;
use super::surface::{Sensor, Surface};
use super::vent::{Vent, VentControl};
use super::zone::Zone;

/// A whole building: references between its parts are indices into the lists.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// All numeric leaves, in the order of their ids.
    pub parameters: Vec<Parameter>,
    /// Site.
    pub site: Site,
    /// Materials.
    pub materials: Vec<Material>,
    /// Constructions.
    pub constructions: Vec<Construction>,
    /// Air zones.
    pub zones: Vec<Zone>,
    /// Air exchanged between zones.
    #[serde(default)]
    pub air_paths: Vec<AirPath>,
    /// Air that flows from zone to zone.
    #[serde(default)]
    pub directed_flows: Vec<DirectedFlow>,
    /// Doors between zones.
    #[serde(default)]
    pub doors: Vec<Door>,
    /// Mechanical ventilation.
    #[serde(default)]
    pub ventilation_units: Vec<VentilationUnit>,
    /// Thermal bridges.
    #[serde(default)]
    pub thermal_bridges: Vec<ThermalBridge>,
    /// Openings between zones and outdoors.
    #[serde(default)]
    pub openings: Vec<Opening>,
    /// Openings of the pressure network.
    #[serde(default)]
    pub vents: Vec<Vent>,
    /// What opens and closes openings of both kinds.
    #[serde(default)]
    pub controls: Vec<VentControl>,
    /// Walls and windows.
    pub surfaces: Vec<Surface>,
    /// Heat released between layers of walls.
    #[serde(default)]
    pub heat_sources: Vec<HeatSource>,
    /// Sensors inside walls.
    #[serde(default)]
    pub sensors: Vec<Sensor>,
    /// Outputs that are derived from others.
    #[serde(default)]
    pub outputs: Vec<DerivedOutput>,
    /// Vapour balance of the zones. None: air without vapour.
    #[serde(default)]
    pub humidity: Option<Humidity>,
    /// Corners of opaque thin polygons outdoors that shade [m].
    #[serde(default)]
    pub shades: Vec<Vec<[f64; 3]>>,
    /// Names of the forcing channels after the climate channels (measured temperatures, irradiances, schedules).
    #[serde(default)]
    pub channels: Vec<String>,
}

/// An output that is derived from others.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DerivedOutput {
    /// Name in messages.
    pub name: String,
    /// Its formula.
    pub law: TextLaw,
    /// The outputs that the formula uses.
    pub of: Vec<UsedOutput>,
}

/// An output by its name in a formula.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UsedOutput {
    /// Name in the formula.
    pub name: String,
    /// Kind in the table of outputs (`run/outputs`).
    pub kind: String,
    /// Where it is read.
    #[serde(default)]
    pub place: OutputPlace,
}

/// Positions of an output in the description; those that it does not use are zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(missing_docs, reason = "each is the position of what its name says")]
pub struct OutputPlace {
    pub zone: usize,
    pub surface: usize,
    pub side: usize,
    pub layer: usize,
    pub interface: usize,
    pub vent: usize,
    pub control: usize,
    pub source: usize,
    pub sensor: usize,
    pub derived: usize,
}
