//! Straight lines: linearised laws.

use crate::number::real::Real;

/// A straight line `offset + slope T`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<S> {
    pub(crate) offset: S,
    pub(crate) slope: S,
}

impl<S: Real> Line<S> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self { offset: S::zero(), slope: S::zero() }
    }
    /// The tangent of a function with a value and a slope at a point. What derivatives do to the slope does not matter:
    /// it counts only away from that point, where no solution lies.
    #[inline(always)]
    pub(crate) fn tangent(value: S, slope: S, at: S) -> Self {
        let slope = slope.fixed();
        Self { offset: value - slope * at, slope }
    }
    /// The sum of two lines.
    #[inline(always)]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { offset: self.offset + other.offset, slope: self.slope + other.slope }
    }
    #[inline(always)]
    pub(crate) fn at(&self, x: S) -> S {
        self.offset + self.slope * x
    }
}

impl Line<f64> {
    /// The values of another line.
    #[inline(always)]
    pub(crate) fn of<S: Real>(other: &Line<S>) -> Self {
        Self { offset: other.offset.lane(0), slope: other.slope.lane(0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

    #[test]
    fn a_tangent_has_the_value_and_the_slope_of_its_function_at_the_point() {
        // x^2 at 3: 9 + 6 (x - 3).
        let line = Line::tangent(9.0, 6.0, 3.0);
        assert_eq!([line.offset, line.slope, line.at(3.0), line.at(5.0)], [-9.0, 6.0, 9.0, 21.0]);
    }

    #[test]
    fn the_slope_of_a_tangent_is_a_constant_for_derivatives() {
        let x = Dual::<1>::variable(3.0, 0);
        let line = Line::tangent(x * x, x.scale(2.0), x);
        assert!(!line.slope.carries());
        // d(x^2 - 6 x)/dx = 0 at 3, where 6 is held; the value at x has the slope of x^2.
        assert_eq!(line.offset, Dual { value: -9.0, slope: [0.0] });
        assert_eq!(line.at(x), Dual { value: 9.0, slope: [6.0] });
        assert_eq!(Line::of(&line).at(5.0), 21.0);
    }
}
