//! The vapour balance of the zones.

use super::numbers::{check_count, check_rising};
use super::{Checked, check_index, check_schedule, refuse};
use crate::input::description::{
    Buffer, Description, Drying, Facing, Humidity, HumidityControl, HumiditySetPoint, Sorption,
};

/// Zones, sources, set points, surfaces that take up vapour.
pub(super) fn check_humidity(description: &Description, humidity: &Humidity) -> Checked {
    let zones = description.zones.len();
    check_count("humidity, zones", humidity.zones.len(), zones, "the number of zones")?;
    for (zone, definition) in humidity.zones.iter().zip(&description.zones) {
        let place = format!("humidity, zone {}", definition.name);
        for gain in &zone.gains {
            let place = format!("{place}, gain {}", gain.name);
            if gain.power.is_some() == gain.rate.is_some() {
                return refuse(place, "both or none of them", "either a power or a rate");
            }
            check_schedule(description, &place, gain.schedule)?;
        }
        if let Some(Drying::Controlled { control }) = &zone.drying {
            check_control(description, &place, control)?;
        }
        if let Some(control) = &zone.humidifying {
            check_control(description, &place, control)?;
        }
    }
    for buffer in &humidity.buffers {
        check_buffer(description, buffer)?;
    }
    if humidity.recoveries.is_empty() {
        return Ok(());
    }
    let units = description.ventilation_units.len();
    check_count("humidity, recoveries", humidity.recoveries.len(), units, "the number of ventilation units")
}

fn check_control(description: &Description, place: &str, control: &HumidityControl) -> Checked {
    let (HumiditySetPoint::RelativeScheduled { channel } | HumiditySetPoint::RatioScheduled { channel }) =
        control.setpoint
    else {
        return check_schedule(description, place, control.schedule);
    };
    check_schedule(description, place, Some(channel))?;
    check_schedule(description, place, control.schedule)
}

/// At a surface with convection in a zone, with contents that rise.
fn check_buffer(description: &Description, buffer: &Buffer) -> Checked {
    check_index("humidity, buffers", "surface", buffer.surface, description.surfaces.len())?;
    let wall = &description.surfaces[buffer.surface];
    let place = format!("humidity, surface {}", wall.name);
    check_index(&place, "side", buffer.side, 2)?;
    let side = if buffer.side == 0 { &wall.outside } else { &wall.inside };
    if !matches!(side.facing, Facing::Zone { .. }) || side.convection.is_none() {
        return refuse(place, "a side that no air of a zone flows along", "a side in a zone");
    }
    let Sorption::Table { humidities, contents, .. } = &buffer.sorption else { return Ok(()) };
    check_count(&place, contents.len(), humidities.len(), "contents, the number of humidities")?;
    check_rising(&format!("{place}, humidities"), humidities)?;
    check_rising(&format!("{place}, contents"), contents)
}
