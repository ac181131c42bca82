//! Mechanical ventilation and air that flows from zone to zone, with the pairs of zones that exchange heat by them.

use crate::building::plan::Plan;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::mechanical_air::{DirectedFlow, Unit};

/// All flows that fans drive; empty in a building without them.
#[derive(Debug, Clone)]
pub struct MechanicalAir<S> {
    /// Ventilation units.
    pub units: Vec<Unit<S>>,
    /// Air from zone to zone.
    pub directed: Vec<DirectedFlow<S>>,
    /// Zones that heat comes from and goes to: of each directed flow, then of each supply and exhaust of each unit with heat
    /// recovery that are in different zones.
    pub carries: Vec<[usize; 2]>,
}

impl<S: Real> MechanicalAir<S> {
    /// `heat`: heat capacity of a cubic metre of air [J/(m3 K)].
    pub(crate) fn new(plan: &Plan, values: &Values<'_, S>, heat: S) -> Self {
        let description = &plan.description;
        let units: Vec<_> =
            description.ventilation_units.iter().map(|unit| Unit::new(unit, values, heat)).collect();
        let directed: Vec<_> =
            description.directed_flows.iter().map(|flow| DirectedFlow::new(flow, values, heat)).collect();
        let mut carries: Vec<[usize; 2]> = directed.iter().map(|flow| flow.ends).collect();
        for unit in units.iter().filter(|unit| unit.recovers()) {
            for supply in &unit.supply {
                let pairs = unit.exhaust.iter().map(|exhaust| [exhaust.zone, supply.zone]);
                carries.extend(pairs.filter(|[from, to]| from != to));
            }
        }
        Self { units, directed, carries }
    }

    /// Whether there are none.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.units.is_empty() && self.directed.is_empty()
    }

    /// Whether one of them enters or leaves a zone.
    pub(crate) fn reaches(&self, zone: usize) -> bool {
        let of_unit = |unit: &Unit<S>| unit.supply.iter().chain(&unit.exhaust).any(|flow| flow.zone == zone);
        self.units.iter().any(of_unit) || self.directed.iter().any(|flow| flow.ends.contains(&zone))
    }
}
