//! The root of a function of one number, with its derivatives.

use super::real::{ByPrecision, Real};

/// Half of the distance between the points of a slope, relative to the larger of one and the place.
const WIDTH: ByPrecision = ByPrecision { double: 1e-5, single: 5e-3 };

/// Root of a falling function between two limits, by Newton's method with slopes from differences.
///
/// The slope needs no derivatives: where the function is evaluated with `true`, none of its numbers may have any. Those of the
/// root are exact.
pub(crate) fn falling_root<S: Real>(
    start: S,
    iterations: usize,
    [low, high]: [S; 2],
    excess: impl Fn(S, bool) -> S,
) -> S {
    let mut at = start;
    for _ in 0..iterations {
        let fixed = at.fixed();
        let width = fixed.abs().min(S::one()).max(S::constant(1e-3)).scale(WIDTH.of::<S>());
        let slope = (excess(fixed + width, true) - excess(fixed - width, true)) / (width + width);
        let slope = slope.min(S::constant(-1e-9));
        at = (at - excess(at, false) / slope).max(low).min(high);
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `exp(-x) = 0.2` at `ln 5`; without a root between the limits, the nearer one.
    #[test]
    fn root_of_an_exponential() {
        let root = |limit: f64| falling_root(0.5, 12, [0.0, limit], |x: f64, _| Real::exp(-x) - 0.2);
        assert!((root(9.0) - 1.609_437_912_434_100_3).abs() < 1e-13);
        assert_eq!(root(1.0), 1.0);
    }
}
