//! Reverse derivatives: from weights on the records of a run to the slopes of their weighted sum by all parameters.
//!
//! The run keeps the states between its steps and the solutions of their stages. The reverse pass takes the steps from the
//! last to the first. Each step is computed once more at its known solution, with numbers that record their operations on a
//! tape; from the weights on the state after the step follow those on the state before it and on the coefficients. The
//! operations from parameters to coefficients stay on the tape during the whole pass. A repeated first period is gone through as
//! often as the slopes of a periodic state need (`periodic_slopes`).

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::linear::unknowns::Unknowns;
use crate::number::tape::{Tape, Taped};
use crate::run::options::Options;
use crate::run::simulate::{Run, simulate_observed};
use crate::run::{Action, Recorded};
use crate::step::Stepper;
use crate::step::control::RunControl;
use crate::step::halving::Part;
use crate::step::stage_solutions::StageSolutions;
use crate::step::state::State;
use crate::weather::conditions::Weather;

use super::kept_steps::{KeptRun, KeptSteps, StepKeeper, Stretch};
use super::periodic_slopes::{SlopeSearch, plain_weights};
use super::stored_steps::DerivativeStepper;

/// A run, and what its reverse pass needs.
#[derive(Debug)]
pub struct Trajectory {
    /// The run.
    pub run: Run<f64>,
    /// The last repetition of the first period, where it was repeated.
    period: Option<KeptSteps>,
    /// The steps after it.
    steps: KeptSteps,
}

impl Trajectory {
    /// Runs a plan, keeping about as many bytes as given of the run, and of its repeated first period.
    ///
    /// # Errors
    /// As [`simulate`](crate::run::simulate::simulate).
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
        let keep =
            |state: &State<f64>, history, steps| StepKeeper::new(state, history, steps, options, bytes);
        let mut kept =
            keep(&stepper.begin(&options.initial, weather.row(0, 0)), stepper.history(), weather.steps() + 1);
        let mut period = None;
        let run = simulate_observed(stepper, &weather, options, watch, |stepper, reached, action| {
            match (action, options.warmup) {
                (Action::BeginPeriod, Some(warmup)) => {
                    kept = keep(reached, stepper.history(), warmup.steps);
                    return Ok(());
                }
                (Action::Balance, Some(_)) => {
                    let (repeated, history) = kept.finish();
                    period = Some(repeated);
                    kept = keep(&kept.reached, history, weather.steps() + 1);
                }
                _ => {}
            }
            kept.add(action, stepper, reached);
            Ok(())
        })?;
        Ok(Self { run, period, steps: kept.finish().0 })
    }

    /// Slopes by all parameters of the sum of weights (rows x outputs) times records.
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
        let run = KeptRun { plan, numbers, weather: &weather, options };
        self.steps.visit(run, true, |actions, stretch| pass.over(actions, stretch, watch))?;
        if let Some(period) = &self.period {
            pass.over_repeated(period, run, watch)?;
        }
        Ok(pass.finish(&leaves))
    }
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
        let stepper = DerivativeStepper::of_run(plan, leaves, options);
        let length = Tape::len();
        let now = stepper.linearized_stepper.begin(&options.initial, weather.row(0, 0));
        Tape::truncate(length);
        let state = vec![0.0; now.count()];
        let first = Tape::reserve(state.len());
        Self {
            known: StageSolutions::nothing(),
            blank: (stepper.linearized_stepper.place(), reached.clone()),
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

    /// Reverses a period that was repeated until its end was its start. The weights on the end are `own + P^T w` with the map `P` of
    /// the slopes over the period, until they no longer change; the period adds to the weights on the coefficients once.
    fn over_repeated(
        &mut self,
        period: &KeptSteps,
        run: KeptRun<'_, '_>,
        watch: &RunControl,
    ) -> Result<(), EngineError> {
        let coefficients: Vec<f64> = self.weights.iter().copied().take(self.base).collect();
        let own = self.state.clone();
        let model = &self.stepper.linearized_stepper.model;
        let dual = |weight: f64| if weight > 0.0 { 1.0 / weight } else { 0.0 };
        let mut search = SlopeSearch::new(plain_weights(model, &self.now).into_iter().map(dual).collect());
        let mut weights = own.clone();
        loop {
            self.weights[..self.base].copy_from_slice(&coefficients);
            self.state.copy_from_slice(&weights);
            period.visit(run, true, |actions, stretch| self.over(actions, stretch, watch))?;
            let image: Vec<f64> = self.state.iter().zip(&own).map(|(passed, own)| passed + own).collect();
            let Some(next) = search.next(&weights, &image) else {
                // What is left belongs to the state that the first repetition started from.
                for ((left, image), weight) in self.state.iter_mut().zip(image).zip(weights) {
                    *left = image - weight;
                }
                return Ok(());
            };
            weights = next;
        }
    }

    /// Reverses the actions of a stretch.
    fn over(&mut self, actions: &[Action], stretch: &Stretch, watch: &RunControl) -> Result<(), EngineError> {
        for (&action, (before, solution)) in actions.iter().zip(stretch.iter()).rev() {
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
        let cells = &stepper.linearized_stepper.model.parts.nonlinear_cells;
        let stages = if action == Action::Balance { 1 } else { self.options.scheme.weights().len() };
        self.known.read(cells, solution, stages, (&self.blank.0, &self.blank.1));
        let length = self.options.length(action.step());
        stepper.take(action, state, self.weather, length, &self.known);
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        state.zip_with(&self.state, |number, weight| number.add_weight(weight, weights));
        if let Some(Recorded { row, share, ends }) = action.record(self.options) {
            let (outputs, step) = (&self.options.outputs, stepper.linearized_stepper.readings());
            for (output, weight) in outputs.iter().zip(&self.records[row * outputs.len()..]) {
                if !(ends || output.is_mean()) {
                    continue;
                }
                let record = output.read(step.model.plan, &step, state);
                self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
                let share = if output.is_mean() { share } else { 1.0 };
                record.add_weight(*weight * share, &mut self.weights);
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
        let start = self.stepper.linearized_stepper.begin(&self.options.initial, self.weather.row(0, 0));
        self.weights.resize(self.weights.len().max(Tape::len()), 0.0);
        let weights = &mut self.weights;
        start.zip_with(&self.state, |number, weight| number.add_weight(weight, weights));
        Tape::propagate(&mut self.weights, leaves.len() + 1, |_, _, _| {});
        self.weights[1..=leaves.len()].to_vec()
    }
}
