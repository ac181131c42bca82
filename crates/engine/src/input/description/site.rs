//! The site: air, ground, wind profile and models of the sky.

use serde::Deserialize;

use super::convection::TextLaw;
use super::parameter::ParamId;
use super::published_law::{PublishedLaw, WrittenNumbers};

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
    /// Exponent of the view factor of the sky in what surfaces receive of its emission [-]; none: 3/2.
    #[serde(default)]
    pub sky_exponent: Option<ParamId>,
    /// Emission of the sky in proportion to the sine of the sun's altitude, beside that of the model [W/m2]; none: 0.
    #[serde(default)]
    pub sky_diurnal: Option<ParamId>,
    /// Model of the sky's diffuse short-wave radiation: a file of `physics/diffuse/laws`.
    pub diffuse: String,
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

/// Emission of the sky; equations and sources in `physics/longwave`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "WrittenSky")]
pub enum Sky {
    /// A published model.
    Law(PublishedLaw),
    /// An emissivity [-] or a temperature [degC] as text.
    Text {
        /// Whether it gives a temperature.
        temperature: bool,
        /// Of `To`, `Td`, `pw` and `cloud`.
        law: TextLaw,
    },
}

/// A sky in JSON.
#[derive(Deserialize)]
struct WrittenSky {
    kind: String,
    temperature: Option<bool>,
    law: Option<TextLaw>,
    #[serde(flatten)]
    numbers: WrittenNumbers,
}

impl TryFrom<WrittenSky> for Sky {
    type Error = String;

    fn try_from(written: WrittenSky) -> Result<Self, String> {
        let WrittenSky { kind, temperature, law, numbers } = written;
        match (kind.as_str(), temperature, law) {
            ("text", Some(temperature), Some(law)) if numbers.is_empty() => {
                Ok(Self::Text { temperature, law })
            }
            ("text", ..) => Err("found other keys than those of 'text'".into()),
            (_, None, None) => Ok(Self::Law(PublishedLaw::written(kind, numbers))),
            _ => Err(format!("found a text in '{kind}'")),
        }
    }
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
