//! Zones of many surfaces, whose balances are solved by iteration: against rooms of few surfaces, and with all that uses the
//! same linear systems.

use crate::common::conditioned::ideal_load;
use crate::common::{Builder, facing, forcing, options, position, run, try_run, values, weather};
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::{Convection, Facing, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::{RunControl, Scheme};

const STEP: f64 = 900.0;
/// Tilt, azimuth and area of the walls of a room; the last one is between it and a second room.
const WALLS: [([f64; 2], f64); 7] = [
    ([90.0, 0.0], 12.0),
    ([90.0, 90.0], 9.0),
    ([90.0, 180.0], 12.0),
    ([90.0, 270.0], 9.0),
    ([0.0, 0.0], 14.0),
    ([180.0, 0.0], 14.0),
    ([60.0, 45.0], 5.0),
];

/// A room whose walls are cut into equal parts, but for the one to the second room.
fn room(parts: usize, heated: bool) -> Plan {
    let mut b = Builder::new();
    let concrete = b.solid("concrete", 1.4, 2200.0, 900.0);
    let board = b.solid("board", 0.2, 500.0, 1000.0);
    let heavy = b.construction("heavy", &[(board, 0.02, 2), (concrete, 0.15, 4)]);
    let light = b.construction("light", &[(board, 0.02, 2)]);
    let [zone, second] = ["room", "second"].map(|name| b.zone(name, 40.0, 0.5, ZoneLongwave::Radiosity));
    let factor = b.number("factor", 1.0);
    let natural = || Convection::law("tarp", &[("factor", factor)]);
    for (wall, ([tilt, azimuth], area)) in WALLS.into_iter().enumerate() {
        let between = wall + 1 == WALLS.len();
        let count = if between { 1 } else { parts };
        for part in 0..count {
            let outside = match wall {
                6 => b.inside(second, natural(), 0.7),
                5 => facing(Facing::Adiabatic, None),
                _ => {
                    let convection = b.convection(12.0 + wall as f64);
                    b.outdoors(convection, 0.9, 0.2 + 0.1 * wall as f64)
                }
            };
            let inside = b.inside(zone, natural(), 0.5 + 0.07 * wall as f64);
            let construction = if between || wall == 2 { light } else { heavy };
            let place = [area / count as f64, tilt, azimuth];
            b.surface(&format!("wall{wall}_{part}"), construction, place, outside, inside);
        }
    }
    let convection = b.convection(15.0);
    let (outside, inside) = (b.outdoors(convection, 0.9, 0.6), b.inside(second, natural(), 0.9));
    b.surface("far", light, [10.0, 90.0, 135.0], outside, inside);
    let mut d = b.describe();
    if heated {
        d.zones[0].heating = Some(ideal_load(&mut d, "heating", 23.0, 400.0));
    }
    Plan::new(d).unwrap()
}

/// Airs, load, and a surface of each wall of the room.
fn outputs(parts: usize) -> Vec<Output> {
    let surface = |wall: usize| Output::FaceTemperature { surface: wall * parts, side: 1 };
    let zones = (0..2).flat_map(|zone| [Output::AirTemperature { zone }, Output::NetLoad { zone }]);
    zones.chain((0..WALLS.len()).map(surface)).collect()
}

/// Equal parts of a wall have its temperature: a room of 151 surfaces is one of 7, which is eliminated.
#[test]
fn walls_that_are_cut_into_parts_stay_as_they_are() {
    const PARTS: usize = 25;
    for scheme in [Scheme::Sdirk2, Scheme::LinearlyImplicit, Scheme::BackwardEuler] {
        for heated in [false, true] {
            let [whole, cut] = [1, PARTS].map(|parts| {
                let plan = room(parts, heated);
                let rows = forcing(&plan, scheme, 24, STEP, weather);
                let mut options = options(scheme, STEP, outputs(parts));
                options.residuals = scheme == Scheme::Sdirk2;
                run(&plan, &rows, &options)
            });
            for (i, (a, b)) in whole.records.iter().zip(&cut.records).enumerate() {
                assert!(
                    (a - b).abs() < 1e-9 * (1.0 + a.abs()),
                    "{a} is not {b}: number {i}, {scheme:?}, {heated}"
                );
            }
            assert!(cut.energy_balance.closure() < 1e-12, "{}", cut.energy_balance.closure());
            let residual = cut.counters.largest_residual;
            assert!(residual.is_none_or(|residual| residual < 1e-6), "{residual:?} W");
        }
    }
}

/// Members of an ensemble, with other numbers beside them, have the bits of runs alone.
#[test]
fn a_large_zone_has_the_same_bits_in_lanes() {
    let plan = room(25, true);
    let rows = forcing(&plan, Scheme::Sdirk2, 8, STEP, weather);
    let options = options(Scheme::Sdirk2, STEP, outputs(25));
    let mut members = Vec::new();
    for member in 0..8 {
        let scale = 1.0 + 0.2 * f64::from(member);
        let paths = plan.description.parameters.iter();
        members.extend(paths.map(|one| if one.path == "factor" { one.value * scale } else { one.value }));
    }
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let pack = ensemble(&plan, &members, &drive, &options, &RunControl::default()).unwrap();
    assert!(pack.failures.is_empty(), "{:?}", pack.failures);
    let count = values(&plan).len();
    for (numbers, records) in members.chunks(count).zip(pack.records.chunks(pack.records.len() / 8)) {
        let alone = try_run(&plan, numbers, &rows, &options).unwrap();
        for (a, b) in alone.records.iter().zip(records) {
            assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}");
        }
    }
}

/// Derivatives, whose linear systems are eliminated, are those of the run.
#[test]
fn derivatives_of_a_large_zone_are_those_of_its_run() {
    let plan = room(22, false);
    let rows = forcing(&plan, Scheme::Sdirk2, 6, STEP, weather);
    let options = options(Scheme::Sdirk2, STEP, vec![Output::AirTemperature { zone: 0 }]);
    let nominal = values(&plan);
    let which = ["factor", "zones.room.infiltration.constant"].map(|path| position(&plan, path));
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let found = jacobian(&plan, &nominal, &which, &drive, &options, &RunControl::default()).unwrap();
    let last = found.records.len() - 1;
    for (k, &parameter) in which.iter().enumerate() {
        let step = 1e-4 * nominal[parameter];
        let [up, down] = [step, -step].map(|change| {
            let mut numbers = nominal.clone();
            numbers[parameter] += change;
            try_run(&plan, &numbers, &rows, &options).unwrap().records[last]
        });
        let (slope, expected) = (found.slopes[k * found.records.len() + last], (up - down) / (2.0 * step));
        assert!((slope - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{slope} is not {expected}");
    }
}
