//! Ideal loads whose values are known from a plain run: their derivatives follow from the responses of the airs.

use crate::building::model::Model;
use crate::linear::unknowns::{Temperatures, Unknowns};
use crate::number::real::{Mask, Real};
use crate::step::ideal_loads::limits::Limits;
use crate::step::ideal_loads::search::find_loads;

/// The ideal loads of a building along a known solution.
#[derive(Debug, Clone)]
pub(crate) struct StoredLoads<S> {
    /// Zone of each load.
    zones: Vec<usize>,
    limits: Vec<Limits<S>>,
    /// Response of what the set points of each load hold at the end of the step to each load: its row, then its column [K/W].
    gains: Vec<f64>,
    /// What the set points of each zone hold [degC].
    controlled: Vec<S>,
    found: Vec<S>,
    matrix: Vec<S>,
    right: Vec<S>,
}

impl<S: Real> StoredLoads<S> {
    /// Of the zones that have one, among all zones of a building.
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let zones = &model.plan.ideal_loads;
        let (count, zero) = (zones.len(), S::zero());
        Self {
            zones: zones.clone(),
            limits: vec![Limits { set_points: [zero; 2], most: [zero; 2] }; count],
            gains: vec![0.0; count * count],
            controlled: vec![zero; model.plan.zones.len()],
            found: vec![zero; count],
            matrix: vec![zero; count * count],
            right: vec![zero; count],
        }
    }

    /// Begins a step that ends with a forcing row, with known loads [W] and temperatures at its end [degC]. Whether any load acts, or
    /// an air, or what else the set points hold, is outside of them.
    #[inline(always)]
    pub(crate) fn begin(
        &mut self,
        model: &Model<'_, S>,
        row: &[f64],
        (load, at): (&[f64], &Unknowns<f64>),
    ) -> bool {
        let mut act = false;
        for (limits, &zone) in self.limits.iter_mut().zip(&self.zones) {
            let numbers = &model.coefficients.zones[zone];
            *limits = Limits::at(numbers, row);
            let surfaces = model.plan.zones[zone].surfaces.iter().map(|&surface| at.surfaces[surface]);
            let radiated = numbers.load_parts(S::constant(load[zone]))[1].lane(0);
            let held = numbers.held_temperature(|number| number.lane(0), (surfaces, at.air[zone]), radiated);
            let [cold, hot] = limits.asks(S::constant(held));
            act |= load[zone] != 0.0 || (cold | hot).any();
        }
        act
    }

    /// Sets the response of surfaces and airs at the end of the step to a load [K/W], of which `radiated` is radiated [-].
    #[inline(always)]
    pub(crate) fn set_response(
        &mut self,
        model: &Model<'_, S>,
        load: usize,
        ([surfaces, airs], radiated): ([&[f64]; 2], f64),
    ) {
        let count = self.zones.len();
        for (p, &zone) in self.zones.iter().enumerate() {
            let own = if p == load { radiated } else { 0.0 };
            let rises = model.plan.zones[zone].surfaces.iter().map(|&surface| surfaces[surface.index()]);
            let numbers = &model.coefficients.zones[zone];
            self.gains[p * count + load] =
                numbers.held_temperature(|number| number.lane(0), (rises, airs[zone]), own);
        }
    }

    /// Corrects loads, and with them their derivatives, by temperatures at the end of the step.
    #[inline(always)]
    pub(crate) fn correct(&mut self, model: &Model<'_, S>, at: &Temperatures<'_, S>, loads: &mut [S]) {
        let Self { zones, limits, gains, controlled, found, matrix, right } = self;
        let count = zones.len();
        for &zone in &*zones {
            controlled[zone] = model.held_temperature(zone, (at.surfaces, at.air[zone]), loads[zone]);
        }
        find_loads(
            (zones, limits),
            #[inline(always)]
            |p, q| S::constant(gains[p * count + q]),
            (&*controlled, loads),
            (found, matrix, right),
        );
        for (&zone, &found) in zones.iter().zip(&*found) {
            let change = found - loads[zone];
            loads[zone] += change;
        }
    }
}
