//! Solutions of the stages of a plain run, for numbers with derivatives that follow it.

use crate::real::Real;
use crate::state::Unknowns;

/// What a step found.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub(crate) stages: Vec<Unknowns<f64>>,
    /// Mean loads of the plants [W].
    pub(crate) load: Vec<f64>,
}

/// What a stepper keeps of its solutions.
#[derive(Debug, Clone)]
pub(crate) struct Known<S> {
    /// Solutions of the stages of this step, where they are kept.
    kept: Option<Vec<Unknowns<S>>>,
    /// The step was halved: its stages are not those of a whole one.
    pub(crate) halved: bool,
}

impl<S: Real> Known<S> {
    pub(crate) fn nothing() -> Self {
        Self { kept: None, halved: false }
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
}

impl Known<f64> {
    /// The solution of the step just made, with the loads at its end; none where it was halved.
    pub(crate) fn solution(&self, load: &[f64]) -> Option<Solution> {
        let stages = self.kept.clone().filter(|kept| !kept.is_empty() && !self.halved)?;
        Some(Solution { stages, load: load.to_vec() })
    }
}
