//! Emission of a black body, `sigma T^4` (Stefan-Boltzmann), or its tangent at a reference temperature.
//!
//! As a function of all real numbers `sigma T^4` is even: it falls below 0 K, and a heat balance has a second root there, which Newton's
//! iteration finds from a start that is far off. Below [`COLDEST`] the law goes on along its tangent. It is then convex, and rises
//! everywhere: balances of such laws have one solution, and Newton's iteration approaches it from above whatever it starts from (Ortega &
//! Rheinboldt 1970, Iterative Solution of Nonlinear Equations in Several Variables, ch. 13.3, doi:10.1137/1.9780898719468).

use crate::number::real::{Real, same};
use crate::physics::constants::{KELVIN, SIGMA};

/// Below this the emission goes on along its tangent [K]: colder than liquid nitrogen (77 K), and than any surface on earth. There it is
/// 0.35 W/m2.
pub(crate) const COLDEST: f64 = 50.0;

/// Emission of a black body at a temperature [degC], exact or linearised.
#[derive(Debug, Clone, Copy)]
pub enum Emission<S> {
    /// sigma T^4; below [`COLDEST`] its tangent there.
    Exact,
    /// Tangent at a reference temperature [degC], or at [`COLDEST`] where that is warmer.
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
        match self {
            Self::Exact => black_body(temperature + S::constant(KELVIN)),
            Self::Linearised(reference) => {
                let reference = reference.max(S::constant(COLDEST - KELVIN));
                let (value, slope) = black_body(reference + S::constant(KELVIN));
                (value + slope * (temperature - reference), slope)
            }
        }
    }
}

/// `sigma T^4` at an absolute temperature [K], below [`COLDEST`] along its tangent there, and the slope.
#[inline(always)]
fn black_body<S: Real>(kelvin: S) -> (S, S) {
    let touched = kelvin.max(S::constant(COLDEST));
    let cube = touched * touched * touched;
    let slope = cube.scale(4.0 * SIGMA);
    ((cube * touched).scale(SIGMA) + slope * (kelvin - touched), slope)
}

/// Temperature [degC] of a black body of an emission [W/m2].
pub fn black_temperature<S: Real>(emission: S) -> S {
    // No emission is absolute zero.
    emission.scale(1.0 / SIGMA).max(S::constant(1e-300)).sqrt().sqrt() - S::constant(KELVIN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

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

    /// The law rises over all real numbers, and its slope never falls: from -1e5 to 1e5 K. At 50 K it is 0.354398 W/m2, its slope
    /// 0.0283519 W/(m2 K); 10 K below, along the tangent, 0.0708797 W/m2; at -300 K -9.56876 W/m2. `sigma T^4` has 459.3 W/m2 there.
    #[test]
    fn emission_rises_everywhere() {
        let at = |kelvin: f64| Emission::Exact.at(kelvin - KELVIN);
        for (kelvin, expected) in [(50.0, 0.354_398_4), (40.0, 0.070_879_7), (-300.0, -9.568_757)] {
            assert!((at(kelvin).0 - expected).abs() < 1e-6, "{} at {kelvin} K", at(kelvin).0);
        }
        assert!((at(50.0).1 - 0.028_351_87).abs() < 1e-8 && at(-300.0).1 == at(50.0).1);
        let (mut value, mut slope) = at(-1e5);
        for k in -99_999..100_000 {
            let next = at(f64::from(k));
            assert!(next.0 > value && next.1 >= slope && next.0.is_finite(), "{k} K");
            (value, slope) = next;
        }
        // So does the tangent at any reference, and its slope is that of numbers with derivatives.
        for reference in [-1e4, -300.0, -250.0, 20.0] {
            let law = Emission::Linearised(reference);
            assert!(law.at(-400.0).1 > 0.0 && law.at(-400.0).0 < law.at(20.0).0, "{reference}");
        }
        for temperature in [-1000.0, -273.15, -230.0, -200.0, 20.0] {
            let seeded = Dual::<1>::variable(temperature, 0);
            let (value, slope) = Emission::Exact.at(seeded);
            assert!((value.slope[0] - slope.value).abs() <= 1e-12 * slope.value, "{temperature}");
        }
    }
}
