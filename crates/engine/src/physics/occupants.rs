//! Heat of people: which part of it is sensible at an air temperature; the rest leaves them as vapour.
//!
//! Sensible heat of a person by the heat `M` [W] of the activity and the air temperature `T` [degC], a polynomial of second degree
//! in both: a fit of the tables of the ASHRAE Handbook of Fundamentals (EnergyPlus 25.2 Engineering Reference, internal gains,
//! people). It is not less than zero and not more than `M`; in air colder than that of its maximum (2 degC at 120 W) it stays there,
//! where the polynomial would fall again.
//!
//! The air temperature is that of the start of a step, as for densities of air: heat of people changes by some percent for each kelvin,
//! and the air by tenths of a kelvin in a step.

use crate::number::real::Real;

/// Coefficients of the powers of the air temperature; within each, of those of the heat of the activity.
const SENSIBLE: [[f64; 3]; 3] = [
    [6.461_927, 0.946_892, 0.000_025_573_7],
    [7.139_322, -0.062_790_9, 0.000_058_917_2],
    [-0.198_550, 0.000_940_018, -0.000_001_495_32],
];

/// Part of the heat of a person that is sensible [-]: of the heat of the activity [W] and the temperature of the air [degC].
pub(crate) fn sensible_share<S: Real>(activity: S, air: S) -> S {
    let [constant, linear, square] =
        SENSIBLE.map(|[a, b, c]| S::constant(a) + activity * (S::constant(b) + activity.scale(c)));
    // The coefficient of the square is negative at each activity.
    let air = air.max(linear / square.scale(-2.0));
    let heat = constant + air * (linear + air * square);
    (heat / activity).max(S::zero()).min(S::one())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seated people at 120 W: the formula by hand at 24 degC, all of it in cold air, none of it in air of 40 degC.
    #[test]
    fn sensible_part_of_the_heat_of_people() {
        // 120.45687 + 0.452816 * 24 - 0.107280 * 576, from the coefficients at 120 W.
        let by_hand = 6.461_927
            + 0.946_892 * 120.0
            + 0.000_025_573_7 * 14400.0
            + 24.0 * (7.139_322 - 0.062_790_9 * 120.0 + 0.000_058_917_2 * 14400.0)
            + 576.0 * (-0.198_550 + 0.000_940_018 * 120.0 - 0.000_001_495_32 * 14400.0);
        assert!((sensible_share(120.0, 24.0) * 120.0 - by_hand).abs() < 1e-9);
        assert!((by_hand - 69.5).abs() < 1.0, "{by_hand}");
        assert_eq!((sensible_share(120.0, -10.0), sensible_share(120.0, 40.0)), (1.0, 0.0));
    }
}
