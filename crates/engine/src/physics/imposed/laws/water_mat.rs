//! A mat of water pipes behind the side, by a heating curve: water of `indoor + steepness (limit - T_o)` below the heating limit, off above it.
//!
//! Range: a flow so large that the water cools little on its way; the control follows the outdoor air alone.

use crate::physics::imposed::prelude::*;

const INDOOR: LawParameter = LawParameter::new(
    "indoor",
    "degC",
    "Temperature of the water at the heating limit",
    LawRange::Within(2.0, "set by hand"),
    21.0,
)
.limits(TEMPERATURES);

const STEEPNESS: LawParameter = LawParameter::new(
    "steepness",
    "K/K",
    "Rise of the water with the fall of the outdoor air",
    LawRange::Span(0.2, 1.0, "panels of good to poor insulation"),
    0.5,
)
.at_most(10.0);

const COEFFICIENT: LawParameter = LawParameter::new(
    "coefficient",
    "W/(m2 K)",
    "Conductance from the water to the surface",
    LawRange::Percent(30.0, "spacing of the pipes"),
    8.0,
);

/// `indoor + steepness (limit - T_o)` through a coefficient, below the limit.
#[derive(Debug, Clone)]
pub(crate) struct WaterMat<S> {
    indoor: S,
    steepness: S,
    limit: S,
    coefficient: S,
}

impl<S: Real> ImposedLaw<S> for WaterMat<S> {
    const ROW: LawRow = LawRow::new(
        "water mat",
        "A mat of water pipes behind the side, its water by a heating curve; off above the heating limit.",
        "a flow so large that the water cools little on its way",
    )
    .gives_coefficient()
    .numbers(&[INDOOR, STEEPNESS, HEATING_LIMIT, COEFFICIENT]);

    fn new(number: &Numbers<'_, S>) -> Self {
        let [indoor, steepness, limit, coefficient] =
            ["indoor", "steepness", "limit", "coefficient"].map(|name| number.of(name));
        Self { indoor, steepness, limit, coefficient }
    }

    #[inline(always)]
    fn temperature(&self, at: &ImposedWeather) -> S {
        self.indoor + self.steepness * (self.limit - S::constant(at.outdoor_air)).max(S::zero())
    }

    fn coefficient(&self, at: &ImposedWeather) -> S {
        S::select(S::constant(at.outdoor_air).lt(self.limit), self.coefficient, S::zero())
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::imposed::imposed_on;

    /// At -5 degC 21 + 0.5 x 20 degC through 8 W/(m2 K); at 16 degC nothing.
    #[test]
    fn water_mat_by_hand() {
        let numbers = [("indoor", 21.0), ("steepness", 0.5), ("limit", 15.0), ("coefficient", 8.0)];
        assert_eq!(imposed_on("water_mat", &numbers, 1.0, -5.0), Ok((31.0, None, Some(8.0))));
        assert_eq!(imposed_on("water_mat", &numbers, 1.0, 16.0), Ok((21.0, None, Some(0.0))));
    }
}
