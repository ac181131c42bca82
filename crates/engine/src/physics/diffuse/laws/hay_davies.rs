//! Hay and Davies: a part of the diffuse radiation comes from around the sun, `A = I/I_0`, the rest from everywhere.
//!
//! Source: Hay & Davies (1980), Calculation of the solar radiation incident on an inclined surface, Proc. First Canadian Solar
//! Radiation Data Workshop, 59-72.

use crate::physics::diffuse::prelude::*;

/// `A = I/I_0` from around the sun.
pub(crate) struct HayDavies;

impl DiffuseModel for HayDavies {
    const ROW: LawRow = LawRow::new(
        "Hay and Davies",
        "A part of the diffuse radiation comes from around the sun, as much as the atmosphere lets pass of the beam.",
        "all skies",
    )
    .source("Hay & Davies 1980, Proc. First Canadian Solar Radiation Data Workshop (diffuse radiation on a plane)")
    .further_sources(&["Kopp & Lean 2011, doi:10.1029/2010GL045777 (solar constant)"])
    .alternatives(&[Alternative::USUAL]);

    fn fractions(sun: &DiffuseSun) -> Fractions {
        let extra = sun.extraterrestrial;
        let circumsolar = if extra > 0.0 { (sun.direct_normal / extra).min(1.0) } else { 0.0 };
        Fractions { circumsolar, horizon: 0.0 }
    }
}
