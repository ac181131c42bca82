//! The fast elimination is held to the terms of the balances: the residual of each solved stage.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::plan::Plan;
use crate::common::random::{Case, Contents as CaseContents};
use crate::common::values;
use crate::input::description::{Material, MeltingCurve, PcmLaw};
use crate::input::forcing::Forcing;
use crate::number::lanes::Lanes;
use crate::number::real::{Mask, Real};
use crate::weather::conditions::Weather;

use super::Scheme;
use super::stepper::Stepper;

/// Of the stages of a run: the largest residual of the linear system and that of the balances, with all laws at the accepted
/// temperatures, each over the largest heat flow density of its stage [-]; and the largest difference of the cells that a step ends with from those of its last stage
/// [K].
fn worst<S: Real>(case: &Case, plan: &Plan, numbers: &[S]) -> [f64; 3] {
    let rows = case.rows(plan);
    let forcing = Forcing::new(&rows, case.scheme.weights().len(), plan.n_channels()).unwrap();
    let weather = Weather::new(plan, &forcing);
    let mut stepper = Stepper::new(plan, numbers, case.scheme);
    stepper.evaluate_residuals();
    let mut state = stepper.begin(&case.options().initial, weather.row(0, 0));
    stepper.balance_surfaces(&mut state, &weather.at(0, 0)).unwrap();
    let (mut energy_balance, mut apart, mut largest) = (EnergyBalance::new(), S::zero(), S::zero());
    for step in 0..case.steps {
        stepper.step(&mut state, &weather, step, case.dt, &mut energy_balance).unwrap();
        let residuals = stepper.residuals.as_ref().unwrap();
        // What is not a number is larger than all others.
        for &relative in &residuals.relative[..case.scheme.weights().len()] {
            largest = S::select(relative.lt(largest), largest, relative);
        }
        let reached = &residuals.cells;
        apart = state.cells.iter().zip(reached).fold(apart, |apart, (&a, &b)| apart.max((a - b).abs()));
    }
    let (linear, stages) = stepper.residuals.as_ref().unwrap().linear;
    assert!(stages >= case.steps * case.scheme.weights().len());
    let failed = stepper.failed();
    let lanes = || (0..S::LANES).filter(|&lane| !failed.lane(lane));
    // What is not a number is larger than all others.
    let worst = |number: S| {
        let numbers = lanes().map(|lane| number.lane(lane));
        numbers.map(|number| if number.is_nan() { f64::INFINITY } else { number }).fold(0.0, f64::max)
    };
    [linear, largest, apart].map(worst)
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

/// Largest residual of an accepted stage over its largest heat flow density [-]. At the end of a step an ideal load moves all
/// temperatures once more, by some 1e-5 K at most: a melting curve whose slope jumps may be crossed there.
fn allowed(plan: &Plan) -> f64 {
    let tanh = |material: &Material| match material {
        Material::Pcm { law: PcmLaw::Melting { curve, .. }, .. } => {
            matches!(curve, MeltingCurve::TanhWidth { .. } | MeltingCurve::TanhGamma { .. })
        }
        Material::Pcm { .. } => false,
        _ => true,
    };
    if plan.ideal_loads.is_empty() || plan.description.materials.iter().all(tanh) { 1e-9 } else { 1e-5 }
}

/// The residual of each stage, from the terms of the balances, is below 1e-9 of the largest heat flow density: with the laws
/// as linearised for the last linear solve, and with the laws at the accepted temperatures.
#[test]
fn fast_elimination_solves_the_balances() {
    let (mut seen, mut strict, mut with_thick_walls) = ([false; 5], 0, 0);
    for seed in 0..24 {
        let mut case = Case::new(seed, CaseContents::All);
        case.steps = 8;
        let plan = case.plan();
        for (seen, contains) in seen.iter_mut().zip(contents(&case, &plan)) {
            *seen |= contains;
        }
        let numbers = values(&plan);
        let thick = Plan::with_thick_walls(case.description.clone(), 1.0).unwrap();
        if thick.walls.iter().any(|wall| wall.thick) {
            let [residual, of_laws, apart] = worst::<f64>(&case, &thick, &numbers);
            // Loads are searched for with linear systems that lack a little of the heat through these walls.
            assert!(
                residual < 1e-9 || !plan.ideal_loads.is_empty(),
                "seed {seed}, thick walls: {residual:e}"
            );
            assert!(apart < 1e-9, "seed {seed}, thick walls: cells differ by {apart:e} K");
            assert!(of_laws < allowed(&plan), "seed {seed}, thick walls: residual of the laws {of_laws:e}");
            with_thick_walls += 1;
        }
        let most = allowed(&plan);
        strict += usize::from(most < 1e-8);
        let [residual, of_laws, apart] = worst::<f64>(&case, &plan, &numbers);
        assert!(residual < 1e-9, "seed {seed}: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed}: cells differ by {apart:e} K");
        assert!(of_laws > 0.0 && of_laws < most, "seed {seed}: residual of the laws {of_laws:e}");
        let lanes: Vec<Lanes<4>> = numbers
            .iter()
            .map(|&number| Lanes(core::array::from_fn(|lane| number * (1.0 + 1e-3 * lane as f64))))
            .collect();
        let [residual, of_laws, apart] = worst(&case, &plan, &lanes);
        assert!(residual < 1e-9, "seed {seed} in lanes: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed} in lanes: cells differ by {apart:e} K");
        assert!(of_laws < most, "seed {seed} in lanes: residual of the laws {of_laws:e}");
    }
    assert!(with_thick_walls > 3, "{with_thick_walls} plans have thick walls");
    assert!(strict > 5, "{strict} plans have the strict bound");
    assert_eq!(seen, [true; 5], "the plans leave out a part of a building");
}
