//! Mechanical ventilation and air that flows from zone to zone, with the pairs of zones that exchange heat by them.

use crate::building::plan::Plan;
use crate::input::description::Vent;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::flow_density::SiteAir;
use crate::physics::mechanical_air::{DirectedFlow, Unit};

/// All flows that fans drive; empty in a building without them.
#[derive(Debug, Clone)]
pub struct MechanicalAir<S> {
    /// Ventilation units.
    pub units: Vec<Unit<S>>,
    /// Air from zone to zone.
    pub directed: Vec<DirectedFlow<S>>,
    /// Zones that heat comes from and goes to: of each directed flow, then of each supply and exhaust of each unit with heat
    /// recovery that are in different zones, then of each opening of the pressure network between zones, both ways.
    pub carries: Vec<[usize; 2]>,
    /// Place of the first opening among them.
    pub(crate) first_of_vents: usize,
    /// Whether there is a pressure network, which every zone is part of.
    vented: bool,
    /// Of each zone: whether the network makes up what fans take out of it.
    pub(crate) by_vents: Vec<bool>,
}

impl<S: Real> MechanicalAir<S> {
    /// Evaluates all flows at a parameter vector.
    pub(crate) fn new(plan: &Plan, values: &Values<'_, S>, site: &SiteAir<S>) -> Self {
        let description = &plan.description;
        let units: Vec<_> =
            description.ventilation_units.iter().map(|unit| Unit::new(unit, values, site)).collect();
        let directed: Vec<_> =
            description.directed_flows.iter().map(|flow| DirectedFlow::new(flow, values, site)).collect();
        let mut carries: Vec<[usize; 2]> = directed.iter().map(|flow| flow.ends).collect();
        for unit in units.iter().filter(|unit| unit.recovers()) {
            for supply in &unit.supply {
                let pairs = unit.exhaust.iter().map(|exhaust| [exhaust.zone, supply.zone]);
                carries.extend(pairs.filter(|[from, to]| from != to));
            }
        }
        let first_of_vents = carries.len();
        let between = description.vents.iter().filter_map(Vent::between);
        carries.extend(between.flat_map(|[a, b]| [[a, b], [b, a]]));
        let by_vents = description.zones.iter().map(|zone| zone.makeup_by_vents).collect();
        Self { units, directed, carries, first_of_vents, vented: plan.vents.is_some(), by_vents }
    }

    /// Whether there are none.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.units.is_empty() && self.directed.is_empty() && !self.vented
    }

    /// Whether one of them enters or leaves a zone.
    pub(crate) fn reaches(&self, zone: usize) -> bool {
        let of_unit = |unit: &Unit<S>| unit.supply.iter().chain(&unit.exhaust).any(|flow| flow.zone == zone);
        self.vented
            || self.units.iter().any(of_unit)
            || self.directed.iter().any(|flow| flow.ends.contains(&zone))
    }
}
