//! Temperatures, heat and coefficients that surroundings impose on sides, and temperatures on ends of thermal bridges: any of the laws of [`laws`].

pub(crate) mod imposed_law;
pub(crate) mod laws;
pub(crate) mod prelude;

use crate::input::description::PublishedLaw;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::law_row::{LawEntry, LawRow, Numbers};
use imposed_law::ImposedLaw;
pub use imposed_law::ImposedWeather;
use laws::with_laws;

/// Defines `Law`, one variant for each file of `laws`.
macro_rules! laws {
    ($(($module:ident, $law:ident, $kind:literal))*) => {
        /// A law with its numbers.
        #[derive(Debug, Clone)]
        enum Law<S> {
            $($law(laws::$module::$law<S>),)*
        }

        impl<S: Real> Law<S> {
            /// The law of a kind.
            fn named(kind: &str, number: &Numbers<'_, S>) -> Option<Self> {
                match kind {
                    $($kind => Some(Self::$law(<laws::$module::$law<S> as ImposedLaw<S>>::new(number))),)*
                    _ => None,
                }
            }

            #[inline(always)]
            fn temperature(&self, at: &ImposedWeather) -> S {
                match self {
                    $(Self::$law(law) => law.temperature(at),)*
                }
            }

            fn heat(&self, at: &ImposedWeather) -> S {
                match self {
                    $(Self::$law(law) => law.heat(at),)*
                }
            }

            fn coefficient(&self, at: &ImposedWeather) -> S {
                match self {
                    $(Self::$law(law) => law.coefficient(at),)*
                }
            }

            fn row(&self) -> LawRow {
                match self {
                    $(Self::$law(_) => <laws::$module::$law<f64> as ImposedLaw<f64>>::ROW,)*
                }
            }
        }

        /// All laws that a description has by name, in the order of their kinds.
        #[must_use]
        pub fn table() -> Vec<LawEntry> {
            vec![$(LawEntry::new($kind, <laws::$module::$law<f64> as ImposedLaw<f64>>::ROW)),*]
        }

        /// What a law says of itself; none for a kind that is no law.
        pub(crate) fn row(law: &PublishedLaw) -> Option<LawRow> {
            match law.kind.as_str() {
                $($kind => Some(<laws::$module::$law<f64> as ImposedLaw<f64>>::ROW),)*
                _ => None,
            }
        }
    };
}

with_laws!(laws);

/// An imposed temperature with its numbers.
#[derive(Debug, Clone)]
pub struct ImposedTemperature<S> {
    law: Law<S>,
}

impl<S: Real> ImposedTemperature<S> {
    /// Evaluates a law at a parameter vector; none for a kind that is no law.
    #[must_use]
    pub fn new(law: &PublishedLaw, values: &Values<'_, S>) -> Option<Self> {
        Law::named(&law.kind, &Numbers::new(values, law)).map(|law| Self { law })
    }

    /// The temperature at an instant [degC].
    #[inline(always)]
    pub fn at(&self, at: &ImposedWeather) -> S {
        self.law.temperature(at)
    }

    /// Whether it gives heat beside its temperature.
    pub(crate) fn gives_heat(&self) -> bool {
        self.law.row().gives_heat
    }

    /// Whether it gives the coefficient through which its temperature acts.
    pub(crate) fn gives_coefficient(&self) -> bool {
        self.law.row().gives_coefficient
    }

    /// Heat beside the temperature at an instant [W/m2], and the coefficient [W/(m2 K)]; none: the law does not give it.
    // One copy only: few buildings have such laws.
    #[inline(never)]
    pub(crate) fn beside(&self, at: &ImposedWeather) -> [Option<S>; 2] {
        let row = self.law.row();
        [row.gives_heat.then(|| self.law.heat(at)), row.gives_coefficient.then(|| self.law.coefficient(at))]
    }
}

/// What a law by the names of its numbers imposes on a day of the year, with outdoor air [degC]: the temperature [degC], heat [W/m2] and the
/// coefficient [W/(m2 K)], none where it does not give it.
///
/// # Errors
/// What was found and what was expected, for a kind or numbers that are none.
pub fn imposed_on(
    kind: &str,
    numbers: &[(&str, f64)],
    day: f64,
    outdoor_air: f64,
) -> Result<(f64, Option<f64>, Option<f64>), String> {
    use crate::input::description::ParamId;
    use crate::number::elementary::sincos;
    use crate::physics::law_row::unknown_kind;

    let ids: Vec<_> = (0..).zip(numbers).map(|(k, (name, _))| (*name, ParamId(k))).collect();
    let values: Vec<f64> = numbers.iter().map(|(_, value)| *value).collect();
    let law = PublishedLaw::new(kind, &ids);
    row(&law).ok_or_else(|| unknown_kind(&law))?.check(&law)?;
    let temperature = ImposedTemperature::new(&law, &Values::new(&values));
    let (sine, cosine) = sincos(day * imposed_law::PER_DAY);
    let at = ImposedWeather { season: [cosine, sine], outdoor_air };
    let law = temperature.ok_or_else(|| unknown_kind(&law))?;
    let [heat, coefficient] = law.beside(&at);
    Ok((law.at(&at), heat, coefficient))
}

#[cfg(test)]
pub(crate) mod testing {
    /// Temperature of a law on a day [degC].
    pub(crate) fn temperature(kind: &str, numbers: &[(&str, f64)], day: f64, outdoor_air: f64) -> f64 {
        super::imposed_on(kind, numbers, day, outdoor_air).unwrap().0
    }
}
