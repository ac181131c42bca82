//! Rooms with windows, frames and shades: books, lanes, derivatives, order.

mod common;

use common::{Builder, facing, forcing, options, position, run, try_run, values, warmup, weather};
use mascarin_engine::batch::ensemble;
use mascarin_engine::description::{
    Construction, Description, Facing, FrameShare, Gap, Gas, Glazing, Material, Pane, PaneOptics, ParamId,
    Parameter, Side, Surface, ZoneLongwave, ZoneSun,
};
use mascarin_engine::forcing::Forcing;
use mascarin_engine::ledger::Flow;
use mascarin_engine::march::{Watch, march};
use mascarin_engine::plan::Plan;
use mascarin_engine::probe::Probe;
use mascarin_engine::real::{Dual, Real};
use mascarin_engine::step::Scheme;

const STEP: f64 = 900.0;
const SCHEMES: [Scheme; 2] = [Scheme::Sdirk2, Scheme::BackwardEuler];
type Corners = [[f64; 3]; 4];
/// A room of 8 m by 6 m by 2.7 m: name, tilt, azimuth, corners seen from outside.
const ROOM: [(&str, [f64; 2], Corners); 6] = [
    ("south", [90.0, 180.0], [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 2.7], [0.0, 0.0, 2.7]]),
    ("north", [90.0, 0.0], [[8.0, 6.0, 0.0], [0.0, 6.0, 0.0], [0.0, 6.0, 2.7], [8.0, 6.0, 2.7]]),
    ("east", [90.0, 90.0], [[8.0, 0.0, 0.0], [8.0, 6.0, 0.0], [8.0, 6.0, 2.7], [8.0, 0.0, 2.7]]),
    ("west", [90.0, 270.0], [[0.0, 6.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.7], [0.0, 6.0, 2.7]]),
    ("floor", [180.0, 0.0], [[0.0, 0.0, 0.0], [0.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 0.0, 0.0]]),
    ("roof", [0.0, 0.0], [[0.0, 0.0, 2.7], [8.0, 0.0, 2.7], [8.0, 6.0, 2.7], [0.0, 6.0, 2.7]]),
];
/// Panes of two windows in the north wall (the sun of the made-up weather stands in the north).
const LARGE: Corners = [[7.5, 6.0, 0.2], [4.5, 6.0, 0.2], [4.5, 6.0, 2.2], [7.5, 6.0, 2.2]];
const SMALL: Corners = [[3.5, 6.0, 0.2], [2.5, 6.0, 0.2], [2.5, 6.0, 2.2], [3.5, 6.0, 2.2]];
const HOOD: Corners = [[8.0, 6.0, 2.7], [0.0, 6.0, 2.7], [0.0, 7.0, 2.7], [8.0, 7.0, 2.7]];

fn number(d: &mut Description, path: &str, value: f64) -> ParamId {
    d.parameters.push(Parameter { path: path.to_owned(), value });
    ParamId(u32::try_from(d.parameters.len() - 1).unwrap())
}

/// A triple unit: a heavy pane, argon, a light one, a given gap, a coated one.
fn triple(d: &mut Description) -> Glazing {
    let mut pane = |storage: bool, name: &str, coated: bool| {
        let mut put = |leaf: &str, value: f64| number(d, &format!("panes.{name}.{leaf}"), value);
        let (outside, inside) = if coated { (0.1, 0.84) } else { (0.84, 0.84) };
        Pane {
            thickness: put("thickness", 0.004),
            conductivity: put("conductivity", 1.0),
            storage: storage.then(|| [put("density", 2500.0), put("specific_heat", 750.0)]),
            emissivity: [put("emissivity.outside", outside), put("emissivity.inside", inside)],
            optics: Some(PaneOptics {
                transmittance: put("transmittance", if coated { 0.6 } else { 0.83 }),
                reflectance: [put("reflectance.outside", 0.09), put("reflectance.inside", 0.08)],
                coated,
            }),
        }
    };
    let panes = vec![pane(true, "outer", false), pane(false, "middle", false), pane(false, "inner", true)];
    let filled = Gap::Filled {
        thickness: number(d, "gap.thickness", 0.012),
        pressure: number(d, "gap.pressure", 101_325.0),
        gas: Gas::Argon,
    };
    let gaps = vec![filled, Gap::Given { conductance: number(d, "gap.conductance", 5.0) }];
    Glazing::Panes { panes, gaps, angular: None }
}

fn sheet(d: &mut Description) -> Glazing {
    Glazing::Simple {
        u_value: number(d, "sheet.u_value", 2.1),
        solar_heat_gain: number(d, "sheet.solar_heat_gain", 0.7),
        panes: number(d, "sheet.panes", 2.0),
        category: number(d, "sheet.category", 4.0),
        films: [number(d, "sheet.outside_film", 0.04), number(d, "sheet.inside_film", 0.13)],
    }
}

fn side(b: &mut Builder, outdoors: bool) -> Side {
    let film = b.film(if outdoors { 15.0 } else { 3.0 });
    if outdoors {
        return b.outdoors(film, 0.9, 0.6);
    }
    let absorptance = Some(b.number("inside.absorptance", 0.55));
    Side { absorptance, ..b.inside(0, film, 0.9) }
}

/// The room, its faces in an order.
fn glazed(sun: ZoneSun, order: [usize; 6]) -> Description {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let wall = b.construction("wall", &[(board, 0.05, 3)]);
    b.zone("room", 129.6, 0.5, ZoneLongwave::Radiosity);
    for (name, [tilt, azimuth], _) in order.map(|k| ROOM[k]) {
        let area = if tilt == 90.0 { if azimuth % 180.0 == 0.0 { 21.6 } else { 16.2 } } else { 48.0 };
        let (outside, inside) = (side(&mut b, true), side(&mut b, false));
        b.surface(name, wall, [area, tilt, azimuth], outside, inside);
    }
    let (large, small) = (b.number("large.area", 6.0), b.number("small.area", 2.0));
    let fraction = b.number("large.fraction", 0.15);
    let mut add = |name: &str, construction: usize, area: ParamId, vertices: &[[f64; 3]]| {
        let (outside, inside) = (side(&mut b, true), side(&mut b, false));
        let index = b.surface(name, construction, [0.0, 90.0, 0.0], outside, inside);
        (index, area, vertices.to_vec())
    };
    let windows = [
        add("large", wall + 1, large, &LARGE),
        add("small", wall + 2, small, &SMALL),
        add("frame", wall + 3, large, &LARGE),
    ];
    let height = b.number("large.cavity_height", 2.0);
    let mut d = b.describe();
    for (surface, k) in d.surfaces.iter_mut().zip(order) {
        surface.vertices = ROOM[k].2.to_vec();
        if ROOM[k].0 == "north" {
            surface.openings = vec![large, small];
        }
    }
    for (index, area, vertices) in windows {
        let surface: &mut Surface = &mut d.surfaces[index];
        (surface.area, surface.vertices, surface.cavity_height) = (area, vertices, Some(height));
    }
    for glass in [6, 7] {
        let surface = &mut d.surfaces[glass];
        // Panes have optics of their own.
        (surface.outside.absorptance, surface.inside.absorptance) = (None, None);
    }
    d.surfaces[6].frame = Some(FrameShare { fraction, is_frame: false });
    d.surfaces[8].frame = Some(FrameShare { fraction, is_frame: true });
    for glazing in [triple(&mut d), sheet(&mut d)] {
        d.constructions.push(Construction {
            name: "glass".to_owned(),
            layers: Vec::new(),
            glazing: Some(glazing),
        });
    }
    let u_value = number(&mut d, "frame.u_value", 2.0);
    d.materials.push(Material::Rated { u_value });
    let mut frame = d.constructions[wall].clone();
    frame.layers.truncate(1);
    (frame.layers[0].material, frame.layers[0].thickness, frame.layers[0].nodes) =
        (d.materials.len() - 1, None, 0);
    d.constructions.push(frame);
    d.zones[0].sun = sun;
    d.shades.push(HOOD.to_vec());
    d
}

/// All laws of where the sun lands.
fn suns() -> [fn(&mut Description) -> ZoneSun; 3] {
    [
        |_| ZoneSun::Area,
        |d| {
            let shares = [0.1, 0.05, 0.03, 0.03, 0.6, 0.15].map(|share| Some(number(d, "share", share)));
            let faces = shares.into_iter().chain([None; 3]).collect();
            ZoneSun::Shares { faces, lost: Some(number(d, "lost", 0.04)) }
        },
        |_| ZoneSun::Geometry,
    ]
}

fn rooms() -> Vec<Description> {
    suns()
        .iter()
        .map(|sun| {
            let mut d = glazed(ZoneSun::Area, [0, 1, 2, 3, 4, 5]);
            d.zones[0].sun = sun(&mut d);
            d
        })
        .collect()
}

fn probes() -> Vec<Probe> {
    vec![
        Probe::AirTemperature { zone: 0 },
        Probe::FaceTemperature { surface: 6, side: 0 },
        Probe::FaceTemperature { surface: 6, side: 1 },
        Probe::FaceTemperature { surface: 8, side: 1 },
        Probe::FaceTemperature { surface: 4, side: 1 },
        Probe::IncidentSolar { surface: 6 },
        Probe::TransmittedSolar { surface: 6 },
        Probe::TransmittedSolar { surface: 7 },
        Probe::ZoneTransmittedSolar { zone: 0 },
        Probe::ZoneLostSolar { zone: 0 },
    ]
}

/// The books close, and what windows let in is what the zone gets.
#[test]
fn energy_closes_with_windows() {
    for description in rooms() {
        let plan = Plan::new(description).unwrap();
        for scheme in SCHEMES {
            let rows = forcing(&plan, scheme, 192, STEP, weather);
            let result = run(&plan, &rows, &options(scheme, STEP, probes()));
            assert!(result.ledger.closure() < 1e-12, "closure {} with {scheme:?}", result.ledger.closure());
            let sums: Vec<f64> = (0..10)
                .map(|k| result.records.chunks(10).skip(1).map(|record| record[k]).sum::<f64>() * STEP)
                .collect();
            assert!(sums[8] > 1e7 && (sums[6] + sums[7] - sums[8]).abs() < 1e-9 * sums[8]);
            assert!(sums[9] > 0.01 * sums[8] && sums[9] < 0.2 * sums[8], "{} of {}", sums[9], sums[8]);
            // What stays in the room, and what the glass takes on the way out.
            let kept = result.ledger.into[Flow::Transmitted as usize];
            assert!(kept > 0.7 * sums[8] && kept <= (sums[8] - sums[9]) * (1.0 + 1e-12));
            assert!(result.ledger.into[Flow::Glass as usize] > 0.0);
        }
    }
}

/// A member's bits do not depend on its neighbours, wherever on the curves they look.
#[test]
fn lanes_are_scalars_with_windows() {
    for description in rooms() {
        let plan = Plan::new(description).unwrap();
        let width = plan.description.parameters.len();
        let [tilt, azimuth, clear, area] =
            ["surfaces.large.tilt", "surfaces.large.azimuth", "panes.outer.transmittance", "large.area"]
                .map(|path| position(&plan, path));
        let mut numbers = Vec::new();
        for member in 0..11 {
            let x = f64::from(member);
            let mut one = values(&plan);
            one[tilt] = 90.0 - 9.0 * x;
            one[azimuth] = 35.0 * x;
            one[clear] = 0.4 + 0.04 * x;
            one[area] = 6.0 - 0.3 * x;
            numbers.extend(one);
        }
        let rows = forcing(&plan, Scheme::Sdirk2, 2 * 96, STEP, weather);
        let mut options = options(Scheme::Sdirk2, STEP, probes());
        options.warmup = Some(warmup(STEP));
        let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
        let watch = Watch::default();
        let together = ensemble(&plan, &numbers, &drive, &options, &watch).unwrap();
        assert!(together.failures.is_empty(), "{:?}", together.failures);
        let row = together.records.len() / 11;
        for (member, numbers) in numbers.chunks(width).enumerate() {
            let alone = march(&plan, numbers, &drive, &options, &watch).unwrap();
            for (i, (a, b)) in alone.records.iter().zip(&together.records[member * row..]).enumerate() {
                assert_eq!(a.to_bits(), b.to_bits(), "{a} is not {b}: member {member}, reading {i}");
            }
            assert!(together.closure[member] < 1e-12);
        }
    }
}

/// Forward derivatives agree with central differences, for every number of glass, frame and sun.
#[test]
fn duals_are_differences_with_windows() {
    for description in rooms() {
        let plan = Plan::new(description).unwrap();
        let numbers = values(&plan);
        let rows = forcing(&plan, Scheme::Sdirk2, 60, STEP, weather);
        let options = options(Scheme::Sdirk2, STEP, probes());
        let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
        let scale = |i: usize| if i % 10 < 5 { 1.0 } else { 0.01 };
        let weight = |i: usize| scale(i) * (1.0 + (0.37 * i as f64).sin());
        let figure = |numbers: &[f64]| -> f64 {
            let records = try_run(&plan, numbers, &rows, &options).unwrap().records;
            records.iter().enumerate().map(|(i, r)| weight(i) * r).sum()
        };
        let mut differ = Vec::new();
        let names = ["panes.", "gap.", "sheet.", "frame.", "large.", "small.", "share", "lost"];
        for (which, parameter) in plan.description.parameters.iter().enumerate() {
            if !names.iter().any(|name| parameter.path.starts_with(name)) {
                continue;
            }
            let variable = |(i, &n)| if i == which { Dual::variable(n, 0) } else { Dual::constant(n) };
            let duals: Vec<Dual<1>> = numbers.iter().enumerate().map(variable).collect();
            let records = march(&plan, &duals, &drive, &options, &Watch::default()).unwrap().records;
            let slope: f64 = records.iter().enumerate().map(|(i, r)| weight(i) * r.slope[0]).sum();
            let step = 1e-5 * numbers[which].abs().max(1e-3);
            let shifted = |sign: f64| {
                let mut numbers = numbers.clone();
                numbers[which] += sign * step;
                figure(&numbers)
            };
            let difference = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
            if (slope - difference).abs() > 1e-4 * difference.abs() + 1e-7 / step {
                differ.push(format!("{}: dual {slope:e}, difference {difference:e}", parameter.path));
            }
        }
        assert!(differ.is_empty(), "{}", differ.join("\n"));
    }
}

/// Numbering the faces of the room another way changes nothing beyond round-off.
#[test]
fn order_of_faces_does_not_matter() {
    for sun in [ZoneSun::Area, ZoneSun::Geometry] {
        let readings = |order| {
            let plan = Plan::new(glazed(sun.clone(), order)).unwrap();
            let rows = forcing(&plan, Scheme::Sdirk2, 96, STEP, weather);
            let probes = vec![
                Probe::AirTemperature { zone: 0 },
                Probe::FaceTemperature { surface: 6, side: 1 },
                Probe::ZoneLostSolar { zone: 0 },
            ];
            run(&plan, &rows, &options(Scheme::Sdirk2, STEP, probes)).records
        };
        let (one, other) = (readings([0, 1, 2, 3, 4, 5]), readings([3, 5, 0, 4, 2, 1]));
        for (i, (a, b)) in one.iter().zip(&other).enumerate() {
            assert!((a - b).abs() < 1e-6 * a.abs().max(1.0), "reading {i}: {a} and {b}");
        }
    }
}

/// A window must lie between outdoors and a zone, and its glazing must be whole.
#[test]
fn what_the_plan_refuses() {
    let whole = || glazed(ZoneSun::Area, [0, 1, 2, 3, 4, 5]);
    let mut d = whole();
    d.surfaces[6].outside = facing(Facing::Adiabatic, None);
    assert!(Plan::new(d).is_err());
    let mut d = whole();
    let glazing = d.constructions.iter_mut().find_map(|one| one.glazing.as_mut()).unwrap();
    let Glazing::Panes { gaps, .. } = glazing else { panic!("the first is of panes") };
    gaps.pop();
    assert!(Plan::new(d).is_err());
    let mut d = whole();
    d.zones[0].sun = ZoneSun::Geometry;
    d.surfaces[0].vertices.clear();
    assert!(Plan::new(d).is_err());
}
