//! Walls of many cells, whose step is no map but two solves.

use crate::common::{Builder, facing, forcing, options, run, values, weather};
use mascarin_engine::derivatives::{Trajectory, jacobian};
use mascarin_engine::description::{Facing, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::{RunControl, Scheme};

/// A room behind a wall of one material in layers of some cells, all of one thickness.
fn room(layers: &[usize]) -> Plan {
    let mut b = Builder::new();
    let brick = b.solid("brick", 0.7, 1800.0, 900.0);
    let count: usize = layers.iter().sum();
    let of = |&nodes: &usize| (brick, 0.3 * nodes as f64 / count as f64, nodes);
    let layers: Vec<_> = layers.iter().map(of).collect();
    let construction = b.construction("wall", &layers);
    let zone = b.zone("room", 30.0, 0.5, ZoneLongwave::Radiosity);
    let (outer, inner, other) = (b.convection(20.0), b.convection(3.0), b.convection(3.0));
    let (outside, inside) = (b.outdoors(outer, 0.9, 0.6), b.inside(zone, inner, 0.9));
    b.surface("wall", construction, [12.0, 90.0, 180.0], outside, inside);
    let inside = b.inside(zone, other, 0.9);
    let floor = b.construction("floor", &[(brick, 0.1, 3)]);
    b.surface("floor", floor, [9.0, 180.0, 0.0], facing(Facing::Adiabatic, None), inside);
    b.plan()
}

const AIR: Output = Output::AirTemperature { zone: 0 };
const DT: f64 = 900.0;

/// A finer mesh changes little: the wall with a map and the one without lie on one line of second order.
#[test]
fn walls_with_and_without_a_map_agree() {
    let air = |nodes: usize, scheme: Scheme| {
        let plan = room(&[nodes]);
        let rows = forcing(&plan, scheme, 96, DT, weather);
        let result = run(&plan, &rows, &options(scheme, DT, vec![AIR]));
        assert!(result.energy_balance.closure() < 1e-12);
        result.records
    };
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        // 24 and 48 cells have maps, 96 and 192 have none.
        let meshes = [24, 48, 96, 192].map(|nodes| air(nodes, scheme));
        let apart = |a: usize| {
            let pairs = meshes[a].iter().zip(&meshes[a + 1]);
            pairs.fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()))
        };
        let [first, second, third] = [apart(0), apart(1), apart(2)];
        assert!(second < 0.3 * first && third < 0.3 * second, "{first:e}, {second:e}, {third:e}, {scheme:?}");
    }
}

/// A member in lanes has the bits that it has alone; slopes forward and in reverse are difference quotients.
#[test]
fn lanes_and_slopes_are_those_of_a_run() {
    let plan = room(&[40, 40]);
    let rows = forcing(&plan, Scheme::Sdirk2, 8, DT, weather);
    let (options, watch) = (options(Scheme::Sdirk2, DT, vec![AIR]), RunControl::default());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let alone = run(&plan, &rows, &options);
    let together = ensemble(&plan, &values(&plan).repeat(4), &drive, &options, &watch).unwrap();
    for member in together.records.chunks(alone.records.len()) {
        assert!(member.iter().zip(&alone.records).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
    let conductivity = crate::common::position(&plan, "materials.brick.conductivity");
    let forward = jacobian(&plan, &values(&plan), &[conductivity], &drive, &options, &watch).unwrap();
    let trajectory = Trajectory::new(&plan, &values(&plan), &drive, &options, &watch, 1 << 30).unwrap();
    let mut weights = vec![0.0; alone.records.len()];
    weights[8] = 1.0;
    let reverse = trajectory.pull(&plan, &values(&plan), &drive, &options, &watch, &weights).unwrap();
    let shifted = |by: f64| {
        let mut numbers = values(&plan);
        numbers[conductivity] += by;
        crate::common::try_run(&plan, &numbers, &rows, &options).unwrap().records[8]
    };
    let difference = (shifted(1e-5) - shifted(-1e-5)) / 2e-5;
    assert!((forward.slopes[8] - difference).abs() < 1e-5 * difference.abs().max(1.0), "{difference}");
    assert!((reverse[conductivity] - forward.slopes[8]).abs() < 1e-9 * difference.abs().max(1.0));
}

/// Ten layers of a thousand cells: a map would take 800 MB.
#[test]
fn ten_thousand_cells_run() {
    let plan = room(&[1000; 10]);
    let rows = forcing(&plan, Scheme::Sdirk2, 24, 3600.0, weather);
    let result = run(&plan, &rows, &options(Scheme::Sdirk2, 3600.0, vec![AIR]));
    assert!(result.records.iter().all(|air| (0.0..60.0).contains(air)));
    assert!(result.energy_balance.closure() < 1e-10, "{:e}", result.energy_balance.closure());
}
