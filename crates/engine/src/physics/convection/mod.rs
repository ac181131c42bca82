//! Convective heat flow between a surface and the air.
//!
//! Every correlation gives a surface heat transfer coefficient h as a function of the temperature difference; the heat flow is
//! `q = h d`, `d = T_surface - T_air`. Each file of [`laws`] holds a published one, with its source, equation, range, and a test against
//! a number worked out by hand. [`measured`] is a forcing channel, [`formula`] a law as written in the description ([`formula_text`]).
//!
//! [`natural`] holds the terms that several of them are made of, [`wind`] the wind and its part of the coefficient, [`numbers`] the
//! numbers that several have. h is a function of `d^2 + r^2` with a small r: it is smooth where the heat flow changes its direction, and
//! roots and derivatives of powers of `|d|` come without divisions. What depends on geometry is computed once per run, what depends on
//! the wind once per stage.
//!
//! # Adding a law
//!
//! A file in [`laws`], as `docs/engine.md` shows. Nothing else changes.

#[cfg(test)]
mod borders;
pub(crate) mod correlation;
pub(crate) mod formula;
pub(crate) mod formula_check;
#[cfg(test)]
mod formula_tests;
pub(crate) mod formula_text;
pub(crate) mod law;
pub(crate) mod laws;
pub(crate) mod measured;
pub(crate) mod natural;
pub(crate) mod numbers;
pub(crate) mod prelude;
#[cfg(test)]
mod testing;
pub(crate) mod wind;

pub use correlation::Placement;
pub use formula_check::{LawSide, LawText};
pub use law::{SurfaceConvection, table, wind_terms};
pub use wind::{Driven, Surroundings, Wind, WindTerms};
