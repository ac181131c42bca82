//! Clark and Allen: emissivity `a + b ln(Tdp/273)` of the clear sky, dew point in K.
//!
//! Source: Clark & Allen (1978), Proc. 2nd National Passive Solar Conference, 675-678.
//!
//! Range: nights and days of San Antonio, Texas; dew points from -10 to 25 degC.

use crate::physics::longwave::prelude::*;

const SOURCE: &str = "Clark & Allen 1978, Proc. 2nd National Passive Solar Conference, Philadelphia";

/// `a + b ln(Tdp/273)`.
#[derive(Debug, Clone)]
pub(crate) struct ClarkAllen<S> {
    a: S,
    b: S,
}

impl<S: Real> SkyModel<S> for ClarkAllen<S> {
    const ROW: LawRow = LawRow::new(
        "Clark and Allen",
        "Emissivity ``a + b ln(Tdp/273)`` of the clear sky, dew point in K.",
        "the clear sky",
    )
    .source(SOURCE)
    .numbers(&[emissivity_coefficient("a", 0.787, SOURCE), emissivity_coefficient("b", 0.764, SOURCE)])
    .weather(&["dew_point", "cloud_cover"])
    .clouds(CloudKind::Factor)
    .alternatives(&[Alternative::USUAL]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { a: number.of("a"), b: number.of("b") }
    }

    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        let humidity = Real::ln((weather.dew_point + KELVIN) / 273.0);
        SkyValue::ClearEmissivity(self.a + self.b.scale(humidity))
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::longwave::testing::assert_emission;

    /// Dew point 10 degC: 0.787 + 0.764 ln(283.15/273) = 0.814890 of 418.766 W/m2.
    #[test]
    fn clark_allen_by_hand() {
        assert_emission("clark_allen", &[("a", 0.787), ("b", 0.764)], 0.814_890 * 418.766);
    }
}
