//! What the file of a law of sorption imports.

pub(crate) use super::sorption_law::SorptionLaw;
pub(crate) use crate::number::real::Real;
pub(crate) use crate::physics::law_row::{LawParameter, LawRange, LawRow, Numbers};
