//! The histories of phase-change cells as their laws read them within a stage, where a law depends on time: with the length of
//! the stage, and in the second stage what the first one has reached.

use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::number::real::Real;
use crate::physics::pcm::{PcmCoefficients, PcmHistory, StageStart};
use crate::step::scheme::Tableau;
use crate::step::state::State;

/// Histories of all cells within a stage; none in a building without such a law, whose stages read those of the state.
#[derive(Debug, Clone)]
pub(crate) struct StageHistories<S> {
    cells: Vec<PcmHistory<S>>,
    /// Cells of laws that depend on time: wall, cell, law of the wall.
    timed: Vec<[usize; 3]>,
    /// Length of the step [s].
    step: f64,
}

impl<S: Real> StageHistories<S> {
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let mut timed = Vec::new();
        for &w in &model.parts.nonlinear_walls {
            let (wall, numbers) = (&model.plan.walls[w], &model.coefficients.walls[w]);
            for (i, cell) in numbers.cells.iter().enumerate() {
                match cell.matter {
                    Matter::Pcm(law) if numbers.pcm[law].has_rate() => {
                        timed.push([w, wall.first_cell + i, law]);
                    }
                    _ => {}
                }
            }
        }
        let count = if timed.is_empty() { 0 } else { model.plan.n_cells };
        Self { cells: vec![PcmHistory::new(S::zero(), S::zero()); count], timed, step: 0.0 }
    }

    /// What the laws read in the present stage of a step from a state.
    #[inline(always)]
    pub(crate) fn within<'h>(&'h self, state: &'h State<S>) -> &'h [PcmHistory<S>] {
        if self.timed.is_empty() { &state.memory } else { &self.cells }
    }

    /// Begins the first stage of a step of a length [s]; zero: no time passes.
    #[inline(always)]
    pub(crate) fn begin(&mut self, model: &Model<'_, S>, state: &State<S>, tableau: &Tableau, step: f64) {
        if self.timed.is_empty() {
            return;
        }
        self.step = step;
        self.cells.copy_from_slice(&state.memory);
        self.set(model, state, tableau, |_, _, _| None);
    }

    /// Begins the second stage, which the first one has left at temperatures of the cells [degC].
    #[inline(always)]
    pub(crate) fn begin_second(
        &mut self,
        model: &Model<'_, S>,
        state: &State<S>,
        tableau: &Tableau,
        reached: &[S],
    ) {
        if self.timed.is_empty() {
            return;
        }
        self.set(model, state, tableau, |law, history, k| {
            Some((law.at(reached[k], history).liquid_fraction, tableau.ratio))
        });
    }

    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn set(
        &mut self,
        model: &Model<'_, S>,
        state: &State<S>,
        tableau: &Tableau,
        first: impl Fn(&PcmCoefficients<S>, &PcmHistory<S>, usize) -> Option<(S, f64)>,
    ) {
        for &[w, k, law] in &self.timed {
            let law = &model.coefficients.walls[w].pcm[law];
            let first = first(law, &self.cells[k], k);
            let start = StageStart { step: self.step, diagonal: tableau.diagonal, first };
            self.cells[k] = law.in_stage(&state.memory[k], &start);
        }
    }
}
