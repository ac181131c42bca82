//! Reverse derivatives: a run that can be gone back along, from weights on its records to the slopes by all parameters.
//!
//! The run keeps the states between its steps and the solutions of their stages. On the way back each step is made once
//! more with numbers that remember what they were made of, along its solution; the weights of the state
//! after it become those of the state before it and of the coefficients. What the coefficients were made of stays on the
//! tape from the start to the end. Where all of this would take too much memory, only every n-th state is kept and the
//! steps between are run again.

use super::tape::{Tape, Taped};
use crate::drive::Weather;
use crate::error::EngineError;
use crate::forcing::Forcing;
use crate::known::Solution;
use crate::ledger::Ledger;
use crate::march::{Move, Options, Run, Watch, check, march_seen};
use crate::plan::Plan;
use crate::state::State;
use crate::step::Stepper;

/// A run, and what is needed to go back along it.
#[derive(Debug)]
pub struct Trajectory {
    /// The run.
    pub run: Run<f64>,
    /// Everything that was done to the state.
    moves: Vec<Move>,
    /// States before the stretches that are run again.
    starts: Vec<State<f64>>,
    /// Moves in each of them.
    length: usize,
    /// What follows them.
    last: Stretch,
}

/// Moves in a row, each with the state before it and its solution.
#[derive(Debug, Default)]
struct Stretch {
    states: Vec<State<f64>>,
    solutions: Vec<Option<Solution>>,
}

impl Trajectory {
    /// Runs a plan, keeping about as many bytes as given.
    ///
    /// # Errors
    /// As [`march`](crate::march::march).
    pub fn new(
        plan: &Plan,
        numbers: &[f64],
        forcing: &Forcing<'_>,
        options: &Options,
        watch: &Watch,
        bytes: usize,
    ) -> Result<Self, EngineError> {
        check(plan, numbers.len(), forcing, options)?;
        let weather = Weather::new(plan, forcing);
        let mut stepper = Stepper::new(plan, numbers, options.scheme);
        stepper.known.start();
        let mut before = stepper.begin(&options.initial);
        let length = stretch(&before, weather.steps(), options, bytes);
        let (mut moves, mut starts, mut last) = (Vec::new(), Vec::new(), Stretch::default());
        let run = march_seen(stepper, &weather, options, watch, |stepper, reached, made| {
            if last.states.len() == length {
                starts.push(last.states.swap_remove(0));
                last = Stretch::default();
            }
            moves.push(made);
            last.states.push(core::mem::replace(&mut before, reached.clone()));
            last.solutions.push(stepper.known.solution(&reached.load));
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
        watch: &Watch,
        weights: &[f64],
    ) -> Result<Vec<f64>, EngineError> {
        check(plan, numbers.len(), forcing, options)?;
        if weights.len() != self.run.records.len() {
            let (found, expected) = (weights.len(), self.run.records.len());
            return Err(EngineError::Input(format!("{found} weights on records, expected {expected}")));
        }
        let weather = Weather::new(plan, forcing);
        Tape::clear();
        let leaves: Vec<_> = numbers.iter().map(|&number| Taped::variable(number)).collect();
        let mut back = Back::new(plan, &leaves, &weather, options, weights);
        let first_of_last = self.starts.len() * self.length;
        back.over(&self.moves[first_of_last..], &self.last, watch)?;
        for (k, start) in self.starts.iter().enumerate().rev() {
            let moves = &self.moves[k * self.length..(k + 1) * self.length];
            let again = again(plan, numbers, &weather, options, start, moves)?;
            back.over(moves, &again, watch)?;
        }
        let slopes = back.finish(&leaves);
        Tape::clear();
        Ok(slopes)
    }
}

/// Moves between two kept states: all of them where they fit into the bytes.
fn stretch(state: &State<f64>, steps: usize, options: &Options, bytes: usize) -> usize {
    // A state and the solutions of its stages, which are never larger.
    let each = state.numbers().count() * size_of::<f64>() * (1 + options.scheme.weights().len());
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
    start: &State<f64>,
    moves: &[Move],
) -> Result<Stretch, EngineError> {
    let mut stepper = Stepper::new(plan, numbers, options.scheme);
    stepper.known.start();
    let (mut state, mut unused) = (start.clone(), Ledger::new());
    let mut made = Stretch::default();
    for step in moves {
        made.states.push(state.clone());
        step.make(&mut stepper, &mut state, weather, options.dt, &mut unused)?;
        made.solutions.push(stepper.known.solution(&state.load));
    }
    Ok(made)
}

/// The way back.
struct Back<'a> {
    /// With the coefficients on the tape.
    fresh: Stepper<'a, Taped>,
    stepper: Stepper<'a, Taped>,
    weather: &'a Weather<'a>,
    options: &'a Options,
    /// Weights on the records.
    records: &'a [f64],
    /// Entries of the tape that stay.
    base: usize,
    /// Weights on the entries of the tape.
    weights: Vec<f64>,
    /// Weights on the state.
    state: Vec<f64>,
    /// The state before the step in hand, then after it.
    now: State<Taped>,
}

impl<'a> Back<'a> {
    fn new(
        plan: &'a Plan,
        leaves: &'a [Taped],
        weather: &'a Weather<'a>,
        options: &'a Options,
        records: &'a [f64],
    ) -> Self {
        let fresh = Stepper::new(plan, leaves, options.scheme);
        let (stepper, base) = (fresh.clone(), Tape::len());
        let now = stepper.begin(&options.initial);
        let state = vec![0.0; now.numbers().count()];
        Self { fresh, stepper, weather, options, records, base, weights: Vec::new(), state, now }
    }

    /// Goes back over a stretch.
    fn over(&mut self, moves: &[Move], stretch: &Stretch, watch: &Watch) -> Result<(), EngineError> {
        let known = stretch.states.iter().zip(&stretch.solutions);
        for (&made, (before, solution)) in moves.iter().zip(known).rev() {
            if watch.stop.load(core::sync::atomic::Ordering::Relaxed) {
                return Err(EngineError::Interrupted);
            }
            self.pass(made, before, solution.as_ref())?;
        }
        Ok(())
    }

    /// Goes back over a move: its weights on the state before it take the place of those on the state after it.
    fn pass(
        &mut self,
        made: Move,
        before: &State<f64>,
        solution: Option<&Solution>,
    ) -> Result<(), EngineError> {
        Tape::cut(self.base);
        let first = Tape::reserve(self.state.len());
        let (leaves, mut places) = (Tape::len(), first..);
        let state = &mut self.now;
        state.meet(before, |number, value| {
            if let Some(place) = places.next() {
                *number = Taped::new(value, place);
            }
        });
        self.stepper.forget();
        made.follow(&mut self.stepper, state, self.weather, self.options.dt, solution)?;
        let read = made.row(self.options).map(|row| {
            let probes = &self.options.probes;
            let records = probes.iter().map(|probe| probe.read(self.stepper.plan, &self.stepper, state));
            (row * probes.len(), records.collect::<Vec<_>>())
        });
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        for (number, weight) in state.numbers().zip(&self.state) {
            number.weigh(*weight, &mut self.weights);
        }
        if let Some((first, records)) = read {
            for (record, weight) in records.iter().zip(&self.records[first..]) {
                record.weigh(*weight, &mut self.weights);
            }
        }
        let stepper = &mut self.stepper;
        Tape::pull(&mut self.weights, leaves, |stage, weights| stepper.pull_stage(stage, weights));
        let passed = &mut self.weights[self.base..leaves];
        self.state.copy_from_slice(passed);
        passed.fill(0.0);
        if solution.is_none() {
            // It has made factors that are about to be cut off.
            self.stepper = self.fresh.clone();
        }
        Ok(())
    }

    /// Weights on the parameters.
    fn finish(mut self, leaves: &[Taped]) -> Vec<f64> {
        Tape::cut(self.base);
        let start = self.fresh.begin(&self.options.initial);
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        for (number, weight) in start.numbers().zip(&self.state) {
            number.weigh(*weight, &mut self.weights);
        }
        Tape::pull(&mut self.weights, leaves.len() + 1, |_, _| {});
        self.weights[1..=leaves.len()].to_vec()
    }
}
