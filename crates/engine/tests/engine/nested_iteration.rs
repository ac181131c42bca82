//! What the nested iteration and halved steps arrive at.

use crate::common::difficult::{Step, all_steps};
use crate::common::{try_run, values};
use mascarin_engine::Scheme;
use mascarin_engine::run::Options;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::state::Initial;

const SCHEMES: [Scheme; 2] = [Scheme::BackwardEuler, Scheme::Sdirk2];

/// Without hysteresis the enthalpy of a state is that of its temperatures.
#[test]
fn enthalpies_are_those_of_the_temperatures() {
    let mut wrong = Vec::new();
    for scheme in SCHEMES {
        for step in [false, true].into_iter().flat_map(|heated| all_steps(scheme, heated)) {
            let enthalpies = |initial: Initial| {
                let outputs = (0..3).map(|surface| Output::LayerEnthalpy { surface, layer: 0 }).collect();
                let options = Options { initial, outputs, ..step.options(1) };
                try_run(&step.plan, &values(&step.plan), &step.rows, &options).unwrap()
            };
            let run = enthalpies(step.initial.clone());
            let state = &run.state;
            let (cells, surfaces, air) = (state.cells.clone(), state.surfaces.to_vec(), state.air.clone());
            // A run starts with the enthalpies of its temperatures [J/m3].
            let restarted = enthalpies(Initial::Given { cells, surfaces, air });
            for (reached, of_temperature) in run.records[3..].iter().zip(&restarted.records) {
                // Within 1e-6 K in a melting range of 2 mK.
                if (reached - of_temperature).abs() > 1e5 {
                    let (halved, nested) = (run.counters.halvings, run.counters.nested);
                    wrong.push(format!(
                        "{} (halved {halved}, nested {nested}): {reached:e} J/m3, of its temperatures {of_temperature:e}",
                        step.name
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Steps that Newton's iteration alone does not solve are solved: of some 1e4 W, less than 1 mW is missing in their balances. With backward Euler, which
/// keeps the maximum principle, they end near where 64 short ones end.
#[test]
fn difficult_steps_are_solved() {
    let mut nested = 0;
    for scheme in SCHEMES {
        for step in all_steps(scheme, false).into_iter().filter(Step::is_difficult) {
            let (plan, numbers) = (&step.plan, values(&step.plan));
            let options = Options { residuals: true, ..step.options(1) };
            let run = try_run(plan, &numbers, &step.rows, &options).unwrap();
            let missing = run.counters.largest_residual.unwrap();
            // A cell on the very edge of its melting range is accepted by its change, 1e-6 K.
            assert!(missing < 1e-3, "{}: {missing:e} W are missing", step.name);
            nested += run.counters.nested;
            if scheme == Scheme::Sdirk2 {
                continue;
            }
            let short = try_run(plan, &numbers, &step.rows.repeat(64), &step.options(64)).unwrap();
            let surfaces = run.state.surfaces.iter().zip(short.state.surfaces.iter());
            let apart = surfaces.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(apart < 5.0, "{}: {apart} K", step.name);
        }
    }
    assert!(nested > 2, "the nested iteration solved {nested} stages only");
}
