//! Measured emission of the sky, times a factor.

use crate::physics::longwave::prelude::*;

const SCALE: LawParameter = LawParameter::new(
    "scale",
    "-",
    "Factor on the measured infrared of the sky",
    LawRange::Within(0.05, "calibration of a pyrgeometer, and the radiation of its body"),
    1.02,
)
.positive()
.default(Default::Value(1.0, "the measurement without a correction"));

/// `scale L`.
#[derive(Debug, Clone)]
pub(crate) struct Measured<S> {
    scale: S,
}

impl<S: Real> SkyModel<S> for Measured<S> {
    const ROW: LawRow = LawRow::new(
        "measured",
        "Measured horizontal infrared radiation of the climate, times a factor.",
        "everywhere",
    )
    .numbers(&[SCALE])
    .weather(&["infrared"]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { scale: number.of("scale") }
    }

    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        SkyValue::Emission(self.scale.scale(weather.infrared))
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::longwave::testing::assert_emission;

    #[test]
    fn measured_by_hand() {
        assert_emission("measured", &[("scale", 1.1)], 1.1 * 333.0);
    }
}
