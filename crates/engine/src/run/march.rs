//! Time stepping: the start, the recorders and the ledger.

use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::balance::ledger::Ledger;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::real::{Mask, Real};
use crate::number::simd::Level;
use crate::run::probe::Probe;
use crate::step::stage_solutions::Solution;
use crate::step::state::{Initial, State};
use crate::step::{Counters, Scheme, Stepper};
use crate::weather::conditions::Weather;

/// How a run is made.
#[derive(Debug, Clone)]
pub struct Options {
    /// Step [s].
    pub dt: f64,
    /// Time-stepping scheme.
    pub scheme: Scheme,
    /// What the run, or the repetition, starts from.
    pub initial: Initial,
    /// The first period, repeated until the state at its end settles. None: start from `initial`.
    pub warmup: Option<Warmup>,
    /// What to record.
    pub probes: Vec<Probe>,
    /// First step whose end is recorded; with 0 the initial state is recorded before it.
    pub record_from: usize,
    /// Record every so many steps.
    pub record_every: usize,
}

/// A repeated first period.
#[derive(Debug, Clone, Copy)]
pub struct Warmup {
    /// Its steps.
    pub steps: usize,
    /// Largest change between two repetitions [K].
    pub tolerance: f64,
    /// Repetitions before it counts as unsettled.
    pub max_cycles: usize,
}

impl Options {
    /// Number of recorded rows for a forcing of `steps` steps.
    #[must_use]
    pub fn rows(&self, steps: usize) -> usize {
        let from = self.record_from.min(steps);
        1 + (steps - from) / self.record_every
    }
}

/// Shared between a run and whoever waits for it.
#[derive(Debug, Default)]
pub struct Watch {
    /// Set to stop the run.
    pub stop: AtomicBool,
    /// Members finished so far.
    pub done: AtomicUsize,
}

/// A finished run (or a pack of members).
#[derive(Debug, Clone)]
pub struct Run<S: Real> {
    /// Rows x probes.
    pub records: Vec<S>,
    /// Heat since the start of the record's first step.
    pub ledger: Ledger<S>,
    /// State at the end.
    pub state: State<S>,
    /// Repetitions of the first period.
    pub cycles: usize,
    /// Change in the last repetition [K].
    pub settled: S,
    /// What it was spent on, the repetitions included.
    pub counters: Counters<S>,
    /// Lanes that failed: what they hold means nothing.
    pub failed: S::Mask,
}

/// Runs a plan at a parameter vector.
///
/// # Errors
/// [`EngineError::NotConverged`], [`EngineError::NotSettled`], [`EngineError::Interrupted`], [`EngineError::Input`].
pub fn march<S: Real>(
    plan: &Plan,
    numbers: &[S],
    forcing: &Forcing<'_>,
    options: &Options,
    watch: &Watch,
) -> Result<Run<S>, EngineError> {
    check(plan, numbers.len(), forcing, options)?;
    march_in(plan, numbers, &Weather::once(plan, forcing), options, watch)
}

/// Runs a plan at a parameter vector in a weather that many runs share. What `march` checks must hold.
pub(crate) fn march_in<S: Real>(
    plan: &Plan,
    numbers: &[S],
    weather: &Weather<'_>,
    options: &Options,
    watch: &Watch,
) -> Result<Run<S>, EngineError> {
    march_seen(Stepper::new(plan, numbers, options.scheme), weather, options, watch, |_, _, _| Ok(()))
}

/// One thing that a run does to its state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Move {
    /// A step of the repeated first period.
    Repeat(usize),
    /// The surfaces brought into balance with the weather of the start.
    Balance,
    /// A step.
    Step(usize),
}

impl Move {
    /// Makes it.
    #[inline(always)]
    pub(crate) fn make<S: Real>(
        self,
        stepper: &mut Stepper<'_, S>,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        ledger: &mut Ledger<S>,
    ) -> Result<(), EngineError> {
        match self {
            Self::Repeat(step) | Self::Step(step) => stepper.step(state, weather, step, dt, ledger),
            Self::Balance => {
                stepper.forget();
                // The weather of the first stage stands for that of the start.
                stepper.balance_surfaces(state, &weather.at(0, 0))
            }
        }
    }

    /// Makes it along its solution, where that is known.
    pub(crate) fn follow<S: Real>(
        self,
        stepper: &mut Stepper<'_, S>,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        solution: Option<Solution<'_>>,
    ) -> Result<(), EngineError> {
        let Some(solution) = solution else {
            return self.make(stepper, state, weather, dt, &mut Ledger::new());
        };
        match self {
            Self::Repeat(step) | Self::Step(step) => stepper.follow_step(state, weather, step, dt, solution),
            Self::Balance => stepper.follow_balance(state, &weather.at(0, 0), solution),
        }
        Ok(())
    }

    /// Row of the record that it leads to.
    pub(crate) fn row(self, options: &Options) -> Option<usize> {
        // Row k is the state at the start of step `record_from + k * record_every`.
        let steps = match self {
            Self::Repeat(_) => return None,
            Self::Balance => 0,
            Self::Step(step) => step + 1,
        };
        let since = steps.checked_sub(options.record_from)?;
        since.is_multiple_of(options.record_every).then(|| since / options.record_every)
    }
}

/// Lets a stepper run; `see` is shown each move and the state after it.
pub(crate) fn march_seen<'a, S: Real>(
    mut stepper: Stepper<'a, S>,
    weather: &Weather<'_>,
    options: &Options,
    watch: &Watch,
    mut see: impl FnMut(&Stepper<'a, S>, &State<S>, Move) -> Result<(), EngineError>,
) -> Result<Run<S>, EngineError> {
    let plan = stepper.model.plan;
    let mut state = stepper.begin(&options.initial);
    let (cycles, settled) = warm_up(&mut stepper, &mut state, weather, options, watch, &mut see)?;
    let mut records = Vec::with_capacity(options.rows(weather.steps()) * options.probes.len());
    let mut ledger = Ledger::new();
    for made in core::iter::once(Move::Balance).chain((0..weather.steps()).map(Move::Step)) {
        if watch.stop.load(Ordering::Relaxed) {
            return Err(EngineError::Interrupted);
        }
        made.make(&mut stepper, &mut state, weather, options.dt, &mut ledger)?;
        if made.row(options).is_some() {
            records.extend(options.probes.iter().map(|probe| probe.read(plan, &stepper, &state)));
        }
        see(&stepper, &state, made)?;
    }
    Ok(Run {
        records,
        ledger,
        state,
        cycles,
        settled,
        counters: stepper.counters(),
        failed: stepper.failed(),
    })
}

/// Repeats the first period until every lane has settled; a settled lane keeps its state.
fn warm_up<'a, S: Real>(
    stepper: &mut Stepper<'a, S>,
    state: &mut State<S>,
    weather: &Weather<'_>,
    options: &Options,
    watch: &Watch,
    see: &mut impl FnMut(&Stepper<'a, S>, &State<S>, Move) -> Result<(), EngineError>,
) -> Result<(usize, S), EngineError> {
    let Some(warmup) = options.warmup else { return Ok((0, S::zero())) };
    let mut active = S::Mask::splat(true);
    let mut settled = S::zero();
    for cycle in 1..=warmup.max_cycles {
        let mut next = state.clone();
        let mut unused = Ledger::new();
        for made in (0..warmup.steps).map(Move::Repeat) {
            if watch.stop.load(Ordering::Relaxed) {
                return Err(EngineError::Interrupted);
            }
            made.make(stepper, &mut next, weather, options.dt, &mut unused)?;
            see(stepper, &next, made)?;
        }
        let change = next.distance(state);
        state.take(active, &next);
        settled = S::select(active, change, settled);
        active = active & !stepper.failed() & S::constant(warmup.tolerance).lt(change);
        if !active.any() {
            return Ok((cycle, settled));
        }
    }
    let residual = (0..S::LANES).map(|lane| settled.lane(lane)).fold(0.0, f64::max);
    Err(EngineError::NotSettled { cycles: warmup.max_cycles, residual, tolerance: warmup.tolerance })
}

pub(crate) fn check(
    plan: &Plan,
    numbers: usize,
    forcing: &Forcing<'_>,
    options: &Options,
) -> Result<Level, EngineError> {
    let fail = |text: String| Err(EngineError::Input(text));
    let stages = options.scheme.weights().len();
    if numbers != plan.description.parameters.len() {
        return fail(format!("{numbers} parameter values, expected {}", plan.description.parameters.len()));
    }
    if forcing.stages() != stages || forcing.channels() != plan.n_channels() {
        return fail(format!(
            "forcing has {} stages and {} channels, expected {stages} and {}",
            forcing.stages(),
            forcing.channels(),
            plan.n_channels()
        ));
    }
    if forcing.steps() == 0 || options.dt <= 0.0 || !options.dt.is_finite() || options.record_every == 0 {
        return fail("a run needs at least one step of positive length".to_owned());
    }
    if options.warmup.is_some_and(|warmup| warmup.steps == 0 || warmup.steps > forcing.steps()) {
        return fail("the repeated first period is longer than the run".to_owned());
    }
    options.initial.check(plan)?;
    options.probes.iter().try_for_each(|probe| probe.check(plan))?;
    Level::widest()
}
