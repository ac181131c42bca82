//! How surfaces and panes follow the ideal load of their zone, for the guess of the sweep after loads have changed.
//!
//! A few watts more move the surfaces of a zone by some thousandths of a kelvin in each stage: more than the tangents of their
//! laws leave out, so that one more sweep would be needed. How far each of them moves with the load of its own zone is learned
//! from the second sweep of a step and used in the next step. It is a guess: the solution does not depend on it.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Mask, Real};

/// Largest rise of a surface, over that of an air by its [`conductance`](super::augmented_lagrangian) alone [-]: what was learned where an
/// iteration had not yet converged may be anything.
const MOST: f64 = 2.0;

/// The change of a load between two sweeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<S: Real> {
    /// [W].
    pub(super) load: S,
    /// Lanes in which it is large enough to learn from.
    pub(super) is_informative: S::Mask,
    /// Conductance of the air of its zone, by its magnitude [W/K].
    pub(super) conductance: S,
}

impl<S: Real> Change<S> {
    /// No change.
    pub(super) fn none() -> Self {
        Self { load: S::zero(), is_informative: S::Mask::splat(false), conductance: S::one() }
    }

    /// A rise that was learned, after something has moved by this change [K].
    #[inline(always)]
    fn learned(&self, rise: S, moved: S) -> S {
        let found = moved / S::select(self.is_informative, self.load, S::one());
        let sound = self.is_informative & found.abs().lt(S::constant(f64::MAX));
        S::select(sound, found.max(S::zero()).min(S::constant(MOST) / self.conductance), rise)
    }
}

/// Rises of surfaces and panes with the load of their zone.
#[derive(Debug, Clone)]
pub(super) struct LoadSensitivity<S> {
    /// Surfaces whose laws are nonlinear and cells of panes, each with the number of its load.
    surfaces: Vec<(SideId, usize)>,
    cells: Vec<(usize, usize)>,
    /// By stage: rises of these surfaces, then of these cells [K/W].
    stages: Vec<Vec<S>>,
}

impl<S: Real> LoadSensitivity<S> {
    /// For the zones of all loads.
    pub(super) fn new(model: &Model<'_, S>, zones: &[usize], stages: usize) -> Self {
        let plan = model.plan;
        let mut load_of = vec![None; plan.zones.len()];
        for (load, &zone) in zones.iter().enumerate() {
            load_of[zone] = Some(load);
        }
        let of_surface = |surface: SideId| match plan.surfaces[surface].role {
            SideRole::Zone { zone, .. } => load_of[zone],
            SideRole::Exterior => None,
        };
        let near = |surface: SideId| of_surface(surface).or_else(|| of_surface(surface.opposite()));
        let linearised = model.parts.linearised.iter().cloned().flatten().map(SideId::from_index);
        let surfaces: Vec<_> = linearised.filter_map(|surface| Some((surface, near(surface)?))).collect();
        let of_window = |&w: &usize| Some((model.cells(w), near(SideId::inside(w))?));
        let cells: Vec<_> = plan
            .windows
            .iter()
            .filter_map(of_window)
            .flat_map(|(cells, load)| cells.map(move |cell| (cell, load)))
            .collect();
        let count = surfaces.len() + cells.len();
        Self { surfaces, cells, stages: vec![vec![S::zero(); count]; stages] }
    }

    /// Moves a solution by the changes of the loads since.
    #[inline(always)]
    pub(super) fn shift(&self, stage: usize, changes: &[Change<S>], solved: &mut Unknowns<S>) {
        let (surfaces, cells) = self.stages[stage].split_at(self.surfaces.len());
        for (&(surface, load), &rise) in self.surfaces.iter().zip(surfaces) {
            solved.surfaces[surface] += rise * changes[load].load;
        }
        for (&(cell, load), &rise) in self.cells.iter().zip(cells) {
            solved.cells[cell] += rise * changes[load].load;
        }
    }

    /// Learns from the solutions of a stage before and after loads changed.
    #[inline(always)]
    pub(super) fn learn(&mut self, stage: usize, changes: &[Change<S>], [old, new]: [&Unknowns<S>; 2]) {
        let (surfaces, cells) = self.stages[stage].split_at_mut(self.surfaces.len());
        for (&(surface, load), rise) in self.surfaces.iter().zip(surfaces) {
            *rise = changes[load].learned(*rise, new.surfaces[surface] - old.surfaces[surface]);
        }
        for (&(cell, load), rise) in self.cells.iter().zip(cells) {
            *rise = changes[load].learned(*rise, new.cells[cell] - old.cells[cell]);
        }
    }

    /// All rises, from which the next step goes on.
    pub(super) fn numbers(&self) -> Vec<S> {
        self.stages.concat()
    }

    /// Sets all rises.
    pub(super) fn set_numbers(&mut self, numbers: &[S]) {
        let count = self.surfaces.len() + self.cells.len();
        for (stage, numbers) in self.stages.iter_mut().zip(numbers.chunks(count.max(1))) {
            stage.copy_from_slice(numbers);
        }
    }
}
