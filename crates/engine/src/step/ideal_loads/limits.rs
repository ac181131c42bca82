//! Limits of an ideal load over a step: set points and capacities.

use crate::building::coefficients::ZoneCoefficients;
use crate::number::real::{ByPrecision, Real};

/// Airs closer to their set points than this count as on them [K].
pub(super) const TOLERANCE: ByPrecision = ByPrecision { double: 1e-8, single: 2e-3 };
/// Magnitude of the set point without heating or cooling, which is never reached [degC].
const NEVER: f64 = 1e6;

/// Limits of one ideal load over a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits<S> {
    /// Set points of heating and cooling [degC].
    pub(super) set_points: [S; 2],
    /// Largest heating and cooling [W].
    pub(super) most: [S; 2],
}

impl<S: Real> Limits<S> {
    /// Reads the set points at the end of a step.
    #[inline(always)]
    pub(super) fn at(zone: &ZoneCoefficients<S>, row: &[f64]) -> Self {
        let nothing = [(S::constant(-NEVER), S::zero()), (S::constant(NEVER), S::zero())];
        let (heating, most_heating) =
            if let Some(ideal_load) = &zone.heating { ideal_load.at(row) } else { nothing[0] };
        let (cooling, most_cooling) =
            if let Some(ideal_load) = &zone.cooling { ideal_load.at(row) } else { nothing[1] };
        Self { set_points: [heating, cooling], most: [most_heating, most_cooling] }
    }

    /// Where an air asks for heating, and where for cooling.
    #[inline(always)]
    pub(super) fn asks(&self, air: S) -> [S::Mask; 2] {
        let slack = S::constant(TOLERANCE.of::<S>());
        let cold = air.lt(self.set_points[0] - slack) & S::zero().lt(self.most[0]);
        let hot = (self.set_points[1] + slack).lt(air) & S::zero().lt(self.most[1]);
        [cold, hot]
    }
}
