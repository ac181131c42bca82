//! Influence of right-hand sides and retained unknowns, where the matrix of a front is constant.

use crate::number::real::Real;

/// Influence coefficients of a constant matrix.
#[derive(Debug, Clone)]
pub(super) struct Influence<S> {
    /// By right-hand side of an eliminated surface (rows): temperatures of the eliminated surfaces, then what is added to the
    /// right-hand sides of the retained unknowns.
    pub(super) of_right: Vec<S>,
    /// By retained unknown (rows): temperatures of the eliminated surfaces.
    pub(super) of_retained: Vec<S>,
    /// Influence of the right-hand side at hand.
    pub(super) applied: Vec<S>,
}

impl<S: Real> Influence<S> {
    pub(super) fn new(stride: usize) -> Self {
        let zeros = |count| vec![S::zero(); count];
        Self { of_right: zeros(stride * stride), of_retained: zeros(stride * stride), applied: zeros(stride) }
    }
}
