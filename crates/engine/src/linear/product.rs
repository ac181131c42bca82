//! Products of right-hand sides and coefficients of a matrix.
//!
//! The factors of a matrix solve right-hand sides of its own kind of number, and those of a plain matrix also right-hand
//! sides that carry derivatives. Each sweep is written once over [`Product`].

use crate::number::real::Real;

/// How a coefficient of a matrix multiplies a value of a right-hand side.
pub(crate) trait Product<S, R> {
    /// `coefficient value`.
    fn of(coefficient: S, value: R) -> R;
    /// `first second value`.
    fn of_both(first: S, second: S, value: R) -> R;
}

/// Matrix and right-hand side are of the same kind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SameKind;

/// The matrix is plain, the right-hand side of any kind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlainMatrix;

impl<S: Real> Product<S, S> for SameKind {
    #[inline(always)]
    fn of(coefficient: S, value: S) -> S {
        coefficient * value
    }
    #[inline(always)]
    fn of_both(first: S, second: S, value: S) -> S {
        first * (second * value)
    }
}

impl<R: Real> Product<f64, R> for PlainMatrix {
    #[inline(always)]
    fn of(coefficient: f64, value: R) -> R {
        value.scale(coefficient)
    }
    /// One product less for each derivative.
    #[inline(always)]
    fn of_both(first: f64, second: f64, value: R) -> R {
        value.scale(first * second)
    }
}
