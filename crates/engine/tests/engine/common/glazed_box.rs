//! A box with one double-glazed window.

use mascarin_engine::description::{
    Construction, Description, Exposure, Gap, Gas, Glazing, Pane, PaneOptics, ParamId, ZoneLongwave,
};

use crate::common::Builder;

/// Three light walls and a window of two heavy panes in the shade. The gap holds air, or has a given conductance.
pub fn glazed_box(gas: bool) -> Description {
    let mut b = Builder::new();
    let board = b.solid("board", 0.16, 800.0, 1090.0);
    let wall = b.construction("wall", &[(board, 0.05, 4)]);
    b.zone("zone", 50.0, 0.5, ZoneLongwave::Radiosity);
    for (name, azimuth) in [("north", 0.0), ("east", 90.0), ("south", 180.0), ("window", 180.0)] {
        let (outer, inner) = (b.convection(15.0), b.convection(3.0));
        let (mut outside, mut inside) = (b.outdoors(outer, 0.9, 0.6), b.inside(0, inner, 0.9));
        outside.exposure = Exposure { sun: false, wind: false, sky: false };
        if name == "window" {
            (outside.absorptance, inside.absorptance) = (None, None);
        }
        b.surface(name, wall, [12.0, 90.0, azimuth], outside, inside);
    }
    let mut put = |leaf: &str, value: f64| b.number(&format!("window.{leaf}"), value);
    let pane = |put: &mut dyn FnMut(&str, f64) -> ParamId| Pane {
        thickness: put("thickness", 0.004),
        conductivity: put("conductivity", 1.0),
        storage: Some([put("density", 2500.0), put("specific_heat", 750.0)]),
        emissivity: [put("emissivity", 0.84), put("emissivity", 0.84)],
        optics: Some(PaneOptics {
            transmittance: put("transmittance", 0.8),
            reflectance: [put("reflectance", 0.08), put("reflectance", 0.08)],
            coated: false,
        }),
    };
    let panes = vec![pane(&mut put), pane(&mut put)];
    let gap = if gas {
        let (thickness, pressure) = (put("gap.thickness", 0.016), put("gap.pressure", 101_325.0));
        Gap::Filled { thickness, pressure, gas: Gas::Air }
    } else {
        Gap::Given { conductance: put("gap.conductance", 5.0) }
    };
    let height = put("cavity_height", 1.5);
    let mut d = b.describe();
    let glazing = Some(Glazing::Panes { panes, gaps: vec![gap], angular: None });
    d.constructions.push(Construction {
        name: "window".to_owned(),
        layers: Vec::new(),
        glazing,
        blind: None,
    });
    d.surfaces[3].construction = 1;
    d.surfaces[3].cavity_height = Some(height);
    d
}
