//! Which air a volume flow is a volume of.

use serde::Deserialize;

use super::parameter::ParamId;

/// Air that a volume flow is a volume of; equations in `physics/flow_density.rs`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum FlowDensity {
    /// The outdoor air of the moment.
    Outdoors,
    /// The air of the zone that the flow leaves or enters, at the start of a step; between two zones the mean of both.
    Zone,
    /// A given density.
    Constant {
        /// [kg/m3].
        value: ParamId,
    },
}
