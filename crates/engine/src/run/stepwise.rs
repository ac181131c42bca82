//! A run that its caller takes on step by step, with the weather of each step: for programs that exchange values with it meanwhile.
//!
//! The actions are those of [`simulate`](crate::run::simulate::simulate), so that the same weather gives the same bits.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::output_limits::require_limits;
use crate::run::physical_limits::{Outlier, PhysicalLimits};
use crate::run::simulate::prepare;
use crate::run::validity::{OutOfRange, Validity};
use crate::run::warm_up::warm_up;
use crate::step::control::RunControl;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// A run of one plan that is taken on step by step.
#[derive(Debug)]
pub struct StepByStep<'a> {
    plan: &'a Plan,
    options: &'a Options,
    stepper: Stepper<'a, f64>,
    /// Weather of nothing, from which that of each step is made.
    weather: Weather<'a>,
    state: State<f64>,
    energy_balance: EnergyBalance<f64>,
    limits: PhysicalLimits<f64>,
    validity: Validity,
    /// Steps made since the start.
    steps: usize,
}

impl<'a> StepByStep<'a> {
    /// Brings a plan to its start: repeats the first period, where the options ask for it, and brings the surfaces into balance with the
    /// weather at the start of the first step.
    ///
    /// `first_period` is the weather of the repeated steps, or of one step at least where nothing is repeated; `first_step` is that of the
    /// first step.
    ///
    /// # Errors
    /// [`EngineError::Input`], [`EngineError::NotConverged`], [`EngineError::WarmUpNotConverged`], [`EngineError::Impossible`].
    pub fn start(
        plan: &'a Plan,
        parameters: &'a [f64],
        options: &'a Options,
        first_period: &Forcing<'_>,
        first_step: &Forcing<'_>,
    ) -> Result<Self, EngineError> {
        options.check(plan, parameters.len(), first_period)?;
        options.check_forcing(plan, first_step)?;
        if options.lengths.is_some() {
            return Err(EngineError::Input("a run step by step has steps of one length".to_owned()));
        }
        let mut stepper = Stepper::new(plan, parameters, options.scheme);
        prepare(&mut stepper, options);
        let repeated = options.warmup.as_ref().map_or(0, |warmup| warmup.steps);
        let weather = Weather::for_single_run(plan, first_period, repeated);
        let mut state = stepper.begin(&options.initial, weather.row(0, 0));
        let control = RunControl::default();
        warm_up(&mut stepper, &mut state, &weather, options, &control, &mut |_, _, _| Ok(()))?;
        let (mut energy_balance, mut limits) =
            (EnergyBalance::new(), PhysicalLimits::new(&state, options.scheme));
        let first = weather.of(first_step);
        Action::Balance.take(&mut stepper, &mut state, &first, options.dt, &mut energy_balance)?;
        let rows = Action::Balance.weather_rows(&first, options.scheme);
        limits.judge(&mut stepper, &state, rows, (Action::Balance, 0))?;
        let weather = Weather::for_single_run(plan, &Forcing::none(), 0);
        let validity = Validity::new(&stepper.model);
        Ok(Self { plan, options, stepper, weather, state, energy_balance, limits, validity, steps: 0 })
    }

    /// Makes a step in its weather. The state stays as it was where the step fails; after an impossible one the run cannot go on.
    ///
    /// # Errors
    /// [`EngineError::Input`], [`EngineError::NotConverged`], [`EngineError::Impossible`].
    pub fn step(&mut self, forcing: &Forcing<'_>) -> Result<(), EngineError> {
        self.options.check_forcing(self.plan, forcing)?;
        // The forcing holds one step.
        let action = if self.steps == 0 { Action::first(self.options) } else { Action::Step(0) };
        let weather = self.weather.of(forcing);
        let Self { stepper, state, energy_balance, limits, .. } = self;
        action.take(stepper, state, &weather, self.options.dt, energy_balance).map_err(
            |error| match error {
                EngineError::NotConverged { stage, place, residual, iterations, .. } => {
                    EngineError::NotConverged { step: self.steps, stage, place, residual, iterations }
                }
                other => other,
            },
        )?;
        let rows = action.weather_rows(&weather, self.options.scheme);
        limits.judge(stepper, state, rows, (action, self.steps))?;
        self.validity.judge(&self.stepper, &self.state, self.steps);
        self.steps += 1;
        let mut values = Vec::new();
        self.read(&mut values);
        require_limits(self.plan, &self.options.outputs, &values, self.steps - 1)
    }

    /// Reads the outputs of the options: the state at the start, or after the last step.
    pub fn read(&self, values: &mut Vec<f64>) {
        values.clear();
        let step = self.stepper.readings();
        values.extend(self.options.outputs.iter().map(|output| output.read(self.plan, &step, &self.state)));
    }

    /// The first temperature that was outside of its causes by more than the scheme's overshoot, if any; see
    /// [`physical_limits`](crate::run::physical_limits).
    #[must_use]
    pub fn outlier(&self) -> Option<&Outlier> {
        self.limits.outlier.as_ref()
    }

    /// Laws written as text that were used where they do not hold.
    pub fn out_of_range(&self) -> impl Iterator<Item = &OutOfRange> {
        self.validity.found()
    }

    /// Steps made since the start.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Relative residual of the energy balance so far, or of the vapour balance if that is larger [-].
    #[must_use]
    pub fn closure(&self) -> f64 {
        let mut energy_balance = self.energy_balance;
        energy_balance.set_content(self.state.heat_content(&self.stepper.model), self.steps);
        energy_balance.worst_closure()
    }

    /// All numbers that the steps to come depend on beside weather and parameters.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let mut numbers = vec![self.steps as f64];
        self.state.write(&mut numbers);
        self.stepper.history().write(&mut numbers);
        numbers
    }

    /// Goes on from where a run of the same plan and parameters was saved. Its energy balance begins anew, and outputs can be read again
    /// after the next step.
    ///
    /// # Errors
    /// [`EngineError::Input`]: the numbers are not those of such a run. Nothing is changed then.
    pub fn restore(&mut self, numbers: &[f64]) -> Result<(), EngineError> {
        let wrong = || EngineError::Input("the saved state is not one of this building".to_owned());
        let (&steps, rest) = numbers.split_first().ok_or_else(wrong)?;
        let (state, rest) = rest.split_at_checked(self.state.count()).ok_or_else(wrong)?;
        let mut history = self.stepper.history();
        let whole = steps >= 0.0 && steps.fract() == 0.0 && steps < 9_007_199_254_740_992.0;
        if !(whole && history.read(self.plan, rest)) {
            return Err(wrong());
        }
        self.state.read(state, |mine, saved| *mine = saved);
        self.stepper.set_history(&history);
        self.energy_balance = EnergyBalance::new();
        self.limits = PhysicalLimits::new(&self.state, self.options.scheme);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and not negative")]
        let steps = steps as usize;
        self.steps = steps;
        Ok(())
    }
}
