//! Cells whose laws of convection and radiation are linear.

use mascarin_engine::description::{
    AirPath, Convection, Description, Facing, Gain, Material, OutdoorLongwave, ParamId, Parameter,
    Ventilation, ZoneLongwave,
};

use super::conditioned::number;
use super::{cell, law};

/// The cell with constant heat transfer coefficients inside, coefficients linear in the wind outside and linearised
/// radiation: only its ceiling, which melts, is nonlinear. With `as_power` one constant coefficient is written as a power of
/// the temperature difference with the factor 0.
pub fn cell_of_linear_laws(as_power: bool) -> Description {
    let mut description = cell(0.04);
    let mut number = |value: f64| {
        let path = format!("linear_laws.{}", description.parameters.len());
        description.parameters.push(Parameter { path, value });
        ParamId(u32::try_from(description.parameters.len() - 1).unwrap())
    };
    for (index, surface) in description.surfaces.iter_mut().enumerate() {
        for side in [&mut surface.outside, &mut surface.inside] {
            side.longwave = OutdoorLongwave::Linearised { reference: number(25.0) };
            side.convection = match side.facing {
                Facing::Zone { .. } if as_power && index == 1 => {
                    let [a, b, n, c, m] = [3.0, 0.0, 0.5, 0.0, 1.0].map(&mut number);
                    let numbers = ["upward", "downward"].map(|direction| {
                        [("a", a), ("b", b), ("n", n), ("c", c), ("m", m)]
                            .map(|(name, id)| (format!("{direction}.{name}"), id))
                    });
                    Some(law("power", numbers.as_flattened()))
                }
                Facing::Zone { .. } => Some(Convection::law("constant", &[("coefficient", number(3.0))])),
                Facing::Outdoors => {
                    Some(Convection::law("linear_wind", &[("constant", number(11.4)), ("wind", number(5.7))]))
                }
                _ => side.convection.take(),
            };
        }
    }
    for zone in &mut description.zones {
        zone.longwave = ZoneLongwave::Linearised { reference: number(27.0) };
    }
    description
}

/// The cell of linear laws with a solid in the place of what melts and constant coefficients outside, with a gain,
/// ventilation and an air path that never change: all of it is linear and constant.
pub fn linear_cell() -> Description {
    let mut d = cell_of_linear_laws(false);
    for index in 0..d.materials.len() {
        if matches!(d.materials[index], Material::Pcm { .. }) {
            d.materials[index] = Material::Solid {
                conductivity: number(&mut d, "linear.conductivity", 0.2),
                density: number(&mut d, "linear.density", 855.0),
                specific_heat: number(&mut d, "linear.specific_heat", 3000.0),
            };
        }
    }
    let coefficient = number(&mut d, "linear.coefficient", 18.0);
    for surface in &mut d.surfaces {
        if surface.outside.facing == Facing::Outdoors {
            surface.outside.convection = Some(Convection::law("constant", &[("coefficient", coefficient)]));
        }
    }
    let gain = Gain {
        name: "lamp".to_owned(),
        power: number(&mut d, "lamp.power", 40.0),
        radiative: number(&mut d, "lamp.radiative", 0.5),
        activity: None,
        schedule: None,
    };
    d.zones[0].gains.push(gain);
    let fan = Ventilation {
        name: "fan".to_owned(),
        air_changes: None,
        flow: Some(number(&mut d, "fan.flow", 0.004)),
        schedule: None,
        control: None,
        density: None,
    };
    d.zones[1].ventilation.push(fan);
    let flow = number(&mut d, "hatch.flow", 0.003);
    d.air_paths.push(AirPath {
        name: "hatch".to_owned(),
        between: [0, 1],
        flow,
        schedule: None,
        density: None,
        control: None,
    });
    d
}
