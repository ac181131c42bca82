//! A run that hands its records over in blocks of rows while it goes on, and takes its forcing in blocks of steps, so that both take the
//! memory of one block only.

use core::ops::Range;

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::input::forcing::{Forcing, ForcingBlocks};
use crate::run::action::Action;
use crate::run::options::Options;
use crate::run::output_limits::require_limits;
use crate::run::outputs::Output;
use crate::run::records::RecordRow;
use crate::run::simulate::{Course, Run};
use crate::step::control::RunControl;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Runs a plan at a parameter vector as [`simulate`](crate::run::simulate::simulate), and gives `take` the records in blocks of `rows` rows, the
/// last one with what is left. The records of the finished run are empty. A repeated first period must lie within the first block of the
/// forcing; steps of unequal length need a forcing of one block.
///
/// # Errors
/// Those of `simulate`, and those of `take` and of the forcing, which end the run.
pub fn simulate_in_blocks(
    plan: &Plan,
    parameters: &[f64],
    forcing: &mut ForcingBlocks<'_>,
    options: &Options,
    control: &RunControl,
    rows: usize,
    take: impl FnMut(Vec<f64>) -> Result<(), EngineError>,
) -> Result<Run<f64>, EngineError> {
    let (first, steps) = (forcing.first(), forcing.steps());
    options.check(plan, parameters.len(), &first)?;
    if first.steps() > steps || (options.lengths.is_some() && first.steps() < steps) {
        return Err(EngineError::Input(format!(
            "the first block of the forcing has {} steps of {steps}; with steps of unequal length it has all",
            first.steps()
        )));
    }
    // The blocks are the only records.
    let bare = Options { outputs: Vec::new(), ..options.clone() };
    let mut stepper = Stepper::new(plan, parameters, options.scheme);
    if options.outputs.iter().any(Output::averages_absorbed_sun) {
        stepper.average_absorbed_sun();
    }
    let repeated = options.warmup.as_ref().map_or(0, |warmup| warmup.steps);
    let weather = Weather::for_single_run(plan, &first, repeated);
    let course = Course::start(stepper, &weather, &bare, control, &mut |_, _, _| Ok(()))?;
    let rows = rows.clamp(1, options.rows(steps).max(1));
    let (block, row) = (Vec::new(), RecordRow::new());
    let mut run = Streamed { plan, options, control, course, rows, block, filled: 0, row, take };
    run.go_through(&weather, 0..first.steps())?;
    drop(weather);
    let mut done = first.steps();
    while done < steps {
        let values = forcing.after(done)?;
        let part = Forcing::new(&values, first.stages(), first.channels())?;
        let weather = Weather::from_step(plan, &part, done);
        let end = done + part.steps();
        run.go_through(&weather, done..end)?;
        done = end;
    }
    run.end(steps)
}

/// A run on its way whose records are handed over in blocks.
struct Streamed<'a, T> {
    plan: &'a Plan,
    options: &'a Options,
    control: &'a RunControl,
    course: Course<'a, f64>,
    /// Rows of a block.
    rows: usize,
    block: Vec<f64>,
    /// Rows in the block.
    filled: usize,
    row: RecordRow<f64>,
    take: T,
}

impl<T: FnMut(Vec<f64>) -> Result<(), EngineError>> Streamed<'_, T> {
    /// Takes the run through some steps in their weather.
    // One copy only: the steps are inlined into it.
    #[inline(never)]
    fn go_through(&mut self, weather: &Weather<'_>, steps: Range<usize>) -> Result<(), EngineError> {
        for action in Action::over(steps, self.options) {
            self.course.take(action, weather, self.options, self.control)?;
            self.record(action)?;
        }
        Ok(())
    }

    /// Adds the state after an action to the block, and hands a full block over.
    #[inline(always)]
    fn record(&mut self, action: Action) -> Result<(), EngineError> {
        let Self { plan, options, course, rows, block, filled, row, take, .. } = self;
        let outputs = &options.outputs;
        block.reserve(if *filled == 0 { *rows * outputs.len() } else { 0 });
        let reached = (&course.stepper.readings(), &course.state);
        if !row.add((action, options, outputs), reached, block) {
            return Ok(());
        }
        require_limits(plan, outputs, &block[block.len() - outputs.len()..], action.step())?;
        *filled += 1;
        if *filled < *rows {
            return Ok(());
        }
        *filled = 0;
        take(core::mem::take(block))
    }

    /// Hands over what is left, and ends the run.
    fn end(mut self, steps: usize) -> Result<Run<f64>, EngineError> {
        if self.filled > 0 {
            (self.take)(self.block)?;
        }
        Ok(self.course.end(Vec::new(), steps))
    }
}
