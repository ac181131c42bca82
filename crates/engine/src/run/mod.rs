//! Runs: options, warm-up, outputs, ensembles.

mod action;
pub(crate) mod anderson;

pub mod ensemble;
pub mod march;
pub mod options;
pub mod outputs;
pub mod ratings;
pub mod stepwise;
pub(crate) mod periodic_start;
mod warm_up;

pub(crate) use action::Action;
