//! Openings that pressure drives air through, and their controls.

use crate::common::{Builder, facing, forcing, options, position, run, values};
use mascarin_engine::derivatives::{Trajectory, jacobian};
use mascarin_engine::description::{
    Band, Facing, Gain, Vent, VentControl, WindOnVent, WindPressure, ZoneLongwave,
};
use mascarin_engine::forcing::{Forcing, channel};
use mascarin_engine::number::Real;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Run;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::state::Initial;
use mascarin_engine::{RunControl, Scheme};

const GRAVITY: f64 = 9.806_65;
const DISCHARGE: f64 = 0.6;
/// Density at 15 degC and the pressure of the standard atmosphere at 55 m [kg/m3], and the heat capacity of a cubic metre [J/(m3 K)].
const DENSITY: f64 = 100_666.018_81 / (287.055 * 288.15);
const HEAT: f64 = DENSITY * 1006.0;

/// Zones with one wall each, adiabatic outside.
fn zones(count: usize) -> Builder {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1000.0);
    let wall = b.construction("wall", &[(board, 0.01, 2)]);
    for k in 0..count {
        let zone = b.zone(&format!("zone{k}"), 30.0, 0.0, ZoneLongwave::None);
        let h = b.convection(3.0);
        let inside = b.inside(zone, h, 0.9);
        b.surface(&format!("wall{k}"), wall, [30.0, 90.0, 0.0], facing(Facing::Adiabatic, None), inside);
    }
    b
}

/// Adds an opening of an area [m2] at an elevation [m].
fn vent(b: &mut Builder, ends: (usize, Option<usize>), area: f64, elevation: f64) -> usize {
    let name = format!("vent{}", b.description.vents.len());
    let mut number = |what: &str, value: f64| b.number(&format!("{name}.{what}"), value);
    let (area, elevation) = (number("area", area), number("elevation", elevation));
    let (discharge, exponent) = (number("discharge", DISCHARGE), number("exponent", 0.5));
    let (zone, to) = ends;
    b.description.vents.push(Vent {
        name,
        zone,
        to,
        area,
        elevation,
        discharge,
        exponent,
        height: None,
        wind: None,
        schedule: None,
        control: None,
    });
    b.description.vents.len() - 1
}

/// Lets a wind of the speed at the mast reach an opening, with one coefficient for all directions.
fn expose(b: &mut Builder, vent: usize, pressure: WindPressure, azimuth: f64) {
    // At 10 m with the profile of the mast, the wind is that at the mast.
    let height = b.number("wind.height", 10.0);
    let (azimuth, shelter) = (b.number("wind.azimuth", azimuth), b.number("wind.shelter", 1.0));
    b.description.vents[vent].wind = Some(WindOnVent { azimuth: Some(azimuth), height, shelter, pressure });
    for (path, value) in [("site.wind.exponent", 0.14), ("site.wind.layer", 270.0)] {
        b.description.parameters.iter_mut().find(|number| number.path == path).unwrap().value = value;
    }
}

fn table(coefficient: f64) -> WindPressure {
    WindPressure::Table { coefficients: vec![coefficient] }
}

/// Flows out of and into the zones of all openings at the start, with zones at a temperature [degC].
fn flows(plan: &Plan, inside: f64, outdoor: f64, wind: f64) -> Vec<[f64; 2]> {
    let rows = forcing(plan, Scheme::BackwardEuler, 1, 60.0, |_, row| {
        (row[channel::AIR_TEMPERATURE], row[channel::WIND_SPEED]) = (outdoor, wind);
    });
    let vents = 0..plan.description.vents.len();
    let outputs = vents.flat_map(|vent| [Output::VentOutflow { vent }, Output::VentInflow { vent }]);
    let mut options = options(Scheme::BackwardEuler, 60.0, outputs.collect());
    options.initial = Initial::Everywhere(inside);
    let records = run(plan, &rows, &options).records;
    let (pairs, _) = records.as_chunks();
    pairs[..plan.description.vents.len()].to_vec()
}

/// Density at a temperature [degC] over that of the site.
fn relative_density(air: f64) -> f64 {
    288.15 / (air + 273.15)
}

/// Through two equal openings, one on top of the other, the same mass passes once as the air of one side and once as that of the other: the
/// flow of both is that of the harmonic mean of the densities.
fn harmonic_mean(a: f64, b: f64) -> f64 {
    2.0 * a * b / (a + b)
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found} is not {expected}");
}

/// Wind through a windward, an inner and a leeward opening: `m = sqrt(2 dp rho)/sqrt(sum 1/(C_d A)^2)`; two leeward openings in
/// parallel are one of their area. Flows are volumes of air of the site.
#[test]
fn openings_in_series_and_in_parallel() {
    let mut b = zones(2);
    let all = [vent(&mut b, (0, None), 0.5, 1.0), vent(&mut b, (0, Some(1)), 1.5, 1.0)];
    let leeward = [vent(&mut b, (1, None), 0.3, 1.0), vent(&mut b, (1, None), 0.5, 2.5)];
    expose(&mut b, all[0], table(0.6), 0.0);
    for vent in leeward {
        expose(&mut b, vent, table(-0.3), 0.0);
    }
    let found = flows(&b.plan(), 20.0, 20.0, 4.0);
    let density = DENSITY * relative_density(20.0);
    let pressure: f64 = 0.9 * 0.5 * density * 16.0;
    let resistance = [0.5, 1.5, 0.8].map(|area| 1.0 / (DISCHARGE * area * DISCHARGE * area));
    let resistance = resistance.iter().sum::<f64>();
    let expected = (2.0 * pressure * density / resistance).sqrt() / DENSITY;
    near(found[0][1], expected, 1e-6);
    near(found[1][0], expected, 1e-6);
    near(found[2][0], expected * 3.0 / 8.0, 1e-6);
    assert_eq!((found[0][0], found[1][1], found[2][1]), (0.0, 0.0, 0.0));
    // As much enters as leaves.
    assert!((found[0][1] - found[2][0] - found[3][0]).abs() < 1e-8);
}

/// Stack: openings of 0.2 m2 at 1 m and 0.4 m2 at 4 m. The neutral level divides their distance by the squares of the areas and the
/// densities of what passes: `h_1 = 3/(1 + (A_1/A_2)^2 rho_o/rho_i)`, and `m = C_d A_1 sqrt(2 rho_o g h_1 (rho_o - rho_i))`.
#[test]
fn stack_and_neutral_level() {
    let mut b = zones(1);
    let _ = [vent(&mut b, (0, None), 0.2, 1.0), vent(&mut b, (0, None), 0.4, 4.0)];
    let found = flows(&b.plan(), 26.0, 16.0, 3.0);
    let (heavy, light) = (relative_density(16.0), relative_density(26.0));
    let below = 3.0 / (1.0 + 0.25 * heavy / light);
    let expected = DISCHARGE * 0.2 * (2.0 * heavy * GRAVITY * below * (heavy - light)).sqrt();
    near(found[0][1], expected, 5e-6);
    near(found[1][0], expected, 5e-6);
    // Cooler than outdoors, it turns round.
    let turned = flows(
        &{
            let mut b = zones(1);
            let _ = [vent(&mut b, (0, None), 0.2, 1.0), vent(&mut b, (0, None), 0.4, 4.0)];
            b.plan()
        },
        16.0,
        26.0,
        3.0,
    );
    near(turned[0][0], expected, 5e-6);
}

/// One window of 1.2 m exchanges `C_d A/3 sqrt(g H (rho_o - rho_i)/rho)` both ways, times the root of the harmonic mean of the densities over
/// that of the site; wind on it alone drives nothing.
#[test]
fn a_single_window() {
    let mut b = zones(1);
    let window = vent(&mut b, (0, None), 0.8, 1.5);
    b.description.vents[window].height = Some(b.number("vent.height", 1.2));
    let side_ratio = b.number("ratio", 1.0);
    expose(&mut b, window, WindPressure::LowRise { side_ratio }, 0.0);
    let plan = b.plan();
    let (heavy, light) = (relative_density(15.0), relative_density(24.0));
    let passing = harmonic_mean(heavy, light);
    let expected = DISCHARGE * 0.8 / 3.0 * (GRAVITY * 1.2 * (heavy - light) * passing).sqrt();
    let [found] = flows(&plan, 24.0, 15.0, 5.0)[..] else { panic!() };
    // 0.1 Pa on each half, rounded off within 0.2 mPa.
    near(found[0], expected, 5e-5);
    near(found[1], expected, 5e-5);
    let [calm] = flows(&plan, 15.0, 15.0, 5.0)[..] else { panic!() };
    assert!(calm[0] < 1e-6 && calm[1] < 1e-6, "{calm:?}");
}

/// Wind from the north on equal openings in the east and in the west: no flow. A zone whose openings lead only to another one, and a
/// building of nothing but a leak, have a solution.
#[test]
fn symmetrical_wind_and_closed_zones() {
    let mut b = zones(3);
    for azimuth in [90.0, 270.0] {
        let window = vent(&mut b, (0, None), 0.5, 1.5);
        let side_ratio = b.number("ratio", 1.5);
        expose(&mut b, window, WindPressure::LowRise { side_ratio }, azimuth);
    }
    let _ = [vent(&mut b, (1, Some(2)), 0.1, 0.5), vent(&mut b, (1, Some(2)), 0.2, 2.0)];
    let found = flows(&b.plan(), 20.0, 20.0, 6.0);
    assert!(found.iter().flatten().all(|&flow| flow < 1e-6), "{found:?}");
}

/// Many zones at different temperatures in wind: as much air enters each zone as leaves it, whatever the sizes of openings.
#[test]
fn mass_balances_in_many_zones() {
    let mut random = 7_u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((random >> 33) as f64) / f64::from(1_u32 << 31)
    };
    for _ in 0..30 {
        let count = 12;
        let mut b = zones(count);
        for zone in 0..count {
            let number = 10.0 * next();
            let other = (zone + 1 + (1..10).filter(|&k| f64::from(k) < number).count()) % count;
            if other != zone {
                vent(&mut b, (zone, Some(other)), Real::exp(-9.0 * next()), 3.0 * next());
            }
            if next() < 0.5 {
                let window = vent(&mut b, (zone, None), Real::exp(-9.0 * next()), 3.0 * next());
                b.description.vents[window].height = Some(b.number("vent.height", next()));
                expose(&mut b, window, table(next() - 0.6), 0.0);
            }
        }
        let plan = b.plan();
        let air = (0..count).map(|_| 15.0 + 15.0 * next()).collect();
        let rows = forcing(&plan, Scheme::BackwardEuler, 1, 60.0, |_, row| row[channel::WIND_SPEED] = 5.0);
        let vents = 0..plan.description.vents.len();
        let outputs = vents.flat_map(|vent| [Output::VentOutflow { vent }, Output::VentInflow { vent }]);
        let mut options = options(Scheme::BackwardEuler, 60.0, outputs.collect());
        options.initial = Initial::Given {
            cells: vec![20.0; plan.n_cells],
            surfaces: vec![20.0; plan.surfaces.len()],
            air,
        };
        let records = run(&plan, &rows, &options).records;
        let (mut surplus, mut all) = (vec![0.0; count], 0.0);
        let (flows, _) = records.as_chunks::<2>();
        for (vent, [out, into]) in plan.description.vents.iter().zip(flows) {
            surplus[vent.zone] += out - into;
            if let Some(to) = vent.to {
                surplus[to] -= out - into;
            }
            all += out + into;
        }
        // The leaks of the zones carry 1e-10 m3/s for each pascal.
        assert!(surplus.iter().all(|surplus| surplus.abs() < 1e-12 * all + 5e-9), "{surplus:?} of {all}");
    }
}

/// A room with a heater under two openings, opened by hysteresis, beside a corridor; weather of a day.
fn ventilated() -> Plan {
    let mut b = zones(2);
    for (zone, azimuth, elevation) in [(0, 0.0, 1.0), (1, 180.0, 3.0)] {
        let window = vent(&mut b, (zone, None), 0.4, elevation);
        b.description.vents[window].height = Some(b.number("window.height", 1.0));
        b.description.vents[window].control = Some(0);
        let side_ratio = b.number("ratio", 1.5);
        expose(&mut b, window, WindPressure::LowRise { side_ratio }, azimuth);
    }
    let door = vent(&mut b, (0, Some(1)), 1.8, 1.0);
    b.description.vents[door].height = Some(b.number("door.height", 2.0));
    let mut band =
        |open: f64, close: f64| Band { open: b.number("band", open), close: b.number("band", close) };
    let (indoor, difference) = (Some(band(22.0, 19.5)), Some(band(1.0, 0.2)));
    let [minimum_open_time, minimum_closed_time] =
        [("open", 40.0), ("closed", 20.0)].map(|(name, minutes)| Some(b.number(name, minutes)));
    b.description.controls.push(VentControl {
        name: "night".to_owned(),
        reference_zone: None,
        zone: 0,
        indoor,
        difference,
        outdoor: None,
        indoor_below: None,
        outdoor_below: None,
        wind: None,
        rain: None,
        minimum_open_time,
        minimum_closed_time,
    });
    let (power, radiative) = (b.number("heater.power", 600.0), b.number("heater.radiative", 0.2));
    let heater = Gain { name: "heater".to_owned(), power, radiative, activity: None, schedule: None };
    b.description.zones[0].gains.push(heater);
    b.plan()
}

fn day(time: f64, row: &mut [f64]) {
    let angle = time / 86400.0 * core::f64::consts::TAU;
    row[channel::AIR_TEMPERATURE] = 17.0 - 5.0 * Real::cos(angle);
    row[channel::WIND_SPEED] = 2.0 + Real::sin(3.0 * angle);
    row[channel::WIND_DIRECTION] = 150.0 + 60.0 * Real::sin(angle);
}

fn outputs() -> Vec<Output> {
    vec![
        Output::AirTemperature { zone: 0 },
        Output::AirTemperature { zone: 1 },
        Output::VentInflow { vent: 0 },
        Output::AirChanges { zone: 1 },
        Output::ControlOpen { control: 0 },
    ]
}

fn of_day(plan: &Plan, scheme: Scheme, steps: usize) -> Run<f64> {
    let dt = 86400.0 / steps as f64;
    run(plan, &forcing(plan, scheme, steps, dt, day), &options(scheme, dt, outputs()))
}

/// The energy balance closes and contains the flow; the control opens and closes.
#[test]
fn a_day_of_control() {
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        let result = of_day(&ventilated(), scheme, 144);
        assert!(result.energy_balance.closure() < 1e-12, "{}", result.energy_balance.closure());
        let ventilation =
            result.energy_balance.into[mascarin_engine::energy_balance::Flow::Ventilation as usize];
        assert!(ventilation < -1e6, "{ventilation}");
        let open: Vec<f64> = result.records.iter().skip(4).step_by(5).copied().collect();
        let switched = open.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!((2..48).contains(&switched), "{switched}");
    }
}

/// Outdoor air that is above and below both limits in turn, a step of 15 min each: the control opens for an hour at least, and at the end
/// of it the air is warm, so that it closes a step later; it stays closed for two steps, and then the air is cold. Wind closes it at once.
#[test]
fn minimum_times() {
    let mut b = zones(1);
    let window = vent(&mut b, (0, None), 0.4, 1.0);
    b.description.vents[window].control = Some(0);
    let mut number = |name: &str, value: f64| b.number(name, value);
    let outdoor = Band { open: number("opens", 20.0), close: number("closes", 20.0) };
    let wind = Band { open: number("calm", 5.0), close: number("storm", 5.0) };
    let (minimum_open_time, minimum_closed_time) = (Some(number("open", 60.0)), Some(number("closed", 30.0)));
    b.description.controls.push(VentControl {
        name: "outdoor".to_owned(),
        reference_zone: None,
        zone: 0,
        indoor: None,
        outdoor: Some(outdoor),
        indoor_below: None,
        outdoor_below: None,
        difference: None,
        wind: Some(wind),
        rain: None,
        minimum_open_time,
        minimum_closed_time,
    });
    let plan = b.plan();
    let (scheme, steps, dt) = (Scheme::BackwardEuler, 40, 900.0);
    // The weather of a step is given with the time at its end.
    let states = |storm: f64, numbers: &[f64]| -> Vec<bool> {
        let rows = forcing(&plan, scheme, steps, dt, |time, row| {
            let step = time / dt - 1.0;
            row[channel::AIR_TEMPERATURE] = if step.rem_euclid(2.0) < 0.5 { 21.0 } else { 19.0 };
            row[channel::WIND_SPEED] = if (step - storm).abs() < 0.5 { 8.0 } else { 2.0 };
        });
        let options = options(scheme, dt, vec![Output::ControlOpen { control: 0 }]);
        let drive = Forcing::new(&rows, 1, plan.n_channels()).unwrap();
        let run =
            mascarin_engine::run::simulate(&plan, numbers, &drive, &options, &RunControl::default()).unwrap();
        // The first row is the start, at which it decides as in the first step.
        assert_eq!(run.records[0], run.records[1]);
        run.records[1..].iter().map(|&open: &f64| open > 0.5).collect()
    };
    let mut numbers = values(&plan);
    let expected: Vec<bool> = (0..steps).map(|step| step % 8 < 5).collect();
    assert_eq!(states(f64::INFINITY, &numbers), expected);
    // Closed by wind in step 1, until a warm step after two steps; then as before.
    let closed_by_wind: Vec<bool> =
        (0..steps).map(|step| step == 0 || (step >= 4 && (step - 4) % 8 < 5)).collect();
    assert_eq!(states(1.0, &numbers), closed_by_wind);
    for name in ["open", "closed"] {
        numbers[position(&plan, name)] = 0.0;
    }
    let in_turn: Vec<bool> = (0..steps).map(|step| step % 2 == 0).collect();
    assert_eq!(states(f64::INFINITY, &numbers), in_turn);
}

/// A constant heater in constant weather: the heat that air carries away is that of the heater, `P = c V (T - T_o)`.
#[test]
fn steady_heat_by_stack() {
    let mut b = zones(1);
    let _ = [vent(&mut b, (0, None), 0.1, 0.5), vent(&mut b, (0, None), 0.1, 2.5)];
    let (power, radiative) = (b.number("heater.power", 500.0), b.number("heater.radiative", 0.0));
    b.description.zones[0].gains.push(Gain {
        name: "heater".to_owned(),
        power,
        radiative,
        activity: None,
        schedule: None,
    });
    let plan = b.plan();
    let rows = forcing(&plan, Scheme::Sdirk2, 400, 900.0, |_, row| row[channel::AIR_TEMPERATURE] = 10.0);
    let outputs = vec![Output::AirTemperature { zone: 0 }, Output::VentOutflow { vent: 1 }];
    let result = run(&plan, &rows, &options(Scheme::Sdirk2, 900.0, outputs));
    let [air, flow] = result.records[result.records.len() - 2..] else { panic!() };
    near(HEAT * flow * (air - 10.0), 500.0, 1e-5);
    let (heavy, light) = (relative_density(10.0), relative_density(air));
    let passing = harmonic_mean(heavy, light);
    near(flow, DISCHARGE * 0.1 * (2.0 * GRAVITY * (heavy - light) * passing).sqrt(), 1e-5);
}

/// Flows belong to the temperatures at the beginning of a step: with half of the step, half of the error is left.
#[test]
fn flows_are_of_first_order() {
    let mut b = zones(1);
    let _ = [vent(&mut b, (0, None), 0.05, 0.5), vent(&mut b, (0, None), 0.05, 2.5)];
    let plan = b.plan();
    let at = |steps: usize| {
        let dt = 3600.0 / steps as f64;
        let rows = forcing(&plan, Scheme::Sdirk2, steps, dt, |_, row| row[channel::AIR_TEMPERATURE] = 12.0);
        let mut options = options(Scheme::Sdirk2, dt, vec![Output::AirTemperature { zone: 0 }]);
        options.initial = Initial::Everywhere(26.0);
        *run(&plan, &rows, &options).records.last().unwrap()
    };
    let exact = 2.0 * at(3840) - at(1920);
    let [coarse, fine] = [60, 120].map(|steps| (at(steps) - exact).abs());
    assert!((1.8..2.2).contains(&(coarse / fine)), "{coarse} and {fine}");
}

/// A member has the same bits alone and in lanes.
#[test]
fn lanes_have_the_bits_of_single_runs() {
    let plan = ventilated();
    let (width, which) = (values(&plan).len(), position(&plan, "heater.power"));
    let members: Vec<f64> = (0..9)
        .flat_map(|member| {
            let mut numbers = values(&plan);
            numbers[which] += 60.0 * f64::from(member);
            numbers[position(&plan, "open")] += 20.0 * f64::from(member);
            numbers
        })
        .collect();
    let (scheme, dt) = (Scheme::Sdirk2, 900.0);
    let rows = forcing(&plan, scheme, 96, dt, day);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(scheme, dt, outputs());
    let all = ensemble(&plan, &members, &drive, &options, &RunControl::default()).unwrap();
    let size = all.records.len() / 9;
    for member in 0..9 {
        let own = &members[member * width..(member + 1) * width];
        let alone = ensemble(&plan, own, &drive, &options, &RunControl::default()).unwrap();
        let same = all.records[member * size..].iter().zip(&alone.records);
        assert!(same.clone().all(|(a, b)| a.to_bits() == b.to_bits()), "member {member}");
        assert!(same.count() == size && all.closure[member] < 1e-12);
    }
}

/// Derivatives by the heater, an area, the shelter and the height of a window: forward, in reverse and by differences.
#[test]
fn derivatives() {
    let plan = ventilated();
    let mut numbers = values(&plan);
    for time in ["open", "closed"] {
        numbers[position(&plan, time)] = 0.0;
    }
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        let rows = forcing(&plan, scheme, 72, 1200.0, day);
        let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
        let options = options(scheme, 1200.0, outputs());
        let watch = RunControl::default();
        let trajectory = Trajectory::new(&plan, &numbers, &drive, &options, &watch, 1 << 30).unwrap();
        let weights: Vec<f64> =
            (0..trajectory.run.records.len()).map(|i| Real::sin(0.37 * i as f64)).collect();
        let reverse = trajectory.pull(&plan, &numbers, &drive, &options, &watch, &weights).unwrap();
        for path in
            ["heater.power", "vent0.area", "wind.shelter", "window.height", "vent2.discharge", "ratio"]
        {
            let which = position(&plan, path);
            let forward = jacobian(&plan, &numbers, &[which], &drive, &options, &watch).unwrap();
            let weighted: f64 =
                forward.slopes.iter().zip(&weights).map(|(slope, weight)| slope * weight).sum();
            assert!((weighted / reverse[which] - 1.0).abs() < 1e-8, "{path}: {weighted}, {}", reverse[which]);
            let sum = |step: f64| {
                let mut numbers = numbers.clone();
                numbers[which] *= 1.0 + step;
                let records = mascarin_engine::run::simulate(&plan, &numbers, &drive, &options, &watch)
                    .unwrap()
                    .records;
                records.iter().zip(&weights).map(|(record, weight)| record * weight).sum::<f64>()
            };
            // Near a pressure difference of zero the flow bends within 0.2 mPa.
            let difference = (sum(2e-6) - sum(-2e-6)) / (4e-6 * numbers[which]);
            assert!((weighted / difference - 1.0).abs() < 1e-4, "{path}: {weighted}, {difference}");
        }
    }
}
