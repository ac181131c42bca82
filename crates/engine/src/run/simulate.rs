//! Time stepping: a plan at a parameter vector, driven by a forcing, from the start to the end.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::real::{Mask, Real};
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::output_limits::{beyond_limits, require_limits};
use crate::run::outputs::Output;
use crate::run::physical_limits::{Outlier, PhysicalLimits};
use crate::run::records::RecordRow;
use crate::run::validity::{OutOfRange, Validity};
use crate::run::warm_up::warm_up;
use crate::step::control::RunControl;
use crate::step::newton::Counters;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// A finished run (or a pack of members).
#[derive(Debug, Clone)]
pub struct Run<S: Real> {
    /// Rows x outputs.
    pub records: Vec<S>,
    /// Heat since the start of the record's first step.
    pub energy_balance: EnergyBalance<S>,
    /// State at the end.
    pub state: State<S>,
    /// Repetitions of the warm-up.
    pub cycles: usize,
    /// Largest change of a temperature in the last repetition of the warm-up [K].
    pub warm_up_change: S,
    /// Counts of iterations, nested iterations and halvings, warm-up included.
    pub counters: Counters<S>,
    /// Lanes that failed: their numbers have no meaning.
    pub failed: S::Mask,
    /// How far temperatures were outside of their causes by more than the scheme's overshoot [K]; see
    /// [`physical_limits`](crate::run::physical_limits).
    pub outside: S,
    /// Where that was first, in a run of one member.
    pub outlier: Option<Outlier>,
    /// Laws written as text that were used where they do not hold; empty for several members.
    pub out_of_range: Vec<OutOfRange>,
    /// Steps at whose end a law written as text did not hold, of the law that holds least often.
    pub beyond_validity: S,
}

/// Runs a plan at a parameter vector.
///
/// # Errors
/// [`EngineError::NotConverged`], [`EngineError::WarmUpNotConverged`], [`EngineError::Impossible`], [`EngineError::Interrupted`],
/// [`EngineError::Input`].
pub fn simulate<S: Real>(
    plan: &Plan,
    parameters: &[S],
    forcing: &Forcing<'_>,
    options: &Options,
    control: &RunControl,
) -> Result<Run<S>, EngineError> {
    options.check(plan, parameters.len(), forcing)?;
    let repeated = options.warmup.as_ref().map_or(0, |warmup| warmup.steps);
    simulate_in(plan, parameters, &Weather::for_single_run(plan, forcing, repeated), options, control)
}

/// Runs a plan at a parameter vector in a weather that many runs share. What [`Options::check`] checks must hold.
pub(crate) fn simulate_in<S: Real>(
    plan: &Plan,
    parameters: &[S],
    weather: &Weather<'_>,
    options: &Options,
    control: &RunControl,
) -> Result<Run<S>, EngineError> {
    simulate_observed(Stepper::new(plan, parameters, options.scheme), weather, options, control, |_, _, _| {
        Ok(())
    })
}

/// Lets a stepper find what the options ask for beside the results of every run.
pub(super) fn prepare<S: Real>(stepper: &mut Stepper<'_, S>, options: &Options) {
    if options.lengths.is_some() {
        stepper.keep_factors();
    }
    if options.residuals {
        stepper.evaluate_residuals();
    }
    if options.outputs.iter().any(Output::averages_absorbed_sun) {
        stepper.average_absorbed_sun();
    }
}

/// A run on its way: its state, and what is added up and judged along it.
pub(super) struct Course<'a, S: Real> {
    pub(super) stepper: Stepper<'a, S>,
    pub(super) state: State<S>,
    cycles: usize,
    warm_up_change: S,
    energy_balance: EnergyBalance<S>,
    limits: PhysicalLimits<S>,
    validity: Validity,
}

impl<'a, S: Real> Course<'a, S> {
    /// Brings a stepper to where a run starts; `observe` is called with each action of the warm-up and the state after it.
    pub(super) fn start(
        mut stepper: Stepper<'a, S>,
        weather: &Weather<'_>,
        options: &Options,
        control: &'a RunControl,
        observe: &mut impl FnMut(&Stepper<'a, S>, &State<S>, Action) -> Result<(), EngineError>,
    ) -> Result<Self, EngineError> {
        stepper.set_control(control);
        prepare(&mut stepper, options);
        let mut state = stepper.begin(&options.initial, weather.row(0, 0));
        let (cycles, warm_up_change) = warm_up(&mut stepper, &mut state, weather, options, control, observe)?;
        let limits = PhysicalLimits::new(&state, options.scheme);
        let validity = Validity::new(&stepper.model);
        let energy_balance = EnergyBalance::new();
        Ok(Self { stepper, state, cycles, warm_up_change, energy_balance, limits, validity })
    }

    /// Carries an action out, and judges the state after it.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        action: Action,
        weather: &Weather<'_>,
        options: &Options,
        control: &RunControl,
    ) -> Result<(), EngineError> {
        control.check()?;
        let Self { stepper, state, energy_balance, limits, validity, .. } = self;
        let length = options.length(action.step());
        action.take(stepper, state, weather, length, energy_balance)?;
        control.count_step();
        let rows = action.weather_rows(weather, options.scheme);
        limits.judge(stepper, state, rows, (action, action.step()))?;
        if action != Action::Balance {
            validity.judge(stepper, state, action.step());
        }
        Ok(())
    }

    /// The run after some steps.
    pub(super) fn end(self, records: Vec<S>, steps: usize) -> Run<S> {
        let Self { stepper, state, cycles, warm_up_change, mut energy_balance, limits, validity } = self;
        energy_balance.set_content(state.heat_content(&stepper.model), steps);
        Run {
            records,
            energy_balance,
            state,
            cycles,
            warm_up_change,
            counters: stepper.counters(),
            failed: stepper.failed(),
            outside: limits.excess,
            outlier: limits.outlier,
            out_of_range: validity.found().cloned().collect(),
            beyond_validity: validity.steps(),
        }
    }
}

/// Runs a stepper; `observe` is called with each action and the state after it.
pub(crate) fn simulate_observed<'a, S: Real>(
    stepper: Stepper<'a, S>,
    weather: &Weather<'_>,
    options: &Options,
    control: &'a RunControl,
    mut observe: impl FnMut(&Stepper<'a, S>, &State<S>, Action) -> Result<(), EngineError>,
) -> Result<Run<S>, EngineError> {
    let mut course = Course::start(stepper, weather, options, control, &mut observe)?;
    let mut records = Vec::with_capacity(options.rows(weather.steps()) * options.outputs.len());
    let mut row = RecordRow::new();
    for action in Action::all(weather.steps(), options) {
        course.take(action, weather, options, control)?;
        let Course { stepper, state, .. } = &mut course;
        let of_row = (action, options, &options.outputs[..]);
        if row.add(of_row, (&stepper.readings(), state), &mut records) {
            judge_records(stepper, &options.outputs, &records, action.step())?;
        }
        observe(stepper, state, action)?;
    }
    Ok(course.end(records, weather.steps()))
}

/// Judges the last row of some records, see [`physical_limits`](crate::run::physical_limits).
#[inline(always)]
fn judge_records<S: Real>(
    stepper: &mut Stepper<'_, S>,
    outputs: &[Output],
    records: &[S],
    step: usize,
) -> Result<(), EngineError> {
    let row = &records[records.len() - outputs.len()..];
    let beyond = beyond_limits(outputs, row);
    if beyond.any() {
        if const { S::LANES == 1 } {
            let values: Vec<f64> = row.iter().map(|value| value.lane(0)).collect();
            require_limits(stepper.model.plan, outputs, &values, step)?;
        }
        stepper.mark_failed(beyond);
    }
    Ok(())
}
