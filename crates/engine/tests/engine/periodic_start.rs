//! Experiment.
use crate::common::random::{Case, Contents};
use crate::common::{Builder, forcing, options, try_run, values, warmup, weather};
use mascarin_engine::description::ZoneLongwave;
use mascarin_engine::march::{Options, Scheme, Warmup};
use mascarin_engine::plan::Plan;
use mascarin_engine::probe::Probe;
use std::fmt::Write as _;

fn heavy(thickness: f64, insulation: f64) -> Plan {
    let mut b = Builder::new();
    let concrete = b.solid("concrete", 1.75, 2240.0, 900.0);
    let foam = b.solid("foam", 0.03, 30.0, 1470.0);
    let mut layers = vec![(concrete, thickness, 12)];
    if insulation > 0.0 {
        layers.insert(0, (foam, insulation, 4));
    }
    let wall = b.construction("wall", &layers);
    let room = b.zone("room", 60.0, 0.3, ZoneLongwave::Radiosity);
    let (h_out, h_in) = (b.convection(20.0), b.convection(3.0));
    for azimuth in [0.0, 90.0, 180.0, 270.0] {
        let (outside, inside) = (b.outdoors(h_out.clone(), 0.9, 0.5), b.inside(room, h_in.clone(), 0.9));
        b.surface("wall", wall, [12.0, 90.0, azimuth], outside, inside);
    }
    let (outside, inside) = (b.outdoors(h_out, 0.9, 0.5), b.inside(room, h_in.clone(), 0.9));
    b.surface("roof", wall, [20.0, 0.0, 0.0], outside, inside);
    b.plan()
}

#[test]
#[ignore]
fn experiment() {
    let count: u64 = std::env::var("COUNT").map_or(100, |t| t.parse().unwrap());
    let mut text = String::new();
    for (d, i) in [(0.2, 0.0), (0.5, 0.0), (0.2, 0.1), (0.5, 0.1), (0.5, 0.3), (1.0, 0.2)] {
        let plan = heavy(d, i);
        let rows = forcing(&plan, Scheme::Sdirk2, 96, 900.0, |t, r| weather(t % 86400.0, r));
        let o = Options { warmup: Some(Warmup { max_cycles: 2000, tolerance: std::env::var("TOL").map_or(0.01, |t| t.parse().unwrap()), ..warmup(900.0) }), ..options(Scheme::Sdirk2, 900.0, vec![Probe::AirTemperature { zone: 0 }]) };
        let r = try_run(&plan, &values(&plan), &rows, &o).unwrap();
        writeln!(text, "heavy {d} {i}: {} {:.5}", r.cycles, r.records[0]).unwrap();
    }
    for contents in [Contents::All, Contents::ImposedTemperatures] {
        for seed in 1..=count {
            let mut case = Case::new(seed, contents);
            let w = warmup(case.dt);
            case.steps = w.steps;
            let plan = case.plan();
            let o = Options { warmup: Some(Warmup { max_cycles: 1000, tolerance: std::env::var("TOL").map_or(0.01, |t| t.parse().unwrap()), ..w }), ..case.options() };
            if std::env::var("ONE").is_ok_and(|t| t.parse::<u64>().unwrap() != seed) { continue; }
            match try_run(&plan, &values(&plan), &case.rows(&plan), &o) {
                Ok(r) => {
                    let n = o.probes.len();
                    let temps: Vec<String> = o.probes.iter().zip(&r.records[..n]).filter(|(p, _)| matches!(p, Probe::AirTemperature { .. } | Probe::Sensor { .. } | Probe::FaceTemperature { .. })).map(|(_, t)| format!("{t:.4}")).collect();
                    writeln!(text, "{contents:?} {seed}: {} {}", r.cycles, temps.join(" ")).unwrap();
                }
                Err(e) => writeln!(text, "{contents:?} {seed}: 9999 {e}").unwrap(),
            }
        }
    }
    std::fs::write(std::env::var("OUTFILE").unwrap(), text).unwrap();
}
