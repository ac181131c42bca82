use super::*;
use crate::input::description::{
    Clouds, Convection, Facing, Glazing, Material, ParamId, PcmLaw, Zone, ZoneSun,
};

/// Two zones, an opaque wall with a phase-change layer, a window, a floor on the ground and a partition; every parameter
/// is number 0 to 9.
fn sound() -> Description {
    let text = r#"{
        "parameters": [
            {"path": "p0", "value": 1.0}, {"path": "p1", "value": 2.0}, {"path": "p2", "value": 0.5},
            {"path": "p3", "value": 1.0}, {"path": "p4", "value": 1.0}, {"path": "p5", "value": 1.0},
            {"path": "p6", "value": 1.0}, {"path": "p7", "value": 1.0}, {"path": "p8", "value": 1.0},
            {"path": "p9", "value": 90.0}
        ],
        "site": {
            "altitude": 0, "ground_reflectance": 2, "cloud": [0, 0, 0], "diffuse": "perez",
            "wind": {"mast_height": 0, "mast_exponent": 0, "mast_layer": 0, "exponent": 0, "layer": 0},
            "sky": {"kind": "offset", "depression": 1}
        },
        "materials": [
            {"kind": "solid", "conductivity": 0, "density": 0, "specific_heat": 0},
            {"kind": "resistance", "resistance": 0},
            {"kind": "pcm", "conductivity": [0, 0], "density": [0, 0], "specific_heat": [0, 0], "law":
                {"kind": "tabulated", "temperatures": [10.0, 20.0, 30.0], "points": {"enthalpies": [0.0, 1e3, 9e4]},
                 "melting_range": [12.0, 28.0], "temperature_shift": 0, "enthalpy_scale": 1}}
        ],
        "constructions": [
            {"name": "wall", "layers": [
                {"name": "board", "material": 0, "thickness": 0, "nodes": 2},
                {"name": "gap", "material": 1, "nodes": 0},
                {"name": "pcm", "material": 2, "thickness": 3, "nodes": 3}]},
            {"name": "unit", "glazing": {"kind": "panes",
                "panes": [{"thickness": 0, "conductivity": 0, "emissivity": [2, 2]},
                          {"thickness": 0, "conductivity": 0, "emissivity": [2, 2]}],
                "gaps": [{"kind": "given", "conductance": 1}],
                "angular": {"angles": [0.0, 60.0, 90.0], "transmittance": [0.7, 0.6, 0.0],
                    "absorptance": [[0.1, 0.1, 0.0], [0.1, 0.1, 0.0]],
                    "transmittance_scale": 0, "absorptance_scale": 0}}}
        ],
        "zones": [
            {"name": "south", "volume": 0, "capacity_factor": 0, "longwave": {"kind": "radiosity"},
             "infiltration": {"constant": 0, "temperature": 0, "wind": 0},
             "view_weights": [[0, 1, 1], [1, 0, 1], [1, 1, 0]],
             "gains": [{"name": "people", "power": 1, "radiative": 2, "schedule": 0}],
             "ventilation": [{"name": "fan", "flow": 0}],
             "heating": {"setpoint": {"kind": "scheduled", "channel": 0}}},
            {"name": "north", "volume": 0, "capacity_factor": 0, "longwave": {"kind": "none"},
             "infiltration": {"constant": 0, "temperature": 0, "wind": 0}}
        ],
        "air_paths": [{"name": "door", "between": [0, 1], "flow": 0}],
        "openings": [{"name": "slot", "zone": 0, "area": 0, "height": 0, "discharge": 0, "wind_coefficient": 0}],
        "surfaces": [
            {"name": "facade", "construction": 0, "area": 1, "tilt": 9, "azimuth": 9,
             "vertices": [[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]],
             "outside": {"facing": {"kind": "outdoors"}, "emissivity": 2, "absorptance": 2, "irradiance": 0,
                "convection": {"kind": "tarp", "factor": 0, "roughness": 0, "perimeter": 0}},
             "inside": {"facing": {"kind": "zone", "zone": 0}, "emissivity": 2,
                "convection": {"kind": "constant", "coefficient": 0}}},
            {"name": "window", "construction": 1, "area": 1, "tilt": 9, "azimuth": 9,
             "outside": {"facing": {"kind": "outdoors"}, "emissivity": 2,
                "convection": {"kind": "mowitt", "factor": 0}},
             "inside": {"facing": {"kind": "zone", "zone": 0}, "emissivity": 2,
                "convection": {"kind": "constant", "coefficient": 0}}},
            {"name": "partition", "construction": 0, "area": 1, "tilt": 9, "azimuth": 9,
             "outside": {"facing": {"kind": "zone", "zone": 1},
                "convection": {"kind": "alamdari_hammond", "length": 0, "factor": 0}},
             "inside": {"facing": {"kind": "zone", "zone": 0}, "emissivity": 2,
                "convection": {"kind": "constant", "coefficient": 0}}},
            {"name": "floor", "construction": 0, "area": 1, "tilt": 9, "azimuth": 9,
             "outside": {"facing": {"kind": "imposed",
                "law": {"kind": "ground", "mean": 0, "amplitude": 0, "coldest_day": 0}}},
             "inside": {"facing": {"kind": "zone", "zone": 1},
                "convection": {"kind": "constant", "coefficient": 0}}}
        ],
        "sensors": [{"name": "probe", "surface": 0, "depth": 0}],
        "shades": [[[0, -1, 3], [4, -1, 3], [4, 0, 3], [0, 0, 3]]],
        "channels": ["always"]
    }"#;
    serde_json::from_str(text).unwrap()
}

/// A fault is refused with a message that says all of this.
#[track_caller]
fn refused(fault: impl FnOnce(&mut Description), says: &[&str]) {
    let mut description = sound();
    fault(&mut description);
    let message = match check(&description) {
        Err(error) => error.to_string(),
        Ok(()) => panic!("accepted, expected a refusal that says {says:?}"),
    };
    for part in says {
        assert!(message.contains(part), "\"{message}\" does not say \"{part}\"");
    }
}

#[test]
fn a_sound_description_is_accepted() {
    check(&sound()).unwrap();
}

#[test]
fn every_parameter_id_is_checked() {
    refused(|d| d.site.wind.layer.0 = 10, &["site.wind.layer", "parameter 10", "below 10"]);
    refused(
        |d| d.site.cloud = Clouds::Factor([ParamId(0), ParamId(0), ParamId(u32::MAX)]),
        &["site.cloud[2]"],
    );
    refused(
        |d| d.site.cloud = Clouds::Layer { emissivity: ParamId(0), base: ParamId(u32::MAX) },
        &["site.cloud.base"],
    );
    refused(
        |d| {
            if let Material::Pcm { law: PcmLaw::Tabulated { enthalpy_scale, .. }, .. } = &mut d.materials[2] {
                enthalpy_scale.0 = 77;
            }
        },
        &["materials[2].law.enthalpy_scale", "parameter 77"],
    );
    refused(
        |d| d.constructions[0].layers[2].thickness.as_mut().unwrap().0 = 77,
        &["constructions[0].layers[2].thickness"],
    );
    refused(
        |d| {
            if let Some(Glazing::Panes { panes, .. }) = &mut d.constructions[1].glazing {
                panes[1].emissivity[0].0 = 77;
            }
        },
        &["constructions[1].glazing.panes[1].emissivity[0]"],
    );
    refused(|d| d.zones[0].gains[0].radiative.0 = 77, &["zones[0].gains[0].radiative"]);
    refused(|d| d.air_paths[0].flow.0 = 77, &["air_paths[0].flow"]);
    refused(|d| d.openings[0].wind_coefficient.0 = 77, &["openings[0].wind_coefficient"]);
    refused(
        |d| {
            if let Some(Convection::Law(law)) = &mut d.surfaces[0].outside.convection {
                law.numbers[1].1.0 = 77;
            }
        },
        &["surfaces[0].outside.convection.perimeter"],
    );
    refused(
        |d| {
            if let Facing::Imposed { law } = &mut d.surfaces[3].outside.facing {
                law.numbers[1].1.0 = 77;
            }
        },
        &["surfaces[3].outside.facing.law.coldest_day"],
    );
    refused(|d| d.sensors[0].depth.0 = 77, &["sensors[0].depth"]);
}

/// The walk meets as many ids as the description has: those of the site alone are 11.
#[test]
fn the_walk_meets_all_parameter_ids() {
    let mut places = Vec::new();
    Walk::over(&sound(), |place, _| places.push(place.to_owned()));
    let below = |start: &str| places.iter().filter(|place| place.starts_with(start)).count();
    assert_eq!(
        ["site", "materials", "constructions", "zones", "air_paths", "openings", "surfaces", "sensors"]
            .map(below),
        [11, 12, 13, 13, 1, 4, 31, 1]
    );
    assert_eq!(places.len(), 86);
    let distinct: std::collections::BTreeSet<_> = places.iter().collect();
    assert_eq!(distinct.len(), places.len());
}

#[test]
fn nominal_values_are_finite() {
    refused(|d| d.parameters[3].value = f64::NAN, &["parameter p3", "NaN", "finite"]);
    refused(|d| d.parameters[3].value = f64::INFINITY, &["parameter p3", "inf"]);
}

#[test]
fn view_weights_have_a_row_and_a_column_for_each_surface() {
    let weights = |weights: Vec<Vec<f64>>| move |d: &mut Description| d.zones[0].view_weights = weights;
    refused(
        weights(vec![vec![0.0, 1.0], vec![1.0, 0.0]]),
        &["zone south, view weights", "2 values", "3: rows", "surfaces"],
    );
    refused(
        weights(vec![vec![1.0; 3], vec![1.0; 2], vec![1.0; 3]]),
        &["zone south", "2 values", "3: columns"],
    );
    refused(weights(vec![vec![f64::NAN; 3]; 3]), &["NaN"]);
    refused(weights(vec![vec![-1.0; 3]; 3]), &["-1", "at least zero"]);
}

#[test]
fn references_have_a_target() {
    refused(|d| d.sensors[0].surface = 4, &["sensor probe", "surface 4", "below 4"]);
    refused(|d| d.openings[0].zone = 2, &["opening slot", "zone 2", "below 2"]);
    refused(|d| d.air_paths[0].between = [0, 2], &["air path door", "zone 2"]);
    refused(|d| d.air_paths[0].between = [1, 1], &["air path door", "zone 1 twice"]);
    refused(|d| d.surfaces[0].construction = 2, &["surface facade", "construction 2"]);
    refused(
        |d| d.surfaces[0].inside.facing = Facing::Zone { zone: 2 },
        &["surface facade, inside", "zone 2"],
    );
    refused(|d| d.surfaces[0].outside.irradiance = Some(1), &["surface facade, outside", "channel 1"]);
    refused(|d| d.constructions[0].layers[0].material = 3, &["layer board", "material 3"]);
    refused(|d| d.zones[0].gains[0].schedule = Some(1), &["zone south, gain people", "channel 1"]);
    refused(|d| d.channels.clear(), &["channel 0", "below 0"]);
}

#[test]
fn parts_that_need_each_other_come_together() {
    refused(|d| d.surfaces[0].outside.emissivity = None, &["facade, outside", "convection and emissivity"]);
    refused(|d| d.surfaces[0].outside.absorptance = None, &["facade, outside", "absorptance"]);
    refused(|d| d.surfaces[2].inside.convection = None, &["partition, inside", "convection"]);
    refused(|d| d.surfaces[1].outside.facing = Facing::Adiabatic, &["window", "between outdoors"]);
    refused(|d| d.zones[0].ventilation[0].flow = None, &["ventilation fan", "either air changes or a flow"]);
    refused(|d| d.zones[0].makeup_by_vents = true, &["zone south", "make-up air by vents", "lead from it"]);
    refused(|d| d.constructions[0].layers.clear(), &["construction wall", "neither"]);
    refused(|d| d.constructions[0].layers[0].nodes = 0, &["layer board", "at least one node"]);
    refused(|d| d.constructions[0].layers[1].nodes = 1, &["layer gap", "without nodes"]);
    refused(
        |d| d.zones[0].sun = ZoneSun::Shares { surfaces: vec![None; 2], lost: None, diffuse: None },
        &["zone south, sun", "2 values", "expected 3"],
    );
    refused(|d| d.zones[0].sun = ZoneSun::Geometry, &["zone south, sun", "surface window without vertices"]);
}

#[test]
fn corners_enclose_an_area() {
    let line = vec![[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]];
    refused(|d| d.shades[0] = line, &["shade 0", "on one line"]);
    refused(|d| d.shades[0].truncate(2), &["shade 0", "2 corners", "at least three"]);
    refused(|d| d.surfaces[0].vertices.truncate(1), &["surface facade", "1 corners"]);
    refused(|d| d.surfaces[0].vertices[2][1] = f64::NAN, &["surface facade", "NaN", "finite"]);
}

#[test]
fn tables_are_whole() {
    let table = |fault: fn(&mut Vec<f64>, &mut [f64; 2])| {
        move |d: &mut Description| {
            if let Material::Pcm { law: PcmLaw::Tabulated { temperatures, melting_range, .. }, .. } =
                &mut d.materials[2]
            {
                fault(temperatures, melting_range);
            }
        }
    };
    refused(table(|t, _| t[1] = 30.0), &["temperatures", "30 after 30", "rising"]);
    refused(table(|t, _| t.push(40.0)), &["enthalpies", "3 values", "expected 4"]);
    refused(table(|_, range| range.reverse()), &["melting range", "12 after 28"]);
    let angular = |fault: fn(&mut crate::input::description::Angular)| {
        move |d: &mut Description| {
            if let Some(Glazing::Panes { angular: Some(table), .. }) = &mut d.constructions[1].glazing {
                fault(table);
            }
        }
    };
    refused(angular(|table| table.angles[2] = 80.0), &["construction unit", "0 to 80 deg", "0 to 90 deg"]);
    refused(angular(|table| table.transmittance[1] = f64::NAN), &["transmittance", "NaN", "0 to 1"]);
    refused(angular(|table| table.transmittance[1] = -0.1), &["transmittance", "-0.1"]);
    refused(angular(|table| table.absorptance.truncate(1)), &["absorptance", "1 values", "expected 2"]);
    refused(
        |d| {
            if let Some(Glazing::Panes { gaps, .. }) = &mut d.constructions[1].glazing {
                gaps.clear();
            }
        },
        &["construction unit", "2 panes and 0 gaps"],
    );
}

/// A zone without surfaces takes no view weights.
#[test]
fn a_zone_without_surfaces_has_no_view_weights() {
    let empty = |d: &mut Description| {
        let zone: Zone = d.zones[0].clone();
        d.zones.push(zone);
    };
    refused(empty, &["3 values", "expected 0"]);
}
