//! Time steps: schemes, Newton's iteration for a stage, ideal loads, parts of a step.

mod accept;
pub mod control;
mod energy;
pub(crate) mod film;
mod gap_convection;
mod guess;
pub(crate) mod halving;
pub(crate) mod history;
pub(crate) mod ideal_loads;
mod limiter;
mod linearisation;
mod linearization_error;
pub(crate) mod linearized_stepper;
mod nested;
pub(crate) mod newton;
mod overshoot;
pub(crate) mod readings;
mod residual;
#[cfg(test)]
mod residual_tests;
pub(crate) mod scheme;
mod stage;
mod stage_histories;
pub(crate) mod stage_solutions;
mod stage_weather;
pub mod state;
pub(crate) mod stepper;
pub(crate) mod vapour;
mod vents;

pub use newton::Counters;
pub use scheme::Scheme;
pub use stepper::Stepper;
