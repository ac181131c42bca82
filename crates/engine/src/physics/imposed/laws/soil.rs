//! Kusuda and Achenbach: undisturbed soil at a depth, `mean - amplitude e^(-x) cos(2 pi (day - coldest_day)/365 - x)`, with
//! `x = depth sqrt(pi/(year diffusivity))`.
//!
//! Source: Kusuda & Achenbach (1965), Earth temperature and thermal diffusivity at selected stations in the United States, ASHRAE
//! Trans. 71(1), 61-75; the wave is that of a half-infinite solid, Carslaw & Jaeger (1959), Conduction of Heat in Solids, ch. 2.6.
//!
//! Range: soil without a building above it, of a constant diffusivity.

use crate::physics::imposed::prelude::*;

/// [s].
const YEAR: f64 = 365.0 * 86_400.0;

const AMPLITUDE: LawParameter = LawParameter::new(
    "amplitude",
    "K",
    "Annual amplitude of the temperature at the surface of the ground",
    LawRange::Percent(20.0, "cover, shade and snow"),
    10.0,
)
.at_most(60.0);

const DEPTH: LawParameter =
    LawParameter::new("depth", "m", "Depth below the surface of the ground", LawRange::Within(0.3, "drawings"), 1.5);

const DIFFUSIVITY: LawParameter = LawParameter::new(
    "diffusivity",
    "m2/s",
    "Thermal diffusivity of the soil",
    LawRange::Span(3e-7, 1.2e-6, "dry sand to wet clay"),
    6e-7,
)
.positive()
.at_most(1e-4)
.default(Default::Assumed(6e-7, "Kusuda & Achenbach 1965: the middle of their stations"));

/// `mean - amplitude e^(-x) cos(2 pi (day - coldest_day)/365 - x)`.
#[derive(Debug, Clone)]
pub(crate) struct Soil<S> {
    mean: S,
    swing: [S; 2],
}

impl<S: Real> ImposedLaw<S> for Soil<S> {
    const ROW: LawRow = LawRow::new(
        "Kusuda and Achenbach",
        "Undisturbed soil at a depth, by the annual wave at the surface of the ground.",
        "soil of constant diffusivity without a building above it",
    )
    .source("Kusuda & Achenbach 1965, ASHRAE Trans. 71(1), 61-75 (temperature of undisturbed soil)")
    .numbers(&[MEAN, AMPLITUDE, DEPTH, DIFFUSIVITY, COLDEST_DAY]);

    fn new(number: &Numbers<'_, S>) -> Self {
        let decay = (S::constant(core::f64::consts::PI / YEAR) / number.of("diffusivity")).sqrt();
        let x = number.of("depth") * decay;
        let amplitude = number.of("amplitude") * (-x).exp();
        Self { mean: number.of("mean"), swing: swing(amplitude, number.of("coldest_day").scale(PER_DAY) + x) }
    }

    #[inline(always)]
    fn temperature(&self, at: &ImposedWeather) -> S {
        self.mean - swung(&self.swing, at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::imposed::testing::temperature;

    /// At a depth of `1/decay` the wave is e times smaller, and one radian, 58.09 days, late: 12 - 10/e = 8.3212 degC.
    #[test]
    fn soil_by_hand() {
        let depth = Real::sqrt(6e-7 * YEAR / core::f64::consts::PI);
        assert!((depth - 2.4542).abs() < 1e-4, "{depth}");
        let numbers =
            [("mean", 12.0), ("amplitude", 10.0), ("depth", depth), ("diffusivity", 6e-7), ("coldest_day", 30.0)];
        let coldest = temperature("soil", &numbers, 30.0 + 58.0916, 0.0);
        assert!((coldest - 8.3212).abs() < 1e-4, "{coldest}");
    }
}
