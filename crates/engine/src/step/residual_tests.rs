//! The fast elimination is held to the terms of the balances: the residual of each solved stage.

use crate::balance::ledger::Ledger;
use crate::building::plan::Plan;
use crate::common::random::{Case, Contents as CaseContents};
use crate::common::values;
use crate::input::forcing::Forcing;
use crate::number::lanes::Lanes;
use crate::number::real::{Mask, Real};
use crate::weather::conditions::Weather;

use super::Scheme;
use super::stepper::Stepper;

/// Of the stages of a run: the largest residual of the linear system over its largest heat flow density [-], the largest
/// residual of the balances [W], and the largest difference of the cells that a step ends with from those of its last stage
/// [K].
fn worst<S: Real>(case: &Case, plan: &Plan, numbers: &[S]) -> [f64; 3] {
    let rows = case.rows(plan);
    let forcing = Forcing::new(&rows, case.scheme.weights().len(), plan.n_channels()).unwrap();
    let weather = Weather::new(plan, &forcing);
    let mut stepper = Stepper::new(plan, numbers, case.scheme);
    stepper.evaluate_residuals();
    let mut state = stepper.begin(&case.options().initial);
    stepper.balance_surfaces(&mut state, &weather.at(0, 0)).unwrap();
    let (mut ledger, mut apart) = (Ledger::new(), S::zero());
    for step in 0..case.steps {
        stepper.step(&mut state, &weather, step, case.dt, &mut ledger).unwrap();
        let reached = &stepper.residuals.as_ref().unwrap().cells;
        apart = state.cells.iter().zip(reached).fold(apart, |apart, (&a, &b)| apart.max((a - b).abs()));
    }
    let (linear, stages) = stepper.residuals.as_ref().unwrap().linear;
    assert!(stages >= case.steps * case.scheme.weights().len());
    let failed = stepper.failed();
    let lanes = || (0..S::LANES).filter(|&lane| !failed.lane(lane));
    // What is not a number is larger than all others.
    let largest = |number: S| {
        let numbers = lanes().map(|lane| number.lane(lane));
        numbers.map(|number| if number.is_nan() { f64::INFINITY } else { number }).fold(0.0, f64::max)
    };
    [linear, stepper.counters().largest_residual.unwrap(), apart].map(largest)
}

/// Parts of a building and of a scheme that random plans have to contain.
fn contents(case: &Case, plan: &Plan) -> [bool; 5] {
    [
        !plan.windows.is_empty(),
        plan.walls.iter().any(|wall| wall.nonlinear && wall.glass.is_none()),
        !plan.ideal_loads.is_empty(),
        !plan.description.air_paths.is_empty(),
        case.scheme == Scheme::Sdirk2,
    ]
}

/// The residual of each stage, from the terms of the balances, is below 1e-9 of the largest heat flow density, with the laws
/// as linearised for the last linear solve; with the laws at the solution it is what the last change has left.
#[test]
fn fast_elimination_solves_the_balances() {
    let mut seen = [false; 5];
    for seed in 0..24 {
        let mut case = Case::new(seed, CaseContents::All);
        case.steps = 8;
        let plan = case.plan();
        for (seen, contains) in seen.iter_mut().zip(contents(&case, &plan)) {
            *seen |= contains;
        }
        let numbers = values(&plan);
        let [residual, heat, apart] = worst::<f64>(&case, &plan, &numbers);
        assert!(residual < 1e-9, "seed {seed}: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed}: cells differ by {apart:e} K");
        assert!(heat > 0.0 && heat < 1e-2, "seed {seed}: {heat:e} W are missing");
        let lanes: Vec<Lanes<4>> = numbers
            .iter()
            .map(|&number| Lanes(core::array::from_fn(|lane| number * (1.0 + 1e-3 * lane as f64))))
            .collect();
        let [residual, heat, apart] = worst(&case, &plan, &lanes);
        assert!(residual < 1e-9, "seed {seed} in lanes: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed} in lanes: cells differ by {apart:e} K");
        assert!(heat > 0.0 && heat < 1e-2, "seed {seed}: {heat:e} W are missing");
    }
    assert_eq!(seen, [true; 5], "the plans leave out a part of a building");
}
