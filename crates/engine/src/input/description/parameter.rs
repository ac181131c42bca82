//! Numeric leaves of a description.

use serde::Deserialize;

/// Index of a numeric leaf in [`Description::parameters`](super::Description::parameters).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(transparent)]
pub struct ParamId(pub u32);

/// A numeric leaf: its path in the user's description and its nominal value (SI, degC, deg).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Dotted path, e.g. `materials.energain.latent_heat`.
    pub path: String,
    /// Nominal value.
    pub value: f64,
}
