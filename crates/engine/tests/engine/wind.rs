//! Which walls are windward.

use crate::common::{Builder, facing, forcing, options, position, set, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::description::{Convection, Exposure, Facing, OutdoorLongwave};
use mascarin_engine::forcing::{Forcing, channel};
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;

/// Orientations of walls and winds [deg].
const ANGLES: usize = 24;
const BETWEEN: usize = 15;
/// [m/s].
const WIND: f64 = 4.0;
/// Of the wall [m2 K/W].
const RESISTANCE: f64 = 0.5;

/// A vertical wall of no heat capacity in each direction, `MoWiTT` outside at 20 degC, 30 degC inside.
fn walls() -> Plan {
    let mut b = Builder::new();
    let layer = b.resistance("layer", RESISTANCE);
    let wall = b.construction("wall", &[(layer, 0.0, 0)]);
    let inside = b.channel("inside");
    for k in 0..ANGLES {
        let convection = Convection::law("mowitt", &[("factor", b.number("mowitt.factor", 1.0))]);
        let mut outside = b.outdoors(convection, 0.9, 0.0);
        outside.longwave = OutdoorLongwave::None;
        outside.exposure = Exposure { sun: false, ..Exposure::default() };
        let azimuth = (BETWEEN * k) as f64;
        let held = facing(Facing::Measured { channel: inside }, None);
        b.surface(&format!("wall{k}"), wall, [1.0, 90.0, azimuth], outside, held);
    }
    b.plan()
}

fn outputs() -> Vec<Output> {
    (0..ANGLES).map(|surface| Output::FaceTemperature { surface, side: 0 }).collect()
}

/// A wind from each direction in turn, a step each.
fn winds(plan: &Plan) -> Vec<f64> {
    forcing(plan, Scheme::BackwardEuler, ANGLES, 1.0, |time, row| {
        row[channel::WIND_SPEED] = WIND;
        row[channel::WIND_DIRECTION] = BETWEEN as f64 * (time.round() - 1.0);
        set(row, 0, 30.0);
    })
}

/// Both sides of a wall along the wind are windward, in every direction: the angle decides, not its rounding.
#[test]
fn a_wind_along_a_wall_is_windward() {
    let plan = walls();
    let rows = winds(&plan);
    let options = options(Scheme::BackwardEuler, 1.0, outputs());
    let drive = Forcing::new(&rows, 1, plan.n_channels()).unwrap();
    let run = simulate(&plan, &values(&plan), &drive, &options, &RunControl::default()).unwrap();
    // The first row is the state at the start.
    for (direction, records) in run.records.chunks(ANGLES).skip(1).enumerate() {
        for (wall, surface) in records.iter().enumerate() {
            let between = BETWEEN * direction.abs_diff(wall);
            let windward = between <= 90 || between >= 270;
            let forced =
                if windward { 3.26 * Real::powf(WIND, 0.89) } else { 3.55 * Real::powf(WIND, 0.617) };
            let natural = 0.84 * Real::cbrt(surface - 20.0);
            let expected = (natural * natural + forced * forced).sqrt();
            let found = (30.0 - surface) / RESISTANCE / (surface - 20.0);
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "wind from {} deg on a wall towards {} deg: {found} is not {expected}",
                BETWEEN * direction,
                BETWEEN * wall
            );
        }
    }
}

/// Lanes and derivatives decide alike, for walls turned by 45 deg from member to member.
#[test]
fn ties_are_the_same_in_lanes_and_derivatives() {
    let plan = walls();
    let rows = winds(&plan);
    let options = options(Scheme::BackwardEuler, 1.0, outputs());
    let drive = Forcing::new(&rows, 1, plan.n_channels()).unwrap();
    let numbers = values(&plan);
    let mut members = Vec::new();
    for turn in 0..8 {
        let mut member = numbers.clone();
        for wall in 0..ANGLES {
            let azimuth = position(&plan, &format!("surfaces.wall{wall}.azimuth"));
            member[azimuth] = ((BETWEEN * wall + 45 * turn) % 360) as f64;
        }
        members.extend(member);
    }
    let watch = RunControl::default();
    let together = ensemble(&plan, &members, &drive, &options, &watch).unwrap();
    let size = together.records.len() / 8;
    for (k, member) in members.chunks(numbers.len()).enumerate() {
        let alone = simulate(&plan, member, &drive, &options, &watch).unwrap();
        let duals: Vec<Dual<1>> = member.iter().map(|&number| Dual::constant(number)).collect();
        let duals = simulate(&plan, &duals, &drive, &options, &watch).unwrap();
        let lanes = &together.records[k * size..(k + 1) * size];
        for ((alone, lane), dual) in alone.records.iter().zip(lanes).zip(&duals.records) {
            assert_eq!(alone.to_bits(), lane.to_bits());
            assert!((alone - dual.value).abs() < 1e-9);
        }
        // A wall turned by 45 deg behaves as the third wall after it.
        let first = &together.records[ANGLES..2 * ANGLES];
        for wall in 0..ANGLES {
            let turned = lanes[ANGLES + wall] - first[(wall + 3 * k) % ANGLES];
            assert!(turned.abs() < 1e-9, "member {k}, wall {wall}: {turned}");
        }
    }
}
