//! Refuses descriptions that the engine cannot compute.
//!
//! Everything that indexing and geometry of the engine rely on is checked here, once, before a plan is made: references,
//! parameter ids, parts that need each other, sizes of tables, and numbers that are not parameters. The description language
//! checks the same with messages in the user's words; what is refused here is a fault of the caller.
//!
//! A message says where, what was found and what was expected.

mod air;
mod construction;
mod humidity;
mod numbers;
mod surface;
#[cfg(test)]
mod tests;
mod zone;

use core::fmt::Display;

use super::description::Description;
use super::parameter_walk::Walk;
use crate::error::EngineError;

/// What every check returns.
type Checked = Result<(), EngineError>;

/// Refuses a place of the description.
fn refuse(place: impl Display, found: impl Display, expected: impl Display) -> Checked {
    Err(EngineError::Description(format!("{place}: found {found}, expected {expected}")))
}

/// Refuses an index that is not below a count.
fn check_index(place: impl Display, what: &str, index: usize, count: usize) -> Checked {
    if index < count {
        return Ok(());
    }
    refuse(place, format_args!("{what} {index}"), format_args!("an index below {count}"))
}

/// Refuses a schedule that is no channel.
fn check_schedule(description: &Description, place: impl Display, schedule: Option<usize>) -> Checked {
    schedule.map_or(Ok(()), |channel| check_index(place, "channel", channel, description.channels.len()))
}

/// Refuses what the engine cannot compute.
///
/// # Errors
/// [`EngineError::Description`] with the place, what was found there and what was expected.
pub(crate) fn check(description: &Description) -> Checked {
    check_parameters(description)?;
    check_horizon(&description.site.horizon)?;
    for material in &description.materials {
        construction::check_material(material)?;
    }
    for construction in &description.constructions {
        construction::check_construction(description, construction)?;
    }
    for wall in &description.surfaces {
        surface::check_surface(description, wall)?;
    }
    for source in &description.heat_sources {
        surface::check_heat_source(description, source)?;
    }
    for (index, zone) in description.zones.iter().enumerate() {
        zone::check_zone(description, index, zone)?;
    }
    for path in &description.air_paths {
        zone::check_air_path(description, path)?;
    }
    air::check_air(description)?;
    if let Some(humidity) = &description.humidity {
        humidity::check_humidity(description, humidity)?;
    }
    for opening in &description.openings {
        zone::check_opening(description, opening)?;
    }
    for sensor in &description.sensors {
        let place = format_args!("sensor {}", sensor.name).to_string();
        check_index(place, "surface", sensor.surface, description.surfaces.len())?;
    }
    for (index, shade) in description.shades.iter().enumerate() {
        numbers::check_polygon(&format!("shade {index}"), shade)?;
    }
    Ok(())
}

/// Azimuths that rise from 0 to below 360 deg, with elevations from 0 to 90 deg.
fn check_horizon(points: &[[f64; 2]]) -> Checked {
    let outside = |point: &[f64; 2]| !(0.0..360.0).contains(&point[0]) || !(0.0..=90.0).contains(&point[1]);
    if let Some([azimuth, elevation]) = points.iter().find(|point| outside(point)) {
        let found = format_args!("azimuth {azimuth} and elevation {elevation}").to_string();
        return refuse("site.horizon", found, "azimuths from 0 to below 360, elevations from 0 to 90");
    }
    match points.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
        Some(pair) => {
            refuse("site.horizon", format_args!("{} after {}", pair[1][0], pair[0][0]), "rising azimuths")
        }
        None => Ok(()),
    }
}

/// Every parameter id has a parameter, and every nominal value is a number.
fn check_parameters(description: &Description) -> Checked {
    for parameter in &description.parameters {
        if !parameter.value.is_finite() {
            return refuse(
                format_args!("parameter {}", parameter.path),
                parameter.value,
                "a finite nominal value",
            );
        }
    }
    let count = description.parameters.len();
    let mut checked = Ok(());
    Walk::over(description, |place, id| {
        if checked.is_ok() {
            checked = check_index(place, "parameter", id.0 as usize, count);
        }
    });
    checked
}
