//! Laws whose liquid fraction depends on what went before: the list of them.
//!
//! Such a law is one file beside this one that implements [`HistoryLaw`], and its lines here; the guide is `docs/engine.md`.

mod curve_scale;
mod curve_switch;
mod curve_track;
mod law;
mod supercooling;
pub(super) mod two_curves;

use crate::input::description::FormulaNumber;
use crate::number::real::Real;
use curve_scale::CurveScale;
use curve_switch::CurveSwitch;
use curve_track::CurveTrack;
use law::HistoryLaw;
use supercooling::Supercooling;

pub(crate) use law::HISTORY_NUMBERS;
pub(super) use law::Ingredients;
pub use law::{MODEL_STATE, PcmHistory, StageStart, reversed};

/// Checks what a description gives a law against what it needs.
fn check_parts(
    name: &str,
    (curves, count): (usize, usize),
    numbers: &[FormulaNumber],
    [needed, optional]: [&[&str]; 2],
) -> Result<(), String> {
    if curves != count {
        return Err(format!("found {curves} curves for the law '{name}', expected {count}"));
    }
    let given = |name: &&&str| numbers.iter().any(|number| number.name == **name);
    if let Some(missing) = needed.iter().find(|name| !given(name)) {
        return Err(format!("found no number '{missing}' for the law '{name}', expected one"));
    }
    let names = || needed.iter().chain(optional);
    match numbers.iter().find(|number| !names().any(|name| *name == number.name)) {
        Some(number) => {
            let names: Vec<&str> = names().copied().collect();
            let expected = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Err(format!("found the number '{}' for the law '{name}', expected {expected}", number.name))
        }
        None => Ok(()),
    }
}

/// The laws, each a module of the name that descriptions give it: an enum, its dispatch, and the table of names that descriptions are checked by.
macro_rules! history_laws {
    ($($module:ident: $law:ident),* $(,)?) => {
        /// Any of the laws.
        #[derive(Debug, Clone)]
        pub(super) enum AnyHistoryLaw<S> {
            $($law(Box<$law<S>>)),*
        }

        impl<S: Real> AnyHistoryLaw<S> {
            /// The law of a name.
            pub(super) fn new(name: &str, ingredients: Ingredients<'_, S>) -> Option<Self> {
                match name {
                    $(stringify!($module) => Some(Self::$law(Box::new($law::new(ingredients)))),)*
                    _ => None,
                }
            }

            history_laws!(@each $($law)*;
                #[inline(always)] fn at(temperature: S, history: &PcmHistory<S>) -> (S, S);
                fn begin(temperature: S) -> PcmHistory<S>;
                #[inline(always)] fn in_stage(history: &PcmHistory<S>, start: &StageStart<S>) -> PcmHistory<S>;
                #[inline(always)] fn next(history: &PcmHistory<S>, temperature: S, fraction: S, step: f64) -> PcmHistory<S>;
                fn complete(history: &PcmHistory<S>) -> PcmHistory<S>;
                #[inline(always)] fn limit(from: S, to: S, history: &PcmHistory<S>) -> S;
                fn width() -> S;
                fn rising(temperature: S, history: &PcmHistory<S>) -> (S, S);
            );

            /// Whether it knows the time.
            pub(super) fn has_rate(&self) -> bool {
                match self {
                    $(Self::$law(_) => <$law<S> as HistoryLaw<S>>::HAS_RATE),*
                }
            }
        }

        /// Checks the name, the count of curves and the names of the numbers of a law.
        pub(crate) fn check(name: &str, curves: usize, numbers: &[FormulaNumber]) -> Result<(), String> {
            type Law<T> = T;
            match name {
                $(stringify!($module) => check_parts(
                    name,
                    (curves, <Law<$law<f64>> as HistoryLaw<f64>>::CURVES),
                    numbers,
                    [<$law<f64> as HistoryLaw<f64>>::NUMBERS, <$law<f64> as HistoryLaw<f64>>::OPTIONAL],
                ),)*
                _ => Err(format!("found the law '{name}', expected one of {}", [$(stringify!($module)),*].join(", "))),
            }
        }
    };
    (@each $($law:ident)*; ) => {};
    (@each $($law:ident)*; $(#[$inline:meta])? fn $method:ident($($argument:ident: $kind:ty),*) -> $result:ty; $($rest:tt)*) => {
        $(#[$inline])?
        pub(super) fn $method(&self, $($argument: $kind),*) -> $result {
            history_laws!(@match self $method ($($argument),*) $($law)*)
        }
        history_laws!(@each $($law)*; $($rest)*);
    };
    (@match $self:ident $method:ident $arguments:tt $($law:ident)*) => {
        match $self {
            $(Self::$law(law) => history_laws!(@call law $method $arguments)),*
        }
    };
    (@call $of:ident $method:ident ($($argument:ident),*)) => { $of.$method($($argument),*) };
}

history_laws! {
    curve_track: CurveTrack,
    curve_switch: CurveSwitch,
    curve_scale: CurveScale,
    supercooling: Supercooling,
}
