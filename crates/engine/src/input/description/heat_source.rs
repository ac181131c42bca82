//! Heat that is released in a plane between two layers of a wall: electric mats and pipes of water.

use serde::Deserialize;

use super::parameter::ParamId;
use super::zone::SetPoint;

/// Heat in a plane between two layers; equations in `physics/heat_sources.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeatSource {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::surfaces`](super::Description::surfaces).
    pub surface: usize,
    /// The layer of its construction whose inner side the plane is.
    pub layer: usize,
    /// What releases the heat.
    pub means: HeatingMeans,
    /// What turns it down by the air of a zone. None: it has all of its power or flow.
    #[serde(default)]
    pub thermostat: Option<Throttle>,
    /// Index into [`Description::controls`](super::Description::controls): it is on where the control lets openings open. None: not controlled.
    #[serde(default)]
    pub control: Option<usize>,
}

/// What releases heat in a plane.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum HeatingMeans {
    /// An electric mat.
    Electric {
        /// Power per area [W/m2]; where a channel gives it, what that is multiplied by.
        power: ParamId,
        /// Index into [`Description::channels`](super::Description::channels): fraction of it [-], or the power [W/m2]. None: always all of it.
        #[serde(default)]
        schedule: Option<usize>,
    },
    /// Pipes of water.
    Water {
        /// Flow through all pipes of the surface [kg/s]; where a channel gives it, what that is multiplied by.
        flow: ParamId,
        /// Index into [`Description::channels`](super::Description::channels): fraction of it [-], or the flow [kg/s]. None: always all of it.
        #[serde(default)]
        schedule: Option<usize>,
        /// Temperature of the water that enters.
        supply: SetPoint,
        /// Specific heat of the water [J/(kg K)].
        specific_heat: ParamId,
        /// How well the water exchanges its heat with the plane.
        exchange: HeatExchange,
    },
}

/// How well water exchanges its heat with a plane.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum HeatExchange {
    /// By a conductance.
    Conductance {
        /// From the water to the plane [W/(m2 K)].
        conductance: ParamId,
    },
    /// At any flow the same.
    Effectiveness {
        /// Fall of the water over its excess at the inlet [-].
        effectiveness: ParamId,
    },
}

/// A thermostat with a throttling range.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Throttle {
    /// Index of the zone whose air it measures.
    pub zone: usize,
    /// Temperature at which power or flow is one half.
    pub setpoint: SetPoint,
    /// Range of the temperature from all of it to nothing [K].
    pub range: ParamId,
    /// Whether it is on above the set point; else below.
    pub cooling: bool,
}
