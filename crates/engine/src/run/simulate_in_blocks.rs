//! A run that hands its records over in blocks of rows while it goes on, so that they take the memory of one block only.

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::Forcing;
use crate::run::options::Options;
use crate::run::output_limits::require_limits;
use crate::run::outputs::Output;
use crate::run::records::RecordRow;
use crate::run::simulate::{Run, simulate_observed};
use crate::step::control::RunControl;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Runs a plan at a parameter vector as [`simulate`](crate::run::simulate::simulate), and gives `take` the records in blocks of `rows` rows, the
/// last one with what is left. The records of the finished run are empty.
///
/// # Errors
/// Those of `simulate`, and those of `take`, which end the run.
pub fn simulate_in_blocks(
    plan: &Plan,
    parameters: &[f64],
    forcing: &Forcing<'_>,
    options: &Options,
    control: &RunControl,
    rows: usize,
    mut take: impl FnMut(Vec<f64>) -> Result<(), EngineError>,
) -> Result<Run<f64>, EngineError> {
    options.check(plan, parameters.len(), forcing)?;
    let outputs = &options.outputs;
    // The blocks are the only records.
    let bare = Options { outputs: Vec::new(), ..options.clone() };
    let mut stepper = Stepper::new(plan, parameters, options.scheme);
    if outputs.iter().any(Output::averages_absorbed_sun) {
        stepper.average_absorbed_sun();
    }
    let repeated = options.warmup.as_ref().map_or(0, |warmup| warmup.steps);
    let weather = Weather::for_single_run(plan, forcing, repeated);
    let rows = rows.clamp(1, options.rows(forcing.steps()).max(1));
    let (mut block, mut filled, mut row) = (Vec::new(), 0, RecordRow::new());
    let run = simulate_observed(stepper, &weather, &bare, control, |stepper, state, action| {
        block.reserve(if filled == 0 { rows * outputs.len() } else { 0 });
        if !row.add((action, options, outputs), (&stepper.readings(), state), &mut block) {
            return Ok(());
        }
        require_limits(plan, outputs, &block[block.len() - outputs.len()..], action.step())?;
        filled += 1;
        if filled < rows {
            return Ok(());
        }
        filled = 0;
        take(core::mem::take(&mut block))
    })?;
    if filled > 0 {
        take(block)?;
    }
    Ok(run)
}
