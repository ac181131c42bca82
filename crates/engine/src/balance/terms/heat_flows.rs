//! Terms for the energy ledger: heat from the environment into the building, by flow.

use crate::balance::energy_balance::{Flow, Power, Sum};
use crate::building::ids::{BySide, SideId};
use crate::number::real::Real;

use super::Balances;
use super::evaluation::{Evaluation, HeatSink};

/// Flows through surfaces outdoors: sums of their own stay in registers.
struct ExteriorSums<S> {
    solar: Sum<S>,
    convection: Sum<S>,
    longwave: Sum<S>,
}

impl<S: Real> HeatSink<S> for ExteriorSums<S> {
    #[inline(always)]
    fn add_to_building(&mut self, flow: Flow, heat: S) {
        match flow {
            Flow::Solar => self.solar.add(heat),
            Flow::Convection => self.convection.add(heat),
            _ => self.longwave.add(heat),
        }
    }
}

/// All other flows; `flux` is the conduction from a surface into its wall [W/m2].
struct OtherFlows<'a, S, F> {
    power: &'a mut Power<S>,
    flux: F,
}

impl<S: Real, F: Fn(SideId) -> S> HeatSink<S> for OtherFlows<'_, S, F> {
    #[inline(always)]
    fn add_to_building(&mut self, flow: Flow, heat: S) {
        self.power.add_flow(flow, heat);
    }

    #[inline(always)]
    fn impose(&mut self, surface: SideId, area: S, _temperature: S) {
        // The environment supplies whatever the wall conducts away.
        self.power.add_flow(Flow::Boundary, area * (self.flux)(surface));
    }
}

impl<S: Real> Balances<'_, S> {
    /// Heat into the building at temperatures of cells, of which those with heat sources count, surfaces and airs [degC]; `flux` is the conduction from a surface into its
    /// wall [W/m2].
    #[inline(always)]
    pub(crate) fn power(
        &self,
        (cells, surfaces, air): (&[S], &BySide<S>, &[S]),
        flux: impl Fn(SideId) -> S,
    ) -> Power<S> {
        let mut power = Power::none();
        let heat = ExteriorSums { solar: Sum::none(), convection: Sum::none(), longwave: Sum::none() };
        let mut exterior = Evaluation { cells: &[], surfaces, air, heat };
        self.exterior_surfaces(&mut exterior);
        power.add_sum(Flow::Solar, &exterior.heat.solar);
        power.add_sum(Flow::Convection, &exterior.heat.convection);
        power.add_sum(Flow::Longwave, &exterior.heat.longwave);
        let heat = OtherFlows { power: &mut power, flux };
        let mut others = Evaluation { cells, surfaces, air, heat };
        self.heat_sources(&mut others);
        self.imposed_temperatures(&mut others);
        self.windows(&mut others);
        self.outdoor_air(&mut others);
        self.gains(&mut others);
        self.air_paths(&mut others);
        self.mechanical_air(&mut others);
        self.bridges(&mut others);
        self.ideal_loads(&mut others);
        power
    }
}
