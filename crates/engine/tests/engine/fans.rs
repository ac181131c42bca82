//! Ventilation units, air from zone to zone, doors, thermal bridges, pressure tests and sun to the air.

use crate::common::{Builder, facing, forcing, options, relative, run, try_run, values};
use mascarin_engine::description::{
    Description, DirectedFlow, Door, Facing, PublishedLaw, SetPoint, ThermalBridge, UnitFlow,
    VentilationUnit, ZoneLongwave,
};
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::{Forcing, channel};
use mascarin_engine::number::{Dual, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::simulate;
use mascarin_engine::{RunControl, Scheme};

const STEP: f64 = 900.0;
/// Density at 15 degC and the pressure of the standard atmosphere at 55 m, times 1006 J/(kg K) [J/(m3 K)].
const HEAT: f64 = 100_666.018_81 / (287.055 * 288.15) * 1006.0;
const FLOW: f64 = 0.03;
const OUTDOOR: f64 = 5.0;

fn flow(zone: usize, flow: mascarin_engine::description::ParamId) -> UnitFlow {
    UnitFlow { zone, flow, schedule: None, density: None }
}

/// Three zones whose only walls are adiabatic: living room, corridor, bath. A unit supplies the first and extracts from the last.
fn row_of_zones(supplied: Option<f64>, recovery: Option<f64>) -> Builder {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1000.0);
    let wall = b.construction("wall", &[(board, 0.01, 1)]);
    for name in ["living", "corridor", "bath"] {
        let zone = b.zone(name, 30.0, 0.0, ZoneLongwave::None);
        let h = b.convection(3.0);
        let inside = b.inside(zone, h, 0.9);
        b.surface(name, wall, [10.0, 90.0, 0.0], facing(Facing::Adiabatic, None), inside);
    }
    let supply = b.number("unit.supply", FLOW);
    let exhaust = b.number("unit.exhaust", FLOW);
    let temperature =
        supplied.map(|value| SetPoint::Constant { temperature: b.number("unit.temperature", value) });
    let recovery = recovery.map(|value| b.number("unit.recovery", value));
    b.description.ventilation_units.push(VentilationUnit {
        name: "unit".to_owned(),
        supply: vec![flow(0, supply)],
        exhaust: vec![flow(2, exhaust)],
        temperature,
        recovery,
    });
    for from in 0..2 {
        let number = b.number(&format!("overflow.{from}"), FLOW);
        let name = "overflow".to_owned();
        b.description.directed_flows.push(DirectedFlow {
            name,
            from,
            to: from + 1,
            flow: number,
            schedule: None,
            density: None,
        });
    }
    b
}

fn gain(b: &mut Builder, zone: usize, power: f64) {
    let power = b.number("gain.power", power);
    let radiative = b.number("gain.radiative", 0.0);
    let name = "gain".to_owned();
    b.description.zones[zone].gains.push(mascarin_engine::description::Gain {
        name,
        power,
        radiative,
        activity: None,
        schedule: None,
    });
}

/// Air temperatures of all zones after a long time in constant weather, the energy balance, and the flows in the last 100 steps.
fn steady(description: Description) -> (Vec<f64>, mascarin_engine::energy_balance::EnergyBalance<f64>) {
    let plan = Plan::new(description).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 4000, STEP, |_, row| {
        row[channel::AIR_TEMPERATURE] = OUTDOOR;
        row[channel::WIND_SPEED] = 0.0;
    });
    let outputs: Vec<_> = (0..plan.zones.len()).map(|zone| Output::AirTemperature { zone }).collect();
    let count = outputs.len();
    let result = run(&plan, &rows, &options(Scheme::Sdirk2, STEP, outputs));
    assert!(result.energy_balance.closure() < 1e-12, "{}", result.energy_balance.closure());
    (result.records[result.records.len() - count..].to_vec(), result.energy_balance)
}

/// Supplied air passes a row of zones; heat in the corridor warms it by `P/(c q)` from there on.
#[test]
fn supplied_air_passes_from_zone_to_zone() {
    let mut b = row_of_zones(Some(18.0), None);
    gain(&mut b, 1, 200.0);
    let (air, energy_balance) = steady(b.description);
    let rise = 200.0 / (HEAT * FLOW);
    for (found, expected) in air.iter().zip([18.0, 18.0 + rise, 18.0 + rise]) {
        assert!((found - expected).abs() < 1e-6, "{air:?}, rise {rise}");
    }
    assert!(energy_balance.into[Flow::Interzone as usize].abs() < 1e-12 * energy_balance.total_exchanged);
}

/// Heat recovery of effectiveness e: in a steady state `P = (1 - e) c q (T_bath - T_o)`, and the living room is at the supply
/// temperature `T_o + e (T_bath - T_o)`.
#[test]
fn heat_recovery_by_hand() {
    let mut b = row_of_zones(None, Some(0.7));
    gain(&mut b, 2, 200.0);
    let (air, _) = steady(b.description);
    let exhaust = OUTDOOR + 200.0 / (HEAT * FLOW * 0.3);
    assert!((air[2] - exhaust).abs() < 1e-6, "{air:?} {exhaust}");
    assert!((air[0] - (OUTDOOR + 0.7 * (exhaust - OUTDOOR))).abs() < 1e-6, "{air:?}");
}

/// The bath lacks half of what is extracted: outdoor air comes in through leaks. `T = (18 + 5)/2`.
#[test]
fn what_is_lacking_comes_from_outdoors() {
    let mut b = row_of_zones(Some(18.0), None);
    for number in &mut b.description.parameters {
        if number.path.starts_with("unit.supply") || number.path.starts_with("overflow") {
            number.value = 0.5 * FLOW;
        }
    }
    let (air, _) = steady(b.description);
    assert!((air[1] - 18.0).abs() < 1e-6 && (air[2] - 0.5 * (18.0 + OUTDOOR)).abs() < 1e-6, "{air:?}");
}

fn bridge(b: &mut Builder, zone: usize, conductance: f64, to: Facing) {
    let (coefficient, size) = (b.number("bridge.psi", conductance / 4.0), b.number("bridge.length", 4.0));
    let name = "bridge".to_owned();
    b.description.thermal_bridges.push(ThermalBridge { name, zone, coefficient, size, to });
}

/// 100 W through bridges of 5 W/K to outdoors, 3 W/K to ground of 11 degC and 2 W/K to another zone that loses by 4 W/K.
#[test]
fn bridges_conduct_what_they_should() {
    let mut b = row_of_zones(Some(18.0), None);
    (b.description.ventilation_units, b.description.directed_flows) = (Vec::new(), Vec::new());
    gain(&mut b, 0, 100.0);
    let number = |b: &mut Builder, value| b.number("ground", value);
    let numbers = [
        ("mean", number(&mut b, 11.0)),
        ("amplitude", number(&mut b, 0.0)),
        ("coldest_day", number(&mut b, 15.0)),
    ];
    let ground = Facing::imposed("ground", &numbers);
    bridge(&mut b, 0, 5.0, Facing::Outdoors);
    bridge(&mut b, 0, 3.0, ground);
    bridge(&mut b, 0, 2.0, Facing::Zone { zone: 1 });
    bridge(&mut b, 1, 4.0, Facing::Outdoors);
    bridge(&mut b, 2, 1.0, Facing::Outdoors);
    let (air, energy_balance) = steady(b.description);
    // In series 2 and 4 W/K to outdoors: 4/3 W/K.
    let room = (100.0 + (5.0 + 4.0 / 3.0) * OUTDOOR + 3.0 * 11.0) / (5.0 + 4.0 / 3.0 + 3.0);
    assert!((air[0] - room).abs() < 1e-6, "{air:?} {room}");
    assert!((air[1] - (OUTDOOR + (room - OUTDOOR) / 3.0)).abs() < 1e-6, "{air:?}");
    assert!(energy_balance.into[Flow::Bridges as usize] < 0.0);
}

/// Between two zones a door carries `P = c C_d W H/3 sqrt(g H/T) d^1.5`; the colder zone loses it by a bridge.
#[test]
fn a_door_carries_heat() {
    let mut b = row_of_zones(Some(18.0), None);
    (b.description.ventilation_units, b.description.directed_flows) = (Vec::new(), Vec::new());
    gain(&mut b, 0, 300.0);
    bridge(&mut b, 1, 30.0, Facing::Outdoors);
    bridge(&mut b, 2, 1.0, Facing::Outdoors);
    let mut number = |value| b.number("door", value);
    let [width, height, discharge, open] = [0.9, 2.0, 0.65, 0.5].map(&mut number);
    let name = "door".to_owned();
    b.description.doors.push(Door {
        name,
        between: [0, 1],
        width,
        height,
        discharge,
        open,
        schedule: None,
        control: None,
    });
    let (air, _) = steady(b.description);
    let whole = HEAT * 0.65 * 0.45 * 2.0 / 3.0 * (9.806_65_f64 * 2.0 / 293.15).sqrt();
    let difference = Real::powf(300.0 / whole, 2.0 / 3.0);
    assert!((air[1] - (OUTDOOR + 10.0)).abs() < 1e-6, "{air:?}");
    assert!((air[0] - air[1] - difference).abs() < 1e-4 * difference, "{air:?} {difference}");
}

/// n50 times a factor is a constant air change: 100 W, 30 m3, 2 0.07 1/h.
#[test]
fn a_pressure_test_is_infiltration() {
    let mut b = row_of_zones(Some(18.0), None);
    (b.description.ventilation_units, b.description.directed_flows) = (Vec::new(), Vec::new());
    gain(&mut b, 0, 100.0);
    for zone in 0..3 {
        let numbers = [("n50", b.number("n50", 2.0)), ("factor", b.number("factor", 0.07))];
        let leakage = PublishedLaw::new("factor", &numbers);
        b.description.zones[zone].infiltration.leakage = Some(leakage);
    }
    let (air, _) = steady(b.description);
    let expected = OUTDOOR + 100.0 / (HEAT * 30.0 * 0.14 / 3600.0);
    assert!((air[0] - expected).abs() < 1e-5, "{air:?} {expected}");
}

/// All of them at once, unbalanced, in changing weather.
fn all_at_once() -> Plan {
    let mut b = row_of_zones(None, Some(0.6));
    gain(&mut b, 0, 150.0);
    bridge(&mut b, 0, 2.0, Facing::Outdoors);
    bridge(&mut b, 1, 3.0, Facing::Zone { zone: 2 });
    // Away from balances, where slopes differ to both sides.
    let factors = [("unit.exhaust", 1.3), ("overflow.0", 0.9), ("overflow.1", 0.8)];
    for number in &mut b.description.parameters {
        for (_, factor) in factors.iter().filter(|(path, _)| *path == number.path) {
            number.value *= factor;
        }
    }
    let mut number = |path: &str, value| b.number(path, value);
    let door = Door {
        name: "door".to_owned(),
        between: [0, 1],
        width: number("door.width", 0.8),
        height: number("door.height", 2.0),
        discharge: number("door.discharge", 0.5),
        open: number("door.open", 0.3),
        schedule: None,
        control: None,
    };
    let numbers = [
        ("n50", number("leak.n50", 3.0)),
        ("exponent", number("leak.exponent", 0.65)),
        ("stack", number("leak.stack", 0.000_145)),
        ("wind", number("leak.wind", 0.000_174)),
    ];
    let leakage = PublishedLaw::new("stack_wind", &numbers);
    b.description.doors.push(door);
    b.description.zones[2].infiltration.leakage = Some(leakage);
    b.plan()
}

fn weather(time: f64, row: &mut [f64]) {
    let day = core::f64::consts::TAU * time / 86_400.0;
    row[channel::AIR_TEMPERATURE] = 6.0 + 5.0 * Real::sin(day);
    row[channel::WIND_SPEED] = 3.0 + 2.0 * Real::cos(day);
}

/// The tangents of the elimination are those of the terms: residuals at the accepted temperatures are rounding.
#[test]
fn residuals_are_rounding() {
    let plan = all_at_once();
    for scheme in [Scheme::Sdirk2, Scheme::BackwardEuler] {
        let rows = forcing(&plan, scheme, 96, STEP, weather);
        let mut options = options(scheme, STEP, vec![Output::AirTemperature { zone: 0 }]);
        options.residuals = true;
        let result = run(&plan, &rows, &options);
        let largest = result.counters.largest_residual.unwrap();
        assert!(largest < 1e-6 && largest > 0.0, "{largest} W");
        assert!(result.energy_balance.closure() < 1e-12);
    }
}

/// Derivatives by every number of these parts agree with central differences.
#[test]
fn slopes_are_differences() {
    let plan = all_at_once();
    let numbers = values(&plan);
    let outputs: Vec<_> = (0..3).map(|zone| Output::AirTemperature { zone }).collect();
    let (rows, options) =
        (forcing(&plan, Scheme::Sdirk2, 48, STEP, weather), options(Scheme::Sdirk2, STEP, outputs));
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let figure = |numbers: &[f64]| -> f64 {
        let records = try_run(&plan, numbers, &rows, &options).unwrap().records;
        records.iter().enumerate().map(|(i, record)| (1.0 + Real::sin(0.37 * i as f64)) * record).sum()
    };
    let names = ["unit.", "overflow.", "bridge.", "door.", "leak.", "gain.power"];
    let mut checked = 0;
    for (which, parameter) in plan.description.parameters.iter().enumerate() {
        if !names.iter().any(|name| parameter.path.starts_with(name)) {
            continue;
        }
        let variable = |(i, &n)| if i == which { Dual::variable(n, 0) } else { Dual::constant(n) };
        let duals: Vec<Dual<1>> = numbers.iter().enumerate().map(variable).collect();
        let records = simulate(&plan, &duals, &drive, &options, &RunControl::default()).unwrap().records;
        let slope: f64 = records
            .iter()
            .enumerate()
            .map(|(i, record)| (1.0 + Real::sin(0.37 * i as f64)) * record.slope[0])
            .sum();
        let step = 1e-5 * numbers[which].abs();
        let shifted = |sign: f64| {
            let mut numbers = numbers.clone();
            numbers[which] += sign * step;
            figure(&numbers)
        };
        let difference = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
        assert!(
            relative(slope, difference) < 1e-5 || (slope - difference).abs() < 1e-6 / step,
            "{}: {slope} is not {difference}",
            parameter.path
        );
        checked += 1;
    }
    assert!(checked > 15, "{checked}");
}

/// Members of an ensemble have the bits that each has alone.
#[test]
fn lanes_are_scalars_with_fans() {
    let plan = all_at_once();
    let width = plan.description.parameters.len();
    let unit = plan.description.parameters.iter().position(|one| one.path == "unit.exhaust").unwrap();
    let mut numbers = Vec::new();
    for member in 0..9 {
        let mut one = values(&plan);
        one[unit] *= 0.6 + 0.1 * f64::from(member);
        numbers.extend(one);
    }
    let options = options(Scheme::Sdirk2, STEP, vec![Output::AirTemperature { zone: 2 }]);
    let rows = forcing(&plan, Scheme::Sdirk2, 48, STEP, weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let together = ensemble(&plan, &numbers, &drive, &options, &RunControl::default()).unwrap();
    let row = together.records.len() / 9;
    for (member, numbers) in numbers.chunks(width).enumerate() {
        let alone = simulate(&plan, numbers, &drive, &options, &RunControl::default()).unwrap();
        for (a, b) in alone.records.iter().zip(&together.records[member * row..]) {
            assert_eq!(a.to_bits(), b.to_bits(), "member {member}");
        }
    }
}
