//! Runs that hand their records over in blocks.

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::{ALL_SCHEMES, forcing, options, run, values, warmup};
use mascarin_engine::RunControl;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::{Forcing, ForcingBlocks};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Warmup, simulate_in_blocks};

const STEP: f64 = 900.0;
const STEPS: usize = 96;

/// Records of the sun that is absorbed are averaged on request only.
fn outputs() -> Vec<Output> {
    [conditioned_outputs(), vec![Output::AbsorbedSolar { surface: 0, side: 0 }]].concat()
}

/// The blocks have the rows that were asked for, the last one what is left, and together the bits of a run.
#[test]
fn blocks_are_the_records_of_a_run() {
    for scheme in ALL_SCHEMES {
        let plan = Plan::new(conditioned(0.04)).unwrap();
        let weather = forcing(&plan, scheme, STEPS, STEP, conditioned_weather);
        let (numbers, stages) = (values(&plan), scheme.weights().len());
        let drive = Forcing::new(&weather, stages, plan.n_channels()).unwrap();
        for (warmup, record_every, rows) in
            [(None, 1, 10), (Some(warmup(STEP)), 1, 97), (None, 3, 1), (None, 1, usize::MAX)]
        {
            let options = Options { warmup, record_every, ..options(scheme, STEP, outputs()) };
            let whole = run(&plan, &weather, &options);
            let mut blocks: Vec<Vec<f64>> = Vec::new();
            let watch = RunControl::default();
            let streamed = simulate_in_blocks(
                &plan,
                &numbers,
                &mut ForcingBlocks::single(drive),
                &options,
                &watch,
                rows,
                |block| {
                    blocks.push(block);
                    Ok(())
                },
            )
            .unwrap();
            let total = options.rows(STEPS);
            let expected = total.div_ceil(rows.min(total));
            assert_eq!(blocks.len(), expected);
            let width = rows.min(total) * options.outputs.len();
            assert!(blocks[..expected - 1].iter().all(|block| block.len() == width));
            let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&blocks.concat()), bits(&whole.records));
            assert_eq!(streamed.energy_balance.closure().to_bits(), whole.energy_balance.closure().to_bits());
            assert_eq!(streamed.cycles, whole.cycles);
            assert!(streamed.records.is_empty());
        }
    }
}

/// The forcing in blocks of steps gives the bits of all steps, with a repeated first period in the first block.
#[test]
fn a_forcing_in_blocks_gives_the_bits_of_one() {
    for scheme in ALL_SCHEMES {
        let plan = Plan::new(conditioned(0.04)).unwrap();
        let weather = forcing(&plan, scheme, STEPS, STEP, conditioned_weather);
        let (numbers, stages) = (values(&plan), scheme.weights().len());
        let whole_warmup = Some(Warmup { steps: 24, ..warmup(STEP) });
        for (warmup, lengths) in [(None, vec![1; STEPS]), (whole_warmup, vec![24, 40, 1, 31])] {
            let options = Options { warmup, ..options(scheme, STEP, outputs()) };
            let whole = run(&plan, &weather, &options);
            let step = stages * plan.n_channels();
            let mut parts = weather.chunks(step).map(<[f64]>::to_vec);
            let mut blocks =
                lengths.into_iter().map(move |steps| parts.by_ref().take(steps).flatten().collect());
            let first: Vec<f64> = blocks.next().unwrap();
            let first = Forcing::new(&first, stages, plan.n_channels()).unwrap();
            let mut drive = ForcingBlocks::new(first, STEPS, || Ok(blocks.next().unwrap()));
            let (mut records, watch) = (Vec::new(), RunControl::default());
            let run = simulate_in_blocks(&plan, &numbers, &mut drive, &options, &watch, 7, |block| {
                records.extend(block);
                Ok(())
            })
            .unwrap();
            let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&records), bits(&whole.records));
            assert_eq!(run.energy_balance.closure().to_bits(), whole.energy_balance.closure().to_bits());
            assert_eq!((run.cycles, run.outside.to_bits()), (whole.cycles, whole.outside.to_bits()));
        }
    }
}

/// A first block that is shorter than the repeated period, a block without steps, and one with more than are left.
#[test]
fn blocks_that_do_not_fit_are_refused() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let scheme = ALL_SCHEMES[0];
    let weather = forcing(&plan, scheme, STEPS, STEP, conditioned_weather);
    let (numbers, stages) = (values(&plan), scheme.weights().len());
    let row = stages * plan.n_channels();
    for (repeated, first, next, words) in [
        (12, 10, 86, "the repeated first period is longer than the run"),
        (8, 10, 0, "has 0 steps, expected 1 to 86"),
        (8, 10, 87, "has 87 steps, expected 1 to 86"),
        (8, 96, 0, "has 96 steps of 95"),
    ] {
        let warmup = Some(Warmup { steps: repeated, ..warmup(STEP) });
        let options = Options { warmup, ..options(scheme, STEP, outputs()) };
        let block = Forcing::new(&weather[..first * row], stages, plan.n_channels()).unwrap();
        let steps = if next == 0 && first == STEPS { STEPS - 1 } else { STEPS };
        let mut drive = ForcingBlocks::new(block, steps, || Ok(weather[..next * row].to_vec()));
        let watch = RunControl::default();
        let ended = simulate_in_blocks(&plan, &numbers, &mut drive, &options, &watch, 7, |_| Ok(()));
        let error = ended.unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// A block that is not taken ends the run.
#[test]
fn a_refused_block_ends_the_run() {
    let options = options(ALL_SCHEMES[0], STEP, outputs());
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let weather = forcing(&plan, options.scheme, STEPS, STEP, conditioned_weather);
    let (numbers, stages) = (values(&plan), options.scheme.weights().len());
    let drive = Forcing::new(&weather, stages, plan.n_channels()).unwrap();
    let (watch, mut taken) = (RunControl::default(), 0);
    let ended =
        simulate_in_blocks(&plan, &numbers, &mut ForcingBlocks::single(drive), &options, &watch, 10, |_| {
            taken += 1;
            if taken < 3 { Ok(()) } else { Err(EngineError::Interrupted) }
        });
    assert!(matches!(ended, Err(EngineError::Interrupted)));
    assert_eq!(taken, 3);
}
