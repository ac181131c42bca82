//! The liquid fraction over temperature, in closed form or measured.

use super::normal::normal;
use super::segments::{Reading, Segments};
use super::text::{FractionText, Text};
use crate::input::description::{MeltingCurve, Tail};
use crate::input::values::Values;
use crate::number::real::{Logistic, Mask, Real};
use core::f64::consts::LOG2_E;

/// Fraction of the transition that is cut off at each end of a curve with tails, to make it compact.
pub const CUT: f64 = 1e-3;
/// Beyond this the double exponential of the Gumbel distribution is zero or one.
const GUMBEL_END: f64 = 30.0;
/// Halvings of the support in which a fraction is searched: to a millionth of it.
const BISECTIONS: usize = 20;

/// A curve at one temperature.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint<S> {
    /// Liquid fraction [-].
    pub(super) fraction: S,
    /// Its slope [1/K].
    pub(super) slope: S,
    /// Its integral over temperature [K], from where nothing has melted.
    pub(super) molten: S,
}

/// A curve of the liquid fraction that rises from 0 to 1.
#[derive(Debug, Clone)]
pub(crate) struct Curve<S> {
    shape: Shape<S>,
    centre: S,
    width: S,
    inverse_width: S,
}

/// `(1 + tanh u)/2`, a logistic function of `2 u`.
#[derive(Debug, Clone)]
pub(super) struct Tanh<S> {
    centre: S,
    /// `2 u/ln 2` [1/K].
    rate: S,
    /// Twice the slope of `u` [1/K].
    steepness: S,
    /// [K].
    half_width: S,
}

impl<S: Real> Tanh<S> {
    fn new(centre: S, width: S) -> Self {
        let steepness = S::constant(2.0) / width;
        Self { centre, rate: steepness.scale(LOG2_E), steepness, half_width: width.scale(0.5) }
    }

    #[inline(always)]
    pub(super) fn at(&self, temperature: S) -> CurvePoint<S> {
        let excess = temperature - self.centre;
        let Logistic { rise, rest, tail } = (excess * self.rate).logistic();
        // The integral of the fraction is w/2 ln(1 + e^(2u)).
        let molten = excess.max(S::zero()) + self.half_width * tail;
        CurvePoint { fraction: rise, slope: rise * rest * self.steepness, molten }
    }
}

/// What the curve is over `u = (T - centre)/width`.
#[derive(Debug, Clone)]
enum Shape<S> {
    Tanh(Tanh<S>),
    /// `v^2 (3 - 2 v)`, `v = (1 + u)/2`.
    Cubic,
    /// `v^3 (10 - 15 v + 6 v^2)`.
    Quintic,
    Gaussian,
    Gumbel(Tail),
    Linear,
    /// Below and above the peak, as parts of their sum.
    Triangle([S; 2]),
    /// Read at `T - centre`.
    Measured(Segments),
    /// As written.
    Text(Box<Text<S>>),
}

impl<S: Real> Curve<S> {
    pub(super) fn new(values: &Values<'_, S>, curve: &MeltingCurve) -> Self {
        let of = |shape, centre, width: S| Self {
            shape,
            centre: values.get(centre),
            width,
            inverse_width: S::one() / width,
        };
        let tanh = |centre, width| of(Shape::Tanh(Tanh::new(values.get(centre), width)), centre, width);
        match curve {
            MeltingCurve::TanhWidth { melting_temperature, width } => {
                tanh(*melting_temperature, values.get(*width))
            }
            MeltingCurve::TanhGamma { melting_temperature, gamma, delta_t } => {
                tanh(*melting_temperature, values.get(*delta_t).scale(4.0) / values.get(*gamma))
            }
            MeltingCurve::SmoothStep { melting_temperature, width, continuity } => {
                let shape = if *continuity == 1 { Shape::Cubic } else { Shape::Quintic };
                of(shape, *melting_temperature, values.get(*width))
            }
            MeltingCurve::Gaussian { melting_temperature, width } => {
                of(Shape::Gaussian, *melting_temperature, values.get(*width))
            }
            MeltingCurve::Gumbel { melting_temperature, width, tail } => {
                of(Shape::Gumbel(*tail), *melting_temperature, values.get(*width))
            }
            MeltingCurve::Linear { melting_temperature, width } => {
                of(Shape::Linear, *melting_temperature, values.get(*width))
            }
            MeltingCurve::Triangle { melting_temperature, below, above } => {
                let (below, above) = (values.get(*below), values.get(*above));
                let sum = below + above;
                of(Shape::Triangle([below / sum, above / sum]), *melting_temperature, sum)
            }
            MeltingCurve::Fractions { temperatures, fractions, temperature_shift } => {
                let measured = Segments::monotone(temperatures, fractions);
                let width = S::constant(0.5 * (measured.last() - measured.first()));
                of(Shape::Measured(measured), *temperature_shift, width)
            }
            MeltingCurve::Text { melting_temperature, formula, range, numbers } => {
                let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
                let given =
                    core::iter::once(*melting_temperature).chain(numbers.iter().map(|number| number.value));
                let given: Vec<S> = given.map(|id| values.get(id)).collect();
                let text =
                    FractionText::new(formula, &names).expect("a plan reads the formulas of its materials");
                let text = Text::new(text, &given, *range);
                let width = text.width;
                of(Shape::Text(Box::new(text)), *melting_temperature, width)
            }
        }
    }

    /// The curve at a temperature [degC].
    #[inline(always)]
    pub(super) fn at(&self, temperature: S) -> CurvePoint<S> {
        let excess = temperature - self.centre;
        let u = excess * self.inverse_width;
        let (fraction, slope, molten) = match &self.shape {
            Shape::Tanh(tanh) => return tanh.at(temperature),
            Shape::Cubic => cubic(u),
            Shape::Quintic => quintic(u),
            Shape::Gaussian => {
                let (fraction, density) = normal(u);
                (fraction, density, u * fraction + density)
            }
            Shape::Gumbel(tail) => gumbel(u, *tail),
            Shape::Linear => linear(u),
            Shape::Triangle(parts) => triangle(u, *parts),
            Shape::Measured(segments) => return measured(segments, excess),
            Shape::Text(text) => {
                let [fraction, slope] = text.at(temperature);
                return CurvePoint { fraction, slope, molten: S::zero() };
            }
        };
        CurvePoint { fraction, slope: slope * self.inverse_width, molten: molten * self.width }
    }

    /// The curve, if it is of this kind.
    #[inline(always)]
    pub(super) fn tanh(&self) -> Option<&Tanh<S>> {
        if let Shape::Tanh(tanh) = &self.shape { Some(tanh) } else { None }
    }

    /// Whether it is read from a measurement or a text and may have several bends.
    #[inline(always)]
    pub(super) fn is_measured(&self) -> bool {
        matches!(self.shape, Shape::Measured(_) | Shape::Text(_))
    }

    /// The curve with its tails cut off and the rest stretched to 0..1: fraction and slope.
    #[inline(never)]
    pub(super) fn compact(&self, temperature: S) -> (S, S) {
        S::vectorised(
            #[inline(always)]
            || self.cut(temperature),
        )
    }

    #[inline(always)]
    fn cut(&self, temperature: S) -> (S, S) {
        let point = self.at(temperature);
        if !matches!(self.shape, Shape::Tanh(_) | Shape::Gaussian | Shape::Gumbel(_)) {
            return (point.fraction, point.slope);
        }
        let gain = 1.0 / (1.0 - 2.0 * CUT);
        let raw = (point.fraction - S::constant(CUT)).scale(gain);
        let inside = S::zero().lt(raw) & raw.lt(S::one());
        let slope = S::select(inside, point.slope.scale(gain), S::zero());
        (raw.max(S::zero()).min(S::one()), slope)
    }

    /// The curve with its tails, not inlined, for places where speed does not matter: fraction and slope.
    #[inline(never)]
    pub(super) fn whole(&self, temperature: S) -> (S, S) {
        let point = self.at(temperature);
        (point.fraction, point.slope)
    }

    /// The convex part of the compact curve between two temperatures, and its slope: with all that the slope falls by left out; beyond the
    /// second temperature its tangent there.
    pub(super) fn convex(&self, temperature: S, [from, to]: [S; 2]) -> (S, S) {
        if let Shape::Text(text) = &self.shape {
            return text.convex(temperature, [from, to]);
        }
        let Shape::Measured(segments) = &self.shape else {
            // The slope rises up to the peak, and falls behind it.
            let place = temperature.max(from).min(self.peak().max(from).min(to));
            let (fraction, slope) = self.compact(place);
            return (fraction + slope * (temperature - place), slope);
        };
        let place = temperature.max(from).min(to);
        let [(before, rise_before), (here, rise)] =
            [from, place].map(|place| segments.convex(place - self.centre));
        let (begin, slope) = self.compact(from);
        let value = begin + here - before + (slope - rise_before) * (place - from);
        let slope = slope + rise - rise_before;
        (value + slope * (temperature - place), slope)
    }

    /// Whether the integral of the fraction is known.
    pub(super) fn integrable(&self) -> bool {
        !matches!(self.shape, Shape::Gumbel(_) | Shape::Text(_))
    }

    /// Temperature of the largest slope [degC].
    #[inline(always)]
    pub(super) fn peak(&self) -> S {
        match &self.shape {
            Shape::Measured(segments) => self.centre + S::constant(segments.steepest()),
            Shape::Text(text) => text.steepest,
            _ => self.centre,
        }
    }

    /// Temperature that the heat of melting is given at [degC]: the centre, or the middle of what was measured.
    pub(super) fn reference(&self) -> S {
        match &self.shape {
            Shape::Measured(segments) => {
                self.centre + S::constant(0.5 * (segments.first() + segments.last()))
            }
            _ => self.centre,
        }
    }

    /// Half-width of what melts, or nearly so [K].
    #[inline(always)]
    pub(super) fn width(&self) -> S {
        match &self.shape {
            Shape::Triangle(_) => self.width.scale(0.5),
            _ => self.width,
        }
    }

    /// Temperatures between which the compact curve rises [degC].
    #[inline(always)]
    pub(super) fn support(&self) -> [S; 2] {
        let [low, high] = match &self.shape {
            Shape::Tanh(_) => [-3.453_377_389_324_276_5, 3.453_377_389_324_276_5],
            Shape::Gaussian => [-3.090_232_306_167_813, 3.090_232_306_167_813],
            Shape::Gumbel(Tail::Low) => [-6.907_255_070_523_716, 1.932_644_733_916_065_5],
            Shape::Gumbel(Tail::High) => [-1.932_644_733_916_065_5, 6.907_255_070_523_716],
            Shape::Cubic | Shape::Quintic | Shape::Linear => [-1.0, 1.0],
            Shape::Triangle([below, above]) => {
                return [self.centre - *below * self.width, self.centre + *above * self.width];
            }
            Shape::Measured(segments) => {
                return [segments.first(), segments.last()].map(|end| self.centre + S::constant(end));
            }
            Shape::Text(text) => return text.ends(),
        };
        [self.centre + self.width.scale(low), self.centre + self.width.scale(high)]
    }

    /// Temperatures between which the compact curve reaches a fraction, a millionth of its support apart: at the second
    /// the curve is not below it [degC].
    #[inline(never)]
    pub(super) fn temperatures_of(&self, fraction: S) -> [S; 2] {
        let [mut low, mut high] = self.support();
        for _ in 0..BISECTIONS {
            let middle = (low + high).scale(0.5);
            let beneath = self.compact(middle).0.lt(fraction);
            low = S::select(beneath, middle, low);
            high = S::select(beneath, high, middle);
        }
        [low, high]
    }
}

/// `(1 + u)/2` held within 0 and 1, and how far u lies above 1.
#[inline(always)]
fn ramp<S: Real>(u: S) -> (S, S) {
    let v = (u + S::one()).scale(0.5).max(S::zero()).min(S::one());
    (v, (u - S::one()).max(S::zero()))
}

#[inline(always)]
fn cubic<S: Real>(u: S) -> (S, S, S) {
    let (v, beyond) = ramp(u);
    let square = v * v;
    let fraction = square * (S::constant(3.0) - v.scale(2.0));
    let slope = (v * (S::one() - v)).scale(3.0);
    (fraction, slope, (square * v) * (S::constant(2.0) - v) + beyond)
}

#[inline(always)]
fn quintic<S: Real>(u: S) -> (S, S, S) {
    let (v, beyond) = ramp(u);
    let (square, rest) = (v * v, S::one() - v);
    let cube = square * v;
    let fraction = cube * (S::constant(10.0) + v * (v.scale(6.0) - S::constant(15.0)));
    let slope = (square * rest * rest).scale(15.0);
    let molten = square * square * (S::constant(5.0) + v * (v.scale(2.0) - S::constant(6.0)));
    (fraction, slope, molten + beyond)
}

#[inline(always)]
fn linear<S: Real>(u: S) -> (S, S, S) {
    let (v, beyond) = ramp(u);
    let inside = !u.lt(-S::one()) & !S::one().lt(u);
    (v, S::select(inside, S::constant(0.5), S::zero()), v * v + beyond)
}

/// Its integral is no elementary function and left at zero.
#[inline(always)]
fn gumbel<S: Real>(u: S, tail: Tail) -> (S, S, S) {
    let x = if tail == Tail::Low { u } else { -u };
    let rate = x.max(S::constant(-GUMBEL_END)).min(S::constant(GUMBEL_END)).exp();
    let left = (-rate).exp();
    let fraction = if tail == Tail::Low { S::one() - left } else { left };
    (fraction, rate * left, S::zero())
}

/// `u` in units of the sum of both flanks.
#[inline(always)]
fn triangle<S: Real>(u: S, [below, above]: [S; 2]) -> (S, S, S) {
    // The share that melts below the peak is `below`, as the flanks have one height.
    let rising = ((u + below) / below).max(S::zero()).min(S::one());
    let falling = ((above - u) / above).max(S::zero()).min(S::one());
    let fraction = below * rising * rising + above * (S::one() - falling * falling);
    let slope = S::select(u.lt(S::zero()), rising, falling).scale(2.0);
    let (past, beyond) = (u.max(S::zero()), (u - above).max(S::zero()));
    let molten = (below * below * rising * rising * rising).scale(1.0 / 3.0)
        + below * past
        + above * (past.min(above) - (above * (S::one() - falling * falling * falling)).scale(1.0 / 3.0))
        + above * beyond;
    (fraction, slope, molten)
}

#[inline(always)]
fn measured<S: Real>(segments: &Segments, read: S) -> CurvePoint<S> {
    let Reading { height, slope, area } = segments.at(read);
    let beyond = (read - S::constant(segments.last())).max(S::zero());
    // The sum of the segments ends within round-off of one.
    CurvePoint { fraction: height.min(S::one()), slope, molten: area + beyond }
}

/// Limits a step that crosses a temperature and is longer than a width to that temperature.
#[inline(always)]
pub(super) fn limit_at<S: Real>(from: S, to: S, place: S, width: S) -> S {
    // Most steps are short.
    let long = width.lt((to - from).abs());
    if !long.any() {
        return to;
    }
    let crosses = (from.lt(place) & place.lt(to)) | (to.lt(place) & place.lt(from));
    S::select(crosses & long, place, to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    /// Every curve at both ends of what melts, at its peak and far beyond: continuous, with the slope that its fraction has, from 0
    /// to 1, and its integral rises by one kelvin for a kelvin where all is liquid.
    #[test]
    fn borders() {
        let [centre, width, other] = [0, 1, 2].map(ParamId);
        let values = Values::new(&[25.0_f64, 2.0, 1.0]);
        let cubic = |continuity| MeltingCurve::SmoothStep { melting_temperature: centre, width, continuity };
        let curves = [
            MeltingCurve::TanhWidth { melting_temperature: centre, width },
            cubic(1),
            cubic(2),
            MeltingCurve::Gaussian { melting_temperature: centre, width },
            MeltingCurve::Gumbel { melting_temperature: centre, width, tail: Tail::Low },
            MeltingCurve::Gumbel { melting_temperature: centre, width, tail: Tail::High },
            MeltingCurve::Linear { melting_temperature: centre, width },
            MeltingCurve::Triangle { melting_temperature: centre, below: width, above: other },
        ];
        for (k, described) in curves.iter().enumerate() {
            let curve = Curve::new(&values, described);
            assert!(curve.at(-75.0).fraction.abs() < 1e-9 && (curve.at(125.0).fraction - 1.0).abs() < 1e-9);
            for place in [22.0, 23.0, 24.0, 25.0, 26.0, 27.0, 28.0] {
                let step = 1e-6;
                let [before, behind] = [-step, step].map(|more| curve.at(place + more));
                let rise = behind.fraction - before.fraction;
                assert!((-1e-12..2e-6).contains(&rise), "curve {k} at {place}: a step of {rise}");
                // Only the slopes of straight flanks have steps.
                let mean = 0.5 * (before.slope + behind.slope);
                assert!((rise / (2.0 * step) - mean).abs() < 1e-5, "curve {k} at {place}");
                if curve.integrable() {
                    let area = (behind.molten - before.molten) / (2.0 * step);
                    assert!((area - curve.at(place).fraction).abs() < 1e-5, "curve {k} at {place}: {area}");
                }
            }
        }
    }
}
