//! A room with windows, a frame and a shade.

use mascarin_engine::description::{
    Construction, Description, FrameShare, Gap, Gas, Glazing, Material, Pane, PaneOptics, ParamId, Side,
    Surface, ZoneLongwave, ZoneSun,
};
use mascarin_engine::run::outputs::Output;

use super::Builder;
use super::conditioned::number;

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
        transmittance: None,
        panes: number(d, "sheet.panes", 2.0),
        category: number(d, "sheet.category", 4.0),
        surface_resistances: [number(d, "sheet.outside_film", 0.04), number(d, "sheet.inside_film", 0.13)],
    }
}

fn side(b: &mut Builder, outdoors: bool) -> Side {
    let convection = b.convection(if outdoors { 15.0 } else { 3.0 });
    if outdoors {
        return b.outdoors(convection, 0.9, 0.6);
    }
    let absorptance = Some(b.number("inside.absorptance", 0.55));
    Side { absorptance, ..b.inside(0, convection, 0.9) }
}

/// The room, its surfaces in an order.
pub fn glazed(sun: ZoneSun, order: [usize; 6]) -> Description {
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
            blind: None,
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
            let surfaces = shares.into_iter().chain([None; 3]).collect();
            ZoneSun::Shares { surfaces, lost: Some(number(d, "lost", 0.04)), diffuse: None }
        },
        |_| ZoneSun::Geometry,
    ]
}

/// One room for each law of where the sun lands.
pub fn glazed_rooms() -> Vec<Description> {
    suns()
        .iter()
        .map(|sun| {
            let mut d = glazed(ZoneSun::Area, [0, 1, 2, 3, 4, 5]);
            d.zones[0].sun = sun(&mut d);
            d
        })
        .collect()
}

/// Readings that see the windows, the frame and the room.
pub fn glazed_outputs() -> Vec<Output> {
    vec![
        Output::AirTemperature { zone: 0 },
        Output::FaceTemperature { surface: 6, side: 0 },
        Output::FaceTemperature { surface: 6, side: 1 },
        Output::FaceTemperature { surface: 8, side: 1 },
        Output::FaceTemperature { surface: 4, side: 1 },
        Output::IncidentSolar { surface: 6 },
        Output::TransmittedSolar { surface: 6 },
        Output::TransmittedSolar { surface: 7 },
        Output::ZoneTransmittedSolar { zone: 0 },
        Output::ZoneLostSolar { zone: 0 },
    ]
}
