//! Humidity of the outdoor air, sources of vapour and set points at one instant.

use crate::building::coefficients::HumidityCoefficients;
use crate::building::coefficients::humidity::{Control, Dryer};
use crate::number::real::Real;
use crate::physics::flow_density::AirDensities;
use crate::physics::mechanical_air::Unit;
use crate::physics::psychrometrics::humidity_ratio;
use crate::weather::instant::Instant;

/// What acts on the vapour in the zones in one stage.
#[derive(Debug, Clone)]
pub(crate) struct HumidityConditions<S> {
    /// Pressure of the air [Pa].
    pub(crate) pressure: S,
    /// Humidity ratio of the outdoor air [kg/kg].
    pub(crate) outdoor: S,
    pub(crate) zones: Vec<ZoneVapour<S>>,
    /// Exchanged between each extracted and each supplied flow of the units that recover vapour [W/K].
    pub(crate) recovered: Vec<S>,
}

/// What acts on the vapour in a zone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ZoneVapour<S> {
    /// From sources [kg/s].
    pub(crate) gain: S,
    /// Ideal drying to a set point, and ideal humidifying.
    pub(crate) drying: Plant<S>,
    pub(crate) humidifying: Plant<S>,
}

/// A set point and a capacity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plant<S> {
    /// Relative humidity [-], or humidity ratio [kg/kg].
    pub(crate) target: S,
    pub(crate) relative: bool,
    /// [kg/s].
    pub(crate) capacity: S,
}

impl<S: Real> Plant<S> {
    fn none() -> Self {
        Self { target: S::zero(), relative: false, capacity: S::zero() }
    }

    #[inline(always)]
    fn of(control: Option<&Control<S>>, row: &[f64]) -> Self {
        let Some(control) = control else { return Self::none() };
        let (target, capacity) = control.at(row);
        Self { target, relative: control.relative, capacity }
    }

    fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| (a + (b - a).scale(fraction)).max(S::zero());
        *self = Self {
            target: line(first.target, second.target),
            relative: first.relative,
            capacity: line(first.capacity, second.capacity),
        };
    }
}

impl<S: Real> HumidityConditions<S> {
    /// Zeros for a building.
    pub(crate) fn new(humidity: &HumidityCoefficients<S>, recovered: usize) -> Self {
        let none = ZoneVapour { gain: S::zero(), drying: Plant::none(), humidifying: Plant::none() };
        Self {
            pressure: humidity.pressure,
            outdoor: S::zero(),
            zones: vec![none; humidity.zones.len()],
            recovered: vec![S::zero(); recovered],
        }
    }

    /// Linear interpolation or extrapolation; nothing is extrapolated below zero.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        self.pressure = line(first.pressure, second.pressure);
        self.outdoor = rate(first.outdoor, second.outdoor);
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.gain = line(a.gain, b.gain);
            at.drying.interpolate(&a.drying, &b.drying, fraction);
            at.humidifying.interpolate(&a.humidifying, &b.humidifying, fraction);
        }
        for (at, (&a, &b)) in self.recovered.iter_mut().zip(first.recovered.iter().zip(&second.recovered)) {
            *at = rate(a, b);
        }
    }

    /// Evaluates the weather at an instant.
    #[inline(always)]
    pub(crate) fn update(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        (units, densities): (&[Unit<S>], &AirDensities<S>),
        now: &Instant<'_>,
        airs: &[S],
    ) {
        let row = now.row;
        self.pressure = humidity.pressure_in(row);
        self.outdoor = humidity_ratio(S::constant(now.vapour), self.pressure);
        for (z, (at, zone)) in self.zones.iter_mut().zip(&humidity.zones).enumerate() {
            at.gain = zone.gain(row, airs.get(z).copied().unwrap_or_else(S::zero));
            if !zone.has_plants() {
                continue;
            }
            let control = match &zone.drying {
                Some(Dryer::Controlled(control)) => Some(control),
                Some(Dryer::Coil { .. }) | None => None,
            };
            at.drying = Plant::of(control, row);
            at.humidifying = Plant::of(zone.humidifying.as_ref(), row);
        }
        let mut places = self.recovered.iter_mut();
        for (unit, effectiveness) in units.iter().zip(&humidity.recoveries) {
            let Some(effectiveness) = *effectiveness else { continue };
            let share = unit.recovery_with(effectiveness, row, densities);
            for exhaust in &unit.exhaust {
                for supply in &unit.supply {
                    if let Some(place) = places.next() {
                        *place = share * exhaust.at(row, densities) * supply.at(row, densities);
                    }
                }
            }
        }
    }
}
