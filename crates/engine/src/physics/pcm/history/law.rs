//! What a law with a state is made of: the numbers that a cell carries, those that the law is given, and the trait.
//!
//! Within a stage the liquid fraction is a function of temperature that never falls, given the history; the history changes
//! once per accepted step.

use crate::input::description::FormulaNumber;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::pcm::curve::Curve;

/// How many numbers a law has for its own use.
pub const MODEL_STATE: usize = 3;

/// Count of the numbers of a history.
pub(crate) const HISTORY_NUMBERS: usize = 2 + MODEL_STATE;

/// What a phase-change cell carries from step to step. Changes once per accepted step; a law with a rate reads a copy of it
/// within a stage, see `HistoryLaw::in_stage`.
#[derive(Debug, Clone, Copy)]
pub struct PcmHistory<S> {
    /// Liquid fraction at the end of the last accepted step [-].
    pub liquid_fraction: S,
    /// Temperature there [degC].
    pub temperature: S,
    /// What the law needs beside, see its file; zeros without one.
    pub model_state: [S; MODEL_STATE],
}

impl<S: Real> PcmHistory<S> {
    /// A history of a fraction and a temperature alone.
    #[inline(always)]
    pub fn new(liquid_fraction: S, temperature: S) -> Self {
        Self { liquid_fraction, temperature, model_state: [S::zero(); MODEL_STATE] }
    }

    /// All its numbers.
    pub(crate) fn numbers(&self) -> [S; HISTORY_NUMBERS] {
        let mut numbers = [self.liquid_fraction; HISTORY_NUMBERS];
        numbers[1] = self.temperature;
        numbers[2..].copy_from_slice(&self.model_state);
        numbers
    }

    /// Changes each number by one of others, in the order of [`Self::numbers`].
    #[inline(always)]
    pub(crate) fn read<T: Copy>(
        &mut self,
        numbers: &[T; HISTORY_NUMBERS],
        change: &mut impl FnMut(&mut S, T),
    ) {
        change(&mut self.liquid_fraction, numbers[0]);
        change(&mut self.temperature, numbers[1]);
        for (mine, &theirs) in self.model_state.iter_mut().zip(&numbers[2..]) {
            change(mine, theirs);
        }
    }

    /// Takes the lanes of another history where the mask is true.
    #[inline(always)]
    pub fn take(&mut self, mask: S::Mask, other: &Self) {
        self.read(&other.numbers(), &mut |mine, theirs| *mine = S::select(mask, theirs, *mine));
    }
}

/// The numbers and curves that a law is made of.
pub(crate) struct Ingredients<'v, S> {
    pub(crate) values: &'v Values<'v, S>,
    pub(crate) curves: Vec<Curve<S>>,
    pub(crate) numbers: &'v [FormulaNumber],
}

impl<S: Real> Ingredients<'_, S> {
    /// A number by its name.
    pub(super) fn number(&self, name: &str) -> Option<S> {
        self.numbers.iter().find(|number| number.name == name).map(|number| self.values.get(number.value))
    }

    /// A number that [`HistoryLaw::NUMBERS`] says every description has: the check has refused one without it.
    pub(super) fn required(&self, name: &str) -> S {
        self.number(name).expect("the check of a description finds the numbers of its laws")
    }
}

/// The same history at the start of a stage.
#[derive(Debug, Clone, Copy)]
pub struct StageStart<S> {
    /// Length of the step, or of the part of a step; zero where no time passes [s].
    pub step: f64,
    /// Effective length of the stage over that of the step [-].
    pub diagonal: f64,
    /// Of the second stage: the fraction at the end of the first one, and the ratio of the scheme.
    pub first: Option<(S, f64)>,
}

/// A law with a state of its own.
pub(crate) trait HistoryLaw<S: Real>: Sized {
    /// Numbers that it cannot do without, and others that it may have.
    const NUMBERS: &'static [&'static str];
    const OPTIONAL: &'static [&'static str] = &[];
    /// How many curves of the liquid fraction it has.
    const CURVES: usize = 1;
    /// Whether it knows the time: its history is read by way of [`Self::in_stage`].
    const HAS_RATE: bool;

    /// Takes its numbers.
    fn new(ingredients: Ingredients<'_, S>) -> Self;

    /// The history of a cell that was heated to a temperature.
    fn begin(&self, temperature: S) -> PcmHistory<S>;

    /// Liquid fraction and its slope [1/K] at a temperature [degC]. Where the slope jumps it is the larger one.
    fn at(&self, temperature: S, history: &PcmHistory<S>) -> (S, S);

    /// The history that [`Self::at`] reads within a stage.
    fn in_stage(&self, history: &PcmHistory<S>, _: &StageStart<S>) -> PcmHistory<S> {
        *history
    }

    /// The history after a step of a length [s] that ended at a temperature with a liquid fraction.
    fn next(&self, history: &PcmHistory<S>, temperature: S, fraction: S, step: f64) -> PcmHistory<S>;

    /// The same history with all that [`Self::rising`] needs.
    fn complete(&self, history: &PcmHistory<S>) -> PcmHistory<S> {
        *history
    }

    /// Ends a Newton step that crosses the steepest place of the fraction there, see
    /// [`PcmCoefficients::limit`](super::PcmCoefficients::limit).
    fn limit(&self, from: S, to: S, history: &PcmHistory<S>) -> S;

    /// Half-width of the melting range [K].
    fn width(&self) -> S;

    /// The convex part of the fraction and its slope, see [`PcmCoefficients::rising`](super::PcmCoefficients::rising).
    fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S);
}

/// Whether a fraction rose in the first part of a step and fell in the second, or the reverse.
#[inline(always)]
pub fn reversed<S: Real>(start: S, midway: S, end: S) -> S::Mask {
    // Smaller changes are round-off.
    let threshold = S::constant(1e-12);
    let (before, after) = (midway - start, end - midway);
    (before * after).lt(S::zero()) & threshold.lt(before.abs()) & threshold.lt(after.abs())
}
