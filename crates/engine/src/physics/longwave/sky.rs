//! Long-wave emission of the sky: any of the models of [`skies`], or one that is written as text, and the effect of clouds on it.
//!
//! Sources of the clouds: as a factor Clark & Allen (1978), Proc. 2nd National Passive Solar Conference, 675-678; as an opaque layer
//! Martin & Berdahl (1984), Solar Energy 33(3), doi:10.1016/0038-092X(84)90162-2.

use super::skies::{self, with_laws};
use super::sky_model::{SkyModel, SkyValue, SkyWeather};
use crate::input::description::{Clouds, PublishedLaw, Site, Sky};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::{KELVIN, SIGMA};
use crate::physics::formula::function::Function;
use crate::physics::law_row::{LawEntry, LawRow, Numbers};

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

/// Defines `Law`, one variant for each file of `skies`.
macro_rules! laws {
    ($(($module:ident, $law:ident, $kind:literal))*) => {
        /// A model with its numbers.
        #[derive(Debug, Clone)]
        enum Law<S> {
            $($law(skies::$module::$law<S>),)*
            Text(Box<TextSky<S>>),
        }

        impl<S: Real> Law<S> {
            /// The model of a kind.
            fn named(kind: &str, number: &Numbers<'_, S>) -> Option<Self> {
                match kind {
                    $($kind => Some(Self::$law(<skies::$module::$law<S> as SkyModel<S>>::new(number))),)*
                    _ => None,
                }
            }

            #[inline(always)]
            fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
                match self {
                    $(Self::$law(law) => law.sky(weather),)*
                    Self::Text(law) => law.sky(weather),
                }
            }
        }

        /// All models that a description has by name, in the order of their kinds.
        #[must_use]
        pub fn table() -> Vec<LawEntry> {
            vec![$(LawEntry::new($kind, <skies::$module::$law<f64> as SkyModel<f64>>::ROW)),*]
        }

        /// What a model says of itself; none for a kind that is no model.
        pub(crate) fn row(law: &PublishedLaw) -> Option<LawRow> {
            match law.kind.as_str() {
                $($kind => Some(<skies::$module::$law<f64> as SkyModel<f64>>::ROW),)*
                _ => None,
            }
        }
    };
}

with_laws!(laws);

/// A model that is written as text.
#[derive(Debug, Clone)]
struct TextSky<S> {
    /// Whether it gives a temperature [degC], else an emissivity [-].
    temperature: bool,
    law: Function<S>,
}

/// Values of the names of a sky as text: `To`, `Td`, `pw`, `cloud`.
fn names(weather: &SkyWeather) -> [f64; 4] {
    [weather.air - KELVIN, weather.dew_point, weather.vapour_pressure(), weather.cloud_cover]
}

impl<S: Real> TextSky<S> {
    #[inline(always)]
    fn sky(&self, weather: &SkyWeather) -> SkyValue<S> {
        let [air, others @ ..] = names(weather).map(S::constant);
        let [value, _] = self.law.at(air, &others);
        if self.temperature {
            SkyValue::Temperature(value + S::constant(KELVIN))
        } else if self.law.uses(CLOUD) {
            SkyValue::Emissivity(value)
        } else {
            SkyValue::ClearEmissivity(value)
        }
    }
}

/// The emission of the sky with the effect of clouds.
#[derive(Debug, Clone)]
pub struct SkyEmission<S> {
    law: Law<S>,
    clouds: CloudEffect<S>,
    /// Beside that of the model, for the sun in the zenith [W/m2].
    diurnal: Option<S>,
}

impl<S: Real> SkyEmission<S> {
    /// Evaluates the description at a parameter vector.
    ///
    /// # Panics
    /// For a kind that is no model: a plan refuses it.
    #[must_use]
    pub fn new(site: &Site, values: &Values<'_, S>) -> Self {
        let diurnal = site.sky_diurnal.map(|id| values.get(id));
        Self { diurnal, ..Self::of_model(&site.sky, &site.cloud, values) }
    }

    /// Without a part of its own by day.
    pub(crate) fn of_model(sky: &Sky, clouds: &Clouds, values: &Values<'_, S>) -> Self {
        let law = match sky {
            Sky::Law(law) => {
                Law::named(&law.kind, &Numbers::new(values, law)).expect("a plan knows its models of the sky")
            }
            Sky::Text { temperature, law } => {
                let kind = if *temperature { "sky_temperature" } else { "sky_emissivity" };
                Law::Text(Box::new(TextSky {
                    temperature: *temperature,
                    law: Function::of(kind, law, values),
                }))
            }
        };
        Self { law, clouds: CloudEffect::new(clouds, values), diurnal: None }
    }

    /// The model, where it is written as text and says where it holds.
    pub(crate) fn limited(&self) -> Option<&Function<S>> {
        match &self.law {
            Law::Text(sky) if sky.law.limited() => Some(&sky.law),
            _ => None,
        }
    }

    /// Values of the names of a model as text.
    pub(crate) fn names(weather: &SkyWeather) -> [f64; 4] {
        names(weather)
    }

    /// The same sky with another effect of clouds.
    #[cfg(test)]
    pub(crate) fn with_clouds(self, clouds: CloudEffect<S>) -> Self {
        Self { clouds, ..self }
    }

    /// Downward emission on a horizontal plane [W/m2].
    #[inline(always)]
    pub fn at(&self, weather: &SkyWeather) -> S {
        let emission = self.of_weather(weather);
        match self.diurnal {
            Some(diurnal) => emission + diurnal.scale(weather.sun_up),
            None => emission,
        }
    }

    /// Emission that the model has [W/m2].
    #[inline(always)]
    fn of_weather(&self, weather: &SkyWeather) -> S {
        let emissivity = match self.law.sky(weather) {
            SkyValue::Emission(emission) => return emission,
            SkyValue::Temperature(temperature) => return temperature.pow4().scale(SIGMA),
            SkyValue::Emissivity(emissivity) => emissivity,
            SkyValue::ClearEmissivity(clear) => self.clouds.emissivity(clear, weather.cloud_cover),
        };
        emissivity.min(S::one()).scale(SIGMA * weather.air.pow4())
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_close, emission, law};
    use super::*;
    use crate::input::description::{FormulaNumber, ParamId, TextLaw};

    const NO_CLOUDS: CloudEffect<f64> = CloudEffect::Factor([0.0; 3]);
    const CLOUDS: CloudEffect<f64> = CloudEffect::Factor([0.0224, -0.0035, 0.00028]);

    /// Black at 20 degC: 418.766 W/m2. Clouds 1 + 0.0224 5 - 0.0035 25 + 0.00028 125 = 1.0595.
    #[test]
    fn clouds_act_on_clear_skies() {
        let numbers = [0.711, 0.56, 0.73];
        let martin = law("martin_berdahl", &["a", "b", "c"]);
        assert_close(emission(&martin, &numbers, NO_CLOUDS), 0.7743 * 418.766);
        assert_close(emission(&martin, &numbers, CLOUDS), 0.7743 * 1.0595 * 418.766);
        assert_close(emission(&law("measured", &["scale"]), &[1.1], CLOUDS), 1.1 * 333.0);
        // No more than a black body.
        assert_close(emission(&martin, &[1.2, 0.0, 0.0], CLOUDS), 418.766);
    }

    /// With the sun at 30 degrees above or below the horizon half of the diurnal part: 324.248 + 0.5 20 W/m2.
    #[test]
    fn the_diurnal_part_follows_the_sun() {
        let none = Clouds::Factor([ParamId(0); 3]);
        let numbers = [0.711, 0.56, 0.73];
        let values = Values::new(&numbers[..]);
        let sky = SkyEmission::of_model(&law("martin_berdahl", &["a", "b", "c"]), &none, &values);
        let sky = SkyEmission { diurnal: Some(20.0), ..sky.with_clouds(NO_CLOUDS) };
        let at =
            |sun_up| sky.at(&SkyWeather { air: 293.15, dew_point: 10.0, sun_up, ..SkyWeather::default() });
        assert_close(at(0.0), 0.7743 * 418.766);
        assert_close(at(0.5) - at(0.0), 10.0);
        assert_close(at(0.0) - at(-0.5), 10.0);
    }

    /// The same models as text; a law with clouds of its own has no effect of clouds.
    #[test]
    fn skies_as_text() {
        let text = |formula: &str, temperature| {
            let number = |(k, name): (u32, &str)| FormulaNumber { name: name.into(), value: ParamId(k) };
            let numbers = [(0, "a"), (1, "b")].map(number).into();
            Sky::Text { temperature, law: TextLaw { formula: formula.into(), valid: None, numbers } }
        };
        let written = text("a + b*log((Td + 273.15)/273)", false);
        assert_close(emission(&written, &[0.787, 0.764], CLOUDS), 0.814_890 * 1.0595 * 418.766);
        let written = text("a + b*sqrt(pw/100) + 0.01*cloud", false);
        assert_close(emission(&written, &[0.52, 0.065], CLOUDS), (0.747_778 + 0.05) * 418.766);
        assert_close(emission(&text("To - a*b", true), &[5.0, 2.0], CLOUDS), 364.484);
    }

    /// Opaque clouds of half cover, their base at 1200 m: 0.7743 + 0.2257 0.5 e^(-1200/8200) = 0.871787.
    #[test]
    fn a_layer_of_clouds_adds_what_the_clear_sky_lacks() {
        let [emissivity, base] = [ParamId(3), ParamId(4)];
        let numbers = [0.711, 0.56, 0.73, 1.0, 1200.0];
        let clouds = CloudEffect::new(&Clouds::Layer { emissivity, base }, &Values::new(&numbers[..]));
        let martin = law("martin_berdahl", &["a", "b", "c"]);
        assert_close(emission(&martin, &numbers, clouds), 0.871_787 * 418.766);
    }
}
