//! Runs that are taken on step by step.

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::melting::{melting, melting_weather};
use crate::common::{ALL_SCHEMES, forcing, options, run, values, warmup};
use mascarin_engine::Scheme;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Options;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::stepwise::StepByStep;

const STEP: f64 = 900.0;
const STEPS: usize = 96;

/// Records now, and after each step of some weather.
fn records(run: &mut StepByStep<'_>, rows: &[f64], stages: usize, channels: usize) -> Vec<f64> {
    let (mut all, mut one) = (Vec::new(), Vec::new());
    run.read(&mut one);
    all.extend_from_slice(&one);
    for row in rows.chunks(stages * channels) {
        run.step(&Forcing::new(row, stages, channels).unwrap()).unwrap();
        run.read(&mut one);
        all.extend_from_slice(&one);
    }
    all
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

/// Ideal loads in two zones, and phase change with hysteresis and supercooling; periodic and uniform starts.
fn cases(scheme: Scheme) -> Vec<(Plan, Vec<f64>, Options)> {
    let mut found = Vec::new();
    for warmup in [None, Some(warmup(STEP))] {
        let plan = Plan::new(conditioned(0.04)).unwrap();
        let rows = forcing(&plan, scheme, STEPS, STEP, conditioned_weather);
        found.push((plan, rows, Options { warmup, ..options(scheme, STEP, conditioned_outputs()) }));
        for law in ["curve_track", "supercooling"] {
            let plan = Plan::new(melting(Some(law))).unwrap();
            let rows = forcing(&plan, scheme, STEPS, STEP, melting_weather);
            let outputs = vec![Output::AirTemperature { zone: 0 }, Output::FaceFlux { surface: 0, side: 1 }];
            found.push((plan, rows, Options { warmup, ..options(scheme, STEP, outputs) }));
        }
    }
    found
}

/// The bits of a whole run, also after a state has been saved and restored in another run.
#[test]
fn steps_are_those_of_a_run() {
    for scheme in ALL_SCHEMES {
        let stages = scheme.weights().len();
        for (plan, rows, options) in cases(scheme) {
            let (channels, numbers) = (plan.n_channels(), values(&plan));
            let row = stages * channels;
            let start = || {
                let all = Forcing::new(&rows, stages, channels).unwrap();
                let first = Forcing::new(&rows[..row], stages, channels).unwrap();
                StepByStep::start(&plan, &numbers, &options, &all, &first).unwrap()
            };
            let whole = run(&plan, &rows, &options);
            let mut stepwise = start();
            let found = records(&mut stepwise, &rows, stages, channels);
            assert_eq!(bits(&found), bits(&whole.records));
            assert_eq!(stepwise.steps(), STEPS);
            assert!((stepwise.closure() - whole.energy_balance.worst_closure()).abs() < 1e-15);

            let half = STEPS / 2;
            let mut first = start();
            records(&mut first, &rows[..half * row], stages, channels);
            let saved = first.save();
            let mut second = start();
            records(&mut second, &rows[..7 * row], stages, channels);
            second.restore(&saved).unwrap();
            let rest = records(&mut second, &rows[half * row..], stages, channels);
            let outputs = options.outputs.len();
            assert_eq!(bits(&rest[outputs..]), bits(&whole.records[(half + 1) * outputs..]));

            // What is not such a state changes nothing.
            let kept = second.save();
            for wrong in [&saved[1..], &saved[..saved.len() - 1], &[][..], &[0.5, 1.0]] {
                assert!(matches!(second.restore(wrong), Err(EngineError::Input(_))));
            }
            assert_eq!(bits(&second.save()), bits(&kept));
        }
    }
}

/// The weather of a step has the shape of the building's.
#[test]
fn weather_of_another_shape_is_refused() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let (channels, numbers) = (plan.n_channels(), values(&plan));
    let rows = forcing(&plan, Scheme::Sdirk2, 2, STEP, conditioned_weather);
    let options = options(Scheme::Sdirk2, STEP, conditioned_outputs());
    let all = Forcing::new(&rows, 2, channels).unwrap();
    let mut run = StepByStep::start(&plan, &numbers, &options, &all, &all).unwrap();
    let narrow = Forcing::new(&rows[..2 * (channels - 1)], 2, channels - 1).unwrap();
    assert!(matches!(run.step(&narrow), Err(EngineError::Input(_))));
    assert_eq!(run.steps(), 0);
}
