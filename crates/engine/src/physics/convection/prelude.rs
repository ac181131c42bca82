//! What the file of a law imports.

pub(crate) use super::correlation::{Correlation, NamedLaw, Placement, WindPart};
pub(crate) use super::natural::{
    Coefficient, Difference, HORIZONTAL, any_power, blend, cube_root, fifth_root_where, sixth_power,
};
pub(crate) use super::numbers::{FACTOR, LENGTH, PERIMETER, ROUGHNESS, coefficient};
pub(crate) use super::wind::{Forced, MOWITT_EXPONENTS, Wind, WindTerms};
pub(crate) use crate::number::real::{Mask, Real};
pub(crate) use crate::physics::law_row::{
    Alternative, Default, LawParameter, LawRange, LawRow, Numbers, Sides, Tilt,
};
