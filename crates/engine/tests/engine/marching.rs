//! Properties of whole runs of a cell with every law of convection, two zones and a phase-change ceiling.

use crate::common::linear::cell_of_linear_laws;
use crate::common::melting::{ceiling, ceiling_weather};
use crate::common::{
    ALL_SCHEMES, SCHEMES, cell, cell_members, cell_outputs, cell_weather, forcing, options, position, run,
    try_run, values, warmup,
};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;
use mascarin_engine::state::Initial;

const STEP: f64 = 900.0;

/// The energy balance closes with every scheme but the paper's (apparent capacity).
#[test]
fn energy_closes() {
    for (gamma, dt) in [(0.04, STEP), (1.0, STEP), (0.04, 3600.0), (100.0, 300.0)] {
        let plan = Plan::new(cell(gamma)).unwrap();
        for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
            let rows = forcing(&plan, scheme, 480, dt, cell_weather);
            let result = run(&plan, &rows, &options(scheme, dt, cell_outputs()));
            let closure = result.energy_balance.closure();
            assert!(closure < 1e-10, "closure {closure} with {scheme:?}, gamma {gamma}, steps of {dt} s");
            let sum: f64 = result.energy_balance.into.iter().sum();
            assert!(
                (sum - result.energy_balance.stored).abs() < 1e-10 * result.energy_balance.total_exchanged
            );
        }
    }
}

/// The apparent capacity at the old temperature loses heat, the more the sharper the melting.
#[test]
fn apparent_capacity_loses_heat() {
    let mut last = 0.0;
    for gamma in [0.04, 1.0, 100.0] {
        let plan = Plan::new(ceiling(gamma)).unwrap();
        let rows = forcing(&plan, Scheme::ApparentCapacity, 10 * 96, STEP, ceiling_weather);
        let result = run(&plan, &rows, &options(Scheme::ApparentCapacity, STEP, Vec::new()));
        let closure = result.energy_balance.closure();
        assert!(
            closure > 1.5 * last + 0.01 && closure < 1.0,
            "closure {closure} at gamma {gamma} after {last}"
        );
        last = closure;
    }
    assert!(last > 0.1, "closure {last} at gamma 100");
}

/// A member's bits do not depend on whether it runs alone, in a pack, on where, or on how many threads.
#[test]
fn lanes_are_scalars() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let width = plan.description.parameters.len();
    for scheme in ALL_SCHEMES {
        let rows = forcing(&plan, scheme, 3 * 96, STEP, cell_weather);
        let mut options = options(scheme, STEP, cell_outputs());
        options.warmup = Some(warmup(STEP));
        let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
        let numbers = cell_members(&plan, 19);
        let watch = RunControl::default();
        let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
        let row = together.records.len() / 19;
        let (mut iterations, mut cycles) = (Vec::new(), Vec::new());
        for (member, numbers) in numbers.chunks(width).enumerate() {
            let alone = match simulate(&plan, numbers, &drive, &options, &watch) {
                Ok(alone) => alone,
                Err(error) => {
                    // The warm-up of the paper's scheme does not converge where the melting is sharp.
                    assert!(scheme == Scheme::ApparentCapacity, "member {member}: {error}");
                    assert!(together.failures.contains(&(member, error)), "member {member}");
                    continue;
                }
            };
            for (i, (a, b)) in alone.records.iter().zip(&together.records[member * row..]).enumerate() {
                assert_eq!(
                    a.to_bits(),
                    b.to_bits(),
                    "{a} is not {b}: member {member}, reading {i}, {scheme:?}"
                );
            }
            assert_eq!(alone.energy_balance.closure().to_bits(), together.closure[member].to_bits());
            iterations.push(alone.counters.iterations);
            cycles.push(alone.cycles);
        }
        iterations.sort_unstable();
        iterations.dedup();
        cycles.sort_unstable();
        cycles.dedup();
        assert!(
            iterations.len() > 5 && cycles.len() > 1,
            "the members are too alike: {iterations:?} {cycles:?}"
        );
        // Another order puts each member at another place of another pack.
        let turned: Vec<f64> = numbers.chunks(width).rev().flatten().copied().collect();
        let backwards = ensemble(&plan, &turned, &drive, &options, &watch).unwrap();
        for (a, b) in together.records.chunks(row).zip(backwards.records.chunks(row).rev()) {
            assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()), "{scheme:?}");
        }
        assert_eq!(together.failures.len(), backwards.failures.len());
    }
}

/// Forward derivatives agree with central differences for every number of the cell.
#[test]
fn duals_are_differences() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let mut numbers = values(&plan);
    for (number, parameter) in numbers.iter_mut().zip(&plan.description.parameters) {
        // Correlations jump where a surface stops being vertical: the walls are tilted a little.
        if parameter.path.rsplit('.').next() == Some("tilt") && *number == 90.0 {
            *number = 88.0;
        }
    }
    let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, cell_weather);
    let options = options(Scheme::Sdirk2, STEP, cell_outputs());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    // One figure that all readings and times enter with different weights.
    let weight = |row: usize| 1.0 + Real::sin(0.37 * row as f64);
    let figure = |numbers: &[f64]| {
        let records = try_run(&plan, numbers, &rows, &options).unwrap().records;
        records.iter().enumerate().map(|(i, r)| scaled(i) * weight(i) * r).sum::<f64>() / records.len() as f64
    };
    let mut differ = Vec::new();
    for (which, parameter) in plan.description.parameters.iter().enumerate() {
        let duals: Vec<Dual<1>> = numbers
            .iter()
            .enumerate()
            .map(|(i, &n)| if i == which { Dual::variable(n, 0) } else { Dual::constant(n) })
            .collect();
        let records = simulate(&plan, &duals, &drive, &options, &RunControl::default()).unwrap().records;
        let slope = records.iter().enumerate().map(|(i, r)| scaled(i) * weight(i) * r.slope[0]).sum::<f64>()
            / records.len() as f64;
        let step = 1e-5 * if numbers[which] == 0.0 { 1.0 } else { numbers[which].abs() };
        let shifted = |sign: f64| {
            let mut numbers = numbers.clone();
            numbers[which] += sign * step;
            figure(&numbers)
        };
        let difference = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
        // Below this a difference of two figures of size 20 has no digits left.
        let noise = 1e-10 / step;
        if (slope - difference).abs() > 1e-5 * difference.abs() + noise {
            differ.push(format!("{}: dual {slope:e}, difference {difference:e}", parameter.path));
        }
    }
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}

/// Brings readings of enthalpy and flux to the size of temperatures.
fn scaled(index: usize) -> f64 {
    match cell_outputs()[index % cell_outputs().len()] {
        Output::LayerEnthalpy { .. } => 1e-7,
        Output::LiquidFraction { .. } => 10.0,
        _ => 1.0,
    }
}

/// The order in which surfaces are written changes nothing beyond round-off.
#[test]
fn order_of_surfaces_does_not_matter() {
    let forward = Plan::new(cell(0.04)).unwrap();
    let mut description = cell(0.04);
    description.surfaces.reverse();
    let last = description.surfaces.len() - 1;
    for sensor in &mut description.sensors {
        sensor.surface = last - sensor.surface;
    }
    let backward = Plan::new(description).unwrap();
    let rows = forcing(&forward, Scheme::Sdirk2, 480, STEP, cell_weather);
    let outputs = vec![
        Output::AirTemperature { zone: 0 },
        Output::AirTemperature { zone: 1 },
        Output::Sensor { sensor: 0 },
    ];
    let options = options(Scheme::Sdirk2, STEP, outputs);
    let (a, b) = (run(&forward, &rows, &options), run(&backward, &rows, &options));
    for (a, b) in a.records.iter().zip(&b.records) {
        assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    }
}

/// No step fails for any sharpness and step length.
#[test]
fn melting_never_stops_a_run() {
    let mut failures = Vec::new();
    for gamma in [0.01, 0.04, 0.2, 1.0, 5.0, 10.0, 25.0, 100.0] {
        for dt in [60.0, 300.0, 900.0, 1800.0, 3600.0] {
            for (name, description, weather) in [
                ("ceiling", ceiling(gamma), ceiling_weather as fn(f64, &mut [f64])),
                ("cell", cell(gamma), cell_weather),
            ] {
                let plan = Plan::new(description).unwrap();
                for scheme in ALL_SCHEMES {
                    let rows = forcing(&plan, scheme, 1000, dt, weather);
                    if let Err(error) =
                        try_run(&plan, &values(&plan), &rows, &options(scheme, dt, Vec::new()))
                    {
                        failures.push(format!("{name}, gamma {gamma}, {dt} s, {scheme:?}: {error}"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} runs failed:\n{}", failures.len(), failures.join("\n"));
}

/// A number that is not one stops the run and is named; it never passes for converged.
#[test]
fn not_a_number_is_no_solution() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 10, STEP, |time, row| {
        cell_weather(time, row);
        if time > 4000.0 {
            row[0] = f64::NAN;
        }
    });
    let error =
        try_run(&plan, &values(&plan), &rows, &options(Scheme::Sdirk2, STEP, Vec::new())).unwrap_err();
    assert!(error.to_string().contains("step 4 (stage 2)"), "{error}");
}

/// The work of the solver, 960 steps after three repeated days. It grows when something in it gets worse; when it
/// shrinks, write the new number here.
#[test]
fn solver_counters() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 960, STEP, cell_weather);
    let mut options = options(Scheme::Sdirk2, STEP, cell_outputs());
    options.warmup = Some(warmup(STEP));
    let result = run(&plan, &rows, &options);
    assert_eq!((result.cycles, result.counters.iterations), (3, 5644));
}

/// What is eliminated once, because nothing in it changes, is what would be found if it were eliminated every time.
#[test]
fn linear_laws_are_eliminated_once() {
    for scheme in SCHEMES {
        let runs = [false, true].map(|as_power| {
            let plan = Plan::new(cell_of_linear_laws(as_power)).unwrap();
            let rows = forcing(&plan, scheme, 5 * 96, STEP, cell_weather);
            run(&plan, &rows, &options(scheme, STEP, cell_outputs()))
        });
        let [linear, as_power] = &runs;
        for (a, b) in linear.records.iter().zip(&as_power.records) {
            assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} is not {b} with {scheme:?}");
        }
        if scheme != Scheme::ApparentCapacity {
            assert!(linear.energy_balance.closure() < 1e-10, "{:?}", linear.energy_balance);
        }
    }
}

/// Members of such a cell, too, have the same bits alone and in a pack, and one at no number fails by itself.
#[test]
fn lanes_of_linear_laws_have_the_bits_of_single_runs() {
    let plan = Plan::new(cell_of_linear_laws(false)).unwrap();
    let width = plan.description.parameters.len();
    let rows = forcing(&plan, Scheme::Sdirk2, 3 * 96, STEP, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(Scheme::Sdirk2, STEP, cell_outputs());
    let mut numbers = cell_members(&plan, 11);
    numbers[4 * width + position(&plan, "materials.foam.density")] = f64::NAN;
    let watch = RunControl::default();
    let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
    let row = together.records.len() / 11;
    assert_eq!(together.failures.iter().map(|(member, _)| *member).collect::<Vec<_>>(), [4]);
    for (member, numbers) in numbers.chunks(width).enumerate().filter(|(member, _)| *member != 4) {
        let alone = simulate(&plan, numbers, &drive, &options, &watch).unwrap();
        for (a, b) in alone.records.iter().zip(&together.records[member * row..]) {
            assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}: member {member}");
        }
        assert_eq!(alone.energy_balance.closure().to_bits(), together.closure[member].to_bits());
    }
}

/// Temperatures that are given one by one mean the same as one everywhere, and must be all there.
#[test]
fn a_start_may_be_given_cell_by_cell() {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, cell_weather);
    let mut options = options(Scheme::Sdirk2, STEP, cell_outputs());
    let everywhere = run(&plan, &rows, &options);
    let (surfaces, zones) = (plan.surfaces.len(), plan.zones.len());
    let given =
        |cells: Vec<f64>| Initial::Given { cells, surfaces: vec![20.0; surfaces], air: vec![20.0; zones] };
    options.initial = given(vec![20.0; plan.n_cells]);
    let one_by_one = run(&plan, &rows, &options);
    for (a, b) in everywhere.records.iter().zip(&one_by_one.records) {
        assert_eq!(a.to_bits(), b.to_bits());
    }
    options.initial = given(vec![20.0; plan.n_cells + 1]);
    let message = try_run(&plan, &values(&plan), &rows, &options).unwrap_err().to_string();
    assert!(message.contains(&format!("{} cells, expected {}", plan.n_cells + 1, plan.n_cells)), "{message}");
    options.initial = given(vec![f64::NAN; plan.n_cells]);
    assert!(try_run(&plan, &values(&plan), &rows, &options).is_err());
}
