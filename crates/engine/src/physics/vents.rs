//! Openings that pressure drives air through: flow by pressure difference, and the pressure of the wind on a wall.
//!
//! - Flow: `V = C_d A sqrt(2/rho) 4^(1/2 - n) |dp|^(n - 1) dp` [m3/s], rho the density of the air that passes. With the exponent n = 1/2 this is the orifice; other
//!   exponents are those of leaks whose leakage area is given at 4 Pa (ASHRAE Handbook of Fundamentals 2017, ch. 16).
//! - Near zero the root would have an infinite slope, and Newton's method would not converge (Walton 1989, Airflow network
//!   models for element-based building airflow modeling, ASHRAE Trans. 95(2), 611-620): `|dp|` is rounded off within 0.2 mPa, which
//!   makes the flow linear there, as a laminar flow is.
//! - A tall opening is two openings of half the area, 2/9 of the height above and below its middle: with equal pressures in the
//!   middle they exchange `C_d W H/3 sqrt(g H |dT|/T)`, as the whole opening does (Brown & Solvason 1962,
//!   doi:10.1016/0017-9310(62)90184-9).
//! - Wind on the wall of a low building (Swami & Chandra 1988, Correlations for pressure distribution on buildings and calculation of
//!   natural-ventilation airflow, ASHRAE Trans. 94(1), 243-266), at an angle a from its normal, and a wall S times as long as the next:
//!
//! ```text
//! C_p = 0.6 ln(1.248 - 0.703 sin(a/2) - 1.175 sin(a)^2 + 0.131 sin(2 a G)^3 + 0.769 cos(a/2) + 0.07 G^2 sin(a/2)^2
//!              + 0.717 cos(a/2)^2),   G = ln S
//! ```

use crate::input::description;
use crate::number::real::Real;

/// Pressure differences are rounded off within this [Pa].
const ROUND_OFF: f64 = 2e-4;
/// Pressure that leakage areas are given at [Pa].
const LEAKAGE_PRESSURE: f64 = 4.0;
/// Part of the height of an opening that its two halves are above and below its middle [-].
pub(crate) const HALF_PLACE: f64 = 2.0 / 9.0;

/// A flow by pressure difference.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PressureFlow<S> {
    /// The flow, in the unit of the strength.
    pub(crate) flow: S,
    /// Its slope, and the flow over the pressure difference [1/Pa].
    pub(crate) slope: S,
    pub(crate) secant: S,
}

/// Volume flow of an opening at 1 Pa [m3/s]: free area [m2], discharge coefficient, exponent, density [kg/m3].
pub(crate) fn strength<S: Real>(area: S, discharge: S, exponent: S, density: S) -> S {
    let to_power = (S::constant(0.5) - exponent).scale(Real::ln(LEAKAGE_PRESSURE)).exp();
    discharge * area * (S::constant(2.0) / density).sqrt() * to_power
}

/// The flow of an opening at a pressure difference [Pa]; it rises everywhere.
#[inline(always)]
pub(crate) fn flow<S: Real>(strength: S, exponent: S, difference: S) -> PressureFlow<S> {
    let square = difference * difference;
    let rounded = square + S::constant(ROUND_OFF * ROUND_OFF);
    let below_one = exponent - S::one();
    let secant = strength * (below_one.scale(0.5) * rounded.ln()).exp();
    PressureFlow {
        flow: secant * difference,
        slope: secant * (S::one() + below_one * square / rounded),
        secant,
    }
}

/// How the pressure of the wind on an opening depends on its direction.
#[derive(Debug, Clone)]
pub(crate) enum Coefficients<S> {
    /// A wall of a low building; logarithm of its length over that of the next wall.
    LowRise { log_ratio: S },
    /// At equal angles, clockwise from the normal of the opening.
    Table(Vec<f64>),
}

impl<S: Real> Coefficients<S> {
    pub(crate) fn new(shape: &description::WindPressure, get: impl Fn(description::ParamId) -> S) -> Self {
        match shape {
            description::WindPressure::LowRise { side_ratio } => {
                Self::LowRise { log_ratio: get(*side_ratio).ln() }
            }
            description::WindPressure::Table { coefficients } => Self::Table(coefficients.clone()),
        }
    }

    /// The coefficient where the wind comes from a direction and the normal of the opening has an azimuth [deg].
    pub(crate) fn at(&self, direction: f64, azimuth: S) -> S {
        let whole = S::constant(360.0);
        // The direction is between 0 and 360, the azimuth between -360 and 360.
        let turn = S::constant(direction) - azimuth;
        let turn = S::select(turn.lt(S::zero()), turn + whole, turn);
        let turn = S::select(turn.lt(whole), turn, turn - whole);
        match self {
            Self::LowRise { log_ratio } => low_rise(turn.min(whole - turn), *log_ratio),
            Self::Table(table) => interpolated(table, turn),
        }
    }
}

/// By Swami & Chandra; the angle is from 0 to 180 deg.
fn low_rise<S: Real>(angle: S, log_ratio: S) -> S {
    let angle = angle.scale(core::f64::consts::PI / 180.0);
    let half = angle.scale(0.5);
    let (sin_half, cos_half, sin) = (half.sin(), half.cos(), angle.sin());
    let side = (angle * log_ratio).scale(2.0).sin();
    let sum = S::constant(1.248) - sin_half.scale(0.703) - (sin * sin).scale(1.175)
        + (side * side * side).scale(0.131)
        + cos_half.scale(0.769)
        + (log_ratio * log_ratio * sin_half * sin_half).scale(0.07)
        + (cos_half * cos_half).scale(0.717);
    sum.ln().scale(0.6)
}

/// On straight lines between values at equal angles of a whole turn.
fn interpolated<S: Real>(table: &[f64], angle: S) -> S {
    let width = 360.0 / table.len() as f64;
    let [start, value, slope] = angle.look_up(|angle| {
        let place = (0..table.len()).rev().find(|&k| k as f64 * width <= angle).unwrap_or(0);
        let next = table[(place + 1) % table.len()];
        [place as f64 * width, table[place], (next - table[place]) / width]
    });
    value + slope * (angle - start)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 m2, discharge 0.6, 1.2 kg/m3: at 10 Pa `0.6 sqrt(2 10/1.2) = 2.44949 m3/s`; a leak of exponent 0.65 agrees at 4 Pa.
    #[test]
    fn an_orifice_by_hand() {
        let orifice = strength(1.0, 0.6, 0.5, 1.2);
        assert!((flow(orifice, 0.5, 10.0).flow - 2.449_489_7).abs() < 1e-6);
        assert!((flow(orifice, 0.5, -10.0).flow + 2.449_489_7).abs() < 1e-6);
        let leak = strength(1.0, 0.6, 0.65, 1.2);
        assert!((flow(leak, 0.65, 4.0).flow / flow(orifice, 0.5, 4.0).flow - 1.0).abs() < 1e-6);
        for difference in [-2.0, -1e-3, 0.0, 1e-4, 0.3] {
            let [a, b] = [-1.0, 1.0].map(|sign: f64| flow(leak, 0.65, difference + sign * 1e-7).flow);
            let law = flow(leak, 0.65, difference);
            assert!(((b - a) / 2e-7 / law.slope - 1.0).abs() < 1e-6, "{difference}");
            assert!((law.secant * difference - law.flow).abs() < 1e-15);
        }
    }

    /// Windward 0.6 ln 2.734 = 0.60346; at the side 0.6 ln(1.248 - 0.703/sqrt2 - 1.175 + 0.769/sqrt2 + 0.3585) = -0.44267; leeward
    /// 0.6 ln 0.545 = -0.36418; the same from both sides.
    #[test]
    fn walls_of_a_low_building() {
        let square = Coefficients::LowRise { log_ratio: 0.0 };
        assert_eq!(square.at(20.0, -340.0), square.at(20.0, 20.0));
        for (direction, expected) in
            [(90.0, 0.603_46), (180.0, -0.442_67), (0.0, -0.442_67), (270.0, -0.364_18)]
        {
            let found: f64 = square.at(direction, 90.0);
            assert!((found - expected).abs() < 1e-5, "{found} from {direction}");
        }
        let long = Coefficients::LowRise { log_ratio: Real::ln(2.0_f64) };
        let (left, right): (f64, f64) = (long.at(10.0, 60.0), long.at(110.0, 60.0));
        assert!((left - right).abs() < 1e-15);
    }

    /// A table goes round once, clockwise from the normal.
    #[test]
    fn coefficients_of_a_table() {
        let table: Coefficients<f64> = Coefficients::Table(vec![0.6, -0.4, -0.2, -0.8]);
        for (direction, expected) in [(30.0, 0.6), (75.0, 0.1), (120.0, -0.4), (345.0, -0.1), (300.0, -0.8)] {
            assert!((table.at(direction, 30.0) - expected).abs() < 1e-12, "{direction}");
        }
        let one: Coefficients<f64> = Coefficients::Table(vec![-0.5]);
        assert_eq!(one.at(200.0, 10.0), -0.5);
    }
}
