//! Steps that Newton's iteration alone does not solve: a sharp melting range, thin layers, long steps, jumps of the weather.

#![allow(dead_code, reason = "every test program uses its own part")]

use mascarin_engine::Scheme;
use mascarin_engine::description::{
    Convection, Description, IdealLoad, MeltingCurve, PcmLaw, SetPoint, ZoneLongwave,
};
use mascarin_engine::forcing::channel;
use mascarin_engine::number::Real;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Run};
use mascarin_engine::state::Initial;

use crate::common::{Builder, forcing, options, set, try_run, values, weather};

/// Steps that are tried of each building, and how many of them difficult ones are looked for in.
const STEPS: usize = 48;
const MANY: usize = 2 * STEPS;

/// A zone behind three light walls of a material that melts within a few thousandths of a kelvin.
pub fn sharp(width: f64, thickness: f64, nodes: usize, heated: bool) -> Description {
    let mut b = Builder::new();
    let law = PcmLaw::Melting {
        latent_heat: b.number("law.latent_heat", 71e3),
        curve: MeltingCurve::Linear {
            melting_temperature: b.number("law.melting_temperature", 21.7),
            width: b.number("law.width", width),
        },
    };
    let pcm = b.pcm("pcm", [[0.6, 0.2], [3134.0, 2833.0]], 855.0, law);
    let wall = b.construction("wall", &[(pcm, thickness, nodes)]);
    let zone = b.zone("zone", 27.0, 0.5, ZoneLongwave::Radiosity);
    for (name, azimuth) in [("north", 0.0), ("east", 90.0), ("south", 180.0)] {
        let tarp = Convection::law("tarp", &[("factor", b.number("tarp.factor", 1.0))]);
        let mowitt = Convection::law("mowitt", &[("factor", b.number("mowitt.factor", 1.0))]);
        let (outside, inside) = (b.outdoors(mowitt, 0.9, 0.6), b.inside(zone, tarp, 0.9));
        b.surface(name, wall, [9.0, 90.0, azimuth], outside, inside);
    }
    let set_point = b.channel("set_point");
    let mut d = b.describe();
    if heated {
        let setpoint = SetPoint::Scheduled { channel: set_point };
        d.zones[0].heating = Some(IdealLoad { setpoint, capacity: None, radiative: None, schedule: None });
    }
    d
}

/// Air temperatures that jump by 20 K and a set point that jumps by 10 K, constant over each step.
pub fn jumps(time: f64, dt: f64, row: &mut [f64]) {
    let end = (time / dt - 1e-6).ceil() * dt;
    weather(end, row);
    row[channel::AIR_TEMPERATURE] += 10.0 * Real::sin(end / 7000.0).signum();
    set(row, 0, if (end / 3600.0).rem_euclid(6.0) < 3.0 { 15.0 } else { 25.0 });
}

/// One step of a building from a given state.
pub struct Step {
    pub name: String,
    pub plan: Plan,
    pub scheme: Scheme,
    /// [s].
    pub dt: f64,
    /// What drives it, the same at each stage.
    pub rows: Vec<f64>,
    pub initial: Initial,
    pub run: Run<f64>,
}

impl Step {
    /// Options of the step cut into equal parts.
    pub fn options(&self, parts: usize) -> Options {
        let initial = self.initial.clone();
        Options { initial, ..options(self.scheme, self.dt / parts as f64, outputs()) }
    }

    /// Whether Newton's iteration alone did not solve it.
    pub fn is_difficult(&self) -> bool {
        self.run.counters.halvings + self.run.counters.nested > 0
    }

    /// The step at other parameters.
    pub fn at(&self, numbers: &[f64]) -> Run<f64> {
        try_run(&self.plan, numbers, &self.rows, &self.options(1)).unwrap()
    }
}

/// What is recorded.
pub fn outputs() -> Vec<Output> {
    let surface = |surface| Output::FaceTemperature { surface, side: 1 };
    let liquid = |surface| Output::LiquidFraction { surface, layer: 0 };
    let zone = [Output::AirTemperature { zone: 0 }, Output::HeatingLoad { zone: 0 }];
    zone.into_iter().chain((0..3).map(surface)).chain((0..3).map(liquid)).collect()
}

/// Steps that Newton's iteration alone does not solve.
pub fn steps(scheme: Scheme, heated: bool) -> Vec<Step> {
    first_steps(scheme, heated, MANY).into_iter().filter(Step::is_difficult).collect()
}

/// Steps of some buildings, each run alone.
pub fn all_steps(scheme: Scheme, heated: bool) -> Vec<Step> {
    first_steps(scheme, heated, STEPS)
}

fn first_steps(scheme: Scheme, heated: bool, count: usize) -> Vec<Step> {
    let mut found = Vec::new();
    for (width, thickness, nodes, dt) in [
        (1e-3, 0.003, 4, 10_800.0),
        (1e-3, 0.003, 6, 3600.0),
        (1e-3, 0.006, 4, 10_800.0),
        (1e-3, 0.006, 6, 10_800.0),
        (1e-3, 0.006, 8, 3600.0),
        (1e-3, 0.006, 8, 10_800.0),
        (3e-3, 0.006, 8, 10_800.0),
        (6e-3, 0.010, 6, 10_800.0),
        (1e-2, 0.006, 8, 10_800.0),
        (1e-2, 0.010, 6, 10_800.0),
    ] {
        let plan = Plan::new(sharp(width, thickness, nodes, heated)).unwrap();
        let rows = forcing(&plan, scheme, count, dt, |time, row| jumps(time, dt, row));
        let mut initial = Initial::Everywhere(20.0);
        for (step, rows) in rows.chunks(rows.len() / count).enumerate() {
            let options = Options { initial: initial.clone(), ..options(scheme, dt, outputs()) };
            let run = try_run(&plan, &values(&plan), rows, &options).unwrap();
            let state = &run.state;
            let next = Initial::Given {
                cells: state.cells.clone(),
                surfaces: state.surfaces.to_vec(),
                air: state.air.clone(),
            };
            let initial = core::mem::replace(&mut initial, next);
            let name = format!("{width} K, {thickness} m, {nodes} cells, step {step} of {dt} s, {scheme:?}");
            let (plan, rows) = (plan.clone(), rows.to_vec());
            found.push(Step { name, plan, scheme, dt, rows, initial, run });
        }
    }
    found
}
