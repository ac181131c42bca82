//! What every law of infiltration by a pressure test offers, and the numbers that several have.

use crate::number::real::Real;
use crate::physics::law_row::{LawParameter, LawRange, LawRow, Limits, Numbers};

/// A law of infiltration that a description has by its name.
pub(crate) trait LeakageLaw<S: Real>: Sized {
    /// What it says of itself.
    const ROW: LawRow;

    /// Reads its numbers.
    fn new(number: &Numbers<'_, S>) -> Self;

    /// Air changes [1/h], where they depend neither on the wind nor on temperatures.
    fn constant(&self) -> Option<S> {
        None
    }

    /// Air changes [1/h] and their slope in the temperature difference [1/(h K)], at the wind at the mast [m/s] and the difference
    /// between outdoor air and the zone [K]; not asked of a law with constant air changes.
    fn rate(&self, wind: S, difference: S) -> (S, S);
}

/// Air changes at 50 Pa.
pub(crate) const N50: LawParameter = LawParameter::new(
    "n50",
    "1/h",
    "Air changes at 50 Pa in a pressure test, n50",
    LawRange::Percent(20.0, "pressure tests, and the share of a zone in the leaks of a house"),
    2.2,
)
.limits(Limits { above: None, at_least: Some(0.0), at_most: Some(100.0) });
