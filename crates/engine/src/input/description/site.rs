//! The site: air, ground, wind profile and models of the sky.

use serde::Deserialize;

use super::convection::TextLaw;
use super::parameter::ParamId;

/// Site constants that act in the engine. (Latitude and longitude act through the sun's path in the forcing.)
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Site {
    /// Altitude [m]: gives the air density where none is given.
    pub altitude: ParamId,
    /// Density of the air in the zones [kg/m3]; none: from the altitude.
    #[serde(default)]
    pub air_density: Option<ParamId>,
    /// Specific heat of the air [J/(kg K)]; none: that of dry air.
    #[serde(default)]
    pub air_specific_heat: Option<ParamId>,
    /// Solar reflectance of the ground [-].
    pub ground_reflectance: ParamId,
    /// Wind speed at a surface from that at the mast.
    pub wind: WindProfile,
    /// Model of the sky's long-wave emission.
    pub sky: Sky,
    /// Effect of clouds on the sky's long-wave emission.
    pub cloud: Clouds,
    /// Model of the sky's diffuse short-wave radiation.
    pub diffuse: DiffuseSky,
    /// Azimuth, rising below 360, and elevation of what hides the sky [deg]; empty: nothing.
    #[serde(default)]
    pub horizon: Vec<[f64; 2]>,
}

/// Power-law wind profile (ASHRAE Handbook of Fundamentals, ch. 24):
/// `V = V_mast (delta_mast/z_mast)^a_mast (z/delta)^a`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindProfile {
    /// Height of the anemometer [m].
    pub mast_height: ParamId,
    /// Exponent at the mast [-].
    pub mast_exponent: ParamId,
    /// Boundary layer thickness at the mast [m].
    pub mast_layer: ParamId,
    /// Exponent at the building [-].
    pub exponent: ParamId,
    /// Boundary layer thickness at the building [m].
    pub layer: ParamId,
}

/// Sky emission models; see `physics/longwave` for equations and sources.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sky {
    /// Horizontal infrared of the climate [W/m2] (channel `infrared`), times a scale.
    Measured {
        /// Multiplies the channel [-].
        scale: ParamId,
    },
    /// Emissivity `a + b ln(Tdp/273)`, Tdp in K.
    ClarkAllen {
        /// Constant [-].
        a: ParamId,
        /// Gain of the logarithm [-].
        b: ParamId,
    },
    /// Emissivity `a + b (tdp/100) + c (tdp/100)^2`, tdp in degC.
    MartinBerdahl {
        /// Constant [-].
        a: ParamId,
        /// Linear gain [-].
        b: ParamId,
        /// Square gain [-].
        c: ParamId,
    },
    /// Emissivity `a + b sqrt(pw)`, pw in hPa.
    Brunt {
        /// Constant [-].
        a: ParamId,
        /// Gain of the root [1/hPa^(1/2)].
        b: ParamId,
    },
    /// Sky temperature = air temperature - depression [K].
    Offset {
        /// Air minus sky [K].
        depression: ParamId,
    },
    /// An emissivity [-] or a temperature [degC] as text.
    Text {
        /// Whether it gives a temperature.
        temperature: bool,
        /// Of `To`, `Td`, `pw` and `cloud`.
        law: TextLaw,
    },
}

/// Effect of clouds on the emissivity of the clear sky; see `physics/longwave` for sources.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum Clouds {
    /// Factor `1 + c1 N + c2 N^2 + c3 N^3` of cloud cover N [tenths] (Clark & Allen 1978).
    Factor([ParamId; 3]),
    /// Opaque layer: adds `(1 - clear) (N/10) emissivity exp(-base/8200 m)` (Martin & Berdahl 1984).
    Layer {
        /// Emissivity of the clouds [-].
        emissivity: ParamId,
        /// Height of their base above the ground [m].
        base: ParamId,
    },
}

/// Diffuse short-wave models on a tilted plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DiffuseSky {
    /// Isotropic (Liu & Jordan 1963).
    Isotropic,
    /// Hay & Davies (1980).
    HayDavies,
    /// Perez et al. (1990), coefficients "all sites composite 1990".
    Perez,
}
