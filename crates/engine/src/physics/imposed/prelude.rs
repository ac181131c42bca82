//! What the file of a law of an imposed temperature imports.

pub(crate) use super::imposed_law::{
    COLDEST_DAY, HEATING_LIMIT, ImposedLaw, ImposedWeather, MEAN, PER_DAY, TEMPERATURES, swing, swung,
};
pub(crate) use crate::number::real::Real;
pub(crate) use crate::physics::law_row::{Default, LawParameter, LawRange, LawRow, Numbers};
