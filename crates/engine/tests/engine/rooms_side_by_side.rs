//! Rooms of one shape, which a single run computes side by side and a pack of members one by one: the same bits.

use crate::common::conditioned::{ideal_load, number};
use crate::common::{ALL_SCHEMES, Builder, facing, forcing, options, run, values, weather};
use mascarin_engine::RunControl;
use mascarin_engine::description::{
    Construction, Convection, Description, Facing, Gap, Gas, Glazing, Pane, PaneOptics, ParamId, Side,
    ZoneLongwave,
};
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;

/// Of one shape: a front of eight and one of seven, beside the rooms at the ends.
pub const ROOMS: usize = 17;
const STEP: f64 = 900.0;

/// A unit by U and g: windows of this kind are computed together.
fn unit(d: &mut Description) -> Glazing {
    Glazing::Simple {
        u_value: number(d, "unit.u_value", 2.1),
        solar_heat_gain: number(d, "unit.solar_heat_gain", 0.7),
        transmittance: None,
        panes: number(d, "unit.panes", 2.0),
        category: number(d, "unit.category", 4.0),
        surface_resistances: [number(d, "unit.outside_film", 0.04), number(d, "unit.inside_film", 0.13)],
    }
}

/// Two panes that store heat: such a window is computed by itself, and with it those at its place in other rooms.
fn heavy_panes(d: &mut Description) -> Glazing {
    let pane = |d: &mut Description| Pane {
        thickness: number(d, "pane.thickness", 0.006),
        conductivity: number(d, "pane.conductivity", 1.0),
        storage: Some([number(d, "pane.density", 2500.0), number(d, "pane.specific_heat", 750.0)]),
        emissivity: [number(d, "pane.outside", 0.84), number(d, "pane.inside", 0.84)],
        optics: Some(PaneOptics {
            transmittance: number(d, "pane.transmittance", 0.8),
            reflectance: [number(d, "pane.front", 0.08), number(d, "pane.back", 0.08)],
            coated: false,
        }),
    };
    let gap = Gap::Filled {
        thickness: number(d, "gap.thickness", 0.012),
        pressure: number(d, "gap.pressure", 101_325.0),
        gas: Gas::Argon,
    };
    Glazing::Panes { panes: vec![pane(d), pane(d)], gaps: vec![gap], angular: None }
}

/// Gives the last surface of each room a glazing; that of one room heavy panes, where asked for.
fn glaze(d: &mut Description, windows: &[usize], storing: bool) {
    let height = number(d, "window.height", 1.5);
    let first = d.constructions.len();
    for glazing in [unit(d), heavy_panes(d)] {
        d.constructions.push(Construction {
            name: "glass".to_owned(),
            layers: Vec::new(),
            glazing: Some(glazing),
            blind: None,
        });
    }
    for (room, &window) in windows.iter().enumerate() {
        let surface = &mut d.surfaces[window];
        surface.construction = first + usize::from(storing && room == 4);
        surface.cavity_height = Some(height);
        (surface.outside.absorptance, surface.inside.absorptance) = (None, None);
    }
}

/// A row of rooms with walls between them and a window each. Most have the same surfaces, whose areas and laws differ; those at the ends have
/// one wall less between rooms, and the last one has a second wall to outdoors.
pub fn row(loads: bool, storing: bool) -> Plan {
    let mut b = Builder::new();
    let concrete = b.solid("concrete", 1.4, 2200.0, 900.0);
    let board = b.solid("board", 0.2, 500.0, 1000.0);
    let heavy = b.construction("heavy", &[(board, 0.04, 2), (concrete, 0.15, 4)]);
    let light = b.construction("light", &[(board, 0.02, 2)]);
    let factor = b.number("factor", 1.0);
    let natural = |factor: ParamId| Convection::law("tarp", &[("factor", factor)]);
    let roughness = b.number("roughness", 1.67);
    let (mut between, mut windows) = (None, Vec::new());
    let absorbing = Some(b.number("inside.absorptance", 0.5));
    for room in 0..ROOMS {
        let x = room as f64;
        let zone = b.zone(&format!("room{room}"), 30.0 + x, 0.5, ZoneLongwave::Radiosity);
        let mut walls = vec![("wall", 90.0), ("roof", 0.0)];
        walls.extend((room + 1 == ROOMS).then_some(("second", 90.0)));
        for (name, tilt) in walls {
            let outside = b.outdoors(
                Convection::law("doe2", &[("factor", factor), ("roughness", roughness)]),
                0.9,
                0.6,
            );
            // Rooms of one shape have different correlations at the same place.
            let law = if room % 3 == 1 { b.convection(3.0 + 0.1 * x) } else { natural(factor) };
            let inside = Side { absorptance: absorbing, ..b.inside(zone, law, 0.9) };
            b.surface(&format!("{name}{room}"), heavy, [10.0 + 0.5 * x, tilt, 20.0 * x], outside, inside);
        }
        let floor = Side { absorptance: absorbing, ..b.inside(zone, natural(factor), 0.8) };
        b.surface(&format!("floor{room}"), heavy, [12.0, 180.0, 0.0], facing(Facing::Adiabatic, None), floor);
        if let Some(before) = between {
            let [outer, inner] = [before, zone]
                .map(|zone| Side { absorptance: absorbing, ..b.inside(zone, natural(factor), 0.9) });
            b.surface(&format!("between{room}"), light, [9.0, 90.0, 90.0], outer, inner);
        }
        between = Some(zone);
        let outside =
            b.outdoors(Convection::law("doe2", &[("factor", factor), ("roughness", roughness)]), 0.84, 0.0);
        let inside = b.inside(zone, natural(factor), 0.84);
        windows.push(b.surface(
            &format!("window{room}"),
            light,
            [2.0 + 0.1 * x, 90.0, 180.0],
            outside,
            inside,
        ));
    }
    let mut d = b.describe();
    glaze(&mut d, &windows, storing);
    for room in 0..if loads { ROOMS } else { 0 } {
        d.zones[room].heating = Some(ideal_load(&mut d, &format!("heating{room}"), 21.0, 400.0));
        d.zones[room].cooling = Some(ideal_load(&mut d, &format!("cooling{room}"), 24.0, 9000.0));
    }
    Plan::new(d).unwrap()
}

/// The bits of a run are those of a member of an ensemble, and its energy balance closes.
#[test]
fn rooms_side_by_side_have_the_bits_of_rooms_alone() {
    for (loads, storing) in [(false, false), (true, false), (true, true)] {
        let plan = row(loads, storing);
        for scheme in ALL_SCHEMES {
            let rows = forcing(&plan, scheme, 96, STEP, weather);
            let outputs =
                (0..ROOMS).flat_map(|zone| [Output::AirTemperature { zone }, Output::NetLoad { zone }]);
            let surfaces = (0..plan.description.surfaces.len())
                .flat_map(|surface| [0, 1].map(|side| Output::FaceTemperature { surface, side }));
            let options = options(scheme, STEP, outputs.chain(surfaces).collect());
            let alone = run(&plan, &rows, &options);
            assert!(alone.energy_balance.closure() < 1e-12, "{}", alone.energy_balance.closure());
            let heat = [Flow::Heating, Flow::Cooling].map(|flow| alone.energy_balance.into[flow as usize]);
            assert_eq!(heat.map(|heat| heat != 0.0), [loads; 2], "{heat:?} J");
            let drive = Forcing::new(&rows, scheme.weights().len(), plan.n_channels()).unwrap();
            let members = values(&plan).repeat(8);
            let pack = ensemble(&plan, &members, &drive, &options, &RunControl::default()).unwrap();
            assert!(pack.failures.is_empty(), "{:?}", pack.failures);
            for (i, (a, b)) in alone.records.iter().zip(&pack.records).enumerate() {
                assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}: number {i}, {scheme:?}");
            }
            assert_eq!(alone.energy_balance.closure().to_bits(), pack.closure[0].to_bits());
        }
    }
}
