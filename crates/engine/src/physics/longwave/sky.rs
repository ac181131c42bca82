//! Long-wave emission of the sky.
//!
//! Sources:
//! - Emissivity of the clear sky by the dew point: Clark & Allen (1978), Proc. 2nd National Passive Solar Conference, 675-678;
//!   Martin & Berdahl (1984), Solar Energy 33(3), doi:10.1016/0038-092X(84)90162-2; Brunt (1932),
//!   doi:10.1002/qj.49705824704; recalibrated by Li, Jiang & Coimbra (2017), Solar Energy 144,
//!   doi:10.1016/j.solener.2017.01.006. All coefficients are parameters.
//! - Clouds as a factor: Clark & Allen (1978); as an opaque layer: Martin & Berdahl (1984).

use crate::input::description::{Clouds, Sky};
use crate::input::forcing::channel;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::{KELVIN, SIGMA};
use crate::physics::formula::function::Function;
use crate::physics::psychrometrics::saturation_pressure;

/// Scale height of the effect of clouds [m]: the base of a cloud is colder than the air at the ground (Martin & Berdahl 1984).
const CLOUD_SCALE_HEIGHT: f64 = 8200.0;

/// Place of the cloud cover among the names of a sky as text.
const CLOUD: usize = 3;

/// Effect of clouds on the emissivity of the clear sky.
#[derive(Debug, Clone)]
pub enum CloudEffect<S> {
    /// Coefficients of the cubic factor of cloud cover in tenths [-].
    Factor([S; 3]),
    /// Part of the emission that the clear sky lacks, added under an overcast sky [-].
    Layer(S),
}

impl<S: Real> CloudEffect<S> {
    /// Evaluates the description at a parameter vector.
    #[must_use]
    pub fn new(clouds: &Clouds, values: &Values<'_, S>) -> Self {
        match clouds {
            Clouds::Factor(coefficients) => Self::Factor(coefficients.map(|id| values.get(id))),
            Clouds::Layer { emissivity, base } => {
                let depth = values.get(*base).scale(-1.0 / CLOUD_SCALE_HEIGHT);
                Self::Layer(values.get(*emissivity) * depth.exp())
            }
        }
    }

    /// Emissivity of the sky under `cover` tenths of cloud.
    #[inline(always)]
    fn emissivity(&self, clear: S, cover: f64) -> S {
        match self {
            Self::Factor(c) => {
                clear * (S::one() + (c[0] + (c[1] + c[2].scale(cover)).scale(cover)).scale(cover))
            }
            Self::Layer(overcast) => clear + (S::one() - clear) * overcast.scale(0.1 * cover),
        }
    }
}

/// The weather as the models of the sky need it.
#[derive(Debug, Clone, Copy)]
pub struct SkyState {
    /// Black emission at the air's temperature [W/m2].
    black: f64,
    /// Air temperature [K].
    air: f64,
    /// Infrared [W/m2], or the model's function of the dew point.
    humidity: f64,
    /// Cloud cover [tenths].
    cloud: f64,
    /// Dew point [degC].
    dew: f64,
}

impl SkyState {
    /// Reads a forcing row for a model.
    #[must_use]
    pub fn new(sky: &Sky, row: &[f64]) -> Self {
        let air = row[channel::AIR_TEMPERATURE] + KELVIN;
        let dew = row[channel::DEW_POINT];
        let humidity = match sky {
            Sky::Measured { .. } => row[channel::INFRARED],
            Sky::Offset { .. } => 0.0,
            Sky::ClarkAllen { .. } => Real::ln((dew + KELVIN) / 273.0),
            Sky::MartinBerdahl { .. } => dew / 100.0,
            // His law takes the vapour pressure in [hPa].
            Sky::Brunt { .. } => Real::sqrt(saturation_pressure(dew).scale(0.01)),
            Sky::Text { .. } => saturation_pressure(dew),
        };
        Self { black: SIGMA * air.pow4(), air, humidity, cloud: row[channel::CLOUD_COVER], dew }
    }
}

/// A sky that is written as text; none where it is not.
pub(crate) fn sky_law<S: Real>(sky: &Sky, values: &Values<'_, S>) -> Option<Function<S>> {
    let Sky::Text { temperature, law } = sky else { return None };
    Some(Function::of(if *temperature { "sky_temperature" } else { "sky_emissivity" }, law, values))
}

/// Downward emission of the sky on a horizontal plane [W/m2].
#[inline(always)]
pub fn sky_emission<S: Real>(
    values: &Values<'_, S>,
    sky: &Sky,
    (clouds, text): (&CloudEffect<S>, Option<&Function<S>>),
    state: &SkyState,
) -> S {
    let h = state.humidity;
    let clear = match sky {
        Sky::Measured { scale } => return values.get(*scale).scale(h),
        Sky::Offset { depression } => {
            return (S::constant(state.air) - values.get(*depression)).pow4().scale(SIGMA);
        }
        Sky::Text { temperature, law: _ } => {
            let names = [state.dew, state.humidity, state.cloud].map(S::constant);
            let [value, _] =
                text.map_or([S::zero(); 2], |text| text.at(S::constant(state.air - KELVIN), &names));
            if *temperature {
                return (value + S::constant(KELVIN)).pow4().scale(SIGMA);
            }
            if text.is_some_and(|text| text.uses(CLOUD)) {
                return value.min(S::one()).scale(state.black);
            }
            value
        }
        Sky::ClarkAllen { a, b } | Sky::Brunt { a, b } => values.get(*a) + values.get(*b).scale(h),
        Sky::MartinBerdahl { a, b, c } => {
            values.get(*a) + values.get(*b).scale(h) + values.get(*c).scale(h * h)
        }
    };
    clouds.emissivity(clear, state.cloud).min(S::one()).scale(state.black)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::{FormulaNumber, ParamId, TextLaw};
    use crate::input::forcing::CLIMATE_CHANNELS;

    /// Air at 20 degC, dew point 10 degC, 5 tenths of cloud.
    fn emission(sky: &Sky, numbers: &[f64], clouds: &CloudEffect<f64>) -> f64 {
        let mut row = [0.0; CLIMATE_CHANNELS];
        row[channel::AIR_TEMPERATURE] = 20.0;
        row[channel::DEW_POINT] = 10.0;
        row[channel::CLOUD_COVER] = 5.0;
        row[channel::INFRARED] = 333.0;
        let values = Values::new(numbers);
        let text = sky_law(sky, &values);
        sky_emission(&values, sky, (clouds, text.as_ref()), &SkyState::new(sky, &row))
    }

    /// Black at 20 degC: 418.766 W/m2.
    #[test]
    fn models_by_hand() {
        let [a, b, c] = core::array::from_fn(|k| ParamId(u32::try_from(k).unwrap()));
        let clear = &CloudEffect::Factor([0.0; 3]);
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
        };
        // 0.711 + 0.56 0.1 + 0.73 0.01 = 0.7743; clouds 1 + 0.0224 5 - 0.0035 25 + 0.00028 125 = 1.0595.
        let martin = Sky::MartinBerdahl { a, b, c };
        close(emission(&martin, &[0.711, 0.56, 0.73], clear), 0.7743 * 418.766);
        let cloud = &CloudEffect::Factor([0.0224, -0.0035, 0.00028]);
        close(emission(&martin, &[0.711, 0.56, 0.73], cloud), 0.7743 * 1.0595 * 418.766);
        // 0.787 + 0.764 ln(283.15/273) = 0.814890.
        close(emission(&Sky::ClarkAllen { a, b }, &[0.787, 0.764], clear), 0.814_890 * 418.766);
        // Vapour pressure 12.27995 hPa: 0.52 + 0.065 3.504276 = 0.747778.
        close(emission(&Sky::Brunt { a, b }, &[0.52, 0.065], clear), 0.747_778 * 418.766);
        // 10 K below the air: sigma 283.15^4 = 364.484; measured: the channel.
        close(emission(&Sky::Offset { depression: a }, &[10.0], clear), 364.484);
        close(emission(&Sky::Measured { scale: a }, &[1.1], cloud), 1.1 * 333.0);
        // The same models as text; a law with clouds of its own has no effect of clouds.
        let text = |formula: &str, temperature| {
            let number = |(k, name): (u32, &str)| FormulaNumber { name: name.into(), value: ParamId(k) };
            let numbers = [(0, "a"), (1, "b")].map(number).into();
            Sky::Text { temperature, law: TextLaw { formula: formula.into(), numbers } }
        };
        let written = text("a + b*log((Td + 273.15)/273)", false);
        close(emission(&written, &[0.787, 0.764], cloud), 0.814_890 * 1.0595 * 418.766);
        let written = text("a + b*sqrt(pw/100) + 0.01*cloud", false);
        close(emission(&written, &[0.52, 0.065], cloud), (0.747_778 + 0.05) * 418.766);
        close(emission(&text("To - a*b", true), &[5.0, 2.0], cloud), 364.484);
        // No more than a black body.
        close(emission(&martin, &[1.2, 0.0, 0.0], cloud), 418.766);
    }
    /// Opaque clouds of half cover, their base at 1200 m: 0.7743 + 0.2257 0.5 e^(-1200/8200) = 0.871787.
    #[test]
    fn a_layer_of_clouds_adds_what_the_clear_sky_lacks() {
        let [a, b, c, emissivity, base] = core::array::from_fn(|k| ParamId(u32::try_from(k).unwrap()));
        let numbers = [0.711, 0.56, 0.73, 1.0, 1200.0];
        let clouds = CloudEffect::new(&Clouds::Layer { emissivity, base }, &Values::new(&numbers[..]));
        let found = emission(&Sky::MartinBerdahl { a, b, c }, &numbers, &clouds);
        assert!((found / (0.871_787 * 418.766) - 1.0).abs() < 1e-5, "{found}");
    }
}
