//! Numbers of a description that are not parameters: tables and corners.

use core::fmt::Display;

use super::{Checked, refuse};

/// Corners that lie within this share of the polygon's extent of one line enclose no area.
const FLAT: f64 = 1e-9;

/// Refuses numbers that are not finite.
pub(super) fn check_finite<'a>(place: &str, numbers: impl IntoIterator<Item = &'a f64>) -> Checked {
    match numbers.into_iter().find(|number| !number.is_finite()) {
        Some(number) => refuse(place, number, "finite numbers"),
        None => Ok(()),
    }
}

/// Refuses numbers below zero, and those that are not finite.
pub(super) fn check_not_negative<'a>(place: &str, numbers: impl IntoIterator<Item = &'a f64>) -> Checked {
    match numbers.into_iter().find(|number| !(number.is_finite() && **number >= 0.0)) {
        Some(number) => refuse(place, number, "finite numbers of at least zero"),
        None => Ok(()),
    }
}

/// Refuses numbers outside 0 to 1.
pub(super) fn check_fractions<'a>(place: &str, numbers: impl IntoIterator<Item = &'a f64>) -> Checked {
    match numbers.into_iter().find(|number| !(0.0..=1.0).contains(*number)) {
        Some(number) => refuse(place, number, "numbers from 0 to 1"),
        None => Ok(()),
    }
}

/// Refuses less than two numbers, and numbers that do not rise.
pub(super) fn check_rising(place: &str, numbers: &[f64]) -> Checked {
    check_finite(place, numbers)?;
    if numbers.len() < 2 {
        return refuse(place, format_args!("{} points", numbers.len()), "at least two points");
    }
    match numbers.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => refuse(place, format_args!("{} after {}", pair[1], pair[0]), "rising numbers"),
        None => Ok(()),
    }
}

/// Refuses a list of another length.
pub(super) fn check_count(place: &str, found: usize, expected: usize, why: impl Display) -> Checked {
    if found == expected {
        return Ok(());
    }
    refuse(place, format_args!("{found} values"), format_args!("{expected}: {why}"))
}

/// Refuses corners [m] that enclose no area.
pub(super) fn check_polygon(place: &str, corners: &[[f64; 3]]) -> Checked {
    check_finite(place, corners.iter().flatten())?;
    if corners.len() < 3 {
        return refuse(place, format_args!("{} corners", corners.len()), "at least three corners");
    }
    let origin = corners[0];
    let from_origin = |corner: [f64; 3]| core::array::from_fn(|k| corner[k] - origin[k]);
    // Twice the vector area (Newell's method).
    let (mut area, mut extent) = ([0.0; 3], 0.0_f64);
    for pair in corners.windows(2) {
        let [a, b]: [[f64; 3]; 2] = [from_origin(pair[0]), from_origin(pair[1])];
        for (k, part) in area.iter_mut().enumerate() {
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            *part += a[l] * b[m] - a[m] * b[l];
        }
        extent = extent.max(b.iter().map(|x| x * x).sum());
    }
    if area.iter().map(|x| x * x).sum::<f64>().sqrt() <= FLAT * extent {
        return refuse(place, "corners on one line", "corners that enclose an area");
    }
    Ok(())
}
