//! The building compiled to flat arrays, and its coefficients.

pub mod coefficients;
pub mod glazing;
pub mod ids;
pub mod plan;
pub mod sun_distribution;
