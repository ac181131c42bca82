//! The building compiled to flat arrays (the plan), and its coefficients at a parameter vector.

pub(crate) mod cell;
pub mod coefficients;
pub(crate) mod formulas;
pub mod glazing;
pub(crate) mod humidity;
pub mod ids;
pub(crate) mod layout;
pub mod model;
pub(crate) mod order;
pub mod passages;
pub(crate) mod pattern;
pub mod plan;
pub(crate) mod solar_distribution;
pub(crate) mod solar_geometry;
#[cfg(test)]
pub(crate) mod test_buildings;
pub(crate) mod thick_walls;
pub(crate) mod vents;
