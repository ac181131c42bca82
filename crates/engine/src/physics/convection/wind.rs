//! The wind, and its part of a surface heat transfer coefficient.

use crate::number::real::Real;

/// Exponents of the wind, windward and leeward.
pub(crate) const MOWITT_EXPONENTS: [f64; 2] = [0.89, 0.617];

/// Wind speeds below this [m/s] count as this: `V^b` has an infinite slope at zero.
pub(crate) const CALM: f64 = 1e-3;

/// The part of a coefficient that does not depend on temperature, where heat flows up and where it flows down [W/(m2 K)].
pub type Forced<S> = [S; 2];

/// What drives the coefficient of a surface in a stage: [`Forced`] and zeros, or up to four parts of a law that is written as text.
pub type Driven<S> = [S; 4];

/// What acts on a surface beside the wind and the temperature difference; laws that are written as text may depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings<S> {
    /// Temperature of the air in front of it; in a zone that at the start of the step [degC].
    pub air: S,
    /// Angle between its normal and the direction that the wind comes from [deg].
    pub angle: S,
    /// Irradiance of its plane [W/m2].
    pub sun: S,
    /// Outdoor air that flows into its zone, by the air of the zone at the start of the step [1/h].
    pub air_change: S,
    /// All air that flows into its zone, with that which moves within it [1/h].
    pub total_air_change: S,
}

/// How many they are.
pub(crate) const AROUND: usize = 5;

impl<S: Real> Surroundings<S> {
    /// Air of 20 degC, no sun and no wind.
    pub(crate) fn calm() -> Self {
        let zero = S::zero();
        Self { air: S::constant(20.0), angle: zero, sun: zero, air_change: zero, total_air_change: zero }
    }

    /// In the order of the programs.
    pub(crate) fn list(&self) -> [S; AROUND] {
        [self.air, self.angle, self.sun, self.air_change, self.total_air_change]
    }

    /// From the order of the programs.
    pub(crate) fn from_list([air, angle, sun, air_change, total_air_change]: [S; AROUND]) -> Self {
        Self { air, angle, sun, air_change, total_air_change }
    }
}

/// The angle between a direction and another one from the cosine between them [deg].
///
/// The arccosine: `sqrt(1 - x)` times a polynomial (Abramowitz & Stegun 1964, Handbook of Mathematical Functions, 4.4.46) with an error of
/// 2e-8, and one step of Newton's method. Within 0.1 deg of 0 and 180 it is rounded, where its slope is infinite.
pub(crate) fn angle_of_cosine<S: Real>(cosine: S) -> S {
    let most = S::constant(1.0 - 1.5e-6);
    let x = cosine.min(most).max(-most);
    let size = x.abs();
    let powers = [
        -0.001_262_491_1,
        0.006_670_090_1,
        -0.017_088_125_6,
        0.030_891_881_0,
        -0.050_174_304_6,
        0.088_978_987_4,
        -0.214_598_801_6,
        1.570_796_305_0,
    ];
    let sum = powers.into_iter().fold(S::zero(), |sum, power| sum * size + S::constant(power));
    let acute = (S::one() - size).sqrt() * sum;
    let angle = S::select(x.lt(S::zero()), S::constant(core::f64::consts::PI) - acute, acute);
    let exact = angle + (angle.cos() - x) / angle.sin();
    exact.scale(180.0 / core::f64::consts::PI)
}

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

#[cfg(test)]
mod tests {
    use super::angle_of_cosine;

    /// Angles are those of their cosines.
    #[test]
    fn angles_of_cosines() {
        for degrees in [0.5, 1.0, 30.0, 60.0, 89.0, 90.0, 91.0, 135.0, 179.0] {
            let found: f64 = angle_of_cosine(crate::number::elementary::cos_of_degrees::<f64>(degrees));
            assert!((found - degrees).abs() < 1e-11, "{found} is not {degrees}");
        }
        assert!(angle_of_cosine(1.0_f64).abs() < 0.1 && (angle_of_cosine(-1.0_f64) - 180.0).abs() < 0.1);
    }
}
