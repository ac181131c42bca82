//! The pressure network of a building: which zones openings join, and where their pressures stand in its matrix.

use super::order::number_zones;
use super::pattern::Pattern;
use crate::input::description::{Description, Vent};

/// The pressure network.
#[derive(Debug, Clone)]
pub(crate) struct VentPlan {
    /// Row of each zone.
    pub(crate) rows: Vec<usize>,
    pub(crate) pattern: Pattern,
}

impl VentPlan {
    /// None in a building without such openings.
    pub(crate) fn new(description: &Description) -> Option<Self> {
        if description.vents.is_empty() {
            return None;
        }
        let between: Vec<_> = description.vents.iter().filter_map(Vent::between).collect();
        let (rows, pattern) = number_zones(description.zones.len(), &between);
        Some(Self { rows, pattern })
    }
}
