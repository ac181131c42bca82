//! The first step after a jump, and the order of the scheme, against closed answers.

#![allow(
    clippy::disallowed_methods,
    reason = "closed answers are computed with other functions than the engine's"
)]

use core::f64::consts::TAU;

use crate::common::{Builder, facing, forcing, options, run, set};
use mascarin_engine::derivatives::{Trajectory, jacobian};
use mascarin_engine::description::Facing;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Warmup;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::{RunControl, Scheme};

use crate::common::{position, values};

/// A slab that exchanges heat with air of a given temperature on one side and is adiabatic on the other.
fn slab(conductivity: f64, thickness: f64, nodes: usize, coefficient: f64) -> Plan {
    let mut b = Builder::new();
    let solid = b.solid("solid", conductivity, 2000.0, 1000.0);
    let measured = b.channel("air");
    let construction = b.construction("wall", &[(solid, thickness, nodes)]);
    let convection = b.convection(coefficient);
    let outside = facing(Facing::Measured { channel: measured }, Some(convection));
    b.surface("wall", construction, [2.0, 90.0, 0.0], outside, facing(Facing::Adiabatic, None));
    b.plan()
}

const OUTER: Output = Output::FaceTemperature { surface: 0, side: 0 };

/// Temperatures of the outer surface after a jump of the air from 20 to 0 degC.
fn jump(plan: &Plan, scheme: Scheme, dt: f64, steps: usize) -> Vec<f64> {
    let rows = forcing(plan, scheme, steps, dt, |_, row| set(row, 0, 0.0));
    run(plan, &rows, &options(scheme, dt, vec![OUTER])).records
}

/// `exp(x^2) erfc(x)` by its continued fraction (Abramowitz & Stegun 7.1.14) and, for small x, its series (7.1.5).
fn scaled_erfc(x: f64) -> f64 {
    if x > 2.0 {
        let mut fraction = x;
        for n in (1..200).rev() {
            fraction = x + 0.5 * f64::from(n) / fraction;
        }
        return 1.0 / (core::f64::consts::PI.sqrt() * fraction);
    }
    let (mut term, mut sum) = (x, x);
    for n in 1..200 {
        term *= -x * x / f64::from(n);
        sum += term / f64::from(2 * n + 1);
    }
    (x * x).exp() * (1.0 - 2.0 / core::f64::consts::PI.sqrt() * sum)
}

/// A thin sheet is one heat capacity: `T = 20 e^(-h t/(rho c d))`, here with a time constant of an hour.
#[test]
fn a_lumped_sheet_cools_exponentially() {
    let (thickness, h) = (0.0144, 8.0);
    let plan = slab(400.0, thickness, 3, h);
    let records = jump(&plan, Scheme::Sdirk2, 900.0, 8);
    for (row, &found) in records.iter().enumerate().skip(1) {
        let expected = 20.0 * (-h * 900.0 * row as f64 / (2000.0 * 1000.0 * thickness)).exp();
        let bound = if row == 1 { 0.004 } else { 0.05 };
        assert!((found - expected).abs() < bound, "row {row}: {found} is not {expected}");
    }
}

/// The surface of a semi-infinite solid: `T = 20 e^(x^2) erfc(x)`, `x = h sqrt(t/(k rho c))` (Carslaw & Jaeger 1959, sec. 2.7).
/// The first record is as good as those after it.
#[test]
fn the_first_record_after_a_jump_is_right() {
    for (h, dt) in [(8.0, 900.0), (25.0, 900.0), (8.0, 3600.0), (25.0, 3600.0)] {
        // Cells of 0.5 mm: their own error is a hundredth of what is tested.
        let plan = slab(0.5, 0.5, 1000, h);
        let records = jump(&plan, Scheme::Sdirk2, dt, 4);
        let worst = records.iter().enumerate().skip(1).fold(0.0_f64, |worst, (row, found)| {
            let x = h * (dt * row as f64 / (0.5 * 2000.0 * 1000.0)).sqrt();
            worst.max((found - 20.0 * scaled_erfc(x)).abs())
        });
        assert!(worst < 0.05, "h {h}, steps of {dt} s: {worst} K");
    }
}

/// Amplitude [K] and lag [s] of the surface of a slab in air that swings by 10 K within a day.
fn swing(dt: f64) -> [f64; 2] {
    let plan = slab(0.8, 0.2, 80, 8.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred steps")]
    let steps = (86400.0 / dt).round() as usize;
    let rows = forcing(&plan, Scheme::Sdirk2, steps, dt, |time, row| {
        set(row, 0, 10.0 * (TAU * time / 86400.0).cos());
    });
    let mut options = options(Scheme::Sdirk2, dt, vec![OUTER]);
    options.warmup = Some(Warmup { steps, tolerance: 1e-7, max_cycles: 500 });
    let records = run(&plan, &rows, &options).records;
    let [mut cosine, mut sine] = [0.0; 2];
    for (row, &value) in records.iter().enumerate().skip(1) {
        let angle = TAU * row as f64 / steps as f64;
        cosine += 2.0 * value * angle.cos() / steps as f64;
        sine += 2.0 * value * angle.sin() / steps as f64;
    }
    [cosine.hypot(sine), sine.atan2(cosine) / TAU * 86400.0]
}

/// `T/T_air = 1/(1 + k m/h tanh(m L))` with `m = sqrt(i w rho c/k)`: amplitude and lag.
fn exact_swing() -> [f64; 2] {
    let (k, length, h) = (0.8, 0.2, 8.0_f64);
    // m = (1 + i) r.
    let r = (TAU / 86400.0 * 2e6 / (2.0 * k)).sqrt();
    // tanh(a + i a) = (sinh 2a + i sin 2a)/(cosh 2a + cos 2a).
    let a = r * length;
    let below = (2.0 * a).cosh() + (2.0 * a).cos();
    let (u, v) = ((2.0 * a).sinh() / below, (2.0 * a).sin() / below);
    let (real, imaginary) = (1.0 + k * r / h * (u - v), k * r / h * (u + v));
    [10.0 / real.hypot(imaginary), imaginary.atan2(real) / TAU * 86400.0]
}

/// Second order: half the step, a quarter of the error. At 15 min the swing of a massive slab is right to 0.01 % and 5 s.
#[test]
fn a_daily_swing_is_followed_with_second_order() {
    let exact = exact_swing();
    let errors = [3600.0, 1800.0, 900.0].map(|dt| {
        let found = swing(dt);
        [found[0] - exact[0], found[1] - exact[1]]
    });
    let [hour, half, quarter] = errors;
    assert!(hour[0].abs() < 2e-3 * exact[0] && hour[1].abs() < 60.0, "{hour:?} of {exact:?}");
    assert!(quarter[0].abs() < 2e-4 * exact[0] && quarter[1].abs() < 5.0, "{quarter:?} of {exact:?}");
    assert!(half[0].abs() < 0.4 * hour[0].abs() && half[1].abs() < 0.4 * hour[1].abs(), "{errors:?}");
}

/// The parts of the first step are the same for a member alone and in lanes, and slopes go through them both ways.
#[test]
fn lanes_and_slopes_go_through_the_parts() {
    let plan = slab(0.8, 0.2, 6, 8.0);
    let (dt, steps) = (900.0, 3);
    let rows = forcing(&plan, Scheme::Sdirk2, steps, dt, |_, row| set(row, 0, 0.0));
    let (options, watch) = (options(Scheme::Sdirk2, dt, vec![OUTER]), RunControl::default());
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let alone = run(&plan, &rows, &options);
    let together = ensemble(&plan, &values(&plan).repeat(9), &drive, &options, &watch).unwrap();
    for member in together.records.chunks(alone.records.len()) {
        assert!(member.iter().zip(&alone.records).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
    let coefficient = position(&plan, "convection.coefficient");
    let forward = jacobian(&plan, &values(&plan), &[coefficient], &drive, &options, &watch).unwrap();
    let shifted = |by: f64| {
        let mut numbers = values(&plan);
        numbers[coefficient] += by;
        crate::common::try_run(&plan, &numbers, &rows, &options).unwrap().records
    };
    let (more, less) = (shifted(1e-4), shifted(-1e-4));
    let trajectory = Trajectory::new(&plan, &values(&plan), &drive, &options, &watch, 1 << 30).unwrap();
    for row in 1..=steps {
        let difference = (more[row] - less[row]) / 2e-4;
        let slope = forward.slopes[row];
        assert!((slope - difference).abs() < 1e-6, "row {row}: {slope} is not {difference}");
        let mut weights = vec![0.0; steps + 1];
        weights[row] = 1.0;
        let reverse = trajectory.pull(&plan, &values(&plan), &drive, &options, &watch, &weights).unwrap();
        assert!((reverse[coefficient] - slope).abs() < 1e-10, "row {row}, in reverse");
    }
}
