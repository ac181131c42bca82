//! Slopes along known solutions against slopes of the whole iteration, and against differences.

use crate::common::difficult::{all_steps, jumps};
use crate::common::glazed_box::glazed_box;
use crate::common::{Builder, cell, cell_outputs, cell_weather, forcing, options, position, set, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::{Description, IdealLoad, SetPoint, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, simulate};

const SCHEMES: [Scheme; 2] = [Scheme::BackwardEuler, Scheme::Sdirk2];

/// Slopes of all records by a parameter: along the known solution, and by the iteration itself.
fn both(plan: &Plan, rows: &[f64], options: &Options, path: &str) -> Vec<[f64; 2]> {
    let (numbers, which) = (values(plan), position(plan, path));
    let drive = Forcing::new(rows, options.scheme.weights().len(), plan.n_channels()).unwrap();
    let along = jacobian(plan, &numbers, &[which], &drive, options, &RunControl::default()).unwrap().slopes;
    let variable = |(i, &n)| if i == which { Dual::variable(n, 0) } else { Dual::constant(n) };
    let duals: Vec<Dual<1>> = numbers.iter().enumerate().map(variable).collect();
    let iterated = simulate(plan, &duals, &drive, options, &RunControl::default()).unwrap().records;
    along.into_iter().zip(iterated).map(|(along, iterated)| [along, iterated.slope[0]]).collect()
}

fn agree(slopes: &[[f64; 2]], place: &str) {
    let largest = slopes.iter().fold(0.0_f64, |most, [_, slope]| most.max(slope.abs()));
    for (record, [along, iterated]) in slopes.iter().enumerate() {
        assert!(
            (along - iterated).abs() < 1e-6 * iterated.abs() + 1e-8 * largest,
            "record {record}, {place}: along the solution {along:e}, by iteration {iterated:e}"
        );
    }
}

/// A set point of 25 degC, kept without limit.
fn heated(mut d: Description) -> Plan {
    d.channels = vec!["set_point".to_owned()];
    let setpoint = SetPoint::Scheduled { channel: 0 };
    d.zones[0].heating = Some(IdealLoad { setpoint, capacity: None, radiative: None, schedule: None });
    Plan::new(d).unwrap()
}

fn heated_options(scheme: Scheme, dt: f64) -> Options {
    options(scheme, dt, vec![Output::AirTemperature { zone: 0 }, Output::HeatingLoad { zone: 0 }])
}

/// A heated zone behind walls that melt within 1 K, in jumping weather.
#[test]
fn slopes_of_loads_with_phase_change() {
    for scheme in SCHEMES {
        for dt in [3600.0, 10_800.0] {
            let mut b = Builder::new();
            let law = b.tanh(71e3, 21.7, 1.0);
            let pcm = b.pcm("pcm", [[0.4, 0.4], [3000.0, 3000.0]], 855.0, law);
            let wall = b.construction("wall", &[(pcm, 0.006, 6)]);
            let zone = b.zone("zone", 27.0, 0.5, ZoneLongwave::None);
            for (name, azimuth) in [("north", 0.0), ("east", 90.0), ("south", 180.0)] {
                let (outer, inner) = (b.convection(15.0), b.convection(3.0));
                let (outside, inside) = (b.outdoors(outer, 0.9, 0.6), b.inside(zone, inner, 0.9));
                b.surface(name, wall, [9.0, 90.0, azimuth], outside, inside);
            }
            let plan = heated(b.describe());
            let rows = forcing(&plan, scheme, 8, dt, |time, row| {
                jumps(time, dt, row);
                set(row, 0, 25.0);
            });
            let slopes = both(&plan, &rows, &heated_options(scheme, dt), "surfaces.north.area");
            agree(&slopes, &format!("{scheme:?}, steps of {dt} s"));
        }
    }
}

/// A heated zone with gas in the gap of its window.
#[test]
fn slopes_of_loads_with_gas_in_a_gap() {
    for scheme in SCHEMES {
        let plan = heated(glazed_box(true));
        let rows = forcing(&plan, scheme, 12, 3600.0, |time, row| {
            jumps(time, 3600.0, row);
            set(row, 0, 25.0);
        });
        let slopes = both(&plan, &rows, &heated_options(scheme, 3600.0), "surfaces.north.area");
        agree(&slopes, &format!("{scheme:?}"));
    }
}

/// Across stages that the nested iteration solves, slopes are those of differences, where these do not depend on their step.
#[test]
fn slopes_across_nested_stages() {
    for scheme in SCHEMES {
        let mut compared = 0;
        for step in all_steps(scheme, false) {
            if step.run.counters.nested == 0 || step.run.counters.halvings > 0 {
                continue;
            }
            let (plan, numbers) = (&step.plan, values(&step.plan));
            let (options, which) = (step.options(1), position(plan, "tarp.factor"));
            let drive = Forcing::new(&step.rows, scheme.weights().len(), plan.n_channels()).unwrap();
            let slopes =
                jacobian(plan, &numbers, &[which], &drive, &options, &RunControl::default()).unwrap();
            let slope = slopes.slopes[options.outputs.len()];
            let quotient = |h: f64| {
                let at = |change: f64| {
                    let mut numbers = numbers.clone();
                    numbers[which] += change;
                    step.at(&numbers).state.air[0]
                };
                (at(h) - at(-h)) / (2.0 * h)
            };
            let (wide, narrow) = (quotient(2e-5), quotient(1e-5));
            if (wide - narrow).abs() > 1e-3 * narrow.abs() + 1e-4 {
                // A perturbed run was solved otherwise.
                continue;
            }
            compared += 1;
            let allowed = 1e-2 * narrow.abs() + 2e-3;
            assert!((slope - narrow).abs() < allowed, "{}: slope {slope}, difference {narrow}", step.name);
        }
        assert!(compared > 0, "{scheme:?}");
    }
}

/// Slopes in reverse do not depend on how many states are kept: a wall that melts, and a heated zone with a window.
#[test]
fn slopes_in_reverse_do_not_depend_on_memory() {
    for scheme in SCHEMES {
        let melting = Plan::new(cell(1.0)).unwrap();
        let rows = forcing(&melting, scheme, 96, 900.0, cell_weather);
        same_slopes(&melting, &rows, &options(scheme, 900.0, cell_outputs()));
        let glazed = heated(glazed_box(true));
        let rows = forcing(&glazed, scheme, 48, 900.0, |time, row| {
            jumps(time, 900.0, row);
            set(row, 0, 25.0);
        });
        same_slopes(&glazed, &rows, &heated_options(scheme, 900.0));
    }
}

fn same_slopes(plan: &Plan, rows: &[f64], options: &Options) {
    let (numbers, watch) = (values(plan), RunControl::default());
    let drive = Forcing::new(rows, options.scheme.weights().len(), plan.n_channels()).unwrap();
    let slopes = |bytes: usize| {
        let run = Trajectory::new(plan, &numbers, &drive, options, &watch, bytes).unwrap();
        let weights: Vec<f64> = (0..run.run.records.len()).map(|i| Real::sin(0.37 * i as f64)).collect();
        run.pull(plan, &numbers, &drive, options, &watch, &weights).unwrap()
    };
    let all = slopes(1 << 30);
    for bytes in [1, 1 << 16] {
        for ((a, b), parameter) in all.iter().zip(slopes(bytes)).zip(&plan.description.parameters) {
            assert_eq!(a.to_bits(), b.to_bits(), "{a:e} and {b:e} by {}, {bytes} bytes", parameter.path);
        }
    }
}
