//! Surface heat transfer coefficients; equations and sources in `physics/convection`.

use serde::Deserialize;

use super::parameter::ParamId;

/// Surface heat transfer coefficients [W/(m2 K)]; equations and sources in `physics/convection`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Convection {
    /// One number.
    Constant {
        /// [W/(m2 K)].
        coefficient: ParamId,
    },
    /// A forcing channel [W/(m2 K)], times a factor.
    Measured {
        /// Index into [`Description::channels`](super::Description::channels).
        channel: usize,
        /// Multiplies the channel [-].
        factor: ParamId,
    },
    /// `constant + wind V`.
    LinearWind {
        /// Coefficient in still air [W/(m2 K)].
        constant: ParamId,

        /// Its rise with wind [W/(m2 K) per m/s].
        wind: ParamId,
    },
    /// Alamdari & Hammond (1983); `length`: height of a vertical surface, 4 A/P of a horizontal one [m].
    AlamdariHammond {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// The paper's eq. 5 as printed, `length` = H [m].
    PaperEq5 {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// TARP (Walton 1983). On an outdoor side the forced part is added; roughness and perimeter [m] act there alone.
    Tarp {
        /// Multiplies the correlation [-].
        factor: ParamId,
        /// Roughness multiplier Rf [-].
        #[serde(default)]
        roughness: Option<ParamId>,
        /// Perimeter of the surface [m].
        #[serde(default)]
        perimeter: Option<ParamId>,
    },
    /// `MoWiTT` (Yazdanian & Klems 1994), times a factor.
    Mowitt {
        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// DOE-2: TARP's natural part and `MoWiTT`'s wind on a rough surface.
    Doe2 {
        /// Multiplies the correlation [-].
        factor: ParamId,

        /// Roughness multiplier Rf [-].
        roughness: ParamId,
    },
    /// ISO 15099 at the indoor surface of a glazing; `length`: its height [m].
    Iso15099 {
        /// [m].
        length: ParamId,

        /// Multiplies the correlation [-].
        factor: ParamId,
    },
    /// `a + b |dT|^n + c V^m` by direction of heat flow.
    Power {
        /// Heat flows up, or the surface is vertical.
        upward: PowerLaw,
        /// Heat flows down.
        downward: PowerLaw,
    },
    /// As written, see `physics/convection/formula_text.rs`.
    Formula {
        /// The coefficient [W/(m2 K)].
        formula: String,
        /// Where it is valid; none: everywhere.
        #[serde(default)]
        valid: Option<String>,
        /// Its numbers.
        numbers: Vec<FormulaNumber>,
    },
}

/// Coefficients of [`Convection::Power`].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Constant [W/(m2 K)].
    pub a: ParamId,

    /// Gain of the temperature difference [W/(m2 K) per K^n].
    pub b: ParamId,

    /// Exponent of the temperature difference [-].
    pub n: ParamId,

    /// Gain of the wind [W/(m2 K) per (m/s)^m].
    pub c: ParamId,

    /// Exponent of the wind [-].
    pub m: ParamId,
}

/// A number of a formula.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormulaNumber {
    /// Its name in the formula.
    pub name: String,

    /// Its value.
    pub value: ParamId,
}
