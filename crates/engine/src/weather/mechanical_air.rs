//! Flows that fans drive, at one instant; equations in `physics/mechanical_air.rs`.

use crate::building::coefficients::MechanicalAir;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::flow_density::AirDensities;
use crate::physics::mechanical_air::Unit;

/// Mechanical ventilation and air from zone to zone in one stage.
#[derive(Debug, Clone)]
pub struct MechanicalConditions<S> {
    /// Heat carried from zone to zone, for each of [`MechanicalAir::carries`] [W/K].
    pub carried: Vec<S>,
    /// Per zone; empty in a building without such flows.
    pub zones: Vec<ZoneBalance<S>>,
}

/// The air that fans move through a zone.
#[derive(Debug, Clone, Copy)]
pub struct ZoneBalance<S> {
    /// Heat of the supplied air above that of the outdoor air [W].
    pub supplied: S,
    /// What leaves to outdoors, less what heat recovery brings back [W/K].
    pub leaving: S,
    /// What leaves to outdoors [W/K].
    pub outward: S,
    /// Outdoor air that enters, supplied or by leaks [W/K].
    pub fresh: S,
    /// From other zones, by fans [W/K].
    pub(crate) from_zones: S,
    /// Supplied, to other zones, extracted, and recovered from it for other zones or itself [W/K].
    supply: S,
    to_zones: S,
    exhaust: S,
    recovered: S,
    /// What fans take out of a zone and do not bring in, where the pressure network makes it up [W/K]; below zero where they bring in more.
    pub(crate) drawn: S,
}

impl<S: Real> ZoneBalance<S> {
    fn none() -> Self {
        let zero = S::zero();
        Self {
            supplied: zero,
            leaving: zero,
            outward: zero,
            fresh: zero,
            supply: zero,
            from_zones: zero,
            to_zones: zero,
            exhaust: zero,
            recovered: zero,
            drawn: zero,
        }
    }

    /// Balances the flows, once all are added up: by leaks, or by the pressure network.
    fn balance(&mut self, by_vents: bool) {
        let surplus = self.supply + self.from_zones - self.to_zones;
        if by_vents {
            (self.outward, self.fresh, self.drawn) = (self.exhaust, self.supply, self.exhaust - surplus);
        } else {
            self.outward = self.exhaust.max(surplus);
            self.fresh = self.supply + (self.exhaust - surplus).max(S::zero());
        }
        self.leaving = self.outward - self.recovered;
    }

    /// Adds air that leaves to outdoors and outdoor air that enters in its place [W/K].
    #[inline(always)]
    pub(crate) fn exchange(&mut self, [out, into]: [S; 2]) {
        self.outward += out;
        self.leaving += out;
        self.fresh += into;
    }

    /// Heat into the air of the zone, of `T_outdoor - T_air`: that of supplied air and of air that leaves.
    #[inline(always)]
    pub(crate) fn heat(&self) -> Line<S> {
        Line { offset: self.supplied, slope: self.leaving }
    }
}

impl<S: Real> MechanicalConditions<S> {
    /// Zeros for a building.
    pub(crate) fn new(air: &MechanicalAir<S>, zones: usize) -> Self {
        let zones = if air.is_empty() { 0 } else { zones };
        Self { carried: vec![S::zero(); air.carries.len()], zones: vec![ZoneBalance::none(); zones] }
    }

    /// Linear interpolation or extrapolation; flows are not extrapolated below zero.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        for (at, (&a, &b)) in self.carried.iter_mut().zip(first.carried.iter().zip(&second.carried)) {
            *at = rate(a, b);
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.supplied = line(a.supplied, b.supplied);
            at.leaving = rate(a.leaving, b.leaving);
            at.outward = rate(a.outward, b.outward);
            at.fresh = rate(a.fresh, b.fresh);
            at.from_zones = rate(a.from_zones, b.from_zones);
            at.drawn = line(a.drawn, b.drawn);
        }
    }

    /// Evaluates all flows in a forcing row, with the outdoor temperature [degC].
    // Most buildings have none: one copy of it is enough.
    #[inline(never)]
    pub(crate) fn update(
        &mut self,
        air: &MechanicalAir<S>,
        row: &[f64],
        outdoor: S,
        densities: &AirDensities<S>,
    ) {
        self.zones.fill(ZoneBalance::none());
        for (flow, carried) in air.directed.iter().zip(&mut self.carried) {
            *carried = flow.at(row, densities);
            let [from, to] = flow.ends;
            self.zones[from].to_zones += *carried;
            self.zones[to].from_zones += *carried;
        }
        let mut pair = air.directed.len();
        for unit in &air.units {
            let excess = unit.excess(row, outdoor);
            for supply in &unit.supply {
                let (flow, zone) = (supply.at(row, densities), &mut self.zones[supply.zone]);
                zone.supply += flow;
                zone.supplied += flow * excess;
            }
            for exhaust in &unit.exhaust {
                self.zones[exhaust.zone].exhaust += exhaust.at(row, densities);
            }
            if unit.recovers() {
                self.recover(unit, (row, densities), &mut pair);
            }
        }
        for (zone, &by_vents) in self.zones.iter_mut().zip(&air.by_vents) {
            zone.balance(by_vents);
        }
    }

    /// Heat recovery: a part of the heat of each extracted flow goes to the zone of each supplied flow.
    fn recover(&mut self, unit: &Unit<S>, (row, densities): (&[f64], &AirDensities<S>), pair: &mut usize) {
        let share = unit.recovery(row, densities);
        for supply in &unit.supply {
            let by_supply = share * supply.at(row, densities);
            for exhaust in &unit.exhaust {
                let heat = by_supply * exhaust.at(row, densities);
                self.zones[exhaust.zone].recovered += heat;
                if exhaust.zone != supply.zone {
                    self.carried[*pair] = heat;
                    *pair += 1;
                }
            }
        }
    }
}
