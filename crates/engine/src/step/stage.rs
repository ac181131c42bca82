//! A stage of a step: what it is solved for, and what it starts from.

use crate::building::model::Model;
use crate::linear::unknowns::{Unknowns, copy_ranges, line};
use crate::linear::wall::WallSystem;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::pcm::PcmHistory;
use crate::step::scheme::Tableau;
use crate::step::state::State;
use crate::weather::conditions::Conditions;

/// A stage to be solved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stage<'s, S: Real> {
    pub(crate) model: &'s Model<'s, S>,
    pub(crate) conditions: &'s Conditions<S>,
    /// State at the start of the step.
    pub(crate) state: &'s State<S>,
    /// Histories of the cells as the laws read them in this stage.
    pub(crate) histories: &'s [PcmHistory<S>],
    /// Of the scheme.
    pub(crate) tableau: &'static Tableau,
    /// Effective length [s].
    pub(crate) length: f64,
    /// Step, and stage counted from 1; both zero where no step is made.
    pub(crate) place: (usize, usize),
}

impl<S: Real> Stage<'_, S> {
    /// The stage, counted from 0.
    #[inline(always)]
    pub(crate) fn index(&self) -> usize {
        self.place.1.saturating_sub(1)
    }
}

/// What a stage starts from, and the loads that act in it.
#[derive(Debug, Clone)]
pub(crate) struct StageStart<S> {
    /// Enthalpies of the cells of nonlinear walls [J/m3].
    pub(crate) enthalpy: Vec<S>,
    /// Temperatures of the airs [degC].
    pub(crate) air: Vec<S>,
    /// Ideal load of each zone [W].
    pub(crate) load: Vec<S>,
    /// Heat `offset - slope T` that holds the air of each zone at a set point [W]; empty where nothing is held.
    pub(crate) holding: Vec<Line<S>>,
    /// Liquid fractions of the cells at the first stage of the step [-].
    pub(crate) first_fraction: Vec<S>,
}

impl<S: Real> StageStart<S> {
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let zeros = |n: usize| vec![S::zero(); n];
        let (cells, zones) = (model.plan.n_cells, model.plan.zones.len());
        Self {
            enthalpy: zeros(cells),
            air: zeros(zones),
            load: zeros(zones),
            holding: Vec::new(),
            first_fraction: zeros(cells),
        }
    }

    /// The first stage starts from the state.
    #[inline(always)]
    pub(crate) fn begin(&mut self, model: &Model<'_, S>, state: &State<S>) {
        copy_ranges(&model.parts.nonlinear_cells, &mut self.enthalpy, &state.enthalpy);
        self.air.copy_from_slice(&state.air);
    }

    /// The second stage starts from `H_n + ratio (H_stage - H_n)`.
    #[inline(always)]
    pub(crate) fn begin_second_stage(
        &mut self,
        model: &Model<'_, S>,
        state: &State<S>,
        ratio: f64,
        (walls, solution): (&[WallSystem<S>], &Unknowns<S>),
    ) {
        for &w in &model.parts.nonlinear_walls {
            let (wall, chain) = (&model.plan.walls[w], &walls[w]);
            for i in 0..wall.len() {
                let k = wall.first_cell + i;
                self.enthalpy[k] = line(state.enthalpy[k], chain.storage[i].at_solution(), ratio);
                self.first_fraction[k] = chain.liquid_fraction(i);
            }
        }
        for (zone, air) in self.air.iter_mut().enumerate() {
            *air = state.air[zone] + (solution.air[zone] - state.air[zone]).scale(ratio);
        }
    }
}
