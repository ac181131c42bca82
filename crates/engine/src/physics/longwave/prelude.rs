//! What the file of a model of the sky imports.

pub(crate) use super::sky_model::{SkyModel, SkyValue, SkyWeather, emissivity_coefficient};
pub(crate) use crate::number::real::Real;
pub(crate) use crate::physics::constants::KELVIN;
pub(crate) use crate::physics::law_row::{
    Alternative, CloudKind, Default, LawParameter, LawRange, LawRow, Limits, Numbers,
};
