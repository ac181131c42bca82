//! What every law of sorption offers.

use crate::number::real::Real;
use crate::physics::law_row::{LawRow, Numbers};

/// A law of the moisture content that a description has by its name.
pub(crate) trait SorptionLaw<S: Real>: Sized {
    /// What it says of itself.
    const ROW: LawRow;

    /// Whether the content is in proportion to the humidity.
    const STRAIGHT: bool = false;

    /// Reads its numbers.
    fn new(number: &Numbers<'_, S>) -> Self;

    /// Moisture content at a relative humidity from 0 to 1, which rises with it [kg/m3].
    fn content(&self, humidity: f64) -> S;
}
