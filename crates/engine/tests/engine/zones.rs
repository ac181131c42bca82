//! Zones with ideal loads, gains, ventilation, openings and paths: loads, lanes, derivatives, energy balance.

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather, ideal_load, number};
use crate::common::{Builder, facing, forcing, options, position, relative, run, values, warmup};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::{AirPath, Facing, ZoneLongwave};
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;

const STEP: f64 = 900.0;
const SCHEMES: [Scheme; 2] = [Scheme::Sdirk2, Scheme::BackwardEuler];

/// The energy balance closes, the paths between zones cancel, and every mode of an ideal load occurs.
#[test]
fn energy_closes_with_plants() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    for scheme in SCHEMES {
        let rows = forcing(&plan, scheme, 480, STEP, conditioned_weather);
        let result = run(&plan, &rows, &options(scheme, STEP, conditioned_outputs()));
        assert!(
            result.energy_balance.closure() < 1e-12,
            "closure {} with {scheme:?}",
            result.energy_balance.closure()
        );
        let into = |flow: Flow| result.energy_balance.into[flow as usize];
        assert!(into(Flow::Interzone).abs() < 1e-12 * result.energy_balance.total_exchanged);
        assert!(into(Flow::Heating) > 0.0 && into(Flow::Cooling) < 0.0 && into(Flow::Gains) > 0.0);
        let width = conditioned_outputs().len();
        let (mut held, mut full, mut off, mut cooled) = (0, 0, 0, 0);
        for record in result.records.chunks(width).skip(1) {
            let (air, heating, cooling) = (record[0], record[10], record[11]);
            assert!(heating >= 0.0 && cooling >= 0.0 && heating * cooling == 0.0);
            match heating {
                h if h >= 300.0 - 1e-9 => {
                    full += 1;
                    assert!(h < 300.0 + 1e-9 && air < 22.0 + 1e-7);
                }
                h if h > 0.0 => {
                    held += 1;
                    assert!((air - 22.0).abs() < 1e-7, "{air} at {h} W");
                }
                _ if cooling > 0.0 && cooling < 80.0 - 1e-9 => {
                    cooled += 1;
                    assert!((air - 24.0).abs() < 1e-7);
                }
                _ if cooling > 0.0 => assert!(cooling < 80.0 + 1e-9 && air > 24.0 - 1e-7),
                _ => {
                    off += 1;
                    assert!(air > 22.0 - 1e-7 && air < 24.0 + 1e-7);
                }
            }
        }
        assert!(held > 5 && off > 5 && cooled + full > 0, "{held} {full} {off} {cooled}");
    }
}

/// A member's bits do not depend on its neighbours, whatever their ideal loads do.
#[test]
fn lanes_are_scalars_with_plants() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let width = plan.description.parameters.len();
    let (heating, cooling) =
        (position(&plan, "room.heating.setpoint"), position(&plan, "room.cooling.setpoint"));
    let (capacity, power) = (position(&plan, "room.heating.capacity"), position(&plan, "gain.power"));
    let mut numbers = Vec::new();
    for member in 0..11 {
        let x = member as f64;
        let mut one = values(&plan);
        one[heating] = 19.0 + 0.5 * x;
        one[cooling] = one[heating] + 0.3 * (member % 4) as f64;
        one[capacity] = [0.0, 60.0, 300.0, 5000.0][member % 4];
        one[power] *= 1.0 + Real::sin(1.7 * x);
        numbers.extend(one);
    }
    for scheme in SCHEMES {
        let rows = forcing(&plan, scheme, 2 * 96, STEP, conditioned_weather);
        let mut options = options(scheme, STEP, conditioned_outputs());
        options.warmup = Some(warmup(STEP));
        let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
        let watch = RunControl::default();
        let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
        assert!(together.failures.is_empty(), "{:?}", together.failures);
        let row = together.records.len() / 11;
        for (member, numbers) in numbers.chunks(width).enumerate() {
            let alone = simulate(&plan, numbers, &drive, &options, &watch).unwrap();
            for (i, (a, b)) in alone.records.iter().zip(&together.records[member * row..]).enumerate() {
                assert_eq!(
                    a.to_bits(),
                    b.to_bits(),
                    "{a} is not {b}: member {member}, reading {i}, {scheme:?}"
                );
            }
            assert_eq!(alone.energy_balance.closure().to_bits(), together.closure[member].to_bits());
        }
    }
}

/// Forward derivatives of airs and loads agree with central differences.
#[test]
fn duals_are_differences_with_plants() {
    let plan = Plan::new(conditioned(0.04)).unwrap();
    let numbers = values(&plan);
    let rows = forcing(&plan, Scheme::Sdirk2, 40, STEP, conditioned_weather);
    let options = options(Scheme::Sdirk2, STEP, conditioned_outputs());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let size = conditioned_outputs().len();
    let scale = |i: usize| {
        if i % size >= 10 && (i % size - 10) % 3 < 2 { 0.01 } else { f64::from(u8::from(i % size != 8)) }
    };
    let weight = |i: usize| scale(i) * (1.0 + Real::sin(0.37 * i as f64));
    // As derivatives do, with two sweeps more than a plain run: that one ends where the loads are right within 1e-5 K of the air, and a quotient
    // shows how what is left depends on the parameter (2.5e-4 of it).
    let figure = |numbers: &[f64]| -> f64 {
        let watch = RunControl::default();
        let records = jacobian(&plan, numbers, &[0], &drive, &options, &watch).unwrap().records;
        records.iter().enumerate().map(|(i, r)| weight(i) * r).sum()
    };
    let mut differ = Vec::new();
    let names =
        ["heating.setpoint", "cooling.setpoint", "capacity", "gain.", "fan.", "hatch.", "slot.", "volume"];
    for (which, parameter) in plan.description.parameters.iter().enumerate() {
        if !names.iter().any(|name| parameter.path.contains(name)) {
            continue;
        }
        let variable = |(i, &n)| if i == which { Dual::variable(n, 0) } else { Dual::constant(n) };
        let duals: Vec<Dual<1>> = numbers.iter().enumerate().map(variable).collect();
        let records = simulate(&plan, &duals, &drive, &options, &RunControl::default()).unwrap().records;
        let slope: f64 = records.iter().enumerate().map(|(i, r)| weight(i) * r.slope[0]).sum();
        let step = 1e-5 * numbers[which].abs().max(1e-3);
        let shifted = |sign: f64| {
            let mut numbers = numbers.clone();
            numbers[which] += sign * step;
            figure(&numbers)
        };
        let difference = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
        if (slope - difference).abs() > 5e-5 * difference.abs() + 1e-7 / step {
            differ.push(format!("{}: dual {slope:e}, difference {difference:e}", parameter.path));
        }
    }
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}

/// The reverse order of zones and surfaces changes nothing beyond round-off.
#[test]
fn order_of_zones_and_surfaces_does_not_matter() {
    let forward = Plan::new(conditioned(0.04)).unwrap();
    let mut description = conditioned(0.04);
    description.zones.reverse();
    description.surfaces.reverse();
    let last = description.surfaces.len() - 1;
    for surface in &mut description.surfaces {
        for side in [&mut surface.outside, &mut surface.inside] {
            if let Facing::Zone { zone } = &mut side.facing {
                *zone = 1 - *zone;
            }
        }
    }
    for sensor in &mut description.sensors {
        sensor.surface = last - sensor.surface;
    }
    description.air_paths[0].between = [0, 1];
    description.openings[0].zone = 0;
    let backward = Plan::new(description).unwrap();
    let readings = |plan: &Plan, zones: [usize; 2]| {
        let rows = forcing(plan, Scheme::Sdirk2, 192, STEP, conditioned_weather);
        let outputs = zones
            .into_iter()
            .flat_map(|zone| {
                [
                    Output::AirTemperature { zone },
                    Output::MeanRadiantTemperature { zone },
                    Output::HeatingLoad { zone },
                    Output::CoolingLoad { zone },
                ]
            })
            .collect();
        run(plan, &rows, &options(Scheme::Sdirk2, STEP, outputs)).records
    };
    let (one, other) = (readings(&forward, [0, 1]), readings(&backward, [1, 0]));
    for (i, (a, b)) in one.iter().zip(&other).enumerate() {
        // Loads answer to a K of the air with some 100 W.
        let slack = if i % 4 < 2 { 1e-7 } else { 1e-4 };
        assert!((a - b).abs() < slack, "reading {i}: {a} and {b}");
    }
}

/// Two heated zones behind adiabatic surfaces: each load is what its zone loses, by wall, path and outdoor air.
#[test]
fn coupled_loads_by_hand() {
    let mut b = Builder::new();
    let board = b.solid("board", 0.2, 500.0, 1000.0);
    let wall = b.construction("wall", &[(board, 0.1, 3)]);
    let zones =
        [("a", 1.0), ("b", 0.0)].map(|(name, changes)| b.zone(name, 40.0, changes, ZoneLongwave::None));
    let (outer, inner) = (b.convection(4.0), b.convection(4.0));
    let [outside, inside] = [(zones[0], outer), (zones[1], inner)]
        .map(|(zone, convection)| facing(Facing::Zone { zone }, Some(convection)));
    b.surface("between", wall, [12.0, 90.0, 0.0], outside, inside);
    let mut d = b.describe();
    d.zones[0].heating = Some(ideal_load(&mut d, "a.heating", 22.0, 1e5));
    d.zones[1].heating = Some(ideal_load(&mut d, "b.heating", 18.0, 1e5));
    d.zones[1].cooling = Some(ideal_load(&mut d, "b.cooling", 18.0, 1e5));
    let flow = number(&mut d, "door.flow", 0.02);
    d.air_paths.push(AirPath {
        name: "door".to_owned(),
        between: [0, 1],
        flow,
        schedule: None,
        density: None,
        control: None,
    });
    d.site.air_density = Some(number(&mut d, "site.air_density", 1.2));
    let plan = Plan::new(d).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 20 * 96, STEP, |_, row| row[0] = 5.0);
    let outputs = vec![Output::HeatingLoad { zone: 0 }, Output::CoolingLoad { zone: 1 }];
    let result = run(&plan, &rows, &options(Scheme::Sdirk2, STEP, outputs));
    let across = (12.0 / (0.1 / 0.2 + 2.0 / 4.0) + 0.02 * 1.2 * 1006.0) * 4.0;
    let fresh = 40.0 / 3600.0 * 1.2 * 1006.0 * 17.0;
    let [a, b] = [result.records[result.records.len() - 2], result.records[result.records.len() - 1]];
    // The air is held to within 1e-8 K, and answers with some 100 W to a K.
    assert!(relative(a, across + fresh) < 1e-7, "{a} and {}", across + fresh);
    assert!(relative(b, across) < 1e-7, "{b} and {across}");
}
