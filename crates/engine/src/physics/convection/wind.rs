//! The wind, and its part of a surface heat transfer coefficient.

use crate::input::description::Convection;
use crate::number::real::Real;

/// Exponents of the wind, windward and leeward.
pub(super) const MOWITT_EXPONENTS: [f64; 2] = [0.89, 0.617];

/// Wind speeds below this [m/s] count as this: `V^b` has an infinite slope at zero.
pub(super) const CALM: f64 = 1e-3;

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
    /// What several correlations need together.
    pub fn of<'a>(laws: impl Iterator<Item = &'a Convection>) -> Self {
        laws.fold(Self::default(), |mut terms, law| {
            match law {
                Convection::Tarp { .. } => terms.direction = true,
                Convection::Mowitt { .. } | Convection::Doe2 { .. } => {
                    (terms.direction, terms.mowitt) = (true, true);
                }
                Convection::Power { .. } => terms.logarithm = true,
                Convection::Formula { formula, .. } => terms.direction |= formula.contains("windward"),
                Convection::Constant { .. }
                | Convection::Measured { .. }
                | Convection::LinearWind { .. }
                | Convection::AlamdariHammond { .. }
                | Convection::PaperEq5 { .. }
                | Convection::Iso15099 { .. } => {}
            }
            terms
        })
    }

    /// All terms.
    #[cfg(test)]
    pub(super) fn all() -> Self {
        Self { mowitt: true, logarithm: true, direction: true }
    }
}

/// Wind at the mast and the terms of it that correlations need.
#[derive(Debug, Clone, Copy)]
pub struct Wind {
    /// [m/s].
    pub speed: f64,
    /// Root of the speed.
    pub(super) root: f64,
    /// Speed to the windward and leeward exponents of `MoWiTT`.
    pub(super) mowitt: [f64; 2],
    /// Logarithm of the speed.
    pub(super) logarithm: f64,
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
