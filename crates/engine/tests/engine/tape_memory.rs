//! Reverse derivatives leave no memory behind, whether they succeed, fail or panic.

use core::sync::atomic::Ordering;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::common::{cell, cell_outputs, cell_weather, forcing, options, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::tape;
use mascarin_engine::plan::Plan;

const STEPS: usize = 12;

#[test]
fn the_tape_is_empty_after_a_gradient_an_error_and_a_panic() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let numbers = values(&plan);
    let rows = forcing(&plan, Scheme::Sdirk2, STEPS, 900.0, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(Scheme::Sdirk2, 900.0, cell_outputs());
    let trajectory =
        Trajectory::new(&plan, &numbers, &drive, &options, &RunControl::default(), usize::MAX).unwrap();
    let weights = vec![1.0; trajectory.run.records.len()];
    let pull = |drive: &Forcing<'_>, watch: &RunControl| {
        trajectory.pull(&plan, &numbers, drive, &options, watch, &weights)
    };

    let slopes = pull(&drive, &RunControl::default()).unwrap();
    assert!(slopes.iter().any(|&slope| slope != 0.0));
    assert_eq!(tape::memory(), 0, "after a gradient");

    let watch = RunControl::default();
    watch.stop.store(true, Ordering::Relaxed);
    assert!(matches!(pull(&drive, &watch), Err(EngineError::Interrupted)));
    assert_eq!(tape::memory(), 0, "after an error");

    // The weather of the first half of the run only: the last step has none.
    let half = Forcing::new(&rows[..rows.len() / 2], 2, plan.n_channels()).unwrap();
    assert!(catch_unwind(AssertUnwindSafe(|| pull(&half, &RunControl::default()))).is_err());
    assert_eq!(tape::memory(), 0, "after a panic");
    assert_eq!(pull(&drive, &RunControl::default()).unwrap(), slopes, "the next gradient is not affected");
}
