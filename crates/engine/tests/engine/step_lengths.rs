//! Steps of unequal length: the bits of equal ones where they are equal, one sequence for all members and derivatives, and their choice.

use std::sync::Arc;

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::glazed::{glazed_outputs, glazed_rooms};
use crate::common::{
    Builder, cell, cell_members, cell_outputs, cell_weather, facing, forcing, forcing_over, options,
    position, set, try_run, values, warmup, weather,
};
use mascarin_engine::derivatives::{Trajectory, jacobian};
use mascarin_engine::description::Facing;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::step_choice::{Criterion, StepChoice, choose_steps};
use mascarin_engine::run::{Options, StepLengths};
use mascarin_engine::{RunControl, Scheme};

const HOUR: f64 = 3600.0;
const SCHEME: Scheme = Scheme::Sdirk2;

/// Starts in their own lengths, and lengths [s].
fn starts(halvings: &[u8]) -> Vec<(f64, f64)> {
    let mut at = 0.0;
    let length = |count: u8| HOUR / f64::from(1_u32 << count);
    let step = |&count: &u8| {
        let start = at / length(count);
        at += length(count);
        (start, length(count))
    };
    halvings.iter().map(step).collect()
}

fn with_lengths(options: Options, halvings: &[u8]) -> Options {
    let lengths = StepLengths::new(halvings.to_vec()).unwrap();
    Options { lengths: Some(Arc::new(lengths)), ..options }
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

/// Hours in steps that differ from hour to hour, and within some.
fn mixed(hours: usize) -> Vec<u8> {
    let patterns: [&[u8]; 5] = [&[0], &[1, 2, 2], &[3, 3, 2, 1], &[1, 1], &[2, 3, 3, 1]];
    (0..hours).flat_map(|hour| patterns[hour % 5].iter().copied()).collect()
}

/// With all steps equal, whatever part of the record interval they are, a run has the bits of one with steps of that length.
#[test]
fn equal_lengths_have_the_bits_of_a_fixed_step() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    for (halved, steps) in [(0_u8, 24_usize), (2, 96)] {
        let dt = HOUR / f64::from(1_u32 << halved);
        let rows = forcing(&plan, SCHEME, steps, dt, conditioned_weather);
        let fixed = Options {
            warmup: Some(warmup(dt)),
            record_every: 1 << halved,
            ..options(SCHEME, dt, conditioned_outputs())
        };
        let unequal =
            with_lengths(Options { dt: HOUR, record_every: 1, ..fixed.clone() }, &vec![halved; steps]);
        let [fixed, unequal] =
            [fixed, unequal].map(|options| try_run(&plan, &values(&plan), &rows, &options).unwrap());
        assert_eq!(fixed.energy_balance.closure().to_bits(), unequal.energy_balance.closure().to_bits());
        assert_eq!((fixed.cycles, fixed.counters.iterations), (unequal.cycles, unequal.counters.iterations));
        let outputs = conditioned_outputs();
        let states = |records: &[f64]| -> Vec<u64> {
            let rows = records.chunks(outputs.len());
            rows.flat_map(|row| row.iter().zip(&outputs))
                .filter(|(_, output)| matches!(output, Output::AirTemperature { .. }))
                .map(|(value, _)| value.to_bits())
                .collect()
        };
        assert_eq!(states(&fixed.records), states(&unequal.records));
        assert!(!states(&fixed.records).is_empty());
    }
}

/// Means of an hour are those of its steps by their lengths, instants those at its end, and the energy balance closes.
#[test]
fn means_weigh_by_length() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let outputs = vec![
        Output::HeatingLoad { zone: 0 },
        Output::CoolingLoad { zone: 0 },
        Output::HeatingLoad { zone: 1 },
    ];
    let halvings = mixed(48);
    let rows = forcing_over(&plan, SCHEME, starts(&halvings).into_iter(), conditioned_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let numbers = values(&plan);
    let given = with_lengths(options(SCHEME, HOUR, outputs.clone()), &halvings);
    let run = try_run(&plan, &numbers, &rows, &given).unwrap();
    assert_eq!(run.records.len(), 49 * outputs.len());
    assert!(run.energy_balance.closure() < 1e-11, "{}", run.energy_balance.closure());
    // The sum of the loads of all zones over all hours is the heat of the balance, by its own sum over all stages.
    let sum = |k: usize| run.records.chunks(3).skip(1).map(|row| row[k]).sum::<f64>() * HOUR;
    let sums = [sum(0) + sum(2), sum(1)];
    let into = run.energy_balance.into;
    let [heating, cooling] =
        [mascarin_engine::energy_balance::Flow::Heating, mascarin_engine::energy_balance::Flow::Cooling]
            .map(|flow| into[flow as usize]);
    assert!(heating > 1e5 || cooling.abs() > 1e5, "{heating} {cooling}");
    for (sum, heat) in sums.into_iter().zip([heating, cooling.abs()]) {
        assert!((sum - heat).abs() < 1e-9 * (heating + cooling.abs()), "{sum} J is not {heat} J");
    }
    // In blocks and in an ensemble, too.
    let mut blocks: Vec<f64> = Vec::new();
    mascarin_engine::run::simulate_in_blocks(
        &plan,
        &numbers,
        &mut mascarin_engine::forcing::ForcingBlocks::single(drive),
        &given,
        &RunControl::default(),
        7,
        |block| {
            blocks.extend(block);
            Ok(())
        },
    )
    .unwrap();
    assert_eq!(bits(&blocks), bits(&run.records));
}

/// A member of a pack has the bits of its run alone, whatever its neighbours are, in glazed rooms and with phase change.
#[test]
fn members_have_the_bits_of_their_runs() {
    let halvings = mixed(30);
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing_over(&plan, SCHEME, starts(&halvings).into_iter(), cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let steps = halvings.iter().scan(0.0, |at, &count| {
        *at += 1.0 / f64::from(1_u32 << count);
        Some(*at)
    });
    let first = 1 + steps.take_while(|&at| at < 24.0).count();
    let warm = mascarin_engine::run::Warmup { steps: first, ..warmup(HOUR) };
    let given =
        with_lengths(Options { warmup: Some(warm), ..options(SCHEME, HOUR, cell_outputs()) }, &halvings);
    let members = cell_members(&plan, 13);
    let together = ensemble(&plan, &members, &drive, &given, &RunControl::default()).unwrap();
    let (width, length) = (values(&plan).len(), together.records.len() / 13);
    assert!(together.failures.is_empty());
    for k in 0..13 {
        let alone = try_run(&plan, &members[k * width..][..width], &rows, &given).unwrap();
        assert_eq!(bits(&alone.records), bits(&together.records[k * length..][..length]), "member {k}");
    }
    for description in glazed_rooms().into_iter().take(2) {
        let plan = Plan::new(description).unwrap();
        let rows = forcing_over(&plan, SCHEME, starts(&halvings).into_iter(), weather);
        let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
        let given = with_lengths(options(SCHEME, HOUR, glazed_outputs()), &halvings);
        let members =
            [values(&plan), values(&plan).iter().map(|value| value * 0.97).collect(), values(&plan)].concat();
        let together = ensemble(
            &plan,
            &[members.clone(), members.clone()].concat(),
            &drive,
            &given,
            &RunControl::default(),
        )
        .unwrap();
        let alone = try_run(&plan, &values(&plan), &rows, &given).unwrap();
        assert_eq!(bits(&alone.records), bits(&together.records[..alone.records.len()]));
    }
}

/// Derivatives forward, in reverse and as difference quotients of runs with the same steps agree.
#[test]
fn derivatives_along_unequal_steps() {
    let halvings = mixed(26);
    let plan = Plan::new(conditioned(1.0)).unwrap();
    let outputs = vec![Output::AirTemperature { zone: 0 }, Output::NetLoad { zone: 0 }];
    let rows = forcing_over(&plan, SCHEME, starts(&halvings).into_iter(), conditioned_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let given = with_lengths(options(SCHEME, HOUR, outputs.clone()), &halvings);
    let numbers = values(&plan);
    let which =
        numbers.iter().enumerate().position(|(k, _)| plan.description.parameters[k].path.contains("volume"));
    let which = which.unwrap();
    let watch = RunControl::default();
    let forward = jacobian(&plan, &numbers, &[which], &drive, &given, &watch).unwrap();
    let trajectory = Trajectory::new(&plan, &numbers, &drive, &given, &watch, 1 << 24).unwrap();
    let moved = |by: f64| {
        let mut numbers = numbers.clone();
        numbers[which] += by;
        let exact = Options { scheme: SCHEME, ..given.clone() };
        try_run(&plan, &numbers, &rows, &exact).unwrap().records
    };
    let step = 1e-3 * numbers[which];
    let (high, low) = (moved(step), moved(-step));
    for (k, output) in outputs.iter().enumerate() {
        // A sum of all rows: each mean comes by many steps.
        let weights: Vec<f64> = (0..forward.records.len()).map(|i| f64::from(u8::from(i % 2 == k))).collect();
        let pulled = trajectory.pull(&plan, &numbers, &drive, &given, &watch, &weights).unwrap()[which];
        let sum: f64 = forward.slopes.iter().zip(&weights).map(|(slope, weight)| slope * weight).sum();
        let scale: f64 =
            forward.slopes.iter().zip(&weights).map(|(slope, weight)| (slope * weight).abs()).sum();
        let quotient: f64 =
            high.iter().zip(&low).zip(&weights).map(|((a, b), weight)| (a - b) * weight).sum::<f64>()
                / (2.0 * step);
        assert!((pulled - sum).abs() < 1e-9 * scale, "{output:?}: reverse {pulled}, forward {sum}");
        assert!(
            (quotient - sum).abs() < 2e-4 * scale,
            "{output:?}: difference {quotient}, forward {sum}, of {scale}"
        );
    }
}

/// A slab that exchanges heat with air on one side, in a zone without any other heat.
fn sheet() -> Plan {
    let mut b = Builder::new();
    let solid = b.solid("solid", 50.0, 2000.0, 1000.0);
    let measured = b.channel("air");
    let zone = b.zone("room", 30.0, 0.0, mascarin_engine::description::ZoneLongwave::None);
    let construction = b.construction("wall", &[(solid, 0.02, 4)]);
    let (outside, inside) = (b.convection(11.0), b.convection(5.0));
    let outside = facing(Facing::Measured { channel: measured }, Some(outside));
    let inside = b.inside(zone, inside, 0.0);
    b.surface("wall", construction, [2.0, 90.0, 0.0], outside, inside);
    b.plan()
}

fn chosen(plan: &Plan, tolerance: f64, hours: usize, fill: impl Fn(f64, &mut [f64])) -> StepChoice {
    let levels =
        [1_usize, 2, 4].map(|parts| forcing(plan, SCHEME, hours * parts, HOUR / parts as f64, &fill));
    let drives: Vec<_> =
        levels.iter().map(|rows| Forcing::new(rows, 2, plan.n_channels()).unwrap()).collect();
    let criterion = Criterion { tolerance, most_halvings: 9 };
    choose_steps(
        plan,
        &values(plan),
        &drives,
        &options(SCHEME, HOUR, Vec::new()),
        criterion,
        &RunControl::default(),
    )
    .unwrap()
}

/// Air outside that jumps after some hours: the air of the room follows with a time constant that the steps resolve where it moves, and long
/// steps are taken where nothing does. Against the same in steps of 7 s: errors of steps add up, so that each may have a fifth of the
/// tolerance, as in `step: auto`.
#[test]
fn steps_follow_a_jump() {
    let plan = sheet();
    let fill = |time: f64, row: &mut [f64]| set(row, 0, if time > 30.0 * HOUR { 30.0 } else { 20.0 });
    let outputs = vec![Output::AirTemperature { zone: 0 }];
    let records = |halvings: &[u8]| {
        let rows = forcing_over(&plan, SCHEME, starts(halvings).into_iter(), fill);
        let given = with_lengths(options(SCHEME, HOUR, outputs.clone()), halvings);
        try_run(&plan, &values(&plan), &rows, &given).unwrap().records
    };
    let fine = records(&vec![9; 60 << 9]);
    let mut before = usize::MAX;
    for tolerance in [0.003, 0.03, 0.3] {
        let choice = chosen(&plan, 0.2 * tolerance, 60, fill);
        assert!(choice.errors.iter().all(|&error| error <= 0.2 * tolerance), "{tolerance} K");
        let worst =
            records(&choice.halvings).iter().zip(&fine).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= tolerance, "{worst} K with a tolerance of {tolerance} K");
        let shortest = choice.halvings.iter().copied().max().unwrap();
        // Before the jump nothing moves. Steps of one length would be more, with a close tolerance eight times as many.
        let saved = if tolerance < 0.01 { 8 } else { 1 };
        assert!(choice.halvings[..30].iter().skip(8).filter(|&&count| count == 0).count() >= 20);
        assert!(saved * choice.halvings.len() < 60 << shortest, "{} steps", choice.halvings.len());
        assert!(choice.halvings.len() < before);
        before = choice.halvings.len();
    }
}

/// What cannot be used is refused: lengths of another number of steps, and weather whose steps are no halves.
#[test]
fn unusable_lengths_are_refused() {
    let plan = sheet();
    let rows = forcing(&plan, SCHEME, 4, HOUR, |_, row| set(row, 0, 20.0));
    let given = with_lengths(options(SCHEME, HOUR, Vec::new()), &[0, 0, 0]);
    assert!(try_run(&plan, &values(&plan), &rows, &given).is_err());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let criterion = Criterion { tolerance: 0.1, most_halvings: 6 };
    let watch = RunControl::default();
    let numbers = values(&plan);
    let given = options(SCHEME, HOUR, Vec::new());
    assert!(choose_steps(&plan, &numbers, &[drive, drive], &given, criterion, &watch).is_err());
    watch.stop.store(true, core::sync::atomic::Ordering::Relaxed);
    assert!(matches!(
        choose_steps(&plan, &numbers, &[drive], &given, criterion, &watch),
        Err(mascarin_engine::error::EngineError::Interrupted)
    ));
    assert!(position(&plan, "zones.room.volume") < numbers.len());
}
