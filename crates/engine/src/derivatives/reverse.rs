//! Reverse derivatives: from weights on the records of a run to the slopes of their weighted sum by all parameters.
//!
//! The run keeps the states between its steps and the solutions of their stages. The reverse pass takes the steps from the
//! last to the first. Each step is computed once more at its known solution, with numbers that record their operations on a
//! tape; from the weights on the state after the step follow those on the state before it and on the coefficients. The
//! operations from parameters to coefficients stay on the tape during the whole pass. Where all states would take too much
//! memory, only every n-th state is kept and the steps between are run again.

use crate::balance::ledger::Ledger;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::linear::unknowns::Unknowns;
use crate::number::tape::{Tape, Taped};
use crate::run::Action;
use crate::run::march::{Run, march_observed};
use crate::run::options::Options;
use crate::run::outputs::Output;
use crate::step::Stepper;
use crate::step::control::RunControl;
use crate::step::halving::Part;
use crate::step::history::History;
use crate::step::stage_solutions::StageSolutions;
use crate::step::state::State;
use crate::weather::conditions::Weather;

use super::known_steps::DerivativeStepper;

/// A run, and what its reverse pass needs.
#[derive(Debug)]
pub struct Trajectory {
    /// The run.
    pub run: Run<f64>,
    /// All actions of the run.
    actions: Vec<Action>,
    /// Starts of the stretches that are run again.
    starts: Vec<Start>,
    /// Number of actions in each of these stretches.
    length: usize,
    /// The last stretch, which is kept.
    last: Stretch,
}

/// Start of a stretch.
#[derive(Debug)]
struct Start {
    state: State<f64>,
    /// Results from which its first step is guessed: with them the stretch that is run again has the same bits.
    history: History<f64>,
}

/// Successive actions: the numbers of the state before each of them, and of its solution.
#[derive(Debug, Default)]
struct Stretch {
    states: Vec<f64>,
    /// Parts of the steps, and the numbers of their solutions.
    parts: Vec<Part>,
    solutions: Vec<f64>,
    /// Where the parts of each action end, and their numbers.
    ends: Vec<[usize; 2]>,
}

impl Stretch {
    /// Adds an action that a stepper has taken, from the state before it.
    fn push(&mut self, before: &State<f64>, stepper: &Stepper<'_, f64>) {
        before.write(&mut self.states);
        let cells = &stepper.model.parts.nonlinear_cells;
        stepper.known.write(cells, (&mut self.parts, &mut self.solutions));
        self.ends.push([self.parts.len(), self.solutions.len()]);
    }

    /// The actions from the last to the first: numbers of the state before each, parts and numbers of its solution.
    fn reversed(&self) -> impl Iterator<Item = (&[f64], (&[Part], &[f64]))> {
        let size = self.states.len() / self.ends.len().max(1);
        (0..self.ends.len()).rev().map(move |k| {
            let [part, number] = k.checked_sub(1).map_or([0; 2], |before| self.ends[before]);
            let [last_part, last_number] = self.ends[k];
            let solution = (&self.parts[part..last_part], &self.solutions[number..last_number]);
            (&self.states[k * size..(k + 1) * size], solution)
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
        let mut stepper = Stepper::new(plan, numbers, options.scheme.converged());
        stepper.known.start();
        let mut before = stepper.begin(&options.initial);
        let mut start = Start { state: before.clone(), history: stepper.history() };
        let mut next = start.history.clone();
        let length = stretch(&before, weather.steps(), options, bytes);
        let (mut actions, mut starts, mut last) = (Vec::new(), Vec::new(), Stretch::default());
        last.states.reserve(before.count() * length.min(weather.steps() + 1));
        let run = march_observed(stepper, &weather, options, watch, |stepper, reached, action| {
            if last.ends.len() == length {
                let follows = Start { state: before.clone(), history: next.clone() };
                starts.push(core::mem::replace(&mut start, follows));
                last = Stretch::default();
            }
            actions.push(action);
            last.push(&before, stepper);
            before.copy_from(reached);
            if last.ends.len() == length {
                next = stepper.history();
            }
            Ok(())
        })?;
        Ok(Self { run, actions, starts, length, last })
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
        let mut pass = ReversePass::new(plan, &leaves, &weather, options, (&self.run.state, weights));
        let first_of_last = self.starts.len() * self.length;
        pass.over(&self.actions[first_of_last..], &self.last, watch)?;
        for (k, start) in self.starts.iter().enumerate().rev() {
            let actions = &self.actions[k * self.length..(k + 1) * self.length];
            let stretch = run_again(plan, numbers, &weather, options, start, actions)?;
            pass.over(actions, &stretch, watch)?;
        }
        Ok(pass.finish(&leaves))
    }
}

/// Actions between two kept states: all of them where they fit into the bytes.
fn stretch(state: &State<f64>, steps: usize, options: &Options, bytes: usize) -> usize {
    // A state and the solutions of its stages, which are never larger.
    let each = state.count() * size_of::<f64>() * (1 + options.scheme.weights().len());
    let repeated = options.warmup.map_or(0, |warmup| warmup.steps * warmup.max_cycles);
    let all = repeated + 1 + steps;
    let fit = (bytes / each).max(1);
    // The least memory is taken with as many kept states as there are states between two of them.
    if all <= fit { all } else { fit.min(all.isqrt() + 1) }
}

/// Runs a stretch again and keeps its states and solutions.
fn run_again(
    plan: &Plan,
    numbers: &[f64],
    weather: &Weather<'_>,
    options: &Options,
    start: &Start,
    actions: &[Action],
) -> Result<Stretch, EngineError> {
    let mut stepper = Stepper::new(plan, numbers, options.scheme.converged());
    stepper.known.start();
    stepper.set_history(&start.history);
    let (mut before, mut state, mut unused) = (start.state.clone(), start.state.clone(), Ledger::new());
    let mut stretch = Stretch::default();
    for action in actions {
        before.copy_from(&state);
        action.take(&mut stepper, &mut state, weather, options.dt, &mut unused)?;
        stretch.push(&before, &stepper);
    }
    Ok(stretch)
}

/// The reverse pass.
struct ReversePass<'a> {
    stepper: DerivativeStepper<'a, Taped>,
    weather: &'a Weather<'a>,
    options: &'a Options,
    /// Weights on the records.
    records: &'a [f64],
    /// Number of entries of the tape that stay, and the first of them that is a number of the state before an action.
    base: usize,
    first: u32,
    /// Weights on the entries of the tape.
    weights: Vec<f64>,
    /// Weights on the state.
    state: Vec<f64>,
    /// The state before the current action, then after it.
    now: State<Taped>,
    /// Its solution.
    known: StageSolutions<f64>,
    /// Unknowns and a state of the building, to be filled.
    blank: (Unknowns<f64>, State<f64>),
}

impl<'a> ReversePass<'a> {
    fn new(
        plan: &'a Plan,
        leaves: &'a [Taped],
        weather: &'a Weather<'a>,
        options: &'a Options,
        (reached, records): (&State<f64>, &'a [f64]),
    ) -> Self {
        let mut stepper = DerivativeStepper::new(plan, leaves, options.scheme.converged());
        if options.probes.iter().any(Output::averages_absorbed_sun) {
            stepper.follower.average_absorbed_sun();
        }
        let length = Tape::len();
        let now = stepper.follower.begin(&options.initial);
        Tape::truncate(length);
        let state = vec![0.0; now.count()];
        let first = Tape::reserve(state.len());
        Self {
            known: StageSolutions::nothing(),
            blank: (stepper.follower.place(), reached.clone()),
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

    /// Reverses the actions of a stretch.
    fn over(&mut self, actions: &[Action], stretch: &Stretch, watch: &RunControl) -> Result<(), EngineError> {
        for (&action, (before, solution)) in actions.iter().rev().zip(stretch.reversed()) {
            if watch.stop.load(core::sync::atomic::Ordering::Relaxed) {
                return Err(EngineError::Interrupted);
            }
            self.reverse(action, before, solution);
        }
        Ok(())
    }

    /// Reverses an action: replaces the weights on the state after it by those on the state before it.
    fn reverse(&mut self, action: Action, before: &[f64], solution: (&[Part], &[f64])) {
        Tape::truncate(self.base);
        let (stepper, state) = (&mut self.stepper, &mut self.now);
        let mut place = self.first;
        state.read(before, |number, value| {
            *number = Taped::new(value, place);
            place += 1;
        });
        let cells = &stepper.follower.model.parts.nonlinear_cells;
        let stages = if action == Action::Balance { 1 } else { self.options.scheme.weights().len() };
        self.known.read(cells, solution, stages, (&self.blank.0, &self.blank.1));
        stepper.take(action, state, self.weather, self.options.dt, &self.known);
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        state.zip_with(&self.state, |number, weight| number.add_weight(weight, weights));
        if let Some(row) = action.row(self.options) {
            let (probes, step) = (&self.options.probes, stepper.follower.readings());
            for (probe, weight) in probes.iter().zip(&self.records[row * probes.len()..]) {
                let record = probe.read(step.model.plan, &step, state);
                self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
                record.add_weight(*weight, &mut self.weights);
            }
        }
        Tape::propagate(&mut self.weights, self.base, |stage, equations, weights| {
            stepper.pull(stage, equations, weights);
        });
        let before = &mut self.weights[self.base - self.state.len()..self.base];
        for (mine, weight) in self.state.iter_mut().zip(before) {
            *mine = core::mem::take(weight);
        }
    }

    /// Weights on the parameters.
    fn finish(mut self, leaves: &[Taped]) -> Vec<f64> {
        Tape::truncate(self.base);
        let start = self.stepper.follower.begin(&self.options.initial);
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        start.zip_with(&self.state, |number, weight| number.add_weight(weight, weights));
        Tape::propagate(&mut self.weights, leaves.len() + 1, |_, _, _| {});
        self.weights[1..=leaves.len()].to_vec()
    }
}
