//! Mascarin's engine: transient physics of buildings with phase-change materials.
//!
//! A [`description::Description`] is compiled to a [`plan::Plan`]. [`run::simulate()`] (or [`run::ensemble::ensemble`]) runs the plan with
//! a [`forcing::Forcing`] and returns records and an energy ledger. The engine reads no files, and has no dates and no Python.

// Compiled for a browser the engine makes single runs: ensembles, derivatives and linear models are left out, and what they alone use.
#![cfg_attr(target_arch = "wasm32", allow(dead_code, unused_imports, unused_macros, reason = "see above"))]
#![allow(rustdoc::broken_intra_doc_links, reason = "units stand in square brackets: [m] is no link")]

// Unit tests build their plans with the builders of `tests/common`, which name this crate from outside.
#[cfg(test)]
extern crate self as mascarin_engine;
#[cfg(test)]
#[path = "../tests/engine/common/mod.rs"]
mod common;

mod balance;
mod building;
#[cfg(not(target_arch = "wasm32"))]
pub mod derivatives;
pub mod error;
mod geometry;
mod input;
mod linear;
#[cfg(not(target_arch = "wasm32"))]
pub mod linear_model;
pub mod number;
mod physics;
pub mod run;
mod step;
mod weather;

pub use balance::{energy_balance, vapour};
pub use building::{coefficients, plan};
pub use input::{description, forcing, values};
pub use physics::{constants, globe, pcm, psychrometrics, standard_air};
pub use step::control::RunControl;
pub use step::{Counters, Scheme, state};

/// The published laws that a description has by name.
pub mod laws {
    pub use crate::physics::convection::table as convection;
    pub use crate::physics::diffuse::table as diffuse;
    pub use crate::physics::imposed::{imposed_on, table as imposed};
    pub use crate::physics::law_row::{
        Alternative, Choice, CloudKind, Default, LawEntry, LawParameter, LawRange, LawRow, Limits, Sides,
        Tilt,
    };
    pub use crate::physics::leakage::{air_changes_of as leakage_air_changes, table as leakage};
    pub use crate::physics::longwave::sky::table as sky;
    pub use crate::physics::sorption::table as sorption;
}

/// Laws that are written as text.
pub mod formula {
    pub use crate::physics::convection::formula_check::LawPoint;
    pub use crate::physics::convection::{LawSide, LawText, Surroundings};
    pub use crate::physics::formula::expression::DerivedText;
    pub use crate::physics::formula::function_check::FunctionLaw;
    pub use crate::physics::formula::{Fault, FormulaFault, LawNumber, Position};
    pub use crate::physics::pcm::text::CurveText;
}
