//! The globe thermometer: radiation and natural convection at a black sphere in still air.
//!
//! `e sigma (T_r^4 - T_g^4) = 1.4 (|T_g - T_a|/D)^0.25 (T_g - T_a)`, with `T_g` of the globe, `T_a` of the air and `T_r` the mean
//! radiant temperature.
//!
//! Source: ISO 7726:1998, Ergonomics of the thermal environment, annex B (eqs. B.1 and B.5: natural convection at a globe of the diameter D).

use crate::number::real::Real;
use crate::physics::constants::{KELVIN, SIGMA};

/// Coefficient of natural convection at a sphere [W/(m1.75 K1.25)] (ISO 7726, annex B).
const CONVECTION: f64 = 1.4;
/// Ratios of difference and diameter below this count as this, so that the root has a slope [K/m]: what it changes is 1e-7 W/(m2 K).
const LEAST_RATIO: f64 = 1e-30;
/// Newton's iterations: they converge for differences of 200 K, and derivatives with them.
const ITERATIONS: usize = 12;

/// Temperature of a globe [degC] at temperatures of the air and the surroundings [degC], by its diameter [m] and emissivity [-].
///
/// The heat that it gains falls with its temperature at all temperatures, so that there is one solution, between air and surroundings.
/// With derivatives the last of Newton's iterations is the implicit function theorem.
pub fn globe_temperature<S: Real>(air: S, radiant: S, diameter: S, emissivity: S) -> S {
    let kelvin = S::constant(KELVIN);
    let surroundings = (radiant + kelvin).pow4();
    let mut globe = (air + radiant).scale(0.5);
    for _ in 0..ITERATIONS {
        let warmer = globe - air;
        let ratio = (warmer.abs() / diameter).max(S::constant(LEAST_RATIO));
        let coefficient = ratio.sqrt().sqrt().scale(CONVECTION);
        let absolute = globe + kelvin;
        let cube = absolute * absolute * absolute;
        let radiation = emissivity.scale(SIGMA);
        let gain = radiation * (surroundings - absolute.pow4()) - coefficient * warmer;
        let slope = (radiation * cube).scale(4.0) + coefficient.scale(1.25);
        globe += gain / slope;
    }
    globe
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

    /// A hot wall: the balance of ISO 7726 holds to round-off, and the mean radiant temperature comes back by its closed form
    /// `((T_g + 273)^4 + 1.4/(e sigma) (|T_g - T_a|/D)^0.25 (T_g - T_a))^0.25 - 273`.
    #[test]
    fn radiant_temperature_comes_back() {
        for (air, radiant) in
            [(20.0, 40.0), (30.0, 10.0), (-20.0, 60.0), (20.0, 20.001), (0.0, 200.0), (80.0, -60.0)]
        {
            let globe: f64 = globe_temperature(air, radiant, 0.15, 0.95);
            let difference: f64 = globe - air;
            let carried = 1.4 * (difference.abs() / 0.15).sqrt().sqrt() * difference;
            let back = ((globe + KELVIN).pow4() + carried / (0.95 * SIGMA)).sqrt().sqrt() - KELVIN;
            assert!((back - radiant).abs() < 1e-9, "{air}, {radiant}: {globe}, back {back}");
        }
        assert_eq!(globe_temperature(20.0, 20.0, 0.15, 0.95), 20.0);
    }

    /// Derivatives are those of the implicit function theorem, `dT_g/dT_a = 1.25 h/(4 e sigma T_g^3 + 1.25 h)` and
    /// `dT_g/dT_r = 4 e sigma T_r^3/(...)`, to round-off, and a difference quotient has them within its own error. Where globe, air
    /// and surroundings are equally warm, nothing is carried, and the globe follows the surroundings.
    #[test]
    fn derivatives_are_exact() {
        let (diameter, emissivity) = (0.15, 0.95);
        for (air, radiant) in [(20.0, 40.0), (30.0, 10.0), (-20.0, 60.0), (20.0, 20.01), (20.0, 20.0)] {
            let (a, r) = (Dual::<2>::variable(air, 0), Dual::variable(radiant, 1));
            let globe = globe_temperature(a, r, Dual::constant(diameter), Dual::constant(emissivity));
            let h = CONVECTION * ((globe.value - air).abs() / diameter).sqrt().sqrt();
            let radiation = |t: f64| 4.0 * emissivity * SIGMA * (t + KELVIN) * (t + KELVIN) * (t + KELVIN);
            let sum = radiation(globe.value) + 1.25 * h;
            let exact = [1.25 * h / sum, radiation(radiant) / sum];
            for (found, exact) in globe.slope.into_iter().zip(exact) {
                assert!((found - exact).abs() < 1e-7, "{air}, {radiant}: {found}, expected {exact}");
            }
            let at = |air, radiant| globe_temperature::<f64>(air, radiant, diameter, emissivity);
            if (air - radiant).abs() > 1.0 {
                let quotients = [
                    (at(air + 1e-4, radiant) - at(air - 1e-4, radiant)) / 2e-4,
                    (at(air, radiant + 1e-4) - at(air, radiant - 1e-4)) / 2e-4,
                ];
                for (found, quotient) in globe.slope.into_iter().zip(quotients) {
                    assert!(
                        (found - quotient).abs() < 1e-8,
                        "{air}, {radiant}: {found}, quotient {quotient}"
                    );
                }
            }
        }
    }
}
