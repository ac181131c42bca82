//! Time of one run and of an ensemble for a box of six walls, and for the cell of the tests.
//!
//! `cargo run --release --example ensemble [days] [members]`; for instruction counts run it under
//! `valgrind --tool=callgrind` with few days.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::{Builder, cell, cell_weather, facing, forcing, options, set, values, warmup};
use mascarin_engine::batch::ensemble;
use mascarin_engine::description::{Convection, Description, Facing, ZoneLongwave};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::march::{Watch, march};
use mascarin_engine::plan::Plan;
use mascarin_engine::probe::Probe;
use mascarin_engine::real::Real;
use mascarin_engine::step::Scheme;

/// Six walls of foam and concrete, a roof of foam and PCM; TARP inside, `MoWiTT` outside.
fn six_walls() -> Description {
    let mut b = Builder::new();
    let concrete = b.solid("concrete", 1.75, 2240.0, 900.0);
    let foam = b.solid("foam", 0.028, 30.0, 1470.0);
    let energain = b.energain(0.04);
    let wall = b.construction("wall", &[(foam, 0.07, 5), (concrete, 0.05, 4)]);
    let roof = b.construction("roof", &[(foam, 0.07, 5), (energain, 0.00526, 4)]);
    let room = b.zone("room", 27.0, 0.2, ZoneLongwave::Radiosity);
    let soil = b.channel("soil");
    let places = [[90.0, 0.0], [90.0, 90.0], [90.0, 180.0], [90.0, 270.0], [0.0, 0.0]];
    for (i, place) in places.into_iter().enumerate() {
        let film_out = Convection::Mowitt { factor: b.number("mowitt.factor", 1.0) };
        let film_in =
            Convection::Tarp { factor: b.number("tarp.factor", 1.0), roughness: None, perimeter: None };
        let (outside, inside) = (b.outdoors(film_out, 0.9, 0.4), b.inside(room, film_in, 0.9));
        let construction = if i < 4 { wall } else { roof };
        b.surface(&format!("wall_{i}"), construction, [9.0, place[0], place[1]], outside, inside);
    }
    let film_in = Convection::Tarp { factor: b.number("tarp.factor", 1.0), roughness: None, perimeter: None };
    let inside = b.inside(room, film_in, 0.9);
    let outside = facing(Facing::Measured { channel: soil }, None);
    b.surface("floor", wall, [9.0, 180.0, 0.0], outside, inside);
    b.describe()
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse().expect("a whole number"));
    let days: usize = arguments.next().unwrap_or(92);
    let members: usize = arguments.next().unwrap_or(64);
    for (name, description) in [("box", six_walls()), ("cell", cell(0.04))] {
        let plan = Plan::new(description).expect("a sound description");
        let rows = forcing(&plan, Scheme::Sdirk2, 96 * days, 900.0, |time, row| {
            cell_weather(time, row);
            set(row, 0, 22.0);
        });
        let drive = Forcing::new(&rows, 2, plan.n_channels()).expect("a forcing of two stages");
        let mut options = options(Scheme::Sdirk2, 900.0, vec![Probe::AirTemperature { zone: 0 }]);
        options.warmup = Some(warmup(900.0));
        let numbers = values(&plan);
        let start = Instant::now();
        let run = march(&plan, &numbers, &drive, &options, &Watch::default()).expect("a run");
        println!(
            "{name}: one run {:.1} ms, {} iterations, closure {:.1e}",
            1e3 * start.elapsed().as_secs_f64(),
            run.counters.iterations,
            run.ledger.closure()
        );
        let mut all = Vec::new();
        for member in 0..members {
            all.extend(numbers.iter().map(|n| n * (1.0 + 1e-3 * Real::sin(member as f64))));
        }
        let start = Instant::now();
        let result = ensemble(&plan, &all, &drive, &options, &Watch::default()).expect("an ensemble");
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{name}: {members} members on {} threads: {:.1} ms each, {:.0} members/s, {} failed",
            rayon::current_num_threads(),
            1e3 * seconds / members.max(1) as f64,
            members as f64 / seconds,
            result.failures.len()
        );
    }
}
