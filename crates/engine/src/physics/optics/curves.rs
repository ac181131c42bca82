//! Transmittance and absorptances over the cosine of the angle of incidence, as monotone piecewise cubics.
//!
//! Source: Fritsch & Butland (1984), SIAM J. Sci. Stat. Comput. 5(2), doi:10.1137/0905021.

use super::diffuse::{Diffuse, Unit, cosine};
use crate::number::real::{Mask, Real};

/// Number of directions in a quarter of the horizon.
const HORIZON: usize = 32;

/// Quantities over the cosine of the angle of incidence, piecewise cubic.
#[derive(Debug, Clone)]
pub struct Curves<S> {
    /// Rising from 0 to 1.
    knots: Vec<f64>,
    /// Number of quantities.
    count: usize,
    /// By piece and quantity: polynomial of the distance from the piece's first knot.
    pieces: Vec<[S; 4]>,
}

impl<S: Real> Curves<S> {
    /// Through units at angles rising from 0 to 90 deg.
    pub(super) fn new(angles: &[f64], units: &[Unit<S>]) -> Self {
        // As they are in the numbers that are compared with them.
        let knots: Vec<f64> = angles.iter().rev().map(|angle| S::constant(cosine(*angle)).lane(0)).collect();
        let count = units[0].len();
        let mut pieces = vec![[S::zero(); 4]; (knots.len() - 1) * count];
        for quantity in 0..count {
            let heights: Vec<S> = units.iter().rev().map(|unit| unit[quantity]).collect();
            for (piece, polynomial) in monotone(&knots, &heights).into_iter().enumerate() {
                pieces[piece * count + quantity] = polynomial;
            }
        }
        Self { knots, count, pieces }
    }

    /// Transmittance at a cosine; fills in the absorptance of each pane. Between two angles of a table the curves may together
    /// exceed one: they are kept below it.
    #[inline(always)]
    pub fn split(&self, cosine: S, panes: &mut [S]) -> S {
        let mut transmittance = [S::zero()];
        self.read(cosine, 0, &mut transmittance);
        self.read(cosine, 1, panes);
        let sum = panes.iter().fold(transmittance[0], |sum, part| sum + *part);
        if S::one().lt(sum).any() {
            let factor = S::one() / sum.max(S::one());
            for pane in panes {
                *pane = *pane * factor;
            }
            return transmittance[0] * factor;
        }
        transmittance[0]
    }

    /// Reads quantities from the given one on at a cosine; below zero as at zero.
    #[inline(always)]
    pub(super) fn read(&self, cosine: S, offset: usize, read: &mut [S]) {
        // Mostly the cosines of all lanes lie in one piece; where they do not, each lane selects its own.
        let (mut first, mut last) = (self.knots.len(), 0);
        for lane in 0..S::LANES {
            let piece = self.piece(cosine.lane(lane));
            first = first.min(piece);
            last = last.max(piece);
        }
        let piece = |number: usize, quantity: usize| self.pieces[number * self.count + offset + quantity];
        let mut from = S::constant(self.knots[first]);
        for number in first + 1..=last {
            let knot = S::constant(self.knots[number]);
            from = S::select(cosine.lt(knot), from, knot);
        }
        let x = cosine.max(S::zero()) - from;
        for (quantity, read) in read.iter_mut().enumerate() {
            let mut polynomial = piece(first, quantity);
            for number in first + 1..=last {
                let before = cosine.lt(S::constant(self.knots[number]));
                let here = piece(number, quantity);
                polynomial = core::array::from_fn(|k| S::select(before, polynomial[k], here[k]));
            }
            let [a, b, c, d] = polynomial;
            *read = a + x * (b + x * (c + x * d));
        }
    }

    /// Piece that holds a cosine.
    #[inline(always)]
    fn piece(&self, cosine: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.iter().filter(|knot| **knot <= cosine).count()
    }

    /// Means over the horizon, `1/2 int f(sin tilt cos a) cos a da`, a the azimuth off the normal from -90 to 90 deg.
    pub fn horizon(&self, sine: S) -> Diffuse<S> {
        let mut means = vec![S::zero(); self.count];
        let mut read = means.clone();
        let step = core::f64::consts::FRAC_PI_2 / HORIZON as f64;
        let mut weights = 0.0;
        for k in 0..HORIZON {
            let weight = Real::cos((k as f64 + 0.5) * step);
            self.read(sine.scale(weight), 0, &mut read);
            for (mean, read) in means.iter_mut().zip(&read) {
                *mean += read.scale(weight);
            }
            weights += weight;
        }
        for mean in &mut means {
            *mean = mean.scale(1.0 / weights);
        }
        Diffuse { transmittance: means[0], absorptance: means.split_off(1) }
    }

    /// Means over the hemisphere, `2 int f(c) c dc`.
    pub(super) fn diffuse(&self) -> Diffuse<S> {
        let mut means = vec![S::zero(); self.count];
        for (number, pair) in self.knots.windows(2).enumerate() {
            let (from, h) = (pair[0], pair[1] - pair[0]);
            let square = h * h;
            let powers = [h, square, square * h, square * square, square * square * h];
            // int_0^h t^k (from + t) dt
            let moment = |k: usize| {
                let (m, n) = ((k + 1) as f64, (k + 2) as f64);
                from * powers[k] / m + powers[k + 1] / n
            };
            let moments = [moment(0), moment(1), moment(2), moment(3)];
            for (quantity, mean) in means.iter_mut().enumerate() {
                let polynomial = self.pieces[number * self.count + quantity];
                for (coefficient, moment) in polynomial.into_iter().zip(moments) {
                    *mean += coefficient.scale(2.0 * moment);
                }
            }
        }
        Diffuse { transmittance: means[0], absorptance: means.split_off(1) }
    }
}

/// Polynomials between knots, without overshoot where the heights are monotone.
fn monotone<S: Real>(knots: &[f64], heights: &[S]) -> Vec<[S; 4]> {
    let n = knots.len() - 1;
    let widths: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let load_sensitivities: Vec<S> =
        (0..n).map(|k| (heights[k + 1] - heights[k]).scale(1.0 / widths[k])).collect();
    let mut slopes = vec![load_sensitivities[0]; n + 1];
    for k in 1..n {
        slopes[k] = inner_slope(widths[k - 1], widths[k], load_sensitivities[k - 1], load_sensitivities[k]);
    }
    if n > 1 {
        slopes[0] = end_slope(widths[0], widths[1], load_sensitivities[0], load_sensitivities[1]);
        slopes[n] =
            end_slope(widths[n - 1], widths[n - 2], load_sensitivities[n - 1], load_sensitivities[n - 2]);
    }
    (0..n)
        .map(|k| {
            let h = widths[k];
            let (start, end, rise) = (slopes[k], slopes[k + 1], load_sensitivities[k]);
            [
                heights[k],
                start,
                (rise.scale(3.0) - start.scale(2.0) - end).scale(1.0 / h),
                (start + end - rise.scale(2.0)).scale(1.0 / (h * h)),
            ]
        })
        .collect()
}

/// Weighted harmonic mean of the slopes on both sides, zero at an extremum.
fn inner_slope<S: Real>(before: f64, after: f64, left: S, right: S) -> S {
    let (u, v) = (before + 2.0 * after, 2.0 * before + after);
    let product = left * right;
    let extremum = !S::zero().lt(product);
    let sum = S::select(extremum, S::one(), right.scale(u) + left.scale(v));
    S::select(extremum, S::zero(), product.scale(u + v) / sum)
}

/// Slope of the parabola through three points, kept from overshooting.
fn end_slope<S: Real>(near: f64, far: f64, rise: S, next: S) -> S {
    let slope = (rise.scale(2.0 * near + far) - next.scale(near)).scale(1.0 / (near + far));
    let against = (slope * rise).lt(S::zero());
    let steep = (rise * next).lt(S::zero()) & rise.scale(3.0).abs().lt(slope.abs());
    S::select(against, S::zero(), S::select(steep, rise.scale(3.0), slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean over the horizon of the cosine itself: pi/4 times the sine of the tilt.
    #[test]
    fn horizontal_means() {
        let angles: Vec<f64> = (0..=90).map(f64::from).collect();
        let units: Vec<_> = angles.iter().map(|a| vec![1.0, cosine(*a)]).collect();
        let curves = Curves::new(&angles, &units);
        for sine in [1.0, 0.5] {
            let means = curves.horizon(sine);
            assert!((means.transmittance - 1.0).abs() < 1e-12);
            let expected = sine * core::f64::consts::FRAC_PI_4;
            assert!((means.absorptance[0] - expected).abs() < 1e-4, "{}", means.absorptance[0]);
        }
    }

    /// Hemispherical means of a constant and of the cosine itself: 1 and 2/3.
    #[test]
    fn hemispherical_means() {
        let angles = [0.0, 60.0, 90.0];
        let units: Vec<_> = angles.iter().map(|a| vec![1.0, cosine(*a)]).collect();
        let means = Curves::new(&angles, &units).diffuse();
        assert!((means.transmittance - 1.0).abs() < 1e-12);
        assert!((means.absorptance[0] - 2.0 / 3.0).abs() < 1e-12);
    }

    /// A table whose curves together exceed one by 6 % between its angles: what is transmitted and absorbed does not.
    #[test]
    fn no_more_than_arrives() {
        let angles = [0.0, 40.0, 50.0, 60.0, 90.0];
        let through = [0.63, 0.93, 0.44, 0.95, 0.0];
        let rest = [0.37, 0.07, 0.06, 0.0, 0.0];
        let units: Vec<_> = through.iter().zip(rest).map(|(t, a)| vec![*t, a]).collect();
        let curves = Curves::new(&angles, &units);
        let mut above = 0;
        for k in 0..=1000 {
            let (cosine, mut panes, mut raw) = (f64::from(k) / 1000.0, [0.0], [0.0; 2]);
            let sum = curves.split(cosine, &mut panes) + panes[0];
            assert!((0.0..=1.0 + 1e-12).contains(&sum), "{sum} at {cosine}");
            curves.read(cosine, 0, &mut raw);
            above += usize::from(raw[0] + raw[1] > 1.0 + 1e-9);
        }
        assert!(above > 0, "the curves of the table do not exceed one anywhere");
    }

    /// The curve goes through its table.
    #[test]
    fn through_the_table() {
        let angles = [0.0, 30.0, 60.0, 80.0, 90.0];
        let heights = [0.703, 0.692, 0.577, 0.208, 0.0];
        let units: Vec<_> = heights.iter().map(|t| vec![*t]).collect();
        let curves = Curves::new(&angles, &units);
        for (angle, height) in angles.into_iter().zip(heights) {
            let mut read = [0.0];
            curves.read(cosine(angle), 0, &mut read);
            assert!((read[0] - height).abs() < 1e-12, "{angle}");
        }
    }
}
