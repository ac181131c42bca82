//! Martin and Berdahl: emissivity `a + b (tdp/100) + c (tdp/100)^2` of the clear sky, dew point in degC.
//!
//! Source: Martin & Berdahl (1984), Solar Energy 33(3), 321-336, doi:10.1016/0038-092X(84)90162-2.
//!
//! Range: monthly means of six sites of the United States; dew points from -13 to 24 degC.

use crate::physics::longwave::prelude::*;

const SOURCE: &str = "Martin & Berdahl 1984, doi:10.1016/0038-092X(84)90162-2";

/// `a + b (tdp/100) + c (tdp/100)^2`.
#[derive(Debug, Clone)]
pub(crate) struct MartinBerdahl<S> {
    a: S,
    b: S,
    c: S,
}

impl<S: Real> SkyModel<S> for MartinBerdahl<S> {
    const ROW: LawRow = LawRow::new(
        "Martin and Berdahl",
        "Emissivity ``a + b (tdp/100) + c (tdp/100)^2`` of the clear sky, dew point in degC.",
        "the clear sky",
    )
    .source(SOURCE)
    .numbers(&[
        emissivity_coefficient("a", 0.711, SOURCE),
        emissivity_coefficient("b", 0.56, SOURCE),
        emissivity_coefficient("c", 0.73, SOURCE),
    ])
    .weather(&["dew_point", "cloud_cover"])
    .clouds(CloudKind::Layer)
    .alternatives(&[Alternative::USUAL]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { a: number.of("a"), b: number.of("b"), c: number.of("c") }
    }

    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        let humidity = weather.dew_point / 100.0;
        SkyValue::ClearEmissivity(self.a + self.b.scale(humidity) + self.c.scale(humidity * humidity))
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::longwave::testing::assert_emission;

    /// Dew point 10 degC: 0.711 + 0.56 0.1 + 0.73 0.01 = 0.7743 of 418.766 W/m2.
    #[test]
    fn martin_berdahl_by_hand() {
        assert_emission("martin_berdahl", &[("a", 0.711), ("b", 0.56), ("c", 0.73)], 0.7743 * 418.766);
    }
}
