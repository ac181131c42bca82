//! Hysteresis `curve_switch`: on a reversal the liquid fraction stays until the other curve is met.
//!
//! Sources: see `two_curves.rs`. Its state: the temperatures at which the freezing and the melting curve have the present
//! fraction [degC].

use super::law::{HistoryLaw, Ingredients, MODEL_STATE, PcmHistory};
use super::two_curves::{FAR, TwoCurves};
use crate::number::real::{Mask, Real};
use crate::physics::pcm::curve::Curve;

/// The law with its curves.
#[derive(Debug, Clone)]
pub(crate) struct CurveSwitch<S>(TwoCurves<S>);

/// The state of a law: the temperatures, and nothing more.
#[inline(always)]
fn state<S: Real>([freezes, melts]: [S; 2]) -> [S; MODEL_STATE] {
    let mut state = [S::zero(); MODEL_STATE];
    (state[0], state[1]) = (freezes, melts);
    state
}

/// Up to which temperature the material freezes and from which it melts [degC].
#[inline(always)]
fn thresholds<S: Real>(history: &PcmHistory<S>) -> [S; 2] {
    [history.model_state[0], history.model_state[1]]
}

impl<S: Real> CurveSwitch<S> {
    /// Computes the temperatures that are needed and not known.
    #[inline(always)]
    fn complete_temperatures(&self, fraction: S, known: [S; 2], needed: S::Mask) -> [S; 2] {
        let far = S::constant(0.5 * FAR);
        let missing = [needed & far.lt(known[0]), needed & known[1].lt(-far)];
        let search = |mask: S::Mask, curve: &Curve<S>, side: usize| {
            if mask.any() {
                S::select(mask, curve.temperatures_of(fraction)[side], known[side])
            } else {
                known[side]
            }
        };
        // Each on the side on which its curve holds: a step limited to it meets the slope beyond it.
        [search(missing[0], &self.0.cooling, 0), search(missing[1], &self.0.heating, 1)]
    }

    #[inline(always)]
    fn after(&self, history: &PcmHistory<S>, temperature: S, fraction: S) -> PcmHistory<S> {
        let [first, second] = thresholds(history);
        let [(melting, _), (freezing, _)] = self.0.at(temperature);
        // On a curve its own temperature is the present one, and that of the other curve is not needed yet.
        let (melts, freezes) = (!melting.lt(fraction), !fraction.lt(freezing));
        let on = melts | freezes;
        let far = S::constant(FAR);
        let first = S::select(freezes, temperature, S::select(on, far, first));
        let second = S::select(melts, temperature, S::select(on, -far, second));
        let model_state = state(self.complete_temperatures(fraction, [first, second], !on));
        PcmHistory { liquid_fraction: fraction, temperature, model_state }
    }
}

impl<S: Real> HistoryLaw<S> for CurveSwitch<S> {
    const NUMBERS: &'static [&'static str] = &[];
    const CURVES: usize = 2;
    const HAS_RATE: bool = false;

    fn new(ingredients: Ingredients<'_, S>) -> Self {
        Self(TwoCurves::new(ingredients))
    }

    fn begin(&self, temperature: S) -> PcmHistory<S> {
        let fraction = self.0.heating.compact(temperature).0;
        let model_state = state([-S::constant(FAR), S::constant(FAR)]);
        let history = PcmHistory { liquid_fraction: fraction, temperature, model_state };
        self.next(&history, temperature, fraction, 0.0)
    }

    #[inline(always)]
    fn at(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let [(melting, melting_slope), (freezing, freezing_slope)] = self.0.at(temperature);
        let held = history.liquid_fraction;
        let (melts, freezes) = (!melting.lt(held), !held.lt(freezing));
        let up = S::select(melts, melting_slope, S::zero());
        let down = S::select(freezes, freezing_slope, S::zero());
        (melting.max(freezing.min(held)), up.max(down))
    }

    #[inline(never)]
    fn next(&self, history: &PcmHistory<S>, temperature: S, fraction: S, _: f64) -> PcmHistory<S> {
        S::vectorised(
            #[inline(always)]
            || self.after(history, temperature, fraction),
        )
    }

    fn complete(&self, history: &PcmHistory<S>) -> PcmHistory<S> {
        let all = S::Mask::splat(true);
        let complete = self.complete_temperatures(history.liquid_fraction, thresholds(history), all);
        PcmHistory { model_state: state(complete), ..*history }
    }

    #[inline(never)]
    fn limit(&self, from: S, to: S, history: &PcmHistory<S>) -> S {
        S::vectorised(
            #[inline(always)]
            || self.0.limit(from, to, thresholds(history)),
        )
    }

    fn width(&self) -> S {
        self.0.width()
    }

    fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        self.0.rising(temperature, thresholds(history), [S::one(); 2])
    }
}
