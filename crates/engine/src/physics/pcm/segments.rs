//! Piecewise cubic curves, read through a table of places: the time does not depend on the number of their points.

use crate::number::real::Real;

/// Cells of the table of places for each segment.
const CELLS: usize = 4;

/// `h = below + linear u + square u^2 + cube u^3`, u in \[0, 1\].
#[derive(Debug, Clone, Copy)]
struct Segment {
    start: f64,
    length: f64,
    linear: f64,
    square: f64,
    cube: f64,
    /// Height of the curve at the start.
    below: f64,
    /// Integral of the height above the floor, from the start of its range to that of the segment.
    area: f64,
}

/// A part of a segment in which the slope rises, or falls: at its start the convex part of the height and its slope, height and slope.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    convex: [f64; 2],
    curve: [f64; 2],
    load_sensitivities: bool,
}

/// A monotone C1 curve from its first point to its last; constant before and after.
#[derive(Debug, Clone)]
pub(super) struct Segments {
    all: Vec<Segment>,
    /// The segment that the start of each cell is in, and cells per kelvin: cells of equal length cover the curve.
    places: Vec<usize>,
    density: f64,
    /// The integral counts from this height, within this range of temperatures; its value at the end of the range.
    floor: f64,
    range: [f64; 2],
    whole: f64,
    /// Where the curve is steepest [degC].
    steepest: f64,
}

/// A curve at one temperature.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading<S> {
    /// Height above the first point.
    pub(super) height: S,
    /// Its slope; zero before and after the curve.
    pub(super) slope: S,
    /// Integral of the height above the floor, over the part of the range below the temperature.
    pub(super) area: S,
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
            Segment::of(x[i], length, [linear, square, length * (s0 + s1 - 2.0 * m)])
        });
        Self::piled(pieces.collect())
    }

    /// The integral of a piecewise linear curve.
    pub(super) fn integral(x: &[f64], y: &[f64]) -> Self {
        let pieces = x.windows(2).zip(y.windows(2)).map(|(x, y)| {
            let length = x[1] - x[0];
            Segment::of(x[0], length, [length * y[0], 0.5 * length * (y[1] - y[0]), 0.0])
        });
        Self::piled(pieces.collect())
    }

    fn piled(mut all: Vec<Segment>) -> Self {
        let mut height = 0.0;
        for segment in &mut all {
            segment.below = height;
            height += segment.linear + segment.square + segment.cube;
        }
        let (first, last) = (all[0].start, all[all.len() - 1].end());
        let cells = CELLS * all.len();
        let density = cells as f64 / (last - first);
        let place = |cell: usize| {
            let from = first + cell as f64 / density;
            all.iter().rposition(|segment| segment.start <= from).unwrap_or(0)
        };
        let places = (0..cells).map(place).collect();
        let range = [first, last];
        let found = Self { all, places, density, floor: 0.0, range, whole: 0.0, steepest: first };
        let steepest = found.find_steepest();
        Self { steepest, ..found }.above(0.0, range)
    }

    /// The same curve, with an integral above a height and within a range of temperatures.
    pub(super) fn above(mut self, floor: f64, range: [f64; 2]) -> Self {
        let [low, high] = range;
        let mut area = 0.0;
        for segment in &mut self.all {
            let begin = ((low - segment.start) / segment.length).clamp(0.0, 1.0);
            let offset = segment.below - floor;
            // At the start of the range the integral is zero: in the segment around it, it counts from there.
            segment.area = area - segment.antiderivative(begin, offset);
            area = segment.area + segment.antiderivative(1.0, offset);
        }
        (self.floor, self.range, self.whole) = (floor, range, 0.0);
        self.whole = self.inside(high);
        self
    }

    pub(super) fn first(&self) -> f64 {
        self.all[0].start
    }

    pub(super) fn last(&self) -> f64 {
        self.all[self.all.len() - 1].end()
    }

    /// Where the curve is steepest: the middle of the eighth of a segment that rises most.
    pub(super) fn steepest(&self) -> f64 {
        self.steepest
    }

    fn find_steepest(&self) -> f64 {
        const PARTS: u32 = 8;
        let middles = self.all.iter().flat_map(|segment| {
            (0..PARTS).map(move |i| segment.start + segment.length * (f64::from(i) + 0.5) / f64::from(PARTS))
        });
        let slope = |x: f64| self.at(x).slope;
        let steeper = |a: f64, b: f64| if slope(b) > slope(a) { b } else { a };
        middles.fold(self.first(), steeper)
    }

    /// The segment that a temperature is in; the first before, and the last after the curve.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "such numbers end at the ends"
    )]
    #[inline(always)]
    fn segment(&self, x: f64) -> &Segment {
        // A cast gives zero for what is below zero or no number, and the largest number for what is above it.
        let cell = ((x - self.first()) * self.density) as usize;
        let mut place = self.places[cell.min(self.places.len() - 1)];
        while place + 1 < self.all.len() && self.all[place + 1].start <= x {
            place += 1;
        }
        // A cell may begin behind the temperature by round-off.
        while place > 0 && x < self.all[place].start {
            place -= 1;
        }
        &self.all[place]
    }

    /// The curve at a temperature.
    #[inline(always)]
    pub(super) fn at<S: Real>(&self, x: S) -> Reading<S> {
        let found = x.look_up(
            #[inline(always)]
            |x| {
                let &Segment { start, length, linear, square, cube, below, area } = self.segment(x);
                [start, length, linear, square, cube, below, area]
            },
        );
        let [start, length, linear, square, cube, below, area] = found;
        let raw = (x - start) / length;
        let u = raw.max(S::zero()).min(S::one());
        let inside = !raw.lt(S::zero()) & raw.lt(S::one());
        let rise = u * (linear + u * (square + u * cube));
        let slope = (linear + u * (square.scale(2.0) + u * cube.scale(3.0))) / length;
        let cubic = square.scale(1.0 / 3.0) + u * cube.scale(0.25);
        let parts = u * (below - S::constant(self.floor) + u * (linear.scale(0.5) + u * cubic)) * length;
        let [low, high] = self.range.map(S::constant);
        let within = S::select(high.lt(x), S::constant(self.whole), area + parts);
        Reading {
            height: below + rise,
            slope: S::select(inside, slope, S::zero()),
            area: S::select(x.lt(low), S::zero(), within),
        }
    }

    /// The convex part of the height and its slope: that of the curve with all that its slope falls by left out. The rest, this less the
    /// height, is convex as well.
    pub(super) fn convex<S: Real>(&self, x: S) -> (S, S) {
        let found = x.look_up(|x| {
            let Piece { start, convex: [value, slope], curve: [height, steepness], load_sensitivities } =
                self.piece(x);
            [start, value, slope, height, steepness, if load_sensitivities { 1.0 } else { 0.0 }]
        });
        let [start, value, slope, height, steepness, load_sensitivities] = found;
        let Reading { height: reached, slope: there, .. } = self.at(x);
        let distance = x - start;
        let bent = reached - height - steepness * distance;
        (
            value + slope * distance + load_sensitivities * bent,
            slope + load_sensitivities * (there - steepness),
        )
    }

    /// The piece that a temperature is in.
    fn piece(&self, x: f64) -> Piece {
        let mut piece =
            Piece { start: self.first(), convex: [0.0; 2], curve: [0.0; 2], load_sensitivities: false };
        if x < piece.start {
            return piece;
        }
        for segment in &self.all {
            let turn = -segment.square / (3.0 * segment.cube);
            let turns = 0.0 < turn && turn < 1.0;
            let parts = if turns { [Some([0.0, turn]), Some([turn, 1.0])] } else { [Some([0.0, 1.0]), None] };
            for [from, to] in parts.into_iter().flatten() {
                let (begin, end) = (segment.place(from), segment.place(to));
                // Where two segments meet the slope may rise at once.
                piece.convex[1] += (begin.curve[1] - piece.curve[1]).max(0.0);
                piece = Piece { convex: piece.convex, ..begin };
                piece.load_sensitivities = end.curve[1] > begin.curve[1];
                if x < end.start {
                    return piece;
                }
                let length = end.start - begin.start;
                piece.convex[0] += piece.convex[1] * length;
                if piece.load_sensitivities {
                    piece.convex[0] += end.curve[0] - begin.curve[0] - begin.curve[1] * length;
                    piece.convex[1] += end.curve[1] - begin.curve[1];
                }
                piece = Piece { convex: piece.convex, ..end };
            }
        }
        piece.curve[1] = 0.0;
        piece
    }

    /// The integral at a temperature of the range.
    fn inside(&self, x: f64) -> f64 {
        let segment = self.segment(x);
        let u = ((x - segment.start) / segment.length).clamp(0.0, 1.0);
        segment.area + segment.antiderivative(u, segment.below - self.floor)
    }
}

impl Segment {
    /// With coefficients of u, its square and its cube.
    fn of(start: f64, length: f64, [linear, square, cube]: [f64; 3]) -> Self {
        Self { start, length, linear, square, cube, below: 0.0, area: 0.0 }
    }

    fn end(&self) -> f64 {
        self.start + self.length
    }

    /// A place on the curve, of which no convex part is known.
    fn place(&self, u: f64) -> Piece {
        let height = self.below + u * (self.linear + u * (self.square + u * self.cube));
        let slope = (self.linear + u * (2.0 * self.square + u * 3.0 * self.cube)) / self.length;
        Piece {
            start: self.start + u * self.length,
            convex: [0.0; 2],
            curve: [height, slope],
            load_sensitivities: false,
        }
    }

    /// Integral of `offset + rise` from the start.
    fn antiderivative(&self, u: f64, offset: f64) -> f64 {
        let cubic = self.square / 3.0 + u * (self.cube / 4.0);
        u * (offset + u * (self.linear / 2.0 + u * cubic)) * self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

    fn curve() -> Segments {
        let temperatures = [18.0, 19.5, 20.0, 20.1, 20.2, 21.0, 26.0];
        Segments::monotone(&temperatures, &[0.0, 5.0, 20.0, 60.0, 90.0, 97.0, 100.0])
    }

    /// The curve passes through its points, whatever the places that they are found by.
    #[test]
    fn every_point_is_found() {
        let curve = curve();
        let points =
            [(17.0, 0.0), (18.0, 0.0), (19.5, 5.0), (20.1, 60.0), (21.0, 97.0), (26.0, 100.0), (40.0, 100.0)];
        for (x, height) in points {
            assert!((curve.at(x).height - height).abs() < 1e-12, "{x}");
        }
        assert_eq!((curve.at(17.9).slope, curve.at(26.0).slope), (0.0, 0.0));
        assert!((curve.steepest() - 20.05).abs() < 0.05);
    }

    /// The slope is the derivative of the height, and the height above the floor that of the area, within the range.
    #[test]
    fn heights_are_derivatives_of_areas() {
        let curve = curve().above(5.0, [19.5, 21.0]);
        for k in 0..400 {
            let x = 17.003 + 0.025 * f64::from(k);
            let seeded: Reading<Dual<1>> = curve.at(Dual { value: x, slope: [1.0] });
            assert!((seeded.height.slope[0] - curve.at(x).slope).abs() < 1e-9, "{x}");
            let inside = (19.5..21.0).contains(&x);
            let expected = if inside { curve.at(x).height - 5.0 } else { 0.0 };
            assert!((seeded.area.slope[0] - expected).abs() < 1e-9, "{x}");
        }
        // Fine trapezia.
        let parts = 100_000;
        let at = |k: i32| curve.at(19.5 + 1.5 * f64::from(k) / f64::from(parts)).height - 5.0;
        let sum: f64 = (0..parts).map(|k| 0.5 * (at(k) + at(k + 1))).sum();
        assert!((curve.at(30.0).area - sum * 1.5 / f64::from(parts)).abs() < 1e-6);
        assert_eq!(curve.at(19.4).area, 0.0);
    }

    /// The slopes of the convex part and of the rest never fall, and are the derivatives of both.
    #[test]
    fn a_curve_is_the_difference_of_two_convex_ones() {
        let capacities = Segments::integral(&[18.0, 19.0, 20.0, 22.0], &[2.0, 9.0, 1.0, 4.0]);
        for curve in [curve(), capacities] {
            let rest = |x: f64| {
                let ((value, slope), Reading { height, slope: steepness, .. }) =
                    (curve.convex(x), curve.at(x));
                (value - height, slope - steepness)
            };
            let mut last = [0.0; 2];
            for k in 0..2000 {
                let x = 16.003 + 0.006 * f64::from(k);
                let ((value, slope), (other, fall)) = (curve.convex(x), rest(x));
                assert!(slope >= last[0] - 1e-9 && fall >= last[1] - 1e-9, "{x}: {slope}, {fall}");
                assert!((curve.convex(x + 1e-6).0 - value - 1e-6 * slope).abs() < 1e-7, "{x}");
                assert!((rest(x + 1e-6).0 - other - 1e-6 * fall).abs() < 1e-7, "{x}");
                last = [slope, fall];
            }
            assert_eq!(curve.convex(17.0), (0.0, 0.0));
        }
    }

    /// Numbers that are no temperatures end in the first or the last segment.
    #[test]
    fn a_lookup_never_leaves_the_table() {
        let curve = curve();
        for x in [f64::NAN, f64::NEG_INFINITY, -1e300, 1e300, f64::INFINITY] {
            let _ = curve.at(x);
        }
    }
}
