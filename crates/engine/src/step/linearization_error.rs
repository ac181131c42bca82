//! What the tangents of the laws leave out at the solution of a linear solve: the residual of the heat balances there.
//!
//! A law differs from its tangent by half its second derivative times the square of the change. For most laws this is
//! estimated, without evaluating them once more: the second derivative of a melting curve `tanh` is at most twice its slope
//! over its width, that of natural convection `C (d^2 + r^2)^(n/2) d` at most `1.55 n C (d^2 + r^2)^((n - 1)/2)`, with the
//! temperature difference `d` and the rounding `r` of its root. All other melting curves are evaluated at the solution, once
//! all else is small.

use crate::building::coefficients::Boundary;
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::linear::building_system::BuildingSystem;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::StorageRule;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::convection::natural::ROUND_OFF;
use crate::physics::doors;
use crate::step::stage::Stage;

/// Heat flow density that a building has at night and in calm air; the absorbed sun is added to it [W/m2].
const LEAST_FLOW: f64 = 10.0;
/// Half of the second derivative of emission, which is also more than that of air flow over the area of a zone [W/(m2 K2)].
const EMISSION: f64 = 0.05;
/// Half of the second derivative of natural convection, times the cube root of the square of the temperature difference
/// [W/(m2 K^(4/3))]: with `n = 1/3` it is `0.26 C`, and `C` is at most 1.63 in the published correlations.
const CONVECTION: f64 = 0.6;
/// More than the heat transfer coefficients of natural convection on the two sides of equal temperatures, where correlations
/// for warm and for cold plates meet [W/(m2 K)].
const SIDES: f64 = 2.0;

/// What rounding adds to the change of a temperature difference [K].
const ROUNDING: ByPrecision = ByPrecision { double: 1e-11, single: 1e-3 };

/// Parts of a building whose laws are nonlinear.
#[derive(Debug, Clone)]
pub(crate) struct NonlinearLaws<S> {
    /// Surfaces with natural convection outdoors, and those in zones with their zone.
    exterior: Vec<SideId>,
    interior: Vec<(SideId, usize)>,
    /// Walls whose melting curves are estimated, and those whose curves have to be evaluated.
    estimated: Vec<usize>,
    evaluated: Vec<usize>,
    /// Surfaces outdoors, which the sun falls on.
    outdoors: Vec<SideId>,
    /// How much more convection bends than [`CONVECTION`] says; one at least.
    bend: S,
    /// What is accepted in this stage.
    limit: Limit<S>,
}

/// What is accepted in a stage.
#[derive(Debug, Clone, Copy)]
struct Limit<S> {
    /// Largest remainder [W/m2].
    linearization_error: S,
    /// Third power of the largest remainder over [`CONVECTION`] [K4].
    cube: S,
    /// Largest change of a temperature difference that changes its sign [K].
    across: S,
}

impl<S: Real> Limit<S> {
    #[inline(always)]
    fn new(linearization_error: S, bend: S) -> Self {
        let (root, across) = (
            linearization_error.scale(1.0 / CONVECTION) / bend,
            linearization_error.scale(1.0 / SIDES) / bend,
        );
        Self { linearization_error, cube: root * root * root, across }
    }

    /// Square of a temperature difference from which on the remainder of natural convection is accepted [K2], where no temperature has
    /// changed by more than `change` [K]: it is smooth enough there, and too far from zero to have changed its sign.
    #[inline(always)]
    fn far(&self, change: S) -> S {
        let most = change.scale(2.0) + S::constant(ROUNDING.of::<S>());
        let square = most * most;
        (square * square * square / self.cube).max(square)
    }

    /// Where the remainder of natural convection is accepted; temperature difference from surface to air at the iterate
    /// and at the solution [K].
    #[inline(always)]
    fn accepts_convection(&self, before: S, after: S) -> S::Mask {
        let moved = after - before;
        let square = moved * moved;
        let rounded = after * after + S::constant(ROUND_OFF * ROUND_OFF);
        let smooth = (square * square * square).lt(self.cube * rounded);
        let one_side = !(before * after).lt(S::zero());
        smooth & (one_side | moved.abs().lt(self.across))
    }
}

impl<S: Real> NonlinearLaws<S> {
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let (parts, plan, coefficients) = (&model.parts, model.plan, &model.coefficients);
        let (mut exterior, mut interior) = (Vec::new(), Vec::new());
        for &surface in &parts.surfaces.nonlinear {
            match plan.surfaces[surface].role {
                SideRole::Zone { zone, .. } => interior.push((surface, zone)),
                SideRole::Exterior => exterior.push(surface),
            }
        }
        let laws = parts.surfaces.nonlinear.iter().filter_map(|&surface| model.convection(surface));
        let bend = laws.fold(S::one(), |most, law| most.max(law.bend()));
        let estimated = |&w: &usize| coefficients.walls[w].pcm.iter().all(|law| law.curvature().is_some());
        let (estimated, evaluated) = parts.nonlinear_walls.iter().copied().partition(estimated);
        let outdoors =
            |&surface: &SideId| matches!(coefficients.surfaces[surface].boundary, Boundary::Outdoors(_));
        Self {
            exterior,
            interior,
            estimated,
            evaluated,
            outdoors: plan.surfaces.ids().filter(outdoors).collect(),
            bend,
            limit: Limit::new(S::zero(), S::one()),
        }
    }

    /// Sets what is accepted in a stage, by the heat flows that drive it.
    #[inline(always)]
    pub(crate) fn begin(&mut self, stage: &Stage<'_, S>) {
        let mut sun = S::zero();
        for &surface in &self.outdoors {
            sun = sun.max(stage.conditions.surfaces[surface].solar);
        }
        let flow = sun + S::constant(LEAST_FLOW);
        self.limit = Limit::new(flow.scale(stage.tableau.tolerance.linearization_error.of::<S>()), self.bend);
    }

    /// Where a change of a temperature [K] is not too large for any law, by lane.
    #[inline(always)]
    pub(crate) fn accepts_change(&self, change: S) -> S::Mask {
        (change * change).scale(EMISSION).lt(self.limit.linearization_error)
    }

    /// Where the largest remainder is accepted, by lane. `change`: the largest change from the iterate to the solution [K].
    #[inline(always)]
    pub(crate) fn accepts(
        &self,
        stage: &Stage<'_, S>,
        change: S,
        system: &BuildingSystem<'_, S>,
        [old, new]: [&Unknowns<S>; 2],
    ) -> S::Mask {
        let mut small = self.accepts_change(change);
        // In most of the iterations that do not end here, this is enough to know.
        if !small.any() {
            return small;
        }
        let far = self.limit.far(change);
        for &surface in &self.exterior {
            let air = stage.conditions.surfaces[surface].temperature;
            let after = new.surfaces[surface] - air;
            if (!far.lt(after * after)).any() {
                small = small & self.limit.accepts_convection(old.surfaces[surface] - air, after);
            }
        }
        for &(surface, zone) in &self.interior {
            let shift = stage.conditions.surfaces[surface].air_shift;
            let after = new.surfaces[surface] - new.air[zone] - shift;
            if (!far.lt(after * after)).any() {
                let before = old.surfaces[surface] - old.air[zone] - shift;
                small = small & self.limit.accepts_convection(before, after);
            }
        }
        for (door, &whole) in stage.model.coefficients.doors.iter().zip(&stage.conditions.doors) {
            let [zone, other] = door.between;
            let [before, after] = [old.air[zone] - old.air[other], new.air[zone] - new.air[other]];
            let left = doors::heat(whole, after) - doors::tangent(whole, before).at(after);
            let areas = &stage.model.coefficients.zones[zone].areas;
            let area = areas.iter().fold(S::zero(), |sum, &area| sum + area);
            small = small & left.abs().lt(self.limit.linearization_error * area);
        }
        if stage.tableau.storage == StorageRule::ApparentCapacity || !small.any() {
            return small;
        }
        let mut largest = S::zero();
        for &w in &self.estimated {
            largest = largest.max(system.walls[w].estimated_remainder());
        }
        small = small & largest.lt(self.limit.linearization_error);
        if !self.evaluated.is_empty() && small.any() {
            small = small & self.accepts_evaluated(stage, &self.evaluated, system, new);
        }
        small
    }

    /// Where the remainder of the melting curves of some walls, evaluated, is accepted.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn accepts_evaluated(
        &self,
        stage: &Stage<'_, S>,
        walls: &[usize],
        system: &BuildingSystem<'_, S>,
        solution: &Unknowns<S>,
    ) -> S::Mask {
        let mut largest = S::zero();
        for &w in walls {
            let (numbers, cells) = (&stage.model.coefficients.walls[w], stage.model.cells(w));
            let surfaces = solution.surfaces.pair(w);
            let memory = &stage.histories[cells];
            largest = largest.max(system.walls[w].linearization_error(numbers, memory, surfaces));
        }
        largest.lt(self.limit.linearization_error)
    }

    /// As [`Self::accepts`], with all melting curves evaluated.
    #[inline(always)]
    pub(crate) fn accepts_with_all_evaluated(
        &self,
        stage: &Stage<'_, S>,
        change: S,
        system: &BuildingSystem<'_, S>,
        places: [&Unknowns<S>; 2],
    ) -> S::Mask {
        let walls = &stage.model.parts.nonlinear_walls;
        self.accepts(stage, change, system, places) & self.accepts_evaluated(stage, walls, system, places[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From [`Limit::far`] on nothing has to be looked at: the remainder is accepted at any temperature difference before the change. Closer to
    /// zero it is not always.
    #[test]
    fn far_from_zero_the_remainder_of_convection_is_accepted() {
        let power = |exponent: f64| Real::powf(10.0_f64, exponent);
        let (mut beyond, mut refused) = (0, 0);
        for k in 0..20 * 30 * 40 {
            let [error, change, after] = [k % 20, k / 20 % 30, k / 600].map(f64::from);
            let limit = Limit::new(power(-8.5 + 0.23 * error), 1.0);
            let (change, after) = (power(-7.0 + 0.27 * change), power(-4.0 + 0.13 * after));
            for moved in [-2.0 * change, -change, change, 2.0 * change] {
                let accepted = limit.accepts_convection(after - moved, after);
                if limit.far(change) < after * after {
                    beyond += 1;
                    assert!(accepted, "{change} K to {after} K");
                }
                refused += usize::from(!accepted);
            }
        }
        assert!(beyond > 10_000 && refused > 10_000, "{beyond}, {refused}");
    }
}
