//! The ideal loads of a building during one step: limits, state of the search, responses.

use core::ops::Range;

use crate::building::coefficients::ZoneCoefficients;
use crate::building::model::Model;
use crate::linear::building_system::BuildingSystem;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Mask, Real};
use crate::step::ideal_loads::responses::Response;

/// Airs closer to their set points than this count as on them [K].
const TOLERANCE: f64 = 1e-8;
/// Magnitude of the set point without heating or cooling, which is never reached [degC].
const NEVER: f64 = 1e6;

/// Limits of one ideal load over a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits<S> {
    /// Set points of heating and cooling [degC].
    pub(super) set_points: [S; 2],
    /// Largest heating and cooling [W].
    pub(super) most: [S; 2],
}

impl<S: Real> Limits<S> {
    /// Reads the set points at the end of a step.
    #[inline(always)]
    fn at(zone: &ZoneCoefficients<S>, row: &[f64]) -> Self {
        let nothing = [(S::constant(-NEVER), S::zero()), (S::constant(NEVER), S::zero())];
        let (heating, most_heating) =
            if let Some(ideal_load) = &zone.heating { ideal_load.at(row) } else { nothing[0] };
        let (cooling, most_cooling) =
            if let Some(ideal_load) = &zone.cooling { ideal_load.at(row) } else { nothing[1] };
        Self { set_points: [heating, cooling], most: [most_heating, most_cooling] }
    }
}

/// What the guess of the next step is made from.
#[derive(Debug, Clone)]
pub(crate) struct LoadHistory<S> {
    first: Option<Unknowns<S>>,
    outdoor: [S; 2],
    earlier: Vec<S>,
}

/// The ideal loads of a building and the search for them in one step.
#[derive(Debug, Clone)]
pub(crate) struct IdealLoads<S: Real> {
    /// Zone of each load.
    pub(super) zones: Vec<usize>,
    pub(super) limits: Vec<Limits<S>>,
    /// Response of the building to each load.
    pub(crate) responses: Vec<Response<S>>,
    /// Iterate about which each stage was last linearised, and its solution.
    iterates: Vec<Unknowns<S>>,
    solved: Vec<Unknowns<S>>,
    /// The first stage of the step before, and whether this step continues it.
    pub(super) first: Unknowns<S>,
    pub(super) continues: bool,
    /// Outdoor air at the ends of the last two steps [degC].
    pub(super) outdoor: [S; 2],
    /// Loads that the step before started from [W].
    earlier: Vec<S>,
    /// Lanes that have, or need, a load.
    pub(super) needed: S::Mask,
    /// Those of them whose responses are known.
    pub(super) responses_known: S::Mask,
    /// Change of each load [W].
    pub(super) correction: Vec<S>,
    pub(super) matrix: Vec<S>,
    pub(super) right: Vec<S>,
}

impl<S: Real> IdealLoads<S> {
    pub(crate) fn new(model: &Model<'_, S>, unknowns: &Unknowns<S>, stages: usize) -> Self {
        let (zones, rows) = (&model.plan.ideal_loads, model.plan.rows());
        let zeros = |n: usize| vec![S::zero(); n];
        let count = zones.len();
        let nothing = Limits { set_points: [S::zero(); 2], most: [S::zero(); 2] };
        let kept = if count == 0 { 0 } else { stages };
        Self {
            zones: zones.clone(),
            limits: vec![nothing; count],
            responses: vec![Response::new(unknowns, rows, stages); count],
            iterates: vec![unknowns.clone(); kept],
            solved: vec![unknowns.clone(); kept],
            first: unknowns.clone(),
            continues: false,
            outdoor: [S::zero(); 2],
            earlier: zeros(unknowns.air.len()),
            needed: S::Mask::splat(false),
            responses_known: S::Mask::splat(false),
            correction: zeros(count),
            matrix: zeros(count * count),
            right: zeros(count),
        }
    }

    /// Begins a step that ends with a forcing row. Loads change as in the step before, where this step `continues` it.
    #[inline(always)]
    pub(crate) fn begin(
        &mut self,
        zones: &[ZoneCoefficients<S>],
        row: &[f64],
        loads: &mut [S],
        continues: bool,
    ) {
        self.continues = continues;
        core::mem::swap(&mut self.first, &mut self.solved[0]);
        for (limits, &zone) in self.limits.iter_mut().zip(&self.zones) {
            *limits = Limits::at(&zones[zone], row);
            let (before, now) = (self.earlier[zone], loads[zone]);
            self.earlier[zone] = now;
            let next = if continues { now + now - before } else { now };
            // A guess never turns heating into cooling.
            let next = S::select(S::zero().lt(next * now), next, S::zero());
            loads[zone] = next.min(limits.most[0]).max(-limits.most[1]);
        }
    }

    /// Results of the last step, from which the next step is guessed.
    pub(crate) fn history(&self) -> LoadHistory<S> {
        LoadHistory {
            first: self.solved.first().cloned(),
            outdoor: self.outdoor,
            earlier: self.earlier.clone(),
        }
    }

    /// Sets the results of the last step.
    pub(crate) fn set_history(&mut self, history: &LoadHistory<S>) {
        if let (Some(solved), Some(first)) = (self.solved.first_mut(), &history.first) {
            solved.copy_from(first);
        }
        self.outdoor = history.outdoor;
        self.earlier.clone_from(&history.earlier);
    }

    /// Marks the lanes that start with a load, or whose air is expected outside its set points.
    #[inline(always)]
    pub(crate) fn mark_needed(&mut self, loads: &[S], air: impl Fn(usize) -> S) {
        self.responses_known = S::Mask::splat(false);
        self.needed = !self.within_set_points(air);
        for &zone in &self.zones {
            self.needed = self.needed | S::zero().lt(loads[zone].abs());
        }
    }

    /// Whether some active lane needs a load.
    #[inline(always)]
    pub(super) fn any_needed(&self, active: S::Mask) -> bool {
        (self.needed & active).any()
    }

    /// Whether a sweep finds the responses: the second uses those of the first, which are close enough.
    #[inline(always)]
    pub(crate) fn finds_responses(&mut self, sweep: usize, active: S::Mask) -> bool {
        let finds = sweep != 1 && self.any_needed(active);
        if finds {
            self.responses_known = self.needed;
        }
        finds
    }

    /// Keeps the iterate about which a stage was linearised (by exchange, the other is overwritten later) and its solution.
    #[inline(always)]
    pub(super) fn keep(&mut self, stage: usize, iterate: &mut Unknowns<S>, solved: &Unknowns<S>) {
        core::mem::swap(&mut self.iterates[stage], iterate);
        self.solved[stage].copy_from(solved);
    }

    /// The iterate of a stage, and its solution corrected by the changes of the loads since; only some cells are corrected.
    #[inline(always)]
    pub(super) fn guess(
        &mut self,
        stage: usize,
        cells: &[Range<usize>],
        iterate: &mut Unknowns<S>,
        solved: &mut Unknowns<S>,
    ) {
        core::mem::swap(iterate, &mut self.iterates[stage]);
        solved.copy_some(cells, &self.solved[stage].view());
        for (response, &change) in self.responses.iter().zip(&self.correction) {
            let rises = &response.stages[stage];
            let shift = |values: &mut [S], rises: &[S]| {
                for (value, &rise) in values.iter_mut().zip(rises) {
                    *value += rise * change;
                }
            };
            shift(&mut solved.surfaces, &rises.surfaces);
            shift(&mut solved.air, &rises.air);
            for cells in cells {
                shift(&mut solved.cells[cells.clone()], &rises.cells[cells.clone()]);
            }
        }
    }

    /// True where every air lies between its set points.
    #[inline(always)]
    pub(super) fn within_set_points(&self, air: impl Fn(usize) -> S) -> S::Mask {
        let slack = S::constant(TOLERANCE);
        let mut within = S::Mask::splat(true);
        for (limits, &zone) in self.limits.iter().zip(&self.zones) {
            let [heat, cool] = limits.set_points;
            let cold = air(zone).lt(heat - slack) & S::zero().lt(limits.most[0]);
            let hot = (cool + slack).lt(air(zone)) & S::zero().lt(limits.most[1]);
            within = within & !(cold | hot);
        }
        within
    }

    /// Response of the air of load `p` at the end of the step to load `q` [K/W].
    #[inline(always)]
    pub(super) fn gain(&self, p: usize, q: usize) -> S {
        let stages = &self.responses[q].stages;
        stages[stages.len() - 1].air[self.zones[p]]
    }

    /// Zone whose load changes most in a lane, and by how much its air would change [K].
    pub(super) fn worst(&self, lane: usize) -> (usize, f64) {
        let moved = |p: usize| (self.correction[p] * self.gain(p, p)).lane(lane).abs();
        let worst = (0..self.zones.len()).max_by(|&a, &b| moved(a).total_cmp(&moved(b))).unwrap_or(0);
        (self.zones[worst], moved(worst))
    }

    /// Response of the stage just solved to a watt of each load.
    #[inline(always)]
    pub(super) fn respond(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        stage: usize,
        length_and_ratio: (f64, f64),
    ) {
        for (response, &zone) in self.responses.iter_mut().zip(&self.zones) {
            response.find(model, system, zone, stage, length_and_ratio);
        }
    }

    /// Response of the airs at the end of the step to a watt of each load in the last stage only.
    #[inline(always)]
    pub(super) fn respond_last(&mut self, model: &Model<'_, S>, system: &BuildingSystem<'_, S>) {
        for (response, &zone) in self.responses.iter_mut().zip(&self.zones) {
            response.find_last(model, system, zone);
        }
    }
}
