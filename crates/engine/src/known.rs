//! Solutions of stages that are known beforehand: of a plain run, for one that carries derivatives along it.

use crate::real::Real;
use crate::state::Unknowns;

/// What a step found.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    stages: Vec<Unknowns<f64>>,
    load: Vec<f64>,
}

/// What a stepper keeps of its solutions, and those that guide it.
#[derive(Debug, Clone)]
pub(crate) struct Known<S> {
    /// Solutions of the stages of this step, where they are kept.
    kept: Option<Vec<Unknowns<S>>>,
    /// The step was halved: its stages are not those of a whole one.
    pub(crate) halved: bool,
    guide: Option<Solution>,
    /// Next stage that is guided.
    stage: usize,
}

impl<S: Real> Known<S> {
    pub(crate) fn nothing() -> Self {
        Self { kept: None, halved: false, guide: None, stage: 0 }
    }

    /// Keeps solutions from now on.
    pub(crate) fn start(&mut self) {
        self.kept = Some(Vec::new());
    }

    /// Whether solutions are kept.
    #[inline(always)]
    pub(crate) fn keeps(&self) -> bool {
        self.kept.is_some()
    }

    /// The stages of a step begin, or begin again.
    #[inline(always)]
    pub(crate) fn restart(&mut self) {
        self.stage = 0;
        if let Some(kept) = &mut self.kept {
            kept.clear();
        }
    }

    /// A stage is solved.
    #[inline(always)]
    pub(crate) fn keep(&mut self, solved: &Unknowns<S>) {
        if let Some(kept) = &mut self.kept {
            kept.push(solved.clone());
        }
    }

    /// The last stage is corrected.
    #[inline(always)]
    pub(crate) fn amend(&mut self, solved: &Unknowns<S>) {
        if let Some(last) = self.kept.as_mut().and_then(|kept| kept.last_mut()) {
            last.copy_from(solved);
        }
    }

    /// Goes along a solution in the next step, or finds it itself.
    pub(crate) fn follow(&mut self, solution: Option<Solution>) {
        self.guide = solution;
    }

    /// True where the solution of the step is known.
    #[inline(always)]
    pub(crate) fn guides(&self) -> bool {
        S::DERIVATIVES && self.guide.is_some()
    }

    /// Sets an iterate to the solution of the next stage. False where it is not known.
    #[inline(always)]
    pub(crate) fn guide(&mut self, iterate: &mut Unknowns<S>) -> bool {
        let Some(solution) = self.guide.as_ref().and_then(|guide| guide.stages.get(self.stage)) else {
            return false;
        };
        iterate.set(solution);
        self.stage += 1;
        true
    }

    /// Sets the loads to those of the solution, where it is known.
    #[inline(always)]
    pub(crate) fn load(&self, load: &mut [S]) {
        if let Some(guide) = self.guide.as_ref().filter(|_| S::DERIVATIVES) {
            for (load, &known) in load.iter_mut().zip(&guide.load) {
                *load = S::constant(known);
            }
        }
    }
}

impl Known<f64> {
    /// The solution of the step just made, with the loads at its end; none where it was halved.
    pub(crate) fn solution(&self, load: &[f64]) -> Option<Solution> {
        let stages = self.kept.clone().filter(|kept| !kept.is_empty() && !self.halved)?;
        Some(Solution { stages, load: load.to_vec() })
    }
}
