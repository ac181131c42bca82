//! The part of the irradiance of planes that comes from the sun's disc, where a run records it.

use crate::building::coefficients::Coefficients;
use crate::building::plan::Plan;
use crate::number::real::Real;
use crate::weather::index::{IrradianceSource, WeatherIndex};
use crate::weather::instant::Instant;
use crate::weather::sun::SolarConditions;

impl<S: Real> SolarConditions<S> {
    /// The part of the irradiance of all planes that comes from the sun's disc.
    // A rare part of a run: kept out of the code of the others.
    #[inline(never)]
    pub(super) fn light_beams(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        let (sunlight, dark) = (&now.sunlight, now.sunlight.dark());
        for (beam, source) in self.beams.iter_mut().zip(&weather_index.irradiance_sources) {
            *beam = match source {
                IrradianceSource::Uniform(plane, ground, surface) if !dark => {
                    S::constant(sunlight.on(plane, *ground, &now.visibility(plan, *surface)).beam)
                }
                IrradianceSource::Varied(plane, surface) if !dark => {
                    sunlight.on(plane, coefficients.ground_reflectance, &now.visibility(plan, *surface)).beam
                }
                _ => S::zero(),
            };
        }
    }
}
