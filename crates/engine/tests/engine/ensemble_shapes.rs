//! Ensembles of unusual shapes: without outputs, without members, without recorded rows.

use crate::common::{cell, cell_outputs, cell_weather, forcing, options, run, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Options;
use mascarin_engine::run::ensemble::{Ensemble, ensemble};
use mascarin_engine::run::outputs::Output;

const STEP: f64 = 900.0;
const STEPS: usize = 6;

fn alike(
    count: usize,
    outputs: Vec<Output>,
    record_from: usize,
) -> (Ensemble, Plan, Vec<f64>, Options, usize) {
    let plan = Plan::new(cell(0.04)).unwrap();
    let scheme = Scheme::Sdirk2;
    let rows = forcing(&plan, scheme, STEPS, STEP, cell_weather);
    let options = Options { record_from, ..options(scheme, STEP, outputs) };
    let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
    let members = values(&plan).repeat(count);
    let watch = RunControl::default();
    let result = ensemble(&plan, &members, &drive, &options, &watch).unwrap();
    let done = watch.done.into_inner();
    (result, plan, rows, options, done)
}

/// Members without outputs are run: their energy-balance residuals are those of runs alone.
#[test]
fn members_run_without_outputs() {
    let (result, plan, rows, options, done) = alike(11, Vec::new(), 0);
    assert_eq!((result.records.len(), result.closure.len(), done), (0, 11, 11));
    assert!(result.failures.is_empty());
    let alone = run(&plan, &rows, &options).energy_balance.closure();
    assert!(alone > 0.0 && alone < 1e-12);
    assert!(
        result.closure.iter().all(|closure| closure.to_bits() == alone.to_bits()),
        "{:?}",
        result.closure
    );
}

/// No member gives empty arrays.
#[test]
fn no_member_is_an_empty_ensemble() {
    let (result, .., done) = alike(0, cell_outputs(), 0);
    assert_eq!((result.records.len(), result.closure.len(), result.failures.len(), done), (0, 0, 0, 0));
}

/// A record that would begin after the end has no rows, alone and in an ensemble.
#[test]
fn a_record_after_the_end_has_no_rows() {
    for (record_from, expected) in [(STEPS, 1), (STEPS + 1, 0)] {
        let (result, plan, rows, options, _) = alike(3, cell_outputs(), record_from);
        assert_eq!(options.rows(STEPS), expected);
        assert_eq!(result.records.len(), 3 * expected * cell_outputs().len());
        assert_eq!(run(&plan, &rows, &options).records.len(), expected * cell_outputs().len());
        assert!(result.failures.is_empty() && result.closure.iter().all(|closure| *closure < 1e-12));
    }
}
