//! Emission of a black body, `sigma T^4` (Stefan-Boltzmann), or its tangent at a reference temperature.

use crate::number::real::{Real, same};
use crate::physics::constants::{KELVIN, SIGMA};

/// Emission of a black body at a temperature [degC], exact or linearised.
#[derive(Debug, Clone, Copy)]
pub enum Emission<S> {
    /// sigma T^4.
    Exact,
    /// Tangent at a reference temperature [degC].
    Linearised(S),
}

impl<S: Real> Emission<S> {
    /// Whether another law is this one.
    pub(crate) fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Exact, Self::Exact) => true,
            (Self::Linearised(mine), Self::Linearised(theirs)) => same(*mine, *theirs),
            _ => false,
        }
    }

    /// (sigma T^4, its slope) [W/m2, W/(m2 K)].
    #[inline(always)]
    pub fn at(&self, temperature: S) -> (S, S) {
        let kelvin = |t: S| t + S::constant(KELVIN);
        match self {
            Self::Exact => {
                let t = kelvin(temperature);
                let cube = t * t * t;
                ((cube * t).scale(SIGMA), cube.scale(4.0 * SIGMA))
            }
            Self::Linearised(reference) => {
                let t = kelvin(*reference);
                let cube = t * t * t;
                let slope = cube.scale(4.0 * SIGMA);
                ((cube * t).scale(SIGMA) + slope * (temperature - *reference), slope)
            }
        }
    }
}

/// Temperature [degC] of a black body of an emission [W/m2].
pub fn black_temperature<S: Real>(emission: S) -> S {
    // No emission is absolute zero.
    emission.scale(1.0 / SIGMA).max(S::constant(1e-300)).sqrt().sqrt() - S::constant(KELVIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 20 degC: 5.670374419e-8 293.15^4 = 418.766 W/m2, slope 4 418.766/293.15 = 5.71402 W/(m2 K).
    #[test]
    fn emission_by_hand() {
        let (value, slope) = Emission::Exact.at(20.0);
        assert!((value - 418.766).abs() < 1e-3 && (slope - 5.714_02).abs() < 1e-5, "{value}, {slope}");
        assert!((black_temperature(value) - 20.0_f64).abs() < 1e-12);
        // The tangent at 20 degC, 10 K away.
        let (linear, same_slope) = Emission::Linearised(20.0).at(30.0);
        assert!((linear - (value + 10.0 * slope)).abs() < 1e-12);
        assert_eq!(same_slope, slope);
    }
}
