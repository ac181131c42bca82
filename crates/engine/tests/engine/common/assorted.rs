//! Buildings with the laws and options that the other samples leave out.

use mascarin_engine::description::{
    Angular, Convection, Description, Exposure, Facing, Gap, Gas, Glazing, OutdoorLongwave, PublishedLaw,
    SetPoint, Sky, ZoneSun,
};
use mascarin_engine::forcing::channel;
use mascarin_engine::number::Real;

use super::conditioned::{conditioned, conditioned_weather, number};
use super::glazed::glazed;
use super::set;

/// The conditioned cell with other laws outdoors, set points and openings that follow channels, and other boundaries.
/// `sky`: 0 to 3, measured, Clark & Allen, Brunt or an offset.
pub fn assorted_cell(sky: usize) -> Description {
    let mut d = conditioned(0.04);
    d.channels.extend(["irradiance", "set_point"].map(str::to_owned));
    let (kind, numbers, diffuse): (&str, &[(&str, f64)], &str) = match sky {
        0 => ("measured", &[("scale", 0.97)], "isotropic"),
        1 => ("clark_allen", &[("a", 0.787), ("b", 0.764)], "hay_davies"),
        2 => ("brunt", &[("a", 0.51), ("b", 0.066)], "perez"),
        _ => ("offset", &[("depression", 11.0)], "hay_davies"),
    };
    let mut put =
        |&(name, value): &(&'static str, f64)| (name, number(&mut d, &format!("sky.{name}"), value));
    let numbers: Vec<_> = numbers.iter().map(&mut put).collect();
    d.site.sky = Sky::Law(PublishedLaw::new(kind, &numbers));
    diffuse.clone_into(&mut d.site.diffuse);
    d.site.air_density = Some(number(&mut d, "site.air_density", 1.18));

    let doe2 = Convection::law(
        "doe2",
        &[
            ("factor", number(&mut d, "doe2.factor", 1.0)),
            ("roughness", number(&mut d, "doe2.roughness", 1.67)),
        ],
    );
    let (sky_view, height) = (number(&mut d, "north.sky_view", 0.35), number(&mut d, "north.height", 2.5));
    let north = &mut d.surfaces[0].outside;
    (north.convection, north.sky_view, north.height) = (Some(doe2), Some(sky_view), Some(height));
    let reference = number(&mut d, "east.reference", 24.0);
    d.surfaces[1].outside.longwave = OutdoorLongwave::Linearised { reference };
    let south = &mut d.surfaces[2].outside;
    south.irradiance = Some(2);
    south.exposure = Exposure { sun: true, wind: false, sky: false };
    d.surfaces[3].outside.longwave = OutdoorLongwave::None;
    d.surfaces[4].outside.facing = {
        let numbers = [
            ("mean", number(&mut d, "ground.mean", 21.0)),
            ("amplitude", number(&mut d, "ground.amplitude", 3.0)),
            ("coldest_day", number(&mut d, "ground.coldest_day", 30.0)),
        ];
        Facing::imposed("ground", &numbers)
    };

    d.zones[0].infiltration.temperature = number(&mut d, "room.infiltration.temperature", 0.02);
    d.zones[0].infiltration.wind = number(&mut d, "room.infiltration.wind", 0.03);
    d.zones[0].view_weights = vec![
        vec![0.0, 1.0, 0.8, 0.3, 1.2, 1.5],
        vec![1.0, 0.0, 1.1, 0.2, 1.3, 1.4],
        vec![0.8, 1.1, 0.0, 0.0, 0.9, 1.0],
        vec![0.3, 0.2, 0.0, 0.0, 0.4, 0.3],
        vec![1.2, 1.3, 0.9, 0.4, 0.0, 2.0],
        vec![1.5, 1.4, 1.0, 0.3, 2.0, 0.0],
    ];
    let heating = d.zones[0].heating.as_mut().unwrap();
    (heating.setpoint, heating.capacity) = (SetPoint::Scheduled { channel: 3 }, None);
    d.zones[0].cooling.as_mut().unwrap().schedule = Some(1);
    d.air_paths[0].schedule = Some(1);
    d.openings[0].schedule = Some(1);
    d
}

/// Infrared of the sky, pressure, irradiance and set point, on top of the weather of the conditioned cell.
pub fn assorted_weather(time: f64, row: &mut [f64]) {
    conditioned_weather(time, row);
    let day = time / 86400.0;
    row[channel::INFRARED] = 380.0 + 25.0 * Real::sin(5.0 * day);
    row[channel::PRESSURE] = 100_800.0 + 300.0 * Real::cos(1.3 * day);
    set(row, 2, (600.0 * Real::sin(6.3 * day)).max(0.0));
    set(row, 3, if day.fract() < 0.3 { 19.0 } else { 21.5 });
}

/// The glazed room with other gases between the panes, ISO 15099 at the glass inside, and optics of the whole triple unit
/// as a table.
pub fn assorted_windows() -> Description {
    let mut d = glazed(ZoneSun::Geometry, [0, 1, 2, 3, 4, 5]);
    let length = number(&mut d, "iso.length", 2.0);
    let factor = number(&mut d, "iso.factor", 1.0);
    for window in [6, 7] {
        d.surfaces[window].inside.convection =
            Some(Convection::law("iso15099", &[("length", length), ("factor", factor)]));
    }
    let krypton = Gap::Filled {
        thickness: number(&mut d, "krypton.thickness", 0.01),
        pressure: number(&mut d, "krypton.pressure", 101_325.0),
        gas: Gas::Krypton,
    };
    let air = Gap::Filled {
        thickness: number(&mut d, "air.thickness", 0.016),
        pressure: number(&mut d, "air.pressure", 98_000.0),
        gas: Gas::Air,
    };
    let table = Angular {
        angles: vec![0.0, 30.0, 50.0, 70.0, 90.0],
        transmittance: vec![0.45, 0.44, 0.40, 0.25, 0.0],
        absorptance: vec![
            vec![0.12, 0.12, 0.13, 0.14, 0.0],
            vec![0.06, 0.06, 0.06, 0.05, 0.0],
            vec![0.10, 0.10, 0.11, 0.08, 0.0],
        ],
        diffuse_transmittance: Some(0.36),
        diffuse_absorptance: None,
        back_transmittance: None,
        back_absorptance: None,
        transmittance_scale: number(&mut d, "table.transmittance_scale", 0.98),
        absorptance_scale: number(&mut d, "table.absorptance_scale", 1.02),
    };
    let glazing = d.constructions.iter_mut().find_map(|one| one.glazing.as_mut()).unwrap();
    if let Glazing::Panes { gaps, angular, .. } = glazing {
        (*gaps, *angular) = (vec![krypton, air], Some(table));
    }
    d
}
