//! The published laws written as text give the coefficients of the built-in ones, and laws that are none are refused.

use std::sync::Arc;

use super::correlation::Placement;
use super::formula_check::{LawPoint, LawSide, LawText};
use super::formula_text::{FormulaText, SideNames};
use super::testing::power;
use super::{SurfaceConvection, Surroundings, Wind, WindTerms};
use crate::input::description::{Convection, FormulaNumber, ParamId};
use crate::input::values::Values;
use crate::number::dual::Dual;
use crate::number::elementary::cos_of_degrees;
use crate::number::lanes::Lanes;
use crate::number::real::Real;
use crate::physics::formula::LawNumber;

/// Air density [kg/m3].
const DENSITY: f64 = 1.17;
const TILTS: [f64; 9] = [0.0, 10.0, 30.0, 44.0, 60.0, 90.0, 120.0, 150.0, 180.0];
const DIFFERENCES: [f64; 14] =
    [-80.0, -31.0, -8.0, -1.2, -0.1, -0.01, -1e-5, 1e-5, 3e-3, 0.2, 1.0, 5.5, 17.0, 95.0];
const WINDS: [f64; 6] = [0.0, 5e-4, 0.3, 1.7, 6.0, 25.0];

fn placement<S: Real>(tilt: f64) -> Placement<S> {
    let number = S::constant;
    Placement {
        area: number(12.5),
        upward: number(cos_of_degrees(tilt)),
        wind_factor: number(0.8),
        inclination: number(tilt.min(180.0 - tilt)),
        density: number(DENSITY),
        height: number(4.5),
    }
}

/// A law as text with its numbers in the order of `names`.
fn written(formula: &str, names: &[&str]) -> Convection {
    let numbers = (0..).zip(names).map(|(k, name)| FormulaNumber { name: (*name).into(), value: ParamId(k) });
    Convection::Formula { formula: formula.into(), valid: None, numbers: numbers.collect() }
}

fn surface<S: Real>(law: &Convection, values: &[S], tilt: f64) -> SurfaceConvection<S> {
    let text = if let Convection::Formula { formula, valid, numbers } = law {
        let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
        let side = SideNames { wind: true, sun: true, zone: true, height: true };
        match FormulaText::new(formula, valid.as_deref(), &names, side) {
            Ok(text) => Some(Arc::new(text)),
            Err(fault) => panic!("{fault:?}"),
        }
    } else {
        None
    };
    SurfaceConvection::new(&Values::new(values), law, text.as_ref(), &placement(tilt))
}

/// Both laws give the same flow and slope over all tilts, differences and winds.
fn assert_same_law(built_in: &Convection, formula: &str, names: &[&str], values: &[f64]) {
    let law = written(formula, names);
    for tilt in TILTS {
        let [expected, found] = [built_in, &law].map(|law| surface(law, values, tilt));
        for (difference, speed) in DIFFERENCES.into_iter().flat_map(|d| WINDS.map(|speed| (d, speed))) {
            for windward in [true, false] {
                let wind = Wind::new(speed, WindTerms::all());
                let [expected, found] = [&expected, &found].map(|law| {
                    let flux = law.flux(difference, &law.forced(&wind, windward));
                    [flux.flux / difference, flux.slope]
                });
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!(
                        (found / expected - 1.0).abs() < 1e-12,
                        "{formula} at {tilt} deg, {difference} K, {speed} m/s: {found} is not {expected}"
                    );
                }
            }
        }
    }
}

fn id(index: u32) -> ParamId {
    ParamId(index)
}

#[test]
fn laws_without_buoyancy() {
    assert_same_law(&Convection::law("constant", &[("coefficient", id(0))]), "h", &["h"], &[7.5]);
    let linear = Convection::law("linear_wind", &[("constant", id(0)), ("wind", id(1))]);
    assert_same_law(&linear, "a + b*V", &["a", "b"], &[5.7, 3.8]);
    assert!(surface(&written("a + b*V", &["a", "b"]), &[5.7, 3.8], 90.0).straight());
}

#[test]
fn alamdari_hammond_and_guichard2016_eq5() {
    let blend = "f*((1.5*(abs(dT)/L)^(1/4))^6 + (1.23*abs(dT)^(1/3))^6)^(1/6)";
    let plate = "f*((1.4*(abs(dT)/L)^(1/4))^6 + (1.63*abs(dT)^(1/3))^6)^(1/6)";
    let stable = "f*0.6*(abs(dT)/L^2)^(1/5)";
    let law = format!("if(abs(upward) > sqrt(1/2), if(dT*upward > 0, {plate}, {stable}), {blend})");
    let built_in = Convection::law("alamdari_hammond", &[("length", id(0)), ("factor", id(1))]);
    assert_same_law(&built_in, &law, &["L", "f"], &[2.7, 1.1]);
    let law = "f*((1.51*abs(dT)^(1/4)/H)^6 + (1.33*abs(dT)^(1/3))^6)^(1/6)";
    assert_same_law(
        &Convection::law("guichard2016_eq5", &[("length", id(0)), ("factor", id(1))]),
        law,
        &["H", "f"],
        &[0.3, 0.9],
    );
}

const TARP: &str = "if(abs(upward) < 1e-6, 1.31, if(dT*upward > 0, 9.482/(7.238 - abs(upward)), \
                    1.810/(1.382 + abs(upward))))*abs(dT)^(1/3)";

#[test]
fn laws_with_wind() {
    let tarp = Convection::law("tarp", &[("factor", id(0)), ("roughness", id(1)), ("perimeter", id(2))]);
    let law = format!("f*({TARP} + if(windward, 1, 0.5)*2.537*R*sqrt(P*V/area))");
    assert_same_law(&tarp, &law, &["f", "R", "P"], &[1.2, 1.67, 14.5]);
    let wind = "if(windward, 3.26*V^0.89, 3.55*V^0.617)";
    let law = format!("f*sqrt((0.84*abs(dT)^(1/3))^2 + ({wind})^2)");
    assert_same_law(&Convection::law("mowitt", &[("factor", id(0))]), &law, &["f"], &[0.9]);
    let smooth = format!("sqrt(({TARP})^2 + ({wind})^2)");
    let law = format!("f*({TARP} + R*({smooth} - {TARP}))");
    assert_same_law(
        &Convection::law("doe2", &[("factor", id(0)), ("roughness", id(1))]),
        &law,
        &["f", "R"],
        &[1.05, 1.52],
    );
}

#[test]
fn power_law() {
    let built_in = power([0, 5]);
    let values = [1.0, 2.0, 0.25, 0.5, 0.8, 0.3, 1.1, 0.33, 0.4, 0.7];
    let text = "if(dT*upward > 0 or abs(upward) < 1e-6, a + b*abs(dT)^n + c*V^m, A + B*abs(dT)^N + C*V^M)";
    assert_same_law(&built_in, text, &["a", "b", "n", "c", "m", "A", "B", "N", "C", "M"], &values);
}

/// The angle is counted from where heat flows up.
#[test]
fn iso_15099() {
    let rayleigh = "density^2*L^3*9.80665*1006/(293.15*1.8205e-5*0.025621)";
    let angle = "if(dT*upward > 0, min(tilt, 180 - tilt), if(tilt > 90, tilt, 180 - tilt))";
    let sine = "sin(min(tilt, 180 - tilt)*pi/180)";
    let critical = format!("2.5e5*(exp(0.72*min(tilt, 180 - tilt))/{sine})^(1/5)");
    let ra = format!("({rayleigh})*abs(dT)");
    let laminar = format!("0.56*(({ra})*{sine})^(1/4)");
    let turbulent = format!("0.13*(({ra})^(1/3) - ({critical})^(1/3)) + 0.56*(({critical})*{sine})^(1/4)");
    let steep = format!("if(({ra})^2 > ({critical})^2, {turbulent}, {laminar})");
    let turns = "abs(tilt - 90) < 1e-6";
    let law = format!(
        "f*0.025621/L*if(({angle}) < 15, 0.13*({ra})^(1/3), if(({angle}) > 179, 0.58*({ra})^(1/5), \
         if(({angle}) < 90 or {turns}, {steep}, {laminar})))"
    );
    assert_same_law(
        &Convection::law("iso15099", &[("length", id(0)), ("factor", id(1))]),
        &law,
        &["L", "f"],
        &[2.1, 1.3],
    );
}

/// Derivatives of flow and slope by the numbers and the difference against differences of plain numbers.
#[test]
fn derivatives() {
    let law = written("if(windward, 1.3, 0.8)*c*abs(dT)^n + b*V^m + tanh(c*dT/40)^2", &["c", "n", "b", "m"]);
    let values = [2.3, 0.33, 3.1, 0.8];
    let at = |values: &[f64], d: f64| {
        let law = surface(&law, values, 35.0);
        let flux = law.flux(d, &law.forced(&Wind::new(2.7, WindTerms::default()), true));
        [flux.flux, flux.slope]
    };
    for difference in [-14.0, -0.3, 0.004, 6.0] {
        let dual: Vec<Dual<5>> = (0..4).map(|k| Dual::variable(values[k], k)).collect();
        let law = surface(&law, &dual, 35.0);
        let forced = law.forced(&Wind::new(2.7, WindTerms::default()), true);
        let flux = law.flux(Dual::variable(difference, 4), &forced);
        assert!((flux.flux.slope[4] / flux.slope.value - 1.0).abs() < 1e-12);
        for which in 0..5 {
            let moved = |step: f64| {
                let (mut values, mut difference) = (values, difference);
                if which < 4 {
                    values[which] += step;
                } else {
                    difference += step;
                }
                at(&values, difference)
            };
            let step = 1e-5 * if which < 4 { values[which] } else { difference.abs() };
            let [after, before] = [moved(step), moved(-step)];
            for (k, found) in [flux.flux.slope[which], flux.slope.slope[which]].into_iter().enumerate() {
                let quotient = (after[k] - before[k]) / (2.0 * step);
                assert!(
                    (found - quotient).abs() < 1e-6 * (1.0 + quotient.abs()),
                    "{which}: {found}, {quotient}"
                );
            }
        }
    }
}

/// Each lane has the bits of a run alone, also where one lane is beyond the limits of the law.
#[test]
fn lanes_have_the_bits_of_plain_numbers() {
    let law = written("c*abs(dT)^n + 3 - 0.005*abs(dT)^1.7*k", &["c", "n", "k"]);
    let members = [[2.3, 0.33, 1.0], [1.0, 0.2, 9.0], [5.0, 0.5, 0.0], [0.4, 1.0 / 3.0, 30.0]];
    let values: Vec<Lanes<4>> = (0..3).map(|k| Lanes(members.map(|member| member[k]))).collect();
    let lanes = surface(&law, &values, 90.0);
    for difference in [0.002, -7.0, 44.0, -190.0, 260.0] {
        let flux = lanes.flux(Lanes([difference; 4]), &[Lanes::zero(); 4]);
        for (lane, member) in members.iter().enumerate() {
            let alone = surface(&law, &member[..], 90.0).flux(difference, &[0.0; 4]);
            assert_eq!(flux.flux.lane(lane).to_bits(), alone.flux.to_bits());
            assert_eq!(flux.slope.lane(lane).to_bits(), alone.slope.to_bits());
            assert!(alone.slope > -1e-9, "the flow rises everywhere");
        }
    }
}

/// A wall, outdoors or in a zone.
fn side(outdoors: bool) -> LawSide {
    let height = outdoors.then_some(4.5);
    let (wind, sun, zone) = (outdoors, outdoors, !outdoors);
    LawSide { wind, sun, zone, tilt: 90.0, area: 10.0, density: 1.2, height }
}

fn check(formula: &str, valid: Option<&str>, numbers: &[LawNumber], wind: bool) -> Result<(), String> {
    let law = LawText { formula, valid, numbers, side: side(wind) };
    law.check().map_err(|found| format!("{} {}", found.key, found.fault))
}

fn number(name: &str, value: f64, range: Option<[f64; 2]>) -> LawNumber {
    LawNumber { name: name.into(), value, range, unit: None }
}

#[test]
fn laws_that_are_none_are_refused() {
    let good = [number("c", 2.3, Some([1.0, 4.0])), number("n", 0.33, None)];
    assert_eq!(check("c*abs(dT)^n", Some("abs(dT) < 30"), &good, false), Ok(()));
    for (formula, valid, wind, words) in [
        ("c*n + 1/abs(dT)", None, false, "formula column 8: found inf"),
        ("c*abs(dT)^n + 1/(9 - dT)", None, false, "formula column 1: found"),
        ("c*abs(dT)^-n", None, false, "column 10: found inf"),
        ("c*dT^n", None, false, "column 5: found NaN"),
        ("c*(20 - abs(dT))^2*n", None, false, "falls from"),
        ("c*(20 - abs(dT))*n", Some("abs(dT) < 19"), false, "falls from"),
        ("c*n + dT", None, false, "not negative"),
        ("c*n + V", None, false, "column 7: found the name 'V'"),
        ("c*n + T", None, true, "Write Ts for the surface"),
        ("c*n + height", None, false, "no height above ground"),
        ("c*n + wind_angle", None, false, "No wind reaches"),
        ("c*n + sun", None, false, "The irradiance is known"),
        ("c*n + air_change", None, true, "faces no zone"),
        ("c*n", Some("sun < 800"), true, "by dT, Ts, Ta and V"),
        // Falling or singular only somewhere in what is around the surface.
        ("c*n + 1/abs(Ts - 5)", Some("Ts > 4.99 and Ts < 5.01"), true, "column 8: found inf"),
        ("c*n + 40*(Ts - 50)^2/100", None, true, "falls from"),
        ("c*n*(1 - wind_angle/120)", None, true, "wind_angle = 135.000 deg"),
        ("c*n + 8*(1 - sun/1000)", None, true, "sun = 1200.000 W/m2"),
        ("c*n/(air_change - 10)^2", None, false, "air_change = 10.000 1/h"),
        ("c*n", Some("abs(dT) < -1"), false, "valid column 1: found no difference"),
        ("c", None, false, "n column 1: found the number 'n'"),
        ("c*n*(1 - V/20)", None, true, "V = 30 m/s"),
    ] {
        let fault = check(formula, valid, &good, wind).unwrap_err();
        assert!(fault.contains(words), "{formula}: {fault}");
    }
    // The nominal law is sound, that at an end of the range of c is not.
    let ranged = [number("c", 0.5, Some([-1.0, 1.0])), number("n", 0.33, None)];
    let fault = check("3 + c*abs(dT)^n*3", None, &ranged, false).unwrap_err();
    assert!(fault.contains("c = -1"), "{fault}");
    assert!(check("2*dT", None, &[number("dT", 1.0, None)], false).unwrap_err().contains("other meaning"));
}

/// Units of numbers are compared where they are stated; exponents may have names.
#[test]
fn units_that_do_not_fit_are_refused() {
    let check = |formula: &str, units: [&str; 2]| {
        let mut numbers = [number("c", 2.3, None), number("n", 0.25, None), number("b", 3.0, None)];
        numbers[0].unit = Some(units[0].into());
        numbers[2].unit = Some(units[1].into());
        let law = LawText { formula, valid: Some("abs(dT) < 30"), numbers: &numbers, side: side(true) };
        law.check().map_err(|found| format!("{} {}", found.key, found.fault))
    };
    let law = "c*abs(dT)^n + b*V";
    for fits in [
        ["W/(m2 K^(1+n))", "J/(m3 K)"],
        ["W/(m2 K^1.25)", "W s/(m3 K)"],
        ["W m-2 K^-(1+n)", "W/(m2 K)/(m/s)"],
    ] {
        let found = check(law, fits);
        assert!(found.is_ok() || fits[0].contains('-'), "{found:?}");
    }
    for (formula, units, words) in [
        (law, ["W/(m2 K)", "W s/(m3 K)"], "formula column 13: found"),
        (law, ["W/(m2 K^(1+n))", "W/(m2 K)"], "column 13"),
        ("c*abs(dT)^n*b", ["W/(m2 K^(1+n))", "m"], "a formula in"),
        ("c*exp(dT)^n*b", ["-", "W/(m2 K)"], "an argument in K"),
        ("b*abs(dT)^c*n", ["K", "-"], "an exponent in K"),
        (law, ["kW/(m2 K)", "-"], "c column 1: found 'kW'"),
        (law, ["W/(m2 K", "-"], "Close the bracket"),
        (law, ["3", "-"], "a unit"),
        ("c*2^(dT)*b*n", ["W/(m2 K)", "-"], "an exponent in K"),
        ("c*(b/b)^n*if(dT < V, 1, 2)", ["W/(m2 K)", "-"], "K beside m s^-1"),
    ] {
        let fault = check(formula, units).unwrap_err();
        assert!(fault.contains(words), "{formula}: {fault}");
    }
}

/// `Ts`, `Ta`, the angle, the sun, the air change and the height: the coefficient of the engine is that of the tree, and its slopes are those of
/// dual numbers. More than two parts change with what is around the surface.
#[test]
fn what_is_around_a_surface() {
    for (formula, [wind_acts, air_changes, all_air]) in [
        (
            "c*(Ts + 273.15)^0.5*abs(dT)^(1/3)/10 + b*V^0.8*(1 + cos(wind_angle*pi/180)) + 1e-3*sun*exp(-dT/60) + 0.01*height",
            [true, false, false],
        ),
        ("c*abs(dT)^0.25*(1 + 0.1*air_change) + b*(Ta + 40)/100", [false, true, false]),
        ("c*abs(dT)^0.25 + 0.1*total_air_change^0.5 + b*(Ta + 40)/100", [false, false, true]),
    ] {
        let law = written(formula, &["c", "b"]);
        let around =
            Surroundings { air: 12.0, angle: 70.0, sun: 400.0, air_change: 1.5, total_air_change: 6.0 };
        let (values, numbers) = ([1.3, 2.1], [number("c", 1.3, None), number("b", 2.1, None)]);
        let side = LawSide { wind: true, sun: true, zone: true, height: Some(4.5), ..side(true) };
        let text = LawText { formula, valid: None, numbers: &numbers, side };
        let plain = surface(&law, &values, 90.0);
        assert!(plain.surrounded() && plain.windy() && !plain.straight());
        assert_eq!(plain.needs_air_change(), air_changes || all_air);
        let wind = Wind::new(3.0, WindTerms::default());
        for d in [-20.0, -2.0, 0.5, 15.0] {
            let flux = plain.flux(d, &plain.driven(&wind, true, &around));
            let point = LawPoint { difference: d, wind: 3.0 * 0.8, around };
            let expected = text.values(&[point]).unwrap()[0];
            // The magnitude of the difference is rounded.
            assert!((flux.flux / d / expected - 1.0).abs() < 1e-4, "{} is not {expected}", flux.flux / d);
            let dual = surface(&law, &values.map(Dual::<1>::constant), 90.0);
            let with = |place: Option<usize>| {
                let mut list = around.list().map(Dual::constant);
                if let Some(place) = place {
                    list[place].slope = [1.0];
                }
                dual.driven(&wind, true, &Surroundings::from_list(list))
            };
            let slope = dual.flux(Dual { value: d, slope: [1.0] }, &with(None)).flux.slope[0];
            assert!((slope / flux.slope - 1.0).abs() < 1e-9, "{slope} is not {}", flux.slope);
            for place in 0..5 {
                let found = dual.flux(Dual::constant(d), &with(Some(place))).flux.slope[0];
                let [low, high] = [-1e-4, 1e-4].map(|nudge| {
                    let mut list = around.list();
                    list[place] += nudge;
                    let driven = plain.driven(&wind, true, &Surroundings::from_list(list));
                    plain.flux(d, &driven).flux
                });
                assert!((found - (high - low) / 2e-4).abs() < 1e-6, "{formula}: {place}");
                assert_eq!(found == 0.0, ![true, wind_acts, wind_acts, air_changes, all_air][place]);
            }
        }
    }
}
