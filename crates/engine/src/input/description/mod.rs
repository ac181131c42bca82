//! The building as it crosses the border from the description language.
//!
//! Every number that a user may vary is a [`ParamId`]: an index into
//! [`Description::parameters`]. The engine reads no path and no file; it reads
//! values from a parameter vector, so that the same description serves one run,
//! an ensemble (one vector per member) and derivatives (a vector of duals).
//! What is a plain number, `usize`, `bool` or list here is structural: it shapes the plan.
//!
//! A module per object. `input/check` refuses what the engine cannot compute. A new field of type
//! [`ParamId`] has to be named in `input/parameter_walk.rs` too; the compiler asks for it.

mod air_flow;
mod construction;
mod convection;
mod glazing;
mod material;
mod phase_change;
mod site;
mod surface;
mod zone;

use serde::Deserialize;

pub use air_flow::{AirPath, Opening};
pub use construction::{Construction, Layer};
pub use convection::{Convection, PowerLaw};
pub use glazing::{Angular, Gap, Gas, Glazing, Pane, PaneOptics};
pub use material::Material;
pub use phase_change::{HysteresisModel, MeltingCurve, PcmLaw, TablePoints, Tail};
pub use site::{DiffuseSky, Site, Sky, WindProfile};
pub use surface::{Exposure, Facing, FrameShare, OutdoorLongwave, Sensor, Side, Surface};
pub use zone::{Gain, IdealLoad, Infiltration, SetPoint, Ventilation, Zone, ZoneLongwave, ZoneSun};

/// Index of a numeric leaf in [`Description::parameters`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(transparent)]
pub struct ParamId(pub u32);

/// A numeric leaf: its path in the user's description and its nominal value (SI, degC, deg).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Dotted path, e.g. `materials.energain.latent_heat`.
    pub path: String,
    /// Nominal value.
    pub value: f64,
}

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
    /// Openings between zones and outdoors.
    #[serde(default)]
    pub openings: Vec<Opening>,
    /// Walls and windows.
    pub surfaces: Vec<Surface>,
    /// Sensors inside walls.
    #[serde(default)]
    pub sensors: Vec<Sensor>,
    /// Corners of opaque thin polygons outdoors that shade [m].
    #[serde(default)]
    pub shades: Vec<Vec<[f64; 3]>>,
    /// Names of the forcing channels after the climate channels (measured temperatures, irradiances, schedules).
    #[serde(default)]
    pub channels: Vec<String>,
}
