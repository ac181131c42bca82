//! What a caller hands over: the description of a building, parameter values, forcing.

pub mod description;
pub mod forcing;
pub mod values;
