//! The temperatures that the iteration of a stage starts from, extrapolated from what went before.

use crate::building::coefficients::Matter;
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::Plan;
use crate::linear::unknowns::{Temperatures, Unknowns, line};
use crate::number::real::Real;
use crate::physics::pcm::PcmHistory;
use crate::step::state::State;

/// A step that is longer than the one before is guessed as one of so many times its length at most.
const LONGER: f64 = 2.0;

/// What initial guesses are made from beside the state: the start of the step before.
#[derive(Debug, Clone)]
pub(crate) struct Guess<S> {
    previous: Option<Unknowns<S>>,
    /// Length of that step [s]; zero: that of the next one.
    length: f64,
}

impl<S: Real> Guess<S> {
    /// Nothing went before.
    pub(crate) fn none() -> Self {
        Self { previous: None, length: 0.0 }
    }

    /// What comes next does not continue the step before.
    pub(crate) fn forget(&mut self) {
        self.previous = None;
    }

    /// The start of the step before, where this step continues it.
    #[inline(always)]
    pub(crate) fn previous(&self) -> Option<Temperatures<'_, S>> {
        self.previous.as_ref().map(Unknowns::view)
    }

    /// Keeps the start of this step for the guess of the next.
    #[inline(always)]
    pub(crate) fn remember(&mut self, model: &Model<'_, S>, state: &State<S>, length: f64) {
        self.length = length;
        let plan = model.plan;
        let zero = || Unknowns::zero(plan.n_cells, plan.surfaces.len(), plan.zones.len());
        self.previous.get_or_insert_with(zero).copy_some(&model.parts.nonlinear_cells, &state.view());
    }

    /// Copies the lanes of another one where the mask is true.
    pub(crate) fn take(&mut self, mask: S::Mask, other: &Self) {
        if let (Some(mine), Some(theirs)) = (&mut self.previous, &other.previous) {
            mine.take(mask, theirs);
        }
    }

    /// What comes next starts from another state than the one that was reached, but goes on from it as it would have from there.
    pub(crate) fn move_by(&mut self, reached: &State<S>, start: &State<S>) {
        let Some(previous) = &mut self.previous else { return };
        let Unknowns { cells, surfaces, air } = previous;
        let kinds = [
            (&mut cells[..], &reached.cells[..], &start.cells[..]),
            (&mut *surfaces, &reached.surfaces, &start.surfaces),
            (&mut *air, &reached.air, &start.air),
        ];
        for (previous, reached, start) in kinds {
            for ((previous, &reached), &start) in previous.iter_mut().zip(reached).zip(start) {
                *previous += start - reached;
            }
        }
    }

    /// Guesses a stage at a node of a step of a length [s]: the straight line through the start of the step before and that of this one,
    /// or the start itself.
    #[inline(always)]
    pub(crate) fn first(
        &self,
        model: &Model<'_, S>,
        state: &State<S>,
        (node, length): (f64, f64),
        iterate: &mut Unknowns<S>,
    ) {
        // The same bits as without the ratio where lengths are equal.
        let ratio = if self.length > 0.0 { (length / self.length).min(LONGER) } else { 1.0 };
        match &self.previous {
            Some(previous) if node > 0.0 => {
                iterate.extrapolate(
                    model,
                    &[previous.view(), state.view()],
                    1.0 + node * ratio,
                    &state.memory,
                );
            }
            _ => iterate.copy_some(&model.parts.nonlinear_cells, &state.view()),
        }
    }
}

impl Guess<f64> {
    /// Writes all its numbers.
    pub(crate) fn write(&self, numbers: &mut Vec<f64>) {
        numbers.push(f64::from(u8::from(self.previous.is_some())));
        if let Some(previous) = &self.previous {
            previous.write(numbers);
        }
    }

    /// Reads the numbers of another one for the same plan, and gives those after them; none where these are no such numbers.
    pub(crate) fn read<'n>(&mut self, plan: &Plan, numbers: &'n [f64]) -> Option<&'n [f64]> {
        let (&some, rest) = numbers.split_first()?;
        self.length = 0.0;
        if some == 0.0 {
            self.previous = None;
            return Some(rest);
        }
        let mut previous = Unknowns::zero(plan.n_cells, plan.surfaces.len(), plan.zones.len());
        let rest = previous.read(rest)?;
        self.previous = Some(previous);
        Some(rest)
    }
}

impl<S: Real> Unknowns<S> {
    /// Airs, and some surfaces, as far from others as two known ones are from each other.
    #[inline(always)]
    pub(crate) fn shift(
        &mut self,
        surfaces: &[SideId],
        from: &Temperatures<'_, S>,
        known: &[Temperatures<'_, S>; 2],
    ) {
        let [start, end] = known;
        for (zone, air) in self.air.iter_mut().enumerate() {
            *air = from.air[zone] + (end.air[zone] - start.air[zone]);
        }
        for &surface in surfaces {
            self.surfaces[surface] =
                from.surfaces[surface] + (end.surfaces[surface] - start.surfaces[surface]);
        }
    }

    /// `from + ratio (to - from)` where something is linearised, without crossing a melting range.
    #[inline(always)]
    pub(crate) fn extrapolate(
        &mut self,
        model: &Model<'_, S>,
        [from, to]: &[Temperatures<'_, S>; 2],
        ratio: f64,
        memory: &[PcmHistory<S>],
    ) {
        for surfaces in &model.parts.linearised {
            let ends = from.surfaces.places(surfaces).iter().zip(to.surfaces.places(surfaces));
            for (guess, (&from, &to)) in self.surfaces.places_mut(surfaces).iter_mut().zip(ends) {
                *guess = line(from, to, ratio);
            }
        }
        for ((guess, &from), &to) in self.air.iter_mut().zip(from.air).zip(to.air) {
            *guess = line(from, to, ratio);
        }
        for cells in &model.parts.solid_cells {
            let ends = from.cells[cells.clone()].iter().zip(&to.cells[cells.clone()]);
            for (guess, (&from, &to)) in self.cells[cells.clone()].iter_mut().zip(ends) {
                *guess = line(from, to, ratio);
            }
        }
        for &w in &model.parts.melting_walls {
            let (numbers, cells) = (&model.coefficients.walls[w], model.cells(w));
            let ends = from.cells[cells.clone()].iter().zip(&to.cells[cells.clone()]);
            let laws = numbers.cells.iter().zip(&memory[cells.clone()]);
            for ((guess, (&from, &to)), (cell, memory)) in self.cells[cells].iter_mut().zip(ends).zip(laws) {
                *guess = line(from, to, ratio);
                if let Matter::Pcm(law) = cell.matter {
                    *guess = numbers.pcm[law].limit(to, *guess, memory);
                }
            }
        }
    }
}
