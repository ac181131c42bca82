use super::*;
use crate::building::coefficients::Coefficients;
use crate::building::plan::Plan;
use crate::common::facing;
use crate::common::{Builder, values};
use crate::input::description::{
    Facing, Gain, HeatFlux, OutdoorLongwave, ParamId, Parameter, Side, ZoneLongwave,
};
use crate::physics::constants::{KELVIN, SIGMA};
use crate::step::control::RunControl;

/// One cell and one air: the matrices are those of the network of two capacities written by hand.
#[test]
fn two_capacities() {
    const AREA: f64 = 6.0;
    const THICKNESS: f64 = 0.1;
    const CONDUCTIVITY: f64 = 0.5;
    const HEAT: f64 = 1.2e6;
    const OUTER: f64 = 14.0;
    const INNER: f64 = 3.0;
    const ABSORPTANCE: f64 = 0.6;
    const EMISSIVITY: f64 = 0.9;
    const VOLUME: f64 = 30.0;
    const AIR_CHANGES: f64 = 0.7;
    const REFERENCE: f64 = 10.0;
    const RADIATIVE: f64 = 0.4;
    let mut b = Builder::new();
    let solid = b.solid("solid", CONDUCTIVITY, 1200.0, HEAT / 1200.0);
    let construction = b.construction("wall", &[(solid, THICKNESS, 1)]);
    let zone = b.zone("zone", VOLUME, AIR_CHANGES, ZoneLongwave::None);
    let (outer, inner) = (b.convection(OUTER), b.convection(INNER));
    let reference = b.number("reference", REFERENCE);
    let mut outside = b.outdoors(outer, EMISSIVITY, ABSORPTANCE);
    outside.longwave = OutdoorLongwave::Linearised { reference };
    let inside = b.inside(zone, inner, 0.9);
    b.surface("wall", construction, [AREA, 90.0, 0.0], outside, inside);
    let mut description = b.describe();
    let mut number = |path: &str, value: f64| {
        description.parameters.push(Parameter { path: path.to_owned(), value });
        ParamId(u32::try_from(description.parameters.len() - 1).unwrap())
    };
    let (power, radiative) = (number("power", 100.0), number("radiative", RADIATIVE));
    let gain = Gain { name: "light".to_owned(), power, radiative, activity: None, schedule: None };
    description.zones[0].gains.push(gain);
    let plan = Plan::new(description).unwrap();
    let numbers = values(&plan);
    let air_capacity = Coefficients::new(&plan, &numbers).zones[0].capacity;
    let system = state_space(&plan, &numbers, &RunControl::default()).unwrap();

    let half = CONDUCTIVITY / (0.5 * THICKNESS);
    let kelvin = REFERENCE + KELVIN;
    let slope = 4.0 * SIGMA * (kelvin * kelvin * kelvin);
    let offset = SIGMA * (kelvin * kelvin * kelvin * kelvin) - slope * REFERENCE;
    // A vertical wall sees half the sky; the part near the horizon is as warm as the air.
    let to_sky = 0.5 * 0.5_f64.sqrt();
    // Surfaces: `(half + outer) T = half T_cell + ...`, `(half + inner) T = half T_cell + inner T_air + ...`.
    let from_outer = half / (half + OUTER + EMISSIVITY * slope);
    let from_inner = half / (half + INNER);
    let by_air = OUTER + EMISSIVITY * (1.0 - to_sky) * slope;
    let cell = AREA * THICKNESS * HEAT;
    let inflow = air_capacity * AIR_CHANGES / 3600.0;
    let per_cell = |heat: f64| heat / cell;
    let per_air = |heat: f64| heat / air_capacity;
    let a = [
        per_cell(-AREA * (half * (1.0 - from_outer) + half * (1.0 - from_inner))),
        per_cell(AREA * from_inner * INNER),
        per_air(AREA * INNER * from_inner),
        per_air(-AREA * INNER * from_inner - inflow),
    ];
    let b = [
        per_cell(AREA * from_outer * ABSORPTANCE),
        per_cell(AREA * from_outer * by_air),
        per_cell(AREA * from_outer * EMISSIVITY * to_sky),
        per_cell(-AREA * from_outer * EMISSIVITY * to_sky * offset),
        per_cell(from_inner * RADIATIVE),
        0.0,
        per_air(inflow),
        0.0,
        0.0,
        per_air(1.0 - RADIATIVE + (1.0 - from_inner) * RADIATIVE),
    ];
    let names =
        ["wall.outside_irradiance", "outdoor_air_temperature", "sky_emission", "one", "zone.light_gain"];
    assert_eq!(system.inputs, names);
    assert_eq!(system.states, ["wall.layer_0_1_temperature", "zone.air_temperature"]);
    for (found, expected) in [(&system.a, &a[..]), (&system.b, &b[..])] {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found:e} is not {expected:e}");
        }
    }
}

/// A heat flux that is given is an input: all of it reaches the cell, and the surface is warmer than the cell by its resistance.
#[test]
fn a_heat_flux_is_an_input() {
    const AREA: f64 = 6.0;
    const THICKNESS: f64 = 0.1;
    const CONDUCTIVITY: f64 = 0.5;
    const HEAT: f64 = 1.2e6;
    let mut b = Builder::new();
    let solid = b.solid("solid", CONDUCTIVITY, 1200.0, HEAT / 1200.0);
    let construction = b.construction("wall", &[(solid, THICKNESS, 1)]);
    let zone = b.zone("zone", 30.0, 0.5, ZoneLongwave::None);
    let inner = b.convection(3.0);
    let flux = b.number("flux", 40.0);
    let outside =
        Side { heat_flux: Some(HeatFlux { flux, schedule: None }), ..facing(Facing::Adiabatic, None) };
    let inside = b.inside(zone, inner, 0.9);
    b.surface("wall", construction, [AREA, 90.0, 0.0], outside, inside);
    let plan = b.plan();
    let numbers = values(&plan);
    let system = state_space(&plan, &numbers, &RunControl::default()).unwrap();
    let input = system.inputs.iter().position(|name| name == "wall.outside_heat_flux").unwrap();
    let inputs = system.inputs.len();
    let into_cell = system.b[input] * AREA * THICKNESS * HEAT;
    assert!((into_cell / AREA - 1.0).abs() < 1e-12, "{into_cell}");
    let surface = system.outputs.iter().position(|name| name == "wall.outside_temperature").unwrap();
    let rise = system.d[surface * inputs + input];
    assert!((rise * CONDUCTIVITY / (0.5 * THICKNESS) - 1.0).abs() < 1e-12, "{rise}");
}
