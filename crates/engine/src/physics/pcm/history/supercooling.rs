//! Supercooling: what has melted wholly stays liquid below its melting temperature until it nucleates, and then crystallises
//! at a finite rate; the heat that this sets free warms it back into its melting range (recalescence).
//!
//! 1. Without crystals (all was liquid) the liquid fraction `xi` is 1 down to the nucleation temperature `Tm - degree`.
//! 2. With crystals `d xi/dt = -K (xi - f(T))` where the curve of melting `f(T)` lies below `xi`: kinetics of first order,
//!    Avrami's exponent 1, towards the equilibrium. `K` is `1/time_constant`, or `rate (Te - T)` with the undercooling below
//!    the end `Te` of the melting range: growth proportional to the undercooling. Melting follows the curve without delay.
//!
//! With a time constant of zero, or a rate without bounds, what has crystals freezes as it melts. Who has not melted wholly
//! keeps crystals and does not supercool. Each finite volume nucleates by itself.
//!
//! Sources: states and nucleation: Guenther, Mehling & Hiebler (2007), Modelling Simul. Mater. Sci. Eng. 15(8), 879-892,
//! doi:10.1088/0965-0393/15/8/005; Davin, Lefez & Guillet (2020), Int. J. Therm. Sci. 147, 106121,
//! doi:10.1016/j.ijthermalsci.2019.106121. Kinetics with a rate that depends on temperature: Nakamura et al. (1972), J. Appl.
//! Polym. Sci. 16(5), 1077-1091, doi:10.1002/app.1972.070160503; growth proportional to the undercooling: Uzan et al. (2017), Int. J. Heat
//! Mass Transf. 106, 91-102.
//!
//! In time the fraction goes with the stages of the scheme: `xi - g dt d xi/dt = xi_n + ratio (xi_1 - xi_n)` at the temperature
//! of the stage. The nucleation falls into a step: what is left of that step after it (by the straight line between the
//! temperatures at its ends) is made up for by the kinetics of the next step, so that time of nucleation and results change
//! continuously with all parameters, and the error falls with the square of the step.

use super::law::{HistoryLaw, Ingredients, PcmHistory, StageStart};
use super::two_curves::{FAR, either};
use crate::number::real::Real;
use crate::physics::pcm::curve::{Curve, limit_at};

/// Places of the state: whether there are crystals (1 or 0), the time after the nucleation that the step did not count, and
/// within a stage the time that the kinetics act [s].
const CRYSTALS: usize = 0;
const LEFT_OVER: usize = 1;
const DURATION: usize = 2;

/// The law with its numbers.
#[derive(Debug, Clone)]
pub(crate) struct Supercooling<S> {
    curve: Curve<S>,
    /// Temperature at which it nucleates [degC].
    nucleation: S,
    kinetics: Kinetics<S>,
}

#[derive(Debug, Clone)]
enum Kinetics<S> {
    /// [s].
    TimeConstant(S),
    /// By the undercooling [1/(s K)] below the end of melting [degC].
    Rate(S, S),
}

impl<S: Real> Kinetics<S> {
    /// What is left of the distance from equilibrium after a duration [s] of an implicit stage, and its slope [1/K].
    #[inline(always)]
    fn linearization_error(&self, temperature: S, duration: S) -> (S, S) {
        match self {
            Self::TimeConstant(constant) => {
                let sum = (*constant + duration).max(S::constant(f64::MIN_POSITIVE));
                (*constant / sum, S::zero())
            }
            Self::Rate(rate, end) => {
                let product = duration * *rate;
                let undercooling = (*end - temperature).max(S::zero());
                let linearization_error = S::one() / (S::one() + product * undercooling);
                let cold = temperature.lt(*end);
                (
                    linearization_error,
                    S::select(cold, linearization_error * linearization_error * product, S::zero()),
                )
            }
        }
    }
}

impl<S: Real> Supercooling<S> {
    /// Whether there are crystals.
    #[inline(always)]
    fn crystals(history: &PcmHistory<S>) -> S::Mask {
        S::constant(0.5).lt(history.model_state[CRYSTALS])
    }
}

impl<S: Real> HistoryLaw<S> for Supercooling<S> {
    const NUMBERS: &'static [&'static str] = &["degree"];
    const OPTIONAL: &'static [&'static str] = &["time_constant", "rate"];
    const HAS_RATE: bool = true;

    fn new(mut ingredients: Ingredients<'_, S>) -> Self {
        let (degree, rate) = (ingredients.required("degree"), ingredients.number("rate"));
        let constant = ingredients.number("time_constant").unwrap_or_else(S::zero);
        let curve = ingredients.curves.remove(0);
        let kinetics = match rate {
            Some(rate) => Kinetics::Rate(rate, curve.support()[1]),
            None => Kinetics::TimeConstant(constant),
        };
        Self { nucleation: curve.reference() - degree, curve, kinetics }
    }

    /// Crystals, unless all is liquid.
    fn begin(&self, temperature: S) -> PcmHistory<S> {
        let fraction = self.curve.compact(temperature).0;
        let mut history = PcmHistory::new(fraction, temperature);
        history.model_state[CRYSTALS] = S::select(fraction.lt(S::one()), S::one(), S::zero());
        history
    }

    #[inline(always)]
    fn at(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let (melting, slope) = self.curve.compact(temperature);
        let (linearization_error, remainder_slope) =
            self.kinetics.linearization_error(temperature, history.model_state[DURATION]);
        let excess = history.liquid_fraction - melting;
        let freezing = (
            melting + excess * linearization_error,
            slope * (S::one() - linearization_error) + excess * remainder_slope,
        );
        let with_crystals = either(S::zero().lt(excess), freezing, (melting, slope));
        either(Self::crystals(history), with_crystals, (S::one(), S::zero()))
    }

    /// What freezes is extrapolated to the second stage as its scheme has it; what has melted stays so.
    #[inline(always)]
    fn in_stage(&self, history: &PcmHistory<S>, start: &StageStart<S>) -> PcmHistory<S> {
        let mut stage = *history;
        if let Some((first, ratio)) = start.first {
            let change = first - history.liquid_fraction;
            let frozen = history.liquid_fraction + change.scale(ratio);
            let fraction = S::select(change.lt(S::zero()), frozen, first);
            stage.liquid_fraction = fraction.max(S::zero()).min(S::one());
        }
        let passes = start.step > 0.0;
        let duration = S::constant(start.step) + history.model_state[LEFT_OVER];
        stage.model_state[DURATION] = if passes { duration.scale(start.diagonal) } else { S::zero() };
        stage
    }

    #[inline(always)]
    fn next(&self, history: &PcmHistory<S>, temperature: S, fraction: S, step: f64) -> PcmHistory<S> {
        let mut next = PcmHistory::new(fraction, temperature);
        let (molten, nucleates) = (!fraction.lt(S::one()), temperature.lt(self.nucleation));
        // Where it nucleates within the step, by the straight line of the temperature.
        let begins = nucleates & !Self::crystals(history);
        let fall = S::select(begins, history.temperature - temperature, S::one());
        let beneath = (self.nucleation - temperature).max(S::zero());
        let share = (beneath / fall.max(beneath).max(S::constant(f64::MIN_POSITIVE))).min(S::one());
        next.model_state[LEFT_OVER] = S::select(begins, share.scale(step), S::zero());
        next.model_state[CRYSTALS] = S::select(molten & !nucleates, S::zero(), S::one());
        next
    }

    #[inline(never)]
    fn limit(&self, from: S, to: S, _: &PcmHistory<S>) -> S {
        S::vectorised(
            #[inline(always)]
            || limit_at(from, to, self.curve.peak(), self.curve.width()),
        )
    }

    fn width(&self) -> S {
        self.curve.width()
    }

    /// Below the temperature at which the curve has the fraction of the start it freezes along a share of the curve, above it
    /// melts along the whole of it. By the rate the share is that at the temperature.
    fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let far = S::constant(FAR);
        let [_, meets] = self.curve.temperatures_of(history.liquid_fraction);
        let (linearization_error, remainder_slope) =
            self.kinetics.linearization_error(temperature, history.model_state[DURATION]);
        let (all, all_slope) = self.curve.convex(temperature, [-far, far]);
        let (molten, molten_slope) = self.curve.convex(temperature, [meets, far]);
        // As `at` has it, so that both have their corner at the same number.
        let melts = !S::zero().lt(history.liquid_fraction - self.curve.compact(temperature).0);
        let begun = self.curve.compact(meets).0;
        let (more, more_slope) = either(melts, (molten - begun, molten_slope), (S::zero(), S::zero()));
        let value = all + linearization_error * (more - all);
        let slope =
            all_slope + linearization_error * (more_slope - all_slope) + remainder_slope * (more - all);
        either(Self::crystals(history), (value, slope), (S::one(), S::zero()))
    }
}
