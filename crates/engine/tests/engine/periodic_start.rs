//! The periodic start: few repetitions, close to the state that very many repetitions lead to, and derivatives of that state.

#![allow(
    clippy::disallowed_methods,
    reason = "closed answers are computed with other functions than the engine's"
)]

use core::f64::consts::TAU;

use crate::common::{Builder, facing, forcing, options, position, run, set, values, warmup, weather};
use mascarin_engine::derivatives::{Trajectory, jacobian};
use mascarin_engine::description::{Facing, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Warmup, simulate};
use mascarin_engine::{RunControl, Scheme};

const HOUR: f64 = 3600.0;
/// Thickness of concrete and of insulation outside of it [m], and how far the start may be from the air after 400 days [K].
const HOUSES: [([f64; 2], f64); 6] = [
    ([0.2, 0.0], 0.02),
    ([0.5, 0.0], 0.02),
    ([0.2, 0.1], 0.02),
    ([0.5, 0.1], 0.02),
    ([0.5, 0.3], 0.02),
    ([1.0, 0.2], 0.08),
];

/// A house without floor, of concrete behind insulation.
fn house([concrete, insulation]: [f64; 2]) -> Plan {
    let mut b = Builder::new();
    let heavy = b.solid("concrete", 1.75, 2240.0, 900.0);
    let foam = b.solid("foam", 0.03, 30.0, 1470.0);
    let layers = [(foam, insulation, 4), (heavy, concrete, 12)];
    let wall = b.construction("wall", &layers[usize::from(insulation == 0.0)..]);
    let room = b.zone("room", 60.0, 0.3, ZoneLongwave::Radiosity);
    let (outer, inner) = (b.convection(20.0), b.convection(3.0));
    for (area, tilt, azimuth) in
        [(12.0, 90.0, 0.0), (12.0, 90.0, 90.0), (12.0, 90.0, 180.0), (12.0, 90.0, 270.0), (20.0, 0.0, 0.0)]
    {
        let (outside, inside) = (b.outdoors(outer.clone(), 0.9, 0.5), b.inside(room, inner.clone(), 0.9));
        b.surface("wall", wall, [area, tilt, azimuth], outside, inside);
    }
    b.plan()
}

/// Weather that is the same every day.
fn same_days(plan: &Plan, days: usize) -> Vec<f64> {
    forcing(plan, Scheme::Sdirk2, 24 * days, HOUR, |time, row| weather(time % 86400.0, row))
}

fn air(warmup: Option<Warmup>) -> Options {
    Options { warmup, ..options(Scheme::Sdirk2, HOUR, vec![Output::AirTemperature { zone: 0 }]) }
}

/// Houses that need up to 143 repetitions alone: at most nine, and their air is nearer to that after 400 days than with repetitions
/// alone, which end a tolerance over the decay of the slowest mode away (0.1 to 1 K).
#[test]
fn heavy_houses_need_few_repetitions() {
    for (layers, most) in HOUSES {
        let plan = house(layers);
        let found = run(&plan, &same_days(&plan, 1), &air(Some(warmup(HOUR))));
        let long = run(&plan, &same_days(&plan, 400), &air(None)).records;
        let error = (found.records[0] - long[24 * 400]).abs();
        assert!(found.cycles <= 9 && error < most, "{layers:?}: {} repetitions, {error} K", found.cycles);
    }
}

/// A slab of 1 m, 20 K from its periodic state: the air on one side swings about 10 degC, and the adiabatic side, which the swing does
/// not reach, is at the mean.
#[test]
fn the_periodic_state_of_a_thick_slab_is_found() {
    let mut b = Builder::new();
    let solid = b.solid("solid", 0.8, 2000.0, 1000.0);
    let measured = b.channel("air");
    let construction = b.construction("wall", &[(solid, 1.0, 80)]);
    let convection = b.convection(8.0);
    let outside = facing(Facing::Measured { channel: measured }, Some(convection));
    b.surface("wall", construction, [2.0, 90.0, 0.0], outside, facing(Facing::Adiabatic, None));
    let plan = b.plan();
    let rows = forcing(&plan, Scheme::Sdirk2, 96, 900.0, |time, row| {
        set(row, 0, 10.0 + 10.0 * (TAU * time / 86400.0).cos());
    });
    let outputs = [0, 1].map(|side| Output::FaceTemperature { surface: 0, side });
    let mut options = options(Scheme::Sdirk2, 900.0, outputs.to_vec());
    options.initial = mascarin_engine::state::Initial::Everywhere(30.0);
    options.warmup = Some(Warmup { steps: 96, tolerance: 1e-3, max_cycles: 200 });
    let found = run(&plan, &rows, &options);
    assert!(found.cycles <= 9, "{} repetitions", found.cycles);
    let [mut cosine, mut sine] = [0.0; 2];
    for (row, record) in found.records.chunks(2).enumerate().skip(1) {
        let angle = TAU * row as f64 / 96.0;
        cosine += 2.0 * record[0] * angle.cos() / 96.0;
        sine += 2.0 * record[0] * angle.sin() / 96.0;
        assert!((record[1] - 10.0).abs() < 0.003, "inside, row {row}: {}", record[1]);
    }
    // A half-space: T = 10 / (1 + (1 + i) r k / h).
    let x = (TAU / 86400.0 * 2e6 / (2.0 * 0.8)).sqrt() * 0.8 / 8.0;
    let exact = 10.0 / (1.0 + x).hypot(x);
    assert!((cosine.hypot(sine) - exact).abs() < 0.002 * exact, "{} is not {exact}", cosine.hypot(sine));
}

/// Members that need different numbers of repetitions have the bits of single runs.
#[test]
fn members_converge_one_by_one() {
    let plan = house([0.3, 0.1]);
    let (rows, options) = (same_days(&plan, 2), air(Some(warmup(HOUR))));
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let nominal = values(&plan);
    let density = position(&plan, "materials.concrete.density");
    let mut numbers = Vec::new();
    for member in 0..8 {
        let mut own = nominal.clone();
        own[density] *= [1.0, 0.02, 3.0, 0.2, 0.5, 0.05, 2.0, 0.1][member];
        numbers.extend(own);
    }
    let together = ensemble(&plan, &numbers, &drive, &options, &RunControl::default()).unwrap();
    assert!(together.failures.is_empty());
    let mut cycles = Vec::new();
    let records = together.records.chunks(together.records.len() / 8);
    for (own, records) in numbers.chunks(nominal.len()).zip(records) {
        let alone = simulate(&plan, own, &drive, &options, &RunControl::default()).unwrap();
        assert!(alone.records.iter().zip(records).all(|(a, b)| a.to_bits() == b.to_bits()));
        cycles.push(alone.cycles);
    }
    cycles.sort_unstable();
    cycles.dedup();
    assert!(cycles.len() > 1, "{cycles:?}");
}

/// The slopes are those of the periodic state: of central differences with a tight tolerance, forward and in reverse, with all of
/// the repeated day kept and some of it.
#[test]
fn slopes_are_those_of_the_periodic_state() {
    let plan = house([0.5, 0.1]);
    let (rows, nominal, watch) = (same_days(&plan, 1), values(&plan), RunControl::default());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let tight = air(Some(Warmup { tolerance: 1e-10, ..warmup(HOUR) }));
    let names =
        ["materials.concrete.density", "materials.concrete.conductivity", "materials.foam.conductivity"];
    let which = names.map(|name| position(&plan, name));
    let found = jacobian(&plan, &nominal, &which, &drive, &tight, &watch).unwrap();
    let rough = jacobian(&plan, &nominal, &which, &drive, &air(Some(warmup(HOUR))), &watch).unwrap();
    let size = found.records.len();
    let largest = |slopes: &[f64]| slopes.iter().fold(0.0_f64, |largest, slope| largest.max(slope.abs()));
    for (&parameter, (slopes, rough)) in
        which.iter().zip(found.slopes.chunks(size).zip(rough.slopes.chunks(size)))
    {
        // Stages are solved to 1e-8 W/m2, which moves the air of an insulated house by some 1e-7 K.
        let nudge = 2e-3 * nominal[parameter];
        let [low, high] = [-nudge, nudge].map(|nudge| {
            let mut numbers = nominal.clone();
            numbers[parameter] += nudge;
            jacobian(&plan, &numbers, &which[..1], &drive, &tight, &watch).unwrap().records
        });
        let scale = largest(slopes);
        for (k, (low, high)) in low.iter().zip(&high).enumerate() {
            let quotient = (high - low) / (2.0 * nudge);
            assert!((quotient - slopes[k]).abs() < 1e-4 * scale, "{parameter}: {quotient}, {}", slopes[k]);
            // The slopes at a start that is some hundredths of a kelvin away.
            assert!((rough[k] - slopes[k]).abs() < 0.1 * scale, "{parameter}: {}, {}", rough[k], slopes[k]);
        }
    }
    for bytes in [1 << 30, 1 << 12] {
        let trajectory = Trajectory::new(&plan, &nominal, &drive, &tight, &watch, bytes).unwrap();
        let gradient = trajectory.pull(&plan, &nominal, &drive, &tight, &watch, &vec![1.0; size]).unwrap();
        for (&parameter, slopes) in which.iter().zip(found.slopes.chunks(size)) {
            let sum: f64 = slopes.iter().sum();
            assert!((gradient[parameter] - sum).abs() < 1e-8 * sum.abs(), "{} {sum}", gradient[parameter]);
        }
    }
}
