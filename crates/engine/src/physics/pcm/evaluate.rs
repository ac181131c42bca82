//! The liquid fraction of a described curve outside of a run: for checks, fits and figures.

use super::curve::Curve;
use super::text::FractionText;
use crate::error::EngineError;
use crate::input::description::{MeltingCurve, ParamId};
use crate::input::values::Values;

/// A curve with its numbers.
#[derive(Debug, Clone)]
pub struct LiquidFraction {
    curve: Curve<f64>,
}

impl LiquidFraction {
    /// From a curve as descriptions have it, whose parameters are positions in `values`.
    ///
    /// # Errors
    /// [`EngineError::Input`]: a position without a value, or a table that is not one.
    pub fn new(curve: &MeltingCurve, values: &[f64]) -> Result<Self, EngineError> {
        let most = parameters(curve).into_iter().map(|id| id.0 as usize).max().unwrap_or(0);
        if most >= values.len() {
            let text = format!("a melting curve reads value {most}, found {} values", values.len());
            return Err(EngineError::Input(text));
        }
        if let MeltingCurve::Fractions { temperatures, fractions, .. } = curve {
            let load_sensitivities = temperatures.windows(2).all(|pair| pair[0] < pair[1]);
            if temperatures.len() < 2 || temperatures.len() != fractions.len() || !load_sensitivities {
                let text =
                    "a measured melting curve needs two or more rising temperatures, each with a fraction";
                return Err(EngineError::Input(text.to_owned()));
            }
        }
        if let MeltingCurve::Text { formula, numbers, .. } = curve {
            let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
            FractionText::new(formula, &names)
                .map_err(|error| EngineError::Input(error.fault.to_string()))?;
        }
        Ok(Self { curve: Curve::new(&Values::new(values), curve) })
    }

    /// Liquid fraction at a temperature [degC]: [-].
    #[must_use]
    pub fn at(&self, temperature: f64) -> f64 {
        self.curve.whole(temperature).0
    }

    /// Temperatures where melting starts and is complete; a thousandth of the transition is cut off where a curve has tails [degC].
    #[must_use]
    pub fn reach(&self) -> [f64; 2] {
        self.curve.support()
    }
}

/// Parameters of a curve.
fn parameters(curve: &MeltingCurve) -> Vec<ParamId> {
    match curve {
        MeltingCurve::TanhWidth { melting_temperature, width }
        | MeltingCurve::SmoothStep { melting_temperature, width, .. }
        | MeltingCurve::Gaussian { melting_temperature, width }
        | MeltingCurve::Gumbel { melting_temperature, width, .. }
        | MeltingCurve::Linear { melting_temperature, width } => vec![*melting_temperature, *width],
        MeltingCurve::TanhGamma { melting_temperature, gamma: first, delta_t: second }
        | MeltingCurve::Triangle { melting_temperature, below: first, above: second } => {
            vec![*melting_temperature, *first, *second]
        }
        MeltingCurve::Fractions { temperature_shift, .. } => vec![*temperature_shift],
        MeltingCurve::Text { melting_temperature, numbers, .. } => {
            core::iter::once(*melting_temperature).chain(numbers.iter().map(|number| number.value)).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::pcm::CUT;

    /// `(1 + tanh 1)/2 = 0.880797` at a half-width above the middle; the ends are where a thousandth is left.
    #[test]
    fn the_tanh_law_by_hand() {
        let [melting_temperature, width] = [0, 1].map(ParamId);
        let curve = MeltingCurve::TanhWidth { melting_temperature, width };
        let law = LiquidFraction::new(&curve, &[25.0, 2.0]).unwrap();
        assert!((law.at(27.0) - 0.880_797_077_977_882_4).abs() < 1e-15);
        let [low, high] = law.reach();
        assert!((law.at(low) - CUT).abs() < 1e-12 && (law.at(high) - (1.0 - CUT)).abs() < 1e-12);
        assert!((high - 25.0 - 2.0 * 3.453_377_389_324_276).abs() < 1e-12);
        assert!(LiquidFraction::new(&curve, &[25.0]).is_err());
    }
}
