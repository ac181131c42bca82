//! Enthalpy of a phase-change material over temperature; equations in `physics/pcm`.

use serde::Deserialize;

use super::convection::FormulaNumber;
use super::parameter::ParamId;

/// How enthalpy depends on temperature.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PcmLaw {
    /// Sensible heat, and latent heat by one curve of the liquid fraction.
    Melting {
        /// Heat of melting [J/kg].
        latent_heat: ParamId,
        /// Liquid fraction over temperature.
        curve: MeltingCurve,
    },
    /// The same by a law whose liquid fraction depends on what went before; laws, curves and numbers: `physics/pcm/history`.
    History {
        /// Heat of melting [J/kg].
        latent_heat: ParamId,
        /// Name of the law.
        model: String,
        /// Its curves, that of melting first; one of freezing is nowhere below it.
        curves: Vec<MeltingCurve>,
        /// Its numbers.
        numbers: Vec<FormulaNumber>,
    },
    /// Monotone C1 curve of specific enthalpy over temperature [degC]; read at `T - temperature_shift`, multiplied by
    /// `enthalpy_scale`. `specific_heat` of the material is used outside the table. The liquid fraction is 0 below
    /// `melting_range[0]`, 1 above `melting_range[1]` and proportional to the enthalpy between.
    Tabulated {
        /// Points of the curve, rising [degC].
        temperatures: Vec<f64>,

        /// What is given at each point.
        points: TablePoints,

        /// Solidus and liquidus [degC].
        melting_range: [f64; 2],

        /// Shifts the curve towards higher temperatures [K].
        temperature_shift: ParamId,

        /// Multiplies the enthalpies [-].
        enthalpy_scale: ParamId,
    },
}

/// Points of a tabulated curve.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TablePoints {
    /// Rising [J/kg], interpolated by monotone cubics.
    Enthalpies(Vec<f64>),
    /// Positive [J/(kg K)], interpolated linearly: the enthalpy is their integral.
    Capacities(Vec<f64>),
}

/// Liquid fraction over temperature. Widths [K] are half-widths unless said otherwise; shifts and temperatures [degC].
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MeltingCurve {
    /// `1/2 + 1/2 tanh((T - Tm)/w)`.
    TanhWidth {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
    },
    /// The paper's form, `w = 4 delta_t / gamma`.
    TanhGamma {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// The paper's gamma [-].
        gamma: ParamId,
        /// The paper's delta T [K].
        delta_t: ParamId,
    },
    /// The polynomial of least degree from 0 at `Tm - w` to 1 at `Tm + w` with so many continuous derivatives.
    SmoothStep {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
        /// 1 or 2.
        continuity: u8,
    },
    /// The normal distribution.
    Gaussian {
        /// Mean [degC].
        melting_temperature: ParamId,
        /// Standard deviation [K].
        width: ParamId,
    },
    /// The Gumbel distribution, the skewed one of extremes.
    Gumbel {
        /// Its mode, where most melts [degC].
        melting_temperature: ParamId,
        /// Its scale [K].
        width: ParamId,
        /// Where its long tail is.
        tail: Tail,
    },
    /// Straight from 0 at `Tm - w` to 1 at `Tm + w`.
    Linear {
        /// Middle of the melting range [degC].
        melting_temperature: ParamId,
        /// Half-width w [K].
        width: ParamId,
    },
    /// Latent capacity that rises straight to the peak and falls straight after it.
    Triangle {
        /// The peak [degC].
        melting_temperature: ParamId,
        /// From the solidus to the peak [K].
        below: ParamId,
        /// From the peak to the liquidus [K].
        above: ParamId,
    },
    /// Measured fractions, interpolated by monotone cubics; read at `T - temperature_shift`.
    Fractions {
        /// Points of the curve, rising [degC].
        temperatures: Vec<f64>,
        /// Rising from 0 to 1.
        fractions: Vec<f64>,
        /// Shifts the curve towards higher temperatures [K].
        temperature_shift: ParamId,
    },
    /// As written, see `physics/pcm/text.rs`.
    Text {
        /// Melting temperature of the formula [degC].
        melting_temperature: ParamId,
        /// The liquid fraction.
        formula: String,
        /// Where it melts, about the melting temperature [K].
        range: [f64; 2],
        /// Its numbers.
        numbers: Vec<FormulaNumber>,
    },
}

/// Side of the long tail of a skewed curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tail {
    /// Melting starts slowly and ends abruptly.
    Low,
    /// Melting starts abruptly and ends slowly.
    High,
}
