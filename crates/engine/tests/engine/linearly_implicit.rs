//! The scheme with one linear solve a stage: where it is exact, how far it is from the solutions of its equations, and how
//! many solves it takes.

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::linear::{cell_of_linear_laws, linear_cell};
use crate::common::melting::{ceiling, ceiling_weather};
use crate::common::{cell, cell_outputs, cell_weather, forcing, options, run};
use mascarin_engine::Scheme;
use mascarin_engine::description::Description;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Run;
use mascarin_engine::run::outputs::Output;

const STEP: f64 = 900.0;
const DAYS: usize = 6;

/// The same run with the stages of SDIRK2 solved to the end, and by one linear solve each.
fn both(
    description: Description,
    weather: fn(f64, &mut [f64]),
    outputs: impl Fn() -> Vec<Output>,
) -> [Run<f64>; 2] {
    let plan = Plan::new(description).unwrap();
    [Scheme::Sdirk2, Scheme::LinearlyImplicit].map(|scheme| {
        let rows = forcing(&plan, scheme, DAYS * 96, STEP, weather);
        run(&plan, &rows, &options(scheme, STEP, outputs()))
    })
}

/// Root mean square, and the largest, of the difference of a record in both runs, without the first day.
fn apart([whole, linear]: &[Run<f64>; 2], output: usize, outputs: usize) -> [f64; 2] {
    let of = |run: &Run<f64>| -> Vec<f64> {
        run.records[96 * outputs..].iter().skip(output).step_by(outputs).copied().collect()
    };
    let differences: Vec<f64> = of(whole).iter().zip(of(linear)).map(|(a, b)| a - b).collect();
    let sum: f64 = differences.iter().map(|difference| difference * difference).sum();
    [(sum / differences.len() as f64).sqrt(), differences.iter().fold(0.0, |most, d| d.abs().max(most))]
}

/// Solves of a stage.
fn solves(run: &Run<f64>) -> f64 {
    run.counters.iterations as f64 / (2 * DAYS * 96) as f64
}

/// Where all laws are linear, one solve is the solution: both runs are the same to rounding.
#[test]
fn linear_laws_are_solved_exactly() {
    let runs = both(linear_cell(), cell_weather, || vec![Output::AirTemperature { zone: 0 }]);
    let [_, most] = apart(&runs, 0, 1);
    assert!(most < 1e-10, "{most} K");
    assert!(solves(&runs[1]) < 1.05, "{} solves a stage", solves(&runs[1]));
}

/// A cell with a phase-change ceiling: one solve in most stages, and thousandths of a kelvin.
#[test]
fn a_cell_is_within_thousandths_of_a_kelvin() {
    for description in [cell(1.0), cell_of_linear_laws(false)] {
        let runs = both(description, cell_weather, cell_outputs);
        let outputs = cell_outputs().len();
        let [rms, most] = apart(&runs, 0, outputs);
        assert!(rms > 0.0 && rms < 2e-3 && most < 0.03, "{rms} K, at most {most} K");
        assert!(solves(&runs[1]) < 1.6 && solves(&runs[0]) >= 2.0, "{} solves a stage", solves(&runs[1]));
    }
}

/// Where melting is sharp and the temperatures jump, more solves are made, and the heat is conserved.
#[test]
fn jumps_take_more_solves() {
    for gamma in [1.0, 0.04] {
        let runs = both(ceiling(gamma), ceiling_weather, || vec![Output::AirTemperature { zone: 0 }]);
        let [rms, most] = apart(&runs, 0, 1);
        assert!(rms < 5e-3 && most < 0.05, "{rms} K, at most {most} K, gamma {gamma}");
        assert!(runs[1].energy_balance.closure() < 1e-10, "{:?}", runs[1].energy_balance);
        assert!(runs[1].counters.iterations < runs[0].counters.iterations);
    }
}

/// Ideal loads that begin, end and reach their capacity each day: the sum of the heat is the same within half a per cent. (Where loads change
/// slowly, it is the same within a ten-thousandth, see docs/speed.md.)
#[test]
fn ideal_loads_give_the_same_heat() {
    let runs = both(conditioned(1.0), conditioned_weather, conditioned_outputs);
    let outputs = conditioned_outputs().len();
    let heat =
        |run: &Run<f64>, output: usize| -> f64 { run.records.iter().skip(output).step_by(outputs).sum() };
    for (k, output) in conditioned_outputs().iter().enumerate() {
        if let Output::HeatingLoad { .. } | Output::CoolingLoad { .. } = output {
            let [whole, linear] = [heat(&runs[0], k), heat(&runs[1], k)];
            assert!((linear - whole).abs() <= 5e-3 * whole, "{linear} is not {whole}: {output:?}");
        }
    }
    assert!(runs[1].energy_balance.closure() < 1e-10, "{:?}", runs[1].energy_balance);
    assert!(solves(&runs[1]) < 0.85 * solves(&runs[0]));
}
