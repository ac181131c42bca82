//! Thermal bridges.

use super::surface::{Imposed, imposed};
use crate::input::description::{Facing, ThermalBridge};
use crate::input::values::Values;
use crate::number::real::Real;

/// What the other end of a bridge is in contact with.
#[derive(Debug, Clone)]
pub enum BridgeEnd<S> {
    /// Outdoor air.
    Outdoors,
    /// The air of another zone.
    Zone(usize),
    /// A ground or measured temperature.
    Imposed(Imposed<S>),
}

/// A thermal bridge from the air of a zone.
#[derive(Debug, Clone)]
pub struct Bridge<S> {
    /// The zone.
    pub zone: usize,
    /// Heat per degree [W/K].
    pub conductance: S,
    /// The other end.
    pub to: BridgeEnd<S>,
}

impl<S: Real> Bridge<S> {
    /// Evaluates a bridge at a parameter vector.
    pub(crate) fn new(bridge: &ThermalBridge, values: &Values<'_, S>) -> Self {
        let to = match bridge.to {
            Facing::Zone { zone } => BridgeEnd::Zone(zone),
            _ => imposed(&bridge.to, values).map_or(BridgeEnd::Outdoors, BridgeEnd::Imposed),
        };
        Self { zone: bridge.zone, conductance: values.get(bridge.coefficient) * values.get(bridge.size), to }
    }
}
