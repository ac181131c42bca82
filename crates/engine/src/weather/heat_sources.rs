//! What heat sources in walls release in one stage.

use crate::building::coefficients::HeatSource;
use crate::building::coefficients::heat_source::Exchange;
use crate::input::forcing::scheduled;
use crate::number::real::Real;
use crate::physics::heat_sources::{effectiveness, throttled};

/// What a heat source releases in one stage.
#[derive(Debug, Clone)]
pub struct SourceConditions<S> {
    /// Power [W/m2] or flow [kg/(s m2)], as its schedule lets it.
    driven: S,
    /// Set point of its thermostat [degC].
    set_point: S,
    /// Temperature of the water that enters [degC].
    pub(crate) supply: S,
    /// Electric power [W/m2].
    pub(crate) heat: S,
    /// Heat of the water per degree between its inlet and the plane [W/(m2 K)].
    pub(crate) conductance: S,
    /// Fall of the water over its excess at the inlet [-].
    pub(crate) effectiveness: S,
}

impl<S: Real> SourceConditions<S> {
    /// Nothing is released.
    pub(crate) fn none() -> Self {
        let zero = S::zero();
        Self {
            driven: zero,
            set_point: zero,
            supply: zero,
            heat: zero,
            conductance: zero,
            effectiveness: zero,
        }
    }

    /// Some heat is released [W/m2].
    #[cfg(test)]
    pub(crate) fn of_heat(heat: S) -> Self {
        Self { heat, ..Self::none() }
    }

    /// Linear interpolation or extrapolation of two others; flows do not go below zero.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        let driven = line(first.driven, second.driven);
        let negative = first.driven.lt(S::zero()) | second.driven.lt(S::zero());
        self.driven = S::select(negative, driven, driven.max(S::zero()));
        self.supply = line(first.supply, second.supply);
        self.set_point = line(first.set_point, second.set_point);
    }

    /// Schedules and columns in a forcing row.
    pub(crate) fn update(&mut self, source: &HeatSource<S>, row: &[f64]) {
        let (whole, schedule) = source.driven;
        self.driven = scheduled(whole, schedule, row);
        if let Some(water) = &source.water {
            self.supply = water.supply.at(row);
        }
        if let Some(thermostat) = &source.thermostat {
            self.set_point = thermostat.set_point.at(row);
        }
    }

    /// What is released with airs of the zones at the beginning of the step [degC], and controls as they have decided.
    pub(crate) fn drive(&mut self, source: &HeatSource<S>, air: &[S], opened: &[S]) {
        let mut driven = self.driven;
        if let Some(thermostat) = &source.thermostat {
            let air = air[thermostat.zone];
            driven = driven * throttled(air, self.set_point, thermostat.range, thermostat.cooling);
        }
        if let Some(control) = source.control {
            driven = driven * opened[control];
        }
        let Some(water) = &source.water else {
            self.heat = driven;
            return;
        };
        let capacity_rate = driven * water.specific_heat;
        self.effectiveness = match water.exchange {
            Exchange::Conductance(conductance) => effectiveness(conductance, capacity_rate),
            Exchange::Effectiveness(effectiveness) => effectiveness,
        };
        self.conductance = capacity_rate * self.effectiveness;
    }

    /// Heat into a plane at a temperature [W/m2].
    pub(crate) fn released(&self, plane: S) -> S {
        self.heat + self.conductance * (self.supply - plane)
    }
}
