//! Buildings whose walls between zones are treated as thick, beside the same buildings with all surfaces coupled at once.

use crate::building::plan::Plan;
use crate::common::random::{Case, Contents, outputs};
use crate::common::values;
use crate::derivatives::forward::jacobian;
use crate::derivatives::reverse::Trajectory;
use crate::input::forcing::Forcing;
use crate::number::lanes::Lanes;
use crate::run::outputs::Output;
use crate::run::simulate::simulate;
use crate::step::control::RunControl;

/// Walls of at least this depth count as thick here: a third of what happens at one surface reaches the other.
const DEPTH: f64 = 1.0;

/// Random buildings with thick walls: the case, the plan that couples all surfaces, and the one that does not.
fn buildings() -> impl Iterator<Item = (u64, Case, Plan, Plan)> {
    (0..30).filter_map(|seed| {
        let mut case = Case::new(seed, Contents::All);
        case.steps = 12;
        let plans = [
            Plan::new(case.description.clone()).unwrap(),
            Plan::with_thick_walls(case.description.clone(), DEPTH).unwrap(),
        ];
        let [coupled, thick] = plans;
        thick.walls.iter().any(|wall| wall.thick).then_some((seed, case, coupled, thick))
    })
}

/// Both leave the same temperatures and loads, and the same slopes of them, forward and reverse. A member in a lane has the bits
/// that it has alone.
#[test]
fn thick_walls_change_the_way_and_not_the_result() {
    let mut seen = 0;
    for (seed, case, coupled, thick) in buildings() {
        assert!(coupled.walls.iter().all(|wall| !wall.thick));
        let (numbers, rows) = (values(&coupled), case.rows(&coupled));
        let forcing = Forcing::new(&rows, case.scheme.weights().len(), coupled.n_channels()).unwrap();
        let (options, watch) = (case.options(), RunControl::default());
        let run = |plan: &Plan| simulate(plan, &numbers, &forcing, &options, &watch).unwrap();
        let (expected, found) = (run(&coupled), run(&thick));
        assert!(
            found.energy_balance.closure() < 1e-11,
            "seed {seed}: closure {:e}",
            found.energy_balance.closure()
        );
        let outputs = outputs(&case.description);
        for (k, (&a, &b)) in expected.records.iter().zip(&found.records).enumerate() {
            // Loads are as precise as the airs that they hold.
            let load =
                matches!(outputs[k % outputs.len()], Output::HeatingLoad { .. } | Output::CoolingLoad { .. });
            let apart = if load { 1e-5 * a.abs().max(1.0) } else { 1e-7 };
            assert!((a - b).abs() < apart, "seed {seed}: {a} and {b}");
        }
        let lanes: Vec<Lanes<4>> = numbers.iter().map(|&number| Lanes([number; 4])).collect();
        let in_lanes = simulate(&thick, &lanes, &forcing, &options, &watch).unwrap();
        for (&alone, lanes) in found.records.iter().zip(&in_lanes.records) {
            assert!(lanes.0.iter().all(|lane| lane.to_bits() == alone.to_bits()), "seed {seed}");
        }
        let which: Vec<usize> = (0..numbers.len()).step_by(5).collect();
        let slopes =
            |plan: &Plan| jacobian(plan, &numbers, &which, &forcing, &options, &watch).unwrap().slopes;
        close(&slopes(&coupled), &slopes(&thick), seed);
        let weights = vec![1.0; expected.records.len()];
        let gradient = |plan: &Plan| {
            let all = Trajectory::new(plan, &numbers, &forcing, &options, &watch, usize::MAX).unwrap();
            all.pull(plan, &numbers, &forcing, &options, &watch, &weights).unwrap()
        };
        close(&gradient(&coupled), &gradient(&thick), seed);
        seen += 1;
    }
    assert!(seen > 10, "{seen} buildings have thick walls");
}

fn close(expected: &[f64], found: &[f64], seed: u64) {
    let scale = expected.iter().fold(1e-9, |scale: f64, slope| scale.max(slope.abs()));
    for (a, b) in expected.iter().zip(found) {
        assert!((a - b).abs() < 1e-5 * scale, "seed {seed}: {a} and {b}, the largest is {scale}");
    }
}
