//! Air between zones, and openings to outdoors; equations and sources in `physics/air_flow.rs`.

use serde::Deserialize;

use super::parameter::ParamId;

/// Air that two zones exchange, the same flow in both directions.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirPath {
    /// Name in messages.
    pub name: String,
    /// Indices into [`Description::zones`](super::Description::zones).
    pub between: [usize; 2],
    /// Volume flow in each direction at the density of the site [m3/s].
    pub flow: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the flow [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}

/// An opening to outdoors that wind and buoyancy drive air through; equation and source in `physics/air_flow.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Opening {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::zones`](super::Description::zones).
    pub zone: usize,
    /// Free area [m2].
    pub area: ParamId,
    /// From the opening to the neutral level [m].
    pub height: ParamId,
    /// Discharge coefficient of the buoyant flow [-].
    pub discharge: ParamId,
    /// Effectiveness against the wind [-].
    pub wind_coefficient: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the area that is open [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
}
