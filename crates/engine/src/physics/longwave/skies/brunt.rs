//! Brunt: emissivity `a + b sqrt(pw)` of the clear sky, vapour pressure in hPa.
//!
//! Sources: Brunt (1932), Quarterly Journal of the Royal Meteorological Society 58, doi:10.1002/qj.49705824704; coefficients
//! recalibrated by Li, Jiang & Coimbra (2017), Solar Energy 144, doi:10.1016/j.solener.2017.01.006.
//!
//! Range: seven stations of the United States, days and nights.

use crate::physics::longwave::prelude::*;

const COEFFICIENTS: &str = "Li, Jiang & Coimbra 2017, doi:10.1016/j.solener.2017.01.006";

/// `a + b sqrt(pw)`.
#[derive(Debug, Clone)]
pub(crate) struct Brunt<S> {
    a: S,
    b: S,
}

impl<S: Real> SkyModel<S> for Brunt<S> {
    const ROW: LawRow = LawRow::new(
        "Brunt",
        "Emissivity ``a + b sqrt(pw)`` of the clear sky, vapour pressure in hPa.",
        "the clear sky",
    )
    .source("Brunt 1932, doi:10.1002/qj.49705824704 (emissivity of the clear sky)")
    .further_sources(&[
        "ASHRAE Handbook of Fundamentals 2017, ch. 1, eq. 6 (vapour pressure at the dew point)",
    ])
    .numbers(&[
        emissivity_coefficient("a", 0.618, COEFFICIENTS),
        emissivity_coefficient("b", 0.056, COEFFICIENTS),
    ])
    .weather(&["dew_point", "cloud_cover"])
    .clouds(CloudKind::Factor)
    .alternatives(&[Alternative::USUAL]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { a: number.of("a"), b: number.of("b") }
    }

    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        // His law takes the vapour pressure in [hPa].
        let humidity = Real::sqrt(weather.vapour_pressure().scale(0.01));
        SkyValue::ClearEmissivity(self.a + self.b.scale(humidity))
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::longwave::testing::assert_emission;

    /// Vapour pressure 12.27995 hPa: 0.52 + 0.065 3.504276 = 0.747778 of 418.766 W/m2.
    #[test]
    fn brunt_by_hand() {
        assert_emission("brunt", &[("a", 0.52), ("b", 0.065)], 0.747_778 * 418.766);
    }
}
