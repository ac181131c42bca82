//! The flows of vapour of a stage, counted for the vapour balance.

use crate::balance::vapour::{VapourFlow, VapourLedger};
use crate::building::coefficients::HumidityCoefficients;
use crate::building::humidity::HumidityPlan;
use crate::number::real::Real;

use super::flows::StageFlows;
use super::plants::Limits;

/// A solution of a stage, and what it is counted by.
pub(super) struct Counted<'r, S: Real> {
    pub(super) flows: &'r StageFlows<S>,
    pub(super) reached: &'r [S],
    pub(super) removed: &'r [S],
    pub(super) limits: &'r [Limits<S>],
}

/// Adds the flows of a solution, which counts for a duration in each zone [s]; what plants take away and add into `plants`.
#[inline(always)]
pub(super) fn count<S: Real>(
    plan: &HumidityPlan,
    humidity: &HumidityCoefficients<S>,
    solution: &Counted<'_, S>,
    duration: impl Fn(usize) -> S,
    plants: &mut [[S; 2]],
    step: &mut VapourLedger<S>,
) {
    let Counted { flows, reached, removed, limits } = *solution;
    for (z, (zone, numbers)) in flows.zones.iter().zip(&humidity.zones).enumerate() {
        let lasting = duration(z);
        let fresh = zone.outward * (flows.outdoor - reached[z]);
        step.add_flow(VapourFlow::OutdoorAir, fresh * lasting);
        step.add_flow(VapourFlow::Gains, zone.gain * lasting);
        let [dried, condensed, added] = limits[z].shares(removed[z]);
        if numbers.has_plants() {
            step.add_flow(VapourFlow::Drying, -(dried * lasting));
        }
        step.add_flow(VapourFlow::Condensation, -(condensed * lasting));
        if numbers.has_plants() {
            step.add_flow(VapourFlow::Humidifying, added * lasting);
            plants[z][0] += dried * lasting;
            plants[z][1] += added * lasting;
        }
    }
    for (&[from, to], &carried) in plan.carries.iter().zip(&flows.carried) {
        if from != to {
            let vapour = carried * (reached[from] - flows.outdoor) * duration(from);
            step.add_flow(VapourFlow::Interzone, vapour);
            step.add_flow(VapourFlow::Interzone, -vapour);
        }
    }
}
