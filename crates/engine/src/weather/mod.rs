//! The conditions that act on a building at an instant: forcing evaluated at its surfaces, zones and windows.

mod beams;
pub mod conditions;
pub(crate) mod heat_sources;
pub(crate) mod humidity;
pub mod index;
pub(crate) mod instant;
pub(crate) mod mechanical_air;
mod panes;
pub(crate) mod solar_means;
pub(crate) mod sun;
pub(crate) mod sun_position;
pub(crate) mod surface;
mod surroundings;
pub(crate) mod vents;
pub mod zone_conditions;
