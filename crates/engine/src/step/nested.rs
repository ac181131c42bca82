//! The nested iteration: the enthalpy is the difference of two convex functions; the outer iteration goes along the tangent
//! of the second, the inner one is Newton's on the first. Each converges from one side as long as the rest is linear.
//!
//! Source: Casulli & Zanolli (2010), SIAM J. Sci. Comput. 32(4), doi:10.1137/100786320.

use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::linear::thick_walls::ThickWalls;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Mask, Real};
use crate::physics::constants::KELVIN;
use crate::physics::pcm::PcmHistory;
use crate::step::newton::{MAX_ITERATIONS, StageSolver, TOLERANCE};
use crate::step::stage::Stage;

/// Iterations in all before a stage is given up.
const MAX_NESTED: usize = 10 * MAX_ITERATIONS;
/// Colder than any melting range: there the second function is zero [degC].
const SOLID: f64 = -KELVIN;

impl<S: Real> StageSolver<'_, S> {
    /// Solves a stage from its start, one lane. False where it does not converge.
    // One copy only: inlining multiplies compile time.
    #[cold]
    #[inline(never)]
    pub(super) fn solve_nested(&mut self, stage: &Stage<'_, S>) -> bool {
        let model = stage.model;
        let (state, histories) = (stage.state, complete_histories(model, stage.histories));
        let stage = &Stage { histories: &histories, ..*stage };
        let enough = S::constant(TOLERANCE.of::<S>());
        let mut outer =
            Unknowns { cells: state.cells.clone(), surfaces: state.surfaces.clone(), air: state.air.clone() };
        self.iterate.copy_from(&outer);
        outer.cells.fill(S::constant(SOLID));
        let start = self.counters.iterations;
        while self.counters.iterations - start < MAX_NESTED && self.check_stop().is_ok() {
            let Some(change) = self.solve_convex(stage, &outer.cells) else { return false };
            let places = [&outer, &self.solution];
            let moved = self.distance(model, &outer);
            if moved.lt(enough).any()
                && ThickWalls::accepts(self.load_residual_before).any()
                && self.nonlinear.accepts_with_all_evaluated(stage, change, &self.system, places).any()
            {
                self.counters.nested += 1;
                self.accept_change(change);
                return self.finish(stage, true).any();
            }
            outer.copy_from(&self.solution);
        }
        false
    }

    /// Newton's iteration with the second function along its tangent at the outer cells. The last change [K]; none where it
    /// does not converge.
    fn solve_convex(&mut self, stage: &Stage<'_, S>, outer: &[S]) -> Option<S> {
        for _ in 0..MAX_ITERATIONS {
            self.solve_linearised(stage, Some(outer));
            let change = self.change(stage.model);
            if change.lt(S::constant(TOLERANCE.of::<S>())).any() {
                return Some(change);
            }
            self.iterate.copy_from(&self.solution);
        }
        None
    }
}

/// Histories with all that the split of the enthalpy into convex functions needs.
fn complete_histories<S: Real>(model: &Model<'_, S>, histories: &[PcmHistory<S>]) -> Vec<PcmHistory<S>> {
    let mut histories = histories.to_vec();
    for (wall, numbers) in model.plan.walls.iter().zip(&model.coefficients.walls) {
        for (i, cell) in numbers.cells.iter().enumerate() {
            if let Matter::Pcm(law) = cell.matter {
                let k = wall.first_cell + i;
                histories[k] = numbers.pcm[law].complete(&histories[k]);
            }
        }
    }
    histories
}
