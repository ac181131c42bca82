//! Laws of convection at the borders of their branches, and the limits that their sources state. Each is continuous within
//! round-off, or jumps by what its source has.

use super::testing::{id, power as power_law, surface};
use super::{SurfaceConvection, Wind, WindTerms};
use crate::input::description::Convection;
use crate::number::real::Real;

/// Coefficient at a difference [K] and a wind [m/s] on the windward side [W/(m2 K)].
fn at(surface: &SurfaceConvection<f64>, d: f64, wind: f64) -> f64 {
    surface.flux(d, &surface.forced(&Wind::new(wind, WindTerms::all()), true)).flux / d
}

/// Coefficients at 8 K, heat flowing up and down, just before and just behind a tilt [deg].
fn beside(law: &Convection, numbers: &[f64], tilt: f64) -> [[f64; 2]; 2] {
    [8.0, -8.0].map(|d| {
        [-1e-3, 1e-3].map(|more| at(&surface(law, numbers, Real::cos((tilt + more).to_radians())), d, 0.0))
    })
}

fn tarp() -> Convection {
    Convection::law("tarp", &[("factor", id(0))])
}

/// Relative jump.
fn jump([before, behind]: [f64; 2]) -> f64 {
    (behind / before - 1.0).abs()
}

#[track_caller]
fn assert_same(found: f64, expected: f64, within: f64) {
    assert!((found / expected - 1.0).abs() < within, "{found} is not {expected}");
}

/// 1.31 d^1/3 at the vertical, 9.482/6.238 = 1.520 and 1.810/2.382 = 0.760 at the level (Walton 1983). The branches meet at the
/// vertical without a jump, where they are within the rounding of their constants: 9.482/7.238 = 1.31003 and 1.810/1.382 = 1.30970.
#[test]
fn tarp_and_doe2() {
    let doe2 = Convection::law("doe2", &[("factor", id(0)), ("roughness", id(1))]);
    for law in [tarp(), doe2] {
        let at_tilt = |tilt: f64, d: f64| {
            // The wind of DOE-2 is never quite still.
            at(&surface(&law, &[1.0, 1.0], Real::cos(f64::to_radians(tilt))), d, 0.0)
        };
        assert_same(at_tilt(90.0, 8.0), 2.62, 1e-4);
        assert_same(at_tilt(0.0, 8.0), 2.0 * 1.520_038, 1e-4);
        assert_same(at_tilt(0.0, -8.0), 2.0 * 0.759_866, 1e-4);
        for border in [89.0, 90.0, 91.0] {
            for tilts in [[border, border + 1e-6], [border, border - 1e-6]] {
                for d in [8.0, -8.0] {
                    // At most 0.72 by a cosine that changes by 1.7e-8.
                    assert!(jump(tilts.map(|tilt| at_tilt(tilt, d))) < 2e-8, "{tilts:?} deg, {d} K");
                }
            }
        }
    }
}

/// In still air DOE-2 and `MoWiTT` are natural convection, in wind without a difference the law of the wind, with the larger
/// exponent windward; at 0 m/s no law with wind jumps.
#[test]
fn limits_of_the_wind() {
    let mowitt = surface(&Convection::law("mowitt", &[("factor", id(0))]), &[1.0], 0.0);
    assert_same(at(&mowitt, 8.0, 0.0), 0.84 * 2.0, 1e-3);
    assert_same(at(&mowitt, 1e-6, 4.0), 3.26 * Real::powf(4.0, 0.89), 1e-3);
    let doe2 = Convection::law("doe2", &[("factor", id(0)), ("roughness", id(1))]);
    assert_same(at(&surface(&doe2, &[1.0, 1.67], 0.0), 1e-6, 4.0), 1.67 * 3.26 * Real::powf(4.0, 0.89), 0.1);
    let linear =
        surface(&Convection::law("linear_wind", &[("constant", id(0)), ("wind", id(1))]), &[5.7, 3.8], 0.0);
    assert_same(at(&linear, 8.0, 0.0), 5.7, 1e-12);
    for surface in [&mowitt, &linear] {
        assert!((at(surface, 8.0, 2e-3) - at(surface, 8.0, 0.0)).abs() < 0.01);
    }
}

/// For vertical and for horizontal surfaces only: at 45 deg, where this program changes from one to the other, the coefficient
/// jumps from one formula to the other. Small differences are laminar, large ones turbulent.
#[test]
fn alamdari_and_hammond() {
    let law = Convection::law("alamdari_hammond", &[("length", id(0)), ("factor", id(1))]);
    let sixth = |a: f64, b: f64| Real::powf(Real::powf(a, 6.0) + Real::powf(b, 6.0), 1.0 / 6.0);
    let quarter = Real::powf(8.0 / 3.0, 0.25);
    let (wall, plate) = (sixth(1.5 * quarter, 1.23 * 2.0), sixth(1.4 * quarter, 1.63 * 2.0));
    let stable = 0.6 * Real::powf(8.0 / 9.0, 0.2);
    let [up, down] = beside(&law, &[3.0, 1.0], 45.0);
    for (found, expected) in up.into_iter().chain(down).zip([plate, wall, stable, wall]) {
        assert_same(found, expected, 1e-4);
    }
    let wall = surface(&law, &[3.0, 1.0], 0.0);
    assert_same(at(&wall, 1e3, 0.0), 1.23 * 10.0, 0.02);
    assert_same(at(&surface(&law, &[0.01, 1.0], 0.0), 1.0, 0.0), 1.5 * Real::powf(100.0, 0.25), 1e-3);
}

/// ISO 15099: one formula on both sides of the critical Rayleigh number and of the vertical; jumps at 15 deg, to a formula that
/// does not depend on the inclination, and at 179 deg, to that of a level plate.
#[test]
fn iso_15099() {
    let law = Convection::law("iso15099", &[("length", id(0)), ("factor", id(1))]);
    let per_cube = 1.2 * 1.2 * 9.806_65 * 1006.0 / (293.15 * 1.820_5e-5 * 0.025_621);
    // Vertical: Rac = 2.5e5 e^(0.72 90/5), reached by 5 m at 8.2 K.
    let critical = 2.5e5 * Real::exp(0.72 * 90.0 / 5.0);
    let glass = surface(&law, &[5.0, 1.0], 0.0);
    let turning = critical / (per_cube * 125.0);
    assert!(turning > 5.0 && turning < 12.0, "{turning}");
    let [before, behind] = [-1e-6, 1e-6].map(|more| at(&glass, turning + more, 0.0));
    assert!(jump([before, behind]) < 1e-6, "{before} and {behind}");
    let beyond = 8.0 * turning;
    let number = 0.13 * Real::powf(critical, 1.0 / 3.0) + 0.56 * Real::powf(critical, 0.25);
    assert_same(at(&glass, beyond, 0.0), number * 0.025_621 / 5.0, 1e-4);
    let [up, _] = beside(&law, &[2.0, 1.0], 90.0);
    assert!(jump(up) < 1e-4, "{up:?}");
    let number = |d: f64, length: f64| per_cube * length * length * length * d;
    let third = 0.13 * Real::powf(number(8.0, 2.0), 1.0 / 3.0) * 0.025_621 / 2.0;
    assert_same(beside(&law, &[2.0, 1.0], 15.0)[0][0], third, 1e-3);
    let sine = Real::sin(f64::to_radians(1.0));
    let nearly = 0.56 * Real::powf(number(8.0, 2.0) * sine, 0.25) * 0.025_621 / 2.0;
    let level = 0.58 * Real::powf(number(8.0, 2.0), 0.2) * 0.025_621 / 2.0;
    let found = beside(&law, &[2.0, 1.0], 1.0)[1];
    assert_same(found[0], level, 1e-3);
    assert_same(found[1], nearly, 1e-3);
}

/// Given by the user for both directions of the heat flow: a vertical surface has the first.
#[test]
fn power() {
    let law = power_law([0, 5]);
    let numbers = [1.0, 2.0, 0.25, 3.0, 0.5, 0.5, 1.0, 0.2, 3.0, 0.5];
    for d in [16.0, -16.0] {
        assert_same(at(&surface(&law, &numbers, 0.0), d, 4.0), 1.0 + 2.0 * 2.0 + 3.0 * 2.0, 1e-5);
    }
    assert_same(at(&surface(&law, &numbers, 1.0), -32.0, 4.0), 0.5 + 2.0 + 6.0, 1e-5);
}

/// Equation 5 of the paper is one formula for all directions, without a border.
#[test]
fn guichard2016_eq5() {
    let law = Convection::law("guichard2016_eq5", &[("length", id(0)), ("factor", id(1))]);
    for tilt in [45.0, 90.0, 135.0] {
        let [up, down] = beside(&law, &[2.0, 1.0], tilt);
        assert!(jump(up) < 1e-12 && jump([up[0], down[0]]) < 1e-12);
    }
}
