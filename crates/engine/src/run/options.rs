//! How a run is made: step, scheme, start, outputs.

use std::sync::Arc;

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::simd::Level;
use crate::run::outputs::Output;
use crate::run::step_lengths::StepLengths;
use crate::step::scheme::Scheme;
use crate::step::state::Initial;

/// How a run is made.
#[derive(Debug, Clone)]
pub struct Options {
    /// Step, or with unequal ones the record interval [s].
    pub dt: f64,
    /// Lengths of the steps; none: all are `dt`.
    pub lengths: Option<Arc<StepLengths>>,
    /// Time-stepping scheme.
    pub scheme: Scheme,
    /// What the run, or its warm-up, starts from.
    pub initial: Initial,
    /// The first period, repeated until the state at its end is periodic. None: the run starts from `initial`.
    pub warmup: Option<Warmup>,
    /// What to record.
    pub outputs: Vec<Output>,
    /// First step whose end is recorded, or with unequal ones the first record interval; with 0 the initial state is recorded before it.
    pub record_from: usize,
    /// One step, or record interval, of this number is recorded.
    pub record_every: usize,
    /// Evaluate the residuals of all stages, see [`Counters::largest_residual`](crate::step::Counters::largest_residual):
    /// a run then takes longer.
    pub residuals: bool,
}

/// A repeated first period, before the run.
#[derive(Debug, Clone, Copy)]
pub struct Warmup {
    /// Its steps.
    pub steps: usize,
    /// Largest change between two repetitions [K].
    pub tolerance: f64,
    /// Largest number of repetitions.
    pub max_cycles: usize,
}

impl Options {
    /// Number of recorded rows for a forcing of `steps` steps.
    #[must_use]
    pub fn rows(&self, steps: usize) -> usize {
        let steps = self.lengths.as_ref().map_or(steps, |lengths| lengths.intervals(steps));
        steps.checked_sub(self.record_from).map_or(0, |left| 1 + left / self.record_every)
    }

    /// Length of a step [s].
    #[inline(always)]
    pub(crate) fn length(&self, step: usize) -> f64 {
        self.lengths.as_ref().map_or(self.dt, |lengths| lengths.share(step) * self.dt)
    }

    /// Length of the first steps together [s].
    pub(crate) fn elapsed(&self, steps: usize) -> f64 {
        let intervals = self.lengths.as_ref().map_or(steps, |lengths| lengths.intervals(steps));
        intervals as f64 * self.dt
    }

    /// Checks these options with a number of parameter values and a forcing, and the lanes to use.
    ///
    /// # Errors
    /// [`EngineError::Input`].
    pub(crate) fn check(
        &self,
        plan: &Plan,
        parameters: usize,
        forcing: &Forcing<'_>,
    ) -> Result<Level, EngineError> {
        let fail = |text: String| Err(EngineError::Input(text));
        if parameters != plan.description.parameters.len() {
            return fail(format!(
                "{parameters} parameter values, expected {}",
                plan.description.parameters.len()
            ));
        }
        self.check_forcing(plan, forcing)?;
        if forcing.steps() == 0 || self.dt <= 0.0 || !self.dt.is_finite() || self.record_every == 0 {
            return fail("a run needs at least one step of positive length".to_owned());
        }
        if self.warmup.is_some_and(|warmup| warmup.steps == 0 || warmup.steps > forcing.steps()) {
            return fail("the repeated first period is longer than the run".to_owned());
        }
        self.check_lengths(forcing)?;
        self.initial.check(plan)?;
        self.outputs.iter().try_for_each(|output| output.check(plan))?;
        Level::widest()
    }

    /// Checks that unequal steps are those of the forcing, and that the repeated period ends with a record interval.
    fn check_lengths(&self, forcing: &Forcing<'_>) -> Result<(), EngineError> {
        let Some(lengths) = &self.lengths else { return Ok(()) };
        if lengths.steps() != forcing.steps() {
            let (found, expected) = (lengths.steps(), forcing.steps());
            return Err(EngineError::Input(format!("lengths of {found} steps, expected {expected}")));
        }
        if self.warmup.is_some_and(|warmup| !lengths.ends_interval(warmup.steps)) {
            return Err(EngineError::Input(
                "the repeated first period does not end with a record interval".to_owned(),
            ));
        }
        Ok(())
    }

    /// Checks the shape of a forcing.
    pub(crate) fn check_forcing(&self, plan: &Plan, forcing: &Forcing<'_>) -> Result<(), EngineError> {
        let stages = self.scheme.weights().len();
        if forcing.stages() == stages && forcing.channels() == plan.n_channels() && forcing.steps() > 0 {
            return Ok(());
        }
        Err(EngineError::Input(format!(
            "forcing has {} steps, {} stages and {} channels, expected one step at least, {stages} and {}",
            forcing.steps(),
            forcing.stages(),
            forcing.channels(),
            plan.n_channels()
        )))
    }
}
