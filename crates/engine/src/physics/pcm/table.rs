//! A measured curve of enthalpy, sensible heat included.

use super::segments::{Reading, Segments};
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
    shift: S,
    /// Scale times density [kg/m3].
    factor: S,
}

/// A measured curve at one temperature.
#[derive(Debug, Clone, Copy)]
pub(super) struct TablePoint<S> {
    /// Enthalpy [J/m3].
    pub(super) enthalpy: S,
    /// Its slope [J/(m3 K)].
    pub(super) capacity: S,
    /// Liquid fraction [-].
    pub(super) fraction: S,
    /// Its slope [1/K].
    pub(super) fraction_slope: S,
    /// Integral of the liquid fraction over temperature, from the solidus [K].
    pub(super) molten: S,
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
        let solid = curve.at(solidus).height;
        let melt = curve.at(liquidus).height - solid;
        let curve = curve.above(solid, melting_range);
        Self { curve, solidus, liquidus, solid, melt, shift, factor }
    }

    /// The curve at a temperature [degC].
    #[inline(always)]
    pub(super) fn at(&self, temperature: S, volumetric_heat: [S; 2]) -> TablePoint<S> {
        let read = temperature - self.shift;
        let Reading { height, slope, area } = self.curve.at(read);
        let below = (read - S::constant(self.curve.first())).min(S::zero());
        let above = (read - S::constant(self.curve.last())).max(S::zero());
        let before = read.lt(S::constant(self.curve.first()));
        let after = !read.lt(S::constant(self.curve.last()));
        let outside = S::select(before, volumetric_heat[0], S::select(after, volumetric_heat[1], S::zero()));
        let raw = (height - S::constant(self.solid)).scale(1.0 / self.melt);
        let melting = S::zero().lt(raw) & raw.lt(S::one());
        TablePoint {
            enthalpy: height * self.factor + below * volumetric_heat[0] + above * volumetric_heat[1],
            capacity: slope * self.factor + outside,
            fraction: raw.max(S::zero()).min(S::one()),
            fraction_slope: S::select(melting, slope.scale(1.0 / self.melt), S::zero()),
            molten: (read - S::constant(self.liquidus)).max(S::zero()) + area.scale(1.0 / self.melt),
        }
    }

    /// A convex part of the enthalpy [J/m3] and its slope: what the curve rises by less is convex as well. The heat of the solid counts at
    /// all temperatures, and that of the liquid is added behind the curve.
    pub(super) fn convex(&self, temperature: S, [solid, liquid]: [S; 2]) -> (S, S) {
        let read = temperature - self.shift;
        let (value, slope) = self.curve.convex(read);
        let above = (read - S::constant(self.curve.last())).max(S::zero());
        let after = S::select(S::zero().lt(above), liquid, S::zero());
        let below = read - S::constant(self.curve.first());
        (value * self.factor + below * solid + above * liquid, slope * self.factor + solid + after)
    }

    /// Temperature of the largest capacity [degC].
    #[inline(always)]
    pub(super) fn peak(&self) -> S {
        S::constant(self.curve.steepest()) + self.shift
    }

    /// Half of the melting range [K].
    #[inline(always)]
    pub(super) fn width(&self) -> S {
        S::constant(0.5 * (self.liquidus - self.solidus))
    }
}
