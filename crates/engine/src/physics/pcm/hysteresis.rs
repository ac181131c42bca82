//! Rate-independent hysteresis: one curve for melting, another for freezing, and what lies between.
//!
//! Within a step the liquid fraction is a function of temperature alone, given what the cell remembers of the step's
//! start; that function never falls. Sources: Barz et al. (2019), J. Build. Perf. Simul. 12(6),
//! doi:10.1080/19401493.2019.1657953; Barz et al. (2021), J. Energy Storage 34, doi:10.1016/j.est.2020.101907.

use super::curve::{Curve, limit_at};
use crate::input::description::{HysteresisModel, MeltingCurve};
use crate::input::values::Values;
use crate::number::real::{Mask, Real};

/// A temperature beyond all others, for a mark that is not known [degC].
pub(super) const FAR: f64 = 1e100;

/// Rounding of a fraction [-].
const LEAST: f64 = 1e-12;

/// Count of the numbers of a memory.
pub(crate) const REMEMBERED: usize = 4;

/// What a phase-change cell remembers between steps. Changes once per accepted step;
/// both stages of a step read the memory as it stood at the step's start.
#[derive(Debug, Clone, Copy)]
pub struct PcmMemory<S> {
    /// Liquid fraction at the end of the last accepted step [-].
    pub liquid_fraction: S,
    /// Temperature there [degC].
    pub temperature: S,
    /// What the model of hysteresis needs beside; zeros without one.
    ///
    /// `curve_track`: 1 on the freezing curve, else 0. `curve_switch`: the temperatures at which the freezing and the
    /// melting curve have the present fraction. `curve_scale`: the solid over that of the melting curve, the liquid
    /// over that of the freezing curve.
    pub marks: [S; 2],
}

impl<S: Real> PcmMemory<S> {
    /// A memory of a fraction and a temperature alone.
    #[inline(always)]
    pub fn new(liquid_fraction: S, temperature: S) -> Self {
        Self { liquid_fraction, temperature, marks: [S::zero(); 2] }
    }

    /// All its numbers.
    pub(crate) fn numbers(&self) -> [S; REMEMBERED] {
        [self.liquid_fraction, self.temperature, self.marks[0], self.marks[1]]
    }

    /// Changes each number by one of others, in the order of [`Self::numbers`].
    #[inline(always)]
    pub(crate) fn read<T>(&mut self, numbers: [T; REMEMBERED], change: &mut impl FnMut(&mut S, T)) {
        let [fraction, temperature, first, second] = numbers;
        change(&mut self.liquid_fraction, fraction);
        change(&mut self.temperature, temperature);
        change(&mut self.marks[0], first);
        change(&mut self.marks[1], second);
    }

    /// Takes the lanes of another memory where the mask is true.
    #[inline(always)]
    pub fn take(&mut self, mask: S::Mask, other: &Self) {
        let blend = |a: &mut S, b: S| *a = S::select(mask, b, *a);
        blend(&mut self.liquid_fraction, other.liquid_fraction);
        blend(&mut self.temperature, other.temperature);
        blend(&mut self.marks[0], other.marks[0]);
        blend(&mut self.marks[1], other.marks[1]);
    }
}

/// Two curves and a model.
#[derive(Debug, Clone)]
pub(super) struct Hysteresis<S> {
    model: HysteresisModel,
    heating: Curve<S>,
    cooling: Curve<S>,
}

impl<S: Real> Hysteresis<S> {
    pub(super) fn new(
        values: &Values<'_, S>,
        model: HysteresisModel,
        heating: &MeltingCurve,
        cooling: &MeltingCurve,
    ) -> Self {
        Self { model, heating: Curve::new(values, heating), cooling: Curve::new(values, cooling) }
    }

    /// Fraction and slope of the melting and of the freezing curve. Where parameters vary so far that the curves cross,
    /// the freezing curve is the melting curve.
    #[inline(always)]
    fn curves(&self, temperature: S) -> [(S, S); 2] {
        let melting = self.heating.compact(temperature);
        let freezing = self.cooling.compact(temperature);
        let crossed = freezing.0.lt(melting.0);
        let (fraction, slope) =
            (S::select(crossed, melting.0, freezing.0), S::select(crossed, melting.1, freezing.1));
        [melting, (fraction, slope)]
    }

    /// The memory of a cell that was heated to a temperature.
    pub(super) fn begin(&self, temperature: S) -> PcmMemory<S> {
        let fraction = self.heating.compact(temperature).0;
        let memory = PcmMemory::new(fraction, temperature);
        let known = match self.model {
            HysteresisModel::CurveSwitch => [-S::constant(FAR), S::constant(FAR)],
            HysteresisModel::CurveTrack | HysteresisModel::CurveScale => [S::zero(); 2],
        };
        self.next(&PcmMemory { marks: known, ..memory }, temperature, fraction)
    }

    /// Liquid fraction and its slope [1/K]. Where the slope jumps it is the larger one.
    #[inline(always)]
    pub(super) fn at(&self, temperature: S, memory: &PcmMemory<S>) -> (S, S) {
        let [(melting, melting_slope), (freezing, freezing_slope)] = self.curves(temperature);
        let either = |mask, a: (S, S), b: (S, S)| (S::select(mask, a.0, b.0), S::select(mask, a.1, b.1));
        let [first, second] = memory.marks;
        match self.model {
            HysteresisModel::CurveTrack => {
                let cools = S::constant(0.5).lt(first);
                either(cools, (freezing, freezing_slope), (melting, melting_slope))
            }
            HysteresisModel::CurveSwitch => {
                let held = memory.liquid_fraction;
                let (melts, freezes) = (!melting.lt(held), !held.lt(freezing));
                let up = S::select(melts, melting_slope, S::zero());
                let down = S::select(freezes, freezing_slope, S::zero());
                (melting.max(freezing.min(held)), up.max(down))
            }
            HysteresisModel::CurveScale => {
                // Rounding may lead beyond the limits.
                let warmer = S::one() - first * (S::one() - melting);
                let warmer = (warmer.max(S::zero()), first * melting_slope);
                let colder = ((second * freezing).min(S::one()), second * freezing_slope);
                let heats = memory.temperature.lt(temperature);
                let (fraction, slope) = either(heats, warmer, colder);
                let still = !heats & !temperature.lt(memory.temperature);
                let fraction = S::select(still, memory.liquid_fraction, fraction);
                (fraction, S::select(still, warmer.1.max(colder.1), slope))
            }
        }
    }

    /// The memory after a step that ended at a temperature with a fraction.
    #[inline(never)]
    pub(super) fn next(&self, memory: &PcmMemory<S>, temperature: S, fraction: S) -> PcmMemory<S> {
        S::vectorised(
            #[inline(always)]
            || self.memory_after(memory, temperature, fraction),
        )
    }

    #[inline(always)]
    fn memory_after(&self, memory: &PcmMemory<S>, temperature: S, fraction: S) -> PcmMemory<S> {
        let [first, second] = memory.marks;
        let [(melting, _), (freezing, _)] = self.curves(temperature);
        let marks = match self.model {
            HysteresisModel::CurveTrack => {
                let molten = !fraction.lt(S::one());
                let frozen = !S::zero().lt(fraction);
                [S::select(molten, S::one(), S::select(frozen, S::zero(), first)), S::zero()]
            }
            HysteresisModel::CurveSwitch => {
                // On a curve its own mark is the present temperature, and that of the other curve is not needed yet.
                let (melts, freezes) = (!melting.lt(fraction), !fraction.lt(freezing));
                let on = melts | freezes;
                let far = S::constant(FAR);
                let first = S::select(freezes, temperature, S::select(on, far, first));
                let second = S::select(melts, temperature, S::select(on, -far, second));
                self.marked(fraction, [first, second], !on)
            }
            HysteresisModel::CurveScale => {
                [share(S::one() - fraction, S::one() - melting), share(fraction, freezing)]
            }
        };
        PcmMemory { liquid_fraction: fraction, temperature, marks }
    }

    /// Computes the marks of `curve_switch` that are needed and not known.
    #[inline(always)]
    fn marked(&self, fraction: S, marks: [S; 2], needed: S::Mask) -> [S; 2] {
        let far = S::constant(0.5 * FAR);
        let missing = [needed & far.lt(marks[0]), needed & marks[1].lt(-far)];
        let find = |mask: S::Mask, curve: &Curve<S>, side: usize| {
            if mask.any() {
                S::select(mask, curve.temperatures_of(fraction)[side], marks[side])
            } else {
                marks[side]
            }
        };
        // Each on the side on which its curve holds: a step limited to it finds the slope beyond it.
        [find(missing[0], &self.cooling, 0), find(missing[1], &self.heating, 1)]
    }

    /// The same memory with all marks known.
    pub(super) fn complete(&self, memory: &PcmMemory<S>) -> PcmMemory<S> {
        match self.model {
            HysteresisModel::CurveSwitch => PcmMemory {
                marks: self.marked(memory.liquid_fraction, memory.marks, S::Mask::splat(true)),
                ..*memory
            },
            HysteresisModel::CurveTrack | HysteresisModel::CurveScale => *memory,
        }
    }

    /// Up to which temperature the material freezes and from which it melts, starting from the memory [degC].
    #[inline(always)]
    fn thresholds(&self, memory: &PcmMemory<S>) -> [S; 2] {
        match self.model {
            HysteresisModel::CurveTrack => [S::constant(FAR), -S::constant(FAR)],
            HysteresisModel::CurveSwitch => memory.marks,
            HysteresisModel::CurveScale => [memory.temperature; 2],
        }
    }

    /// Temperatures of the largest capacity on freezing and on melting [degC].
    #[inline(always)]
    fn peaks(&self, memory: &PcmMemory<S>) -> [S; 2] {
        let [colder, warmer] = self.thresholds(memory);
        [self.cooling.peak().min(colder), self.heating.peak().max(warmer)]
    }

    /// See [`PcmCoefficients::limit`](super::PcmCoefficients::limit).
    #[inline(never)]
    pub(super) fn limit(&self, from: S, to: S, memory: &PcmMemory<S>) -> S {
        S::vectorised(
            #[inline(always)]
            || {
                let [freezing, melting] = self.peaks(memory);
                let to = limit_at(from, to, freezing, self.cooling.width());
                limit_at(from, to, melting, self.heating.width())
            },
        )
    }

    /// Half-width of the narrower curve [K].
    pub(super) fn width(&self) -> S {
        self.heating.width().min(self.cooling.width())
    }

    /// The convex part of the fraction and its slope: those of both curves where they hold. The memory must be complete.
    pub(super) fn rising(&self, temperature: S, memory: &PcmMemory<S>) -> (S, S) {
        let [first, second] = memory.marks;
        let [colder, warmer] = self.thresholds(memory);
        let far = S::constant(FAR);
        let (frozen, frozen_slope) = self.cooling.convex(temperature, [-far, colder]);
        let (molten, molten_slope) = self.heating.convex(temperature, [warmer, far]);
        match self.model {
            HysteresisModel::CurveTrack => {
                let cools = S::constant(0.5).lt(first);
                (S::select(cools, frozen, molten), S::select(cools, frozen_slope, molten_slope))
            }
            HysteresisModel::CurveSwitch | HysteresisModel::CurveScale => {
                let scale = self.model == HysteresisModel::CurveScale;
                let (solid, liquid) = if scale { (first, second) } else { (S::one(), S::one()) };
                let begun = solid * self.heating.compact(warmer).0;
                let melts = !temperature.lt(warmer);
                (
                    liquid * frozen + S::select(melts, solid * molten - begun, S::zero()),
                    liquid * frozen_slope + S::select(melts, solid * molten_slope, S::zero()),
                )
            }
        }
    }
}

/// What is solid, or liquid, over that of a curve. It is above one where curves of different shapes have led the fraction below the melting or
/// above the freezing curve: with less, the fraction would jump to the curve at the present temperature.
#[inline(always)]
fn share<S: Real>(present: S, of_curve: S) -> S {
    let share = present / of_curve.max(S::constant(LEAST));
    S::select(share.lt(S::constant(1.0 + LEAST)), share.min(S::one()), share)
}

/// Whether a fraction rose in the first part of a step and fell in the second, or the reverse.
#[inline(always)]
pub fn reversed<S: Real>(start: S, midway: S, end: S) -> S::Mask {
    // Smaller changes are round-off.
    let threshold = S::constant(1e-12);
    let (before, after) = (midway - start, end - midway);
    (before * after).lt(S::zero()) & threshold.lt(before.abs()) & threshold.lt(after.abs())
}
