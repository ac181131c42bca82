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
mod bridge;
mod building;
mod construction;
mod convection;
mod flow_density;
mod glazing;
mod heat_source;
mod humidity;
mod material;
mod parameter;
mod phase_change;
mod published_law;
mod site;
mod surface;
mod vent;
mod zone;

pub use air_flow::{AirPath, DirectedFlow, Door, Opening, UnitFlow, VentilationUnit};
pub use bridge::ThermalBridge;
pub use building::{DerivedOutput, Description, OutputPlace, UsedOutput};
pub use construction::{Construction, Layer};
pub use convection::{Convection, FormulaNumber, TextLaw};
pub use flow_density::FlowDensity;
pub use glazing::{Angular, Blind, Gap, Gas, Glazing, Pane, PaneOptics};
pub use heat_source::{HeatExchange, HeatSource, HeatingMeans, Throttle};
pub use humidity::{
    Buffer, Depth, Drying, Humidity, HumidityControl, HumiditySetPoint, Sorption, VapourGain, ZoneHumidity,
};
pub use material::Material;
pub use parameter::{ParamId, Parameter};
pub use phase_change::{MeltingCurve, PcmLaw, TablePoints, Tail};
pub use published_law::PublishedLaw;
pub use site::{Clouds, Site, Sky, WindProfile};
pub use surface::{Exposure, Facing, FrameShare, HeatFlux, OutdoorLongwave, Sensor, Side, Soil, Surface};
pub use vent::{Band, ChannelBand, Vent, VentControl, WindOnVent, WindPressure};
pub use zone::{
    Gain, IdealLoad, Infiltration, Mixing, SetPoint, Stratification, SunShares, Ventilation, Zone,
    ZoneLongwave, ZoneSun,
};
