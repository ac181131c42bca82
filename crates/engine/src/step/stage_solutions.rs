//! Solutions of the stages of a plain run: numbers with derivatives are computed along them.

use core::ops::Range;

use crate::linear::unknowns::Unknowns;
use crate::number::real::Real;

/// The solution of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution<'a> {
    pub(crate) stages: &'a [Unknowns<f64>],
    /// Ideal loads, means over the step [W].
    pub(crate) load: &'a [f64],
}

impl Solution<'_> {
    /// Its numbers; of cells only some.
    pub(crate) fn write(&self, cells: &[Range<usize>], numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(self.load);
        for stage in self.stages {
            numbers.extend_from_slice(&stage.surfaces);
            numbers.extend_from_slice(&stage.air);
            for cells in cells {
                numbers.extend_from_slice(&stage.cells[cells.clone()]);
            }
        }
    }
}

/// Reads the numbers of a solution. False where there are none.
pub(crate) fn read_solution(
    mut numbers: &[f64],
    cells: &[Range<usize>],
    stages: &mut [Unknowns<f64>],
    load: &mut [f64],
) -> bool {
    let known = !numbers.is_empty();
    let mut take = |values: &mut [f64]| {
        if let Some((own, rest)) = numbers.split_at_checked(values.len()) {
            values.copy_from_slice(own);
            numbers = rest;
        }
    };
    take(load);
    for stage in stages {
        take(&mut stage.surfaces);
        take(&mut stage.air);
        for cells in cells {
            take(&mut stage.cells[cells.clone()]);
        }
    }
    known
}

/// Solutions of the stages of a step, which a stepper keeps for derivatives.
#[derive(Debug, Clone)]
pub(crate) struct StageSolutions<S> {
    keeps: bool,
    /// Solutions of the stages of this step, and how many there are.
    kept: Vec<Unknowns<S>>,
    count: usize,
    /// The step was halved: its stages are not those of a whole one.
    pub(crate) halved: bool,
}

impl<S: Real> StageSolutions<S> {
    pub(crate) fn nothing() -> Self {
        Self { keeps: false, kept: Vec::new(), count: 0, halved: false }
    }

    /// Keeps solutions from now on.
    pub(crate) fn start(&mut self) {
        self.keeps = true;
    }

    /// Whether solutions are kept.
    #[inline(always)]
    pub(crate) fn keeps(&self) -> bool {
        self.keeps
    }

    /// The stages of a step begin, or begin again.
    #[inline(always)]
    pub(crate) fn restart(&mut self) {
        self.count = 0;
    }

    /// A stage has been solved.
    #[inline(always)]
    pub(crate) fn keep(&mut self, solved: &Unknowns<S>) {
        if self.keeps {
            if let Some(kept) = self.kept.get_mut(self.count) {
                kept.copy_from(solved);
            } else {
                self.kept.push(solved.clone());
            }
            self.count += 1;
        }
    }

    /// The last stage has been corrected.
    #[inline(always)]
    pub(crate) fn amend(&mut self, solved: &Unknowns<S>) {
        if let Some(last) = self.count.checked_sub(1) {
            self.kept[last].copy_from(solved);
        }
    }
}

impl StageSolutions<f64> {
    /// The solution of the step just made, with the loads at its end; none where it was halved.
    pub(crate) fn solution<'a>(&'a self, load: &'a [f64]) -> Option<Solution<'a>> {
        let stages = &self.kept[..self.count];
        (!stages.is_empty() && !self.halved).then_some(Solution { stages, load })
    }
}
