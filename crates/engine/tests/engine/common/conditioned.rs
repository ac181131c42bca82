//! The cell with everything that can act on the air of its zones.

use mascarin_engine::description::{
    AirPath, Description, Gain, IdealLoad, Opening, ParamId, Parameter, SetPoint, Ventilation,
};
use mascarin_engine::run::outputs::Output;

use super::{cell, cell_outputs, cell_weather, set};

/// Adds a parameter.
pub fn number(description: &mut Description, path: &str, value: f64) -> ParamId {
    description.parameters.push(Parameter { path: path.to_owned(), value });
    ParamId(u32::try_from(description.parameters.len() - 1).unwrap())
}

/// Ideal heating or cooling with a constant set point [degC] and a capacity [W].
pub fn ideal_load(description: &mut Description, path: &str, set_point: f64, capacity: f64) -> IdealLoad {
    IdealLoad {
        setpoint: SetPoint::Constant {
            temperature: number(description, &format!("{path}.setpoint"), set_point),
        },
        capacity: Some(number(description, &format!("{path}.capacity"), capacity)),
        radiative: None,
        schedule: None,
    }
}

/// The cell with everything that can act on the air of its zones: channel 1 opens and shuts.
pub fn conditioned(gamma: f64) -> Description {
    let mut d = cell(gamma);
    d.channels.push("fan".to_owned());
    d.zones[0].heating = Some(ideal_load(&mut d, "room.heating", 22.0, 300.0));
    d.zones[0].cooling = Some(ideal_load(&mut d, "room.cooling", 24.0, 80.0));
    d.zones[1].heating = Some(ideal_load(&mut d, "gap.heating", 21.0, 1000.0));
    let gain = Gain {
        name: "people".to_owned(),
        power: number(&mut d, "gain.power", 100.0),
        radiative: number(&mut d, "gain.radiative", 0.6),
        activity: None,
        schedule: Some(1),
    };
    d.zones[0].gains.push(gain);
    let fan = Ventilation {
        name: "fan".to_owned(),
        air_changes: Some(number(&mut d, "fan.air_changes", 2.0)),
        flow: None,
        schedule: Some(1),
        control: None,
        density: None,
    };
    d.zones[0].ventilation.push(fan);
    let path = AirPath {
        name: "hatch".to_owned(),
        between: [1, 0],
        flow: number(&mut d, "hatch.flow", 0.003),
        schedule: None,
        density: None,
        control: None,
    };
    d.air_paths.push(path);
    let opening = Opening {
        name: "slot".to_owned(),
        zone: 1,
        area: number(&mut d, "slot.area", 0.01),
        height: number(&mut d, "slot.height", 0.2),
        discharge: number(&mut d, "slot.discharge", 0.6),
        wind_coefficient: number(&mut d, "slot.wind_coefficient", 0.25),
        schedule: None,
        control: None,
    };
    d.openings.push(opening);
    d
}

/// The weather of the cell, and a schedule in channel 1.
pub fn conditioned_weather(time: f64, row: &mut [f64]) {
    cell_weather(time, row);
    set(row, 1, if (time / 3600.0).rem_euclid(24.0) < 9.0 { 1.0 } else { 0.25 });
}

/// Readings of the cell, and the loads and the air changes of both zones.
pub fn conditioned_outputs() -> Vec<Output> {
    let mut outputs = cell_outputs();
    for zone in 0..2 {
        outputs.push(Output::HeatingLoad { zone });
        outputs.push(Output::CoolingLoad { zone });
        outputs.push(Output::AirChanges { zone });
    }
    outputs
}
