//! Solar optics of panes and of units of panes.
//!
//! A unit is described by its transmittance and the absorptance of each pane over the cosine of the angle of incidence:
//! a monotone piecewise cubic through a few angles, computed once per run (`curves.rs`). In a step only the cubic is evaluated.
//! The laws of a single pane are in `pane.rs`.
//!
//! Panes are combined with values that are the mean of both polarisations already. Keeping the polarisations apart between the
//! panes is what a single plane wave would do; tables of real units (WINDOW, EN 410) are made with the mean, and lie 3 % (60 deg)
//! to 5 % (70 deg) lower in transmittance.
//!
//! Sources:
//! - Multiple reflection between panes: Duffie & Beckman (2013), ch. 5, doi:10.1002/9781118671603.
//! - A unit known by U and g only: `rated.rs`.

mod curves;
mod diffuse;
mod pane;
mod rated;
mod unit;

pub use diffuse::Diffuse;
pub(crate) use rated::Rating;
pub use unit::Optics;
