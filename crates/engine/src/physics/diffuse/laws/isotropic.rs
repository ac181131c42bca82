//! Liu and Jordan: a sky of the same brightness everywhere.
//!
//! Source: Liu & Jordan (1963), Solar Energy 7(2), 53-74, doi:10.1016/0038-092X(63)90006-9.
//!
//! Range: overcast skies; too dark towards the sun under clear ones.

use crate::physics::diffuse::prelude::*;

/// No part comes from anywhere else.
pub(crate) struct Isotropic;

impl DiffuseModel for Isotropic {
    const ROW: LawRow = LawRow::new("isotropic", "A sky of the same brightness everywhere.", "overcast skies")
        .source("Liu & Jordan 1963, doi:10.1016/0038-092X(63)90006-9 (diffuse radiation on a plane)")
        .alternatives(&[Alternative::USUAL]);

    fn fractions(_sun: &DiffuseSun) -> Fractions {
        Fractions::default()
    }
}
