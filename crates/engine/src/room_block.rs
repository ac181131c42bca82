//! The linear system of zone faces and airs, which the walls are eliminated onto.

use core::ops::Range;

use crate::real::Real;

/// The system of zone faces and airs. Its matrix is an M-matrix: no pivoting.
#[derive(Debug)]
pub(crate) struct RoomBlock<'a, S> {
    /// For each row the later ones that it meets, see [`Plan::reach`](crate::plan::Plan::reach).
    pub(crate) reach: &'a [Vec<Range<usize>>],
    pub(crate) matrix: Vec<S>,
    pub(crate) right: Vec<S>,
}

impl<'a, S: Real> RoomBlock<'a, S> {
    pub(crate) fn new(reach: &'a [Vec<Range<usize>>]) -> Self {
        let size = reach.len();
        Self { reach, matrix: vec![S::zero(); size * size], right: vec![S::zero(); size] }
    }

    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.matrix.fill(S::zero());
        self.right.fill(S::zero());
    }

    #[inline(always)]
    pub(crate) fn row(&mut self, row: usize) -> &mut [S] {
        let n = self.reach.len();
        &mut self.matrix[row * n..(row + 1) * n]
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, row: usize, column: usize, value: S) {
        self.matrix[row * self.reach.len() + column] += value;
    }

    /// A conductance between two unknowns.
    #[inline(always)]
    pub(crate) fn couple(&mut self, a: usize, b: usize, conductance: S) {
        self.add(a, a, conductance);
        self.add(b, b, conductance);
        self.add(a, b, -conductance);
        self.add(b, a, -conductance);
    }

    /// Gaussian elimination of what is not zero; the solution replaces the right-hand side.
    #[inline(always)]
    pub(crate) fn solve(&mut self) {
        let n = self.reach.len();
        for (k, reach) in self.reach.iter().enumerate() {
            let (upper, lower) = self.matrix.split_at_mut((k + 1) * n);
            let pivot = &mut upper[k * n..];
            let inverse = S::one() / pivot[k];
            pivot[k] = inverse;
            let known = self.right[k];
            for rows in reach {
                let later = &mut lower[(rows.start - k - 1) * n..(rows.end - k - 1) * n];
                let right = &mut self.right[rows.clone()];
                for (row, right) in later.chunks_exact_mut(n).zip(right) {
                    let factor = row[k] * inverse;
                    for run in reach {
                        for (a, &p) in row[run.clone()].iter_mut().zip(&pivot[run.clone()]) {
                            *a = *a - factor * p;
                        }
                    }
                    *right = *right - factor * known;
                }
            }
        }
        back_substitute(self.reach, &self.matrix, &mut self.right);
    }

    /// The solution for another right-hand side, with the factors of [`Self::solve`].
    #[inline(always)]
    pub(crate) fn solve_again(&self, right: &mut [S]) {
        let n = self.reach.len();
        for (k, reach) in self.reach.iter().enumerate() {
            let known = right[k] * self.matrix[k * n + k];
            for row in reach.iter().cloned().flatten() {
                right[row] = right[row] - self.matrix[row * n + k] * known;
            }
        }
        back_substitute(self.reach, &self.matrix, right);
    }
}

/// From the last unknown to the first; the pivots stand inverted on the diagonal.
#[inline(always)]
fn back_substitute<S: Real>(reach: &[Vec<Range<usize>>], matrix: &[S], right: &mut [S]) {
    let n = reach.len();
    for (k, reach) in reach.iter().enumerate().rev() {
        let row = &matrix[k * n..(k + 1) * n];
        let mut sum = right[k];
        for run in reach {
            for (&a, &x) in row[run.clone()].iter().zip(&right[run.clone()]) {
                sum = sum - a * x;
            }
        }
        right[k] = sum * row[k];
    }
}
