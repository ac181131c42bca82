//! From parameter ids to numbers.

use crate::input::description::ParamId;
use crate::number::real::Real;

/// The parameter vector of one run (or of a pack of members in lanes).
#[derive(Debug, Clone, Copy)]
pub struct Values<'a, S> {
    numbers: &'a [S],
}

impl<'a, S: Real> Values<'a, S> {
    /// Wraps a vector in the order of the description's parameters.
    #[must_use]
    #[inline(always)]
    pub fn new(numbers: &'a [S]) -> Self {
        Self { numbers }
    }

    /// Value of a leaf.
    #[must_use]
    #[inline(always)]
    pub fn get(&self, id: ParamId) -> S {
        self.numbers[id.0 as usize]
    }

    /// Value of a leaf that may be absent.
    #[must_use]
    #[inline(always)]
    pub fn get_or(&self, id: Option<ParamId>, default: f64) -> S {
        id.map_or_else(|| S::constant(default), |id| self.get(id))
    }
}
