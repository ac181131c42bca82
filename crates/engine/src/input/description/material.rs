//! What a layer is made of.

use serde::Deserialize;

use super::convection::TextLaw;
use super::parameter::ParamId;
use super::phase_change::PcmLaw;

/// What a layer is made of.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Material {
    /// Constant properties: W/(m K), kg/m3, J/(kg K).
    Solid {
        /// [W/(m K)].
        conductivity: ParamId,
        /// [kg/m3].
        density: ParamId,
        /// [J/(kg K)].
        specific_heat: ParamId,
    },
    /// A conductivity that changes with temperature: W/(m K), kg/m3, J/(kg K).
    Variable {
        /// Of the temperature `T` [degC]: [W/(m K)].
        conductivity: TextLaw,
        /// [kg/m3].
        density: ParamId,
        /// [J/(kg K)].
        specific_heat: ParamId,
    },
    /// No heat capacity, a resistance [m2 K/W]; the layer has no thickness.
    Resistance {
        /// [m2 K/W].
        resistance: ParamId,
    },
    /// A frame by its rated U value: its resistance is 1/U less the rated surface resistances (ISO 6946).
    Rated {
        /// Air to air [W/(m2 K)].
        u_value: ParamId,
    },
    /// Phase-change material; pairs are [solid, liquid].
    Pcm {
        /// [W/(m K)].
        conductivity: [ParamId; 2],
        /// [kg/m3].
        density: [ParamId; 2],
        /// [J/(kg K)].
        specific_heat: [ParamId; 2],
        /// Enthalpy over temperature.
        law: PcmLaw,
    },
}
