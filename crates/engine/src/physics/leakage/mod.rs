//! Infiltration by a pressure test, which gives `n50` [1/h], the air changes at 50 Pa between inside and outdoors: any of the laws of
//! [`laws`].

pub(crate) mod laws;
pub(crate) mod leakage_law;
pub(crate) mod prelude;

use crate::input::description::PublishedLaw;
use crate::input::values::Values;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::law_row::{LawEntry, LawRow, Numbers};
use laws::with_laws;
use leakage_law::LeakageLaw;

/// Defines `Leakage`, one variant for each file of `laws`.
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
                    $($kind => Some(Self::$law(<laws::$module::$law<S> as LeakageLaw<S>>::new(number))),)*
                    _ => None,
                }
            }

            fn constant(&self) -> Option<S> {
                match self {
                    $(Self::$law(law) => law.constant(),)*
                }
            }

            #[inline(always)]
            fn rate(&self, wind: S, difference: S) -> (S, S) {
                match self {
                    $(Self::$law(law) => law.rate(wind, difference),)*
                }
            }
        }

        /// All laws that a description has by name, in the order of their kinds.
        #[must_use]
        pub fn table() -> Vec<LawEntry> {
            vec![$(LawEntry::new($kind, <laws::$module::$law<f64> as LeakageLaw<f64>>::ROW)),*]
        }

        /// What a law says of itself; none for a kind that is no law.
        pub(crate) fn row(law: &PublishedLaw) -> Option<LawRow> {
            match law.kind.as_str() {
                $($kind => Some(<laws::$module::$law<f64> as LeakageLaw<f64>>::ROW),)*
                _ => None,
            }
        }
    };
}

with_laws!(laws);

/// Infiltration that wind and temperatures drive through the leaks of a pressure test.
#[derive(Debug, Clone)]
pub struct Leakage<S> {
    law: Law<S>,
}

impl<S: Real> Leakage<S> {
    /// Constant air changes [1/h], and the law of those that are not.
    ///
    /// # Panics
    /// For a kind that is no law: a plan refuses it.
    pub(crate) fn of(test: &PublishedLaw, values: &Values<'_, S>) -> (Option<S>, Option<Self>) {
        let law = Law::named(&test.kind, &Numbers::new(values, test)).expect("a plan knows its laws");
        match law.constant() {
            Some(rate) => (Some(rate), None),
            None => (None, Some(Self { law })),
        }
    }

    /// Air changes [1/h] at a difference between outdoors and the zone [K].
    #[inline(always)]
    pub(crate) fn air_changes(&self, wind: S, difference: S) -> S {
        self.law.rate(wind, difference).0
    }

    /// Heat that it brings into a zone, as its tangent in `d = T_outdoor - T_air`; `air_capacity` of its air [J/K].
    #[inline(always)]
    pub(crate) fn heat(&self, air_capacity: S, wind: S, outdoor: S, air: S) -> Line<S> {
        let d = outdoor - air;
        let per_second = air_capacity.scale(1.0 / 3600.0);
        let (rate, rise) = self.law.rate(wind, d);
        Line::tangent(per_second * rate * d, per_second * (rate + rise * d), d)
    }
}

/// Air changes [1/h] of a law by the names of its numbers, at a wind [m/s] and a difference between outdoors and the zone [K].
///
/// # Errors
/// What was found and what was expected, for a kind or numbers that are none.
pub fn air_changes_of(
    kind: &str,
    numbers: &[(&str, f64)],
    wind: f64,
    difference: f64,
) -> Result<f64, String> {
    use crate::input::description::ParamId;
    use crate::physics::law_row::unknown_kind;

    let ids: Vec<_> = (0..).zip(numbers).map(|(k, (name, _))| (*name, ParamId(k))).collect();
    let values: Vec<f64> = numbers.iter().map(|(_, value)| *value).collect();
    let law = PublishedLaw::new(kind, &ids);
    row(&law).ok_or_else(|| unknown_kind(&law))?.check(&law)?;
    let (constant, leakage) = Leakage::of(&law, &Values::new(&values));
    Ok(constant.unwrap_or(0.0) + leakage.map_or(0.0, |law| law.air_changes(wind, difference)))
}

#[cfg(test)]
pub(crate) mod testing {
    use super::Leakage;
    use crate::input::description::{ParamId, PublishedLaw};
    use crate::input::values::Values;

    /// A law with these numbers.
    pub(crate) fn leakage(kind: &str, numbers: &[(&str, f64)]) -> (Option<f64>, Option<Leakage<f64>>) {
        let ids: Vec<_> = (0..).zip(numbers).map(|(k, (name, _))| (*name, ParamId(k))).collect();
        let values: Vec<f64> = numbers.iter().map(|(_, value)| *value).collect();
        Leakage::of(&PublishedLaw::new(kind, &ids), &Values::new(&values))
    }
}
