//! Ideal loads whose values are known from a plain run: their derivatives follow from the responses of the airs.

use crate::building::coefficients::ZoneCoefficients;
use crate::number::real::{Mask, Real};
use crate::step::ideal_loads::limits::Limits;
use crate::step::ideal_loads::search::find_loads;

/// The ideal loads of a building along a known solution.
#[derive(Debug, Clone)]
pub(crate) struct StoredLoads<S> {
    /// Zone of each load.
    zones: Vec<usize>,
    limits: Vec<Limits<S>>,
    /// Response of the air of each load at the end of the step to each load: its row, then its column [K/W].
    gains: Vec<f64>,
    found: Vec<S>,
    matrix: Vec<S>,
    right: Vec<S>,
}

impl<S: Real> StoredLoads<S> {
    /// Of the zones that have one.
    pub(crate) fn new(zones: &[usize]) -> Self {
        let (count, zero) = (zones.len(), S::zero());
        Self {
            zones: zones.to_vec(),
            limits: vec![Limits { set_points: [zero; 2], most: [zero; 2] }; count],
            gains: vec![0.0; count * count],
            found: vec![zero; count],
            matrix: vec![zero; count * count],
            right: vec![zero; count],
        }
    }

    /// Begins a step that ends with a forcing row, with known loads [W] and airs at its end [degC]. Whether any load acts, or an air is
    /// outside its set points.
    #[inline(always)]
    pub(crate) fn begin(
        &mut self,
        zones: &[ZoneCoefficients<S>],
        row: &[f64],
        (load, air): (&[f64], &[f64]),
    ) -> bool {
        let mut act = false;
        for (limits, &zone) in self.limits.iter_mut().zip(&self.zones) {
            *limits = Limits::at(&zones[zone], row);
            let [cold, hot] = limits.asks(S::constant(air[zone]));
            act |= load[zone] != 0.0 || (cold | hot).any();
        }
        act
    }

    /// Sets the response of the airs at the end of the step to a load [K/W].
    #[inline(always)]
    pub(crate) fn set_response(&mut self, load: usize, airs: &[f64]) {
        let count = self.zones.len();
        for (p, &zone) in self.zones.iter().enumerate() {
            self.gains[p * count + load] = airs[zone];
        }
    }

    /// Corrects loads, and with them their derivatives, by airs at the end of the step.
    #[inline(always)]
    pub(crate) fn correct(&mut self, air: &[S], loads: &mut [S]) {
        let Self { zones, limits, gains, found, matrix, right } = self;
        let count = zones.len();
        find_loads(
            (zones, limits),
            #[inline(always)]
            |p, q| S::constant(gains[p * count + q]),
            (air, loads),
            (found, matrix, right),
        );
        for (&zone, &found) in zones.iter().zip(&*found) {
            let change = found - loads[zone];
            loads[zone] += change;
        }
    }
}
