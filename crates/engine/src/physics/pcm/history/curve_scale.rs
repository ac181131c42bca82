//! Hysteresis `curve_scale`: on a reversal the material takes the other curve, scaled to what is left to melt or to freeze.
//!
//! Sources: see `two_curves.rs`. Its state: the solid over that of the melting curve, the liquid over that of the freezing
//! curve.

use super::law::{HistoryLaw, Ingredients, PcmHistory};
use super::two_curves::{TwoCurves, either};
use crate::number::real::Real;

/// Rounding of a fraction [-].
const ROUNDING: f64 = 1e-12;

/// The law with its curves.
#[derive(Debug, Clone)]
pub(crate) struct CurveScale<S>(TwoCurves<S>);

impl<S: Real> CurveScale<S> {
    #[inline(always)]
    fn after(&self, temperature: S, fraction: S) -> PcmHistory<S> {
        let [(melting, _), (freezing, _)] = self.0.at(temperature);
        let mut next = PcmHistory::new(fraction, temperature);
        next.model_state[0] = share(S::one() - fraction, S::one() - melting);
        next.model_state[1] = share(fraction, freezing);
        next
    }
}

impl<S: Real> HistoryLaw<S> for CurveScale<S> {
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
        let [(melting, melting_slope), (freezing, freezing_slope)] = self.0.at(temperature);
        let [solid, liquid, ..] = history.model_state;
        // Rounding may lead beyond the limits.
        let warmer = S::one() - solid * (S::one() - melting);
        let warmer = (warmer.max(S::zero()), solid * melting_slope);
        let colder = ((liquid * freezing).min(S::one()), liquid * freezing_slope);
        let heats = history.temperature.lt(temperature);
        let (fraction, slope) = either(heats, warmer, colder);
        let still = !heats & !temperature.lt(history.temperature);
        let fraction = S::select(still, history.liquid_fraction, fraction);
        (fraction, S::select(still, warmer.1.max(colder.1), slope))
    }

    #[inline(never)]
    fn next(&self, _: &PcmHistory<S>, temperature: S, fraction: S, _: f64) -> PcmHistory<S> {
        S::vectorised(
            #[inline(always)]
            || self.after(temperature, fraction),
        )
    }

    #[inline(never)]
    fn limit(&self, from: S, to: S, history: &PcmHistory<S>) -> S {
        S::vectorised(
            #[inline(always)]
            || self.0.limit(from, to, [history.temperature; 2]),
        )
    }

    fn width(&self) -> S {
        self.0.width()
    }

    fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let [solid, liquid, ..] = history.model_state;
        self.0.rising(temperature, [history.temperature; 2], [liquid, solid])
    }
}

/// What is solid, or liquid, over that of a curve. It is above one where curves of different shapes have led the fraction below
/// the melting or above the freezing curve: with less, the fraction would jump to the curve at the present temperature.
#[inline(always)]
fn share<S: Real>(present: S, of_curve: S) -> S {
    let share = present / of_curve.max(S::constant(ROUNDING));
    S::select(share.lt(S::constant(1.0 + ROUNDING)), share.min(S::one()), share)
}
