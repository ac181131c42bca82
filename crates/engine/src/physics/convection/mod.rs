//! Convective heat flow between a surface and the air.
//!
//! Every correlation gives a surface heat transfer coefficient h as a function of the temperature difference; the heat flow is
//! `q = h d`, `d = T_surface - T_air`. Each file holds one correlation, with its source, equation, range, and a test against a
//! number worked out by hand:
//!
//! | file | correlation | used |
//! |---|---|---|
//! | [`constant`] | one number | anywhere |
//! | [`measured`] | a forcing channel | anywhere |
//! | [`linear_wind`] | `a + b V` (`McAdams` 1954) | outdoors |
//! | [`alamdari_hammond`] | Alamdari & Hammond (1983) | indoors |
//! | [`paper_eq5`] | Guichard et al. (2016), eq. 5 as printed | indoors |
//! | [`tarp`] | TARP: Walton (1983) | indoors and outdoors |
//! | [`mowitt`] | `MoWiTT`: Yazdanian & Klems (1994) | outdoors, smooth surfaces |
//! | [`doe2`] | DOE-2: `MoWiTT` on rough surfaces | outdoors |
//! | [`iso15099`] | ISO 15099:2003, 8.3.2.2 | indoor surface of a glazing |
//! | [`power`] | `a + b |d|^n + c V^m` | anywhere |
//! | [`formula`] | as written in the description ([`formula_text`]) | anywhere |
//!
//! [`natural`] holds the terms that several of them are made of, [`wind`] the wind and its part of the coefficient. h is a
//! function of `d^2 + r^2` with a small r: it is smooth where the heat flow changes its direction, and roots and derivatives of
//! powers of `|d|` come without divisions. What depends on geometry is computed once per run, what depends on the wind once per
//! stage.
//!
//! # Adding a correlation
//!
//! 1. `input/description/convection.rs`: a variant of `Convection` with its parameters and their units;
//! 2. `input/parameter_walk.rs`: the names of these parameters (the compiler asks for them);
//! 3. here: a file with a struct of the numbers that remain after geometry, its `new`, `impl Correlation`, `impl WindPart`, and
//!    a test with a number worked out by hand; its name in `mod` and in the table above; in `law.rs` its name in `laws!` and an arm of
//!    `Law::new` (the compiler asks for it);
//! 4. [`wind::WindTerms::of`]: the terms of the wind that it needs (the compiler asks for it);
//! 5. the description language: a class in `python/mascarin/model/convection.py` with the same names.
//!
//! Lanes, derivatives, ledger, and the linear systems need no change.

pub(crate) mod alamdari_hammond;
#[cfg(test)]
mod borders;
pub(crate) mod constant;
pub(crate) mod correlation;
pub(crate) mod doe2;
pub(crate) mod formula;
pub(crate) mod formula_check;
#[cfg(test)]
mod formula_tests;
pub(crate) mod formula_text;
pub(crate) mod iso15099;
pub(crate) mod law;
pub(crate) mod linear_wind;
pub(crate) mod measured;
pub(crate) mod mowitt;
pub(crate) mod natural;
pub(crate) mod paper_eq5;
pub(crate) mod power;
pub(crate) mod tarp;
#[cfg(test)]
mod testing;
pub(crate) mod wind;

pub use correlation::Placement;
pub use formula_check::LawText;
pub use law::SurfaceConvection;
pub use wind::{Forced, Wind, WindTerms};
