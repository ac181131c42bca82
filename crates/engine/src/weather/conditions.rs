//! What acts on the building at one instant: on each surface, zone, window and air path.

use crate::building::coefficients::{Boundary, BridgeEnd, Coefficients, Imposed};
use crate::building::humidity::HumidityPlan;
use crate::building::ids::{BySide, SideId};
use crate::building::plan::Plan;
use crate::input::forcing::{channel, scheduled};
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::physics::flow_density::AirDensities;
use crate::physics::longwave::SkyWeather;
use crate::weather::heat_sources::SourceConditions;
use crate::weather::humidity::HumidityConditions;
use crate::weather::index::WeatherIndex;
pub use crate::weather::instant::{Instant, Weather};
use crate::weather::mechanical_air::MechanicalConditions;
pub use crate::weather::sun::SolarConditions;
pub use crate::weather::surface::SurfaceConditions;
use crate::weather::surface::{driven_outside, forced, imposed_temperature, stratify};
use crate::weather::vents::VentConditions;
use crate::weather::zone_conditions::ZoneConditions;

/// What acts on all parts of a building.
#[derive(Debug, Clone)]
pub struct Conditions<S: Real> {
    /// Per surface.
    pub surfaces: BySide<SurfaceConditions<S>>,
    /// Per zone.
    pub zones: Vec<ZoneConditions<S>>,
    /// Heat carried between two zones, per path [W/K].
    pub paths: Vec<S>,
    /// Heat that each door carries at a temperature difference of 1 K [W].
    pub doors: Vec<S>,
    /// Flows that fans drive.
    pub mechanical_air: MechanicalConditions<S>,
    /// Openings of the pressure network.
    pub vents: VentConditions<S>,
    /// Humidity, in a building with vapour balances.
    pub(crate) humidity: Option<HumidityConditions<S>>,
    /// Densities of the air that flows are volumes of.
    pub(crate) densities: AirDensities<S>,
    /// Airs of the zones at the start of the step [degC]; empty where no people change their heat with them.
    airs: Vec<S>,
    /// Heat released between layers of walls.
    pub(crate) heat_sources: Vec<SourceConditions<S>>,
    /// Temperature at the other end of each thermal bridge; none where that is a zone [degC].
    pub bridges: Vec<Option<S>>,
    /// Outdoor air [degC].
    pub outdoor_air: S,
    /// Wind at the mast [m/s].
    pub wind: S,
    /// Emission of the sky on a horizontal plane [W/m2].
    pub sky: S,
    /// What the emission of the sky depends on.
    pub(crate) sky_weather: SkyWeather,
    /// The sun on planes, through windows and in zones.
    pub sun: SolarConditions<S>,
    /// Emission of the outdoor air by each of [`WeatherIndex::emissions`] [W/m2].
    from_air: Vec<S>,
    /// Surfaces whose convection is written as text.
    with_text: Box<[SideId]>,
}

impl<S: Real> Conditions<S> {
    /// Zeros for a building, in still air.
    #[must_use]
    pub(crate) fn new(plan: &Plan, coefficients: &Coefficients<S>, weather_index: &WeatherIndex<S>) -> Self {
        let zero = S::zero();
        let is_text = |&surface: &SideId| {
            coefficients.surfaces[surface].convection.as_ref().is_some_and(SurfaceConvection::is_text)
        };
        let surfaces = coefficients.surfaces.iter().map(|surface| {
            let forced = surface.convection.as_ref().map_or([zero; 4], SurfaceConvection::calm);
            SurfaceConditions { solar: zero, longwave: zero, temperature: zero, air_shift: zero, forced }
        });
        Self {
            surfaces: surfaces.collect(),
            zones: coefficients.zones.iter().map(ZoneConditions::new).collect(),
            paths: vec![zero; coefficients.paths.len()],
            doors: vec![zero; coefficients.doors.len()],
            mechanical_air: MechanicalConditions::new(&coefficients.mechanical_air, plan.zones.len()),
            vents: VentConditions::new(&coefficients.vents),
            humidity: coefficients.humidity.as_ref().map(|humidity| {
                HumidityConditions::new(humidity, plan.humidity.as_ref().map_or(0, HumidityPlan::recovered))
            }),
            heat_sources: vec![SourceConditions::none(); coefficients.heat_sources.len()],
            densities: AirDensities::of_site(plan.zones.len()),
            airs: if coefficients.has_people { vec![zero; plan.zones.len()] } else { Vec::new() },
            bridges: coefficients
                .bridges
                .iter()
                .map(|bridge| (!matches!(bridge.to, BridgeEnd::Zone(_))).then_some(zero))
                .collect(),
            outdoor_air: zero,
            wind: zero,
            sky: zero,
            sky_weather: SkyWeather::default(),
            sun: SolarConditions::new(plan, weather_index),
            from_air: vec![zero; weather_index.emissions.len()],
            with_text: (0..coefficients.surfaces.len()).map(SideId::from_index).filter(is_text).collect(),
        }
    }

    /// Linear interpolation or extrapolation of two instants: `fraction` 0 at the first, 1 at the second; for the sun the one of
    /// [`Self::fraction_of_sun`].
    ///
    /// Wind and the coefficients that depend on it are not extrapolated below zero.
    pub fn interpolate(&mut self, first: &Self, second: &Self, (fraction, of_sun): (f64, S)) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        // A part of a law that is written as text may be negative.
        let part = |a: S, b: S| {
            let negative = a.lt(S::zero()) | b.lt(S::zero());
            S::select(negative, line(a, b), rate(a, b))
        };
        for (at, (a, b)) in self.surfaces.iter_mut().zip(first.surfaces.iter().zip(&second.surfaces)) {
            at.solar = a.solar + (b.solar - a.solar) * of_sun;
            at.longwave = line(a.longwave, b.longwave);
            at.temperature = line(a.temperature, b.temperature);
            at.air_shift = line(a.air_shift, b.air_shift);
            for k in 0..2 {
                at.forced[k] = rate(a.forced[k], b.forced[k]);
            }
        }
        for &surface in &self.with_text {
            let (a, b) = (&first.surfaces[surface].forced, &second.surfaces[surface].forced);
            self.surfaces[surface].forced = core::array::from_fn(|k| part(a[k], b[k]));
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.interpolate(a, b, fraction);
        }
        for (at, (&a, &b)) in self.paths.iter_mut().zip(first.paths.iter().zip(&second.paths)) {
            *at = rate(a, b);
        }
        for (at, (&a, &b)) in self.doors.iter_mut().zip(first.doors.iter().zip(&second.doors)) {
            *at = rate(a, b);
        }
        self.mechanical_air.interpolate(&first.mechanical_air, &second.mechanical_air, fraction);
        self.vents.interpolate(&first.vents, &second.vents, fraction);
        let sources = first.heat_sources.iter().zip(&second.heat_sources);
        for (at, (a, b)) in self.heat_sources.iter_mut().zip(sources) {
            at.interpolate(a, b, fraction);
        }
        if let (Some(at), Some(a), Some(b)) = (&mut self.humidity, &first.humidity, &second.humidity) {
            at.interpolate(a, b, fraction);
        }
        for (at, (&a, &b)) in self.bridges.iter_mut().zip(first.bridges.iter().zip(&second.bridges)) {
            *at = a.zip(b).map(|(a, b)| line(a, b));
        }
        self.sun.interpolate(&first.sun, &second.sun, of_sun);
        self.sky = line(first.sky, second.sky);
        self.sky_weather = SkyWeather::between(&first.sky_weather, &second.sky_weather, fraction);
        self.outdoor_air = line(first.outdoor_air, second.outdoor_air);
        self.wind = rate(first.wind, second.wind);
    }

    /// Where on the straight line through two instants the sun is, instead of at a fraction; `start` and `middle` are the fractions at the
    /// start and in the middle of the step.
    ///
    /// A sun that rises from the first instant to the second would be negative at the start of the step. The line is turned about the middle of the
    /// step until it is nowhere: the mean over the step stays. It is turned for all parts of the sun alike, so that what is absorbed stays
    /// what is transmitted.
    pub(crate) fn fraction_of_sun(
        first: &Self,
        second: &Self,
        fraction: f64,
        [start, middle]: [f64; 2],
    ) -> S {
        let mut turn = S::one();
        let mut keep = |a: S, b: S| {
            let (rise, mean) = (b - a, a + (b - a).scale(middle));
            let load_sensitivities = S::zero().lt(rise);
            let most = mean / S::select(load_sensitivities, rise.scale(middle - start), S::one());
            turn = S::select(load_sensitivities, turn.min(most.max(S::zero())), turn);
        };
        for (a, b) in first.surfaces.iter().zip(&second.surfaces) {
            keep(a.solar, b.solar);
        }
        for (&a, &b) in first.sun.irradiances.iter().zip(&second.sun.irradiances) {
            keep(a, b);
        }
        for (a, b) in first.sun.windows.iter().zip(&second.sun.windows) {
            keep(a.beam, b.beam);
            for (&a, &b) in a.panes.iter().zip(&b.panes) {
                keep(a, b);
            }
        }
        let turned = S::constant(middle) + turn.scale(fraction - middle);
        S::select(turn.lt(S::one()), turned, S::constant(fraction))
    }

    /// Densities of the air at an instant and at airs of the zones [degC], before [`Self::update`] needs them.
    #[inline(always)]
    pub(crate) fn weigh(&mut self, coefficients: &Coefficients<S>, now: &Instant<'_>, airs: &[S]) {
        if let Some(site) = &coefficients.densities {
            self.densities.update(site, now.row, airs);
        }
        let people = self.airs.len();
        self.airs.copy_from_slice(&airs[..people]);
    }

    /// Evaluates the weather at an instant.
    // Never inlined, one copy only: it is large and called in several places, where inlining multiplies compile time.
    #[inline(never)]
    pub(crate) fn update(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        S::vectorised(
            #[inline(always)]
            || self.evaluate(plan, coefficients, weather_index, now),
        );
    }

    #[inline(always)]
    fn evaluate(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        let air = S::constant(now.row[channel::AIR_TEMPERATURE]);
        (self.sky, self.outdoor_air) = (coefficients.sky.at(&now.sky), air);
        self.sky_weather = now.sky;
        self.wind = S::constant(now.wind.speed);
        self.sun.irradiate(plan, coefficients, weather_index, now);
        self.update_surfaces(coefficients, weather_index, now);
        for (z, (at, zone)) in self.zones.iter_mut().zip(&coefficients.zones).enumerate() {
            let air = self.airs.get(z).copied().unwrap_or_else(S::zero);
            at.update(zone, now.row, &self.densities, air);
        }
        if coefficients.has_stratified {
            stratify(&mut self.surfaces, &self.zones, plan, coefficients);
        }
        for (at, path) in self.paths.iter_mut().zip(&coefficients.paths) {
            *at = path.conductance(now.row, &self.densities);
        }
        self.update_airs(coefficients, now);
        if !self.sun.windows.is_empty() {
            self.sun.transmit(plan, coefficients, now);
            if !self.sun.to_air.is_empty() {
                self.sun.give_to_air(coefficients);
            }
            self.sun.trace(plan, coefficients, now);
            if !plan.passages.is_empty() {
                self.sun.pass(plan, coefficients);
            }
            self.sun.distribute(plan, coefficients, &mut self.surfaces);
            self.sun.absorb_in_panes(plan, coefficients, &mut self.surfaces);
        }
    }

    /// Doors, fans and thermal bridges.
    #[inline(always)]
    fn update_airs(&mut self, coefficients: &Coefficients<S>, now: &Instant<'_>) {
        for (at, door) in self.doors.iter_mut().zip(&coefficients.doors) {
            *at = door.at(now.row);
        }
        if !coefficients.mechanical_air.is_empty() {
            self.mechanical_air.update(
                &coefficients.mechanical_air,
                now.row,
                self.outdoor_air,
                &self.densities,
            );
        }
        if !coefficients.vents.is_empty() {
            self.vents.update(&coefficients.vents, now.row);
        }
        if let (Some(at), Some(humidity)) = (&mut self.humidity, &coefficients.humidity) {
            at.update(humidity, (&coefficients.mechanical_air.units, &self.densities), now, &self.airs);
        }
        for (at, source) in self.heat_sources.iter_mut().zip(&coefficients.heat_sources) {
            at.update(source, now.row);
        }
        for (at, bridge) in self.bridges.iter_mut().zip(&coefficients.bridges) {
            *at = match &bridge.to {
                BridgeEnd::Outdoors => Some(self.outdoor_air),
                BridgeEnd::Zone(_) => None,
                BridgeEnd::Imposed(imposed) => Some(imposed_temperature(imposed, now)),
            };
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
                at.longwave = outside.air_factor * self.from_air[emission] + outside.sky_factor * sky;
            }
        }
        for &index in &weather_index.windy {
            self.surfaces[index].forced = forced(coefficients, index, now);
        }
        for &(index, source, absorptance) in &weather_index.irradiated {
            self.surfaces[index].solar = absorptance * irradiances[source];
        }
        for &(index, channel, factor) in &weather_index.measured {
            self.surfaces[index].forced = [factor.scale(now.row[channel]); 4];
        }
        for &(index, flux, schedule) in &weather_index.heated {
            self.surfaces[index].longwave = scheduled(flux, schedule, now.row);
        }
        for &index in &weather_index.imposed {
            if let Boundary::Imposed(imposed) = &coefficients.surfaces[index].boundary {
                self.surfaces[index].temperature = imposed_temperature(imposed, now);
                if let (Imposed::Law(law), true) = (imposed, weather_index.beside) {
                    self.surfaces[index].impose(law.beside(&now.imposed_weather()));
                }
            }
        }
        for &(index, source) in &weather_index.surrounded {
            let sun = source.map_or_else(S::zero, |source| self.sun.irradiances[source]);
            let around = (self.surfaces[index].temperature, sun);
            self.surfaces[index].forced = driven_outside(coefficients, index, now, around);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::test_buildings::{WINDOW, glazed_zone, values};
    use crate::input::forcing::{CLIMATE_CHANNELS, Forcing};

    /// Air at 10 degC, wind of 3 m/s from the south, sun due south at 30 deg: 600 W/m2 direct, 120 W/m2 diffuse.
    fn row() -> [f64; CLIMATE_CHANNELS] {
        let mut row = [0.0; CLIMATE_CHANNELS];
        row[channel::AIR_TEMPERATURE] = 10.0;
        (row[channel::WIND_SPEED], row[channel::WIND_DIRECTION]) = (3.0, 180.0);
        (row[channel::DIRECT_NORMAL], row[channel::DIFFUSE_HORIZONTAL]) = (600.0, 120.0);
        row[channel::GLOBAL_HORIZONTAL] = 600.0 * 0.5 + 120.0;
        row[channel::DIRECT_NORMAL_EXTRA] = 1361.0;
        (row[channel::SUN_NORTH], row[channel::SUN_UP]) = (-0.75_f64.sqrt(), 0.5);
        row
    }

    fn conditions(plan: &Plan, row: &[f64]) -> Conditions<f64> {
        let numbers = values(&plan.description);
        let coefficients = Coefficients::new(plan, &numbers);
        let index = WeatherIndex::new(plan, &coefficients);
        let weather = Weather::new(plan, &Forcing::new(row, 1, row.len()).unwrap());
        let mut conditions = Conditions::new(plan, &coefficients, &index);
        conditions.update(plan, &coefficients, &index, &weather.at(0, 0));
        conditions
    }

    /// By Perez a horizontal plane receives the global radiation: the roof, of absorptance 0.6. The floor receives what the
    /// ground reflects, a fifth of it.
    #[test]
    fn a_horizontal_plane_receives_the_global_radiation() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let at = conditions(&plan, &row());
        let solar = |wall| at.surfaces[SideId::outside(wall)].solar;
        assert!((solar(5) - 0.6 * 420.0).abs() < 1e-10, "{}", solar(5));
        assert!((solar(4) - 0.6 * 0.2 * 420.0).abs() < 1e-10, "{}", solar(4));
        // On the south wall the beam alone gives 600 cos 30; on the north wall there is none.
        assert!(solar(0) > 0.6 * 600.0 * 0.75_f64.sqrt() && solar(1) < 0.6 * (120.0 + 42.0));
    }

    /// The sky 10 K below the air: the roof absorbs its emission, the floor that of the air.
    #[test]
    fn long_wave_radiation_of_sky_and_air() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let at = conditions(&plan, &row());
        let black = |kelvin: f64| 5.670_374_419e-8 * kelvin.pow4();
        assert!((at.sky / black(273.15) - 1.0).abs() < 1e-12);
        let longwave = |wall| at.surfaces[SideId::outside(wall)].longwave;
        assert!((longwave(5) / (0.9 * black(273.15)) - 1.0).abs() < 1e-12);
        assert!((longwave(4) / (0.9 * black(283.15)) - 1.0).abs() < 1e-12);
        assert_eq!(at.surfaces[SideId::outside(0)].temperature, 10.0);
    }

    /// Whatever the law, the surfaces and the glass absorb and lose what the window transmits.
    #[test]
    fn the_transmitted_sun_is_absorbed_or_lost() {
        for (sun, overhang) in [("area", false), ("geometry", false), ("area", true), ("geometry", true)] {
            let plan = Plan::new(glazed_zone(sun, overhang)).unwrap();
            let at = conditions(&plan, &row());
            let areas = Coefficients::new(&plan, &values(&plan.description)).zones.remove(0).areas;
            let opaque = (0..WINDOW).map(|wall| areas[wall] * at.surfaces[SideId::inside(wall)].solar);
            let zone = &at.sun.zones[0];
            assert!(zone.transmitted > 1000.0 && zone.transmitted == at.sun.windows[0].transmitted);
            let sum = opaque.sum::<f64>() + zone.in_glass + zone.lost;
            assert!((sum / zone.transmitted - 1.0).abs() < 1e-9, "{sun}: {sum} of {}", zone.transmitted);
            // What each of the two panes absorbs acts on its surface.
            let solar = SideId::pair(WINDOW).map(|surface| at.surfaces[surface].solar);
            let panes = &at.sun.windows[0].panes;
            assert!(solar.iter().zip(panes).all(|(solar, pane)| (solar - pane).abs() < 1e-12));
        }
    }

    /// With beams traced, at 30 deg most of the beam ends on the floor: more than by area.
    #[test]
    fn a_traced_beam_ends_on_the_floor() {
        let floor = |sun: &str| {
            let plan = Plan::new(glazed_zone(sun, false)).unwrap();
            conditions(&plan, &row()).surfaces[SideId::inside(4)].solar
        };
        assert!(floor("geometry") > 2.0 * floor("area"), "{} and {}", floor("geometry"), floor("area"));
    }

    /// No sun: nothing is absorbed inside, and means over a step weigh the stages.
    #[test]
    fn night_and_means() {
        let plan = Plan::new(glazed_zone("geometry", true)).unwrap();
        let day = conditions(&plan, &row());
        let mut dark = row();
        for at in [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL] {
            dark[at] = 0.0;
        }
        let night = conditions(&plan, &dark);
        assert!(night.surfaces.iter().all(|surface| surface.solar == 0.0));
        let mut means = crate::weather::solar_means::SolarMeans::new(&day.sun);
        means.add(&day.sun, 0.25);
        means.add(&night.sun, 0.75);
        assert_eq!(means.zones[0], 0.25 * day.sun.zones[0].transmitted);
        means.restart();
        assert_eq!((means.windows[0], means.lost[0]), (0.0, 0.0));
    }

    /// Halfway between two instants are their means; beyond them temperatures go on, the wind not below zero.
    #[test]
    fn interpolation() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let (first, mut later) = (conditions(&plan, &row()), row());
        (later[channel::AIR_TEMPERATURE], later[channel::WIND_SPEED]) = (14.0, 1.0);
        later[channel::DIRECT_NORMAL] = 400.0;
        let second = conditions(&plan, &later);
        let mut at = first.clone();
        at.interpolate(&first, &second, (0.5, 0.5));
        let wall = SideId::outside(0);
        assert_eq!((at.outdoor_air, at.wind, at.surfaces[wall].temperature), (12.0, 2.0, 12.0));
        let mean = 0.5 * (first.sun.windows[0].transmitted + second.sun.windows[0].transmitted);
        assert!((at.sun.windows[0].transmitted / mean - 1.0).abs() < 1e-12);
        at.interpolate(&first, &second, (2.0, 2.0));
        assert_eq!((at.outdoor_air, at.wind), (18.0, 0.0));
        assert!(at.surfaces[wall].forced[0] >= 0.0);
    }

    /// The sun rises from nothing at the first stage to 420 W/m2 at the last one. In no part of the step is it negative, and the parts of the step
    /// have the mean of both stages; a sun that sets keeps its line.
    #[test]
    fn the_sun_is_not_extrapolated_below_zero() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let node = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
        let mut dark = row();
        for at in [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL] {
            dark[at] = 0.0;
        }
        let at_stages = [conditions(&plan, &dark), conditions(&plan, &row())];
        let at = |place: f64| (place - node) / (1.0 - node);
        for [first, last] in [[0, 1], [1, 0]] {
            let [first, last] = [&at_stages[first], &at_stages[last]];
            let roof = |place: f64| {
                let of_sun = Conditions::fraction_of_sun(first, last, at(place), [at(0.0), at(0.5)]);
                let mut now = first.clone();
                now.interpolate(first, last, (at(place), of_sun));
                for (surface, solar) in now.surfaces.iter().enumerate() {
                    assert!(solar.solar >= -1e-12, "{} W/m2 on {surface} at {place}", solar.solar);
                }
                now.surfaces[SideId::outside(5)].solar
            };
            let whole = (1.0 - node) * first.surfaces[SideId::outside(5)].solar
                + node * last.surfaces[SideId::outside(5)].solar;
            let mut sum = 0.0;
            for part in 0..8 {
                let from = f64::from(part) / 8.0;
                sum += ((1.0 - node) * roof(from + node / 8.0) + node * roof(from + 0.125)) / 8.0;
            }
            assert!((sum / whole - 1.0).abs() < 1e-12, "{sum} is not {whole}");
        }
    }
}
