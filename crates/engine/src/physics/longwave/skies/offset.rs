//! The sky at a constant difference below the air temperature, `T_sky = T_air - depression`.

use crate::physics::longwave::prelude::*;

const DEPRESSION: LawParameter = LawParameter::new(
    "depression",
    "K",
    "Outdoor air temperature minus sky temperature",
    LawRange::Span(3.0, 20.0, "overcast to clear and dry; annual means of ISO 13790 are 9 to 13 K"),
    9.0,
)
.limits(Limits { above: None, at_least: Some(-10.0), at_most: Some(60.0) })
.default(Default::Assumed(11.0, "ISO 13790:2008: between tropics and subpolar zones"));

/// `T_air - depression`.
#[derive(Debug, Clone)]
pub(crate) struct Offset<S> {
    depression: S,
}

impl<S: Real> SkyModel<S> for Offset<S> {
    const ROW: LawRow = LawRow::new(
        "a fixed difference below the air temperature",
        "Sky temperature at a constant difference below the air temperature.",
        "means over months",
    )
    .numbers(&[DEPRESSION]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { depression: number.of("depression") }
    }

    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        SkyValue::Temperature(S::constant(weather.air) - self.depression)
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::longwave::testing::assert_emission;

    /// 10 K below the air: sigma 283.15^4 = 364.484 W/m2.
    #[test]
    fn offset_by_hand() {
        assert_emission("offset", &[("depression", 10.0)], 364.484);
    }
}
