//! Ensembles in single precision: how near they are to double precision, and what their members depend on.

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::glazed::{glazed_outputs, glazed_rooms};
use crate::common::linear::linear_cell;
use crate::common::melting::{melting, melting_weather};
use crate::common::{
    cell, cell_members, cell_outputs, cell_weather, forcing, options, position, values, warmup, weather,
};
use crate::rooms_side_by_side::{ROOMS, row};
use mascarin_engine::description::Description;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::simd::Level;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::{Ensemble, ensemble, screening};
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Warmup};
use mascarin_engine::{RunControl, Scheme};

const STEP: f64 = 900.0;
const DAYS: usize = 6;

/// A building with its weather, run in both precisions.
struct Both {
    outputs: Vec<Output>,
    single: Ensemble,
    double: Ensemble,
}

impl Both {
    fn new(plan: &Plan, weather: fn(f64, &mut [f64]), outputs: Vec<Output>, scheme: Scheme) -> Self {
        let rows = forcing(plan, scheme, DAYS * 96, STEP, weather);
        let options = Options { warmup: Some(warmup(STEP)), ..options(scheme, STEP, outputs.clone()) };
        let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
        let mut numbers = values(plan).repeat(5);
        for (k, number) in numbers.iter_mut().enumerate() {
            // Up to 0.6 % less.
            *number *= 1.0 - 1e-3 * (k % 7) as f64;
        }
        let run = |run: fn(&Plan, &[f64], &Forcing<'_>, &Options, &RunControl) -> _| {
            let found: Result<Ensemble, _> = run(plan, &numbers, &drive, &options, &RunControl::default());
            found.unwrap()
        };
        Self { outputs, single: run(screening), double: run(ensemble) }
    }

    /// Root mean square and largest difference of the outputs that are chosen.
    fn apart(&self, chosen: impl Fn(&Output) -> bool) -> [f64; 2] {
        let of = |found: &Ensemble| -> Vec<f64> {
            let records = found.records.iter().zip(self.outputs.iter().cycle());
            records.filter(|(_, output)| chosen(output)).map(|(record, _)| *record).collect()
        };
        let differences: Vec<f64> =
            of(&self.single).iter().zip(of(&self.double)).map(|(a, b)| a - b).collect();
        let sum: f64 = differences.iter().map(|difference| difference * difference).sum();
        let most = differences.iter().fold(0.0, |most: f64, difference| most.max(difference.abs()));
        [(sum / differences.len() as f64).sqrt(), most]
    }

    /// Whether it was really computed in single precision: not on machines without registers for lanes.
    fn is_single(&self, name: &str) -> bool {
        let found = self.single.closure.iter().all(|closure| (1e-9..1e-4).contains(closure));
        assert_eq!(found, Level::widest().unwrap() != Level::Array, "{name}: {:?}", self.single.closure);
        found
    }
}

/// A building, its weather and its outputs.
type Building = (&'static str, Plan, fn(f64, &mut [f64]), Vec<Output>);

fn is_air(output: &Output) -> bool {
    matches!(output, Output::AirTemperature { .. })
}

/// Phase change, radiation and convection that are not linear, ideal loads, windows, hysteresis: airs within 0.01 K.
#[test]
fn airs_are_within_a_hundredth_of_a_kelvin() {
    let airs = |zones: usize| (0..zones).map(|zone| Output::AirTemperature { zone }).collect::<Vec<_>>();
    let plan = |description: Description| Plan::new(description).unwrap();
    let buildings: [Building; 8] = [
        ("cell", plan(cell(1.0)), cell_weather, cell_outputs()),
        ("sharp", plan(cell(0.04)), cell_weather, cell_outputs()),
        ("linear", plan(linear_cell()), cell_weather, airs(1)),
        ("loads", plan(conditioned(0.5)), conditioned_weather, conditioned_outputs()),
        ("glass", plan(glazed_rooms().swap_remove(0)), weather, glazed_outputs()),
        ("hysteresis", plan(melting(None)), melting_weather, airs(1)),
        ("rooms", row(false, false), weather, airs(ROOMS)),
        ("rooms with loads", row(true, true), weather, airs(ROOMS)),
    ];
    for (name, plan, weather, outputs) in buildings {
        for scheme in [Scheme::Sdirk2, Scheme::LinearlyImplicit] {
            let both = Both::new(&plan, weather, outputs.clone(), scheme);
            assert!(both.single.failures.is_empty() && both.double.failures.is_empty(), "{name}");
            let [rms, most] = both.apart(is_air);
            assert!(rms < 4e-3 && most < 0.03, "{name}, {scheme:?}: {rms} K, at most {most} K");
            if both.is_single(name) {
                assert!(rms > 0.0, "{name}");
            }
        }
    }
}

/// Loads are within 0.2 % of the largest.
#[test]
fn loads_are_near_those_in_double_precision() {
    let plan = Plan::new(conditioned(0.5)).unwrap();
    let both = Both::new(&plan, conditioned_weather, conditioned_outputs(), Scheme::Sdirk2);
    let is_load = |output: &Output| matches!(output, Output::HeatingLoad { .. } | Output::CoolingLoad { .. });
    let [rms, _] = both.apart(is_load);
    let largest = both
        .double
        .records
        .iter()
        .zip(both.outputs.iter().cycle())
        .filter(|(_, output)| is_load(output))
        .fold(0.0_f64, |most, (record, _)| most.max(record.abs()));
    assert!(largest > 100.0 && rms < 2e-3 * largest, "{rms} W of {largest} W");
}

/// The bits of a member depend neither on its place nor on the members beside it: a short pack is filled, and one member alone too.
#[test]
fn members_do_not_depend_on_their_neighbours() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(Scheme::Sdirk2, STEP, cell_outputs());
    let members = cell_members(&plan, 19);
    let width = values(&plan).len();
    let run = |numbers: &[f64]| screening(&plan, numbers, &drive, &options, &RunControl::default()).unwrap();
    let all = run(&members);
    let row = all.records.len() / 19;
    for (first, last) in [(0, 1), (3, 5), (7, 18), (18, 19)] {
        let some = run(&members[first * width..last * width]);
        let expected = &all.records[first * row..last * row];
        let differ = some.records.iter().zip(expected).position(|(a, b)| a.to_bits() != b.to_bits());
        assert!(
            differ.is_none(),
            "from member {first}, record {differ:?}, {:?} {:?}",
            some.closure,
            &all.closure
        );
        assert_eq!(some.closure, all.closure[first..last]);
    }
    assert_ne!(all.records[..row], all.records[row..2 * row], "members differ");
}

/// A member whose energy balance cannot close (the scheme loses latent heat) is run again in double precision.
#[test]
fn members_that_do_not_close_are_run_in_double_precision() {
    let scheme = Scheme::ApparentCapacity;
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, scheme, 96, STEP, cell_weather);
    let drive = Forcing::new(&rows, 1, plan.n_channels()).unwrap();
    let options = options(scheme, STEP, cell_outputs());
    let members = cell_members(&plan, 4);
    let [single, double] = [screening, ensemble]
        .map(|run| run(&plan, &members, &drive, &options, &RunControl::default()).unwrap());
    assert!(double.closure.iter().all(|&closure| closure > 1e-4));
    assert_eq!(single.records, double.records);
    assert_eq!(single.closure, double.closure);
}

/// Members whose first day does not become periodic fail alone: the others keep their bits.
#[test]
fn members_that_do_not_become_periodic_fail_alone() {
    let plan = Plan::new(cell(1.0)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 192, STEP, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let mut members = cell_members(&plan, 8);
    let width = values(&plan).len();
    // A heavy floor takes more days.
    let density = position(&plan, "materials.concrete.density");
    for member in members.chunks_mut(width).skip(5) {
        member[density] *= 8.0;
    }
    let warmup = |max_cycles| Some(Warmup { max_cycles, ..warmup(STEP) });
    let of =
        |max_cycles| Options { warmup: warmup(max_cycles), ..options(Scheme::Sdirk2, STEP, cell_outputs()) };
    for run in [ensemble, screening] {
        let run = |max_cycles, members: &[f64]| {
            run(&plan, members, &drive, &of(max_cycles), &RunControl::default()).unwrap()
        };
        let all = run(200, &members);
        assert!(all.failures.is_empty());
        let few = (2..40)
            .find(|&few| !run(few, &members).failures.is_empty() && run(few, &members).failures.len() < 8);
        let some = run(few.expect("a number of repetitions that is enough for some"), &members);
        let failed: Vec<usize> = some.failures.iter().map(|(member, _)| *member).collect();
        let row = all.records.len() / 8;
        for member in 0..8 {
            let [a, b] = [&some, &all].map(|found| &found.records[member * row..(member + 1) * row]);
            if failed.contains(&member) {
                assert!(a.iter().all(|record| record.is_nan()) && some.closure[member].is_nan());
            } else {
                assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "member {member}");
            }
        }
    }
}
