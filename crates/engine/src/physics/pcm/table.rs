//! A measured curve of enthalpy, sensible heat included.

use super::segments::Segments;
use crate::input::description::TablePoints;
use crate::number::real::Real;

/// A monotone C1 curve of specific enthalpy.
#[derive(Debug, Clone)]
pub(super) struct Table<S> {
    curve: Segments,
    solidus: f64,
    liquidus: f64,
    /// Height of the curve at the solidus, and its rise to the liquidus [J/kg].
    solid: f64,
    melt: f64,
    /// Where the curve is steepest [degC].
    steepest: f64,
    shift: S,
    /// Scale times density [kg/m3].
    factor: S,
}

impl<S: Real> Table<S> {
    pub(super) fn new(
        temperatures: &[f64],
        points: &TablePoints,
        melting_range: [f64; 2],
        shift: S,
        factor: S,
    ) -> Self {
        let curve = match points {
            TablePoints::Enthalpies(values) => Segments::monotone(temperatures, values),
            TablePoints::Capacities(values) => Segments::integral(temperatures, values),
        };
        let [solidus, liquidus] = melting_range;
        let solid = curve.at(solidus).0;
        let melt = curve.at(liquidus).0 - solid;
        let steepest = curve.steepest();
        Self { curve, solidus, liquidus, solid, melt, steepest, shift, factor }
    }

    /// (enthalpy, capacity, liquid fraction, its slope).
    #[inline(always)]
    pub(super) fn at(&self, temperature: S, volumetric_heat: [S; 2]) -> (S, S, S, S) {
        let read = temperature - self.shift;
        let (height, slope) = self.curve.at(read);
        let below = (read - S::constant(self.curve.first())).min(S::zero());
        let above = (read - S::constant(self.curve.last())).max(S::zero());
        let before = read.lt(S::constant(self.curve.first()));
        let after = !read.lt(S::constant(self.curve.last()));
        let outside = S::select(before, volumetric_heat[0], S::select(after, volumetric_heat[1], S::zero()));
        let enthalpy = height * self.factor + below * volumetric_heat[0] + above * volumetric_heat[1];
        let raw = (height - S::constant(self.solid)).scale(1.0 / self.melt);
        let fraction = raw.max(S::zero()).min(S::one());
        let melting = S::zero().lt(raw) & raw.lt(S::one());
        let fraction_slope = S::select(melting, slope.scale(1.0 / self.melt), S::zero());
        (enthalpy, slope * self.factor + outside, fraction, fraction_slope)
    }

    /// Integral of the liquid fraction over temperature [K], from the solidus.
    #[inline(always)]
    pub(super) fn molten(&self, temperature: S) -> S {
        let read = temperature - self.shift;
        let melting = self.curve.area(read, self.solid, [self.solidus, self.liquidus]);
        (read - S::constant(self.liquidus)).max(S::zero()) + melting.scale(1.0 / self.melt)
    }

    /// Temperature of the largest capacity [degC].
    #[inline(always)]
    pub(super) fn peak(&self) -> S {
        S::constant(self.steepest) + self.shift
    }

    /// Half of the melting range [K].
    #[inline(always)]
    pub(super) fn width(&self) -> S {
        S::constant(0.5 * (self.liquidus - self.solidus))
    }
}
