//! How a run is made: step, scheme, start, outputs.

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::simd::Level;
use crate::run::outputs::Output;
use crate::step::scheme::Scheme;
use crate::step::state::Initial;

/// How a run is made.
#[derive(Debug, Clone)]
pub struct Options {
    /// Step [s].
    pub dt: f64,
    /// Time-stepping scheme.
    pub scheme: Scheme,
    /// What the run, or its warm-up, starts from.
    pub initial: Initial,
    /// The first period, repeated until the state at its end is periodic. None: the run starts from `initial`.
    pub warmup: Option<Warmup>,
    /// What to record.
    pub outputs: Vec<Output>,
    /// First step whose end is recorded; with 0 the initial state is recorded before it.
    pub record_from: usize,
    /// One step of this number is recorded.
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
        steps.checked_sub(self.record_from).map_or(0, |left| 1 + left / self.record_every)
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
        self.initial.check(plan)?;
        self.outputs.iter().try_for_each(|output| output.check(plan))?;
        Level::widest()
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
