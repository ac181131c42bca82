//! Rate-independent hysteresis: one curve for melting, another for freezing; what lies between is the matter of three laws.
//!
//! Within a step the liquid fraction is a function of temperature alone, given the history at the step's start; that
//! function never falls. Sources: Barz et al. (2019), J. Build. Perf. Simul. 12(6),
//! doi:10.1080/19401493.2019.1657953; Barz et al. (2021), J. Energy Storage 34, doi:10.1016/j.est.2020.101907.

use super::law::Ingredients;
use crate::number::real::Real;
use crate::physics::pcm::curve::{Curve, limit_at};

/// A temperature beyond all others, for one that is not known [degC].
pub(crate) const FAR: f64 = 1e100;

/// A curve for melting and one for freezing.
#[derive(Debug, Clone)]
pub(super) struct TwoCurves<S> {
    pub(super) heating: Curve<S>,
    pub(super) cooling: Curve<S>,
}

impl<S: Real> TwoCurves<S> {
    /// The curves of a law, that for melting first: the check of a description has counted them.
    pub(super) fn new(ingredients: Ingredients<'_, S>) -> Self {
        let mut curves = ingredients.curves.into_iter();
        let mut next = || curves.next().expect("the check of a description counts the curves of its laws");
        Self { heating: next(), cooling: next() }
    }

    /// Fraction and slope of the melting and of the freezing curve. Where parameters vary so far that the curves cross,
    /// the freezing curve is the melting curve.
    #[inline(always)]
    pub(super) fn at(&self, temperature: S) -> [(S, S); 2] {
        let melting = self.heating.compact(temperature);
        let freezing = self.cooling.compact(temperature);
        let crossed = freezing.0.lt(melting.0);
        let (fraction, slope) =
            (S::select(crossed, melting.0, freezing.0), S::select(crossed, melting.1, freezing.1));
        [melting, (fraction, slope)]
    }

    /// Ends a Newton step at the largest capacity of freezing or of melting; `thresholds`: up to which temperature the
    /// material freezes and from which it melts [degC].
    #[inline(always)]
    pub(super) fn limit(&self, from: S, to: S, [colder, warmer]: [S; 2]) -> S {
        let (freezing, melting) = (self.cooling.peak().min(colder), self.heating.peak().max(warmer));
        let to = limit_at(from, to, freezing, self.cooling.width());
        limit_at(from, to, melting, self.heating.width())
    }

    /// Half-width of the narrower curve [K].
    pub(super) fn width(&self) -> S {
        self.heating.width().min(self.cooling.width())
    }

    /// The convex parts of the freezing and the melting curve and their slopes, where both hold.
    pub(super) fn convex(&self, temperature: S, [colder, warmer]: [S; 2]) -> [(S, S); 2] {
        let far = S::constant(FAR);
        let frozen = self.cooling.convex(temperature, [-far, colder]);
        [frozen, self.heating.convex(temperature, [warmer, far])]
    }

    /// The convex part of a fraction that follows a share of the freezing curve up to one temperature and a share of the
    /// melting curve from another on, and its slope.
    pub(super) fn rising(&self, temperature: S, thresholds: [S; 2], [liquid, solid]: [S; 2]) -> (S, S) {
        let [(frozen, frozen_slope), (molten, molten_slope)] = self.convex(temperature, thresholds);
        let warmer = thresholds[1];
        let begun = solid * self.heating.compact(warmer).0;
        let melts = !temperature.lt(warmer);
        (
            liquid * frozen + S::select(melts, solid * molten - begun, S::zero()),
            liquid * frozen_slope + S::select(melts, solid * molten_slope, S::zero()),
        )
    }
}

/// One of two pairs.
#[inline(always)]
pub(super) fn either<S: Real>(mask: S::Mask, a: (S, S), b: (S, S)) -> (S, S) {
    (S::select(mask, a.0, b.0), S::select(mask, a.1, b.1))
}
