//! Walls, windows and their sides.

use super::numbers::check_polygon;
use super::{Checked, check_index, check_schedule, refuse};
use crate::input::description::{
    Convection, Description, Facing, HeatSource, HeatingMeans, OutdoorLongwave, SetPoint, Side, Soil,
    Surface, ZoneLongwave,
};

/// References of a heat source, and a plane between two layers.
pub(super) fn check_heat_source(description: &Description, source: &HeatSource) -> Checked {
    let place = format!("heat source {}", source.name);
    check_index(&place, "surface", source.surface, description.surfaces.len())?;
    let wall = &description.surfaces[source.surface];
    let layers = description.constructions[wall.construction].layers.len();
    if source.layer + 1 >= layers {
        return refuse(place, format_args!("layer {}", source.layer), "a layer with another one behind it");
    }
    let channels = description.channels.len();
    let check_temperature = |temperature: &SetPoint| match temperature {
        SetPoint::Scheduled { channel } => check_index(&place, "channel", *channel, channels),
        SetPoint::Constant { .. } => Ok(()),
    };
    match &source.means {
        HeatingMeans::Electric { schedule, .. } => check_schedule(description, &place, *schedule)?,
        HeatingMeans::Water { schedule, supply, .. } => {
            check_schedule(description, &place, *schedule)?;
            check_temperature(supply)?;
        }
    }
    if let Some(thermostat) = &source.thermostat {
        check_index(&place, "zone", thermostat.zone, description.zones.len())?;
        check_temperature(&thermostat.setpoint)?;
    }
    source
        .control
        .map_or(Ok(()), |control| check_index(&place, "control", control, description.controls.len()))
}

/// References, corners and both sides of a wall or window.
pub(super) fn check_surface(description: &Description, wall: &Surface) -> Checked {
    let place = format!("surface {}", wall.name);
    check_index(&place, "construction", wall.construction, description.constructions.len())?;
    if !wall.vertices.is_empty() {
        check_polygon(&place, &wall.vertices)?;
    }
    let glazed = description.constructions[wall.construction].glazing.is_some();
    if let Some(soil) = &wall.soil {
        check_soil(description, &place, wall, soil)?;
    }
    for (name, side) in [("outside", &wall.outside), ("inside", &wall.inside)] {
        check_side(description, &format!("{place}, {name}"), side, glazed)?;
    }
    let between = (&wall.outside.facing, &wall.inside.facing);
    let fits = match between {
        (Facing::Outdoors, Facing::Zone { .. }) => true,
        (Facing::Zone { zone }, Facing::Zone { zone: other }) => zone != other,
        _ => false,
    };
    if glazed && !fits {
        return refuse(
            place,
            "a window elsewhere",
            "a window between outdoors (outside) and a zone (inside), or between two zones",
        );
    }
    Ok(())
}

/// Cells with a resistance on both sides, behind a construction of layers whose outer side has a given temperature.
fn check_soil(description: &Description, place: &str, wall: &Surface, soil: &Soil) -> Checked {
    for channel in soil.heat {
        check_index(place, "channel of the soil", channel, description.channels.len())?;
    }
    let (cells, links) = (soil.capacities.len(), soil.resistances.len());
    if cells < 2 || links != cells + 1 {
        let found = format_args!("soil of {cells} cells and {links} resistances").to_string();
        return refuse(place, found, "two cells or more, and one resistance more than these");
    }
    let numbers = soil.capacities.iter().chain(&soil.resistances);
    if let Some(number) = numbers.into_iter().find(|number| !(number.is_finite() && **number > 0.0)) {
        return refuse(place, format_args!("{number} in the soil"), "numbers above 0");
    }
    let glazed = description.constructions[wall.construction].glazing.is_some();
    let held = matches!(wall.outside.facing, Facing::Measured { .. }) && wall.outside.convection.is_none();
    if glazed || !held {
        return refuse(
            place,
            "soil behind something else",
            "layers whose outer side has a measured temperature",
        );
    }
    Ok(())
}

fn check_side(description: &Description, place: &str, side: &Side, glazed: bool) -> Checked {
    let channels = description.channels.len();
    match &side.facing {
        &Facing::Zone { zone } => {
            check_index(place, "zone", zone, description.zones.len())?;
            let exchanges = !matches!(description.zones[zone].longwave, ZoneLongwave::None);
            if side.convection.is_none() || (exchanges && side.emissivity.is_none()) {
                return refuse(place, "a zone without them", "convection and emissivity");
            }
        }
        Facing::Outdoors => {
            let radiates = !matches!(side.longwave, OutdoorLongwave::None);
            if side.convection.is_none() || (radiates && side.emissivity.is_none()) {
                return refuse(place, "outdoors without them", "convection and emissivity");
            }
            if side.absorptance.is_none() && side.exposure.sun && !glazed {
                return refuse(place, "sun without it", "absorptance");
            }
        }
        Facing::Measured { channel } => check_index(place, "channel", *channel, channels)?,
        Facing::Imposed { .. } | Facing::Adiabatic => {}
    }
    if let Some(flux) = &side.heat_flux {
        check_schedule(description, format_args!("{place}, heat flux"), flux.schedule)?;
        if side.facing != Facing::Adiabatic {
            return refuse(place, "a heat flux on a side that faces something", "an adiabatic side");
        }
    }
    if glazed && side.absorptance.is_some() {
        return refuse(place, "absorptance of a window", "none: its panes have their own");
    }
    for &wall in &side.shaded_by {
        check_index(place, "shaded by surface", wall, description.surfaces.len())?;
        if description.surfaces[wall].vertices.is_empty() {
            return refuse(place, format_args!("shaded by surface {wall} without vertices"), "vertices");
        }
    }
    for shade in &side.own_shades {
        check_polygon(&format!("{place}, own shade"), shade)?;
    }
    if !side.outline.is_empty() {
        check_polygon(&format!("{place}, outline"), &side.outline)?;
    }
    check_irradiance(place, side, (channels, glazed))?;
    check_convection(place, side, channels)
}

fn check_irradiance(place: &str, side: &Side, (channels, glazed): (usize, bool)) -> Checked {
    let Some(channel) = side.irradiance else {
        if side.behind_obstacles {
            return refuse(place, "behind obstacles without a measured irradiance", "irradiance");
        }
        return Ok(());
    };
    check_index(place, "irradiance in channel", channel, channels)?;
    if side.absorptance.is_none() && !glazed {
        return refuse(place, "a measured irradiance without it", "absorptance");
    }
    if side.convection.is_none() && !matches!(side.facing, Facing::Adiabatic) {
        return refuse(place, "sun on a surface with an imposed temperature", "convection, or no irradiance");
    }
    Ok(())
}

/// A measured coefficient has a channel; the laws are checked where their table is (`building/formulas.rs`).
fn check_convection(place: &str, side: &Side, channels: usize) -> Checked {
    if let Some(Convection::Measured { channel, .. }) = &side.convection {
        check_index(place, "convection in channel", *channel, channels)?;
    }
    Ok(())
}
