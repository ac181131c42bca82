//! Reverse derivatives: a run that can be gone back along, from weights on its records to the slopes by all parameters.
//!
//! The run keeps the states between its steps and the solutions of their stages. On the way back each step is made once
//! more with numbers that remember what they were made of, along its solution; the weights of the state
//! after it become those of the state before it and of the coefficients. What the coefficients were made of stays on the
//! tape from the start to the end. Where all of this would take too much memory, only every n-th state is kept and the
//! steps between are run again.

use crate::balance::ledger::Ledger;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::linear::unknowns::Unknowns;
use crate::number::tape::{Tape, Taped};
use crate::run::Action;
use crate::run::control::RunControl;
use crate::run::march::{Run, march_observed};
use crate::run::options::Options;
use crate::step::Stepper;
use crate::step::history::History;
use crate::step::stage_solutions::{Solution, read_solution};
use crate::step::state::State;
use crate::weather::conditions::Weather;

use super::along::StepperAlong;

/// A run, and what is needed to go back along it.
#[derive(Debug)]
pub struct Trajectory {
    /// The run.
    pub run: Run<f64>,
    /// Everything that was done to the state.
    moves: Vec<Action>,
    /// What the stretches that are run again start from.
    starts: Vec<Start>,
    /// Actions in each of them.
    length: usize,
    /// What follows them.
    last: Stretch,
}

/// What a stretch starts from.
#[derive(Debug)]
struct Start {
    state: State<f64>,
    /// What its first step is guessed from: with it the stretch made again has the same bits.
    history: History<f64>,
}

/// Actions in a row, each with the numbers of the state before it and of its solution.
#[derive(Debug, Default)]
struct Stretch {
    states: Vec<f64>,
    solutions: Vec<f64>,
    /// Where the numbers of each solution end; it has none where it is not known.
    ends: Vec<usize>,
}

impl Stretch {
    /// Adds a move that a stepper has made, from the state before it to one with these loads.
    fn push(&mut self, before: &State<f64>, stepper: &Stepper<'_, f64>, load: &[f64]) {
        before.write(&mut self.states);
        if let Some(solution) = stepper.known.solution(load) {
            solution.write(&stepper.model.parts.nonlinear_cells, &mut self.solutions);
        }
        self.ends.push(self.solutions.len());
    }

    /// The moves from the last to the first: numbers of the states before them and of their solutions.
    fn back(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        let size = self.states.len() / self.ends.len().max(1);
        (0..self.ends.len()).rev().map(move |k| {
            let first = k.checked_sub(1).map_or(0, |before| self.ends[before]);
            (&self.states[k * size..(k + 1) * size], &self.solutions[first..self.ends[k]])
        })
    }
}

impl Trajectory {
    /// Runs a plan, keeping about as many bytes as given.
    ///
    /// # Errors
    /// As [`march`](crate::run::march::march).
    pub fn new(
        plan: &Plan,
        numbers: &[f64],
        forcing: &Forcing<'_>,
        options: &Options,
        watch: &RunControl,
        bytes: usize,
    ) -> Result<Self, EngineError> {
        options.check(plan, numbers.len(), forcing)?;
        let weather = Weather::new(plan, forcing);
        let mut stepper = Stepper::new(plan, numbers, options.scheme);
        stepper.known.start();
        let mut before = stepper.begin(&options.initial);
        let mut start = Start { state: before.clone(), history: stepper.history() };
        let mut next = start.history.clone();
        let length = stretch(&before, weather.steps(), options, bytes);
        let (mut moves, mut starts, mut last) = (Vec::new(), Vec::new(), Stretch::default());
        last.states.reserve(before.count() * length.min(weather.steps() + 1));
        let run = march_observed(stepper, &weather, options, watch, |stepper, reached, made| {
            if last.ends.len() == length {
                let follows = Start { state: before.clone(), history: next.clone() };
                starts.push(core::mem::replace(&mut start, follows));
                last = Stretch::default();
            }
            moves.push(made);
            last.push(&before, stepper, &reached.load);
            before.copy_from(reached);
            if last.ends.len() == length {
                next = stepper.history();
            }
            Ok(())
        })?;
        Ok(Self { run, moves, starts, length, last })
    }

    /// Slopes by all parameters of the sum of weights (rows x probes) times records.
    ///
    /// # Errors
    /// [`EngineError::Input`] when the weights or numbers do not fit, [`EngineError::Interrupted`].
    pub fn pull(
        &self,
        plan: &Plan,
        numbers: &[f64],
        forcing: &Forcing<'_>,
        options: &Options,
        watch: &RunControl,
        weights: &[f64],
    ) -> Result<Vec<f64>, EngineError> {
        options.check(plan, numbers.len(), forcing)?;
        if weights.len() != self.run.records.len() {
            let (found, expected) = (weights.len(), self.run.records.len());
            return Err(EngineError::Input(format!("{found} weights on records, expected {expected}")));
        }
        let weather = Weather::new(plan, forcing);
        // Dropped last: its end releases the tape, also after an error.
        let _recording = Tape::record();
        let leaves: Vec<_> = numbers.iter().map(|&number| Taped::variable(number)).collect();
        let mut back = Back::new(plan, &leaves, &weather, options, weights);
        let first_of_last = self.starts.len() * self.length;
        back.over(&self.moves[first_of_last..], &self.last, watch)?;
        for (k, start) in self.starts.iter().enumerate().rev() {
            let moves = &self.moves[k * self.length..(k + 1) * self.length];
            let again = again(plan, numbers, &weather, options, start, moves)?;
            back.over(moves, &again, watch)?;
        }
        Ok(back.finish(&leaves))
    }
}

/// Actions between two kept states: all of them where they fit into the bytes.
fn stretch(state: &State<f64>, steps: usize, options: &Options, bytes: usize) -> usize {
    // A state and the solutions of its stages, which are never larger.
    let each = state.count() * size_of::<f64>() * (1 + options.scheme.weights().len());
    let repeated = options.warmup.map_or(0, |warmup| warmup.steps * warmup.max_cycles);
    let all = repeated + 1 + steps;
    let fit = (bytes / each).max(1);
    // As many kept states as states between two of them take the least room.
    if all <= fit { all } else { fit.min(all.isqrt() + 1) }
}

/// Makes moves again, keeping what is needed to go back along them.
fn again(
    plan: &Plan,
    numbers: &[f64],
    weather: &Weather<'_>,
    options: &Options,
    start: &Start,
    moves: &[Action],
) -> Result<Stretch, EngineError> {
    let mut stepper = Stepper::new(plan, numbers, options.scheme);
    stepper.known.start();
    stepper.set_history(&start.history);
    let (mut before, mut state, mut unused) = (start.state.clone(), start.state.clone(), Ledger::new());
    let mut made = Stretch::default();
    for step in moves {
        before.copy_from(&state);
        step.take(&mut stepper, &mut state, weather, options.dt, &mut unused)?;
        made.push(&before, &stepper, &state.load);
    }
    Ok(made)
}

/// The way back.
struct Back<'a> {
    /// With the coefficients on the tape.
    fresh: StepperAlong<'a, Taped>,
    stepper: StepperAlong<'a, Taped>,
    weather: &'a Weather<'a>,
    options: &'a Options,
    /// Weights on the records.
    records: &'a [f64],
    /// Entries of the tape that stay, and the first of them that stands for a number of the state before a move.
    base: usize,
    first: u32,
    /// Weights on the entries of the tape.
    weights: Vec<f64>,
    /// Weights on the state.
    state: Vec<f64>,
    /// The state before the step in hand, then after it.
    now: State<Taped>,
    /// Its solution.
    stages: Vec<Unknowns<f64>>,
    load: Vec<f64>,
}

impl<'a> Back<'a> {
    fn new(
        plan: &'a Plan,
        leaves: &'a [Taped],
        weather: &'a Weather<'a>,
        options: &'a Options,
        records: &'a [f64],
    ) -> Self {
        let fresh = StepperAlong::new(plan, leaves, options.scheme);
        let (stepper, made) = (fresh.clone(), Tape::len());
        let now = fresh.stepper.begin(&options.initial);
        Tape::truncate(made);
        let state = vec![0.0; now.count()];
        let first = Tape::reserve(state.len());
        let plain = |unknowns: &Unknowns<Taped>| unknowns.plain();
        Self {
            stages: fresh.stepper.places().iter().map(plain).collect(),
            load: vec![0.0; plan.zones.len()],
            fresh,
            stepper,
            weather,
            options,
            records,
            base: Tape::len(),
            first,
            weights: Vec::new(),
            state,
            now,
        }
    }

    /// Goes back over a stretch.
    fn over(&mut self, moves: &[Action], stretch: &Stretch, watch: &RunControl) -> Result<(), EngineError> {
        for (&made, (before, solution)) in moves.iter().rev().zip(stretch.back()) {
            if watch.stop.load(core::sync::atomic::Ordering::Relaxed) {
                return Err(EngineError::Interrupted);
            }
            self.pass(made, before, solution)?;
        }
        Ok(())
    }

    /// Goes back over a move: its weights on the state before it take the place of those on the state after it.
    fn pass(&mut self, made: Action, before: &[f64], solution: &[f64]) -> Result<(), EngineError> {
        Tape::truncate(self.base);
        let (along, state) = (&mut self.stepper, &mut self.now);
        let mut place = self.first;
        state.read(before, |number, value| {
            *number = Taped::new(value, place);
            place += 1;
        });
        let cells = &along.stepper.model.parts.nonlinear_cells;
        let known = read_solution(solution, cells, &mut self.stages, &mut self.load);
        let solution = known.then_some(Solution { stages: &self.stages, load: &self.load });
        along.stepper.forget();
        along.take(made, state, self.weather, self.options.dt, solution)?;
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        state.beside(&self.state, |number, weight| number.add_weight(weight, weights));
        if let Some(row) = made.row(self.options) {
            let probes = &self.options.probes;
            for (probe, weight) in probes.iter().zip(&self.records[row * probes.len()..]) {
                let record = probe.read(along.stepper.model.plan, &along.stepper, state);
                self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
                record.add_weight(*weight, &mut self.weights);
            }
        }
        Tape::propagate(&mut self.weights, self.base, |stage, weights| {
            along.solve_transposed(stage, weights);
        });
        let passed = &mut self.weights[self.base - self.state.len()..self.base];
        self.state.copy_from_slice(passed);
        passed.fill(0.0);
        if !known {
            // It has made factors that are about to be cut off.
            self.stepper = self.fresh.clone();
        }
        Ok(())
    }

    /// Weights on the parameters.
    fn finish(mut self, leaves: &[Taped]) -> Vec<f64> {
        Tape::truncate(self.base);
        let start = self.fresh.stepper.begin(&self.options.initial);
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        start.beside(&self.state, |number, weight| number.add_weight(weight, weights));
        Tape::propagate(&mut self.weights, leaves.len() + 1, |_, _| {});
        self.weights[1..=leaves.len()].to_vec()
    }
}
