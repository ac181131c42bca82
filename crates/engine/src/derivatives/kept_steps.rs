//! The steps of a run, kept so that derivatives can go through them again, forwards or backwards: the states before them and the
//! solutions of their stages. Where these would take too much memory, only every n-th state is kept and the steps between are
//! run again.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::run::Action;
use crate::run::options::Options;
use crate::step::Stepper;
use crate::step::halving::Part;
use crate::step::history::History;
use crate::step::state::State;
use crate::weather::conditions::Weather;

/// A run of which steps are kept.
#[derive(Clone, Copy)]
pub(super) struct KeptRun<'a, 'w> {
    pub(super) plan: &'a Plan,
    pub(super) numbers: &'a [f64],
    pub(super) weather: &'a Weather<'w>,
    pub(super) options: &'a Options,
}

/// Start of a stretch.
#[derive(Debug)]
struct Start {
    state: State<f64>,
    /// Results from which its first step is guessed: with them the stretch that is run again has the same bits.
    history: History<f64>,
}

/// Successive actions: the numbers of the state before each of them and of its solution.
#[derive(Debug, Default)]
pub(super) struct Stretch {
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

    /// The actions from the first to the last: numbers of the state before each, parts and numbers of its solution.
    pub(super) fn iter(
        &self,
    ) -> impl DoubleEndedIterator<Item = (&[f64], (&[Part], &[f64]))> + ExactSizeIterator {
        let size = self.states.len() / self.ends.len().max(1);
        (0..self.ends.len()).map(move |k| {
            let [part, number] = k.checked_sub(1).map_or([0; 2], |before| self.ends[before]);
            let [last_part, last_number] = self.ends[k];
            let solution = (&self.parts[part..last_part], &self.solutions[number..last_number]);
            (&self.states[k * size..(k + 1) * size], solution)
        })
    }
}

/// Steps of a run that were kept.
#[derive(Debug, Default)]
pub(super) struct KeptSteps {
    actions: Vec<Action>,
    /// Starts of the stretches that are run again.
    starts: Vec<Start>,
    /// Number of actions in each of these stretches.
    length: usize,
    /// The last stretch, which is kept.
    last: Stretch,
}

impl KeptSteps {
    /// Visits the stretches from the first to the last, or `backwards`.
    pub(super) fn visit(
        &self,
        run: KeptRun<'_, '_>,
        backwards: bool,
        mut visit: impl FnMut(&[Action], &Stretch) -> Result<(), EngineError>,
    ) -> Result<(), EngineError> {
        let last = self.starts.len();
        for k in 0..=last {
            let k = if backwards { last - k } else { k };
            if k == last {
                visit(&self.actions[last * self.length..], &self.last)?;
            } else {
                let actions = &self.actions[k * self.length..(k + 1) * self.length];
                visit(actions, &run_again(run, &self.starts[k], actions)?)?;
            }
        }
        Ok(())
    }
}

/// Runs a stretch again and keeps its states and solutions.
fn run_again(run: KeptRun<'_, '_>, start: &Start, actions: &[Action]) -> Result<Stretch, EngineError> {
    let mut stepper = Stepper::new(run.plan, run.numbers, run.options.scheme.converged());
    stepper.known.start();
    stepper.set_history(&start.history);
    let (mut before, mut state, mut unused) =
        (start.state.clone(), start.state.clone(), EnergyBalance::new());
    let mut stretch = Stretch::default();
    for action in actions {
        before.copy_from(&state);
        let length = run.options.length(action.step());
        action.take(&mut stepper, &mut state, run.weather, length, &mut unused)?;
        stretch.push(&before, &stepper);
    }
    Ok(stretch)
}

/// Keeps steps while a run makes them.
pub(super) struct StepKeeper {
    kept: KeptSteps,
    start: Start,
    /// What the stretch that follows is guessed from.
    next: History<f64>,
    /// Number of actions that will be added.
    steps: usize,
    /// The state that was reached.
    pub(super) reached: State<f64>,
}

impl StepKeeper {
    /// Will keep some steps from a state on, in about as many bytes as given.
    pub(super) fn new(
        state: &State<f64>,
        history: History<f64>,
        steps: usize,
        options: &Options,
        bytes: usize,
    ) -> Self {
        // A state and the solutions of its stages, which are never larger.
        let each = state.count() * size_of::<f64>() * (1 + options.scheme.weights().len());
        let fit = (bytes / each).max(1);
        // The least memory is taken with as many kept states as there are states between two of them.
        let length = if steps <= fit { steps } else { fit.min(steps.isqrt() + 1) };
        let mut last = Stretch::default();
        last.states.reserve(state.count() * length);
        Self {
            kept: KeptSteps { actions: Vec::new(), starts: Vec::new(), length, last },
            next: history.clone(),
            steps,
            start: Start { state: state.clone(), history },
            reached: state.clone(),
        }
    }

    /// Adds an action that a stepper has taken to a state.
    pub(super) fn add(&mut self, action: Action, stepper: &Stepper<'_, f64>, reached: &State<f64>) {
        let Self { kept, start, next, steps, reached: before } = self;
        if kept.last.ends.len() == kept.length {
            let follows = Start { state: before.clone(), history: next.clone() };
            kept.starts.push(core::mem::replace(start, follows));
            kept.last = Stretch::default();
        }
        kept.actions.push(action);
        kept.last.push(before, stepper);
        before.copy_from(reached);
        if kept.last.ends.len() == kept.length || kept.actions.len() == *steps {
            *next = stepper.history();
        }
    }

    /// Gives the steps, and what the step after them is guessed from where as many were added as had been announced.
    pub(super) fn finish(&mut self) -> (KeptSteps, History<f64>) {
        (core::mem::take(&mut self.kept), self.next.clone())
    }
}

/// Memory for the steps of a repeated first period, for each thread [B].
const PERIOD_BYTES: usize = 1 << 28;

/// Keeps the last repetition of a first period. False for actions that belong to none.
pub(super) fn keep_period(
    period: &mut Option<StepKeeper>,
    action: Action,
    stepper: &Stepper<'_, f64>,
    reached: &State<f64>,
    options: &Options,
) -> bool {
    match (action, options.warmup, &mut *period) {
        (Action::BeginPeriod, Some(warmup), _) => {
            let (history, steps) = (stepper.history(), warmup.steps);
            *period = Some(StepKeeper::new(reached, history, steps, options, PERIOD_BYTES));
            true
        }
        (Action::WarmUp(_), _, Some(period)) => {
            period.add(action, stepper, reached);
            true
        }
        _ => false,
    }
}
