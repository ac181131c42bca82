//! The sun over a step: means of its stages.

use crate::number::real::Real;
use crate::weather::sun::SolarConditions;

/// The sun over a step: means of its stages.
#[derive(Debug, Clone)]
pub struct SolarMeans<S> {
    /// Irradiance from each of [`WeatherIndex::irradiance_sources`] [W/m2].
    pub(crate) irradiances: Vec<S>,
    /// The part of each from the sun's disc [W/m2]; empty where nobody reads it.
    pub(crate) beams: Vec<S>,
    /// Transmitted by each window [W].
    pub windows: Vec<S>,
    /// Transmitted into each zone, from other zones included [W].
    pub zones: Vec<S>,
    /// Lost outdoors from each zone [W].
    pub lost: Vec<S>,
}

impl<S: Real> SolarMeans<S> {
    /// Zeros for a building.
    #[must_use]
    pub fn new(sun: &SolarConditions<S>) -> Self {
        let zeros = |count: usize| vec![S::zero(); count];
        Self {
            irradiances: zeros(sun.irradiances.len()),
            beams: zeros(sun.beams.len()),
            windows: zeros(sun.windows.len()),
            zones: zeros(sun.zones.len()),
            lost: zeros(sun.zones.len()),
        }
    }

    /// Sets all means to zero.
    #[inline(always)]
    pub fn restart(&mut self) {
        let Self { irradiances, beams, windows, zones, lost } = self;
        for means in [irradiances, beams, windows, zones, lost] {
            means.fill(S::zero());
        }
    }

    /// Adds a stage by its weight.
    #[inline(always)]
    pub fn add(&mut self, sun: &SolarConditions<S>, weight: f64) {
        for (mean, irradiance) in self.irradiances.iter_mut().zip(&sun.irradiances) {
            *mean += irradiance.scale(weight);
        }
        for (mean, beam) in self.beams.iter_mut().zip(&sun.beams) {
            *mean += beam.scale(weight);
        }
        for (mean, window) in self.windows.iter_mut().zip(&sun.windows) {
            *mean += window.transmitted.scale(weight);
        }
        for ((mean, lost), zone) in self.zones.iter_mut().zip(&mut self.lost).zip(&sun.zones) {
            *mean += zone.transmitted.scale(weight);
            *lost += zone.lost.scale(weight);
        }
        for (mean, exchanged) in self.zones.iter_mut().zip(&sun.exchanged) {
            *mean += exchanged.scale(weight);
        }
    }
}
