//! A moisture content in proportion to the relative humidity, `capacity phi`.

use crate::physics::sorption::prelude::*;

const CAPACITY: LawParameter = LawParameter::new(
    "capacity",
    "kg/m3",
    "Moisture content at a relative humidity of 1",
    LawRange::Percent(30.0, "differences between tables for the same name, moisture, temperature, ageing"),
    12.0,
)
.positive();

/// `capacity phi`.
#[derive(Debug, Clone)]
pub(crate) struct Linear<S> {
    capacity: S,
}

impl<S: Real> SorptionLaw<S> for Linear<S> {
    const ROW: LawRow = LawRow::new(
        "in proportion",
        "A moisture content in proportion to the relative humidity.",
        "small swings of humidity",
    )
    .numbers(&[CAPACITY]);

    const STRAIGHT: bool = true;

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { capacity: number.of("capacity") }
    }

    fn content(&self, humidity: f64) -> S {
        self.capacity.scale(humidity)
    }
}
