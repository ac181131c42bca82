//! Hysteresis `curve_track`: on a reversal the material stays on its curve until all has melted or frozen.
//!
//! Sources: see `two_curves.rs`. Its state: 1 on the freezing curve, else 0.

use super::law::{HistoryLaw, Ingredients, PcmHistory};
use super::two_curves::{FAR, TwoCurves, either};
use crate::number::real::Real;

/// The law with its curves.
#[derive(Debug, Clone)]
pub(crate) struct CurveTrack<S>(TwoCurves<S>);

/// Both curves hold everywhere.
#[inline(always)]
fn everywhere<S: Real>() -> [S; 2] {
    [S::constant(FAR), -S::constant(FAR)]
}

impl<S: Real> HistoryLaw<S> for CurveTrack<S> {
    const NUMBERS: &'static [&'static str] = &[];
    const CURVES: usize = 2;
    const HAS_RATE: bool = false;

    fn new(ingredients: Ingredients<'_, S>) -> Self {
        Self(TwoCurves::new(ingredients))
    }

    fn begin(&self, temperature: S) -> PcmHistory<S> {
        let fraction = self.0.heating.compact(temperature).0;
        self.next(&PcmHistory::new(fraction, temperature), temperature, fraction, 0.0)
    }

    #[inline(always)]
    fn at(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let [melting, freezing] = self.0.at(temperature);
        let cools = S::constant(0.5).lt(history.model_state[0]);
        either(cools, freezing, melting)
    }

    #[inline(never)]
    fn next(&self, history: &PcmHistory<S>, temperature: S, fraction: S, _: f64) -> PcmHistory<S> {
        let molten = !fraction.lt(S::one());
        let frozen = !S::zero().lt(fraction);
        let mut next = PcmHistory::new(fraction, temperature);
        next.model_state[0] =
            S::select(molten, S::one(), S::select(frozen, S::zero(), history.model_state[0]));
        next
    }

    #[inline(never)]
    fn limit(&self, from: S, to: S, _: &PcmHistory<S>) -> S {
        S::vectorised(
            #[inline(always)]
            || self.0.limit(from, to, everywhere()),
        )
    }

    fn width(&self) -> S {
        self.0.width()
    }

    fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let [frozen, molten] = self.0.convex(temperature, everywhere());
        either(S::constant(0.5).lt(history.model_state[0]), frozen, molten)
    }
}
