//! Heat of a stage by its flows, at the values of the last linear solve: what a step adds to the ledger.

use crate::balance::flow_index::FlowIndex;
use crate::balance::ledger::{Flow, Power};
use crate::building::ids::SurfaceId;
use crate::building::model::Model;
use crate::linear::building_system::BuildingSystem;
use crate::linear::laws::LinearisedLaws;
use crate::linear::unknowns::Unknowns;
use crate::number::real::Real;
use crate::weather::conditions::{Conditions, SurfaceConditions};

/// A solved stage, to read its flows.
pub(crate) struct StageHeat<'s, 'a, S: Real> {
    pub(crate) model: &'s Model<'a, S>,
    pub(crate) flows: &'s FlowIndex<S>,
    pub(crate) conditions: &'s Conditions<S>,
    pub(crate) laws: &'s LinearisedLaws<S>,
    pub(crate) system: &'s BuildingSystem<'a, S>,
    pub(crate) solution: &'s Unknowns<S>,
    pub(crate) load: &'s [S],
}

impl<S: Real> StageHeat<'_, '_, S> {
    /// Adds the heat of a stage that counts for a duration [s] to that of a step.
    #[inline(always)]
    pub(crate) fn add_to(&self, duration: f64, energy: &mut Power<S>) {
        let mut power = Power::none();
        self.flows.surfaces(self.conditions, &self.laws.surfaces, &self.solution.surfaces, &mut power);
        for &(surface, area) in &self.flows.imposed {
            let heat = self.boundary_heat(surface, &self.conditions.surfaces[surface]);
            power.book(Flow::Boundary, area * heat);
        }
        if !self.model.plan.windows.is_empty() {
            self.add_windows(&mut power);
        }
        self.add_zones(&mut power);
        energy.add_for(duration, &power);
    }

    /// Solar radiation absorbed in windows and transmitted by them.
    #[inline(always)]
    fn add_windows(&self, power: &mut Power<S>) {
        for (&w, window) in self.model.plan.windows.iter().zip(&self.conditions.sun.windows) {
            let absorbed = window.panes.iter().fold(S::zero(), |sum, heat| sum + *heat);
            power.book(Flow::Glass, self.model.coefficients.walls[w].area * absorbed);
        }
        for zone in &self.conditions.sun.zones {
            // What the surfaces absorb, computed from what came in: the balance closes only where both agree.
            power.book(Flow::Transmitted, zone.transmitted - zone.lost - zone.in_glass);
        }
    }

    /// What acts on the airs of the zones beside walls, and internal gains.
    #[inline(always)]
    fn add_zones(&self, power: &mut Power<S>) {
        let outdoor = self.conditions.outdoor_air;
        for (infiltration, &air) in self.laws.infiltration.iter().zip(&self.solution.air) {
            power.book(Flow::Infiltration, infiltration.at(outdoor - air));
        }
        for &zone in &self.flows.aired {
            power.book(Flow::Ventilation, self.laws.ventilation[zone].at(outdoor - self.solution.air[zone]));
        }
        for &zone in &self.flows.gaining {
            let at = &self.conditions.zones[zone];
            power.book(Flow::Gains, at.convective + at.radiant);
        }
        for (path, &conductance) in self.model.coefficients.paths.iter().zip(&self.conditions.paths) {
            let [a, b] = path.between.map(|zone| self.solution.air[zone]);
            let heat = conductance * (b - a);
            power.book(Flow::Interzone, heat);
            power.book(Flow::Interzone, -heat);
        }
        for &zone in &self.model.plan.ideal_loads {
            let load = self.load[zone];
            power.book(Flow::Heating, load.max(S::zero()));
            power.book(Flow::Cooling, load.min(S::zero()));
        }
    }

    /// Heat from an imposed temperature into its wall [W/m2].
    #[inline(always)]
    fn boundary_heat(&self, index: SurfaceId, at: &SurfaceConditions<S>) -> S {
        if self.model.coefficients.surfaces[index].convection.is_some() {
            let difference = self.solution.surfaces[index] - at.temperature;
            return -self.laws.surfaces[index].convection.at(difference);
        }
        let flux = self.surface_flux(index);
        if index.is_outside() { flux } else { -flux }
    }

    /// Conduction through a surface [W/m2], positive towards the inside.
    #[inline(always)]
    fn surface_flux(&self, index: SurfaceId) -> S {
        let (w, e) = (index.wall(), index.side());
        let surfaces = self.solution.surfaces.pair(w);
        if self.model.plan.walls[w].nonlinear {
            return self.system.walls[w].link_flux(e * self.model.plan.walls[w].len(), surfaces);
        }
        let [by_outside, by_inside] = self.system.responses[w][e];
        let into = self.system.sources[w][e] + by_outside * surfaces[0] + by_inside * surfaces[1];
        if e == 0 { -into } else { into }
    }
}
