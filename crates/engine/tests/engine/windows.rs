//! Rooms with windows, frames and shades: energy balance, lanes, derivatives, order.

use crate::common::glazed::{glazed, glazed_outputs, glazed_rooms};
use crate::common::{facing, forcing, options, position, run, set, try_run, values, warmup, weather};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::description::{Facing, Glazing, ZoneSun};
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::{Forcing, channel};
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;

const STEP: f64 = 900.0;
const SCHEMES: [Scheme; 2] = [Scheme::Sdirk2, Scheme::BackwardEuler];
/// The energy balance closes, and the sun that windows transmit is what the zone gains.
#[test]
fn energy_closes_with_windows() {
    for description in glazed_rooms() {
        let plan = Plan::new(description).unwrap();
        for scheme in SCHEMES {
            let rows = forcing(&plan, scheme, 192, STEP, weather);
            let result = run(&plan, &rows, &options(scheme, STEP, glazed_outputs()));
            assert!(
                result.energy_balance.closure() < 1e-12,
                "closure {} with {scheme:?}",
                result.energy_balance.closure()
            );
            let sums: Vec<f64> = (0..10)
                .map(|k| result.records.chunks(10).skip(1).map(|record| record[k]).sum::<f64>() * STEP)
                .collect();
            assert!(sums[8] > 1e7 && (sums[6] + sums[7] - sums[8]).abs() < 1e-9 * sums[8]);
            assert!(sums[9] > 0.01 * sums[8] && sums[9] < 0.2 * sums[8], "{} of {}", sums[9], sums[8]);
            // What stays in the zone, and what the panes absorb of the sun that leaves it.
            let kept = result.energy_balance.into[Flow::Transmitted as usize];
            assert!(kept > 0.7 * sums[8] && kept <= (sums[8] - sums[9]) * (1.0 + 1e-12));
            assert!(result.energy_balance.into[Flow::Glass as usize] > 0.0);
        }
    }
}

/// A pyranometer that shows 5 W/m2 in the first stage of each step and 6 W/m2 below zero in the last one, by day and by night: a window
/// transmits no more than what is on it, and the sun takes no heat away.
#[test]
fn transmittances_of_a_sensor_with_an_offset() {
    for mut d in glazed_rooms() {
        d.channels.push("sensor".to_owned());
        let channel = d.channels.len() - 1;
        let mut windows = Vec::new();
        for (w, surface) in d.surfaces.iter_mut().enumerate() {
            let glazed = d.constructions[surface.construction].glazing.is_some();
            if glazed && matches!(surface.outside.facing, Facing::Outdoors) {
                surface.outside.irradiance = Some(channel);
                windows.push(w);
            }
        }
        let plan = Plan::new(d).unwrap();
        let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, |time, row| {
            weather(time, row);
            let first = (0.1..0.9).contains(&(time / STEP).fract());
            set(row, channel, if first { 5.0 } else { -6.0 });
        });
        let outputs = windows.iter().flat_map(|&surface| {
            [Output::SolarTransmittance { surface }, Output::TransmittedSolar { surface }]
        });
        let run = run(&plan, &rows, &options(Scheme::Sdirk2, STEP, outputs.collect()));
        let (mut lit, mut total) = (0, 0);
        for record in run.records.chunks(2) {
            assert!((0.0..=1.0).contains(&record[0]) && record[1] >= 0.0, "{record:?}");
            (lit, total) = (lit + usize::from(record[0] > 0.1), total + 1);
        }
        assert!(10 * lit > total && !windows.is_empty(), "{lit} of {total}");
    }
}

/// The same of the radiation of the climate: what is below zero in both stages is dark.
#[test]
fn transmittances_of_a_climate_with_offsets() {
    for d in glazed_rooms() {
        let glazed = |&w: &usize| d.constructions[d.surfaces[w].construction].glazing.is_some();
        let windows: Vec<usize> = (0..d.surfaces.len()).filter(glazed).collect();
        let plan = Plan::new(d).unwrap();
        for in_first in [5.0, -5.0] {
            let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, |time, row| {
                weather(time, row);
                let first = (0.1..0.9).contains(&(time / STEP).fract());
                for at in [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL] {
                    row[at] = if first { in_first } else { -6.0 };
                }
            });
            let outputs = windows.iter().flat_map(|&surface| {
                [Output::SolarTransmittance { surface }, Output::TransmittedSolar { surface }]
            });
            let run = run(&plan, &rows, &options(Scheme::Sdirk2, STEP, outputs.collect()));
            for record in run.records.chunks(2) {
                assert!((0.0..=1.0).contains(&record[0]) && record[1] >= 0.0, "{record:?}");
                assert_eq!(record[1] > 0.0, in_first > 0.0, "{record:?}");
            }
        }
    }
}

/// A member's bits do not depend on its neighbours, wherever on the curves they look.
#[test]
fn lanes_are_scalars_with_windows() {
    for description in glazed_rooms() {
        let plan = Plan::new(description).unwrap();
        let width = plan.description.parameters.len();
        let [tilt, azimuth, clear, area] =
            ["surfaces.large.tilt", "surfaces.large.azimuth", "panes.outer.transmittance", "large.area"]
                .map(|path| position(&plan, path));
        let mut numbers = Vec::new();
        for member in 0..11 {
            let x = f64::from(member);
            let mut one = values(&plan);
            one[tilt] = 90.0 - 9.0 * x;
            one[azimuth] = 35.0 * x;
            one[clear] = 0.4 + 0.04 * x;
            one[area] = 6.0 - 0.3 * x;
            numbers.extend(one);
        }
        let rows = forcing(&plan, Scheme::Sdirk2, 2 * 96, STEP, weather);
        let mut options = options(Scheme::Sdirk2, STEP, glazed_outputs());
        options.warmup = Some(warmup(STEP));
        let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
        let watch = RunControl::default();
        let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
        assert!(together.failures.is_empty(), "{:?}", together.failures);
        let row = together.records.len() / 11;
        for (member, numbers) in numbers.chunks(width).enumerate() {
            let alone = simulate(&plan, numbers, &drive, &options, &watch).unwrap();
            for (i, (a, b)) in alone.records.iter().zip(&together.records[member * row..]).enumerate() {
                assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}: member {member}, reading {i}");
            }
            assert!(together.closure[member] < 1e-12);
        }
    }
}

/// Forward derivatives agree with central differences, for every number of glass, frame and sun.
#[test]
fn duals_are_differences_with_windows() {
    for description in glazed_rooms() {
        let plan = Plan::new(description).unwrap();
        let numbers = values(&plan);
        let rows = forcing(&plan, Scheme::Sdirk2, 60, STEP, weather);
        let options = options(Scheme::Sdirk2, STEP, glazed_outputs());
        let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
        let scale = |i: usize| if i % 10 < 5 { 1.0 } else { 0.01 };
        let weight = |i: usize| scale(i) * (1.0 + Real::sin(0.37 * i as f64));
        let figure = |numbers: &[f64]| -> f64 {
            let records = try_run(&plan, numbers, &rows, &options).unwrap().records;
            records.iter().enumerate().map(|(i, r)| weight(i) * r).sum()
        };
        let mut differ = Vec::new();
        let names = ["panes.", "gap.", "sheet.", "frame.", "large.", "small.", "share", "lost"];
        for (which, parameter) in plan.description.parameters.iter().enumerate() {
            if !names.iter().any(|name| parameter.path.starts_with(name)) {
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
            if (slope - difference).abs() > 1e-4 * difference.abs() + 1e-7 / step {
                differ.push(format!("{}: dual {slope:e}, difference {difference:e}", parameter.path));
            }
        }
        assert!(differ.is_empty(), "{}", differ.join("\n"));
    }
}

/// Another order of the surfaces of the room changes nothing beyond round-off.
#[test]
fn order_of_faces_does_not_matter() {
    for sun in [ZoneSun::Area, ZoneSun::Geometry] {
        let readings = |order| {
            let plan = Plan::new(glazed(sun.clone(), order)).unwrap();
            let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, weather);
            let outputs = vec![
                Output::AirTemperature { zone: 0 },
                Output::FaceTemperature { surface: 6, side: 1 },
                Output::ZoneLostSolar { zone: 0 },
            ];
            run(&plan, &rows, &options(Scheme::Sdirk2, STEP, outputs)).records
        };
        let (one, other) = (readings([0, 1, 2, 3, 4, 5]), readings([3, 5, 0, 4, 2, 1]));
        for (i, (a, b)) in one.iter().zip(&other).enumerate() {
            assert!((a - b).abs() < 1e-6 * a.abs().max(1.0), "reading {i}: {a} and {b}");
        }
    }
}

/// A window must lie between outdoors and a zone, and its glazing must be whole.
#[test]
fn what_the_plan_refuses() {
    let whole = || glazed(ZoneSun::Area, [0, 1, 2, 3, 4, 5]);
    let mut d = whole();
    d.surfaces[6].outside = facing(Facing::Adiabatic, None);
    assert!(Plan::new(d).is_err());
    let mut d = whole();
    let glazing = d.constructions.iter_mut().find_map(|one| one.glazing.as_mut()).unwrap();
    let Glazing::Panes { gaps, .. } = glazing else { panic!("the first is of panes") };
    gaps.pop();
    assert!(Plan::new(d).is_err());
    let mut d = whole();
    d.zones[0].sun = ZoneSun::Geometry;
    d.surfaces[0].vertices.clear();
    assert!(Plan::new(d).is_err());
}
