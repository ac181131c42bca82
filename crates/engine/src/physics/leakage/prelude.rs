//! What the file of a law of infiltration imports.

pub(crate) use super::leakage_law::{LeakageLaw, N50};
pub(crate) use crate::number::real::Real;
pub(crate) use crate::physics::law_row::{Choice, Default, LawParameter, LawRange, LawRow, Limits, Numbers};
