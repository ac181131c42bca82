//! What the file of a model of the diffuse radiation imports.

pub(crate) use super::model::{COS_85, DiffuseModel, DiffuseSun, Fractions};
pub(crate) use crate::number::elementary::acos;
pub(crate) use crate::number::real::Real;
pub(crate) use crate::physics::law_row::{Alternative, LawRow};
