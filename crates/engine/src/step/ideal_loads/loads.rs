//! The ideal loads of a building during one step: state of the search, responses.

use core::ops::Range;

use crate::building::coefficients::ZoneCoefficients;
use crate::building::model::Model;
use crate::linear::building_system::BuildingSystem;
use crate::linear::unknowns::{Temperatures, Unknowns};
use crate::number::line::Line;
use crate::number::real::{Mask, Real};
use crate::step::ideal_loads::augmented_lagrangian::ZoneLoadSolver;
use crate::step::ideal_loads::limits::Limits;
use crate::step::ideal_loads::load_sensitivities::{Change, LoadSensitivity};
use crate::step::ideal_loads::responses::Response;
use crate::step::scheme::Tableau;
use crate::step::state::blend;

/// What the guess of the next step is made from.
#[derive(Debug, Clone)]
pub(crate) struct LoadHistory<S> {
    first: Option<Unknowns<S>>,
    outdoor: [S; 2],
    earlier: Vec<S>,
    slopes: Vec<S>,
    load_sensitivities: Vec<S>,
}

impl<S: Real> LoadHistory<S> {
    /// Copies the lanes of another one where the mask is true.
    pub(crate) fn take(&mut self, mask: S::Mask, other: &Self) {
        if let (Some(mine), Some(theirs)) = (&mut self.first, &other.first) {
            mine.take(mask, theirs);
        }
        blend(mask, &mut self.outdoor, &other.outdoor);
        blend(mask, &mut self.earlier, &other.earlier);
        blend(mask, &mut self.slopes, &other.slopes);
        blend(mask, &mut self.load_sensitivities, &other.load_sensitivities);
    }
}

impl LoadHistory<f64> {
    /// Writes all its numbers.
    pub(crate) fn write(&self, numbers: &mut Vec<f64>) {
        if let Some(first) = &self.first {
            first.write(numbers);
        }
        for values in [&self.outdoor[..], &self.earlier, &self.slopes, &self.load_sensitivities] {
            numbers.extend_from_slice(values);
        }
    }

    /// Reads the numbers of another one of the same building, and gives those after them; none where there are too few.
    pub(crate) fn read<'n>(&mut self, mut numbers: &'n [f64]) -> Option<&'n [f64]> {
        if let Some(first) = &mut self.first {
            numbers = first.read(numbers)?;
        }
        for values in
            [&mut self.outdoor[..], &mut self.earlier, &mut self.slopes, &mut self.load_sensitivities]
        {
            let (own, rest) = numbers.split_at_checked(values.len())?;
            values.copy_from_slice(own);
            numbers = rest;
        }
        Some(numbers)
    }
}

/// The ideal loads of a building and the search for them in one step.
#[derive(Debug, Clone)]
pub(crate) struct IdealLoads<S: Real> {
    /// Zone of each load.
    pub(super) zones: Vec<usize>,
    /// A load is found when correcting it would change the air by less than this [K]: the last stage supplies so little.
    pub(super) close: f64,
    pub(super) limits: Vec<Limits<S>>,
    /// What the set points of each zone hold [degC]; empty where that is the air everywhere.
    pub(super) controlled: Vec<S>,
    /// Response of the building to each load, where there are few.
    pub(super) responses: Vec<Response<S>>,
    /// The airs that the last stage holds, where there are many.
    pub(super) held: Option<ZoneLoadSolver<S>>,
    /// There: how surfaces follow the loads, and the changes of the loads after the last sweep.
    load_sensitivities: Option<LoadSensitivity<S>>,
    changes: Vec<Change<S>>,
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
    pub(crate) fn new(model: &Model<'_, S>, unknowns: &Unknowns<S>, tableau: &Tableau) -> Self {
        let (zones, rows) = (&model.plan.ideal_loads, model.plan.rows());
        let zeros = |n: usize| vec![S::zero(); n];
        let (count, stages, close) = (zones.len(), tableau.weights.len(), tableau.tolerance.load.of::<S>());
        let nothing = Limits { set_points: [S::zero(); 2], most: [S::zero(); 2] };
        let kept = if count == 0 { 0 } else { stages };
        // Numbers with derivatives take the responses: slopes of loads follow from them without iteration.
        // Airs are held by heat to them; loads that are partly radiated need the responses as well.
        let direct = S::DERIVATIVES || model.loads_by_responses();
        let few = if direct { count } else { 0 };
        let operative = model.holds_operative();
        Self {
            zones: zones.clone(),
            close,
            limits: vec![nothing; count],
            controlled: zeros(if operative { unknowns.air.len() } else { 0 }),
            responses: vec![Response::new(unknowns, rows, stages, operative); few],
            held: (!direct).then(|| ZoneLoadSolver::new(count, rows, close)),
            load_sensitivities: (!direct && count > 0).then(|| LoadSensitivity::new(model, zones, stages)),
            changes: vec![Change::none(); if direct { 0 } else { count }],
            iterates: vec![unknowns.clone(); kept],
            solved: vec![unknowns.clone(); kept],
            first: unknowns.clone(),
            continues: false,
            outdoor: [S::zero(); 2],
            earlier: zeros(unknowns.air.len()),
            needed: S::Mask::splat(false),
            responses_known: S::Mask::splat(false),
            correction: zeros(count),
            matrix: zeros(few * few),
            right: zeros(few),
        }
    }

    /// Begins a step that ends with a forcing row. Loads change as in the step before, where this step `continues` it.
    #[inline(always)]
    pub(super) fn begin(
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
            slopes: self.held.as_ref().map(ZoneLoadSolver::slopes).unwrap_or_default(),
            load_sensitivities: self
                .load_sensitivities
                .as_ref()
                .map(LoadSensitivity::numbers)
                .unwrap_or_default(),
        }
    }

    /// Sets the results of the last step.
    pub(crate) fn set_history(&mut self, history: &LoadHistory<S>) {
        if let (Some(solved), Some(first)) = (self.solved.first_mut(), &history.first) {
            solved.copy_from(first);
        }
        self.outdoor = history.outdoor;
        self.earlier.clone_from(&history.earlier);
        if let Some(held) = &mut self.held {
            held.set_slopes(&history.slopes);
        }
        if let Some(load_sensitivities) = &mut self.load_sensitivities {
            load_sensitivities.set_numbers(&history.load_sensitivities);
        }
    }

    /// Marks the lanes that start with a load, or whose air is expected outside its set points.
    #[inline(always)]
    pub(super) fn mark_needed(&mut self, loads: &[S], air: impl Fn(usize) -> S) {
        self.responses_known = S::Mask::splat(false);
        self.needed = !self.within_set_points(air);
        for &zone in &self.zones {
            self.needed = self.needed | S::zero().lt(loads[zone].abs());
        }
    }

    /// Whether some active lane needs a load.
    #[inline(always)]
    pub(super) fn any_needed(&self, active: S::Mask) -> bool {
        self.held.as_ref().map_or_else(|| (self.needed & active).any(), |held| held.any(active))
    }

    /// Begins to hold airs, where loads are found so: in a step that ends with a forcing row, with stages of a length [s],
    /// guessed loads, and airs that are expected without them.
    #[inline(always)]
    pub(super) fn begin_holding(
        &mut self,
        model: &Model<'_, S>,
        row: &[f64],
        length_and_ratio: (f64, f64),
        loads: &[S],
        expected: impl Fn(usize) -> S,
    ) {
        if let Some(held) = &mut self.held {
            let of_zones = (&self.limits[..], &self.zones[..]);
            held.begin(model, row, length_and_ratio, of_zones, (loads, expected));
        }
    }

    /// Writes what holds the airs in a stage: in the last one, where loads are found so, else nothing.
    #[inline(always)]
    pub(super) fn hold(&self, last: bool, holding: &mut Vec<Line<S>>) {
        holding.clear();
        if let (true, Some(held)) = (last, &self.held) {
            holding.resize(self.earlier.len(), Line::zero());
            held.write(&self.zones, holding);
        }
    }

    /// Whether a sweep finds the responses: the second uses those of the first, which are close enough.
    #[inline(always)]
    pub(super) fn finds_responses(&mut self, sweep: usize, active: S::Mask) -> bool {
        let finds = self.held.is_none() && sweep != 1 && self.any_needed(active);
        if finds {
            self.responses_known = self.needed;
        }
        finds
    }

    /// The solution of the first stage of the step.
    #[inline(always)]
    pub(crate) fn first_stage(&self) -> Temperatures<'_, S> {
        self.solved[0].view()
    }

    /// Keeps the iterate about which a stage was linearised (by exchange, the other is overwritten later) and its solution, of cells
    /// only some.
    #[inline(always)]
    pub(super) fn keep(
        &mut self,
        stage: usize,
        cells: &[Range<usize>],
        iterate: &mut Unknowns<S>,
        solved: &Unknowns<S>,
    ) {
        core::mem::swap(&mut self.iterates[stage], iterate);
        self.solved[stage].copy_some(cells, &solved.view());
    }

    /// Begins a sweep after another one, in active lanes: notes how the loads were changed in between.
    #[inline(always)]
    pub(super) fn begin_again(&mut self, active: S::Mask) {
        if let Some(held) = &self.held {
            held.write_changes(active, &mut self.changes);
        }
    }

    /// Learns from the second solution of a stage how surfaces follow the loads.
    #[inline(always)]
    pub(super) fn learn(&mut self, stage: usize, solved: &Unknowns<S>) {
        if let Some(load_sensitivities) = &mut self.load_sensitivities {
            load_sensitivities.learn(stage, &self.changes, [&self.solved[stage], solved]);
        }
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
        if let (Some(held), 0) = (&self.held, stage) {
            for (p, &zone) in self.zones.iter().enumerate() {
                solved.air[zone] += held.first_rise(p);
            }
        }
        if let Some(load_sensitivities) = &self.load_sensitivities {
            load_sensitivities.shift(stage, &self.changes, solved);
        }
        for (response, &change) in self.responses.iter().zip(&self.correction) {
            let load_sensitivities = &response.stages[stage];
            let shift = |values: &mut [S], load_sensitivities: &[S]| {
                for (value, &rise) in values.iter_mut().zip(load_sensitivities) {
                    *value += rise * change;
                }
            };
            shift(&mut solved.surfaces, &load_sensitivities.surfaces);
            shift(&mut solved.air, &load_sensitivities.air);
            for cells in cells {
                shift(&mut solved.cells[cells.clone()], &load_sensitivities.cells[cells.clone()]);
            }
        }
    }

    /// True where every air lies between its set points.
    #[inline(always)]
    pub(super) fn within_set_points(&self, air: impl Fn(usize) -> S) -> S::Mask {
        let mut within = S::Mask::splat(true);
        for (limits, &zone) in self.limits.iter().zip(&self.zones) {
            let [cold, hot] = limits.asks(air(zone));
            within = within & !(cold | hot);
        }
        within
    }

    /// Response of what the set points of load `p` hold at the end of the step to load `q` [K/W].
    #[inline(always)]
    pub(super) fn gain(&self, p: usize, q: usize) -> S {
        self.responses[q].gain(self.zones[p])
    }

    /// Reads what the set points hold, where that is not the air everywhere, at temperatures and loads [W].
    #[inline(always)]
    pub(super) fn read_controlled(&mut self, model: &Model<'_, S>, at: &Temperatures<'_, S>, loads: &[S]) {
        for (zone, temperature) in self.controlled.iter_mut().enumerate() {
            *temperature = model.held_temperature(zone, (at.surfaces, at.air[zone]), loads[zone]);
        }
    }

    /// Zone whose load changes most in a lane, and by how much its air would change [K].
    pub(super) fn worst(&self, lane: usize) -> (usize, f64) {
        let moved = |p: usize| match &self.held {
            Some(held) => held.distance(p).lane(lane).abs(),
            None => (self.correction[p] * self.gain(p, p)).lane(lane).abs(),
        };
        let worst = (0..self.zones.len()).max_by(|&a, &b| moved(a).total_cmp(&moved(b))).unwrap_or(0);
        (self.zones[worst], moved(worst))
    }

    /// Response of the stage just solved to a watt of each load.
    #[inline(always)]
    pub(super) fn respond(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        (stage, loads): (usize, &[S]),
        length_and_ratio: (f64, f64),
    ) {
        for (response, &zone) in self.responses.iter_mut().zip(&self.zones) {
            response.find(model, system, (zone, loads[zone]), stage, length_and_ratio);
        }
    }

    /// Corrects the solution of the coupled system of the last stage by the loads that are missing there.
    #[inline(always)]
    pub(super) fn complete(
        &mut self,
        model: &Model<'_, S>,
        system: &mut BuildingSystem<'_, S>,
        air: &[S],
        loads: &[S],
    ) {
        if let Some(held) = &mut self.held {
            held.complete(model, system, (&self.zones, air), &mut self.correction);
            return;
        }
        self.respond_last(model, system, loads);
        let controlled = core::mem::take(&mut self.controlled);
        let held = if controlled.is_empty() { air } else { &controlled };
        self.complete_by_responses(held, loads, &mut system.coupled.right);
        self.controlled = controlled;
    }

    /// Adds the heat that still holds the airs at the end to the corrections: some millionth.
    #[inline(always)]
    pub(super) fn add_held(&mut self, air: &[S]) {
        if let Some(held) = &self.held {
            for (p, (&zone, correction)) in self.zones.iter().zip(&mut self.correction).enumerate() {
                *correction += held.missing(p, air[zone]);
            }
        }
    }

    /// Heat that holds the airs at temperatures in the last stage, by zone: what their loads lack there [W].
    pub(super) fn holding_heat<'h>(&'h self, air: &'h [S]) -> impl Iterator<Item = (usize, S)> + 'h {
        let of_load = move |held: &'h ZoneLoadSolver<S>| {
            self.zones.iter().enumerate().map(move |(p, &zone)| (zone, held.missing(p, air[zone])))
        };
        self.held.iter().flat_map(of_load)
    }

    /// Gives loads the heat that they lacked after sweep `number`, where airs are held, in the first stage just solved.
    /// True where loads change.
    #[inline(always)]
    pub(super) fn supply(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        number: usize,
        loads: &mut [S],
    ) -> bool {
        self.held.as_mut().is_some_and(|held| held.supply(model, system, (number, &self.zones), loads))
    }

    /// Response of the airs at the end of the step to a watt of each load in the last stage only.
    #[inline(always)]
    fn respond_last(&mut self, model: &Model<'_, S>, system: &BuildingSystem<'_, S>, loads: &[S]) {
        for (response, &zone) in self.responses.iter_mut().zip(&self.zones) {
            response.find_last(model, system, (zone, loads[zone]));
        }
    }
}
