//! The linear system that is left when walls and zones are eliminated: airs, and the surfaces that zones share.
//!
//! Gaussian elimination row by row. The pattern of the matrix is known beforehand, fill-in included ([`Pattern`]): only these
//! entries are stored and computed with, so that work and memory grow like the building.
//! The matrix is an M-matrix, whose pivots are positive in any order: no pivoting, the same operations in every lane.
//!
//! The first unknowns are surfaces of walls of constant properties. Their rows change less often than the rest (once for each
//! stage length, stage or iteration, as the laws at these surfaces demand). They stay eliminated until then, and only the
//! rest is assembled and solved again.

use core::ops::Range;

use crate::building::pattern::{Pattern, RowPattern};
use crate::linear::product::{PlainMatrix, Product, SameKind};
use crate::number::real::Real;

use dense::DenseRows;

mod dense;

/// The system of airs and of the surfaces that zones share.
#[derive(Debug, Clone)]
pub(crate) struct CoupledSystem<'a, S> {
    pattern: &'a Pattern,
    /// Number of unknowns that zones eliminate: rows are counted from there, see
    /// [`Plan::own_rows`](crate::building::plan::Plan::own_rows).
    before: usize,
    /// Number of the first unknowns, see [`Plan::constant_rows`](crate::building::plan::Plan::constant_rows).
    first: usize,
    /// Entries of the matrix as the pattern places them, in place of them its factors: inverse pivots on the diagonal, the upper triangle as the elimination
    /// leaves it, and below the diagonal the entries that the pivot eliminated.
    matrix: Vec<S>,
    /// Right-hand sides, then the solution, of all unknowns, those that zones eliminate included.
    pub(crate) right: Vec<S>,
    /// Matrix and right-hand sides after the elimination of the first unknowns.
    kept: Vec<S>,
    kept_right: Vec<S>,
    /// The rows behind the first, where all of them meet.
    dense: Option<DenseRows>,
}

impl<'a, S: Real> CoupledSystem<'a, S> {
    pub(crate) fn new(pattern: &'a Pattern, before: usize, first: usize) -> Self {
        let size = pattern.size();
        // One entry more, at `nowhere`.
        let (all, line) = (vec![S::zero(); pattern.entries() + 1], vec![S::zero(); size]);
        let right = vec![S::zero(); before + size];
        // Compiled for numbers in registers only: others do not solve stages in long runs.
        let dense = if S::IN_REGISTERS { DenseRows::new(pattern, first) } else { None };
        Self { pattern, before, first, kept: all.clone(), matrix: all, kept_right: line, right, dense }
    }

    #[inline(always)]
    pub(crate) fn clear_matrix(&mut self) {
        self.matrix.fill(S::zero());
    }

    #[inline(always)]
    pub(crate) fn clear_right(&mut self) {
        self.right[self.before..].fill(S::zero());
    }

    /// Adds to the diagonal of the matrix.
    #[inline(always)]
    pub(crate) fn add_diagonal(&mut self, row: usize, value: S) {
        self.matrix[self.pattern.row(row - self.before).diagonal] += value;
    }

    /// Adds to an entry of the matrix; the rows must meet.
    #[inline(always)]
    pub(crate) fn add(&mut self, row: usize, column: usize, value: S) {
        let place = self.pattern.place(row - self.before, column - self.before);
        debug_assert!(place.is_some(), "row {row} does not meet row {column}");
        if let Some(place) = place {
            self.matrix[place] += value;
        }
    }

    /// Adds to an entry whose place is known.
    #[inline(always)]
    pub(crate) fn add_at(&mut self, place: usize, value: S) {
        self.matrix[place] += value;
    }

    /// Adds some numbers to entries whose places are known.
    #[inline(always)]
    pub(crate) fn add_all(&mut self, places: &[usize], values: &[S]) {
        for (&place, &value) in places.iter().zip(values) {
            self.matrix[place] += value;
        }
    }

    /// Adds a conductance between two unknowns.
    #[inline(always)]
    pub(crate) fn couple(&mut self, a: usize, b: usize, conductance: S) {
        self.add_diagonal(a, conductance);
        self.add_diagonal(b, conductance);
        self.add(a, b, -conductance);
        self.add(b, a, -conductance);
    }

    /// Eliminates the first unknowns from the matrix, once their rows are complete.
    #[inline(always)]
    pub(crate) fn keep_matrix(&mut self) {
        self.eliminate(0..self.first);
        let start = self.pattern.start(self.first);
        self.kept[start..].copy_from_slice(&self.matrix[start..]);
    }

    /// Eliminates them from the right-hand side.
    #[inline(always)]
    pub(crate) fn keep_right(&mut self) {
        let right = &mut self.right[self.before..];
        forward::<S, SameKind, S>(self.pattern, &self.matrix, right, 0..self.first);
        self.kept_right.copy_from_slice(right);
    }

    /// Restores the system as the elimination of the first unknowns left it, before anything was added to the rest.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        let start = self.pattern.start(self.first);
        self.matrix[start..].copy_from_slice(&self.kept[start..]);
        self.right[self.before..].copy_from_slice(&self.kept_right);
    }

    /// Solves for the unknowns behind the first; they replace their right-hand sides.
    #[inline(always)]
    pub(crate) fn solve_rest(&mut self) {
        if const { S::IN_REGISTERS }
            && let Some(dense) = &self.dense
        {
            return dense.solve(&mut self.matrix, &mut self.right[self.before..]);
        }
        let rest = self.first..self.pattern.size();
        self.eliminate(rest.clone());
        let right = &mut self.right[self.before..];
        forward::<S, SameKind, S>(self.pattern, &self.matrix, right, rest.clone());
        back::<S, SameKind, S>(self.pattern, &self.matrix, right, rest);
    }

    /// Solves for the first unknowns, once the others are known.
    #[inline(always)]
    pub(crate) fn solve_first(&mut self) {
        let right = &mut self.right[self.before..];
        back::<S, SameKind, S>(self.pattern, &self.matrix, right, 0..self.first);
    }

    /// The inverse pivot of a row of the rest: how its unknown responds to its own right-hand side, unknowns eliminated later held.
    #[inline(always)]
    pub(crate) fn inverse_pivot(&self, row: usize) -> S {
        self.matrix[self.pattern.row(row - self.before).diagonal]
    }

    /// The solution for another right-hand side, with the factors already computed.
    #[inline(always)]
    pub(crate) fn solve_again(&self, right: &mut [S]) {
        self.solve_with::<SameKind, S>(right);
    }

    #[inline(always)]
    fn solve_with<P: Product<S, R>, R: Real>(&self, right: &mut [R]) {
        let (right, all) = (&mut right[self.before..], 0..self.pattern.size());
        forward::<S, P, R>(self.pattern, &self.matrix, right, all.clone());
        back::<S, P, R>(self.pattern, &self.matrix, right, all);
    }

    /// Gaussian elimination of what is not zero. Pivots are left inverted; what is below them stays.
    #[inline(always)]
    fn eliminate(&mut self, rows: Range<usize>) {
        for RowPattern { entries, diagonal, later, .. } in self.pattern.rows(rows) {
            let (upper, lower) = self.matrix.split_at_mut(entries.end);
            let inverse = S::one() / upper[*diagonal];
            upper[*diagonal] = inverse;
            let pivot = &upper[diagonal + 1..];
            for row in later {
                let factor = lower[row.entry - entries.end] * inverse;
                for segment in &row.segments {
                    let changed = &mut lower[segment.place - entries.end..][..segment.of_pivot.len()];
                    for (a, &p) in changed.iter_mut().zip(&pivot[segment.of_pivot.clone()]) {
                        *a = *a - factor * p;
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
        let (right, rows) = (&mut right[self.before..], self.pattern.rows(0..self.pattern.size()));
        for (k, row) in rows.iter().enumerate() {
            let weight = right[k] * self.matrix[row.diagonal];
            right[k] = weight;
            let factors = &self.matrix[row.diagonal + 1..row.entries.end];
            for (later, &factor) in row.later.iter().zip(factors) {
                right[later.row] -= factor * weight;
            }
        }
        for (k, row) in rows.iter().enumerate().rev() {
            let below = row.later.iter().map(|later| self.matrix[later.entry] * right[later.row]);
            let sum = below.fold(0.0, |sum, term| sum + term);
            right[k] -= self.matrix[row.diagonal] * sum;
        }
    }
}

/// Eliminates some unknowns from a right-hand side.
#[inline(always)]
fn forward<S: Real, P: Product<S, R>, R: Real>(
    pattern: &Pattern,
    matrix: &[S],
    right: &mut [R],
    rows: Range<usize>,
) {
    for (k, row) in rows.clone().zip(pattern.rows(rows)) {
        let known = P::of(matrix[row.diagonal], right[k]);
        for later in &row.later {
            right[later.row] = right[later.row] - P::of(matrix[later.entry], known);
        }
    }
}

/// Solves for some unknowns, from the last to the first.
#[inline(always)]
fn back<S: Real, P: Product<S, R>, R: Real>(
    pattern: &Pattern,
    matrix: &[S],
    right: &mut [R],
    rows: Range<usize>,
) {
    for (k, row) in rows.clone().zip(pattern.rows(rows)).rev() {
        let factors = &matrix[row.diagonal + 1..row.entries.end];
        let mut sum = right[k];
        for (later, &factor) in row.later.iter().zip(factors) {
            sum = sum - P::of(factor, right[later.row]);
        }
        right[k] = P::of(matrix[row.diagonal], sum);
    }
}

#[cfg(test)]
mod tests;
