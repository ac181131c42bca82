//! The building compiled to flat arrays, and its coefficients.

pub mod coefficients;
pub mod plan;
pub mod sun_distribution;
