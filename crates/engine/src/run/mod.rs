//! Runs: options, warm-up, outputs, ensembles.

mod action;
pub(crate) mod anderson;

#[cfg(not(target_arch = "wasm32"))]
pub mod ensemble;
pub mod options;
mod output_limits;
pub mod outputs;
pub(crate) mod periodic_start;
pub mod physical_limits;
pub mod ratings;
pub(crate) mod records;
pub mod simulate;
pub mod simulate_in_blocks;
mod soil_start;
pub mod step_choice;
pub mod step_lengths;
pub mod stepwise;
pub mod validity;
mod warm_up;

pub(crate) use action::{Action, Recorded};
pub use options::{Options, Warmup};
pub use simulate::{Run, simulate};
pub use simulate_in_blocks::simulate_in_blocks;
pub use step_lengths::StepLengths;
