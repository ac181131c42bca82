//! What acts on the building at one instant: on each surface, zone, window and air path.

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::BySurface;
use crate::building::plan::Plan;
use crate::input::forcing::channel;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::sky_emission;
use crate::weather::index::WeatherIndex;
pub use crate::weather::instant::{Instant, Weather};
pub use crate::weather::sun::{SolarConditions, SolarMeans, WindowConditions, ZoneSolar};
pub use crate::weather::surface::SurfaceConditions;
use crate::weather::surface::{forced, imposed_temperature};
use crate::weather::zone_conditions::ZoneConditions;

/// What acts on all parts of a building.
#[derive(Debug, Clone)]
pub struct Conditions<S: Real> {
    /// Per surface.
    pub surfaces: BySurface<SurfaceConditions<S>>,
    /// Per zone.
    pub zones: Vec<ZoneConditions<S>>,
    /// Heat carried between two zones, per path [W/K].
    pub paths: Vec<S>,
    /// Outdoor air [degC].
    pub outdoor_air: S,
    /// Wind at the mast [m/s].
    pub wind: S,
    /// Emission of the sky on a horizontal plane [W/m2].
    pub sky: S,
    /// The sun on planes, through windows and in zones.
    pub sun: SolarConditions<S>,
    /// Emission of the outdoor air by each of [`WeatherIndex::emissions`] [W/m2].
    from_air: Vec<S>,
}

impl<S: Real> Conditions<S> {
    /// Zeros for a building, in still air.
    #[must_use]
    pub(crate) fn new(plan: &Plan, coefficients: &Coefficients<S>, weather_index: &WeatherIndex<S>) -> Self {
        let zero = S::zero();
        let surfaces = coefficients.surfaces.iter().map(|surface| {
            let forced = surface.convection.as_ref().map_or([zero; 2], SurfaceConvection::calm);
            SurfaceConditions { solar: zero, longwave: zero, temperature: zero, forced }
        });
        Self {
            surfaces: surfaces.collect(),
            zones: coefficients.zones.iter().map(ZoneConditions::new).collect(),
            paths: vec![zero; coefficients.paths.len()],
            outdoor_air: zero,
            wind: zero,
            sky: zero,
            sun: SolarConditions::new(plan, weather_index),
            from_air: vec![zero; weather_index.emissions.len()],
        }
    }

    /// Linear interpolation or extrapolation of two instants: `fraction` 0 at the first, 1 at the second.
    ///
    /// Wind and the coefficients that depend on it are not extrapolated below zero.
    pub fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        for (at, (a, b)) in self.surfaces.iter_mut().zip(first.surfaces.iter().zip(&second.surfaces)) {
            at.solar = line(a.solar, b.solar);
            at.longwave = line(a.longwave, b.longwave);
            at.temperature = line(a.temperature, b.temperature);
            at.forced = [rate(a.forced[0], b.forced[0]), rate(a.forced[1], b.forced[1])];
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.interpolate(a, b, fraction);
        }
        for (at, (&a, &b)) in self.paths.iter_mut().zip(first.paths.iter().zip(&second.paths)) {
            *at = rate(a, b);
        }
        self.sun.interpolate(&first.sun, &second.sun, fraction);
        self.sky = line(first.sky, second.sky);
        self.outdoor_air = line(first.outdoor_air, second.outdoor_air);
        self.wind = rate(first.wind, second.wind);
    }

    /// Evaluates the weather at an instant.
    // Never inlined, one copy only: it is large and called in several places, where inlining multiplies compile time.
    #[inline(never)]
    pub(crate) fn update(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        numbers: &[S],
        now: &Instant<'_>,
    ) {
        S::vectorised(
            #[inline(always)]
            || self.evaluate(plan, coefficients, weather_index, numbers, now),
        );
    }

    #[inline(always)]
    fn evaluate(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        numbers: &[S],
        now: &Instant<'_>,
    ) {
        let site = &plan.description.site;
        let air = S::constant(now.row[channel::AIR_TEMPERATURE]);
        let sky = sky_emission(&Values::new(numbers), &site.sky, coefficients.cloud, &now.sky);
        (self.sky, self.outdoor_air) = (sky, air);
        self.wind = S::constant(now.wind.speed);
        self.sun.irradiate(plan, coefficients, weather_index, now);
        self.update_surfaces(coefficients, weather_index, now);
        for (at, zone) in self.zones.iter_mut().zip(&coefficients.zones) {
            at.update(zone, now.row);
        }
        for (at, path) in self.paths.iter_mut().zip(&coefficients.paths) {
            *at = path.conductance(now.row);
        }
        if !self.sun.windows.is_empty() {
            self.sun.transmit(plan, coefficients, now);
            self.sun.distribute(plan, coefficients, now, &mut self.surfaces);
            self.sun.absorb_in_panes(plan, &mut self.surfaces);
        }
    }

    /// Air, sky, sun and wind on surfaces outdoors, and what is measured or imposed on others.
    #[inline(always)]
    fn update_surfaces(
        &mut self,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        let (air, sky, irradiances) = (self.outdoor_air, self.sky, &self.sun.irradiances);
        for (emission, law) in self.from_air.iter_mut().zip(&weather_index.emissions) {
            *emission = law.at(air).0;
        }
        for outside in &weather_index.outdoors {
            let at = &mut self.surfaces[outside.surface];
            at.temperature = air;
            if let Some(source) = outside.source {
                at.solar = outside.absorptance * irradiances[source];
            }
            if let Some(emission) = outside.emission {
                at.longwave = outside.of_air * self.from_air[emission] + outside.of_sky * sky;
            }
        }
        for &index in &weather_index.windy {
            self.surfaces[index].forced = forced(coefficients, index, now);
        }
        for &(index, source, absorptance) in &weather_index.irradiated {
            self.surfaces[index].solar = absorptance * irradiances[source];
        }
        for &index in &weather_index.imposed {
            if let Boundary::Imposed(imposed) = &coefficients.surfaces[index].boundary {
                self.surfaces[index].temperature = imposed_temperature(imposed, now);
            }
        }
    }
}
