//! A run together with the building and the parameters that it borrows.

use std::sync::Arc;

use mascarin_engine::error::EngineError;
use mascarin_engine::run::physical_limits::Outlier;
use mascarin_engine::run::stepwise::StepByStep;
use mascarin_engine::run::validity::OutOfRange;
use self_cell::self_cell;

use mascarin_contents::Contents;

/// What a run is made of.
pub(crate) struct Base {
    pub(crate) contents: Arc<Contents>,
    pub(crate) parameters: Vec<f64>,
}

self_cell!(
    /// A run that owns what it is made of.
    pub(crate) struct Running {
        owner: Base,
        #[not_covariant]
        dependent: StepByStep,
    }
);

impl Running {
    /// Brings a building to its start at a step of its weather; `now` is the weather of that step, inputs included.
    ///
    /// # Errors
    /// As [`StepByStep::start`].
    pub(crate) fn start(
        contents: &Arc<Contents>,
        parameters: &[f64],
        first: usize,
        now: &[f64],
    ) -> Result<Self, EngineError> {
        let base = Base { contents: Arc::clone(contents), parameters: parameters.to_vec() };
        Self::try_new(base, |base| {
            let contents = &base.contents;
            let repeated = contents.options.warmup.map_or(1, |warmup| warmup.steps);
            let left = contents.steps().saturating_sub(first);
            let period = contents.forcing(contents.rows(first, repeated.min(left)));
            let now = contents.forcing(now);
            StepByStep::start(
                &contents.plan,
                &base.parameters,
                &contents.options,
                &period.map_err(EngineError::Input)?,
                &now.map_err(EngineError::Input)?,
            )
        })
    }

    /// Whether it runs with these parameters, to the bit.
    pub(crate) fn has(&self, parameters: &[f64]) -> bool {
        let own = &self.borrow_owner().parameters;
        own.len() == parameters.len() && own.iter().zip(parameters).all(|(a, b)| a.to_bits() == b.to_bits())
    }

    /// Makes a step in its weather.
    ///
    /// # Errors
    /// As [`StepByStep::step`].
    pub(crate) fn step(&mut self, rows: &[f64]) -> Result<(), EngineError> {
        self.with_dependent_mut(|base, run| {
            let forcing = base.contents.forcing(rows).map_err(EngineError::Input)?;
            run.step(&forcing)
        })
    }

    /// Steps made since the start.
    pub(crate) fn steps(&self) -> usize {
        self.with_dependent(|_, run| run.steps())
    }

    /// Records of the engine.
    pub(crate) fn read(&self, records: &mut Vec<f64>) {
        self.with_dependent(|_, run| run.read(records));
    }

    /// Relative residual of the energy balance so far [-].
    pub(crate) fn closure(&self) -> f64 {
        self.with_dependent(|_, run| run.closure())
    }

    /// The first temperature that was outside of its causes by more than the scheme's overshoot.
    pub(crate) fn outlier(&self) -> Option<Outlier> {
        self.with_dependent(|_, run| run.outlier().cloned())
    }

    /// Laws written as text that were used where they do not hold.
    pub(crate) fn out_of_range(&self) -> Vec<OutOfRange> {
        self.with_dependent(|_, run| run.out_of_range().cloned().collect())
    }

    /// All numbers that the steps to come depend on.
    pub(crate) fn save(&self) -> Vec<f64> {
        self.with_dependent(|_, run| run.save())
    }

    /// Goes on from saved numbers.
    ///
    /// # Errors
    /// As [`StepByStep::restore`].
    pub(crate) fn restore(&mut self, numbers: &[f64]) -> Result<(), EngineError> {
        self.with_dependent_mut(|_, run| run.restore(numbers))
    }
}
