//! Ideal loads of several zones, found by holding their airs: against a closed form, and against the loads that follow from the
//! responses to each, which numbers with derivatives take.

use crate::common::random::{Case, Contents};
use crate::common::{Builder, SCHEMES, facing, forcing, options, run, set, values};
use mascarin_engine::RunControl;
use mascarin_engine::description::{AirPath, Facing, IdealLoad, SetPoint, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;

const OUTDOORS: f64 = 5.0;
/// Heat capacity of a cubic metre of air [J/(m3 K)].
const AIR: f64 = 1200.0;
/// Heating of the last room [W], which does not reach its set point.
const CAPACITY: f64 = 50.0;

/// Rooms in a row, each with a wall to outdoors, that exchange air with the next one. Every third is not heated.
struct Row {
    plan: Plan,
    /// Set points [degC].
    set_points: Vec<Option<f64>>,
    /// Conductance to outdoors of each room, and between rooms [W/K].
    outwards: Vec<f64>,
    between: f64,
}

fn row(rooms: usize, flow: f64) -> Row {
    let mut b = Builder::new();
    let board = b.solid("board", 0.2, 500.0, 1000.0);
    let wall = b.construction("wall", &[(board, 0.02, 2)]);
    let (mut set_points, mut outwards) = (Vec::new(), Vec::new());
    let outdoors = b.channel("outdoors");
    for room in 0..rooms {
        let area = 10.0 + room as f64;
        let zone = b.zone(&format!("room{room}"), 30.0, 0.0, ZoneLongwave::Radiosity);
        let [outer, inner] = [20.0, 5.0].map(|coefficient| b.convection(coefficient));
        let outside = facing(Facing::Measured { channel: outdoors }, Some(outer));
        let inside = b.inside(zone, inner, 0.9);
        b.surface(&format!("wall{room}"), wall, [area, 90.0, 0.0], outside, inside);
        outwards.push(area / (1.0 / 20.0 + 0.02 / 0.2 + 1.0 / 5.0));
        set_points.push((room % 3 != 2).then_some(18.0 + 0.25 * (room % 5) as f64));
    }
    set_points[rooms - 1] = Some(30.0);
    let mut loads = Vec::new();
    for (room, set_point) in set_points.iter().enumerate() {
        let temperature = set_point.map(|at| b.number("setpoint", at));
        let capacity = (room + 1 == rooms).then(|| b.number("capacity", CAPACITY));
        let setpoint = temperature.map(|temperature| SetPoint::Constant { temperature });
        loads.push(setpoint.map(|setpoint| IdealLoad {
            setpoint,
            capacity,
            radiative: None,
            schedule: None,
        }));
    }
    let flow_number = b.number("flow", flow);
    let air = [1.2, AIR / 1.2].map(|value| b.number("air", value));
    let mut d = b.describe();
    (d.site.air_density, d.site.air_specific_heat) = (Some(air[0]), Some(air[1]));
    for (zone, load) in d.zones.iter_mut().zip(loads) {
        zone.heating = load;
    }
    for room in 1..rooms {
        let path = AirPath {
            name: format!("path{room}"),
            between: [room - 1, room],
            flow: flow_number,
            schedule: None,
            density: None,
            control: None,
        };
        d.air_paths.push(path);
    }
    Row { plan: Plan::new(d).unwrap(), set_points, outwards, between: flow * AIR }
}

impl Row {
    /// Temperatures [degC] and loads [W] at rest: no heated room but the last is colder than its set point, and those that are warmer
    /// have no load. By projected Gauss-Seidel iteration.
    fn at_rest(&self) -> Vec<[f64; 2]> {
        let rooms = self.outwards.len();
        let mut air = vec![OUTDOORS; rooms];
        let near = |room: usize| [room.checked_sub(1), (room + 1 < rooms).then_some(room + 1)];
        let losses = |air: &[f64], room: usize| {
            let to_rooms =
                near(room).into_iter().flatten().map(|other| self.between * (air[room] - air[other]));
            to_rooms.sum::<f64>() + self.outwards[room] * (air[room] - OUTDOORS)
        };
        for _ in 0..200_000 {
            for room in 0..rooms {
                let conductance =
                    self.outwards[room] + self.between * near(room).into_iter().flatten().count() as f64;
                let heat = if room + 1 == rooms { CAPACITY } else { 0.0 };
                let free = air[room] + (heat - losses(&air, room)) / conductance;
                let least = if room + 1 == rooms { None } else { self.set_points[room] };
                air[room] = least.map_or(free, |least| free.max(least));
            }
        }
        (0..rooms).map(|room| [air[room], losses(&air, room)]).collect()
    }
}

/// Loads at rest, rooms that hang together weakly and strongly: between rooms the air conducts from nothing to ten thousand times
/// what the walls conduct.
#[test]
fn loads_at_rest_are_those_of_the_balances() {
    for flow in [0.0, 0.02, 0.3, 5.0, 500.0] {
        for scheme in SCHEMES {
            let row = row(11, flow);
            let rows = forcing(&row.plan, scheme, 120, 3600.0, |_, row| set(row, 0, OUTDOORS));
            let outputs = (0..11)
                .flat_map(|zone| [Output::AirTemperature { zone }, Output::HeatingLoad { zone }])
                .collect();
            let result = run(&row.plan, &rows, &options(scheme, 3600.0, outputs));
            let last = &result.records[result.records.len() - 22..];
            let expected = row.at_rest();
            assert!(
                expected.iter().any(|&[_, load]| load > 100.0)
                    && expected.iter().any(|&[_, load]| load.abs() < 1e-6)
            );
            for (room, (found, [air, load])) in last.chunks(2).zip(expected).enumerate() {
                let place = format!("{scheme:?}, {flow} m3/s, room {room}");
                assert!((found[0] - air).abs() < 1e-6, "{place}: {} degC, expected {air}", found[0]);
                assert!(
                    (found[1] - load).abs() < 1e-6 * (load.abs() + row.between + 1.0),
                    "{place}: {} W, expected {load}",
                    found[1]
                );
            }
            // Of strongly mixed rooms, some steps in which many loads begin or end are divided.
            let divided = result.counters.halvings;
            assert!(divided == 0 || (flow > 1.0 && divided < 10), "{scheme:?}, {flow} m3/s: {divided}");
        }
    }
}

/// In random buildings the loads are those that the responses give.
#[test]
fn loads_are_those_of_the_responses() {
    let (mut compared, mut largest) = (0, 0.0_f64);
    for seed in 0..120 {
        let case = Case::new(seed, Contents::All);
        let plan = case.plan();
        let zones: Vec<usize> = (0..plan.zones.len()).collect();
        let d = &plan.description;
        if zones
            .iter()
            .filter(|&&zone| d.zones[zone].heating.is_some() || d.zones[zone].cooling.is_some())
            .count()
            < 2
        {
            continue;
        }
        let outputs = zones.iter().flat_map(|&zone| {
            [Output::AirTemperature { zone }, Output::HeatingLoad { zone }, Output::CoolingLoad { zone }]
        });
        let options = mascarin_engine::run::Options { outputs: outputs.collect(), ..case.options() };
        let rows = case.rows(&plan);
        let drive = Forcing::new(&rows, case.scheme.weights().len(), plan.n_channels()).unwrap();
        let numbers = values(&plan);
        let held = simulate(&plan, &numbers, &drive, &options, &RunControl::default()).unwrap();
        let duals: Vec<Dual<1>> = numbers.iter().map(|&number| Dual::constant(number)).collect();
        let direct = simulate(&plan, &duals, &drive, &options, &RunControl::default()).unwrap();
        if held.counters.halvings + direct.counters.halvings > 0 {
            continue;
        }
        for (a, b) in held.records.chunks(3).zip(direct.records.chunks(3)) {
            assert!((a[0] - b[0].value).abs() < 1e-4, "seed {seed}: {} degC, expected {}", a[0], b[0].value);
            for k in 1..3 {
                let (found, expected) = (a[k], b[k].value);
                largest = largest.max(expected);
                assert!(
                    (found - expected).abs() < 0.05 + 1e-4 * expected,
                    "seed {seed}: {found} W, expected {expected}"
                );
            }
        }
        compared += 1;
    }
    assert!(compared > 20 && largest > 1000.0, "{compared} buildings, {largest} W");
}
