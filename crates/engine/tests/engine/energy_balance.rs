//! The energy balance where conductances and heat capacities are far apart, and where nothing happens.

use crate::common::{Builder, facing, forcing, options, run, weather};
use mascarin_engine::Scheme;
use mascarin_engine::description::{Facing, ZoneLongwave};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;

const SCHEMES: [Scheme; 3] = [Scheme::Sdirk2, Scheme::LinearlyImplicit, Scheme::BackwardEuler];

/// A roof of metal sheets [conductivity, thickness, nodes] over a zone.
fn sheet(conductivity: f64, thickness: f64, nodes: usize, melts: bool) -> Plan {
    let mut b = Builder::new();
    let metal = b.solid("metal", conductivity, 3858.0, 1295.0);
    let mut layers = vec![(metal, thickness, nodes)];
    if melts {
        layers.push((b.energain(1.0), 0.005, 4));
    }
    let construction = b.construction("roof", &layers);
    let zone = b.zone("room", 16.85, 0.0, ZoneLongwave::Radiosity);
    let (outer, inner) = (b.convection(4.3), b.convection(3.0));
    let (outside, inside) = (b.outdoors(outer, 0.2, 0.1), b.inside(zone, inner, 0.3));
    b.surface("roof", construction, [32.0, 0.0, 0.0], outside, inside);
    b.plan()
}

/// A sheet conducts a million times what its surfaces exchange: differences of conductances would lose the balance.
#[test]
fn the_balance_of_metal_sheets_closes() {
    for (conductivity, thickness, nodes) in
        [(85.0, 0.0054, 30), (400.0, 1e-4, 1), (400.0, 1e-4, 8), (50.0, 1e-3, 1)]
    {
        for melts in [false, true] {
            let plan = sheet(conductivity, thickness, nodes, melts);
            for scheme in SCHEMES {
                for dt in [60.0, 600.0, 3600.0] {
                    let rows = forcing(&plan, scheme, 144, dt, weather);
                    let closure =
                        run(&plan, &rows, &options(scheme, dt, Vec::new())).energy_balance.closure();
                    let case = format!("{nodes} nodes of {thickness} m, {melts}, {scheme:?}, {dt} s");
                    assert!(closure < 1e-11, "{case}: {closure:e}");
                }
            }
        }
    }
}

/// A wall that touches no zone, of 5000 cells.
#[test]
fn the_balance_of_thousands_of_cells_closes() {
    let mut b = Builder::new();
    let brick = b.solid("brick", 0.5, 1500.0, 900.0);
    let construction = b.construction("wall", &[(brick, 0.5, 5000)]);
    let outer = b.convection(5.0);
    let outside = b.outdoors(outer, 0.2, 0.3);
    b.surface("wall", construction, [30.0, 0.0, 0.0], outside, facing(Facing::Adiabatic, None));
    let plan = b.plan();
    for scheme in SCHEMES {
        let rows = forcing(&plan, scheme, 48, 3600.0, weather);
        let closure = run(&plan, &rows, &options(scheme, 3600.0, Vec::new())).energy_balance.closure();
        assert!(closure < 1e-11, "{scheme:?}: {closure:e}");
    }
}

/// An adiabatic building at rest exchanges nothing: there is no balance to close.
#[test]
fn a_building_at_rest_has_no_residual() {
    for temperature in [20.0, -7.3, 23.4] {
        let mut b = Builder::new();
        let pcm = b.energain(1.0);
        let construction = b.construction("wall", &[(pcm, 0.0038, 6)]);
        let zone = b.zone("room", 44.8, 0.0, ZoneLongwave::Radiosity);
        let inner = b.power([0.3, 1.4, 0.3, 0.0, 1.0], [0.2, 0.6, 0.25, 0.0, 1.0]);
        let inside = b.inside(zone, inner, 0.14);
        b.surface("wall", construction, [11.0, 180.0, 0.0], facing(Facing::Adiabatic, None), inside);
        let plan = b.plan();
        let rows = forcing(&plan, Scheme::Sdirk2, 144, 600.0, weather);
        let mut options = options(Scheme::Sdirk2, 600.0, vec![Output::AirTemperature { zone: 0 }]);
        options.initial = mascarin_engine::state::Initial::Everywhere(temperature);
        let run = run(&plan, &rows, &options);
        assert_eq!(
            run.energy_balance.closure(),
            0.0,
            "{} J of {} J",
            run.energy_balance.imbalance,
            run.energy_balance.total_exchanged
        );
        assert!(run.records.iter().all(|air| (air - temperature).abs() < 1e-9));
    }
}
