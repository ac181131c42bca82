//! Ensembles at the ends: without outputs, without members.

use crate::common::{cell, cell_outputs, cell_weather, forcing, options, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::{Ensemble, ensemble};
use mascarin_engine::run::outputs::Output;

fn members(count: usize, outputs: Vec<Output>) -> (Ensemble, usize) {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 10, 900.0, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let (numbers, watch) = (values(&plan).repeat(count), RunControl::default());
    let result = ensemble(&plan, &numbers, &drive, &options(Scheme::Sdirk2, 900.0, outputs), &watch).unwrap();
    (result, watch.done.into_inner())
}

/// Members without outputs are run: each has its energy balance.
#[test]
fn members_without_outputs_are_run() {
    for count in [1, 3, 20] {
        let ((with, _), (without, done)) = (members(count, cell_outputs()), members(count, Vec::new()));
        assert!(without.records.is_empty() && without.failures.is_empty());
        assert_eq!(done, count);
        assert_eq!(without.closure, with.closure, "{count} members");
        assert!(without.closure.iter().all(|closure| closure.is_finite()));
    }
}

/// No members give no records, no residuals and no failures.
#[test]
fn no_members_give_nothing() {
    for outputs in [Vec::new(), cell_outputs()] {
        let (result, done) = members(0, outputs);
        assert!(result.records.is_empty() && result.closure.is_empty() && result.failures.is_empty());
        assert_eq!(done, 0);
    }
}
