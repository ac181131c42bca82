//! Runs: options, warm-up, outputs, ensembles.

mod action;
pub(crate) mod anderson;

pub mod ensemble;
pub mod march;
pub mod options;
mod output_limits;
pub mod outputs;
pub(crate) mod periodic_start;
pub mod physical_limits;
pub mod ratings;
pub mod stepwise;
pub mod streamed;
pub mod validity;
mod warm_up;

pub(crate) use action::Action;
