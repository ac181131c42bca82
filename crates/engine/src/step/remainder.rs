//! What the tangents of the laws leave out at the solution of a linear solve: the residual of the heat balances there.
//!
//! A law differs from its tangent by half its second derivative times the square of the change. For most laws this is
//! estimated, without evaluating them once more: the second derivative of a melting curve `tanh` is at most twice its slope
//! over its width, that of natural convection (powers up to 4/3 of the temperature difference) a third of its slope over
//! the difference. All other melting curves are evaluated at the solution, once all else is small.

use crate::building::coefficients::Boundary;
use crate::building::ids::SurfaceId;
use crate::building::model::Model;
use crate::building::plan::SurfaceRole;
use crate::linear::building_system::BuildingSystem;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::StorageRule;
use crate::number::real::{Mask, Real};
use crate::step::stage::Stage;

/// Largest remainder that is accepted, over the largest heat flow density [-].
const ACCEPTED: f64 = 1e-9;
/// Heat flow density that a building has at night and in calm air; the absorbed sun is added to it [W/m2].
const LEAST_FLOW: f64 = 10.0;
/// Half of the second derivative of emission, which is also more than that of air flow over the area of a zone [W/(m2 K2)].
const EMISSION: f64 = 0.05;
/// A sixth of a slope of natural convection [W/(m2 K)].
const CONVECTION: f64 = 0.7;
/// Smaller differences count as this one: there the slope of natural convection is small [K].
const LEAST_DIFFERENCE: f64 = 1e-5;

/// Parts of a building whose laws are nonlinear.
#[derive(Debug, Clone)]
pub(crate) struct NonlinearLaws<S> {
    /// Surfaces with natural convection, and the zone whose air they meet; none outdoors.
    convective: Vec<(SurfaceId, Option<usize>)>,
    /// Walls whose melting curves are estimated, and those whose curves have to be evaluated.
    estimated: Vec<usize>,
    evaluated: Vec<usize>,
    /// Surfaces outdoors, which the sun falls on.
    outdoors: Vec<SurfaceId>,
    /// Largest remainder that is accepted in this stage [W/m2].
    accepted: S,
}

impl<S: Real> NonlinearLaws<S> {
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let (parts, plan, coefficients) = (&model.parts, model.plan, &model.coefficients);
        let zone = |surface: SurfaceId| match plan.surfaces[surface].role {
            SurfaceRole::Zone { zone, .. } => Some(zone),
            SurfaceRole::Exterior => None,
        };
        let estimated = |&w: &usize| coefficients.walls[w].pcm.iter().all(|law| law.curvature().is_some());
        let (estimated, evaluated) = parts.nonlinear_walls.iter().copied().partition(estimated);
        let outdoors =
            |&surface: &SurfaceId| matches!(coefficients.surfaces[surface].boundary, Boundary::Outdoors(_));
        Self {
            convective: parts.surfaces.nonlinear.iter().map(|&surface| (surface, zone(surface))).collect(),
            estimated,
            evaluated,
            outdoors: plan.surfaces.ids().filter(outdoors).collect(),
            accepted: S::zero(),
        }
    }

    /// Sets what is accepted in a stage, by the heat flows that drive it.
    #[inline(always)]
    pub(crate) fn begin(&mut self, stage: &Stage<'_, S>) {
        let mut sun = S::zero();
        for &surface in &self.outdoors {
            sun = sun.max(stage.conditions.surfaces[surface].solar);
        }
        self.accepted = (sun + S::constant(LEAST_FLOW)).scale(ACCEPTED);
    }

    /// The largest remainder less what is accepted [W/m2]: below zero where the solution is accepted. `change`: the largest
    /// change from the iterate to the solution [K].
    #[inline(always)]
    pub(crate) fn excess(
        &self,
        stage: &Stage<'_, S>,
        change: S,
        system: &BuildingSystem<'_, S>,
        [old, new]: [&Unknowns<S>; 2],
    ) -> S {
        let accepted = self.accepted;
        let mut largest = (change * change).scale(EMISSION) - accepted;
        let by_difference = accepted.scale(1.0 / CONVECTION);
        for &(surface, zone) in &self.convective {
            let [before, after] = if let Some(zone) = zone {
                [old, new].map(|at| at.surfaces[surface] - at.air[zone])
            } else {
                let outdoors = stage.conditions.surfaces[surface].temperature;
                [old, new].map(|at| at.surfaces[surface] - outdoors)
            };
            let moved = after - before;
            let most = (after.abs() + S::constant(LEAST_DIFFERENCE)) * by_difference;
            largest = largest.max(moved * moved - most);
        }
        if stage.storage == StorageRule::ApparentCapacity {
            return largest;
        }
        for &w in &self.estimated {
            largest = largest.max(system.walls[w].estimated_remainder() - accepted);
        }
        if !self.evaluated.is_empty() && largest.lt(S::zero()).any() {
            largest = largest.max(self.evaluate(stage, &self.evaluated, system, new));
        }
        largest
    }

    /// The largest remainder of the melting curves of some walls, evaluated, less what is accepted [W/m2].
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn evaluate(
        &self,
        stage: &Stage<'_, S>,
        walls: &[usize],
        system: &BuildingSystem<'_, S>,
        solution: &Unknowns<S>,
    ) -> S {
        let mut largest = -self.accepted;
        for &w in walls {
            let (numbers, cells) = (&stage.model.coefficients.walls[w], stage.model.cells(w));
            let surfaces = solution.surfaces.pair(w);
            let memory = &stage.state.memory[cells];
            largest = largest.max(system.walls[w].remainder(numbers, memory, surfaces) - self.accepted);
        }
        largest
    }

    /// As [`Self::excess`], with all melting curves evaluated.
    #[inline(always)]
    pub(crate) fn excess_evaluated(
        &self,
        stage: &Stage<'_, S>,
        change: S,
        system: &BuildingSystem<'_, S>,
        places: [&Unknowns<S>; 2],
    ) -> S {
        let walls = &stage.model.parts.nonlinear_walls;
        self.excess(stage, change, system, places).max(self.evaluate(stage, walls, system, places[1]))
    }
}
