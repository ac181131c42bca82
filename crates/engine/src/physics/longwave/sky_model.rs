//! What every model of the sky offers, and the weather that it is given.

use crate::input::forcing::channel;
use crate::number::real::Real;
use crate::physics::constants::KELVIN;
use crate::physics::law_row::{Default, LawParameter, LawRange, LawRow, Limits, Numbers};
use crate::physics::psychrometrics::saturation_pressure;

/// A model of the emission of the sky that a description has by its name.
pub(crate) trait SkyModel<S: Real>: Sized {
    /// What it says of itself.
    const ROW: LawRow;

    /// Reads its numbers.
    fn new(number: &Numbers<'_, S>) -> Self;

    /// What it says of the sky in the weather of an instant.
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S>;
}

/// What a model gives.
#[derive(Debug, Clone, Copy)]
pub(crate) enum SkyValue<S> {
    /// Emissivity of the clear sky, which clouds act on [-].
    ClearEmissivity(S),
    /// Emissivity of the sky with its clouds [-].
    Emissivity(S),
    /// Temperature [K].
    Temperature(S),
    /// Emission downwards on a horizontal plane [W/m2].
    Emission(S),
}

/// The weather that models of the sky depend on.
#[derive(Debug, Clone, Copy, Default)]
pub struct SkyWeather {
    /// Air temperature [K].
    pub(crate) air: f64,
    /// Dew point [degC].
    pub(crate) dew_point: f64,
    /// Cloud cover [tenths].
    pub(crate) cloud_cover: f64,
    /// Measured emission of the sky downwards on a horizontal plane [W/m2].
    pub(crate) infrared: f64,
    /// Sine of the sun's altitude, negative at night [-].
    pub(crate) sun_up: f64,
}

impl SkyWeather {
    /// Reads a forcing row.
    #[must_use]
    pub fn new(row: &[f64]) -> Self {
        Self {
            air: row[channel::AIR_TEMPERATURE] + KELVIN,
            dew_point: row[channel::DEW_POINT],
            cloud_cover: row[channel::CLOUD_COVER],
            infrared: row[channel::INFRARED],
            sun_up: row[channel::SUN_UP],
        }
    }

    /// On the straight line through two instants: `fraction` 0 at the first, 1 at the second.
    pub(crate) fn between(first: &Self, second: &Self, fraction: f64) -> Self {
        let line = |a: f64, b: f64| a + fraction * (b - a);
        Self {
            air: line(first.air, second.air),
            dew_point: line(first.dew_point, second.dew_point),
            cloud_cover: line(first.cloud_cover, second.cloud_cover),
            infrared: line(first.infrared, second.infrared),
            sun_up: line(first.sun_up, second.sun_up),
        }
    }

    /// Vapour pressure [Pa].
    #[inline(always)]
    pub(crate) fn vapour_pressure(&self) -> f64 {
        saturation_pressure(self.dew_point)
    }
}

/// A coefficient of the emissivity of the clear sky, with the value of a publication.
pub(crate) const fn emissivity_coefficient(
    name: &'static str,
    value: f64,
    source: &'static str,
) -> LawParameter {
    let range = LawRange::Percent(
        10.0,
        "standard error of the published fit and the differences between the sites it was fitted to",
    );
    LawParameter::new(name, "-", "Coefficient of the emissivity of the clear sky", range, value)
        .limits(Limits::NONE)
        .default(Default::Published(value, source))
}
