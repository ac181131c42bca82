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

    /// Light of the sky and a horizon that is darker than the rest of it, a negative part of the light [W/m2]. As both are
    /// where all that is transmitted and absorbed stays between zero and what arrives; else all of the sky is darker.
    /// `level`: the unit for light of the horizon.
    #[inline(never)]
    pub fn with_dark_horizon(&self, level: &Self, scattered: S, horizon: S) -> (S, S) {
        let part = |whole: S, level: S| whole * scattered + level * horizon;
        let through = part(self.transmittance, level.transmittance);
        let (mut sum, mut outside) = (through, through.lt(S::zero()));
        for (&whole, &level) in self.absorptance.iter().zip(&level.absorptance) {
            let absorbed = part(whole, level);
            outside = outside | absorbed.lt(S::zero());
            sum += absorbed;
        }
        let arriving = scattered + horizon;
        outside = (outside | arriving.lt(sum)) & horizon.lt(S::zero());
        (S::select(outside, arriving, scattered), S::select(outside, S::zero(), horizon))
    }
}

/// A unit at one angle: transmittance, then the absorptance of each pane.
pub(super) type Unit<S> = Vec<S>;

/// Exact at 90 deg.
pub(super) fn cosine(angle: f64) -> f64 {
    if angle >= 90.0 { 0.0 } else { Real::cos(angle.to_radians()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A horizon that is darker than the sky is wide transmits and absorbs no negative light, nor more than arrives; where it is
    /// little darker, each part of the light keeps its own transmittance.
    #[test]
    fn a_dark_horizon() {
        let sky = Diffuse { transmittance: 0.6, absorptance: vec![0.1, 0.05] };
        for (through, absorbed) in [(0.75, 0.12), (0.2, 0.3)] {
            let level = Diffuse { transmittance: through, absorptance: vec![absorbed, 0.05] };
            for horizon in [-1.0, -30.0, -95.0, -99.9999, -100.0] {
                let (scattered, dark) = sky.with_dark_horizon(&level, 100.0, horizon);
                let parts = [(0.6, through), (0.1, absorbed), (0.05, 0.05)];
                let found = parts.map(|(whole, level)| whole * scattered + level * dark);
                assert!(found.iter().all(|part| *part >= 0.0), "{found:?}");
                assert!(found.iter().sum::<f64>() <= 100.0 + horizon + 1e-12, "{found:?} at {horizon}");
            }
            assert_eq!(sky.with_dark_horizon(&level, 100.0, -1.0), (100.0, -1.0));
        }
    }
}
