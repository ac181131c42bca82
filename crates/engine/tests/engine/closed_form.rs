//! Cases whose answer is known in closed form.

#![allow(
    clippy::disallowed_methods,
    reason = "closed answers are computed with other functions than the engine's"
)]

use crate::common::{Builder, facing, forcing, options, relative, run, set};
use core::f64::consts::TAU;
use mascarin_engine::Scheme;
use mascarin_engine::description::{Convection, Facing, ZoneLongwave};
use mascarin_engine::forcing::channel;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Warmup;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::state::Initial;

const DAY: f64 = 86400.0;

/// erf by its Maclaurin series: exact to round-off for the small arguments used here.
fn erf(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for n in 1..200 {
        term *= -x * x / f64::from(n);
        sum += term / f64::from(2 * n + 1);
    }
    sum * 2.0 / core::f64::consts::PI.sqrt()
}

/// Root of a falling function by bisection.
fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A wall with its outer surface at a measured temperature and an adiabatic inside.
fn wall(b: &mut Builder, material: usize, thickness: f64, nodes: usize) {
    let measured = b.channel("surface");
    let construction = b.construction("wall", &[(material, thickness, nodes)]);
    b.surface(
        "wall",
        construction,
        [1.0, 90.0, 0.0],
        facing(Facing::Measured { channel: measured }, None),
        facing(Facing::Adiabatic, None),
    );
}

/// `T = Tm + A e^(-x/d) cos(wt - x/d)` in a semi-infinite solid.
#[test]
fn sinusoid_in_a_thick_solid() {
    let (k, rho, c, amplitude, dt) = (1.0, 2000.0, 1000.0, 10.0, 300.0);
    let w = TAU / DAY;
    let d = (2.0 * k / (rho * c) / w).sqrt();
    let mut b = Builder::new();
    let solid = b.solid("solid", k, rho, c);
    wall(&mut b, solid, 1.2, 240);
    let depths = [0.05, 0.1, 0.2];
    let outputs = depths.map(|depth| Output::Sensor { sensor: b.sensor(0, depth) });
    let plan = b.plan();
    let rows =
        forcing(&plan, Scheme::Sdirk2, 288, dt, |time, row| set(row, 0, 20.0 + amplitude * (w * time).cos()));
    let mut options = options(Scheme::Sdirk2, dt, outputs.to_vec());
    options.warmup = Some(Warmup { steps: 288, tolerance: 1e-4, max_cycles: 500 });
    let result = run(&plan, &rows, &options);
    for (row, record) in result.records.chunks(depths.len()).enumerate() {
        for (&x, &t) in depths.iter().zip(record) {
            let expected = 20.0 + amplitude * (-x / d).exp() * (w * row as f64 * dt - x / d).cos();
            assert!((t - expected).abs() < 0.004, "{t} is not {expected} at {x} m, row {row}");
        }
    }
}

/// Melted thickness of a wall of PCM [m] after some steps from a uniform temperature with a jump at the surface.
struct Melting {
    conductivity: [f64; 2],
    specific_heat: [f64; 2],
    density: f64,
    latent_heat: f64,
    melts_at: f64,
    width: f64,
    initial: f64,
    hot: f64,
    thickness: f64,
}

impl Melting {
    fn front(&self, nodes: usize, dt: f64, steps: usize) -> f64 {
        let mut b = Builder::new();
        let law = b.tanh(self.latent_heat, self.melts_at, self.width);
        let pcm = b.pcm("pcm", [self.conductivity, self.specific_heat], self.density, law);
        wall(&mut b, pcm, self.thickness, nodes);
        let plan = b.plan();
        let rows = forcing(&plan, Scheme::Sdirk2, steps, dt, |_, row| set(row, 0, self.hot));
        let mut options = options(Scheme::Sdirk2, dt, vec![Output::LiquidFraction { surface: 0, layer: 0 }]);
        options.initial = Initial::Everywhere(self.initial);
        let result = run(&plan, &rows, &options);
        assert!(result.energy_balance.closure() < 1e-10);
        result.records[steps] * self.thickness
    }

    /// Neumann's similarity solution.
    fn neumann(&self, time: f64) -> f64 {
        let [a_s, a_l] = [0, 1].map(|i| self.conductivity[i] / (self.density * self.specific_heat[i]));
        let ste = self.specific_heat[1] * (self.hot - self.melts_at) / self.latent_heat;
        let subcooling = self.conductivity[0] * a_l.sqrt() * (self.melts_at - self.initial)
            / (self.conductivity[1] * a_s.sqrt() * (self.hot - self.melts_at));
        let lambda = root(
            |l: f64| {
                ste / ((l * l).exp() * erf(l))
                    - subcooling * ste * (-l * l * a_l / a_s).exp() / (1.0 - erf(l * (a_l / a_s).sqrt()))
                    - l * core::f64::consts::PI.sqrt()
            },
            1e-3,
            2.0,
        );
        2.0 * lambda * (a_l * time).sqrt()
    }
}

/// Two phases with different properties: the front within 0.3 % on 1 mm cells at 300 s.
#[test]
fn stefan_neumann_two_phases() {
    let case = Melting {
        conductivity: [0.35, 0.20],
        specific_heat: [2000.0, 2400.0],
        density: 850.0,
        latent_heat: 150e3,
        melts_at: 26.0,
        width: 0.04, // gamma 1 at delta T 0.01
        initial: 16.0,
        hot: 46.0,
        thickness: 0.6,
    };
    let steps = 288;
    let expected = case.neumann(300.0 * steps as f64);
    let front = case.front(600, 300.0, steps);
    assert!(relative(front, expected) < 3e-3, "front at {front} m, expected {expected}");
}

/// One phase, published: 81.44 % of 0.1 m melted after 10 h, lambda 0.258415.
#[test]
fn stefan_one_phase() {
    let case = Melting {
        conductivity: [1.5; 2],
        specific_heat: [2500.0; 2],
        density: 870.0,
        latent_heat: 179e3,
        melts_at: 26.0,
        width: 0.004, // gamma 10
        initial: 25.98,
        hot: 36.0,
        thickness: 0.1,
    };
    assert!(relative(case.neumann(36000.0), 0.08144) < 2e-3);
    let melted = case.front(100, 300.0, 120) / case.thickness;
    assert!(relative(melted, 0.8144) < 3e-3, "{melted} melted, expected 0.8144");
}

/// A zone behind a resistance: `T = T1 + (T0 - T1) e^(-t/tau)`. Every law that makes 4 W/(m2 K) in still air serves.
#[test]
fn lumped_zone() {
    step_response(|b| b.convection(4.0));
    step_response(|b| {
        Convection::law(
            "linear_wind",
            &[("constant", b.number("convection.constant", 4.0)), ("wind", b.number("convection.wind", 3.0))],
        )
    });
    step_response(|b| b.power([4.0, 0.0, 0.3, 0.0, 1.0], [4.0, 0.0, 0.3, 0.0, 1.0]));
    step_response(|b| b.power([0.0, 4.0, 0.0, 0.0, 1.0], [0.0, 4.0, 0.0, 0.0, 1.0]));
}

fn step_response(law: impl Fn(&mut Builder) -> Convection) {
    let mut b = Builder::new();
    let measured = b.channel("outer");
    let barrier = b.resistance("barrier", 0.5);
    let wall = b.construction("wall", &[(barrier, 0.0, 0)]);
    let zone = b.zone("room", 30.0, 0.7, ZoneLongwave::None);
    let (outer, inner) = (b.convection(20.0), law(&mut b));
    let inside = b.inside(zone, inner, 0.9);
    b.surface(
        "wall",
        wall,
        [12.0, 90.0, 0.0],
        facing(Facing::Measured { channel: measured }, Some(outer)),
        inside,
    );
    let plan = b.plan();
    let (dt, steps) = (15.0, 960);
    let rows = forcing(&plan, Scheme::Sdirk2, steps, dt, |_, row| {
        set(row, 0, 35.0);
        row[channel::AIR_TEMPERATURE] = 10.0;
        row[channel::WIND_SPEED] = 7.0;
    });
    let result = run(&plan, &rows, &options(Scheme::Sdirk2, dt, vec![Output::AirTemperature { zone: 0 }]));
    let pressure = 101_325.0 * (1.0 - 2.25577e-5 * 55.0_f64).powf(5.25588);
    let air = 30.0 * 1006.0 * pressure / (287.055 * 288.15);
    let through = 12.0 / (1.0 / 20.0 + 0.5 + 1.0 / 4.0);
    let entering = air * 0.7 / 3600.0;
    let end = (through * 35.0 + entering * 10.0) / (through + entering);
    for (row, &t) in result.records.iter().enumerate() {
        let expected = end + (20.0 - end) * (-(through + entering) * row as f64 * dt / air).exp();
        assert!((t - expected).abs() < 1e-5, "{t} is not {expected} in row {row}");
    }
    assert!(result.energy_balance.closure() < 1e-11);
}

/// Two zones in series between 30 and 10 degC, with air changes, worked out by hand from the two balances.
#[test]
fn two_zones_at_rest() {
    let mut b = Builder::new();
    let (hot, cold) = (b.channel("hot"), b.channel("cold"));
    let brick = b.solid("brick", 0.7, 1800.0, 900.0);
    let wall = b.construction("wall", &[(brick, 0.14, 3)]);
    let zones = ["a", "b"].map(|name| b.zone(name, 20.0, 0.5, ZoneLongwave::None));
    let place = [10.0, 90.0, 0.0];
    let constant = |b: &mut Builder| b.convection(5.0);
    let f = constant(&mut b);
    let inside = b.inside(zones[0], f, 0.9);
    b.surface("hot", wall, place, facing(Facing::Measured { channel: hot }, None), inside);
    let (f, g) = (constant(&mut b), constant(&mut b));
    let (outside, inside) = (b.inside(zones[0], f, 0.9), b.inside(zones[1], g, 0.9));
    b.surface("middle", wall, place, outside, inside);
    let f = constant(&mut b);
    let inside = b.inside(zones[1], f, 0.9);
    b.surface("cold", wall, place, facing(Facing::Measured { channel: cold }, None), inside);
    let plan = b.plan();
    let rows = forcing(&plan, Scheme::BackwardEuler, 400, 36000.0, |_, row| {
        set(row, 0, 30.0);
        set(row, 1, 10.0);
        row[channel::AIR_TEMPERATURE] = 5.0;
    });
    let outputs = vec![Output::AirTemperature { zone: 0 }, Output::AirTemperature { zone: 1 }];
    let result = run(&plan, &rows, &options(Scheme::BackwardEuler, 36000.0, outputs));
    // Walls: 0.14/0.7 = 0.2 m2K/W; with one surface resistance 0.4, with two 0.6: 25 and 16.667 W/K.
    let (outer, middle) = (25.0, 10.0 / 0.6);
    let pressure = 101_325.0 * (1.0 - 2.25577e-5 * 55.0_f64).powf(5.25588);
    let air = 20.0 * 1006.0 * pressure / (287.055 * 288.15) * 0.5 / 3600.0;
    // (outer + middle + air) Ta - middle Tb = outer 30 + air 5, and the same for b with 10.
    let (diagonal, determinant) = (outer + middle + air, (outer + middle + air).powi(2) - middle * middle);
    let (f, g) = (outer * 30.0 + air * 5.0, outer * 10.0 + air * 5.0);
    let expected = [(f * diagonal + g * middle) / determinant, (g * diagonal + f * middle) / determinant];
    let last = &result.records[result.records.len() - 2..];
    for (t, expected) in last.iter().zip(expected) {
        assert!((t - expected).abs() < 1e-9, "{t} is not {expected}");
    }
}

/// Surface temperature of a wall under a smooth swing, for orders of convergence.
fn swing(nodes: usize, dt: f64, scheme: Scheme) -> f64 {
    let mut b = Builder::new();
    let solid = b.solid("solid", 0.8, 1600.0, 900.0);
    let measured = b.channel("air");
    let construction = b.construction("wall", &[(solid, 0.2, nodes)]);
    let convection = b.convection(8.0);
    b.surface(
        "wall",
        construction,
        [1.0, 90.0, 0.0],
        facing(Facing::Measured { channel: measured }, Some(convection)),
        facing(Facing::Adiabatic, None),
    );
    let plan = b.plan();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand steps")]
    let steps = (DAY / dt).round() as usize;
    // Starts flat, so that the initial state agrees with the forcing.
    let rows = forcing(&plan, scheme, steps, dt, |time, row| {
        set(row, 0, 20.0 + 10.0 * (TAU * time / DAY).sin().powi(2));
    });
    let result =
        run(&plan, &rows, &options(scheme, dt, vec![Output::FaceTemperature { surface: 0, side: 1 }]));
    result.records[result.records.len() - 1]
}

fn order(coarse: f64, middle: f64, fine: f64) -> f64 {
    ((coarse - middle) / (middle - fine)).abs().log2()
}

#[test]
fn orders_of_convergence() {
    let in_dx = order(
        swing(8, 300.0, Scheme::Sdirk2),
        swing(16, 300.0, Scheme::Sdirk2),
        swing(32, 300.0, Scheme::Sdirk2),
    );
    assert!((in_dx - 2.0).abs() < 0.1, "order {in_dx} in dx");
    for (scheme, expected) in [(Scheme::Sdirk2, 2.0), (Scheme::BackwardEuler, 1.0)] {
        let in_dt = order(swing(8, 1200.0, scheme), swing(8, 600.0, scheme), swing(8, 300.0, scheme));
        assert!((in_dt - expected).abs() < 0.12, "order {in_dt} in dt for {scheme:?}");
    }
}

/// Backward Euler stays between the extremes of what acts on it, whatever the step.
#[test]
fn maximum_principle() {
    for dt in [60.0, 900.0, 7200.0] {
        let mut b = Builder::new();
        let solid = b.solid("solid", 0.8, 1600.0, 900.0);
        let pcm = b.energain(0.4);
        let measured = b.channel("surface");
        let construction = b.construction("wall", &[(solid, 0.05, 10), (pcm, 0.01, 8), (solid, 0.02, 4)]);
        let zone = b.zone("room", 10.0, 0.0, ZoneLongwave::Radiosity);
        let convection = Convection::law("tarp", &[("factor", b.number("factor", 1.0))]);
        let inside = b.inside(zone, convection, 0.9);
        b.surface(
            "wall",
            construction,
            [10.0, 90.0, 0.0],
            facing(Facing::Measured { channel: measured }, None),
            inside,
        );
        let plan = b.plan();
        let rows = forcing(&plan, Scheme::BackwardEuler, 200, dt, |time, row| {
            // Jumps between 10 and 40 degC.
            set(row, 0, if (time / 7200.0) % 2.0 < 1.0 { 10.0 } else { 40.0 });
        });
        let mut outputs = vec![Output::AirTemperature { zone: 0 }];
        outputs.extend((1..3).map(|interface| Output::InterfaceTemperature { surface: 0, interface }));
        let result = run(&plan, &rows, &options(Scheme::BackwardEuler, dt, outputs));
        for t in result.records.iter().chain(&result.state.cells) {
            assert!((10.0 - 1e-9..=40.0 + 1e-9).contains(t), "{t} degC at steps of {dt} s");
        }
    }
}

/// Rows hold what the plan promises.
#[test]
fn unknown_parts_are_refused() {
    let mut description = crate::common::cell(0.04);
    description.surfaces[0].construction = 99;
    assert!(Plan::new(description).is_err());
}
