//! Doors, flows that fans drive, and thermal bridges.

use super::numbers::check_finite;
use super::{Checked, check_index, check_schedule, refuse};
use crate::input::description::{
    Description, Door, Facing, SetPoint, ThermalBridge, Vent, VentControl, VentilationUnit, WindPressure,
};

/// All of them.
pub(super) fn check_air(description: &Description) -> Checked {
    for door in &description.doors {
        check_door(description, door)?;
    }
    for flow in &description.directed_flows {
        let place = format!("air path {}", flow.name);
        check_ends(description, &place, [flow.from, flow.to])?;
        check_schedule(description, &place, flow.schedule)?;
    }
    for unit in &description.ventilation_units {
        check_unit(description, unit)?;
    }
    for bridge in &description.thermal_bridges {
        check_bridge(description, bridge)?;
    }
    for vent in &description.vents {
        check_vent(description, vent)?;
    }
    for control in &description.controls {
        check_control(description, control)?;
    }
    check_makeup(description)?;
    for (index, zone) in description.zones.iter().enumerate() {
        if zone.solar_to_air.is_some() && window_between_zones(description, index) {
            return refuse(
                format_args!("zone {}, solar_to_air", zone.name),
                "a window to another zone",
                "windows to outdoors only",
            );
        }
    }
    Ok(())
}

/// Two different zones.
fn check_ends(description: &Description, place: &str, ends: [usize; 2]) -> Checked {
    for zone in ends {
        check_index(place, "zone", zone, description.zones.len())?;
    }
    if ends[0] == ends[1] {
        return refuse(place, format_args!("zone {} twice", ends[0]), "two zones");
    }
    Ok(())
}

fn check_door(description: &Description, door: &Door) -> Checked {
    let place = format!("door {}", door.name);
    check_ends(description, &place, door.between)?;
    check_schedule(description, &place, door.schedule)?;
    let controls = description.controls.len();
    door.control.map_or(Ok(()), |control| check_index(&place, "control", control, controls))
}

fn check_unit(description: &Description, unit: &VentilationUnit) -> Checked {
    let place = format!("ventilation unit {}", unit.name);
    for flow in unit.supply.iter().chain(&unit.exhaust) {
        check_index(&place, "zone", flow.zone, description.zones.len())?;
        check_schedule(description, &place, flow.schedule)?;
    }
    if let Some(SetPoint::Scheduled { channel }) = unit.temperature {
        check_schedule(description, &place, Some(channel))?;
    }
    if unit.temperature.is_some() && unit.recovery.is_some() {
        return refuse(place, "both", "a temperature of the supplied air or heat recovery");
    }
    Ok(())
}

fn check_vent(description: &Description, vent: &Vent) -> Checked {
    let place = format!("vent {}", vent.name);
    match vent.to {
        Some(to) => check_ends(description, &place, [vent.zone, to])?,
        None => check_index(&place, "zone", vent.zone, description.zones.len())?,
    }
    check_schedule(description, &place, vent.schedule)?;
    if let Some(control) = vent.control {
        check_index(&place, "control", control, description.controls.len())?;
    }
    match vent.wind.as_ref().map(|wind| &wind.pressure) {
        Some(_) if vent.to.is_some() => refuse(place, "wind between two zones", "wind on vents to outdoors"),
        Some(WindPressure::Table { coefficients }) if coefficients.is_empty() => {
            refuse(place, "no coefficients", "at least one")
        }
        Some(WindPressure::Table { coefficients }) => check_finite(&place, coefficients),
        Some(WindPressure::LowRise { .. }) | None => Ok(()),
    }
}

/// Vents join a zone with outdoors that they bring make-up air into.
fn check_makeup(description: &Description) -> Checked {
    let mut joined = vec![false; description.zones.len()];
    for _ in 0..joined.len() {
        for vent in &description.vents {
            match vent.to {
                None => joined[vent.zone] = true,
                Some(to) => {
                    let either = joined[vent.zone] || joined[to];
                    (joined[vent.zone], joined[to]) = (either, either);
                }
            }
        }
    }
    let lacks = description.zones.iter().zip(joined).find(|(zone, joined)| zone.makeup_by_vents && !joined);
    lacks.map_or(Ok(()), |(zone, _)| {
        refuse(format_args!("zone {}", zone.name), "make-up air by vents", "vents that lead from it outdoors")
    })
}

fn check_control(description: &Description, control: &VentControl) -> Checked {
    let place = format!("control {}", control.name);
    check_index(&place, "zone", control.zone, description.zones.len())?;
    if let Some(reference) = control.reference_zone {
        check_ends(description, &place, [control.zone, reference])?;
    }
    check_schedule(description, &place, control.rain.as_ref().map(|rain| rain.channel))
}

fn check_bridge(description: &Description, bridge: &ThermalBridge) -> Checked {
    let place = format!("thermal bridge {}", bridge.name);
    check_index(&place, "zone", bridge.zone, description.zones.len())?;
    match bridge.to {
        Facing::Zone { zone } => check_ends(description, &place, [bridge.zone, zone]),
        Facing::Measured { channel } => check_schedule(description, &place, Some(channel)),
        Facing::Adiabatic => refuse(place, "adiabatic", "outdoors, a zone or a temperature"),
        Facing::Outdoors | Facing::Imposed { .. } => Ok(()),
    }
}

/// Whether sun passes from a zone to another one.
fn window_between_zones(description: &Description, zone: usize) -> bool {
    let of = |facing: &Facing| match facing {
        Facing::Zone { zone } => Some(*zone),
        _ => None,
    };
    description.surfaces.iter().any(|wall| {
        let ends = [of(&wall.outside.facing), of(&wall.inside.facing)];
        let glazed = description.constructions.get(wall.construction).is_some_and(|c| c.glazing.is_some());
        glazed && ends.iter().all(Option::is_some) && ends.contains(&Some(zone))
    })
}
