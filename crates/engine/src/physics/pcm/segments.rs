//! Piecewise cubic curves that lanes can read without a lookup: sums over clamped segments.

use crate::number::real::Real;

/// `h = linear u + square u^2 + cube u^3` above its start, u in \[0, 1\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    start: f64,
    length: f64,
    linear: f64,
    square: f64,
    cube: f64,
    /// Height of the curve at the start.
    below: f64,
}

/// A monotone C1 curve from its first point to its last; constant before and after.
#[derive(Debug, Clone)]
pub(super) struct Segments {
    all: Vec<Segment>,
}

impl Segments {
    /// Monotone cubic interpolation (Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5(2), doi:10.1137/0905021):
    /// harmonic-mean slopes inside, secants at the ends.
    pub(super) fn monotone(x: &[f64], y: &[f64]) -> Self {
        let secants: Vec<f64> =
            x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
        let slope = |i: usize| {
            if i == 0 {
                return secants[0];
            }
            if i == secants.len() {
                return secants[i - 1];
            }
            let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
            let (w1, w2) = (2.0 * right + left, right + 2.0 * left);
            if secants[i - 1] > 0.0 && secants[i] > 0.0 {
                (w1 + w2) / (w1 / secants[i - 1] + w2 / secants[i])
            } else {
                0.0
            }
        };
        let pieces = (0..secants.len()).map(|i| {
            let length = x[i + 1] - x[i];
            let (s0, s1, m) = (slope(i), slope(i + 1), secants[i]);
            let (linear, square) = (length * s0, length * (3.0 * m - 2.0 * s0 - s1));
            Segment { start: x[i], length, linear, square, cube: length * (s0 + s1 - 2.0 * m), below: 0.0 }
        });
        Self::piled(pieces.collect())
    }

    /// The integral of a piecewise linear curve.
    pub(super) fn integral(x: &[f64], y: &[f64]) -> Self {
        let pieces = x.windows(2).zip(y.windows(2)).map(|(x, y)| {
            let length = x[1] - x[0];
            let (linear, square) = (length * y[0], 0.5 * length * (y[1] - y[0]));
            Segment { start: x[0], length, linear, square, cube: 0.0, below: 0.0 }
        });
        Self::piled(pieces.collect())
    }

    fn piled(mut all: Vec<Segment>) -> Self {
        let mut height = 0.0;
        for segment in &mut all {
            segment.below = height;
            height += segment.linear + segment.square + segment.cube;
        }
        Self { all }
    }

    pub(super) fn first(&self) -> f64 {
        self.all[0].start
    }

    pub(super) fn last(&self) -> f64 {
        let segment = self.all[self.all.len() - 1];
        segment.start + segment.length
    }

    /// Height above the first point, and slope (zero before and after).
    #[inline(always)]
    pub(super) fn at<S: Real>(&self, x: S) -> (S, S) {
        let (mut height, mut slope) = (S::zero(), S::zero());
        for segment in &self.all {
            let (rise, gradient) = segment.at(x);
            height += rise;
            slope += gradient;
        }
        (height, slope)
    }

    /// Integral of `height - floor` from the start of a range up to a point, over the part within the range.
    #[inline(always)]
    pub(super) fn area<S: Real>(&self, x: S, floor: f64, range: [f64; 2]) -> S {
        let parts = self.all.iter().map(
            #[inline(always)]
            |segment| segment.area(x, segment.below - floor, range),
        );
        parts.fold(S::zero(), |sum, part| sum + part)
    }

    /// Where the curve is steepest: the middle of the segment half that rises most.
    pub(super) fn steepest(&self) -> f64 {
        const PARTS: u32 = 8;
        let middles = self.all.iter().flat_map(|segment| {
            (0..PARTS).map(move |i| segment.start + segment.length * (f64::from(i) + 0.5) / f64::from(PARTS))
        });
        let steeper = |a: f64, b: f64| if self.at(b).1 > self.at(a).1 { b } else { a };
        middles.fold(self.first(), steeper)
    }
}

impl Segment {
    /// Rise of the segment up to a point and its slope there (zero outside).
    #[inline(always)]
    fn at<S: Real>(&self, x: S) -> (S, S) {
        let raw = (x - S::constant(self.start)).scale(1.0 / self.length);
        let u = raw.max(S::zero()).min(S::one());
        let inside = !raw.lt(S::zero()) & raw.lt(S::one());
        let rise = u * (S::constant(self.linear) + u * (S::constant(self.square) + u.scale(self.cube)));
        let slope =
            S::constant(self.linear) + u * (S::constant(2.0 * self.square) + u.scale(3.0 * self.cube));
        (rise, S::select(inside, slope.scale(1.0 / self.length), S::zero()))
    }

    /// Integral of `offset + rise` up to a point, over the part of the segment within a range.
    #[inline(always)]
    fn area<S: Real>(&self, x: S, offset: f64, range: [f64; 2]) -> S {
        let [low, high] = range.map(|end| ((end - self.start) / self.length).clamp(0.0, 1.0));
        let raw = (x - S::constant(self.start)).scale(1.0 / self.length);
        let u = raw.max(S::constant(low)).min(S::constant(high));
        self.antiderivative(u, offset) - self.antiderivative(S::constant(low), offset)
    }

    #[inline(always)]
    fn antiderivative<S: Real>(&self, u: S, offset: f64) -> S {
        let cubic = S::constant(self.square / 3.0) + u.scale(self.cube / 4.0);
        (u * (S::constant(offset) + u * (S::constant(self.linear / 2.0) + u * cubic))).scale(self.length)
    }
}
