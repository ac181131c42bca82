//! The building compiled to flat arrays (the plan), and its coefficients at a parameter vector.

pub mod coefficients;
pub mod glazing;
pub mod ids;
pub(crate) mod layout;
pub mod model;
pub(crate) mod order;
pub mod plan;
pub(crate) mod solar_geometry;
pub mod sun_distribution;
