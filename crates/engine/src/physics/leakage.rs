//! Infiltration by a pressure test.
//!
//! The test gives `n50` [1/h], the air changes at 50 Pa between inside and outdoors.
//!
//! - `factor n50`: EN ISO 13789:2017, annex C, with a factor by shielding and exposed sides.
//! - By stack and wind: the leakage area at 4 Pa, `A = n50 V/3600 (4/50)^n sqrt(rho/(2 4))` [m2], lets
//!   `Q = A sqrt(C_s |d| + C_w U^2)` in, where Q is in L/s and A in cm2: ten times the flow in m3/s by square metres. Basic model
//!   of ASHRAE Handbook of Fundamentals 2017, ch. 16, eq. 48, after Sherman & Grimsrud (1980), Infiltration-pressurization
//!   correlation: simplified physical modeling, ASHRAE Trans. 86(2), 778-807. Density 1.2 kg/m3; U is the wind at the mast.

use crate::input::description;
use crate::input::values::Values;
use crate::number::line::Line;
use crate::number::real::Real;

/// Temperature differences are rounded off within this [K].
const ROUND_OFF: f64 = 0.01;
/// Pressure of the leakage area and of the test [Pa], and density of air [kg/m3].
const LOW: f64 = 4.0;
const HIGH: f64 = 50.0;
const DENSITY: f64 = 1.2;
/// Cubic metres per second by square metres, from litres per second by square centimetres.
const UNITS: f64 = 10.0;

/// Infiltration by stack and wind: `scale sqrt(stack |d| + wind U^2)` [1/h].
#[derive(Debug, Clone)]
pub struct StackWind<S> {
    /// [1/h per m/s].
    scale: S,
    stack: S,
    wind: S,
}

/// Constant air changes [1/h], and those by stack and wind, of a pressure test.
pub(crate) fn leakage<S: Real>(
    test: &description::Leakage,
    values: &Values<'_, S>,
) -> (S, Option<StackWind<S>>) {
    match test {
        description::Leakage::Factor { n50, factor } => (values.get(*n50) * values.get(*factor), None),
        description::Leakage::StackWind { n50, exponent, stack, wind } => {
            let low = S::constant(LOW / HIGH).powf(values.get(*exponent));
            let scale = (values.get(*n50) * low).scale(UNITS * Real::sqrt(DENSITY / (2.0 * LOW)));
            (S::zero(), Some(StackWind { scale, stack: values.get(*stack), wind: values.get(*wind) }))
        }
    }
}

impl<S: Real> StackWind<S> {
    /// Air changes [1/h] and their slope in the temperature difference `d` [1/(h K)].
    #[inline(always)]
    fn rate(&self, wind: S, d: S) -> (S, S) {
        let magnitude = d.smooth_abs(ROUND_OFF);
        // Without stack and wind the root would have an infinite slope.
        let root = (self.stack * magnitude + self.wind * wind * wind).max(S::constant(1e-30)).sqrt();
        (self.scale * root, self.scale * self.stack * (d / magnitude) / root.scale(2.0))
    }

    /// Air changes [1/h] at a difference `d` between outdoors and the zone.
    #[inline(always)]
    pub(crate) fn air_changes(&self, wind: S, d: S) -> S {
        self.rate(wind, d).0
    }

    /// Heat that it brings into a zone, as its tangent in `d = T_outdoor - T_air`; `air_capacity` of its air [J/K].
    #[inline(always)]
    pub(crate) fn heat(&self, air_capacity: S, wind: S, outdoor: S, air: S) -> Line<S> {
        let d = outdoor - air;
        let per_second = air_capacity.scale(1.0 / 3600.0);
        let (rate, rise) = self.rate(wind, d);
        Line::tangent(per_second * rate * d, per_second * (rate + rise * d), d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    /// n50 2.2, exponent 0.65, one storey, class 3, 20 K and 4 m/s: `2.2 0.08^0.65 10 sqrt(0.15) sqrt(0.0029 + 0.002784) = 0.12438 1/h`.
    #[test]
    fn stack_and_wind_by_hand() {
        let id = ParamId;
        let test = description::Leakage::StackWind { n50: id(0), exponent: id(1), stack: id(2), wind: id(3) };
        let numbers = [2.2, 0.65, 0.000_145, 0.000_174];
        let (constant, law) = leakage(&test, &Values::new(&numbers));
        let law = law.unwrap();
        let expected = 2.2 * Real::powf(0.08, 0.65) * 10.0 * 0.15_f64.sqrt() * 0.005_684_f64.sqrt();
        assert_eq!(constant, 0.0);
        assert!(
            (law.air_changes(4.0, -20.0) / expected - 1.0).abs() < 1e-6,
            "{}",
            law.air_changes(4.0, -20.0)
        );
        assert!((expected - 0.1244).abs() < 1e-4, "{expected}");
        let heat = |air: f64| law.heat(3600.0, 4.0, 0.0, air);
        let difference = (heat(20.0 - 1e-4).at(-20.0 + 1e-4) - heat(20.0 + 1e-4).at(-20.0 - 1e-4)) / 2e-4;
        assert!((heat(20.0).slope / difference - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_factor_by_hand() {
        let test = description::Leakage::Factor { n50: ParamId(0), factor: ParamId(1) };
        assert_eq!(leakage(&test, &Values::new(&[2.0, 0.07])).0, 0.14);
    }
}
