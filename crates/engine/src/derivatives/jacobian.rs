//! Forward derivatives: a run, and its records' slopes by some parameters.

use core::sync::atomic::Ordering;

use rayon::prelude::*;

use crate::drive::Weather;
use crate::error::EngineError;
use crate::forcing::Forcing;
use crate::ledger::Ledger;
use crate::march::{Options, Watch, check, march_seen};
use crate::plan::Plan;
use crate::real::Dual;
use crate::step::Stepper;

/// Records of a run and their slopes.
#[derive(Debug)]
pub struct Jacobian {
    /// Rows x probes.
    pub records: Vec<f64>,
    /// Parameters asked for x rows x probes [unit of the record / unit of the parameter].
    pub slopes: Vec<f64>,
}

/// Runs a plan and the slopes of all its records by the parameters `which`, on as many threads as there are.
///
/// # Errors
/// As [`march`](crate::march::march); [`EngineError::Input`] also for a parameter that does not exist.
pub fn jacobian(
    plan: &Plan,
    numbers: &[f64],
    which: &[usize],
    forcing: &Forcing<'_>,
    options: &Options,
    watch: &Watch,
) -> Result<Jacobian, EngineError> {
    check(plan, numbers.len(), forcing, options)?;
    if which.is_empty() || which.iter().any(|&k| k >= numbers.len()) {
        return Err(EngineError::Input(format!(
            "derivatives by parameters {which:?}: give at least one, each below {}",
            numbers.len()
        )));
    }
    let weather = Weather::new(plan, forcing);
    let parts: Vec<_> = which
        .par_iter()
        .map(|&by| {
            let part = along(plan, numbers, by, &weather, options, watch);
            watch.done.fetch_add(1, Ordering::Relaxed);
            part
        })
        .collect::<Result<_, _>>()?;
    let records = parts[0].iter().map(|record| record.value).collect();
    let slopes = parts.iter().flatten().map(|record| record.slope[0]).collect();
    Ok(Jacobian { records, slopes })
}

/// A number with its slope by the parameter in hand.
type Sloped = Dual<f64, 1>;

/// Runs plain numbers, and beside them those with slopes, which take each step by one linear solve at its solution.
fn along(
    plan: &Plan,
    numbers: &[f64],
    by: usize,
    weather: &Weather<'_>,
    options: &Options,
    watch: &Watch,
) -> Result<Vec<Sloped>, EngineError> {
    let mut sloped: Vec<_> = numbers.iter().map(|&value| Sloped::fixed(value)).collect();
    sloped[by] = Sloped::variable(numbers[by], 0);
    let mut stepper = Stepper::new(plan, &sloped, options.scheme);
    let mut state = stepper.begin(&options.initial);
    let mut records = Vec::with_capacity(options.rows(weather.steps()) * options.probes.len());
    let mut unused = Ledger::new();
    let mut plain = Stepper::new(plan, numbers, options.scheme);
    plain.known.start();
    march_seen(plain, weather, options, watch, |plain, reached, made| {
        stepper.known.follow(plain.known.solution(&reached.load));
        made.make(&mut stepper, &mut state, weather, options.dt, &mut unused)?;
        // Rounding and tolerances must not add up: the slopes are those along the plain run, as in reverse.
        let mut values = reached.numbers();
        state = state.map(|number| Sloped { value: values.next().unwrap_or(number.value), ..number });
        if made.row(options).is_some() {
            records.extend(options.probes.iter().map(|probe| probe.read(plan, &stepper, &state)));
        }
        Ok(())
    })?;
    Ok(records)
}
