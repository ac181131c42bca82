//! Mascarin's engine: transient physics of buildings with phase-change materials.
//!
//! A [`description::Description`] is compiled to a [`plan::Plan`]. [`march::march`] (or [`batch::ensemble`]) runs the plan with
//! a [`forcing::Forcing`] and returns records and an energy ledger. The engine reads no files, and has no dates and no Python.

#![allow(rustdoc::broken_intra_doc_links, reason = "units stand in square brackets: [m] is no link")]

// Unit tests build their plans with the builders of `tests/common`, which name this crate from outside.
#[cfg(test)]
extern crate self as mascarin_engine;
#[cfg(test)]
#[path = "../tests/engine/common/mod.rs"]
mod common;

mod balance;
mod building;
pub mod derivatives;
pub mod error;
mod geometry;
mod input;
mod linear;
pub mod linear_model;
pub mod number;
mod physics;
mod run;
mod step;
mod weather;

pub use balance::{ledger, vapour};
pub use building::{coefficients, plan};
pub use input::values as parameters;
pub use input::{description, forcing};
pub use linear_model as state_space;
pub use number as real;
pub use number::simd as dispatch;
pub use physics::{pcm, psychrometrics};
pub use run::ensemble as batch;
pub use step::state;

/// Runs of one plan.
pub mod march {
    pub use crate::run::march::{Run, march};
    pub use crate::run::options::{Options, Warmup};
    pub use crate::run::streamed::march_streamed;
    pub use crate::step::control::RunControl as Watch;
    pub use crate::step::{Counters, Scheme};
}

pub use run::{physical_limits, ratings, stepwise, validity};

/// Laws that are written as text.
pub mod formula {
    pub use crate::physics::convection::LawText;
    pub use crate::physics::formula::{Fault, FormulaFault, LawNumber, Position};
    pub use crate::physics::pcm::text::CurveText;
}

/// Quantities to record.
pub mod probe {
    pub use crate::run::outputs::Output as Probe;
}
