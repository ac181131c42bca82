//! Runs, outputs and ensembles.

pub mod ensemble;
pub mod march;
pub mod probe;
