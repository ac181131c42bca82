//! What walls of constant properties are factored into, by stage length: a run whose steps change their length factors them once for each.

use crate::linear::transition_matrices::TransitionMatrices;
use crate::linear::wall::{Response, WallSystem};
use crate::number::real::Real;

/// Stage lengths whose factors are kept beside those in use. Steps are halved some times from their longest; few lengths follow each other.
const MOST: usize = 8;

/// The walls of a building, factored for a stage length.
#[derive(Debug, Clone)]
struct WallFactors<S> {
    walls: Vec<WallSystem<S>>,
    transition_matrices: TransitionMatrices<S>,
    responses: Vec<Response<S>>,
    length: f64,
}

/// The factors in use, where a building has them.
pub(crate) struct InUse<'f, S> {
    pub(crate) walls: &'f mut Vec<WallSystem<S>>,
    pub(crate) transition_matrices: &'f mut TransitionMatrices<S>,
    pub(crate) responses: &'f mut Vec<Response<S>>,
    /// Effective stage length [s]; NaN: none.
    pub(crate) length: &'f mut f64,
}

impl<S: Real> InUse<'_, S> {
    fn copied(&self) -> WallFactors<S> {
        WallFactors {
            walls: self.walls.clone(),
            transition_matrices: self.transition_matrices.clone(),
            responses: self.responses.clone(),
            length: *self.length,
        }
    }

    fn exchange(&mut self, other: &mut WallFactors<S>) {
        core::mem::swap(self.walls, &mut other.walls);
        core::mem::swap(self.transition_matrices, &mut other.transition_matrices);
        core::mem::swap(self.responses, &mut other.responses);
        core::mem::swap(self.length, &mut other.length);
    }
}

/// Factors for other stage lengths.
#[derive(Debug, Clone)]
pub(crate) struct FactorStore<S> {
    keeps: bool,
    factors: Vec<WallFactors<S>>,
    /// Which of them is replaced next.
    next: usize,
}

impl<S: Real> FactorStore<S> {
    /// Keeps nothing.
    pub(crate) fn new() -> Self {
        Self { keeps: false, factors: Vec::new(), next: 0 }
    }

    /// Keeps factors from now on.
    pub(crate) fn keep(&mut self) {
        self.keeps = true;
    }

    /// Exchanges the factors in use with those of a stage length [s]; false where there are none: those in use are then to be factored.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    pub(crate) fn exchange(&mut self, length: f64, mut current: InUse<'_, S>) -> bool {
        if !self.keeps || current.length.is_nan() {
            return false;
        }
        if let Some(other) = self.factors.iter_mut().find(|other| other.length.to_bits() == length.to_bits())
        {
            current.exchange(other);
            current.transition_matrices.begin();
            return true;
        }
        if self.factors.len() < MOST {
            self.factors.push(current.copied());
        } else {
            current.exchange(&mut self.factors[self.next]);
            self.next = (self.next + 1) % MOST;
        }
        false
    }
}
