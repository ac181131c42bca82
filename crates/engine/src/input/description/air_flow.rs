//! Air between zones, openings to outdoors and mechanical ventilation; equations and sources in `physics/air_flow.rs`,
//! `physics/doors.rs` and `physics/mechanical_air.rs`.

use serde::Deserialize;

use super::flow_density::FlowDensity;
use super::parameter::ParamId;
use super::zone::SetPoint;

/// Air that two zones exchange, the same flow in both directions.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirPath {
    /// Name in messages.
    pub name: String,
    /// Indices into [`Description::zones`](super::Description::zones).
    pub between: [usize; 2],
    /// Volume flow in each direction [m3/s].
    pub flow: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the flow [-]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Density of the air that the flow is a volume of. None: that of the site.
    #[serde(default)]
    pub density: Option<FlowDensity>,
    /// Index into [`Description::controls`](super::Description::controls): what starts and stops it. None: it always flows.
    #[serde(default)]
    pub control: Option<usize>,
}

/// Air that flows from one zone to another.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectedFlow {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::zones`](super::Description::zones): where it comes from.
    pub from: usize,
    /// Index into [`Description::zones`](super::Description::zones): where it goes to.
    pub to: usize,
    /// Volume flow [m3/s]; where a channel gives the flow, what that is multiplied by.
    pub flow: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the flow [-], or the flow [m3/s]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Density of the air that the flow is a volume of. None: that of the site.
    #[serde(default)]
    pub density: Option<FlowDensity>,
}

/// A door or another large opening between two zones, through which a temperature difference drives air both ways.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Door {
    /// Name in messages.
    pub name: String,
    /// Indices into [`Description::zones`](super::Description::zones).
    pub between: [usize; 2],
    /// Width of the opening [m].
    pub width: ParamId,
    /// Height of the opening [m].
    pub height: ParamId,
    /// Discharge coefficient [-].
    pub discharge: ParamId,
    /// Fraction of the width that is open [-].
    pub open: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): what `open` is multiplied by [-]. None: one.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Index into [`Description::controls`](super::Description::controls): what opens and closes it. None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,
}

/// A flow of a ventilation unit into a zone or out of it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitFlow {
    /// Index into [`Description::zones`](super::Description::zones).
    pub zone: usize,
    /// Volume flow [m3/s]; where a channel gives the flow, what that is multiplied by.
    pub flow: ParamId,
    /// Index into [`Description::channels`](super::Description::channels): fraction of the flow [-], or the flow [m3/s]. None: always all of it.
    #[serde(default)]
    pub schedule: Option<usize>,
    /// Density of the air that the flow is a volume of. None: that of the site.
    #[serde(default)]
    pub density: Option<FlowDensity>,
}

/// Mechanical ventilation: air that is supplied to some zones and extracted from others.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VentilationUnit {
    /// Name in messages.
    pub name: String,
    /// Flows into zones.
    #[serde(default)]
    pub supply: Vec<UnitFlow>,
    /// Flows out of zones.
    #[serde(default)]
    pub exhaust: Vec<UnitFlow>,
    /// Temperature of the supplied air. None: that of the outdoor air, raised by heat recovery.
    #[serde(default)]
    pub temperature: Option<SetPoint>,
    /// Sensible effectiveness of heat recovery [-]. None: no recovery.
    #[serde(default)]
    pub recovery: Option<ParamId>,
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
    /// Index into [`Description::controls`](super::Description::controls). None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,
}
