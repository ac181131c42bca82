//! Forward derivatives: a run and the slopes of its records by some parameters.

use core::sync::atomic::Ordering;

use rayon::prelude::*;

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::number::dual::Dual;
use crate::number::real::Real;
use crate::run::options::Options;
use crate::run::records::RecordRow;
use crate::run::simulate::simulate_observed;
use crate::step::Stepper;
use crate::step::control::RunControl;
use crate::step::state::State;
use crate::weather::conditions::Weather;

use super::kept_steps::{KeptRun, StepKeeper, keep_period};
use super::periodic_slopes::settle;
use super::stored_steps::DerivativeStepper;

/// Records of a run and their slopes.
#[derive(Debug)]
pub struct Jacobian {
    /// Rows x outputs.
    pub records: Vec<f64>,
    /// Chosen parameters or directions x rows x outputs [unit of the record / unit of the parameter].
    pub slopes: Vec<f64>,
}

/// Parameters that change together: their positions, and how much each changes.
pub type Direction = Vec<(usize, f64)>;

/// Runs a plan and computes the slopes of all its records by the parameters `which`, on all threads.
///
/// # Errors
/// As [`slopes_along`].
pub fn jacobian(
    plan: &Plan,
    numbers: &[f64],
    which: &[usize],
    forcing: &Forcing<'_>,
    options: &Options,
    watch: &RunControl,
) -> Result<Jacobian, EngineError> {
    let directions: Vec<Direction> = which.iter().map(|&k| vec![(k, 1.0)]).collect();
    slopes_along(plan, numbers, &directions, forcing, options, watch)
}

/// Runs a plan and computes the slopes of all its records along directions of the parameters, on all threads.
///
/// # Errors
/// As [`simulate`](crate::run::simulate::simulate); [`EngineError::Input`] also for a parameter that does not exist.
pub fn slopes_along(
    plan: &Plan,
    numbers: &[f64],
    directions: &[Direction],
    forcing: &Forcing<'_>,
    options: &Options,
    watch: &RunControl,
) -> Result<Jacobian, EngineError> {
    options.check(plan, numbers.len(), forcing)?;
    if directions.is_empty() || directions.iter().flatten().any(|&(k, _)| k >= numbers.len()) {
        return Err(EngineError::Input(format!(
            "derivatives by parameters {directions:?}: give at least one, each below {}",
            numbers.len()
        )));
    }
    let weather = Weather::new(plan, forcing);
    // All groups of a thread use the solutions of one plain run.
    let share = GROUP * directions.len().div_ceil(GROUP).div_ceil(rayon::current_num_threads());
    let parts: Vec<_> = directions
        .par_chunks(share)
        .map(|some| {
            let part = run_with_slopes(plan, numbers, some, &weather, options, watch);
            watch.done.fetch_add(some.len(), Ordering::Relaxed);
            part
        })
        .collect::<Result<_, _>>()?;
    let groups: Vec<_> = parts.into_iter().flatten().collect();
    let records = groups[0].records.iter().map(|record| record.value).collect();
    let mut slopes = Vec::with_capacity(directions.len() * groups[0].records.len());
    for group in &groups {
        for k in 0..group.parameters {
            slopes.extend(group.records.iter().map(|record| record.slope[k]));
        }
    }
    Ok(Jacobian { records, slopes })
}

/// Number of parameters whose slopes are computed together.
const GROUP: usize = 8;

/// A number with its slopes by the parameters of a group.
type Sloped = Dual<GROUP>;

/// The slopes of a group during a run.
struct Group<'a> {
    stepper: DerivativeStepper<'a, Sloped>,
    state: State<Sloped>,
    slopes: Slopes,
}

/// What a group has recorded.
struct Slopes {
    parameters: usize,
    row: RecordRow<Sloped>,
    records: Vec<Sloped>,
}

/// A plain run; after each of its steps, the slopes of the same step by each group of parameters.
fn run_with_slopes(
    plan: &Plan,
    numbers: &[f64],
    by: &[Direction],
    weather: &Weather<'_>,
    options: &Options,
    watch: &RunControl,
) -> Result<Vec<Slopes>, EngineError> {
    let sloped = |group: &[Direction]| {
        let mut sloped: Vec<_> = numbers.iter().map(|&value| Sloped::constant(value)).collect();
        for (which, direction) in group.iter().enumerate() {
            for &(by, weight) in direction {
                sloped[by].slope[which] += weight;
            }
        }
        (sloped, group.len())
    };
    let vectors: Vec<_> = by.chunks(GROUP).map(sloped).collect();
    let mut groups: Vec<_> = vectors
        .iter()
        .map(|(numbers, parameters)| {
            let stepper = DerivativeStepper::of_run(plan, numbers, options);
            let state = stepper.linearized_stepper.begin(&options.initial, weather.row(0, 0));
            Group {
                state,
                stepper,
                slopes: Slopes { parameters: *parameters, row: RecordRow::new(), records: Vec::new() },
            }
        })
        .collect();
    let mut plain = Stepper::new(plan, numbers, options.scheme.converged());
    plain.known.start();
    let run = KeptRun { plan, numbers, weather, options };
    let mut period: Option<StepKeeper> = None;
    simulate_observed(plain, weather, options, watch, |plain, reached, action| {
        if keep_period(&mut period, action, plain, reached, options) {
            return Ok(());
        }
        if let Some(mut keeper) = period.take() {
            let (steps, _) = keeper.finish();
            for Group { stepper, state, .. } in &mut groups {
                settle(stepper, state, (&steps, &keeper.reached), run, watch)?;
                state.change_by(&keeper.reached, |number, value| number.value = value);
            }
        }
        for Group { stepper, state, slopes } in &mut groups {
            stepper.take(action, state, weather, options.length(action.step()), &plain.known);
            // The values are those of the plain run, as in reverse: rounding and tolerances must not add up.
            state.change_by(reached, |number, value| number.value = value);
            let read = (&stepper.linearized_stepper.readings(), &*state);
            slopes.row.add((action, options, &options.outputs), read, &mut slopes.records);
        }
        Ok(())
    })?;
    Ok(groups.into_iter().map(|group| group.slopes).collect())
}
