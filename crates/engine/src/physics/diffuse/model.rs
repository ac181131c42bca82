//! What every model of the diffuse radiation offers, and the sun that it is given.

use crate::physics::law_row::LawRow;

/// Cosines of the zenith angles 85 and 89 deg: in the ratio of cosines the sun stays at least 5 deg (Perez) or 1 deg (Hay and
/// Davies) above the horizon.
pub(crate) const COS_85: f64 = 0.08715574274765814;
pub(crate) const COS_89: f64 = 0.0174524064372836;

/// A model of the diffuse radiation of the sky on a plane that a description has by its name. Its parts are an isotropic one, a bright
/// sky around the sun, and a bright horizon.
pub(crate) trait DiffuseModel {
    /// What it says of itself.
    const ROW: LawRow;

    /// Cosine of the zenith angle that the sun does not go beyond in the ratio of cosines [-].
    const LOWEST: f64 = COS_89;

    /// The parts that are no isotropic radiation.
    fn fractions(sun: &DiffuseSun) -> Fractions;
}

/// Fractions of the diffuse radiation on the horizontal [-].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Fractions {
    /// From around the sun, 0 to 1.
    pub(crate) circumsolar: f64,
    /// From the horizon, -1 to 1.
    pub(crate) horizon: f64,
}

/// The sun and its radiation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DiffuseSun {
    /// Sine of its elevation [-].
    pub(crate) up: f64,
    /// Beam on a plane normal to it; zero below the horizon [W/m2].
    pub(crate) direct_normal: f64,
    /// Diffuse radiation on the horizontal [W/m2].
    pub(crate) diffuse: f64,
    /// Beam outside of the atmosphere; zero where it is not known [W/m2].
    pub(crate) extraterrestrial: f64,
}
