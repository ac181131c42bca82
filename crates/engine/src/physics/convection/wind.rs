//! The wind, and its part of a surface heat transfer coefficient.

use crate::number::real::Real;

/// Exponents of the wind, windward and leeward.
pub(crate) const MOWITT_EXPONENTS: [f64; 2] = [0.89, 0.617];

/// Wind speeds below this [m/s] count as this: `V^b` has an infinite slope at zero.
pub(crate) const CALM: f64 = 1e-3;

/// The part of a coefficient that does not depend on temperature, where heat flows up and where it flows down [W/(m2 K)].
pub type Forced<S> = [S; 2];

/// Which terms of the wind the correlations of a building need beside its speed and the root of it.
#[derive(Debug, Clone, Copy, Default)]
pub struct WindTerms {
    /// The powers of `MoWiTT`.
    mowitt: bool,
    /// The logarithm, for any power.
    logarithm: bool,
    /// The direction.
    pub direction: bool,
}

impl WindTerms {
    /// The speed and its root.
    pub const SPEED: Self = Self { mowitt: false, logarithm: false, direction: false };
    /// The direction.
    pub const DIRECTION: Self = Self { direction: true, ..Self::SPEED };
    /// The direction and the powers of `MoWiTT`.
    pub const MOWITT: Self = Self { mowitt: true, ..Self::DIRECTION };
    /// The logarithm.
    pub const LOGARITHM: Self = Self { logarithm: true, ..Self::SPEED };

    /// What two correlations need together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            mowitt: self.mowitt | other.mowitt,
            logarithm: self.logarithm | other.logarithm,
            direction: self.direction | other.direction,
        }
    }

    /// All terms.
    #[cfg(test)]
    pub(crate) fn all() -> Self {
        Self { mowitt: true, logarithm: true, direction: true }
    }
}

/// Wind at the mast and the terms of it that correlations need.
#[derive(Debug, Clone, Copy)]
pub struct Wind {
    /// [m/s].
    pub speed: f64,
    /// Root of the speed.
    pub(crate) root: f64,
    /// Speed to the windward and leeward exponents of `MoWiTT`.
    pub(crate) mowitt: [f64; 2],
    /// Logarithm of the speed.
    pub(crate) logarithm: f64,
}

impl Wind {
    /// The terms of a speed [m/s]; zeros for those that are not needed.
    #[must_use]
    pub fn new(speed: f64, terms: WindTerms) -> Self {
        let moving = if speed < CALM { CALM } else { speed };
        let power = |exponent| if terms.mowitt { Real::powf(moving, exponent) } else { 0.0 };
        Self {
            speed,
            root: Real::sqrt(moving),
            mowitt: MOWITT_EXPONENTS.map(power),
            logarithm: if terms.logarithm { Real::ln(moving) } else { 0.0 },
        }
    }
}
