//! The linear system that is left when walls and zones are eliminated: airs, and the surfaces that zones share.
//!
//! Gaussian elimination row by row. The pattern of the matrix is known beforehand: the *reach* of a row lists the later rows
//! that it meets, fill-in included ([`Plan::reach`](crate::building::plan::Plan::reach)), and only these are computed with.
//! The matrix is an M-matrix, whose pivots are positive in any order: no pivoting, the same operations in every lane.
//!
//! The first unknowns are surfaces of walls of constant properties. Their rows change less often than the rest (once for each
//! stage length, stage or iteration, as the laws at these surfaces demand). They stay eliminated until then, and only the
//! rest is assembled and solved again.

use core::ops::Range;

use crate::linear::product::{PlainMatrix, Product, SameKind};
use crate::number::real::Real;

/// The system of airs and of the surfaces that zones share.
#[derive(Debug, Clone)]
pub(crate) struct CoupledSystem<'a, S> {
    /// For each row the later ones that it meets.
    reach: &'a [Vec<Range<usize>>],
    /// Number of unknowns that zones eliminate: rows are counted from there, see
    /// [`Plan::own_rows`](crate::building::plan::Plan::own_rows).
    before: usize,
    /// Number of the first unknowns, see [`Plan::constant_rows`](crate::building::plan::Plan::constant_rows).
    first: usize,
    /// The matrix row by row, in place of it its factors: inverse pivots on the diagonal, the upper triangle as the elimination
    /// leaves it, and below the diagonal the entries that the pivot eliminated.
    matrix: Vec<S>,
    /// Right-hand sides, then the solution, of all unknowns, those that zones eliminate included.
    pub(crate) right: Vec<S>,
    /// Matrix and right-hand sides after the elimination of the first unknowns.
    kept: Vec<S>,
    kept_right: Vec<S>,
}

impl<'a, S: Real> CoupledSystem<'a, S> {
    pub(crate) fn new(reach: &'a [Vec<Range<usize>>], before: usize, first: usize) -> Self {
        let size = reach.len();
        let (all, line) = (vec![S::zero(); size * size], vec![S::zero(); size]);
        let right = vec![S::zero(); before + size];
        Self { reach, before, first, kept: all.clone(), matrix: all, kept_right: line, right }
    }

    #[inline(always)]
    pub(crate) fn clear_matrix(&mut self) {
        self.matrix.fill(S::zero());
    }

    #[inline(always)]
    pub(crate) fn clear_right(&mut self) {
        self.right[self.before..].fill(S::zero());
    }

    /// Adds to an entry of the matrix.
    #[inline(always)]
    pub(crate) fn add(&mut self, row: usize, column: usize, value: S) {
        self.matrix[(row - self.before) * self.reach.len() + column - self.before] += value;
    }

    /// Adds a conductance between two unknowns.
    #[inline(always)]
    pub(crate) fn couple(&mut self, a: usize, b: usize, conductance: S) {
        self.add(a, a, conductance);
        self.add(b, b, conductance);
        self.add(a, b, -conductance);
        self.add(b, a, -conductance);
    }

    /// Eliminates the first unknowns from the matrix, once their rows are complete.
    #[inline(always)]
    pub(crate) fn keep_matrix(&mut self) {
        self.eliminate(0..self.first);
        let start = self.first * self.reach.len();
        self.kept[start..].copy_from_slice(&self.matrix[start..]);
    }

    /// Eliminates them from the right-hand side.
    #[inline(always)]
    pub(crate) fn keep_right(&mut self) {
        let right = &mut self.right[self.before..];
        forward::<S, SameKind, S>(self.reach, &self.matrix, right, 0..self.first);
        self.kept_right.copy_from_slice(right);
    }

    /// Restores the system as the elimination of the first unknowns left it, before anything was added to the rest.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        let start = self.first * self.reach.len();
        self.matrix[start..].copy_from_slice(&self.kept[start..]);
        self.right[self.before..].copy_from_slice(&self.kept_right);
    }

    /// Solves for the unknowns behind the first; they replace their right-hand sides.
    #[inline(always)]
    pub(crate) fn solve_rest(&mut self) {
        let rest = self.first..self.reach.len();
        self.eliminate(rest.clone());
        let right = &mut self.right[self.before..];
        forward::<S, SameKind, S>(self.reach, &self.matrix, right, rest.clone());
        back::<S, SameKind, S>(self.reach, &self.matrix, right, rest);
    }

    /// Solves for the first unknowns, once the others are known.
    #[inline(always)]
    pub(crate) fn solve_first(&mut self) {
        let right = &mut self.right[self.before..];
        back::<S, SameKind, S>(self.reach, &self.matrix, right, 0..self.first);
    }

    /// The solution for another right-hand side, with the factors already computed.
    #[inline(always)]
    pub(crate) fn solve_again(&self, right: &mut [S]) {
        self.solve_with::<SameKind, S>(right);
    }

    #[inline(always)]
    fn solve_with<P: Product<S, R>, R: Real>(&self, right: &mut [R]) {
        let (right, all) = (&mut right[self.before..], 0..self.reach.len());
        forward::<S, P, R>(self.reach, &self.matrix, right, all.clone());
        back::<S, P, R>(self.reach, &self.matrix, right, all);
    }

    /// Gaussian elimination of what is not zero. Pivots are left inverted; what is below them stays.
    #[inline(always)]
    fn eliminate(&mut self, rows: Range<usize>) {
        let n = self.reach.len();
        for k in rows {
            let reach = &self.reach[k];
            let (upper, lower) = self.matrix.split_at_mut((k + 1) * n);
            let pivot = &mut upper[k * n..];
            let inverse = S::one() / pivot[k];
            pivot[k] = inverse;
            for later in reach {
                let later = &mut lower[(later.start - k - 1) * n..(later.end - k - 1) * n];
                for row in later.chunks_exact_mut(n) {
                    let factor = row[k] * inverse;
                    for run in reach {
                        for (a, &p) in row[run.clone()].iter_mut().zip(&pivot[run.clone()]) {
                            *a = *a - factor * p;
                        }
                    }
                }
            }
        }
    }
}

impl CoupledSystem<'_, f64> {
    /// The solution for right-hand sides of another kind of number, with the factors already computed.
    #[inline(always)]
    pub(crate) fn solve_values<R: Real>(&self, right: &mut [R]) {
        self.solve_with::<PlainMatrix, R>(right);
    }

    /// The solution of the transposed system, with the factors already computed.
    #[inline(always)]
    pub(crate) fn solve_transposed(&self, right: &mut [f64]) {
        let (right, n) = (&mut right[self.before..], self.reach.len());
        for k in 0..n {
            let line = &self.matrix[k * n..(k + 1) * n];
            let weight = right[k] * line[k];
            right[k] = weight;
            for run in &self.reach[k] {
                for (later, &factor) in right[run.clone()].iter_mut().zip(&line[run.clone()]) {
                    *later -= factor * weight;
                }
            }
        }
        for k in (0..n).rev() {
            let mut sum = 0.0;
            for row in self.reach[k].iter().cloned().flatten() {
                sum += self.matrix[row * n + k] * right[row];
            }
            right[k] -= self.matrix[k * n + k] * sum;
        }
    }
}

/// Eliminates some unknowns from a right-hand side.
#[inline(always)]
fn forward<S: Real, P: Product<S, R>, R: Real>(
    reach: &[Vec<Range<usize>>],
    matrix: &[S],
    right: &mut [R],
    rows: Range<usize>,
) {
    let n = reach.len();
    for k in rows {
        let known = P::of(matrix[k * n + k], right[k]);
        for run in &reach[k] {
            for row in run.clone() {
                right[row] = right[row] - P::of(matrix[row * n + k], known);
            }
        }
    }
}

/// Solves for some unknowns, from the last to the first.
#[inline(always)]
fn back<S: Real, P: Product<S, R>, R: Real>(
    reach: &[Vec<Range<usize>>],
    matrix: &[S],
    right: &mut [R],
    rows: Range<usize>,
) {
    let n = reach.len();
    for k in rows.rev() {
        let row = &matrix[k * n..(k + 1) * n];
        let mut sum = right[k];
        for run in &reach[k] {
            for (&a, &x) in row[run.clone()].iter().zip(&right[run.clone()]) {
                sum = sum - P::of(a, x);
            }
        }
        right[k] = P::of(row[k], sum);
    }
}

#[cfg(test)]
mod tests;
