//! The conditions that act on a building at an instant.

pub mod conditions;
pub mod index;
pub mod zone_conditions;
