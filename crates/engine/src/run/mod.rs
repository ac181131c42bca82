//! Runs: options, warm-up, outputs, ensembles.

mod action;

pub mod ensemble;
pub mod march;
pub mod options;
pub mod outputs;
pub mod ratings;
pub mod stepwise;
pub mod streamed;
mod warm_up;

pub(crate) use action::Action;
