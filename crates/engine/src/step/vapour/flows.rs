//! What the heat balances of a stage leave for the vapour balances: flows of air, temperatures and heat transfer coefficients.

use crate::building::coefficients::HumidityCoefficients;
use crate::building::humidity::HumidityPlan;
use crate::building::model::Model;
use crate::linear::unknowns::Temperatures;
use crate::number::real::Real;
use crate::physics::constants::KELVIN;
use crate::physics::doors;
use crate::physics::psychrometrics::VAPOUR_GAS_CONSTANT;
use crate::physics::vapour_layers::VapourLayers;
use crate::step::film::film;
use crate::weather::conditions::Conditions;
use crate::weather::humidity::Plant;

/// Smaller heat transfer coefficients count as this [W/(m2 K)].
const LEAST_FILM: f64 = 1e-6;

/// The flows of a stage.
#[derive(Debug, Clone)]
pub(super) struct StageFlows<S> {
    /// Pressure of the air [Pa], and humidity ratio of the outdoor air [kg/kg].
    pub(super) pressure: S,
    pub(super) outdoor: S,
    pub(super) zones: Vec<ZoneFlows<S>>,
    /// Of each of the plan's `carries` [kg/s].
    pub(super) carried: Vec<S>,
    pub(super) surfaces: Vec<SurfaceFlows<S>>,
}

/// The flows of a zone.
#[derive(Debug, Clone, Copy)]
pub(super) struct ZoneFlows<S> {
    /// Air that leaves to outdoors, less that whose vapour is recovered [kg/s].
    pub(super) outward: S,
    /// Vapour from sources [kg/s].
    pub(super) gain: S,
    pub(super) drying: Plant<S>,
    pub(super) humidifying: Plant<S>,
}

/// How vapour reaches a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceFlows<S> {
    /// From the air to the middle of the first layer, and from there to that of the second [kg/(m2 s Pa)].
    pub(super) to_layer: S,
    pub(super) between: S,
}

impl<S: Real> StageFlows<S> {
    /// Zeros.
    pub(super) fn new(humidity: &HumidityCoefficients<S>, carries: usize) -> Self {
        let zero = S::zero();
        let none = Plant { target: zero, relative: false, capacity: zero };
        let zone = ZoneFlows { outward: zero, gain: zero, drying: none, humidifying: none };
        let surface = SurfaceFlows { to_layer: zero, between: zero };
        Self {
            pressure: humidity.pressure,
            outdoor: zero,
            zones: vec![zone; humidity.zones.len()],
            carried: vec![zero; carries],
            surfaces: vec![surface; humidity.surfaces.len()],
        }
    }

    /// Notes the flows of a stage, in its conditions and at its temperatures; those of airs and surfaces into `temperatures`.
    #[inline(always)]
    pub(super) fn note(
        &mut self,
        plan: &HumidityPlan,
        model: &Model<'_, S>,
        conditions: &Conditions<S>,
        at: Temperatures<'_, S>,
        temperatures: &mut [S],
    ) {
        let (Some(humidity), Some(now)) = (&model.coefficients.humidity, &conditions.humidity) else {
            return;
        };
        (self.pressure, self.outdoor) = (now.pressure, now.outdoor);
        let zones = self.zones.iter_mut().zip(&now.zones).zip(&humidity.zones);
        for (z, ((zone, now), of_vapour)) in zones.enumerate() {
            let numbers = &model.coefficients.zones[z];
            let (wind, outdoor) = (conditions.wind, conditions.outdoor_air);
            let changes = conditions.zones[z].air_changes(numbers, wind, outdoor, at.air[z]);
            let mut heat = changes.scale(1.0 / 3600.0) * numbers.air_capacity;
            if let Some(fans) = conditions.mechanical_air.zones.get(z) {
                heat += fans.outward;
            }
            zone.outward = heat * humidity.mass;
            zone.gain = now.gain;
            if of_vapour.has_plants() {
                (zone.drying, zone.humidifying) = (now.drying, now.humidifying);
            }
        }
        let (airs, of_surfaces) = temperatures.split_at_mut(self.zones.len());
        airs.copy_from_slice(at.air);
        if !plan.carries.is_empty() {
            self.note_carried(humidity.mass, model, conditions, at.air);
        }
        // Air whose vapour is recovered does not take it outdoors.
        let first = plan.carries.len() - now.recovered.len();
        for (&[from, _], &carried) in plan.carries[first..].iter().zip(&self.carried[first..]) {
            self.zones[from].outward = self.zones[from].outward - carried;
        }
        let places = self.surfaces.iter_mut().zip(of_surfaces);
        for ((place, at_surface), surface) in places.zip(&humidity.surfaces) {
            let (temperature, air) = (at.surfaces[surface.surface], at.air[surface.zone]);
            let heat =
                film(model, conditions, surface.surface, temperature, air).max(S::constant(LEAST_FILM));
            let air_factor =
                (air + S::constant(KELVIN)).scale(VAPOUR_GAS_CONSTANT) * humidity.heat_over_vapour / heat;
            let permeability = VapourLayers::relative_permeability(temperature);
            let layers = &surface.layers;
            place.to_layer = S::one() / (air_factor + layers.to_surface / permeability);
            place.between = if layers.two { permeability / layers.between } else { S::zero() };
            *at_surface = temperature;
        }
    }

    /// Air between zones, in the order of the plan's `carries`; `mass` of a flow of heat capacity [kg K/J].
    #[inline(always)]
    fn note_carried(&mut self, mass: S, model: &Model<'_, S>, conditions: &Conditions<S>, air: &[S]) {
        let mut places = self.carried.iter_mut();
        let mut put = |heat: S| {
            if let Some(place) = places.next() {
                *place = heat * mass;
            }
        };
        for &path in &conditions.paths {
            put(path);
            put(path);
        }
        for (door, &whole) in model.coefficients.doors.iter().zip(&conditions.doors) {
            let [a, b] = door.between;
            let heat = doors::conductance(whole, air[a] - air[b]);
            put(heat);
            put(heat);
        }
        let directed = model.coefficients.mechanical_air.directed.len();
        let recovered = conditions.humidity.iter().flat_map(|now| &now.recovered);
        let carried = &conditions.mechanical_air.carried;
        let vents = &carried[model.coefficients.mechanical_air.first_of_vents..];
        for &heat in carried[..directed].iter().chain(vents).chain(recovered) {
            put(heat);
        }
    }
}
