//! Runs: options, warm-up, outputs, ensembles.

mod action;
pub(crate) mod anderson;

pub mod ensemble;
pub mod march;
pub mod options;
pub mod outputs;
pub(crate) mod periodic_start;
pub mod ratings;
pub mod stepwise;
mod warm_up;

pub(crate) use action::Action;
