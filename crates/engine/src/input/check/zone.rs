//! Zones, the air between them, and openings.

use super::numbers::{check_count, check_not_negative};
use super::{Checked, check_index, check_schedule, refuse};
use crate::input::description::{
    AirPath, Description, Facing, IdealLoad, Opening, SetPoint, Side, Surface, Zone, ZoneSun,
};

/// Schedules, flows, loads, view weights and the distribution of the sun.
pub(super) fn check_zone(description: &Description, index: usize, zone: &Zone) -> Checked {
    let place = format!("zone {}", zone.name);
    for gain in &zone.gains {
        check_schedule(description, format_args!("{place}, gain {}", gain.name), gain.schedule)?;
    }
    for flow in &zone.ventilation {
        let place = format!("{place}, ventilation {}", flow.name);
        if flow.air_changes.is_some() == flow.flow.is_some() {
            return refuse(place, "both or none of them", "either air changes or a flow");
        }
        check_schedule(description, &place, flow.schedule)?;
        check_control(description, &place, flow.control)?;
    }
    let leaks = format!("{place}, infiltration");
    check_schedule(description, &leaks, zone.infiltration.schedule)?;
    check_control(description, &leaks, zone.infiltration.control)?;
    if let Some(mixing) = &zone.mixing {
        check_schedule(description, format_args!("{place}, mixing"), mixing.schedule)?;
    }
    for load in [&zone.heating, &zone.cooling].into_iter().flatten() {
        check_load(description, &place, load)?;
    }
    let surfaces = description.surfaces.iter().flat_map(sides).filter(|side| in_zone(side, index)).count();
    check_view_weights(&place, zone, surfaces)?;
    check_sun(description, index, zone, surfaces)
}

fn sides(wall: &Surface) -> [&Side; 2] {
    [&wall.outside, &wall.inside]
}

fn in_zone(side: &Side, zone: usize) -> bool {
    side.facing == Facing::Zone { zone }
}

fn check_load(description: &Description, place: &str, load: &IdealLoad) -> Checked {
    check_schedule(description, format_args!("{place}, heating or cooling"), load.schedule)?;
    match load.setpoint {
        SetPoint::Scheduled { channel } => {
            check_schedule(description, format_args!("{place}, set point"), Some(channel))
        }
        SetPoint::Constant { .. } => Ok(()),
    }
}

/// None, or a square of the zone's surfaces.
fn check_view_weights(place: &str, zone: &Zone, surfaces: usize) -> Checked {
    if zone.view_weights.is_empty() {
        return Ok(());
    }
    let place = format!("{place}, view weights");
    let why = "the number of the zone's surfaces";
    check_count(&place, zone.view_weights.len(), surfaces, format_args!("rows, {why}"))?;
    for row in &zone.view_weights {
        check_count(&place, row.len(), surfaces, format_args!("columns, {why}"))?;
        check_not_negative(&place, row)?;
    }
    Ok(())
}

fn check_sun(description: &Description, index: usize, zone: &Zone, surfaces: usize) -> Checked {
    let place = format!("zone {}, sun", zone.name);
    match &zone.sun {
        ZoneSun::Area => Ok(()),
        ZoneSun::Shares { surfaces: given, diffuse, .. } => {
            let why = "one share for each of the zone's surfaces";
            check_count(&place, given.len(), surfaces, why)?;
            diffuse.as_ref().map_or(Ok(()), |diffuse| {
                check_count(&format!("{place}, diffuse"), diffuse.faces.len(), surfaces, why)
            })
        }
        ZoneSun::Floor { floor } => {
            check_count(&place, floor.len(), surfaces, "one flag for each of the zone's surfaces")?;
            if floor.contains(&true) { Ok(()) } else { refuse(place, "no floor", "at least one") }
        }
        ZoneSun::Geometry => {
            let drawn = |wall: &Surface| {
                wall.vertices.len() > 2 || wall.frame.as_ref().is_some_and(|frame| frame.is_frame)
            };
            let mut walls = description.surfaces.iter();
            match walls.find(|wall| sides(wall).iter().any(|side| in_zone(side, index)) && !drawn(wall)) {
                Some(wall) => refuse(
                    place,
                    format_args!("surface {} without vertices", wall.name),
                    "vertices of every surface where the sun is distributed by geometry",
                ),
                None => Ok(()),
            }
        }
    }
}

/// Between two different zones.
pub(super) fn check_air_path(description: &Description, path: &AirPath) -> Checked {
    let place = format!("air path {}", path.name);
    for zone in path.between {
        check_index(&place, "zone", zone, description.zones.len())?;
    }
    if path.between[0] == path.between[1] {
        return refuse(place, format_args!("zone {} twice", path.between[0]), "two zones");
    }
    check_schedule(description, &place, path.schedule)?;
    check_control(description, &place, path.control)
}

/// In a zone.
pub(super) fn check_opening(description: &Description, opening: &Opening) -> Checked {
    let place = format!("opening {}", opening.name);
    check_index(&place, "zone", opening.zone, description.zones.len())?;
    check_control(description, &place, opening.control)?;
    check_schedule(description, &place, opening.schedule)
}

/// A control of the building.
fn check_control(description: &Description, place: &str, control: Option<usize>) -> Checked {
    control.map_or(Ok(()), |control| check_index(place, "control", control, description.controls.len()))
}
