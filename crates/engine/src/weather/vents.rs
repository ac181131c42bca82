//! Openings of the pressure network in one stage: the wind on them, how far they are open, and the flows.

use crate::building::coefficients::vents::Vents;
use crate::input::forcing::channel;
use crate::number::real::Real;

/// All of them.
#[derive(Debug, Clone)]
pub struct VentConditions<S> {
    /// Pressure of the wind [Pa].
    pub(crate) pressure: Vec<S>,
    /// Open fraction of the area [-].
    pub(crate) open: Vec<S>,
    /// Volume flow out of its zone and into it [m3/s].
    pub(crate) flows: Vec<[S; 2]>,
}

impl<S: Real> VentConditions<S> {
    /// Zeros.
    pub(crate) fn new(vents: &Vents<S>) -> Self {
        let zeros = || vec![S::zero(); vents.all.len()];
        Self { pressure: zeros(), open: zeros(), flows: vec![[S::zero(); 2]; vents.all.len()] }
    }

    /// Linear interpolation or extrapolation of wind and schedules; open fractions stay between 0 and 1.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        for (at, (&a, &b)) in self.pressure.iter_mut().zip(first.pressure.iter().zip(&second.pressure)) {
            *at = line(a, b);
        }
        for (at, (&a, &b)) in self.open.iter_mut().zip(first.open.iter().zip(&second.open)) {
            *at = line(a, b).max(S::zero()).min(S::one());
        }
    }

    /// Wind and schedules of a forcing row.
    // Most buildings have none: one copy of it is enough.
    #[inline(never)]
    pub(crate) fn update(&mut self, vents: &Vents<S>, row: &[f64]) {
        let (speed, direction) = (row[channel::WIND_SPEED], row[channel::WIND_DIRECTION]);
        for ((pressure, open), vent) in self.pressure.iter_mut().zip(&mut self.open).zip(&vents.all) {
            *pressure = vent.pressure(speed, direction);
            *open = vent.open(row);
        }
    }

    /// Closes what controls have closed.
    pub(crate) fn control(&mut self, vents: &Vents<S>, opened: &[S]) {
        for (open, vent) in self.open.iter_mut().zip(&vents.all) {
            if let Some(control) = vent.control {
                *open = *open * opened[control];
            }
        }
    }
}
