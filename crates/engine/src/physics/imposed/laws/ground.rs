//! Temperature of the ground, `mean - amplitude cos(2 pi (day - coldest_day)/365)`.

use crate::physics::imposed::prelude::*;

const AMPLITUDE: LawParameter = LawParameter::new(
    "amplitude",
    "K",
    "Annual amplitude of the ground's temperature",
    LawRange::Span(0.0, 5.0, "meters deep to just below the floor"),
    4.0,
)
.at_most(60.0)
.default(Default::Value(0.0, "not given: the same all year"));

/// `mean - amplitude cos(2 pi (day - coldest_day)/365)`.
#[derive(Debug, Clone)]
pub(crate) struct Ground<S> {
    mean: S,
    swing: [S; 2],
}

impl<S: Real> ImposedLaw<S> for Ground<S> {
    const ROW: LawRow = LawRow::new(
        "ground",
        "Temperature of the ground: ``mean - amplitude cos(2 pi (day - coldest_day)/365)``.",
        "below buildings",
    )
    .numbers(&[MEAN, AMPLITUDE, COLDEST_DAY]);

    fn new(number: &Numbers<'_, S>) -> Self {
        // The amplitude is a factor of cosine and sine of the coldest day.
        let (amplitude, angle) = (number.of("amplitude"), number.of("coldest_day").scale(PER_DAY));
        Self { mean: number.of("mean"), swing: swing(amplitude, angle) }
    }

    #[inline(always)]
    fn temperature(&self, at: &ImposedWeather) -> S {
        self.mean - swung(&self.swing, at)
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::imposed::testing::temperature;

    /// On the coldest day 12 - 4 degC, a half year later 12 + 4 degC.
    #[test]
    fn ground_by_hand() {
        let numbers = [("mean", 12.0), ("amplitude", 4.0), ("coldest_day", 30.0)];
        assert!((temperature("ground", &numbers, 30.0, 0.0) - 8.0).abs() < 1e-12);
        assert!((temperature("ground", &numbers, 212.5, 0.0) - 16.0).abs() < 1e-12);
    }
}
