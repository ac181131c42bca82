//! The input of the engine: the description of a building and its check, parameter values, forcing.

pub(crate) mod check;
pub mod description;
pub mod forcing;
mod parameter_walk;
pub mod values;
