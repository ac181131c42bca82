//! Laws of air and moisture at the borders of their branches, and at rest. Each is continuous within round-off, or jumps by what
//! its source has. Convection, gaps, sun, optics and phase change have theirs beside the law.

use super::doors;
use super::psychrometrics::{condensing_pressure, humidity_ratio, wet_bulb};
use super::vents::{Coefficients, flow, strength};
use crate::number::real::Real;

/// Over ice and over water the pressure is the same at the triple point, within 2e-5 (Hyland & Wexler 1983).
#[test]
fn saturation_at_the_triple_point() {
    let [ice, water] = [-1e-9, 1e-9].map(|more| condensing_pressure(0.01_f64 + more));
    assert!((ice / water - 1.0).abs() < 2e-5, "{ice} and {water}");
    assert!((water / 611.657 - 1.0).abs() < 2e-5, "{water}");
}

/// Saturated air has its own temperature as wet-bulb temperature, over ice and over water. The equations of ASHRAE change from
/// water to ice at 0 degC, so that no state of the air has a wet bulb close to it from both sides.
#[test]
fn wet_bulb_of_saturated_air() {
    let pressure = 101_325.0;
    for temperature in [-30.0, -1.0, -0.1, 0.1, 1.0, 30.0] {
        let ratio = humidity_ratio(condensing_pressure(temperature), pressure);
        let wet = wet_bulb(temperature, ratio, pressure);
        assert!((wet - temperature).abs() < 1e-6, "{wet} at {temperature}");
    }
}

/// Doors and openings carry nothing without a difference, the same both ways, and small differences without a jump.
#[test]
fn air_at_rest() {
    let opening = strength(1.0, 0.6, 0.5, 1.2);
    assert_eq!(flow(opening, 0.5, 0.0).flow, 0.0);
    assert_eq!(doors::heat(100.0, 0.0), 0.0);
    for difference in [1e-9, 1e-4, 1e-3, 0.1, 10.0] {
        assert_eq!(flow(opening, 0.5, -difference).flow, -flow(opening, 0.5, difference).flow);
        assert_eq!(doors::heat(100.0, -difference), -doors::heat(100.0, difference));
    }
    // Far above their rounding both are the square-root laws.
    assert!((flow(opening, 0.5, 4.0).flow / (opening * 2.0) - 1.0).abs() < 1e-6);
    assert!((doors::heat(100.0, 4.0) / 800.0 - 1.0).abs() < 1e-4);
}

/// The pressure of the wind on a wall is continuous all the way round, and symmetric about the normal by both kinds.
#[test]
fn wind_all_round() {
    let table: Coefficients<f64> = Coefficients::Table(vec![0.6, -0.4, -0.2, -0.4]);
    let low: Coefficients<f64> = Coefficients::LowRise { log_ratio: Real::ln(1.5_f64) };
    for law in [&table, &low] {
        for k in 0..=72 {
            let turn = 5.0 * f64::from(k);
            let [before, behind] = [-1e-9, 1e-9].map(|more| law.at((turn + more).rem_euclid(360.0), 0.0));
            assert!((before - behind).abs() < 1e-9, "{turn} deg: {before} and {behind}");
            assert!((law.at(turn, 0.0) - law.at((360.0 - turn).rem_euclid(360.0), 0.0)).abs() < 1e-9);
        }
    }
}
