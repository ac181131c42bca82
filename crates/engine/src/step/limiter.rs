//! How far an iterate moves: not across a melting range at once, not to more heat than the tangent has, and half of the step where the
//! iteration may be in a cycle.

use crate::building::coefficients::Matter;
use crate::linear::unknowns::line;
use crate::linear::wall::StorageRule;
use crate::number::real::Real;
use crate::step::newton::{DAMPING_START, StageSolver};
use crate::step::stage::Stage;
use crate::step::state::blend;

/// Iterations before measured melting curves, tables and hysteresis limit a step by its heat: what converges at once is spared the
/// evaluation.
const STRAIGHT: usize = 2;

impl<S: Real> StageSolver<'_, S> {
    /// Moves the iterate of the active lanes to the solution, limited where it would cross a melting range.
    #[inline(always)]
    pub(super) fn advance(&mut self, stage: &Stage<'_, S>, active: S::Mask, iteration: usize) {
        if iteration >= DAMPING_START && iteration.is_multiple_of(3) {
            self.damp();
        }
        let model = stage.model;
        // The apparent capacity is a constant of the step: there is nothing to cross.
        let limits = stage.tableau.storage == StorageRule::Enthalpy;
        for surfaces in &model.parts.linearised {
            let solution = self.solution.surfaces.places(surfaces);
            blend(active, self.iterate.surfaces.places_mut(surfaces), solution);
        }
        blend(active, &mut self.iterate.air, &self.solution.air);
        for cells in &model.parts.solid_cells {
            blend(active, &mut self.iterate.cells[cells.clone()], &self.solution.cells[cells.clone()]);
        }
        for &w in &model.parts.melting_walls {
            let (numbers, cells) = (&model.coefficients.walls[w], model.cells(w));
            let moves = self.iterate.cells[cells.clone()].iter_mut().zip(&self.solution.cells[cells.clone()]);
            let laws = numbers.cells.iter().zip(&stage.histories[cells.clone()]);
            for ((old, &new), (cell, memory)) in moves.zip(laws) {
                let target = match cell.matter {
                    Matter::Pcm(law) if limits && iteration >= STRAIGHT => {
                        numbers.pcm[law].limit_heat(*old, new, memory)
                    }
                    Matter::Pcm(law) if limits => numbers.pcm[law].limit(*old, new, memory),
                    Matter::Pcm(_) | Matter::Solid { .. } => new,
                };
                *old = S::select(active, target, *old);
            }
        }
    }

    /// Halves the step that Newton's iteration takes: it then leaves a cycle.
    #[cold]
    fn damp(&mut self) {
        let halve = |new: &mut [S], old: &[S]| {
            for (a, &b) in new.iter_mut().zip(old) {
                *a = line(b, *a, 0.5);
            }
        };
        halve(&mut self.solution.surfaces, &self.iterate.surfaces);
        halve(&mut self.solution.air, &self.iterate.air);
        halve(&mut self.solution.cells, &self.iterate.cells);
    }
}
