//! A whole building.

use serde::Deserialize;

use super::air_flow::{AirPath, DirectedFlow, Door, Opening, VentilationUnit};
use super::bridge::ThermalBridge;
use super::construction::Construction;
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
    /// Sensors inside walls.
    #[serde(default)]
    pub sensors: Vec<Sensor>,
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
