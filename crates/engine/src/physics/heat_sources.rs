//! Water that exchanges heat with a plane in a wall, and thermostats with a throttling range.
//!
//! The plane has one temperature `T_p`, so that the water sees a stream of infinite capacity:
//!
//! `q = m c_p eps (T_supply - T_p)`, `eps = 1 - exp(-U/(m c_p))`, with `m` per area of the plane [kg/(s m2)].
//!
//! Source: Strand & Pedersen (1997), Implementation of a radiant heating and cooling model into an integrated building energy analysis
//! program, ASHRAE Trans. 103(1), 949-958; Kays & London (1984), Compact Heat Exchangers, 3rd ed. (effectiveness at a capacity ratio of zero).
//!
//! Range: steady flow, one temperature of the plane: pipes of close spacing, or `U` that contains the way through the layer between
//! the pipes (EN ISO 11855-2:2021). Heat stored in the water is left out.

use crate::number::real::Real;

/// Least capacity rate of a flow [W/(m2 K)]: below, the effectiveness is that of standing water.
const STANDING: f64 = 1e-9;

/// Effectiveness of a conductance at a capacity rate of the water, both per area [W/(m2 K)].
#[inline(always)]
pub(crate) fn effectiveness<S: Real>(conductance: S, capacity_rate: S) -> S {
    let units = conductance / capacity_rate.max(S::constant(STANDING));
    S::one() - (-units).exp()
}

/// Part of its power or flow that a thermostat asks for [-]: one half at the set point, all and nothing at the ends of the range about
/// it [K]. Heating is more the colder it is, cooling the warmer.
#[inline(always)]
pub(crate) fn throttled<S: Real>(temperature: S, set_point: S, range: S, cooling: bool) -> S {
    let below = (set_point - temperature) / range;
    let asked = S::constant(0.5) + if cooling { -below } else { below };
    asked.max(S::zero()).min(S::one())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One transfer unit: 1 - 1/e. Standing water has given all of its heat.
    #[test]
    fn effectiveness_by_hand() {
        assert!((effectiveness(20.0, 20.0) - 0.632_120_558_828_557_7).abs() < 1e-15);
        assert_eq!(effectiveness(20.0, 0.0), 1.0);
        assert_eq!(effectiveness(0.0, 20.0), 0.0);
    }

    /// 20 degC within 2 K: all at 19, half at 20, nothing at 21 degC; cooling the other way round.
    #[test]
    fn throttling_by_hand() {
        for (temperature, expected) in
            [(18.0, 1.0), (19.0, 1.0), (19.5, 0.75), (20.0, 0.5), (21.0, 0.0), (25.0, 0.0)]
        {
            assert_eq!(throttled(temperature, 20.0, 2.0, false), expected);
            assert_eq!(throttled(temperature, 20.0, 2.0, true), 1.0 - expected);
        }
    }
}
