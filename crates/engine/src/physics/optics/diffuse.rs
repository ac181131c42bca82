//! Parts of the radiation on a unit at one angle, or of diffuse radiation, that are transmitted and absorbed.

use crate::number::real::Real;

/// Transmitted and absorbed parts of diffuse radiation; the rest is reflected.
#[derive(Debug, Clone)]
pub struct Diffuse<S> {
    /// [-].
    pub transmittance: S,
    /// Of each pane, outside to inside [-].
    pub absorptance: Vec<S>,
}

impl<S: Real> Diffuse<S> {
    /// All that is not reflected [-].
    #[inline(always)]
    pub fn admitted(&self) -> S {
        self.absorptance.iter().fold(self.transmittance, |sum, part| sum + *part)
    }
}

/// A unit at one angle: transmittance, then the absorptance of each pane.
pub(super) type Unit<S> = Vec<S>;

/// Exact at 90 deg.
pub(super) fn cosine(angle: f64) -> f64 {
    if angle >= 90.0 { 0.0 } else { Real::cos(angle.to_radians()) }
}
