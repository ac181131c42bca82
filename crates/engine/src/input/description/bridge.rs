//! Thermal bridges.

use serde::Deserialize;

use super::parameter::ParamId;
use super::surface::Facing;

/// Heat that flows through a joint or a fixing, beside that through plane walls: `coefficient size` [W/K].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThermalBridge {
    /// Name in messages.
    pub name: String,
    /// Index into [`Description::zones`](super::Description::zones).
    pub zone: usize,
    /// Linear [W/(m K)] or point [W/K] thermal transmittance.
    pub coefficient: ParamId,
    /// Length [m] or number [-].
    pub size: ParamId,
    /// What the other end is in contact with: anything but `adiabatic`.
    pub to: Facing,
}
